//! The command as a process: standard output and error, a terminal, signals.

use crate::command::{Console, command_line};
use crate::exit::INTERRUPTED;
use std::ffi::OsString;
use std::io::{IsTerminal, Write, stderr, stdout};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

static ASKED: AtomicBool = AtomicBool::new(false);

/// Runs the command with these arguments, the program's name first, on the standard output and
/// error of this process, and returns its exit code.
///
/// From here on Ctrl-C is the command's, not the caller's: the first asks for a clean stop, a
/// second one ends the process; so do SIGTERM and SIGHUP, with which batch systems and terminals end
/// what they run. Where no handler can be set, the first ends it.
pub fn process<I>(arguments: I) -> u8
where
    I: IntoIterator,
    I::Item: Into<OsString> + Clone,
{
    ASKED.store(false, Relaxed);
    #[allow(clippy::exit)]
    let exit = || std::process::exit(INTERRUPTED.into());
    // A second command in one process finds the handler of the first in place.
    let _ = ctrlc::set_handler(move || _ = ASKED.swap(true, Relaxed).then(exit));
    let (mut out, mut err) = (stdout().lock(), stderr());
    let (progress, interrupted) = (err.is_terminal(), || ASKED.load(Relaxed));
    let code =
        command_line(arguments, &mut Console { out: &mut out, err: &mut err, progress, interrupted: &interrupted });
    // Only Rust's own `main` would do it at the end.
    let _ = out.flush();
    code
}
