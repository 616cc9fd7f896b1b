//! From arguments to exit code.

mod adapt;
mod completion;
mod estimate;
mod export;
mod info;
mod new;
mod outputs;
mod plan;
mod present;
mod recover;
mod report;
mod result;
mod resume;
mod run;
mod schema;
mod simulate;
mod sweep;
mod verify;

use crate::args::{Arguments, Command, PLOT_NEEDS_PYTHON, STUDIES, lacks_steps};
use crate::exit::{BAD_INPUT, DONE, FAILED, INTERRUPTED, code};
use crate::progress::Watch;
use crate::stop::Stop;
use clap::Parser;
use percute_estimator::EstimateError;
use percute_io::{FileError, is_hdf5, is_named_pipe};
use percute_system::is_pipe;
use percute_workflow::Failure;
use percute_workflow::case::{Case, Source, parse, stranger};
use percute_workflow::message::hint;
use percute_workflow::report::Warning;
use percute_workflow::run::{located, resolved as search};
use std::ffi::OsString;
use std::fs::File;
use std::io::{ErrorKind, Read, Write};
use std::path::Path;

/// Most bytes of a case; pipes may have no end.
const MOST: u64 = 1 << 30;
/// As many tell the kind of a file that is no text.
const BEGINNING: u64 = 512;

/// Where a command prints, and what may stop it.
pub struct Console<'a> {
    /// Standard output: the result and nothing else.
    pub out: &'a mut dyn Write,
    /// Standard error: warnings and errors.
    pub err: &'a mut dyn Write,
    /// Whether to show progress on the process's standard error.
    pub progress: bool,
    /// Asked at each step; the run stops cleanly when it says yes.
    pub stop: &'a Stop,
    /// This command, with which it starts processes of its own: a program and its first arguments.
    pub itself: &'a [OsString],
}

