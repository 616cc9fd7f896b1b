//! `percute reproduce`, which the command of the Python package does.

use super::Console;
use crate::exit::FAILED;

const MESSAGE: &str = "error: `percute reproduce` needs the Python package: pip install \"percute[plot]\", or pip install \".[plot]\" \
    in the source folder. Its command `percute` computes the evidence";

pub(super) fn command(console: &mut Console<'_>) -> u8 {
    console.say(MESSAGE);
    FAILED
}
