//! `percute estimate`.

use super::Console;
use super::outputs::check;
use super::result::{Finished, give};
use super::run::{request, within};
use crate::args::EstimateArguments;
use crate::progress::Watch;
use percute_estimator::{EstimateError, Options, Request};
use percute_workflow::Failure;
use percute_workflow::grade::Graded;
use percute_workflow::history::{Stored, open};
use percute_workflow::outputs::OutputFile;
use percute_workflow::report::Subject;
use percute_workflow::run::Analysis;
use percute_workflow::tables::Destination;
use std::time::Instant;

pub(super) fn command(arguments: &EstimateArguments, console: &mut Console<'_>) -> Result<u8, Failure> {
    let output = arguments.output.as_deref().map(|file| OutputFile { what: "--output", file });
    check(&[("history", &arguments.history)], &[output], Some(&arguments.print), arguments.work.force)?;
    let inputs = &[("history", arguments.history.as_path())];
    let tables =
        arguments.print.csv.as_deref().map(|path| Destination::check("--csv", path, inputs, arguments.work.force));
    let tables = tables.transpose()?;
    estimate(&open(&arguments.history)?, output, tables, arguments, console)
}

fn estimate(
    stored: &Stored,
    output: Option<OutputFile<'_>>,
    tables: Option<Destination>,
    arguments: &EstimateArguments,
    console: &mut Console<'_>,
) -> Result<u8, Failure> {
    let EstimateArguments { maps, print, work, .. } = arguments;
    print.about.check(stored.origin().is_some()).map_err(Failure::Argument)?;
    let options = options(stored.options, arguments);
    let instants = maps.instants.clone().unwrap_or_default();
    let times = stored.file.times();
    within("--instants", &instants, times.end())?;
    let wanted = || Request { steps: instants.steps(times, options.every.stride()), fields: maps.fields };
    let request = request(output, "--output", maps, wanted)?;
    let watch = &mut Watch::new(console.progress && !work.quiet, console.stop);
    let start = Instant::now();
    let analysis = Analysis { options, request, contact_steps: output.is_some() || print.report.is_some() };
    let graded = stored.estimate(&analysis, arguments.accept_inconsistent, watch);
    let Graded { results, times, checked } = match graded {
        Err(Failure::History {
            cause: error @ (EstimateError::TooFewSteps { .. } | EstimateError::Stopped), ..
        }) if console.stop.is_asked() => {
            return Ok(console.interrupted_early(&error));
        }
        other => other?,
    };
    watch.clear();
    let (case, seconds) = (stored.file.case().cloned(), start.elapsed().as_secs_f64());
    let subject = Subject { times: &times, checked: checked.as_ref(), ..stored.subject() };
    give(&Finished { subject, options, case, results, seconds, told: Vec::new(), tables }, print, output, work, console)
}

/// The options stored in the history, with those of the command line instead where there are any.
fn options(stored: Options, arguments: &EstimateArguments) -> Options {
    Options {
        reconstruction: arguments.reconstruction.unwrap_or(stored.reconstruction),
        acceleration: arguments.acceleration.or(stored.acceleration),
        every: arguments.every.unwrap_or(stored.every),
        threads: arguments.work.threads,
        window: arguments.work.window,
        ..stored
    }
}
