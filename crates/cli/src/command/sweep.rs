//! `percute sweep`.

use super::Console;
use crate::args::SweepArguments;
use crate::exit::{DONE, FAILED, INTERRUPTED};
use crate::progress::Watch;
use percute_sweep::{Count, Launch, Plan, Planned, run, states, write};
use percute_workflow::Failure;
use percute_workflow::effort::Long;
use percute_workflow::message::counted;

pub(super) fn command(arguments: &SweepArguments, console: &mut Console<'_>) -> Result<u8, Failure> {
    let SweepArguments { index, of, quiet, long, force, .. } = *arguments;
    let plan = Plan::read(&arguments.sweep, arguments.folder.as_deref(), Long::asked(long, "--long"))?;
    if arguments.list {
        let line = |(case, state): (&str, _)| format!("{state:6} {case}\n");
        console.print(&states(&plan).map(line).collect::<String>())?;
        return Ok(DONE);
    }
    if arguments.collect {
        let done = states(&plan).filter(|(_, state)| *state == "done").count();
        let table = write(&plan)?;
        console.print(&format!("{done} of {} done; table: {}", counted(plan.cases.len(), "case"), table.display()))?;
        return Ok(DONE);
    }
    let chosen: Vec<&Planned> = match index.zip(of) {
        Some((index, of)) if index >= of => {
            let message =
                format!("--index is {index}; with --of {of} it is at most {}: the parts are counted from 0", of - 1);
            return Err(Failure::Argument(message));
        }
        Some((index, of)) => plan.cases.iter().skip(index).step_by(of).collect(),
        None => plan.cases.iter().collect(),
    };
    let default = Launch::of(console.itself.to_vec());
    let (jobs, threads) = (arguments.jobs.unwrap_or(default.jobs), arguments.threads.unwrap_or(default.threads));
    let launch = Launch { jobs, threads, long, again: force, ..default };
    let watch = &mut Watch::new(console.progress && !quiet, console.stop);
    let tell = &mut |name: &str, reason: &str| console.say(&format!("{name}: {}", reason.trim()));
    let count = run(&plan.folder, chosen.iter().copied(), &launch, tell, watch)?;
    watch.clear();
    // Parts of a sweep that run at the same time would write the table of one another.
    let table = index.is_none().then(|| write(&plan)).transpose()?;
    console.print(&summary(&count, chosen.len()))?;
    match table {
        Some(table) => console.print(&format!("table: {}", table.display()))?,
        None => console.print("when all parts are done, make the table with --collect")?,
    }
    Ok(match count {
        Count { left: 1.., .. } => INTERRUPTED,
        Count { failed: 1.., .. } => FAILED,
        _ => DONE,
    })
}

/// What became of the cases, in a line.
fn summary(count: &Count, chosen: usize) -> String {
    let Count { found, done, failed, left } = count;
    let mut parts = vec![format!("{done} done")];
    let mut add = |number: usize, what: &str| {
        if number > 0 {
            parts.push(format!("{number} {what}"))
        }
    };
    add(*found, "done before");
    add(*failed, "failed (failure.txt in their folders has the reason)");
    add(*left, "left; the same command continues with them");
    format!("{}: {}", counted(chosen, "case"), parts.join(", "))
}
