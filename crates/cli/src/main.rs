//! The `percute` command.

use std::io::{IsTerminal, stderr, stdout};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

static ASKED: AtomicBool = AtomicBool::new(false);

fn main() -> std::process::ExitCode {
    // The first Ctrl-C asks for a clean stop, a second one does not wait for it. Where no handler
    // can be set, the first ends the process.
    #[allow(clippy::exit)]
    let exit = || std::process::exit(percute::INTERRUPTED.into());
    let _ = ctrlc::set_handler(move || _ = ASKED.swap(true, Relaxed).then(exit));
    let (mut out, mut err) = (stdout().lock(), stderr());
    let (progress, interrupted) = (err.is_terminal(), || ASKED.load(Relaxed));
    let mut console = percute::Console { out: &mut out, err: &mut err, progress, interrupted: &interrupted };
    percute::command_line(std::env::args_os(), &mut console).into()
}
