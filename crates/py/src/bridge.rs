//! The blocking bridge between Python and the work.
//!
//! Each task runs in a thread of its own and owns its data. The calling thread waits without the GIL, so that
//! other Python threads run. Every 50 ms it takes the GIL, checks for signals and reports progress. Ctrl-C thus
//! works during any task; a task that cannot stop at once gets the order to stop and ends later. A task that writes a
//! file is waited for until the file is closed, so that it is complete before the exception is raised and before the
//! interpreter ends.

use crate::errors::percute_error;
use percute_core::observer::{Observer, Progress, StopFlag};
use pyo3::prelude::*;
use std::any::Any;
use std::borrow::Cow;
use std::convert::Infallible;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError, Weak};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// How often signals are checked.
const POLL: Duration = Duration::from_millis(50);
/// How long the caller waits for a task that has the order to stop: with the above, well below half a second.
const GRACE: Duration = Duration::from_millis(200);

/// How far a computation is, as a progress callback gets it.
#[pyclass(frozen, get_all, name = "Progress", module = "percute")]
pub(crate) struct ProgressNow {
    /// What is being done: "simulating", "estimating", or the name of a study.
    stage: Cow<'static, str>,
    /// Steps done.
    done: usize,
    /// Steps in all.
    total: usize,
}

#[pymethods]
impl ProgressNow {
    #[new]
    fn new(stage: String, done: usize, total: usize) -> Self {
        Self { stage: stage.into(), done, total }
    }

    fn __repr__(&self) -> String {
        format!("Progress(stage='{}', done={}, total={})", self.stage, self.done, self.total)
    }
}

/// What the caller and the work share.
#[derive(Debug, Default)]
pub(crate) struct Task {
    stop: StopFlag,
    /// Whether a file is being written.
    writing: AtomicBool,
    progress: Mutex<Option<Progress>>,
}

/// Tasks that write a file, with their process: a forked one does not have them. The end of the interpreter waits for
/// them.
static WRITERS: Mutex<Vec<(u32, Weak<Task>)>> = Mutex::new(Vec::new());

/// The time during which a task writes a file; it ends when this is dropped.
#[derive(Debug)]
pub(crate) struct Writing(Arc<Task>);

impl Drop for Writing {
    fn drop(&mut self) {
        self.0.writing.store(false, Relaxed);
    }
}

impl Task {
    /// Whether the work should stop.
    pub(crate) fn stopped(&self) -> bool {
        self.stop.is_up()
    }

    fn is_writing(&self) -> bool {
        self.writing.load(Relaxed)
    }

    fn progress(&self) -> Option<Progress> {
        *self.progress.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The work's side of a task.
#[derive(Clone, Debug)]
pub(crate) struct Watch(pub(crate) Arc<Task>);

impl Writing {
    fn of(task: &Arc<Task>) -> Self {
        let mut writers = WRITERS.lock().unwrap_or_else(PoisonError::into_inner);
        writers.retain(|(_, task)| task.upgrade().is_some_and(|task| task.is_writing()));
        writers.push((std::process::id(), Arc::downgrade(task)));
        task.writing.store(true, Relaxed);
        Self(task.clone())
    }
}

impl Observer for Watch {
    fn observe(&mut self, progress: Progress) -> ControlFlow<()> {
        *self.0.progress.lock().unwrap_or_else(PoisonError::into_inner) = Some(progress);
        if self.0.stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn flag(&self) -> StopFlag {
        self.0.stop.clone()
    }
}

/// Does work in a thread of its own and returns its result.
///
/// # Errors
/// What a signal handler or `tell`, the progress callback, raised; a panic of the work.
pub(crate) fn blocking<T: Send + 'static>(
    py: Python<'_>,
    tell: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(Watch) -> T + Send + 'static,
) -> PyResult<T> {
    carry_out(py, tell, &Arc::default(), work)
}

/// The same for work that writes a file until it drops its [`Writing`]: an exception is raised after that.
///
/// # Errors
/// As [`blocking`].
pub(crate) fn writing<T: Send + 'static>(
    py: Python<'_>,
    tell: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(Watch, Writing) -> T + Send + 'static,
) -> PyResult<T> {
    let task = Arc::default();
    let writing = Writing::of(&task);
    carry_out(py, tell, &task, move |watch| work(watch, writing))
}

fn carry_out<T: Send + 'static>(
    py: Python<'_>,
    tell: Option<&Bound<'_, PyAny>>,
    task: &Arc<Task>,
    work: impl FnOnce(Watch) -> T + Send + 'static,
) -> PyResult<T> {
    let outcome = Arc::new(Mutex::new(None));
    let (watch, place) = (Watch(task.clone()), outcome.clone());
    // The thread and the wait for it do not know the outcome, so that they are compiled once for all kinds.
    let job = Box::new(move || {
        let done = work(watch);
        *place.lock().unwrap_or_else(PoisonError::into_inner) = Some(done);
    });
    let end = run(py, tell, task, job)?;
    let done = outcome.lock().unwrap_or_else(PoisonError::into_inner).take();
    // Only a panic ends the work without an outcome.
    done.ok_or_else(|| {
        percute_error(py, &format!("internal error, please report it: {}", panic_message(end.join().err())))
    })
}

