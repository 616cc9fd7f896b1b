//! `percute completion`.

use super::Console;
use crate::args::{Arguments, CompletionArguments};
use crate::exit::DONE;
use clap::CommandFactory;
use percute_workflow::Failure;

pub(super) fn command(arguments: &CompletionArguments, console: &mut Console<'_>) -> Result<u8, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "percute", &mut script);
    console.print(&String::from_utf8_lossy(&script))?;
    Ok(DONE)
}
