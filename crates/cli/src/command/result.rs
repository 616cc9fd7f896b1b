//! What a run and the estimate of a history have in common: report, picture, estimate file.

use super::Console;
use super::outputs::taken;
use super::present::{Shown, present};
use crate::args::{PrintArguments, WorkArguments};
use crate::exit::{DONE, INTERRUPTED};
use percute_estimator::Options;
use percute_io::estimate_file::EstimateContents;
use percute_io::{Case, Overwrite, estimate_file};
use percute_presentation::{Body, Document, Surface};
use percute_workflow::Failure;
use percute_workflow::case::statement;
use percute_workflow::outputs::OutputFile;
use percute_workflow::report::{Report, Subject, summary};
use percute_workflow::run::Results;
use percute_workflow::tables::{self, Destination};

/// An estimated run or history, ready for its report.
pub(super) struct Finished<'a> {
    pub(super) subject: Subject<'a>,
    pub(super) options: Options,
    pub(super) case: Option<Case>,
    pub(super) results: Results,
    /// Duration of the work (s).
    pub(super) seconds: f64,
    /// Names of the warnings that were printed before the work.
    pub(super) told: Vec<&'static str>,
    /// The place of the tables, if they are wanted.
    pub(super) tables: Option<Destination>,
}

/// Makes the report; prints the warnings and the result, draws the picture and stores the estimate file.
pub(super) fn give(
    finished: &Finished<'_>,
    print: &PrintArguments,
    stored: Option<OutputFile<'_>>,
    work: &WorkArguments,
    console: &mut Console<'_>,
) -> Result<u8, Failure> {
    let Finished { subject, options, results, seconds, told, .. } = finished;
    let report = &Report::new(subject, *options, results.findings(), *seconds);
    if !work.quiet {
        console.warn(report.warnings.iter().filter(|warning| !told.contains(&warning.name)));
    }
    // Of a million elements it has 17 MB.
    let wanted = stored.is_some() || print.picture.is_some() || print.report.is_some();
    let json = wanted.then(|| report.to_stored_json()).transpose()?;
    // The result first, and one file after the other: what cannot be written must not cost the rest.
    let printed = console.print(&if print.json { report.to_json()? } else { summary(report) });
    let json = json.as_deref();
    let stored = stored.zip(json).map_or(Ok(()), |(output, json)| store(finished, json, output, work.force));
    let tables = tabulate(finished, work.force);
    let shown = json.map_or(Ok(()), |json| show(finished, json, print, work, console));
    console.first([printed, stored, tables, shown])?;
    Ok(if results.interrupted() { INTERRUPTED } else { DONE })
}

/// Draws the picture and writes the page, as far as they are wanted.
fn show(
    finished: &Finished<'_>,
    json: &str,
    print: &PrintArguments,
    work: &WorkArguments,
    console: &mut Console<'_>,
) -> Result<(), Failure> {
    if print.picture.is_none() && print.report.is_none() {
        return Ok(());
    }
    let Finished { subject, options, case, results, .. } = finished;
    let document = Document::parse(json).map_err(|error| Failure::Argument(error.to_string()))?;
    let shown = Shown {
        body: Body::new(subject.problem.mesh()),
        statement: statement(subject.problem, Some(&options.filled(subject.problem.dimension())))?,
        case: case.as_ref(),
        surfaces: Surface::all(&results.contact, &document),
        document,
    };
    present(&shown, print, work, console)
}

/// Writes the tables, if they are wanted.
fn tabulate(finished: &Finished<'_>, force: bool) -> Result<(), Failure> {
    let Some(tables) = &finished.tables else { return Ok(()) };
    let Results { simulation, estimate, contact, .. } = &finished.results;
    let problem = finished.subject.problem;
    let (mesh, contact, units) = (problem.mesh(), Some(contact), problem.units());
    let (balance, error) = (&simulation.balance_over_time[..], &estimate.over_time[..]);
    let results = tables::TableResults { mesh, contact, units, balance, error, by_element: &estimate.by_element };
    tables.write(&results, Overwrite::allowed(force))
}

fn store(finished: &Finished<'_>, json: &str, output: OutputFile<'_>, force: bool) -> Result<(), Failure> {
    let Finished { subject: Subject { problem, .. }, options, case, results, .. } = finished;
    let statement = statement(problem, Some(&options.filled(problem.dimension())))?;
    let Results { estimate, contact, .. } = results;
    let (case, contact) = (case.as_ref(), Some(contact));
    let contents = EstimateContents { problem, estimate, contact, statement: &statement, case, report: json };
    estimate_file::write(output.file, Overwrite::allowed(force), &contents).map_err(taken)
}
