//! The command as a process: standard output and error, a terminal, signals.

use crate::command::{Console, command_line};
use crate::exit::INTERRUPTED;
use std::ffi::OsString;
use std::io::{IsTerminal, Write, stderr, stdout};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::{Duration, Instant};

static ASKED: AtomicBool = AtomicBool::new(false);
/// Whether the command has seen that it was asked to stop.
static HEARD: AtomicBool = AtomicBool::new(false);

/// How long a command may take to see it; what does not look up, such as the set-up of a large mesh or a pipe without a
/// writer, is ended then.
const PATIENCE: Duration = Duration::from_millis(300);
const PAUSE: Duration = Duration::from_millis(10);

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
    ASKED.store(false, Relaxed);
    HEARD.store(false, Relaxed);
    // A second command in one process finds the handler of the first in place.
    let _ = ctrlc::set_handler(asked);
    let (mut out, mut err) = (stdout().lock(), stderr());
    let (progress, interrupted) = (err.is_terminal(), || {
        ASKED.load(Relaxed) && {
            HEARD.store(true, Relaxed);
            true
        }
    });
    let console = &mut Console { out: &mut out, err: &mut err, progress, interrupted: &interrupted, itself };
    let code = command_line(arguments, console);
    // Only Rust's own `main` would do it at the end.
    let _ = out.flush();
    HEARD.store(true, Relaxed);
    code
}

/// A signal has come.
fn asked() {
    let again = ASKED.swap(true, Relaxed);
    let start = Instant::now();
    while !again && start.elapsed() < PATIENCE {
        std::thread::sleep(PAUSE);
        if HEARD.load(Relaxed) {
            return;
        }
    }
    percute_io::remove_unfinished();
    #[allow(clippy::exit)]
    std::process::exit(INTERRUPTED.into());
}
