//! Runs that were killed or stopped, and go on from their histories.

mod numbers;

use crate::case::{Case, SchemaPart, statement};
use crate::difference::{self, OF_RUN};
use crate::failure::Failure;
use crate::history::Stored;
use crate::numbering::Ordered;
use crate::storing::{Outcome, Storage, drive};
use percute_core::dynamics::Simulation;
use percute_core::history::Discard;
use percute_core::observer::Observer;
use percute_core::time::TimeGrid;
use percute_io::history::{StoredPart, Unended};
use std::any::Any;
use std::path::Path;

impl Stored {
    /// Opens the history of the run of a case, which is to go on; `estimated` if the error is estimated then.
    ///
    /// # Errors
    /// As [`open`](crate::history::open), and the history of another case.
    pub fn of_case(case: &Case, file: &Path, estimated: bool) -> Result<Self, Failure> {
        let stored = Self::new(percute_io::history::open(file)?, file)?;
        match stored.difference(case, estimated)? {
            None => Ok(stored),
            Some(what) => Err(Failure::Argument(format!(
                "--resume: {} is the history of another case: {what}; give that case, another file, or --force without \
                 --resume to begin again",
                file.display()
            ))),
        }
    }

    /// The first difference between the run of this history and that of a case.
    fn difference(&self, case: &Case, estimated: bool) -> Result<Option<String>, Failure> {
        let (file, times) = (&self.file, self.file.run_times());
        let problem = &case.problem;
        let kept = |kept: Option<StoredPart>| {
            let kept = kept.unwrap_or_else(|| all(times));
            let reaction = kept.reaction || problem.contact_nodes().is_empty();
            StoredPart { reaction, ..kept }
        };
        if file.is_foreign() {
            return Ok(Some("another program has simulated it".to_string()));
        }
        let stated = OF_RUN.of_statements(&statement(problem, Some(&case.options))?, file.statement(), estimated);
        let start = || {
            let (displacement, velocity) = (problem.initial_displacement(), problem.initial_velocity());
            let first =
                numbers::of_starts("displacement", "m", [displacement, file.initial_displacement()], file.dimension());
            first.or_else(|| {
                numbers::of_starts("velocity", "m/s", [velocity, file.initial_velocity()], file.dimension())
            })
        };
        let output = || {
            let differs = numbers::of_kept(&kept(case.output.keep.of(times)), &kept(file.keeps()))?;
            Some(self.of_texts(case, "output", &["every", "times", "fields"]).unwrap_or(differs))
        };
        let mesh = numbers::of_meshes(problem.mesh(), file.mesh());
        Ok(mesh.or_else(start).or(stated).or_else(|| self.of_times(case)).or_else(output))
    }

    /// The first difference between the instants that the case asks for and those of the file. Those of a run that ends
    /// with the rebound follow from its simulation: its statement must be that of the case in the file.
    fn of_times(&self, case: &Case) -> Option<String> {
        let stated = || self.of_texts(case, "time", &SchemaPart::case().key("time").keys());
        if case.until.is_none() && case.following.is_none() {
            let differs = numbers::of_instants(&case.times, self.file.run_times())?;
            return Some(stated().unwrap_or(differs));
        }
        match self.file.case() {
            Some(_) => stated(),
            None => Some("no case is in it: it was stored from Python, where `pc.resume` continues it".to_string()),
        }
    }

    /// The first difference between keys of a table in the texts of both cases.
    fn of_texts(&self, case: &Case, table: &str, keys: &[&str]) -> Option<String> {
        difference::of_cases(case.source.text(), self.file.case().map(|case| case.text.as_str()), table, keys)
    }

    /// Lets the run go on to its end, on so many threads, by default one for each core. The file then is, byte by byte,
    /// that of a run that was not interrupted. `open` is dropped as soon as the file is closed.
    ///
    /// # Errors
    /// A history whose run cannot go on, a step that cannot be stored, an unstable run.
    pub fn resume(
        &self,
        threads: Option<usize>,
        open: Option<Box<dyn Any + Send>>,
        observer: &mut dyn Observer,
    ) -> Result<Outcome<Simulation>, Failure> {
        let Unended { checkpoint, writer } = self.file.resume(&self.problem)?;
        let (ordered, storage) = (Ordered::new(&self.problem), Storage { file: Some(writer), memory: None, open });
        let checkpoint = checkpoint.map(|checkpoint| ordered.local(checkpoint));
        drive(&ordered, self.file.run_times(), (threads, checkpoint.as_ref()), storage, &mut Discard, observer)
    }
}

/// All steps with their reactions.
fn all(times: &TimeGrid) -> StoredPart {
    StoredPart { steps: (0..=times.step_count()).collect(), velocity: false, acceleration: false, reaction: true }
}
