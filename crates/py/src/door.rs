//! The one door between Python and the work.
//!
//! Work runs in a thread of its own and owns what it needs. The calling thread waits without the GIL, so that
//! other Python threads run, and takes it every 50 ms to look for signals and to tell progress. So Ctrl-C is
//! heard whatever the work is doing; work that cannot stop at once is told to stop and left behind.

use crate::errors::percute_error;
use percute_core::observer::{Observer, Progress};
use pyo3::prelude::*;
use std::any::Any;
use std::borrow::Cow;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// How often signals are looked for.
const POLL: Duration = Duration::from_millis(50);
/// How long work that was told to stop is waited for: with the above, well below half a second.
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
pub(crate) struct Errand {
    stop: AtomicBool,
    progress: Mutex<Option<Progress>>,
}

impl Errand {
    /// Whether the work should stop.
    pub(crate) fn stopped(&self) -> bool {
        self.stop.load(Relaxed)
    }

    fn progress(&self) -> Option<Progress> {
        *self.progress.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The work's side of an errand.
#[derive(Clone, Debug)]
pub(crate) struct Watch(pub(crate) Arc<Errand>);

impl Observer for Watch {
    fn observe(&mut self, progress: Progress) -> ControlFlow<()> {
        *self.0.progress.lock().unwrap_or_else(PoisonError::into_inner) = Some(progress);
        if self.0.stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// Does work in a thread of its own and returns what it gives.
///
/// # Errors
/// What a signal handler or `tell`, the progress callback, raised; a panic of the work.
pub(crate) fn through<T: Send + 'static>(
    py: Python<'_>,
    tell: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(Watch) -> T + Send + 'static,
) -> PyResult<T> {
    let watch = Watch(Arc::default());
    let errand = watch.0.clone();
    let (sender, mut receiver) = sync_channel(1);
    // Nobody listens to work that was left behind.
    let job = move || _ = sender.send(work(watch));
    let worker = std::thread::Builder::new().name("percute".into()).spawn(job)?;
    let waited = wait(py, &errand, &mut receiver, tell);
    if waited.is_err() {
        errand.stop.store(true, Relaxed);
        let receiver = &mut receiver;
        py.detach(move || _ = receiver.recv_timeout(GRACE));
    }
    match waited? {
        Some(done) => Ok(done),
        // Only a panic ends the work without an outcome.
        None => {
            Err(percute_error(py, &format!("internal error, please report it: {}", panic_message(worker.join().err()))))
        }
    }
}

/// Waits for the outcome; `None` if the work ended without.
fn wait<T: Send>(
    py: Python<'_>,
    errand: &Errand,
    receiver: &mut Receiver<T>,
    tell: Option<&Bound<'_, PyAny>>,
) -> PyResult<Option<T>> {
    let mut told = None;
    loop {
        let receiver = &mut *receiver;
        match py.detach(move || receiver.recv_timeout(POLL)) {
            Ok(outcome) => {
                tell_progress(tell, errand, &mut told)?;
                return Ok(Some(outcome));
            }
            Err(RecvTimeoutError::Disconnected) => return Ok(None),
            Err(RecvTimeoutError::Timeout) => {
                py.check_signals()?;
                tell_progress(tell, errand, &mut told)?;
            }
        }
    }
}

fn tell_progress(tell: Option<&Bound<'_, PyAny>>, errand: &Errand, told: &mut Option<Progress>) -> PyResult<()> {
    let (Some(tell), Some(now)) = (tell, errand.progress()) else { return Ok(()) };
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
