//! The `percute` command.

use percute::Console;
use std::io::{IsTerminal, stderr, stdout};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

static ASKED: AtomicBool = AtomicBool::new(false);

fn main() -> ExitCode {
    // The first Ctrl-C asks for a clean stop; a second one does not wait for it.
    #[allow(clippy::exit)]
    let handler = ctrlc::set_handler(|| {
        if ASKED.swap(true, Relaxed) {
            std::process::exit(130)
        }
    });
    let (mut out, mut err) = (stdout().lock(), stderr());
    let progress = handler.is_ok() && err.is_terminal();
    let interrupted = || ASKED.load(Relaxed);
    let mut console = Console { out: &mut out, err: &mut err, progress, interrupted: &interrupted };
    percute::command_line(std::env::args_os(), &mut console).into()
}
