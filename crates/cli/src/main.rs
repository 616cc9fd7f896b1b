//! The `percute` command.

fn main() -> std::process::ExitCode {
    let name = || std::env::args_os().next().unwrap_or_else(|| "percute".into());
    let itself = std::env::current_exe().map_or_else(|_| name(), std::path::PathBuf::into_os_string);
    percute::process(std::env::args_os(), &[itself]).into()
}
