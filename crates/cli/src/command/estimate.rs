//! `percute estimate`.

use super::Console;
use super::outputs::{check, contact_recorder, with_work};
use super::result::{Given, give};
use super::run::{request, within};
use crate::args::EstimateArguments;
use crate::picture::Drawn;
use crate::progress::Watch;
use percute_core::each_dimension;
use percute_core::problem::Problem;
use percute_estimator::{Options, Request};
use percute_workflow::Failure;
use percute_workflow::history::{Stored, open};
use percute_workflow::outputs::Output;
use percute_workflow::report::Report;
use std::time::Instant;

pub(super) fn command(arguments: &EstimateArguments, console: &mut Console<'_>) -> Result<u8, Failure> {
    let output = arguments.output.as_deref().map(|file| Output { what: "--output", file });
    let picture = arguments.print.picture.as_deref();
    check(&[("history", &arguments.history)], &[output], picture, arguments.work.force)?;
    each_dimension!(open(&arguments.history)?, stored => estimate(&stored, output, arguments, console))
}

fn estimate<const D: usize, const N: usize>(
    stored: &Stored<D, N>,
    output: Option<Output<'_>>,
    arguments: &EstimateArguments,
    console: &mut Console<'_>,
) -> Result<u8, Failure>
where
    Problem<D, N>: Drawn,
{
    let EstimateArguments { maps, print, work, .. } = arguments;
    let options = with_work(options(stored.options, arguments), work.threads, work.window);
    let instants = maps.instants.clone().unwrap_or_default();
    let times = stored.file.times();
    within("--instants", &instants, times.end())?;
    let wanted = || Request { steps: instants.steps(times, options.every), fields: maps.fields };
    let request = request(output, "--output", maps, wanted)?;
    let watch = &mut Watch::new(console.progress && !work.quiet, console.interrupted);
    let start = Instant::now();
    let mut contact = contact_recorder(&stored.problem, times, output)?;
    let (simulation, estimate) = stored.estimate(options, &request, &mut contact, watch)?;
    watch.clear();
    let seconds = start.elapsed().as_secs_f64();
    let contact = contact.finish();
    let report = Report::new(&stored.subject(), options, &simulation, &estimate, &contact, seconds);
    let given = Given {
        problem: &stored.problem,
        options,
        case: stored.file.case().cloned(),
        estimate: &estimate,
        contact: &contact,
        report: &report,
        told: Vec::new(),
        interrupted: simulation.interrupted,
    };
    give(&given, print, output, work, console)
}

/// The options stored in the history, with those of the command line instead where there are any.
fn options(stored: Options, arguments: &EstimateArguments) -> Options {
    Options {
        reconstruction: arguments.reconstruction.unwrap_or(stored.reconstruction),
        acceleration: arguments.acceleration.unwrap_or(stored.acceleration),
        every: arguments.every.unwrap_or(stored.every),
        ..stored
    }
}
