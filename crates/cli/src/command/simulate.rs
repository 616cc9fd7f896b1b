//! `percute simulate`.

use super::outputs::begin_history;
use super::{Console, case};
use crate::args::SimulateArguments;
use crate::case::{Case, CaseOf};
use crate::failure::{DONE, Failure, INTERRUPTED};
use crate::outputs::{Output, check, chosen};
use crate::progress::Watch;
use crate::report::build::{balance_summary, problem_summary};
use crate::report::number::{bytes, short, trimmed};
use crate::report::reported;
use crate::report::summary::{body, drift, energy, layout, step};
use crate::run::simulate_only;
use percute_core::dynamics::Simulation;
use std::path::{Path, PathBuf};
use std::time::Instant;

pub(super) fn command(arguments: &SimulateArguments, console: &mut Console<'_>) -> Result<u8, Failure> {
    match case(&arguments.case)? {
        Case::Bar(case) => simulate(&case, arguments, console),
        Case::Plane(case) => simulate(&case, arguments, console),
    }
}

fn simulate<const D: usize, const N: usize>(
    case: &CaseOf<D, N>,
    arguments: &SimulateArguments,
    console: &mut Console<'_>,
) -> Result<u8, Failure> {
    let SimulateArguments { force, quiet, .. } = *arguments;
    let named = named_after(&arguments.case);
    let keys = ["--history", "[output] history"];
    let chosen = chosen(keys, arguments.history.as_deref(), case.output.history.as_deref());
    let history = chosen.unwrap_or(Output { what: "history", file: &named });
    check(&case.inputs(Some(&arguments.case)), &[Some(history)], None, force)?;
    console.plausibility_warning(case, quiet);
    if !quiet {
        console.warn(&reported(case.problem.mesh()).collect::<Vec<_>>());
    }
    let writer = begin_history(case, history, force, quiet, console)?;
    let watch = &mut Watch::new(console.progress && !quiet, console.interrupted);
    let start = Instant::now();
    let simulation = simulate_only(case, writer, watch)?;
    watch.clear();
    console.print(&summary(case, &simulation, history.file, start.elapsed().as_secs_f64()))?;
    Ok(if simulation.interrupted { INTERRUPTED } else { DONE })
}

/// The name of the case with another ending, in the working directory.
fn named_after(case: &Path) -> PathBuf {
    let mut name = case.file_stem().unwrap_or_default().to_os_string();
    name.push(".vtkhdf");
    name.into()
}

fn summary<const D: usize, const N: usize>(
    case: &CaseOf<D, N>,
    simulation: &Simulation,
    file: &Path,
    seconds: f64,
) -> String {
    let (times, balance) = (&case.times, balance_summary(&simulation.balance));
    let (steps, planned) = (simulation.steps, times.step_count());
    let reached = trimmed(times.instants()[steps], 5);
    let time = match steps < planned {
        true => format!("INTERRUPTED at step {steps} of {planned}, t = {reached} s;"),
        false => format!("{reached} s in {steps} steps;"),
    };
    let size = std::fs::metadata(file).map_or(0, |found| found.len());
    let (version, seconds) = (env!("CARGO_PKG_VERSION"), short(seconds, 3));
    layout(&[
        ("case", format!("{} (percute {version}, {seconds} s)", case.source.name())),
        ("body", body(&problem_summary(&case.subject()))),
        ("time", time),
        ("", step(times.longest_step(), case.critical_step)),
        ("energy", energy(&balance)),
        ("drift", drift(&balance)),
        ("history", format!("{}, {}", file.display(), bytes(size))),
    ])
}
