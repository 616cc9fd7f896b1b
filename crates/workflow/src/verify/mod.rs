//! A problem on its mesh and on nested refinements of it: estimates beside true errors against the finest.
//!
//! All meshes have the Courant number of the first. The finest is simulated twice: with its estimate, and beside the comparison, which
//! does not store its steps.

mod criterion;
mod levels;
mod table;

pub use criterion::Settled;
pub use levels::{Cost, Level, Orders, Verification};
pub use table::{announced, table};

use crate::case::{Source, problem_from, statement};
use crate::failure::Failure;
use crate::report::{Report, Subject};
use crate::run::{Analysis, Results, Storage, TakeStep, run, true_errors};
use percute_core::dynamics::critical_time_step;
use percute_core::history::{History, Step};
use percute_core::observer::Observer;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use percute_estimator::Options;
use std::ops::ControlFlow;

/// The most refinements: each has eight times the work of the one before.
pub const MOST_LEVELS: usize = 5;

/// A problem on one of the meshes, ready to run.
#[derive(Clone, Debug)]
pub struct Prepared<const D: usize, const N: usize> {
    problem: Problem<D, N>,
    times: TimeGrid,
    critical_step: f64,
}

/// The problem on its mesh and on `levels` refinements.
///
/// # Errors
/// A number of refinements out of range, a problem that the case language cannot say, a mesh that cannot be refined.
pub fn prepare<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    times: &TimeGrid,
    levels: usize,
) -> Result<Vec<Prepared<D, N>>, Failure> {
    if !(1..=MOST_LEVELS).contains(&levels) {
        return Err(Failure::Argument(format!("`levels` is {levels}; give 1 to {MOST_LEVELS} refinements")));
    }
    let stated = Source::new("the refined problem", statement(problem, None)?);
    let critical_step = critical_time_step(problem);
    let courant = times.longest_step() / critical_step;
    let mut all = vec![Prepared { problem: problem.clone(), times: times.clone(), critical_step }];
    for _ in 0..levels {
        let coarse = &all[all.len() - 1].problem;
        let mesh = coarse.mesh();
        let fine = mesh.refined().map_err(|error| Failure::Argument(format!("the mesh cannot be refined: {error}")))?;
        let initial = [coarse.initial_displacement(), coarse.initial_velocity()].map(|field| mesh.prolonged(field));
        let [displacement, velocity] = initial;
        let (problem, _) = problem_from(&stated, fine, displacement, velocity)?;
        let critical_step = critical_time_step(&problem);
        let times = TimeGrid::with_step(times.end(), courant * critical_step);
        let times = times.map_err(|error| Failure::Argument(error.to_string()))?;
        all.push(Prepared { problem, times, critical_step });
    }
    Ok(all)
}

/// The work before it starts.
#[must_use]
pub fn cost<const D: usize, const N: usize>(prepared: &[Prepared<D, N>], options: &Options) -> Cost {
    Cost::new(prepared.iter().map(|each| levels::Work::new(&each.problem, &each.times, options)).collect())
}

/// Runs all meshes and compares them with the finest. If the observer breaks, the levels done remain, and the finest of them is the
/// reference.
///
/// # Errors
/// As [`run`] and [`true_errors`].
pub fn verify<const D: usize, const N: usize>(
    prepared: &[Prepared<D, N>],
    options: Options,
    observer: &mut dyn Observer,
) -> Result<Verification, Failure> {
    let (mut levels, mut histories) = (Vec::new(), Vec::new());
    let mut stopped = false;
    for (k, each) in prepared.iter().enumerate() {
        let Prepared { problem, times, .. } = each;
        // The steps of the finest are not kept.
        let mut history = (k + 1 < prepared.len()).then(|| History::new(times));
        let mut keep = history.as_mut().map(|history| |step: &Step<'_, D>| history.push(step));
        let memory = keep.as_mut().map(|keep| keep as &mut TakeStep<'_, D>);
        let analysis = Analysis { options, ..Analysis::default() };
        let results = run(problem, times, &analysis, Storage { file: None, memory, open: None }, observer);
        let results = match results {
            Err(_) if stopped_now(observer) && !levels.is_empty() => {
                stopped = true;
                break;
            }
            other => other?,
        };
        if results.simulation.interrupted || results.estimate.steps < times.step_count() {
            stopped = true;
            break;
        }
        levels.push(each.level(options, &results));
        histories.extend(history);
    }
    let finest = levels.len().saturating_sub(1);
    let mut compared = compare(prepared, &mut levels, &histories, finest, observer);
    if compared.is_err() && stopped_now(observer) {
        stopped = true;
        compared = compare(prepared, &mut levels, &histories, finest.saturating_sub(1), observer);
    }
    Ok(Verification::new(levels, compared?, stopped))
}

impl<const D: usize, const N: usize> Prepared<D, N> {
    fn level(&self, options: Options, results: &Results<D>) -> Level {
        let Self { problem, times, critical_step } = self;
        let subject = Subject { name: "", problem, times, critical_step: *critical_step, held: None, checked: None };
        let Results { simulation, estimate, contact } = results;
        Level::new(&Report::new(&subject, options, simulation, estimate, contact, 0.0))
    }
}

/// Sets the true errors of all levels but the finest. Returns whether this is fine enough, if there are two refinements.
fn compare<const D: usize, const N: usize>(
    prepared: &[Prepared<D, N>],
    levels: &mut [Level],
    histories: &[History<D>],
    finest: usize,
    observer: &mut dyn Observer,
) -> Result<Option<Settled>, Failure> {
    if finest == 0 {
        return Ok(None);
    }
    let runs: Vec<_> = prepared.iter().zip(histories).take(finest).map(|(p, h)| (&p.problem, h as _)).collect();
    let Prepared { problem, times, .. } = &prepared[finest];
    // A finest level whose steps are there, after a stop, is not simulated again.
    let kept = histories.get(finest).map(|history| history as _);
    let errors = true_errors(&runs, (problem, times), kept, observer)?;
    levels.iter_mut().zip(&errors).for_each(|(level, error)| level.compare(error));
    if finest == 1 {
        return Ok(None);
    }
    let Prepared { problem, times, .. } = &prepared[finest - 1];
    let before = true_errors(&runs[..1], (problem, times), Some(&histories[finest - 1]), observer)?;
    Ok(before.first().zip(errors.first()).map(|(before, now)| Settled::new(before.mean, now.mean)))
}

/// Whether the observer still asks for a stop.
fn stopped_now(observer: &mut dyn Observer) -> bool {
    let progress = percute_core::observer::Progress { stage: "stopping", done: 0, total: 1 };
    observer.observe(progress) == ControlFlow::Break(())
}
