//! The `percute` command, as its users see it.

mod common;
#[cfg(target_os = "linux")]
mod interrupt;
mod mistakes;
mod picture;
mod run;
