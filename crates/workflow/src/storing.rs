//! The simulation with its history: each step is stored before it is analysed.

use crate::failure::Failure;
use crate::numbering::{Fields, Ordered, TakeStep};
use percute_core::dynamics::{Simulation, SimulationError, missed_contact, resume, simulate_threaded};
use percute_core::history::{Checkpoint, SinkError, State, StateSink, Step};
use percute_core::observer::Observer;
use percute_core::time::TimeGrid;
use percute_io::FileError;
use percute_io::history::{StoredPart, Writer};
use std::any::Any;

/// What a run gave, though its history file may not be what it should.
#[derive(Debug)]
pub struct Outcome<T> {
    /// The results.
    pub results: T,
    /// Why the file could not be completed: it was moved or removed, or the disk is full.
    pub unstored: Option<FileError>,
}

impl<T> Outcome<T> {
    /// The results of a run whose file is complete.
    ///
    /// # Errors
    /// A file that could not be completed.
    pub fn stored(self) -> Result<T, Failure> {
        self.unstored.map_or(Ok(self.results), |error| Err(error.into()))
    }

    pub(crate) fn map<U>(self, results: impl FnOnce(T) -> Result<U, Failure>) -> Result<Outcome<U>, Failure> {
        Ok(Outcome { results: results(self.results)?, unstored: self.unstored })
    }
}

/// The places of the history of a run; each is optional.
#[derive(Default)]
pub struct Storage<'s> {
    /// A file.
    pub file: Option<Writer>,
    /// Memory.
    pub memory: Option<&'s mut TakeStep<'s>>,
    /// Dropped as soon as the file is closed.
    pub open: Option<Box<dyn Any + Send>>,
}

/// Stores steps in the numbers of the user.
struct Storing<'o, 'p, 's> {
    ordered: &'o Ordered<'p>,
    file: Option<Writer>,
    memory: Option<&'s mut TakeStep<'s>>,
    fields: Fields,
}

impl Storing<'_, '_, '_> {
    /// Velocities and accelerations by the scheme at a step, as far as the file keeps them.
    fn motion(&self, state: &State<'_>) -> [Option<Vec<f64>>; 2] {
        let kept = self.file.as_ref().and_then(Writer::stored_part);
        let kept = kept.filter(|kept| kept.row_of(state.step().index).is_some());
        let has = |has: fn(&StoredPart) -> bool| kept.is_some_and(has);
        [
            has(|kept| kept.velocity).then(|| state.velocity()),
            has(|kept| kept.acceleration).then(|| state.acceleration()),
        ]
    }
}

impl StateSink for Storing<'_, '_, '_> {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        let [velocity, acceleration] = self.motion(state);
        let Self { ordered, file, memory, fields } = self;
        let step = Step { velocity: velocity.as_deref(), acceleration: acceleration.as_deref(), ..*state.step() };
        let step = ordered.stated_step(&step, fields);
        if let Some(file) = file {
            file.push(&step)?;
        }
        if let Some(keep) = memory {
            keep(&Step { velocity: None, acceleration: None, ..step })?;
        }
        file.as_mut().map_or(Ok(()), |file| file.keep(state, |checkpoint| ordered.stated(checkpoint)))
    }
}

/// Hands every step to the history and then to `beside`, from the start or from a checkpoint on. A run that was stopped
/// is finished like a complete one; a refused start leaves no file; after any other error the file remains.
pub(crate) fn drive(
    ordered: &Ordered<'_>,
    times: &TimeGrid,
    (threads, checkpoint): (Option<usize>, Option<&Checkpoint>),
    storage: Storage<'_>,
    beside: &mut dyn StateSink,
    observer: &mut dyn Observer,
) -> Result<Outcome<Simulation>, Failure> {
    let Storage { file, memory, open } = storage;
    let stored = file.is_some() || memory.is_some();
    // The history first: a step that cannot be estimated is still stored.
    let storing = stored.then(|| Storing { ordered, file, memory, fields: Fields::default() });
    let problem = ordered.problem();
    let mut sinks = (storing, (beside, missed_contact(problem, times.step_count())));
    let simulation = match checkpoint {
        None => simulate_threaded(problem, times, threads, &mut sinks, observer),
        Some(checkpoint) => resume(problem, times, threads, checkpoint, &mut sinks, observer),
    };
    let file = sinks.0.and_then(|storing| storing.file);
    let done = match (simulation, file) {
        // A file that was lost must not cost the results.
        (Ok(results), file) => Ok(Outcome { results, unstored: file.and_then(|history| history.finish().err()) }),
        (Err(error @ SimulationError::StartsTooNear { .. }), Some(history)) => {
            let file = history.path().to_path_buf();
            drop(history);
            // A file that cannot be removed does no harm: it holds no step.
            let _ = std::fs::remove_file(file);
            Err(ordered.failure(error.into()))
        }
        (Err(error), _) => Err(ordered.failure(error.into())),
    };
    drop(open);
    done
}
