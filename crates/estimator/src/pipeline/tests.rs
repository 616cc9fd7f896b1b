//! Intervals that wait: their memory is limited, and the temporary file changes no result.

use super::fixture::impact;
use super::*;
use crate::options::Reconstruction;
use crate::scratch_file::ScratchFile;
use percute_core::contact::Obstacle;
use percute_core::dynamics::{SimulationError, critical_time_step, simulate};
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::observer::{Progress, StopFlag, Unobserved};
use percute_core::problem::{Initial, Problem};
use std::ops::ControlFlow;

/// A low, wide block that strikes a plane and flies off: most nodes never touch again.
fn rebound() -> Problem<2> {
    Problem::<2>::builder(Mesh::rectangle(0.04, 0.001, 40, 1).unwrap())
        .material(Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap())
        .initial_velocity(Initial::Uniform([2.0, -10.0]))
        .obstacle(Obstacle::plane([0.0, -1e-5], [0.0, 1.0], 0.2, Some("bottom".to_string())).unwrap())
        .build()
        .unwrap()
}

fn instants(problem: &Problem<2>, steps: usize) -> TimeGrid {
    TimeGrid::uniform(steps as f64 * 0.9 * critical_time_step(problem), steps).unwrap()
}

/// An estimate of every step, and the most bytes that have waited in memory.
struct Watched<'p> {
    pipeline: Pipeline<'p, 2, 3>,
    most: usize,
}

impl<'p> Watched<'p> {
    fn new(problem: &'p Problem<2>, times: &'p TimeGrid) -> Self {
        let options = Options {
            reconstruction: Reconstruction::Consistent,
            every: Sampling::Every(1),
            threads: Some(1),
            ..Options::default()
        };
        Self { pipeline: Pipeline::<2, 3>::new(problem, times, options).unwrap(), most: 0 }
    }

    fn run(&mut self) -> Result<(), SimulationError> {
        let (problem, times) = (self.pipeline.problem, self.pipeline.times);
        simulate(problem, times, self, &mut Unobserved).map(|_| ())
    }
}

impl StateSink for Watched<'_> {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        self.pipeline.accept(state)?;
        let Pipeline { preparation, window, .. } = &mut self.pipeline;
        self.most = self.most.max(preparation.tracks().held() + window.near_mut().held());
        Ok(())
    }
}

/// Memory of intervals that wait (bytes), of which 1000 steps need more.
const LIMIT: usize = 1 << 20;

/// Four times as many steps take the same memory within 10 %; without the limit they take almost four times as much,
/// and both estimates have the same bits.
#[test]
fn memory_does_not_grow_with_the_steps() {
    let problem = rebound();
    let run = |steps: usize, limited: bool| {
        let times = instants(&problem, steps);
        let mut watched = Watched::new(&problem, &times);
        if !limited {
            watched.pipeline.preparation.tracks_mut().lift_limit();
        }
        watched.pipeline.window.near_mut().backlog_mut().limit(if limited { LIMIT } else { usize::MAX });
        watched.run().unwrap();
        assert_eq!(watched.pipeline.window.near_mut().backlog_mut().has_been_in_file(), limited);
        (watched.most, Box::new(watched.pipeline).finish().unwrap())
    };
    let [(short, _), (long, estimate)] = [1000, 4000].map(|steps| run(steps, true));
    let [(_, _), (unlimited, same)] = [1000, 4000].map(|steps| run(steps, false));
    assert!(10 * long < 11 * short, "{long} bytes instead of {short}");
    assert!(unlimited > 3 * short, "{unlimited} bytes without limit, {short} with it");
    assert_eq!(estimate, same);
}

/// A file that cannot be made ends the run with an error.
#[test]
fn a_file_that_fails_is_an_error() {
    let problem = rebound();
    let times = instants(&problem, 1000);
    let mut watched = Watched::new(&problem, &times);
    watched.pipeline.window.near_mut().backlog_mut().limit(LIMIT);
    watched.pipeline.window.near_mut().backlog_mut().wait_in(ScratchFile::within("/no/such/folder".into()));
    let Err(SimulationError::Sink { cause, step }) = watched.run() else { panic!("no error") };
    assert!(step > 10, "{step}");
    assert!(matches!(cause.downcast_ref(), Some(EstimateError::Scratch(_))), "{cause}");
}

/// The estimate of a short run that is stopped once this step was taken in; only a `large` mesh is left in the middle
/// of its work.
fn stopped(problem: &Problem<2>, times: &TimeGrid, step: usize, large: bool) -> Result<Estimate, EstimateError> {
    let options = Options { every: Sampling::Every(1), threads: Some(1), ..Options::default() };
    let flag = StopFlag::default();
    let mut pipeline = Pipeline::<2, 3>::new(problem, times, options).unwrap();
    pipeline.stop_at(flag.clone());
    if large {
        pipeline.window.stop_at(flag.clone());
    }
    let watch = &mut |progress: Progress| {
        flag.set(progress.done >= step);
        ControlFlow::Continue(())
    };
    simulate(problem, times, &mut pipeline, watch).unwrap();
    Box::new(pipeline).finish()
}

/// A stop drops the windows from then on. What is kept has the bits of the whole estimate, and the contributions of the
/// elements still add up to the mean.
#[test]
fn a_stop_keeps_the_windows_before_it() {
    let (problem, times) = impact();
    let whole = stopped(&problem, &times, usize::MAX, true).unwrap();
    assert_eq!((whole.steps, whole.over_time.len()), (20, 41));
    // Eight levels are a window; the first ends with step 7, and is ready when step 9 is.
    for (step, last) in [(10, 7), (15, 7), (17, 15), (19, 15)] {
        let kept = stopped(&problem, &times, step, true).unwrap();
        assert_eq!((kept.steps, kept.end), (last, times.instants()[last]), "stopped at step {step}");
        assert_eq!(kept.over_time, whole.over_time[..2 * last + 1]);
        let sum: f64 = kept.by_element.iter().map(|e| e * e).sum();
        // Sums of some hundred terms in another order.
        assert!((sum / kept.error.mean.powi(2) - 1.0).abs() < 1e-12, "stopped at step {step}: {sum}");
        assert_eq!(kept.sources.unwrap().over_time, whole.sources.as_ref().unwrap().over_time[..2 * last + 1]);
    }
    assert_eq!(stopped(&problem, &times, 5, true), Err(EstimateError::Stopped));
    assert_eq!(stopped(&problem, &times, 5, false).unwrap(), whole);
}
