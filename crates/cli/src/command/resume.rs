//! `--resume`: a run goes on from the history that it left.

use super::{Console, resolved};
use crate::args::RunArguments;
use crate::progress::Watch;
use percute_core::dynamics::Simulation;
use percute_workflow::Failure;
use percute_workflow::case::Case;
use percute_workflow::history::Stored;
use percute_workflow::outputs::OutputFile;
use percute_workflow::run::{Outcome, located};
use percute_workflow::until::Until;

/// What a run finds at its start.
pub(super) enum Left {
    /// No history: it begins.
    Nothing,
    /// A history to which steps are missing.
    Begun(Box<Stored>),
    /// A history with all that it is to hold.
    Whole(Box<Stored>),
}

/// Looks for the history that a run of this case left, if it is to go on; `estimated` if its error is estimated.
pub(super) fn left(
    case: &Case,
    history: Option<OutputFile<'_>>,
    resume: bool,
    estimated: bool,
) -> Result<Left, Failure> {
    if !resume {
        return Ok(Left::Nothing);
    }
    let Some(OutputFile { file, .. }) = history else {
        let message = "--resume needs the history of the run: name it with --history FILE, or in [output] of the case";
        return Err(Failure::Argument(message.to_string()));
    };
    if !file.exists() {
        return Ok(Left::Nothing);
    }
    let stored = Box::new(Stored::of_case(case, file, estimated)?);
    Ok(if stored.file.has_ended() { Left::Whole(stored) } else { Left::Begun(stored) })
}

impl Left {
    /// Refuses to begin again, and so to replace a history that keeps a part of its run, unless `--force` is given.
    pub(super) fn refuse_a_part(&self, arguments: &RunArguments) -> Result<(), Failure> {
        let Some(stored) = self.history().filter(|stored| stored.file.expect_all().is_err()) else { return Ok(()) };
        if arguments.work.force {
            return Ok(());
        }
        let (file, case) = (stored.file.path().display(), arguments.case.display());
        Err(Failure::Argument(format!(
            "--resume: {file} keeps a part of the run, and the estimate needs all steps: `percute simulate {case} \
             --resume` continues the history alone; with --force, the run begins again and replaces it"
        )))
    }

    /// The case with the end of its run, which the history knows; no case if the search for it was stopped.
    pub(super) fn resolved(
        &self,
        case: &Case,
        quiet: bool,
        console: &mut Console<'_>,
    ) -> Result<Option<Case>, Failure> {
        let Some(stored) = self.history() else { return resolved(case, quiet, console) };
        let times = stored.file.run_times().clone();
        let unended = case.until.as_ref().filter(|until| times.end() >= until.longest).map(Until::not_found);
        if !quiet {
            console.warn(&unended);
        }
        Ok(Some(Case { times, until: None, unended, ..case.clone() }))
    }

    /// The history that is there, which is no new file then.
    pub(super) fn history(&self) -> Option<&Stored> {
        match self {
            Self::Nothing => None,
            Self::Begun(stored) | Self::Whole(stored) => Some(stored),
        }
    }
}

/// Lets the simulation go on to its end.
pub(super) fn go_on(
    case: &Case,
    stored: &Stored,
    threads: Option<usize>,
    quiet: bool,
    console: &mut Console<'_>,
) -> Result<Outcome<Simulation>, Failure> {
    if !quiet {
        let (file, held) = (stored.file.path().display(), stored.file.count());
        let planned = stored.file.times().instants().len();
        console.say(&format!("history {file}: {held} of {planned} instants are there"));
    }
    let watch = &mut Watch::new(console.progress && !quiet, console.stop);
    let done = stored.resume(threads, None, watch).map_err(|failure| located(case, failure))?;
    watch.clear();
    Ok(done)
}
