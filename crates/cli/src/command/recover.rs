//! `percute recover`.

use super::Console;
use crate::args::RecoverArguments;
use crate::exit::DONE;
use percute_io::history::{open, recover};
use percute_workflow::Failure;

pub(super) fn command(arguments: &RecoverArguments, console: &mut Console<'_>) -> Result<u8, Failure> {
    let file = &arguments.history;
    let recovered = recover(file)?;
    let planned = open(file)?.times().step_count();
    let (shown, steps) = (file.display(), recovered.count.saturating_sub(1));
    let held = format!("{steps} of {planned} planned steps");
    console.print(&match recovered.was_complete {
        true => format!("{shown} is closed already, with {held}; nothing was changed"),
        false => format!("{shown} is now closed, with {held}"),
    })?;
    Ok(DONE)
}
