//! The work of a run and its probable duration, before it begins.

use crate::message::{counted, short, trimmed};
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;
use percute_estimator::Sampling;

/// Runs of more elements times steps than this must be asked for: 10⁸, times a factor of 100. A drop at 5 m/s of 10⁶
/// steps on 5000 elements has half of it; 13 s instead of 13 µs have more on 250 elements.
pub const MOST: u64 = 100 * 100_000_000;
/// Duration of an element in a step of the simulation (s): 2.3 to 4.7 ns were measured, on one thread (docs/speed.md).
const SIMULATION: f64 = 4e-9;
/// The same with the estimate beside it (s), away from samples and at a sample: 19 to 92 ns, and 140 ns more.
const BETWEEN: f64 = 25e-9;
const SAMPLE: f64 = 140e-9;
/// Factors of these with finite kinematics, the second of the estimate: a pass finds the steps before the run.
const FINITE: [f64; 2] = [4.0, 2.5];

/// Whether a run may be long.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Long {
    /// The user has asked for it.
    Allowed,
    /// It must be asked for.
    Refused {
        /// How: an option or an argument.
        way: &'static str,
    },
}

impl Long {
    /// From the option or argument named `way`.
    #[must_use]
    pub fn asked(given: bool, way: &'static str) -> Self {
        if given { Self::Allowed } else { Self::Refused { way } }
    }

    /// How it must be asked for; none if it was.
    fn way(self) -> Option<&'static str> {
        match self {
            Self::Allowed => None,
            Self::Refused { way } => Some(way),
        }
    }
}

/// The work of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Elements.
    pub elements: usize,
    /// Elements times steps.
    pub element_steps: u64,
    /// About how long the simulation takes (s), on one thread.
    pub simulation_seconds: f64,
    /// The same of the simulation with its estimate (s).
    pub run_seconds: f64,
}

impl Effort {
    /// That of a problem over these steps, with its error sampled so.
    #[must_use]
    pub fn of(problem: &AnyProblem, times: &TimeGrid, every: Sampling) -> Self {
        let (elements, steps) = (problem.mesh().element_count(), times.step_count());
        let element_steps = (elements as u64).saturating_mul(steps as u64);
        let run = BETWEEN + SAMPLE / every.spacing(elements, steps) as f64;
        let [of_simulation, of_run] = if problem.is_finite() { FINITE } else { [1.0; 2] };
        let seconds = |each: f64| each * element_steps as f64;
        let [simulation_seconds, run_seconds] = [seconds(of_simulation * SIMULATION), seconds(of_run * run)];
        Self { elements, element_steps, simulation_seconds, run_seconds }
    }

    /// That of the same run on its mesh and on `levels` refinements of it, with steps half as long each time.
    #[must_use]
    pub(crate) fn refined(&self, dimension: usize, levels: usize) -> Self {
        let factor = (0..=levels).map(|k| 1 << ((dimension + 1) * k)).sum::<u64>();
        let seconds = |of_one: f64| factor as f64 * of_one;
        let [simulation_seconds, run_seconds] = [self.simulation_seconds, self.run_seconds].map(seconds);
        Self {
            elements: self.elements << (dimension * levels),
            element_steps: self.element_steps.saturating_mul(factor),
            simulation_seconds,
            run_seconds,
        }
    }

    /// What to say about a number of refinements that was not asked for.
    #[must_use]
    pub(crate) fn refusal_of_levels(&self, levels: usize, long: Long) -> Option<String> {
        let way = long.way().filter(|_| self.is_long())?;
        let (work, took, most) =
            (short(self.element_steps as f64, 2), duration(self.run_seconds), short(MOST as f64, 1));
        Some(format!(
            "`levels` is {levels}, which makes {work} elements times steps in all, {took}; {way} allows more than \
             {most}, or give fewer levels"
        ))
    }

    /// Whether the run must be asked for.
    #[must_use]
    pub fn is_long(&self) -> bool {
        self.element_steps > MOST
    }

    /// What to say about the end of a run that was not asked for; `estimated` if its error is estimated beside it.
    #[must_use]
    pub fn refusal(&self, times: &TimeGrid, estimated: bool, long: Long) -> Option<String> {
        let way = long.way().filter(|_| self.is_long())?;
        let (steps, elements) = (counted(times.step_count(), "step"), counted(self.elements, "element"));
        let end = trimmed(times.end(), 4);
        let (seconds, what) = match estimated {
            true => (self.run_seconds, "simulation and estimate"),
            false => (self.simulation_seconds, "the simulation"),
        };
        let (took, most) = (duration(seconds), short(MOST as f64, 1));
        Some(format!(
            "is {end} s, which makes {steps} of {elements}, {took} for {what}: is it correct, and in seconds? \
             {way} allows more than {most} elements times steps"
        ))
    }
}

/// A duration in a suitable unit.
pub(crate) fn duration(seconds: f64) -> String {
    let units = [(86_400.0, "days"), (3600.0, "h"), (60.0, "min")];
    let found = units.iter().find(|(unit, _)| seconds >= 2.0 * unit);
    let (unit, name) = found.copied().unwrap_or((1.0, "s"));
    if seconds < 1.0 { "less than 1 s".to_string() } else { format!("about {} {name}", short(seconds / unit, 2)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_have_two_digits() {
        let shown = [0.2, 1.0, 90.0, 130.0, 7199.0, 7300.0, 1e6].map(duration);
        assert_eq!(
            shown,
            [
                "less than 1 s",
                "about 1.0 s",
                "about 90 s",
                "about 2.2 min",
                "about 120 min",
                "about 2.0 h",
                "about 12 days"
            ]
        );
    }
}
