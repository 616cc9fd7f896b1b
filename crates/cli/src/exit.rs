//! Exit codes of the command.

use percute_workflow::Failure;

/// Exit code of a command that did all it should.
pub const DONE: u8 = 0;
/// Exit code of a command that failed though its input was good.
pub const FAILED: u8 = 1;
/// Exit code of bad input: the case file, the history or the arguments.
pub const BAD_INPUT: u8 = 2;
/// Exit code after Ctrl-C.
pub const INTERRUPTED: u8 = 130;

/// The exit code of a failure.
pub(crate) fn code(failure: &Failure) -> u8 {
    if failure.is_bad_input() { BAD_INPUT } else { FAILED }
}
