//! What an estimate is made of.

use crate::run::Run;
use crate::{bridge, contact, errors};
use percute_core::contact_results::ContactResults;
use percute_core::dynamics::{Simulation, critical_time_step};
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;
use percute_estimator::{Estimate, Options};
use percute_io::estimate_file::EstimateContents;
use percute_io::{Case, Overwrite, estimate_file};
use percute_workflow::Failure;
use percute_workflow::case::statement;
use percute_workflow::deformation::Deformation;
use percute_workflow::foreign::Checked;
use percute_workflow::outline::Outline;
use percute_workflow::report::{Findings, Report, Subject, Warning, warnings_of};
use percute_workflow::run::Results;
use pyo3::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The layout of a pickle is that of the version that wrote it.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// An estimate, with what it is the estimate of.
pub(crate) struct BuiltEstimate {
    pub(crate) problem: AnyProblem,
    /// The instants planned.
    pub(crate) times: TimeGrid,
    pub(crate) options: Options,
    pub(crate) estimate: Estimate,
    pub(crate) report: ReportSource,
    /// What was found about a history of another program.
    pub(crate) checked: Option<Checked>,
    /// The case file that was run.
    pub(crate) case: Option<Case>,
    /// The warning of a run that was to end with the rebound, if contact did not end.
    pub(crate) unended: Option<Warning>,
}

/// Where the report comes from.
pub(crate) enum ReportSource {
    /// It is made when it is asked for.
    Now {
        /// What the simulation did.
        simulation: Simulation,
        /// What contact did.
        contact: Arc<ContactResults>,
        /// The outline of a plane body at the last step.
        outline: Option<Box<Outline>>,
        /// The deformation and the stress.
        deformation: Box<Deformation>,
        /// Number of instants, of a stored history.
        held: Option<usize>,
        /// How long the estimate took (s).
        seconds: f64,
    },
    /// It was made before: its text.
    Before(String),
}

impl BuiltEstimate {
    /// An estimate from its state.
    pub(crate) fn restored(py: Python<'_>, problem: &AnyProblem, state: &[u8]) -> PyResult<Self> {
        let refused =
            || errors::percute_error(py, "the estimate was pickled by another version of percute, or is damaged");
        type State = (Vec<f64>, Options, Estimate, String);
        let (version, rest) = postcard::take_from_bytes::<&str>(state).map_err(|_| refused())?;
        if version != VERSION {
            return Err(refused());
        }
        let (times, options, estimate, report) = postcard::from_bytes::<State>(rest).map_err(|_| refused())?;
        let times = TimeGrid::from_instants(times).map_err(|_| refused())?;
        Ok(Self {
            problem: problem.clone(),
            times,
            options,
            estimate,
            report: ReportSource::Before(report),
            checked: None,
            case: None,
            unended: None,
        })
    }

    /// The state of the estimate, with its report.
    pub(crate) fn state(&self, report: &str) -> Result<Vec<u8>, postcard::Error> {
        let Self { times, options, estimate, .. } = self;
        postcard::to_stdvec(&(VERSION, times.instants(), options, estimate, report))
    }

    /// The estimate of a run, or of a stored history with `held` instants, that took so many seconds.
    pub(crate) fn new(
        problem: AnyProblem,
        times: TimeGrid,
        options: Options,
        results: Results,
        held: Option<usize>,
        seconds: f64,
    ) -> Self {
        let Results { simulation, estimate, contact, deformation, outline } = results;
        let (contact, outline, deformation) = (Arc::new(contact), outline.map(Box::new), Box::new(deformation));
        let report = ReportSource::Now { simulation, contact, outline, deformation, held, seconds };
        let (checked, case, unended) = (None, None, None);
        let options = options.filled(problem.dimension());
        Self { problem, times, options, estimate, report, checked, case, unended }
    }

    /// The document of `percute run --json`.
    pub(crate) fn report(&self, name: &str) -> Result<String, String> {
        self.document(name, Report::to_json)
    }

    /// The same for files.
    pub(crate) fn stored_report(&self, name: &str) -> Result<String, String> {
        self.document(name, Report::to_stored_json)
    }

    /// Warnings that only the result shows, and those that a run is told of before; none if the report was made before.
    pub(crate) fn warnings(&self) -> [Vec<Warning>; 2] {
        let Self { problem, times, options, estimate, report, checked, unended, .. } = self;
        let ReportSource::Now { simulation, contact, deformation, held, .. } = report else {
            return Default::default();
        };
        // Equal steps need no critical step.
        let critical_step = if times.varies() { critical_time_step(problem) } else { f64::NAN };
        let (name, held, checked, unended) = ("", *held, checked.as_ref(), unended.as_ref());
        let subject = Subject { name, problem, times, critical_step, held, checked, unended };
        warnings_of(&subject, *options, Findings { simulation, estimate, contact, deformation, outline: None })
    }

    /// A document made from the report; if that is there as a text only, this text, which has all of it.
    pub(crate) fn document(
        &self,
        name: &str,
        text: fn(&Report) -> Result<String, std::io::Error>,
    ) -> Result<String, String> {
        let Self { problem, times, options, estimate, report, checked, unended, .. } = self;
        match report {
            ReportSource::Before(text) => Ok(text.clone()),
            ReportSource::Now { simulation, contact, outline, deformation, held, seconds } => {
                let critical_step = critical_time_step(problem);
                let (held, checked, unended) = (*held, checked.as_ref(), unended.as_ref());
                let subject = Subject { name, problem, times, critical_step, held, checked, unended };
                let outline = outline.as_deref();
                let findings = Findings { simulation, estimate, contact, deformation, outline };
                let report = Report::new(&subject, *options, findings, *seconds);
                text(&report).map_err(|error| error.to_string())
            }
        }
    }

    fn save(
        &self,
        path: &Path,
        overwrite: Overwrite,
        name: &str,
        contact: Option<&ContactResults>,
    ) -> Result<(), Failure> {
        let Self { problem, estimate, case, .. } = self;
        let (report, case) = (&self.stored_report(name).map_err(Failure::Argument)?, case.as_ref());
        let statement = &statement(problem, Some(&self.options))?;
        let contents = EstimateContents { problem, estimate, contact, statement, case, report };
        Ok(estimate_file::write(path, overwrite, &contents)?)
    }

    /// The contact results of all nodes at all instants, its own or those of its history if that is there.
    pub(crate) fn contact_steps(
        &self,
        py: Python<'_>,
        history: Option<&Arc<Run>>,
    ) -> PyResult<Option<Arc<ContactResults>>> {
        match &self.report {
            ReportSource::Now { contact, .. } if contact.steps.is_some() => Ok(Some(contact.clone())),
            _ => history.map(|run| contact::of_run(py, run)).transpose(),
        }
    }

    /// Writes an estimate file, with the contact results of its history if that is there.
    pub(crate) fn saved(
        self: &Arc<Self>,
        py: Python<'_>,
        path: PathBuf,
        overwrite: Overwrite,
        name: String,
        history: Option<&Arc<Run>>,
    ) -> PyResult<()> {
        let contact = self.contact_steps(py, history)?;
        let built = self.clone();
        let work = move |_| built.save(&path, overwrite, &name, contact.as_deref());
        bridge::blocking(py, None, work)?.map_err(|error| errors::failure(py, &error))
    }
}
