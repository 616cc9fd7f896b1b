//! The `percute` command as a library.

pub mod case;
