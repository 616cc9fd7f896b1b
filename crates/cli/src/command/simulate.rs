//! `percute simulate`.

use super::outputs::{begin_history, check};
use super::resume::{Left, go_on, left};
use super::{Console, case};
use crate::args::SimulateArguments;
use crate::exit::{DONE, INTERRUPTED};
use crate::progress::Watch;
use percute_workflow::Failure;
use percute_workflow::deformation::StoredFlow;
use percute_workflow::effort::Long;
use percute_workflow::history::open;
use percute_workflow::outputs::{OutputFile, chosen};
use percute_workflow::report::{drifted, reported, simulated};
use percute_workflow::run::{self, Outcome, Storage, located};
use std::path::{Path, PathBuf};
use std::time::Instant;

pub(super) fn command(arguments: &SimulateArguments, console: &mut Console<'_>) -> Result<u8, Failure> {
    let case = &case(&arguments.case)?;
    let SimulateArguments { force, quiet, long, .. } = *arguments;
    let named = named_after(&arguments.case);
    let keys = ["--history", "[output] history"];
    let chosen = chosen(keys, arguments.history.as_deref(), case.output.history.as_deref());
    let history = chosen.unwrap_or(OutputFile { what: "history", file: &named });
    let left = left(case, Some(history), arguments.resume, false)?;
    let new = left.history().is_none().then_some(history);
    check(&case.inputs(Some(&arguments.case)), &[new], None, force)?;
    case.check_run(false, Long::asked(long, "--long"))?;
    console.warn_about(case, quiet);
    if !quiet {
        console.warn(&reported(case.problem.mesh()).collect::<Vec<_>>());
    }
    if let Left::Whole(stored) = &left {
        let (file, steps) = (history.file.display(), stored.file.run_times().step_count());
        console.print(&format!("{file} holds all {steps} steps already; nothing was changed"))?;
        return Ok(DONE);
    }
    let Some(case) = &left.resolved(case, quiet, console)? else { return Ok(INTERRUPTED) };
    let start = Instant::now();
    let Outcome { results: simulation, unstored } = match left.history() {
        Some(stored) => go_on(case, stored, None, quiet, console)?,
        None => {
            let writer = begin_history(case, history, force, quiet, console)?;
            let watch = &mut Watch::new(console.progress && !quiet, console.stop);
            let storage = Storage { file: Some(writer), memory: None, open: None };
            let done = run::simulate(&case.problem, &case.times, storage, watch);
            let done = done.map_err(|failure| located(case, failure))?;
            watch.clear();
            done
        }
    };
    if !quiet {
        console.warn(&drifted(simulation.balance.energy_drift, case.times.varies()));
    }
    let (flow, seconds) = (flow_in(history.file), start.elapsed().as_secs_f64());
    let told = console.print(&simulated(&case.subject(), &simulation, (history.file, flow.as_ref()), seconds));
    console.but_lost(unstored, told.map(|()| if simulation.interrupted { INTERRUPTED } else { DONE }))
}

/// The plastic flow at the end of a history. A file whose last steps could not be stored may lack it; its failure is
/// told.
pub(super) fn flow_in(history: &Path) -> Option<StoredFlow> {
    open(history).ok()?.flow().ok()?
}

/// The name of the case with another ending, in the working directory.
fn named_after(case: &Path) -> PathBuf {
    let mut name = case.file_stem().unwrap_or_default().to_os_string();
    name.push(".vtkhdf");
    name.into()
}
