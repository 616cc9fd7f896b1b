//! From arguments to exit code.

use crate::args::{Arguments, Command, RunArguments};
use crate::case::{Case, Source};
use crate::failure::{BAD_INPUT, DONE, FAILED, Failure, INTERRUPTED};
use crate::picture;
use crate::progress::Watch;
use crate::report::{Report, Warning, summary};
use crate::run::{Settings, run};
use clap::Parser;
use std::ffi::OsString;
use std::io::Write;
use std::path::Path;

/// Where a command prints, and what may stop it.
pub struct Console<'a> {
    /// Standard output: the result and nothing else.
    pub out: &'a mut dyn Write,
    /// Standard error: warnings and errors.
    pub err: &'a mut dyn Write,
    /// Whether to show progress on the process's standard error.
    pub progress: bool,
    /// Asked at each step; the run stops cleanly when it says yes.
    pub interrupted: &'a dyn Fn() -> bool,
}

/// Runs the command with these arguments, the program's name first, and returns its exit code.
pub fn command_line<I>(arguments: I, console: &mut Console<'_>) -> u8
where
    I: IntoIterator,
    I::Item: Into<OsString> + Clone,
{
    let outcome = match Arguments::try_parse_from(arguments) {
        Ok(Arguments { command: Command::Run(arguments) }) => run_command(&arguments, console),
        Err(error) => return clap_says(&error, console),
    };
    outcome.unwrap_or_else(|failure| {
        // If standard error is gone too, the exit code is all that is left to say it.
        let _ = writeln!(console.err, "error: {failure}");
        failure.exit_code()
    })
}

/// Prints clap's help, version or error.
fn clap_says(error: &clap::Error, console: &mut Console<'_>) -> u8 {
    let wrong = error.use_stderr();
    let printed = if wrong { write!(console.err, "{error}") } else { write!(console.out, "{error}") };
    match (wrong, printed) {
        (true, _) => BAD_INPUT,
        (false, Ok(())) => DONE,
        (false, Err(_)) => FAILED,
    }
}

/// `percute run`.
fn run_command(arguments: &RunArguments, console: &mut Console<'_>) -> Result<u8, Failure> {
    if let Some(file) = &arguments.picture {
        picture::check_path(file)?;
        if file.canonicalize().is_ok_and(|file| arguments.case.canonicalize().is_ok_and(|case| case == file)) {
            return Err(Failure::Argument(format!("--picture {} is the case file itself", file.display())));
        }
    }
    let case = Case::parse(read(&arguments.case)?)?;
    let settings = Settings { threads: arguments.threads, window: arguments.window };
    let watch = &mut Watch::new(console.progress && !arguments.quiet, console.interrupted);
    let report = match run(&case, settings, watch) {
        // Nothing can be estimated from a run stopped at its very start.
        Err(Failure::Run(error)) if (console.interrupted)() => {
            writeln!(console.err, "interrupted: {error}")?;
            return Ok(INTERRUPTED);
        }
        other => other?,
    };
    watch.clear();
    if !arguments.quiet {
        warn(&report.warnings, console);
    }
    print(&report, arguments.json, console)?;
    if let Some(file) = &arguments.picture {
        match &case {
            Case::Bar(case) => picture::write(&case.problem, &report, file)?,
            Case::Plane(case) => picture::write(&case.problem, &report, file)?,
        }
    }
    Ok(if report.interrupted { INTERRUPTED } else { DONE })
}

/// Warnings that cannot be written must not cost the result.
fn warn(warnings: &[Warning], console: &mut Console<'_>) {
    for warning in warnings {
        let _ = writeln!(console.err, "warning: {}", warning.message);
    }
}

fn print(report: &Report, json: bool, console: &mut Console<'_>) -> Result<(), Failure> {
    let text = if json { report.to_json()? } else { summary(report) };
    writeln!(console.out, "{}", text.trim_end())?;
    console.out.flush()?;
    Ok(())
}

/// Reads a case file; one that is no UTF-8 is refused with the line where it stops being so.
fn read(file: &Path) -> Result<Source, Failure> {
    let bytes = std::fs::read(file).map_err(|cause| Failure::Unreadable { file: file.to_path_buf(), cause })?;
    let name = file.display().to_string();
    String::from_utf8(bytes).map(|text| Source::new(&name, text)).map_err(|error| {
        let line = 1 + error.as_bytes()[..error.utf8_error().valid_up_to()].iter().filter(|&&b| b == b'\n').count();
        Failure::Argument(format!("{name}:{line}: this is no UTF-8 text"))
    })
}
