//! The summary of a simulation.

use super::Subject;
use super::build::problem_summary;
use super::summary::{body, drift, energy, layout, step};
use crate::deformation::StoredFlow;
use crate::message::{bytes, counted, short, trimmed};
use percute_core::dynamics::Simulation;
use std::path::Path;

/// The summary of a run that is not estimated, with the file of its history, the plastic flow at its end, and the time
/// it took (s).
#[must_use]
pub fn simulated(
    subject: &Subject<'_>,
    simulation: &Simulation,
    (file, flow): (&Path, Option<&StoredFlow>),
    seconds: f64,
) -> String {
    let (times, balance) = (subject.times, &simulation.balance);
    let (steps, planned) = (simulation.steps, times.step_count());
    let reached = trimmed(times.instants()[steps], 5);
    let time = match steps < planned {
        true => format!("INTERRUPTED at step {steps} of {planned}, t = {reached} s;"),
        false => format!("{reached} s in {};", counted(steps, "step")),
    };
    let size =
        std::fs::metadata(file).map_or_else(|_| "which is no longer there".to_string(), |found| bytes(found.len()));
    let (version, seconds) = (env!("CARGO_PKG_VERSION"), short(seconds, 3));
    let mut lines = vec![
        ("case", format!("{} (percute {version}, {seconds} s)", subject.name)),
        ("body", body(&problem_summary(subject))),
        ("time", time),
        ("", step(times.longest_step(), subject.critical_step)),
        ("energy", energy(balance, subject.problem.units())),
        ("drift", drift(balance)),
    ];
    lines.extend(flow.map(StoredFlow::line));
    lines.push(("history", format!("{}, {size}", file.display())));
    layout(&lines)
}
