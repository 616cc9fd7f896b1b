//! Steps that change so that they amplify vibrations.

use super::Warning;
use crate::message::short;
use percute_core::time::TimeGrid;
use percute_core::variable_steps::Amplification;

/// The remedy.
const ADVICE: &str = "take equal steps (`courant` or `step`), or steps that change seldom, or slowly: over a hundred \
                      steps and more from the shortest to the longest";

/// A warning of steps that amplify vibrations; told before the run, too. `critical` is Δt_c (s).
#[must_use]
pub fn varying_steps(times: &TimeGrid, critical: f64) -> Option<Warning> {
    let Amplification { factor, step } = Some(Amplification::of(times, critical)).filter(Amplification::is_notable)?;
    let factor = short(factor, 2);
    let message = format!(
        "change so that they amplify vibrations of the body up to {factor} times by step {step} (parametric \
         resonance), though each is below the critical step: energy may appear from nothing; {ADVICE}"
    );
    Some(Warning { name: "varying_steps", brief: format!("changing steps amplify vibrations {factor} times"), message })
}

/// Why steps are refused that would make the run unstable.
#[must_use]
pub fn unstable_steps(times: &TimeGrid, critical: f64) -> Option<String> {
    let Amplification { factor, step } = Some(Amplification::of(times, critical)).filter(Amplification::is_refused)?;
    Some(format!(
        "change so that they amplify vibrations of the body {factor:.0} times by step {step} (parametric resonance): \
         the run would be unstable, though each step is below the critical one; {ADVICE}"
    ))
}
