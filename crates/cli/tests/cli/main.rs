//! The `percute` command, as its users see it.

// A test that cannot go on fails.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod adapt;
mod circles;
mod common;
mod contact;
mod dependencies;
#[cfg(target_os = "linux")]
mod disk;
mod examples;
mod export;
mod faults;
mod history;
#[cfg(target_os = "linux")]
mod interrupt;
mod lines;
#[cfg(target_os = "linux")]
mod memory;
mod mesh_file;
#[cfg(target_os = "linux")]
mod missing_files;
mod mistakes;
mod picture;
mod rebound;
mod report;
#[cfg(target_os = "linux")]
mod resume;
mod run;
mod steps;
#[cfg(target_os = "linux")]
mod sweep;
mod type_names;
