//! Independent runs side by side, their results in the order of what was asked.

use crate::reproduce::ReproduceError;
use percute_core::observer::{Observer, Progress};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;
use std::time::Duration;

/// How often the observer is asked while nothing ends.
const BEAT: Duration = Duration::from_millis(50);

/// Asks, inside a run, whether to go on.
#[derive(Debug)]
struct Stop<'a>(&'a AtomicBool);

impl Observer for Stop<'_> {
    fn observe(&mut self, _: Progress) -> ControlFlow<()> {
        if self.0.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// How many threads to use if nothing is said: one for each core.
pub(super) fn threads(wanted: Option<usize>) -> usize {
    wanted.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, std::num::NonZero::get))
}

/// Works on each item with `threads` threads, from the last item on, for long ones stand last, and tells the observer how
/// many are done. The results are in the order of the items.
///
/// Not a rayon pool: an estimate waits for a pool of its own, and a rayon worker that waits starts another item
/// meanwhile, so that more runs than threads would be in memory.
///
/// # Errors
/// [`ReproduceError::Interrupted`] if the observer breaks; else the error that was met first.
pub(super) fn in_order<T: Sync, R: Send>(
    stage: &'static str,
    threads: usize,
    items: &[T],
    observer: &mut dyn Observer,
    work: impl Fn(&T, &mut dyn Observer) -> Result<R, ReproduceError> + Sync,
) -> Result<Vec<R>, ReproduceError> {
    let (begun, stop) = (AtomicUsize::new(0), AtomicBool::new(false));
    let (sender, receiver) = mpsc::channel();
    let mut results: Vec<Option<R>> = items.iter().map(|_| None).collect();
    let mut failure = None;
    std::thread::scope(|scope| {
        for _ in 0..threads.clamp(1, items.len().max(1)) {
            let (sender, begun, stop, work) = (sender.clone(), &begun, &stop, &work);
            scope.spawn(move || {
                while !stop.load(Ordering::Relaxed) {
                    let taken = begun.fetch_add(1, Ordering::Relaxed) + 1;
                    let Some(i) = items.len().checked_sub(taken) else { break };
                    if sender.send((i, work(&items[i], &mut Stop(stop)))).is_err() {
                        break;
                    }
                }
            });
        }
        drop(sender);
        let mut done = 0;
        loop {
            match receiver.recv_timeout(BEAT) {
                Ok((i, Ok(result))) => {
                    results[i] = Some(result);
                    done += 1;
                }
                // Later ones may be what stopping did to runs.
                Ok((_, Err(error))) => failure = failure.take().or(Some(error)),
                Err(mpsc::RecvTimeoutError::Timeout) => {}
                Err(mpsc::RecvTimeoutError::Disconnected) => break,
            }
            if failure.is_none() && observer.observe(Progress { stage, done, total: items.len() }).is_break() {
                failure = Some(ReproduceError::Interrupted);
            }
            stop.fetch_or(failure.is_some(), Ordering::Relaxed);
        }
    });
    failure.map_or_else(|| Ok(results.into_iter().flatten().collect()), Err)
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::observer::Unobserved;

    #[test]
    fn results_are_in_the_order_of_the_items() {
        let items: Vec<usize> = (0..100).collect();
        for threads in [1, 3, 200] {
            let squares = in_order("squares", threads, &items, &mut Unobserved, |i, _| Ok(i * i)).unwrap();
            assert!(squares.iter().enumerate().all(|(i, square)| *square == i * i) && squares.len() == 100);
        }
        assert!(in_order("none", 2, &[], &mut Unobserved, |_: &usize, _| Ok(0)).unwrap().is_empty());
    }

    /// The other runs are told to stop, and what they then say is not taken for the reason.
    #[test]
    fn the_first_error_is_the_one() {
        let error = |text: &str| ReproduceError::Unexpected(text.to_string());
        let work = |&last: &bool, stop: &mut dyn Observer| -> Result<(), ReproduceError> {
            if last {
                return Err(error("the reason"));
            }
            while stop.observe(Progress { stage: "wait", done: 0, total: 1 }).is_continue() {
                std::thread::yield_now();
            }
            Err(error("stopped"))
        };
        let told = in_order("errors", 2, &[false, true], &mut Unobserved, work).unwrap_err();
        assert_eq!(told.to_string(), "the reason");
    }

    #[test]
    fn an_observer_that_breaks_ends_all_runs() {
        let work = |_: &u8, stop: &mut dyn Observer| {
            while stop.observe(Progress { stage: "wait", done: 0, total: 1 }).is_continue() {
                std::thread::yield_now();
            }
            Ok(())
        };
        let told = in_order("runs", 2, &[0; 5], &mut |_: Progress| ControlFlow::Break(()), work);
        assert!(matches!(told, Err(ReproduceError::Interrupted)));
    }
}
