//! `percute export`.

use super::Console;
use super::outputs::taken;
use crate::args::ExportArguments;
use crate::exit::{DONE, INTERRUPTED};
use crate::progress::Watch;
use percute_io::{Overwrite, estimate_file};
use percute_workflow::Failure;
use percute_workflow::choice::StepChoice;
use percute_workflow::export::{Export, Names, Request};
use percute_workflow::history::{lacks, open};
use percute_workflow::message::{counted, trimmed};

/// The most instants whose times are printed.
const FEW: usize = 6;

pub(super) fn command(arguments: &ExportArguments, console: &mut Console<'_>) -> Result<u8, Failure> {
    let stored = &open(&arguments.history)?;
    let ExportArguments { history, output, estimate, force, quiet, .. } = arguments;
    let error = estimate.as_deref().map(estimate_file::open).transpose()?.map(|file| file.by_element);
    let instants = if arguments.times.is_some() { "--times" } else { "--steps" };
    let names = Names { path: "--output", instants, fields: "--fields", estimate: "--estimate" };
    let request = Request {
        lacks: lacks(&stored.file),
        kept: stored.file.thinned_steps().map(|kept| kept.steps.clone()),
        names,
        steps: choice(arguments),
        fields: arguments.fields.clone(),
        error,
    };
    let source = stored.file.source(&stored.problem)?;
    let source = source.stored();
    let export = Export::new(&stored.problem, &source, output, &request)?;
    let mut inputs = vec![("history", history.as_path())];
    inputs.extend(estimate.as_deref().map(|file| ("estimate file", file)));
    export.check("--output", &inputs, *force)?;
    let watch = &mut Watch::new(console.progress && !quiet, console.stop);
    let written = export.write(Overwrite::allowed(*force), watch).map_err(|failure| match failure {
        Failure::File(error) => taken(error),
        other => other,
    })?;
    watch.clear();
    let Some(files) = written else {
        console.say("interrupted; no file was written");
        return Ok(INTERRUPTED);
    };
    let main = files.first().map(|file| file.display().to_string()).unwrap_or_default();
    let more = if files.len() > 1 { format!(" and {}", counted(files.len() - 1, "file")) } else { String::new() };
    let (instants, fields) = (counted(export.instants(), "instant"), export.fields().join(", "));
    // Those that were asked for by their times are the nearest ones.
    let times = if export.instants() <= FEW {
        let times: Vec<String> = export.times().map(|time| trimmed(time, 5)).collect();
        format!(" ({} s)", times.join(", "))
    } else {
        String::new()
    };
    console.print(&format!("wrote {main}{more}: {instants}{times}; {fields}"))?;
    Ok(DONE)
}

fn choice(arguments: &ExportArguments) -> StepChoice {
    match (&arguments.steps, arguments.every, &arguments.times) {
        (Some(steps), ..) => StepChoice::Steps(steps.clone()),
        (_, Some(every), _) => StepChoice::Every(every),
        (.., Some(times)) => StepChoice::Times(times.0.clone()),
        _ => StepChoice::All,
    }
}
