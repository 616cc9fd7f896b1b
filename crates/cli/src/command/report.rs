//! `percute report`.

use super::outputs::check;
use super::present::{Shown, present};
use super::{Console, estimate, run};
use crate::args::{EstimateArguments, PrintArguments, ReportArguments, RunArguments, WorkArguments};
use crate::exit::DONE;
use percute_io::{Kind, estimate_file, is_hdf5, is_vtkhdf_name, kind};
use percute_presentation::{About, Body, Document, Surface};
use percute_workflow::Failure;
use std::path::{Path, PathBuf};

pub(super) fn command(arguments: &ReportArguments, console: &mut Console<'_>) -> Result<u8, Failure> {
    let ReportArguments { file, page, output, title, author, program, accept_inconsistent, work } = arguments;
    let page = page.clone().or_else(|| output.clone()).unwrap_or_else(|| named_after(file));
    let about = About { title: title.clone(), author: author.clone(), program: program.clone() };
    let (print, work) = (PrintArguments { report: Some(page), about, ..PrintArguments::default() }, work.clone());
    // A file that cannot be read is refused by the reader of histories or of cases, which says what it can of it.
    if !is_hdf5(file).unwrap_or(false) && !is_vtkhdf_name(file) {
        let case = file.clone();
        print.about.check(false).map_err(Failure::Argument)?;
        return run::command(&RunArguments { case, print, work, ..RunArguments::default() }, console);
    }
    if kind(file)? == Kind::Estimate {
        return stored(file, &print, &work, console);
    }
    let (history, accept_inconsistent) = (file.clone(), *accept_inconsistent);
    let arguments = EstimateArguments { history, print, work, accept_inconsistent, ..EstimateArguments::default() };
    estimate::command(&arguments, console)
}

/// The page of an estimate file, which holds all that it needs.
fn stored(file: &Path, print: &PrintArguments, work: &WorkArguments, console: &mut Console<'_>) -> Result<u8, Failure> {
    check(&[("estimate", file)], &[], Some(print), work.force)?;
    let found = estimate_file::open(file)?;
    let contact = estimate_file::contact(file)?;
    let unusable = |error| Failure::Argument(format!("{}: {error}", file.display()));
    let document = Document::parse(&found.report).map_err(unusable)?;
    print.about.fits(&document).map_err(Failure::Argument)?;
    let surfaces = |contact| Surface::all(&contact, &document);
    let surfaces = contact.map_or_else(Vec::new, surfaces);
    let (body, statement) = (Body::new(&found.mesh), found.statement);
    let shown = Shown { body, document, statement, case: found.case.as_ref(), surfaces };
    present(&shown, print, work, console)?;
    Ok(DONE)
}

/// The name of the file with another ending, in the working directory.
fn named_after(file: &Path) -> PathBuf {
    let mut name = file.file_stem().unwrap_or_default().to_os_string();
    name.push(".html");
    name.into()
}
