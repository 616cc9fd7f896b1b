//! What adds up while forces act for long: a block that slides down a plane.

use super::super::parallel::{in_order, threads};
use super::{ATTEMPTS, PART};
use crate::reproduce::pack::sliding_block;
use crate::reproduce::table::{Cell, Column, Table};
use crate::reproduce::{Effort, ReproduceError, Section};
use percute_core::dynamics::simulate;
use percute_core::observer::Observer;
use percute_core::time::TimeGrid;
use percute_estimator::Estimator;
use percute_workflow::message::short;

/// Parts of the slide.
const PARTS: [f64; 3] = [0.25, 0.5, 1.0];

/// Computes the runs and adds text and table.
pub(super) fn add(section: &mut Section, effort: &Effort, observer: &mut dyn Observer) -> Result<(), ReproduceError> {
    let relative = in_order(PART.key, threads(effort.threads), &PARTS, observer, |&part, stop| errors(part, stop))?;
    let case = sliding_block()?;
    let seconds = PARTS.map(|part| format!("T = {} s", short(part * case.times.end(), 2)));
    let columns = std::iter::once(Column::new("attempt"))
        .chain(seconds.iter().map(|end| Column::new(end).unit("%").equation("[22]").digits(3)));
    let caption = "The relative error ε_mean of the block that slides down a tilted plane (case 6 of the pack), in runs of \
                   more and more steps.";
    let mut table = Table::new("tried-slide", caption, columns.collect());
    for (k, attempt) in ATTEMPTS.iter().enumerate() {
        let values = relative.iter().map(|errors| Cell::from(100.0 * errors[k]));
        table.push(std::iter::once(attempt.name.into()).chain(values));
    }
    section.heading("What adds up");
    section.text(format!(
        "A block slides down a plane for {} s, some {} times as long as a wave needs through its height. The energy of its motion grows \
         like the square of the time and its error does not, so that ε falls. Where ε stays, a force is missing that accelerates the \
         admissible fields as long as the block slides.",
        short(case.times.end(), 2),
        short(waves(&case), 2),
    ));
    section.table(table);
    Ok(())
}

/// How often a longitudinal wave goes through the height of the block.
fn waves(case: &percute_workflow::case::CaseOf<2, 3>) -> f64 {
    let height = case.problem.mesh().points().iter().fold(0.0_f64, |h, p| h.max(p[1]));
    case.times.end() * case.problem.materials()[0].wave_speed() / height
}

/// ε_mean of each attempt over the first part of the slide.
fn errors(part: f64, observer: &mut dyn Observer) -> Result<Vec<f64>, ReproduceError> {
    let case = sliding_block()?;
    let count = (part * case.times.step_count() as f64).round() as usize;
    let times = TimeGrid::from_instants(case.times.instants()[..=count].to_vec())?;
    let estimator = |attempt: &super::Attempt| Estimator::new(&case.problem, &times, attempt.options());
    let mut estimators = ATTEMPTS.iter().map(estimator).collect::<Result<Vec<_>, _>>()?;
    simulate(&case.problem, &times, &mut estimators, observer)?;
    estimators.into_iter().map(|estimator| Ok(estimator.finish()?.error.relative_mean)).collect()
}
