//! The `percute` command.
fn main() {}
