//! How a command makes its files.

use super::Console;
use crate::args::PrintArguments;
use percute_io::history::Writer;
use percute_io::{FileCause, FileError, Overwrite};
use percute_presentation::file;
use percute_workflow::Failure;
use percute_workflow::case::Case;
use percute_workflow::history;
use percute_workflow::message::bytes;
use percute_workflow::outputs::{self, OutputFile};
use std::path::Path;

/// Checks all files that a command makes, before any work.
pub(super) fn check(
    inputs: &[(&str, &Path)],
    outputs: &[Option<OutputFile<'_>>],
    print: Option<&PrintArguments>,
    force: bool,
) -> Result<(), Failure> {
    let (picture, page) = (print.and_then(picture), print.and_then(page));
    outputs::check(inputs, &[outputs, &[picture, page]].concat(), force)?;
    outputs::check_endings(outputs)?;
    picture.as_ref().map_or(Ok(()), |picture| file::picture(picture).map(drop))?;
    page.as_ref().map_or(Ok(()), file::page)
}

/// The picture to draw.
pub(super) fn picture(print: &PrintArguments) -> Option<OutputFile<'_>> {
    print.picture.as_deref().map(|file| OutputFile { what: "--picture", file })
}

/// The page to write.
pub(super) fn page(print: &PrintArguments) -> Option<OutputFile<'_>> {
    print.report.as_deref().map(|file| OutputFile { what: "report", file })
}

/// A file that was made since it was checked.
pub(super) fn taken(error: FileError) -> Failure {
    match error.cause {
        FileCause::Exists => {
            let file = error.path.display();
            Failure::Argument(format!("{file}: the file exists already; give another name, or --force to replace it"))
        }
        _ => error.into(),
    }
}

/// Makes the history file of a case and says how large it is.
pub(super) fn begin_history(
    case: &Case,
    output: OutputFile<'_>,
    force: bool,
    quiet: bool,
    console: &mut Console<'_>,
) -> Result<Writer, Failure> {
    let plan = history::plan(&case.problem, &case.times, &case.options, Some(&case.source), &case.output.keep)?;
    let writer = plan.create(output.file, Overwrite::allowed(force)).map_err(taken)?;
    if !quiet {
        console.say(&format!("history {}: {}", output.file.display(), bytes(plan.bytes())));
    }
    Ok(writer)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_is_there_has_one_remedy() {
        let told = taken(FileCause::Exists.at("a.vtkhdf".as_ref())).to_string();
        assert_eq!(told, "a.vtkhdf: the file exists already; give another name, or --force to replace it");
    }
}
