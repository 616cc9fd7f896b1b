//! What a run and the estimate of a history have in common: report, picture, estimate file.

use super::Console;
use super::outputs::taken;
use crate::args::{PrintArguments, WorkArguments};
use crate::exit::{DONE, INTERRUPTED};
use crate::picture::{self, Drawn};
use percute_core::contact::ContactResults;
use percute_core::problem::Problem;
use percute_estimator::{Estimate, Options};
use percute_io::estimate_file::EstimateContents;
use percute_io::{Case, Overwrite, estimate_file};
use percute_workflow::Failure;
use percute_workflow::case::statement;
use percute_workflow::outputs::Output;
use percute_workflow::report::{Report, summary};

/// What is to be given to the user.
pub(super) struct Given<'a, const D: usize, const N: usize> {
    pub(super) problem: &'a Problem<D, N>,
    pub(super) options: Options,
    pub(super) case: Option<Case>,
    pub(super) estimate: &'a Estimate<D>,
    pub(super) contact: &'a ContactResults<D>,
    pub(super) report: &'a Report,
    /// Names of the warnings that were told before the work.
    pub(super) told: Vec<&'static str>,
    pub(super) interrupted: bool,
}

/// Warns, prints, draws and stores.
pub(super) fn give<const D: usize, const N: usize>(
    given: &Given<'_, D, N>,
    print: &PrintArguments,
    stored: Option<Output<'_>>,
    work: &WorkArguments,
    console: &mut Console<'_>,
) -> Result<u8, Failure>
where
    Problem<D, N>: Drawn,
{
    let report = given.report;
    if !work.quiet {
        console.warn(report.warnings.iter().filter(|warning| !given.told.contains(&warning.name)));
    }
    let json = report.to_json()?;
    // The result first: a file that cannot be written must not cost it.
    console.print(&if print.json { json.clone() } else { summary(report) })?;
    if let Some(file) = &print.picture {
        picture::write(given.problem, report, file)?;
    }
    if let Some(output) = stored {
        store(given, &json, output, work.force)?;
    }
    Ok(if given.interrupted { INTERRUPTED } else { DONE })
}

fn store<const D: usize, const N: usize>(
    given: &Given<'_, D, N>,
    json: &str,
    output: Output<'_>,
    force: bool,
) -> Result<(), Failure> {
    let Given { problem, estimate, contact, .. } = *given;
    let statement = statement(problem, Some(&given.options))?;
    let (case, contact) = (given.case.as_ref(), Some(contact));
    let contents = EstimateContents { problem, estimate, contact, statement: &statement, case, report: json };
    estimate_file::write(output.file, Overwrite::allowed(force), &contents).map_err(taken)
}
