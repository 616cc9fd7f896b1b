//! Exports: fields of chosen steps of a history for ParaView and other programs.

mod quantity;

use crate::choice::StepChoice;
use crate::failure::Failure;
use crate::outputs::{self, OutputFile};
use crate::run;
use crate::step_filter::StepFilter;
use percute_core::history::{SinkError, Step, StepSource};
use percute_core::observer::{Observer, Progress};
use percute_core::problem::AnyProblem;
use percute_io::export::{Contents, ExportWriter, Format};
use percute_io::{FileError, Overwrite};
use quantity::{ExportRows, quantities};
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Names of the options or arguments of a request, for messages.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs)]
pub struct Names {
    pub path: &'static str,
    pub instants: &'static str,
    pub fields: &'static str,
    pub estimate: &'static str,
}

/// A request for an export.
#[derive(Clone, Debug)]
pub struct Request {
    /// Its names.
    pub names: Names,
    /// Its steps.
    pub steps: StepChoice,
    /// Names of its fields; by default displacement, velocity, reaction, stress and von Mises stress, and the error if
    /// there is an estimate.
    pub fields: Option<Vec<String>>,
    /// Of a thinned history, the fields that it lacks; `source` then gives its stored steps.
    pub lacks: Option<Vec<&'static str>>,
    /// Of a thinned history, the step of each instant in its run.
    pub kept: Option<Vec<usize>>,
    /// e_E of each element (J^½), eq. \[20\], of an estimate.
    pub error: Option<Vec<f64>>,
}

impl Request {
    /// What the numbers of steps mean, if the history is thinned.
    fn counted(&self, held: &[f64]) -> String {
        let last = held.len().saturating_sub(1);
        let step = self.kept.as_ref().and_then(|kept| kept.get(last)).filter(|step| **step != last);
        let (StepChoice::Steps(_), Some(step)) = (&self.steps, step) else {
            return String::new();
        };
        format!(
            ". The history keeps a part of its run, and its own instants are counted: {last} is step {step} of the \
             run; choose by times instead, if the numbers are those of the run"
        )
    }
}

/// An export that can be written.
pub struct Export<'a> {
    problem: &'a AnyProblem,
    source: &'a dyn StepSource,
    path: &'a Path,
    format: Format,
    rows: ExportRows<'a>,
    instants: Vec<(usize, f64)>,
    /// Whether velocities and accelerations follow from the scheme.
    by_scheme: bool,
}

impl<'a> Export<'a> {
    /// Checks a request.
    ///
    /// # Errors
    /// A name without a known ending, a step or time after the last, an unknown field, an estimate of another mesh.
    pub fn new(
        problem: &'a AnyProblem,
        source: &'a dyn StepSource,
        path: &'a Path,
        request: &Request,
    ) -> Result<Self, Failure> {
        let wrong = |told: String| Failure::Argument(told);
        let format =
            Format::of(path).map_err(|error| wrong(format!("{} {}: {error}", request.names.path, path.display())))?;
        let held = &source.times().instants()[..source.count()];
        if held.is_empty() {
            return Err(wrong("the history holds no step yet".to_string()));
        }
        let steps = request.steps.of(held);
        let steps =
            steps.map_err(|told| wrong(format!("{}: {told}{}", request.names.instants, request.counted(held))))?;
        if steps.is_empty() {
            return Err(wrong(format!("{}: no step is chosen; name at least one", request.names.instants)));
        }
        let quantities = quantities(request, problem.yields())?;
        let error = request.error.clone().unwrap_or_default();
        let (given, needed) = (error.len(), problem.mesh().element_count());
        if request.error.is_some() && given != needed {
            let told = format!(
                "the estimate has {given} elements, but the history has {needed}; take the estimate of this history"
            );
            return Err(wrong(told));
        }
        let instants = steps.into_iter().map(|step| (step, held[step])).collect();
        Ok(Self {
            problem,
            source,
            path,
            format,
            rows: ExportRows { problem, quantities, error },
            instants,
            by_scheme: request.lacks.is_none(),
        })
    }

    /// The files, first the one to open.
    #[must_use]
    pub fn files(&self) -> Vec<PathBuf> {
        let steps: Vec<usize> = self.instants.iter().map(|(step, _)| *step).collect();
        self.format.files(self.path, &steps)
    }

    /// Number of instants.
    #[must_use]
    pub fn instants(&self) -> usize {
        self.instants.len()
    }

    /// Their times (s).
    pub fn times(&self) -> impl Iterator<Item = f64> {
        self.instants.iter().map(|(_, time)| *time)
    }

    /// Names of the fields.
    #[must_use]
    pub fn fields(&self) -> Vec<&'static str> {
        self.rows.fields().iter().map(|field| field.name).collect()
    }

    /// Makes sure that all files can be made, and that none is an input; `what` names the option or argument.
    ///
    /// # Errors
    /// As [`outputs::check`].
    pub fn check(&self, what: &'static str, inputs: &[(&str, &Path)], force: bool) -> Result<(), Failure> {
        let files = self.files();
        outputs::check(inputs, &[files.first().map(|file| OutputFile { what, file })], force)?;
        match files.into_iter().find(|file| !force && file.exists()) {
            Some(file) => Err(Failure::Exists { what, file }),
            None => Ok(()),
        }
    }

    /// Writes the files and returns their names; none if the observer breaks, and no file remains then.
    ///
    /// # Errors
    /// A step that cannot be read or does not fit, a file that cannot be written.
    pub fn write(&self, overwrite: Overwrite, observer: &mut dyn Observer) -> Result<Option<Vec<PathBuf>>, Failure> {
        let (fields, rows) = (self.rows.fields(), &self.rows);
        let contents = Contents { mesh: self.problem.mesh(), fields: &fields, instants: &self.instants };
        let mut writer = ExportWriter::new(self.path, self.format, overwrite, contents)?;
        let steps: Vec<usize> = self.instants.iter().map(|(step, _)| *step).collect();
        let last = steps.last().copied().unwrap_or(0);
        let observer = RefCell::new(observer);
        let source = StepFilter::new(self.source, |step, take| {
            if step.index > last {
                return Err(Done.into());
            }
            take(step)?;
            let progress = Progress { stage: "exporting", done: step.index, total: last };
            if observer.borrow_mut().observe(progress).is_break() { Err(Stopped.into()) } else { Ok(()) }
        });
        let mut take = |step: &Step<'_>| Ok(writer.push(&rows.at(step))?);
        match run::chosen(self.problem, &source, &steps, rows.need_motion() && self.by_scheme, &mut take) {
            Ok(()) => {}
            Err(cause) if cause.is::<Done>() => {}
            Err(cause) if cause.is::<Stopped>() => return Ok(None),
            Err(cause) => return Err(unwritten(cause)),
        }
        Ok(Some(writer.finish()?))
    }
}

/// The observer broke.
#[derive(Debug, Error)]
#[error("stopped")]
struct Stopped;

/// No later step is needed.
#[derive(Debug, Error)]
#[error("done")]
struct Done;

/// The failure of a step or of a file.
fn unwritten(cause: SinkError) -> Failure {
    match cause.downcast::<FileError>() {
        Ok(error) => Failure::File(*error),
        Err(cause) => Failure::from_sink(cause, percute_estimator::RunError::Source),
    }
}
