//! A history that is in memory, into a file.

use crate::case::{Keep, Source};
use crate::failure::Failure;
use crate::foreign::Origin;
use crate::history::plan;
use percute_core::history::StepSource;
use percute_core::problem::AnyProblem;
use percute_estimator::{Options, RunError};
use percute_io::Overwrite;
use percute_io::history::Elsewhere;
use std::path::Path;

/// A whole history with all that its file has beside the steps.
#[derive(Clone, Copy)]
pub struct Whole<'a> {
    /// The problem that it solves.
    pub problem: &'a AnyProblem,
    /// The steps.
    pub steps: &'a dyn StepSource,
    /// Whether these have their own velocities and accelerations.
    pub supplied: [bool; 2],
    /// Options that its estimate takes unless told otherwise.
    pub options: &'a Options,
    /// The case that it came from.
    pub case: Option<&'a Source>,
    /// Of a history of another program.
    pub origin: Option<&'a Origin>,
}

impl Whole<'_> {
    /// Writes the file: that of a run that was stored from its start, byte by byte, or that of another program's
    /// simulation, from which `percute estimate` gives the same estimate. It has its name, and replaces another file,
    /// once it is complete.
    ///
    /// # Errors
    /// A problem that the language of the case files cannot say; a file that exists and may not be replaced, or that
    /// cannot be written; steps that end with an error.
    pub fn write(&self, path: &Path, overwrite: Overwrite) -> Result<(), Failure> {
        let Self { problem, steps, supplied: [velocity, acceleration], options, case, origin } = *self;
        let elsewhere = origin.map(|origin| Elsewhere {
            program: origin.program.clone().unwrap_or_default(),
            derived: origin.derived.iter().map(|part| part.name().to_string()).collect(),
            initial_displacement: problem.initial_displacement().to_vec(),
        });
        let plan = plan(problem, steps.times(), options, case, &Keep::default())?;
        let plan = plan.with_supplied(velocity, acceleration).simulated_elsewhere(elsewhere);
        let mut writer = plan.create_whole(path, overwrite, steps.count())?;
        let written = steps.replay(&mut |step| writer.push(step));
        written.map_err(|error| Failure::from_sink(error, RunError::Source))?;
        Ok(writer.finish()?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::parse;
    use percute_core::dynamics::simulate;
    use percute_core::history::{History, SinkError, Step};
    use percute_core::observer::Unobserved;
    use percute_core::time::TimeGrid;
    use percute_io::history::open;

    /// A history that breaks off behind some steps.
    struct Broken<'h>(&'h History, usize);

    impl StepSource for Broken<'_> {
        fn times(&self) -> &TimeGrid {
            self.0.times()
        }

        fn count(&self) -> usize {
            self.0.count()
        }

        fn replay(&self, take: &mut dyn FnMut(&Step<'_>) -> Result<(), SinkError>) -> Result<(), SinkError> {
            self.0.replay(&mut |step| if step.index < self.1 { take(step) } else { Err("stopped".into()) })
        }
    }

    /// A body at rest, of which three instants were computed.
    struct Stopped(TimeGrid, usize);

    impl StepSource for Stopped {
        fn times(&self) -> &TimeGrid {
            &self.0
        }

        fn count(&self) -> usize {
            3
        }

        fn replay(&self, take: &mut dyn FnMut(&Step<'_>) -> Result<(), SinkError>) -> Result<(), SinkError> {
            let (displacement, reaction, touching) = (&vec![0.0; self.1][..], &[0.0][..], &[false][..]);
            self.0.instants().iter().enumerate().take(self.count()).try_for_each(|(index, &time)| {
                take(&Step {
                    index,
                    time,
                    displacement,
                    reaction,
                    touching,
                    internal: &[],
                    velocity: None,
                    acceleration: None,
                })
            })
        }
    }

    #[test]
    fn a_file_is_replaced_by_a_whole_history_only() {
        let text = include_str!("../../../examples/bar.toml");
        let case = parse(Source::new("bar.toml", text)).unwrap();
        let mut history = History::new(&case.times);
        simulate(&case.problem, &case.times, &mut history, &mut Unobserved).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.vtkhdf");
        let write = |steps: &dyn StepSource| {
            let (problem, options) = (&case.problem, &case.options);
            Whole { problem, steps, supplied: [false; 2], options, case: None, origin: None }
                .write(&path, Overwrite::Replace)
        };
        let files = || std::fs::read_dir(folder.path()).unwrap().count();
        assert!(write(&Broken(&history, 3)).is_err() && files() == 0);
        std::fs::write(&path, "dear").unwrap();
        for count in [0, 1, history.count() - 1] {
            assert!(write(&Broken(&history, count)).is_err());
            assert!(std::fs::read(&path).unwrap() == b"dear" && files() == 1, "{count} steps");
        }
        write(&history).unwrap();
        let stored = open(&path).unwrap();
        assert!(stored.has_ended() && stored.count() == history.count() && files() == 1);
    }

    /// A stopped run is saved without the room of the steps that it never reached, 2.4 TB here.
    #[test]
    fn steps_that_were_never_computed_take_no_room() {
        let text = include_str!("../../../examples/bar.toml");
        let text = text.replace("elements = 100 ", "elements = 100000 ").replace("end = 50e-6", "end = 1e-9");
        let case = parse(Source::new("bar.toml", text)).unwrap();
        let steps = &Stopped(TimeGrid::uniform(1e-3, 1_000_000).unwrap(), case.problem.mesh().node_count());
        let folder = tempfile::tempdir().unwrap();
        let (problem, options) = (&case.problem, &case.options);
        let stored = plan(problem, steps.times(), options, None, &Keep::default()).unwrap();
        let refused = stored.create(folder.path().join("run.vtkhdf"), Overwrite::Refuse).unwrap_err().to_string();
        assert!(refused.contains("bytes of room"), "{refused}");
        let path = folder.path().join("stopped.vtkhdf");
        let whole = Whole { problem, steps, supplied: [false; 2], options, case: None, origin: None };
        whole.write(&path, Overwrite::Refuse).unwrap();
        let stored = open(&path).unwrap();
        assert!(stored.count() == 3 && !stored.has_ended());
    }
}
