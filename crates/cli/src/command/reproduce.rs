//! `percute reproduce`.

use super::Console;
use crate::args::ReproduceArguments;
use crate::exit::{DONE, INTERRUPTED};
use crate::progress::Watch;
use crate::reproduce::{Effort, PARTS, ReproduceError, Reproduction, parts};
use percute_workflow::Failure;

pub(super) fn command(arguments: &ReproduceArguments, console: &mut Console<'_>) -> Result<u8, Failure> {
    reproduce(arguments, console).or_else(|error| match error {
        ReproduceError::Failure(failure) => Err(*failure),
        error => {
            console.say(&format!("error: {error}"));
            Ok(error.exit_code())
        }
    })
}

fn reproduce(arguments: &ReproduceArguments, console: &mut Console<'_>) -> Result<u8, ReproduceError> {
    if arguments.list {
        let width = PARTS.iter().map(|part| part.key.len()).max().unwrap_or(0);
        let line = |part: &crate::reproduce::Part| format!("{:width$}  {}", part.key, part.title);
        console.print(&PARTS.iter().map(line).collect::<Vec<_>>().join("\n"))?;
        return Ok(DONE);
    }
    let parts = parts(&arguments.parts)?;
    let effort = Effort { small: arguments.small, threads: arguments.threads };
    let mut reproduction = Reproduction::begin(&arguments.output, effort, arguments.force).map_err(refused)?;
    let watch = &mut Watch::parts(console.progress && !arguments.quiet, console.interrupted);
    let mut code = DONE;
    for (k, part) in parts.iter().enumerate() {
        match reproduction.make(part, watch) {
            Ok(()) => {}
            Err(ReproduceError::Interrupted) => {
                code = INTERRUPTED;
                break;
            }
            Err(error) => return Err(error),
        }
        watch.clear();
        if !arguments.quiet {
            console.say(&format!("{} of {} parts done: {}", k + 1, parts.len(), part.title));
        }
    }
    watch.clear();
    if reproduction.sections().is_empty() {
        console.say("interrupted: no part is done");
        return Ok(code);
    }
    let cut = if code == INTERRUPTED { ", INTERRUPTED" } else { "" };
    let done = reproduction.sections().len();
    console.print(&format!("{}: {done} of {} parts{cut}", reproduction.page().display(), parts.len()))?;
    Ok(code)
}

/// Says how a folder that is in use is taken all the same.
fn refused(error: ReproduceError) -> ReproduceError {
    match error {
        ReproduceError::NotEmpty { .. } => Failure::Argument(format!("--output: {error} with --force")).into(),
        other => other,
    }
}
