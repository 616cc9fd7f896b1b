//! The files that a command will make, checked before any work is done for them.

use super::Console;
use crate::case::CaseOf;
use crate::failure::Failure;
use crate::report::number::bytes;
use crate::{history, picture, writable};
use percute_estimator::Options;
use percute_io::history::Writer;
use percute_io::{FileCause, FileError, Overwrite};
use std::path::Path;

/// A file to come.
#[derive(Clone, Copy, Debug)]
pub(super) struct Output<'a> {
    /// The argument or key that names it.
    pub(super) what: &'static str,
    pub(super) file: &'a Path,
}

/// A file from the command line, else from the case.
pub(super) fn chosen<'a>(
    [flag, key]: [&'static str; 2],
    given: Option<&'a Path>,
    stated: Option<&'a Path>,
) -> Option<Output<'a>> {
    let stated = stated.map(|file| Output { what: key, file });
    given.map(|file| Output { what: flag, file }).or(stated)
}

/// Makes sure that all files can be made, that no two of them are one, and that none is the input.
/// Only a picture may replace a file unless `force` says so.
pub(super) fn check(
    input: (&str, &Path),
    outputs: &[Option<Output<'_>>],
    picture: Option<&Path>,
    force: bool,
) -> Result<(), Failure> {
    let drawn = picture.map(|file| Output { what: "--picture", file });
    let all: Vec<Output<'_>> = outputs.iter().copied().chain([drawn]).flatten().collect();
    for (i, Output { what, file }) in all.iter().enumerate() {
        let shown = file.display();
        if writable::same(file, input.1) {
            return Err(Failure::Argument(format!("{what} {shown} is the {} itself", input.0)));
        }
        if let Some(other) = all[..i].iter().find(|other| writable::same(file, other.file)) {
            return Err(Failure::Argument(format!(
                "{what} {shown} is the file of {} too; give it another",
                other.what
            )));
        }
    }
    for Output { what, file } in outputs.iter().flatten() {
        if !force && file.exists() {
            let shown = file.display();
            return Err(Failure::Argument(format!(
                "{what} {shown}: the file exists already; give another name, or --force to replace it"
            )));
        }
        let fail =
            |cause: std::io::Error| Failure::Unwritable { what, file: file.to_path_buf(), cause: cause.to_string() };
        writable::check(file).map_err(fail)?;
    }
    picture.map_or(Ok(()), picture::check_path)
}

/// Whether files that are there may be replaced.
pub(super) fn overwrite(force: bool) -> Overwrite {
    if force { Overwrite::Replace } else { Overwrite::Refuse }
}

/// A file that somebody else has made since it was checked.
pub(super) fn taken(error: FileError) -> Failure {
    match error.cause {
        FileCause::Exists => Failure::Argument(format!("{error}; --force replaces it")),
        _ => error.into(),
    }
}

/// Makes the history file of a case and says how large it is.
pub(super) fn begin_history<const D: usize, const N: usize>(
    case: &CaseOf<D, N>,
    output: Output<'_>,
    force: bool,
    quiet: bool,
    console: &mut Console<'_>,
) -> Result<Writer<D>, Failure> {
    let plan = history::plan(&case.problem, &case.times, &case.options, Some(&case.source))?;
    let writer = plan.create(output.file, overwrite(force)).map_err(taken)?;
    if !quiet {
        console.say(&format!("history {}: {}", output.file.display(), bytes(plan.bytes())));
    }
    Ok(writer)
}

/// Options of a case or a history with what the command line says of them.
pub(super) fn with_work(options: Options, threads: Option<usize>, window: Option<usize>) -> Options {
    Options { threads, window, ..options }
}
