//! The `percute` command as a library: case files, runs, reports and pictures.
//!
//! [`command_line`] is the whole command; it prints to the writers of a [`Console`] only and
//! returns its exit code, so that other programs can offer the same command; [`process`] runs it on
//! the standard output and error of the process, with Ctrl-C. The steps beneath it are public too:
//! [`case::Case::parse`], [`run::run`], [`history`], [`report::Report`], [`picture::Drawn`].

pub mod args;
pub mod case;
mod command;
mod failure;
pub mod history;
pub mod info;
pub mod outputs;
pub mod picture;
mod process;
mod progress;
pub mod report;
pub mod reproduce;
pub mod run;
mod writable;

pub use command::{Console, command_line};
pub use failure::{BAD_INPUT, DONE, FAILED, Failure, INTERRUPTED};
pub use process::process;
