//! `percute new`.

use super::Console;
use crate::args::{NewArguments, Template};
use crate::exit::DONE;
use percute_workflow::Failure;

pub(super) fn command(arguments: &NewArguments, console: &mut Console<'_>) -> Result<u8, Failure> {
    console.print(text(arguments.case))?;
    Ok(DONE)
}

/// The example of that name, so that what is printed is what the tests of the examples run.
fn text(template: Template) -> &'static str {
    match template {
        Template::Bar => include_str!("../../../../examples/bar.toml"),
        Template::Block => include_str!("../../../../examples/block.toml"),
        Template::Drop => include_str!("../../../../examples/drop.toml"),
    }
}
