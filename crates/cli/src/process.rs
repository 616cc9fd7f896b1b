//! The command as a process: standard output and error, a terminal, signals.

use crate::command::{Console, command_line};
use crate::exit::INTERRUPTED;
use crate::stop::{Answer, Stop};
use percute_sweep::ENDS_WITH_INPUT;
use std::ffi::OsString;
use std::io::{IsTerminal, Write, stderr, stdin, stdout};
use std::sync::LazyLock;
use std::time::Duration;

static STOP: LazyLock<Stop> = LazyLock::new(Stop::new);

/// How long a command may take to see that it is to stop, unless it is at its steps.
const PATIENCE: Duration = Duration::from_millis(300);

/// Runs the command with these arguments, the program's name first, on the standard output and
/// error of this process, and returns its exit code.
///
/// From here on Ctrl-C is the command's, not the caller's: the first asks for a clean stop, and ends the process if the
/// command is not at its steps; a second one ends the process; so do SIGTERM and SIGHUP, with which batch systems and
/// terminals end what they run. Where no handler can be set, the first ends it.
///
/// `itself` is the command with which processes of its own are started: a program and its first arguments.
pub fn process<I>(arguments: I, itself: &[OsString]) -> u8
where
    I: IntoIterator,
    I::Item: Into<OsString> + Clone,
{
    survive_limits();
    if std::env::var_os(ENDS_WITH_INPUT).is_some() {
        std::thread::spawn(end_with_input);
    }
    STOP.begin();
    // A second command in one process finds the handler of the first in place.
    let _ = ctrlc::set_handler(asked);
    let (mut out, mut err) = (stdout().lock(), stderr());
    let console = &mut Console { progress: err.is_terminal(), out: &mut out, err: &mut err, stop: &STOP, itself };
    let code = command_line(arguments, console);
    // Only Rust's own `main` would do it at the end.
    let _ = out.flush();
    STOP.end();
    code
}

/// Lets a write beyond the limit on the size of files fail, as one to a full disk does. It would end the process.
#[cfg(unix)]
fn survive_limits() {
    // Nobody asks for the flag. Where it cannot be set, the process ends at the limit.
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, std::sync::Arc::default());
}

#[cfg(not(unix))]
fn survive_limits() {}

/// Ends the process as soon as its standard input ends.
fn end_with_input() {
    let _ = std::io::copy(&mut stdin(), &mut std::io::sink());
    leave();
}

/// A signal has come.
fn asked() {
    if !STOP.ask() {
        match STOP.answer(PATIENCE) {
            Answer::Heard => return,
            // The next signal must find this function free.
            Answer::Later => {
                let _ = writeln!(stderr(), "interrupted: the steps in work are completed; Ctrl-C again ends at once");
                return;
            }
            Answer::None => {}
        }
    }
    leave();
}

/// Ends the process at once, without files of no use.
fn leave() -> ! {
    percute_io::remove_unfinished();
    #[allow(clippy::exit)]
    std::process::exit(INTERRUPTED.into());
}