/// Does a job in a thread of its own and waits for its end.
fn run(
    py: Python<'_>,
    tell: Option<&Bound<'_, PyAny>>,
    task: &Arc<Task>,
    job: Box<dyn FnOnce() + Send>,
) -> PyResult<JoinHandle<()>> {
    let (sender, mut end) = sync_channel(0);
    let thread = move || {
        // Dropped at the end, by a panic as well: the receiver then knows it.
        let _sender = sender;
        job();
    };
    let worker = std::thread::Builder::new().name("percute".into()).spawn(thread)?;
    let waited = wait(py, task, &mut end, tell);
    if waited.is_err() {
        task.stop.set(true);
        leave(py, task, &mut end);
    }
    waited.map(|()| worker)
}

/// Waits for the end of the work.
fn wait(py: Python<'_>, task: &Task, end: &mut Receiver<Infallible>, tell: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
    let mut told = None;
    while is_at_work(py, end) {
        py.check_signals()?;
        tell_progress(tell, task, &mut told)?;
    }
    tell_progress(tell, task, &mut told)
}

/// Waits for a task that has the order to stop: for [`GRACE`], and as long as it writes a file. A second signal ends
/// the wait; the end of the interpreter then waits for the file.
fn leave(py: Python<'_>, task: &Task, end: &mut Receiver<Infallible>) {
    let start = Instant::now();
    while start.elapsed() < GRACE || task.is_writing() {
        if !is_at_work(py, end) || py.check_signals().is_err() {
            return;
        }
    }
}

/// Whether the work goes on after [`POLL`].
fn is_at_work(py: Python<'_>, end: &mut Receiver<Infallible>) -> bool {
    let answer = py.detach(move || end.recv_timeout(POLL));
    matches!(answer, Err(RecvTimeoutError::Timeout))
}

/// Stops all tasks that write a file and waits until the files are closed: the last act before the interpreter ends.
#[pyfunction]
pub(crate) fn close_files(py: Python<'_>) {
    let writers = std::mem::take(&mut *WRITERS.lock().unwrap_or_else(PoisonError::into_inner));
    let ours = writers.iter().filter(|(process, _)| *process == std::process::id());
    let writers: Vec<Arc<Task>> = ours.filter_map(|(_, task)| task.upgrade()).collect();
    for task in &writers {
        task.stop.set(true);
    }
    while writers.iter().any(|task| task.is_writing()) && py.check_signals().is_ok() {
        py.detach(|| std::thread::sleep(POLL));
    }
}

fn tell_progress(tell: Option<&Bound<'_, PyAny>>, task: &Task, told: &mut Option<Progress>) -> PyResult<()> {
    let (Some(tell), Some(now)) = (tell, task.progress()) else { return Ok(()) };
    if *told != Some(now) {
        *told = Some(now);
        tell.call1((ProgressNow { stage: now.stage.into(), done: now.done, total: now.total },))?;
    }
    Ok(())
}

fn panic_message(payload: Option<Box<dyn Any + Send>>) -> String {
    let text = payload.and_then(|p| {
        let fixed = p.downcast_ref::<&str>().map(ToString::to_string);
        fixed.or_else(|| p.downcast_ref::<String>().cloned())
    });
    text.unwrap_or_else(|| "no reason is known".to_string())
}
