//! The processes of a sweep.

use crate::attempt::{Attempt, CASE, State, clean, keep_results, state};
use crate::plan::Planned;
use percute_core::observer::{Observer, Progress};
use percute_system::ask_to_end;
use percute_workflow::Failure;
use std::collections::VecDeque;
use std::ffi::OsString;
use std::io;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// How often processes are asked whether they have ended.
const POLL: Duration = Duration::from_millis(10);
/// How long a process may take to stop when it is told to; percute takes less.
const PATIENCE: Duration = Duration::from_secs(2);

/// The variable of the environment with which a process of a sweep is to end as soon as its standard input does: its
/// sweep has ended.
pub const ENDS_WITH_INPUT: &str = "PERCUTE_ENDS_WITH_INPUT";

/// The exit code of an interrupted run.
const INTERRUPTED: i32 = 130;
/// Ctrl-C reaches all processes of a terminal at once; the observer hears of it this much later at most.
const LATER: Duration = Duration::from_millis(300);

/// How cases are run.
#[derive(Clone, Debug)]
pub struct Launch {
    /// The program `percute`, or an interpreter with its first arguments.
    pub command: Vec<OsString>,
    /// Processes at a time.
    pub jobs: usize,
    /// Threads of each.
    pub threads: usize,
    /// Whether long runs are allowed.
    pub long: bool,
    /// Whether all cases are run, and replace what is in their folders.
    pub again: bool,
}

/// What became of cases.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// Those that were done before.
    pub found: usize,
    /// Those that were done now.
    pub done: usize,
    /// Those that failed now.
    pub failed: usize,
    /// Those that were not run, because the work was stopped.
    pub left: usize,
}

impl Launch {
    /// One process for each core, with one thread each.
    #[must_use]
    pub fn of(command: Vec<OsString>) -> Self {
        let jobs = std::thread::available_parallelism().map_or(1, usize::from);
        Self { command, jobs, threads: 1, long: false, again: false }
    }

    fn start(&self, attempt: &Attempt) -> io::Result<Child> {
        let [result, messages] = attempt.streams()?;
        let (program, first) = self.command.split_first().ok_or(io::ErrorKind::InvalidInput)?;
        let mut command = Command::new(program);
        command.args(first).args(["run", CASE, "--json", "--threads"]).arg(self.threads.to_string());
        if self.long {
            command.arg("--long");
        }
        // Its input ends with this process, however that ends.
        command.current_dir(attempt.folder()).env(ENDS_WITH_INPUT, "1").stdin(Stdio::piped());
        command.stdout(result).stderr(messages).spawn()
    }
}

/// Runs those of the cases in `folder` that are not done. Each failure is handed to `tell` with the name of its case;
/// the others go on. If the observer breaks, all processes are stopped and their attempts removed.
///
/// # Errors
/// Results that would be lost, unless all cases are run again; a folder that cannot be written, a program that cannot
/// be started.
pub fn run<'c>(
    folder: &Path,
    cases: impl IntoIterator<Item = &'c Planned>,
    launch: &Launch,
    tell: &mut dyn FnMut(&str, &str),
    observer: &mut dyn Observer,
) -> Result<Count, Failure> {
    let all: Vec<&Planned> = cases.into_iter().collect();
    if !launch.again {
        keep_results(folder, all.iter().copied())?;
    }
    clean(folder);
    let is_open = |case: &&&Planned| launch.again || !matches!(state(folder, case), State::Done(_));
    let mut waiting: VecDeque<&Planned> = all.iter().filter(is_open).copied().collect();
    let mut count = Count { found: all.len() - waiting.len(), ..Count::default() };
    let (total, mut pool) = (waiting.len(), Pool(Vec::new()));
    let unwritable = |error: io::Error| Failure::unwritable("the folder of the sweep", folder, &error);
    loop {
        let done = count.done + count.failed;
        count.left = total - done;
        let mut stops = || observer.observe(Progress { stage: "running cases", done, total }).is_break();
        if stops() || count.left == 0 {
            // A process that was being started when its sweep was killed keeps the lock for some moments.
            clean(folder);
            return Ok(count);
        }
        while pool.0.len() < launch.jobs.max(1) {
            let Some(case) = waiting.pop_front() else { break };
            pool.0.push(Running::start(folder, case, launch).map_err(unwritable)?);
        }
        match pool.ended().map_err(unwritable)? {
            None => std::thread::sleep(POLL),
            Some((running, status)) if status.code() == Some(INTERRUPTED) && waited(&mut stops) => {
                running.attempt.give_up();
                return Ok(count);
            }
            Some((running, status)) => {
                let (name, failure) = running.end(status).map_err(unwritable)?;
                count.done += usize::from(failure.is_none());
                count.failed += usize::from(failure.is_some());
                failure.iter().for_each(|reason| tell(&name, reason));
            }
        }
    }
}

/// Whether the observer breaks, at once or a little later.
fn waited(stops: &mut dyn FnMut() -> bool) -> bool {
    let start = Instant::now();
    while start.elapsed() < LATER {
        if stops() {
            return true;
        }
        std::thread::sleep(POLL);
    }
    false
}

/// A case in a process.
struct Running {
    name: String,
    child: Child,
    attempt: Attempt,
}

impl Running {
    fn start(folder: &Path, case: &Planned, launch: &Launch) -> io::Result<Self> {
        let attempt = Attempt::begin(folder, case)?;
        match launch.start(&attempt) {
            Ok(child) => Ok(Self { name: case.name.clone(), child, attempt }),
            Err(error) => {
                attempt.give_up();
                Err(error)
            }
        }
    }

    /// Puts the folder in its place. Gives the name, and the reason of a failure.
    fn end(self, status: ExitStatus) -> io::Result<(String, Option<String>)> {
        let failure = (!status.success()).then(|| match self.attempt.said() {
            // A process that was killed has not said why.
            silent if silent.trim().is_empty() => format!("error: the run ended with {status}"),
            said => said,
        });
        self.attempt.finish(failure.as_deref())?;
        Ok((self.name, failure))
    }
}

/// The processes at work; those that are left when this is dropped are stopped.
struct Pool(Vec<Running>);

impl Pool {
    /// Takes a process out that has ended.
    fn ended(&mut self) -> io::Result<Option<(Running, ExitStatus)>> {
        for at in 0..self.0.len() {
            if let Some(status) = self.0[at].child.try_wait()? {
                return Ok(Some((self.0.remove(at), status)));
            }
        }
        Ok(None)
    }
}

impl Drop for Pool {
    fn drop(&mut self) {
        self.0.iter_mut().for_each(|running| ask_to_end(&mut running.child));
        let start = Instant::now();
        for mut running in self.0.drain(..) {
            while start.elapsed() < PATIENCE && matches!(running.child.try_wait(), Ok(None)) {
                std::thread::sleep(POLL);
            }
            let _ = running.child.kill();
            let _ = running.child.wait();
            running.attempt.give_up();
        }
    }
}
