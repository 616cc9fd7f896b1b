//! Independent runs side by side, their results in the order of what was asked.

use percute_core::observer::{Observer, Progress};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;
use std::time::Duration;

/// How often the observer is asked while nothing ends.
const BEAT: Duration = Duration::from_millis(50);

/// Asks, inside a run, whether to go on.
#[derive(Debug)]
pub(super) struct Stop<'a>(&'a AtomicBool);

impl Observer for Stop<'_> {
    fn observe(&mut self, _: Progress) -> ControlFlow<()> {
        if self.0.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// Works on each item with one of `threads` threads of its own; tells the observer how many are done. `None` if it broke.
///
/// Not a rayon pool: an estimate waits for a pool of its own, and a rayon worker that waits starts another item
/// meanwhile, so that more runs than threads would be in memory.
///
/// # Errors
/// The first error, in the order of the items, of those that were done when one was met.
pub(super) fn in_order<T: Sync, R: Send, E: Send>(
    stage: &'static str,
    threads: usize,
    items: &[T],
    observer: &mut dyn Observer,
    work: impl Fn(&T, &mut Stop<'_>) -> Result<R, E> + Sync,
) -> Result<Option<Vec<R>>, E> {
    let (next, stop) = (AtomicUsize::new(0), AtomicBool::new(false));
    let (sender, receiver) = mpsc::channel();
    let mut results: Vec<Option<Result<R, E>>> = items.iter().map(|_| None).collect();
    let mut broke = false;
    std::thread::scope(|scope| {
        for _ in 0..threads.clamp(1, items.len().max(1)) {
            let (sender, next, stop, work) = (sender.clone(), &next, &stop, &work);
            scope.spawn(move || {
                while !stop.load(Ordering::Relaxed) {
                    let i = next.fetch_add(1, Ordering::Relaxed);
                    let Some(item) = items.get(i) else { break };
                    if sender.send((i, work(item, &mut Stop(stop)))).is_err() {
                        break;
                    }
                }
            });
        }
        drop(sender);
        let mut done = 0;
        loop {
            match receiver.recv_timeout(BEAT) {
                Ok((i, result)) => {
                    done += 1;
                    if result.is_err() {
                        stop.store(true, Ordering::Relaxed);
                    }
                    results[i] = Some(result);
                }
                Err(mpsc::RecvTimeoutError::Timeout) => {}
                Err(mpsc::RecvTimeoutError::Disconnected) => break,
            }
            if observer.observe(Progress { stage, done, total: items.len() }).is_break() {
                broke = true;
                stop.store(true, Ordering::Relaxed);
            }
        }
    });
    if broke {
        return Ok(None);
    }
    // After an error some have no result.
    results.into_iter().flatten().collect::<Result<Vec<R>, E>>().map(Some)
}
