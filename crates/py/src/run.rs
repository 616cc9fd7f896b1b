//! A history with its problem, in memory or in a file.

use crate::bridge::Watch;
use percute_core::contact_results::{ContactRecorder, ContactResults};
use percute_core::dynamics::Balance;
use percute_core::history::{History, SinkError, Step, StepSource};
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;
use percute_estimator::Options;
use percute_io::history::{HistoryFile, HistorySource, StoredSteps};
use percute_io::{Case, FileError, Overwrite};
use percute_workflow::Failure;
use percute_workflow::case::Source;
use percute_workflow::foreign::Origin;
use percute_workflow::grade::{self, Graded};
use percute_workflow::history::{Stored, stored_case};
use percute_workflow::run::Analysis;
use percute_workflow::saving::Whole;
use std::path::Path;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use thiserror::Error;

/// A history and the problem it solves; it never changes.
pub(crate) struct Run {
    pub(crate) problem: AnyProblem,
    pub(crate) steps: Steps,
    /// Options that its estimate takes unless told otherwise.
    pub(crate) options: Options,
    /// The case that was run, of a history in memory.
    pub(crate) case: Option<Source>,
    /// Of a history of another program.
    pub(crate) origin: Option<Origin>,
    balance: OnceLock<Vec<Balance>>,
    contact: OnceLock<Arc<ContactResults>>,
}

/// Where the steps are.
pub(crate) enum Steps {
    /// In memory.
    Memory(History),
    /// In a file, from which they are read as they are needed.
    File(HistoryFile, HistorySource),
}

/// Velocities and accelerations at all instants, node by node and step after step.
pub(crate) struct Motion {
    pub(crate) velocity: Vec<f64>,
    pub(crate) acceleration: Vec<f64>,
}

impl Run {
    pub(crate) fn new(problem: AnyProblem, history: History, options: Options, balance: Option<Vec<Balance>>) -> Self {
        let balance = balance.map_or_else(OnceLock::new, OnceLock::from);
        let (steps, contact) = (Steps::Memory(history), OnceLock::new());
        Self { problem, steps, options, case: None, origin: None, balance, contact }
    }

    /// A history of another program, in memory.
    pub(crate) fn foreign(problem: AnyProblem, history: History, options: Options, origin: Origin) -> Self {
        Self { origin: Some(origin), ..Self::new(problem, history, options, None) }
    }

    /// A history in a file.
    pub(crate) fn stored(stored: Stored) -> Result<Self, FileError> {
        let source = stored.file.source(&stored.problem)?;
        let origin = stored.origin();
        let steps = Steps::File(stored.file, source);
        let (problem, options) = (stored.problem, stored.options);
        Ok(Self { problem, steps, options, case: None, origin, balance: OnceLock::new(), contact: OnceLock::new() })
    }

    /// The steps, one after the other.
    pub(crate) fn source(&self) -> &dyn StepSource {
        match &self.steps {
            Steps::Memory(history) => history,
            Steps::File(_, source) => source,
        }
    }

