//! The `percute` command.

fn main() -> std::process::ExitCode {
    percute::process(std::env::args_os()).into()
}