/// Runs the command with these arguments, the program's name first, and returns its exit code.
pub fn command_line<I>(arguments: I, console: &mut Console<'_>) -> u8
where
    I: IntoIterator,
    I::Item: Into<OsString> + Clone,
{
    let arguments: Vec<OsString> = arguments.into_iter().map(Into::into).collect();
    if lacks_steps(&arguments) {
        console.say("error: --steps needs the numbers of steps, separated by commas, as in `--steps 0,-1`");
        return BAD_INPUT;
    }
    let outcome = match Arguments::try_parse_from(arguments) {
        Ok(Arguments { command }) => match command {
            Command::New(arguments) => new::command(&arguments, console),
            Command::Schema => schema::command(console),
            Command::Completion(arguments) => completion::command(&arguments, console),
            Command::Run(arguments) => run::command(&arguments, console),
            Command::Simulate(arguments) => simulate::command(&arguments, console),
            Command::Estimate(arguments) => estimate::command(&arguments, console),
            Command::Report(arguments) => report::command(&arguments, console),
            Command::Verify(arguments) => verify::command(&arguments, console),
            Command::Adapt(arguments) => adapt::command(&arguments, console),
            Command::Plan(arguments) => plan::command(&arguments, console),
            Command::Sweep(arguments) => sweep::command(&arguments, console),
            Command::Info(arguments) => info::command(&arguments, console),
            Command::Export(arguments) => export::command(&arguments, console),
            Command::Recover(arguments) => recover::command(&arguments, console),
            // The command of the Python package does this.
            Command::Plot(_) => Ok(console.refuse(PLOT_NEEDS_PYTHON)),
            Command::Reproduce(_) => Err(Failure::Argument(STUDIES.to_string())),
        },
        Err(error) => return clap_says(&error, console),
    };
    outcome.unwrap_or_else(|failure| {
        // A reader that has enough, such as `head`, is no error to tell of.
        let closed = matches!(&failure, Failure::Output(error) if error.kind() == ErrorKind::BrokenPipe);
        if !closed {
            // If standard error is gone too, the exit code is all that is left to say it.
            let _ = writeln!(console.err, "error: {failure}");
        }
        code(&failure)
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

impl Console<'_> {
    /// Prints a result.
    fn print(&mut self, text: &str) -> Result<(), Failure> {
        writeln!(self.out, "{}", text.trim_end())?;
        self.out.flush()?;
        Ok(())
    }

    /// Says something beside the result; what cannot be said must not cost it.
    fn say(&mut self, text: &str) {
        let _ = writeln!(self.err, "{text}");
    }

    /// The first failure of some works; the others are said.
    fn first<const K: usize>(&mut self, done: [Result<(), Failure>; K]) -> Result<(), Failure> {
        let mut failures = done.into_iter().filter_map(Result::err);
        let first = failures.next().map_or(Ok(()), Err);
        failures.for_each(|failure| self.say(&format!("error: {failure}")));
        first
    }

    /// The outcome of a command whose history file could not be completed: the results are given all the same.
    fn but_lost(&mut self, unstored: Option<FileError>, given: Result<u8, Failure>) -> Result<u8, Failure> {
        let Some(error) = unstored else { return given };
        if let Err(failure) = given {
            self.say(&format!("error: {failure}"));
        }
        Err(error.into())
    }

    /// Says why nothing was done.
    fn refuse(&mut self, why: &str) -> u8 {
        self.say(&format!("error: {why}"));
        FAILED
    }

    /// Says that there is no estimate of the steps done before the interruption.
    fn interrupted_early(&mut self, error: &EstimateError) -> u8 {
        self.say(&format!("interrupted: {error}"));
        INTERRUPTED
    }

    /// Says how an estimate of the steps in a history is made, and how its run goes on.
    fn say_to_estimate(&mut self, history: &Path) {
        let file = history.display();
        self.say(&format!(
            "no estimate was made: `percute estimate {file}` estimates the steps done, and --resume continues"
        ));
    }

    /// Says how a run goes on of which something else than its history has failed.
    fn say_to_resume(&mut self, history: &Path) {
        self.say(&format!("the steps so far are in {}: the same command with --resume continues", history.display()));
    }

    /// Prints the plausibility warnings about a case and returns their names.
    fn warn_about(&mut self, case: &Case, quiet: bool) -> Vec<&'static str> {
        let warnings = if quiet { Vec::new() } else { case.plausibility_warnings(false) };
        self.warn(&warnings);
        warnings.iter().map(|warning| warning.name).collect()
    }

    /// Says warnings.
    fn warn<'w>(&mut self, warnings: impl IntoIterator<Item = &'w Warning>) {
        warnings.into_iter().for_each(|warning| self.say(&format!("warning: {}", warning.message)));
    }
}

/// The case with the end of its run; no case if the search for it was stopped.
fn resolved(case: &Case, quiet: bool, console: &mut Console<'_>) -> Result<Option<Case>, Failure> {
    let watch = &mut Watch::new(console.progress && !quiet, console.stop);
    let found = search(case, watch).map_err(|failure| located(case, failure))?;
    watch.clear();
    let Some(case) = found else {
        let work = if case.until.is_some() { "looking for the rebound" } else { "finding stable steps" };
        console.say(&format!("interrupted while {work}"));
        return Ok(None);
    };
    if !quiet {
        console.warn(&case.unended);
    }
    Ok(Some(case))
}

/// Reads and checks a case file.
fn case(file: &Path) -> Result<Case, Failure> {
    Ok(parse(read(file)?)?)
}

/// The file in the same folder that was likely meant.
fn similar(file: &Path) -> String {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let found = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let names: Vec<String> = found.filter_map(|entry| entry.file_name().into_string().ok()).collect();
    let given = file.file_name().unwrap_or_default().to_string_lossy();
    hint(&given, names.iter().map(String::as_str))
}

/// Reads a text; one that is no UTF-8 is refused with the line where it stops being so.
fn read(file: &Path) -> Result<Source, Failure> {
    let unreadable = |cause| Failure::Unreadable { file: file.to_path_buf(), cause };
    let name = file.display().to_string();
    if file.is_dir() {
        return Err(Failure::Argument(format!("{name}: this is a folder; name a case file in it")));
    }
    if !file.exists() {
        return Err(Failure::Argument(format!("{name}: there is no file of this name{}", similar(file))));
    }
    let kind = file.metadata().map_err(unreadable)?.file_type();
    if is_named_pipe(file) {
        let told = "this is a pipe, which may have no writer; name a case file, or give <(COMMAND)";
        return Err(Failure::Argument(format!("{name}: {told}")));
    }
    if !kind.is_file() && !is_pipe(kind) {
        return Err(Failure::Argument(format!("{name}: this is not a regular file; name a case file")));
    }
    // Asked first: a history may be larger than memory.
    let most = if is_hdf5(file).map_err(unreadable)? { BEGINNING } else { MOST + 1 };
    let mut bytes = Vec::new();
    File::open(file).and_then(|file| file.take(most).read_to_end(&mut bytes)).map_err(unreadable)?;
    if bytes.len() as u64 > MOST {
        return Err(Failure::Argument(format!("{name}: a case file has at most 1 GiB; name a mesh file in the case")));
    }
    if let Some(told) = stranger(file, &bytes) {
        return Err(Failure::Argument(format!("{name}: {told}")));
    }
    let folder = file.parent().unwrap_or(file);
    String::from_utf8(bytes).map(|text| Source::new(&name, text).in_folder(folder)).map_err(|error| {
        let line = 1 + error.as_bytes()[..error.utf8_error().valid_up_to()].iter().filter(|&&b| b == b'\n').count();
        Failure::Argument(format!("{name}:{line}: this is not UTF-8 text"))
    })
}