    /// The stored steps of a file, which may be thinned.
    pub(crate) fn stored_source(&self) -> Option<StoredSteps<'_>> {
        match &self.steps {
            Steps::Memory(_) => None,
            Steps::File(_, source) => Some(source.stored()),
        }
    }

    /// The same until `watch` asks for a stop.
    pub(crate) fn stoppable(&self, watch: Watch) -> Stoppable<'_> {
        Stoppable { source: self.source(), watch }
    }

    /// The file, if that is where the steps are.
    pub(crate) fn file(&self) -> Option<&HistoryFile> {
        match &self.steps {
            Steps::Memory(_) => None,
            Steps::File(file, _) => Some(file),
        }
    }

    /// The history in memory, if that is where it is.
    pub(crate) fn memory(&self) -> Option<&History> {
        match &self.steps {
            Steps::Memory(history) => Some(history),
            Steps::File(..) => None,
        }
    }

    /// Whether it has velocities and accelerations of its own.
    pub(crate) fn supplied(&self) -> [bool; 2] {
        match (self.file(), self.memory().and_then(|history| history.step(0))) {
            (Some(file), _) => file.supplied(),
            (None, Some(step)) => [step.velocity.is_some(), step.acceleration.is_some()],
            (None, None) => [false; 2],
        }
    }

    /// The case that was run.
    pub(crate) fn case(&self) -> Option<Case> {
        self.file().map_or_else(|| self.case.as_ref().map(stored_case), |file| file.case().cloned())
    }

    /// Writes a history that is in memory into a file.
    pub(crate) fn save(&self, path: &Path, overwrite: Overwrite, watch: Watch) -> Result<(), Failure> {
        let Self { problem, options, case, origin, .. } = self;
        let (case, origin) = (case.as_ref(), origin.as_ref());
        let steps = &self.stoppable(watch);
        Whole { problem, steps, supplied: self.supplied(), options, case, origin }.write(path, overwrite)
    }

    /// The instants planned.
    pub(crate) fn times(&self) -> &TimeGrid {
        self.source().times()
    }

    /// Number of instants held.
    pub(crate) fn count(&self) -> usize {
        self.source().count()
    }

    /// Nodes of the rows of reactions and touching status.
    pub(crate) fn contact_nodes(&self) -> Vec<usize> {
        match self.file() {
            Some(file) => file.contact_nodes().to_vec(),
            None => self.problem.contact_nodes().iter().map(|c| c.node.index()).collect(),
        }
    }

    /// Instants and nodes.
    pub(crate) fn shape(&self) -> [usize; 2] {
        [self.count(), self.problem.mesh().node_count()]
    }

    /// Instants, nodes and components of a displacement.
    pub(crate) fn shape_of_motion(&self) -> [usize; 3] {
        let [count, nodes] = self.shape();
        [count, nodes, self.problem.dimension()]
    }

    /// Instants and nodes of the contact surface.
    pub(crate) fn contact_shape(&self) -> [usize; 2] {
        [self.count(), self.contact_nodes().len()]
    }

    /// Analyses the steps that `source` hands on, those of this run.
    pub(crate) fn graded(
        &self,
        source: &dyn StepSource,
        analysis: &Analysis,
        accept: bool,
        watch: &mut Watch,
    ) -> Result<Graded, Failure> {
        self.file().map_or(Ok(()), HistoryFile::expect_all)?;
        if let Some(origin) = self.origin.clone() {
            let origin = &Origin { accept, ..origin };
            return grade::estimate(&self.problem, source, origin, analysis, watch);
        }
        let results = percute_workflow::run::estimate(&self.problem, source, analysis, watch)?;
        Ok(Graded { results, times: self.times().clone(), checked: None })
    }

    /// Energies and works at every step, computed once.
    pub(crate) fn balance(&self, watch: Watch) -> Result<&[Balance], SinkError> {
        if let Some(balance) = self.balance.get() {
            return Ok(balance);
        }
        let balance = percute_workflow::run::balance(&self.problem, &self.stoppable(watch))?;
        Ok(self.balance.get_or_init(|| balance))
    }

    /// What contact did, with all nodes at all instants, computed once.
    pub(crate) fn contact(&self, watch: Watch) -> Result<Arc<ContactResults>, SinkError> {
        if let Some(contact) = self.contact.get() {
            return Ok(contact.clone());
        }
        let recorder = ContactRecorder::new(&self.problem, self.times()).keeping_steps()?;
        let contact = recorder.replay(&self.stoppable(watch))?;
        Ok(self.contact.get_or_init(|| Arc::new(contact)).clone())
    }

    /// v_n and a_n by the scheme, or as the history brings them.
    pub(crate) fn motion(&self, watch: Watch) -> Result<Motion, SinkError> {
        let mut motion = Motion { velocity: Vec::new(), acceleration: Vec::new() };
        percute_workflow::run::motion(&self.problem, &self.stoppable(watch), |velocity, acceleration| {
            motion.velocity.extend(velocity);
            motion.acceleration.extend(acceleration);
        })?;
        Ok(motion)
    }
}

/// The caller has left.
#[derive(Debug, Error)]
#[error("stopped")]
pub(crate) struct Left;

/// A history that ends with an error when its reader is told to stop: unlike an observer that breaks, it
/// asks for nothing more to be computed.
pub(crate) struct Stoppable<'a> {
    pub(crate) source: &'a dyn StepSource,
    pub(crate) watch: Watch,
}

impl StepSource for Stoppable<'_> {
    fn times(&self) -> &TimeGrid {
        self.source.times()
    }

    fn count(&self) -> usize {
        self.source.count()
    }

    fn replay(&self, take: &mut dyn FnMut(&Step<'_>) -> Result<(), SinkError>) -> Result<(), SinkError> {
        self.source.replay(&mut |step| if self.watch.0.stopped() { Err(Left.into()) } else { take(step) })
    }
}

/// A history that two threads share while it grows: one fills it, the other may take it away at any moment.
#[derive(Clone, Debug)]
pub(crate) struct Growing(Arc<Mutex<Option<History>>>);

impl Growing {
    pub(crate) fn new(times: &TimeGrid) -> Self {
        Self(Arc::new(Mutex::new(Some(History::new(times)))))
    }

    /// Appends a step.
    pub(crate) fn push(&self, step: &Step<'_>) -> Result<(), SinkError> {
        match self.0.lock().unwrap_or_else(PoisonError::into_inner).as_mut() {
            Some(history) => history.push(step),
            None => Err(Left.into()),
        }
    }

    /// Takes what is there; later steps are refused.
    pub(crate) fn take(&self) -> Option<History> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take().filter(|history| !history.is_empty())
    }
}
