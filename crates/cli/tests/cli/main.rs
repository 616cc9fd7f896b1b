//! The `percute` command, as its users see it.

// A test that cannot go on fails.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;
mod contact;
mod examples;
mod history;
mod house;
#[cfg(target_os = "linux")]
mod interrupt;
mod mesh_file;
mod mistakes;
mod picture;
mod reproduce;
mod run;
mod statement;
