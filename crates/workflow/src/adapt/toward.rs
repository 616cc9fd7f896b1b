//! How far a run is from the target.

use super::iteration::Iteration;
use super::{Reason, Wish};
use crate::plan::{Basis, Branch, Plan};
use crate::quantity::{Judgement, Obstruction, Quantity, judge};

/// The mean error over that of the run that is aimed at on the way to the limit of a quantity: of graded meshes and
/// maps, about half the size where it matters.
const STEP: f64 = 0.6;
/// A uniform mesh becomes finer by this factor on this way.
const FINER: f64 = 2.0;

impl Wish {
    /// The mean error over that of a run, of which the plan for the next mesh is made.
    pub(super) fn wanted(&self, iteration: &Iteration, basis: &Basis) -> f64 {
        match (&self.on, basis.branch()) {
            (None, _) => self.target / iteration.error,
            (Some(_), Branch::Uniform) => FINER.powf(-Plan::exponents(basis).far),
            (Some(_), _) => STEP,
        }
    }

    /// Why the last of these runs ends the adaptation, if it does; `obstruction` may keep a quantity from converging.
    pub(super) fn end(&self, iterations: &[Iteration], obstruction: Option<&Obstruction>) -> Option<Reason> {
        let last = iterations.last()?;
        let (untrusted, is_last) = (!last.reasons.is_empty(), iterations.len() == self.runs);
        let Some(quantity) = &self.on else {
            let reached = last.error <= self.target;
            let earlier = &iterations[..iterations.len() - 1];
            let trusted = earlier.iter().any(|earlier| earlier.reasons.is_empty());
            let grows = earlier.last().is_some_and(|before| before.error < last.error);
            return match () {
                () if untrusted && (trusted || reached || grows) => Some(Reason::NotTrusted),
                () if reached => Some(Reason::Reached),
                () if is_last => Some(Reason::Runs),
                () => None,
            };
        };
        let (judgement, is_judged) = (judged(iterations), iterations.len() > 2);
        let has_no_limit = is_judged && obstruction.is_some_and(Obstruction::is_of_the_problem);
        match () {
            () if has_no_limit => Some(Reason::NoLimit(quantity.warning(&judgement, obstruction)?)),
            () if is_judged && is_within(&judgement, self.target) => Some(Reason::Reached),
            () if is_last => Some(Reason::Runs),
            () => None,
        }
    }
}

/// How the quantity of the target changes over the runs.
pub(super) fn judged(iterations: &[Iteration]) -> Judgement {
    let found = iterations.iter().filter_map(|run| Some((run.quantity?, run.sizes[0])));
    let (values, sizes): (Vec<f64>, Vec<f64>) = found.unzip();
    judge(&values, &sizes)
}

/// Whether the last change is within a tolerance and, where the differences have an order, the limit too.
fn is_within(judgement: &Judgement, tolerance: f64) -> bool {
    let within = |part: f64| part.abs() <= tolerance;
    judgement.change.is_some_and(within) && judgement.remaining.is_none_or(within) && judgement.converges != Some(false)
}

/// The sentence of a quantity that has no value.
pub(super) fn missing(quantity: &Quantity) -> String {
    format!(
        "the {} has no value: nothing touches, or a body is still in contact at the end; give a later end, or another \
         quantity",
        quantity.told()
    )
}
