//! The `percute` command as a library: arguments, progress and printing. Cases, runs and reports are in
//! `percute-workflow`, pictures in `percute-presentation`.
//!
//! [`command_line`] is the whole command; it prints to the writers of a [`Console`] only and
//! returns its exit code, so that other programs can offer the same command; [`process`] runs it on
//! the standard output and error of the process, with Ctrl-C.

pub mod args;
mod command;
mod exit;
mod process;
mod progress;
mod stop;

pub use command::{Console, command_line};
pub use exit::{BAD_INPUT, DONE, FAILED, INTERRUPTED};
pub use process::process;
pub use stop::Stop;
