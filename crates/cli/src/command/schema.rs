//! `percute schema`.

use super::Console;
use crate::exit::DONE;
use percute_workflow::Failure;
use percute_workflow::case::SCHEMA;

pub(super) fn command(console: &mut Console<'_>) -> Result<u8, Failure> {
    console.print(SCHEMA)?;
    Ok(DONE)
}
