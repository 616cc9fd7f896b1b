//! The picture and the page of an estimate.

use super::Console;
use super::outputs::{page, picture, taken};
use crate::args::{PrintArguments, WorkArguments};
use percute_io::{Case, Overwrite};
use percute_presentation::picture::svg;
use percute_presentation::{Body, Contents, Document, Surface, file};
use percute_workflow::Failure;
use percute_workflow::message::bytes;

/// An estimate to show.
pub(super) struct Shown<'a> {
    pub(super) body: Body,
    pub(super) document: Document,
    pub(super) statement: String,
    pub(super) case: Option<&'a Case>,
    pub(super) surfaces: Vec<Surface>,
}

/// Writes the picture and the page, as far as they are wanted: each, whatever becomes of the other.
pub(super) fn present(
    shown: &Shown<'_>,
    print: &PrintArguments,
    work: &WorkArguments,
    console: &mut Console<'_>,
) -> Result<(), Failure> {
    let Shown { body, document, statement, case, surfaces } = shown;
    let overwrite = Overwrite::allowed(work.force);
    let drawn = picture(print)
        .map_or(Ok(()), |output| file::write_picture(&output, overwrite, &svg(body, document)).map_err(refused));
    let written = page(print).map_or(Ok(()), |output| {
        let about = &print.about;
        let contents = Contents { about, document, body, statement, case: *case, surfaces };
        let size = file::write_page(&output, overwrite, &contents).map_err(refused)?;
        if !work.quiet {
            console.say(&format!("report {}: {}", output.file.display(), bytes(size)));
        }
        Ok(())
    });
    console.first([drawn, written])
}

/// A file that appeared since it was checked.
pub(super) fn refused(failure: Failure) -> Failure {
    match failure {
        Failure::File(error) => taken(error),
        other => other,
    }
}
