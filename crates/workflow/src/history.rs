//! Histories in files: with the statement of their problem in the language of the case files.

use crate::case::{CaseError, Keep, NotRepresentable, Source, problem_from, statement};
use crate::deformation::StoredFlow;
use crate::failure::Failure;
use crate::foreign::{Derived, Lacks, Origin, REVERSED, runs_backwards};
use crate::grade::{self, Graded};
use crate::report::Subject;
use crate::run::{self, Analysis};
use percute_core::contact_results::{ContactRecorder, ContactResults};
use percute_core::dynamics::{Balance, critical_time_step};
use percute_core::observer::Observer;
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;
use percute_estimator::{EstimateError, Options, RunError};
use percute_io::history::{HistoryFile, Plan};
use percute_io::{Case, FileError};
use std::path::Path;

/// The file that will hold the history of a problem, with the options that its estimate takes unless
/// told otherwise, the case file that it came from, and the part of the run that it keeps.
///
/// # Errors
/// A problem that the language of the case files cannot say.
pub fn plan<'p>(
    problem: &'p AnyProblem,
    times: &'p TimeGrid,
    options: &Options,
    case: Option<&Source>,
    keep: &Keep,
) -> Result<Plan<'p>, NotRepresentable> {
    let case = case.map(stored_case);
    Ok(Plan::new(problem, times, &statement(problem, Some(options))?, case.as_ref()).keeping(keep.of(times)))
}

/// A case file as it is stored in others.
#[must_use]
pub fn stored_case(source: &Source) -> Case {
    Case { name: source.name().to_string(), text: source.text().to_string() }
}

/// A history in a file, with its problem.
#[derive(Clone, Debug)]
pub struct Stored {
    /// The file.
    pub file: HistoryFile,
    /// The problem that was simulated.
    pub problem: AnyProblem,
    /// Options of the estimate, from the same statement.
    pub options: Options,
    /// The name of the file, as it was given.
    pub name: String,
}

/// Opens a history and reads the statement of its problem. Its steps stay in the file.
///
/// # Errors
/// A file that is no history or is damaged; a statement with a mistake, with its line.
pub fn open(path: &Path) -> Result<Stored, Failure> {
    Stored::new(percute_io::history::open(path)?, path)
}

/// The fields that a thinned history lacks; none for one with all steps, from which all fields follow.
#[must_use]
pub fn lacks(file: &HistoryFile) -> Option<Vec<&'static str>> {
    file.thinned_steps()?;
    let [velocity, acceleration] = file.stored();
    let there = [("velocity", velocity), ("acceleration", acceleration), ("reaction", !file.lacks_reactions())];
    Some(there.into_iter().filter(|(_, there)| !there).map(|(name, _)| name).collect())
}

/// Whether the end of a history of another program fits its initial velocity, backwards.
fn backwards(file: &HistoryFile) -> bool {
    let (count, nodal) = (file.count(), file.dimension() * file.mesh().node_count());
    if !file.is_foreign() || count < 2 {
        return false;
    }
    let dt = file.times().step(count - 2);
    let last = file.displacement(count - 2..count);
    last.is_ok_and(|last| runs_backwards([&last[..nodal], &last[nodal..]], dt, file.initial_velocity()))
}

fn reversed(error: CaseError) -> CaseError {
    CaseError { message: format!("{}. Likely cause: {REVERSED}", error.message), ..error }
}

impl Stored {
    pub(crate) fn new(file: HistoryFile, path: &Path) -> Result<Self, Failure> {
        let name = path.display().to_string();
        let source = Source::new(format!("{name}, statement of the problem"), file.statement());
        let (u, v) = (file.initial_displacement().to_vec(), file.initial_velocity().to_vec());
        let read = problem_from(&source, file.mesh(), u, v);
        let (problem, options) = read.map_err(|error| if backwards(&file) { reversed(error) } else { error })?;
        if problem.yields() && file.variables() == 0 {
            let told = "a material of this history yields, but the file has no internal variables \
                        (`VTKHDF/CellData/plastic`); leave `tangent` or `hardening` out of its statement, or simulate \
                        with percute";
            return Err(Failure::Argument(format!("{name}: {told}")));
        }
        Ok(Self { file, problem, options, name })
    }

    /// The plastic flow at its last instant; none where no material yields, or of a history without instants.
    ///
    /// # Errors
    /// Internal variables that cannot be read.
    pub fn flow(&self) -> Result<Option<StoredFlow>, FileError> {
        let Some(last) = self.file.count().checked_sub(1).filter(|_| self.problem.yields()) else { return Ok(None) };
        let (time, internal) = (self.file.times().instants()[last], self.file.plastic(last..last + 1)?);
        Ok(StoredFlow::new(&self.problem, time, &internal))
    }

    /// Where it comes from; none if percute simulated it.
    #[must_use]
    pub fn origin(&self) -> Option<Origin> {
        if !self.file.is_foreign() {
            return None;
        }
        let [reaction, touching] = self.file.supplied_contact().map(|given| !given);
        let file = Some(self.file.path().to_path_buf());
        let program = self.file.simulated_by().map(str::to_string);
        let derived = self.file.derived().iter().filter_map(|name| Derived::of_name(name)).collect();
        Some(Origin { program, file, lacks: Lacks { reaction, touching }, derived, accept: false })
    }

    /// What a report on it is about: computes the critical step, which takes a while on a large mesh and
    /// which only reports need.
    #[must_use]
    pub fn subject(&self) -> Subject<'_> {
        let Self { file, problem, name, .. } = self;
        let critical_step = critical_time_step(problem);
        let (times, held) = (file.times(), Some(file.count()));
        Subject { name, problem, times, critical_step, held, checked: None, unended: None }
    }

    /// Contact results, without those of all nodes at all instants, and energies and works at each step.
    ///
    /// # Errors
    /// A step that cannot be read or does not fit.
    pub fn results(&self) -> Result<(ContactResults, Vec<Balance>), Failure> {
        let source = self.file.source(&self.problem)?;
        let unread = |cause| Failure::from_sink(cause, RunError::Source);
        let contact = ContactRecorder::new(&self.problem, self.file.times()).replay(&source).map_err(unread)?;
        Ok((contact, run::balance(&self.problem, &source).map_err(unread)?))
    }

    /// Analyses the steps that the file holds. A history of another program is completed and checked before; `accept`
    /// an inconsistent one.
    ///
    /// # Errors
    /// As [`grade::estimate`].
    pub fn estimate(&self, analysis: &Analysis, accept: bool, observer: &mut dyn Observer) -> Result<Graded, Failure> {
        self.file.expect_all()?;
        let source = self.file.source(&self.problem)?;
        let origin = self.origin().map(|origin| Origin { accept, ..origin });
        let done = match origin {
            Some(origin) => grade::estimate(&self.problem, &source, &origin, analysis, observer),
            None => run::estimate(&self.problem, &source, analysis, observer).map(|results| Graded {
                results,
                times: self.file.times().clone(),
                checked: None,
            }),
        };
        done.map_err(|failure| match failure {
            // The history is good.
            failure @ Failure::Run(RunError::Estimate(EstimateError::Scratch(_))) => failure,
            Failure::Run(RunError::Estimate(cause)) => Failure::History { file: self.file.path().to_path_buf(), cause },
            other => other,
        })
    }
}
