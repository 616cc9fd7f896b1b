//! A problem on its mesh and on nested refinements of it: estimates beside true errors against the finest.
//!
//! All meshes have the Courant number of the first; with finite kinematics the steps of refinements follow the
//! stiffness. Each run is compared with all coarser ones as it goes, so that each is simulated once and a verification
//! is complete after each mesh.

mod criterion;
mod levels;
mod table;

pub use criterion::Settled;
pub use levels::{Convergence, Cost, Level, Orders, ProbeValue, Verification};
pub use table::{announced, table};

use crate::case::{Source, problem_from, statement};
use crate::effort::{Effort, Long};
use crate::failure::Failure;
use crate::memory;
use crate::numbering::Ordered;
use crate::quantity::{Probe, ProbeSink, Quantity};
use crate::report::{Report, Subject};
use crate::run::{Results, following, whole};
use levels::Followed;
use percute_core::dynamics::first_stable_step;
use percute_core::mesh::room;
use percute_core::observer::Observer;
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;
use percute_estimator::Options;
use percute_estimator::reference::{Comparison, Motion};

/// The most refinements: each has eight times the work of the one before.
pub const MOST_LEVELS: usize = 5;

/// A problem on one of the meshes, ready to run.
#[derive(Clone, Debug)]
pub struct Prepared {
    problem: AnyProblem,
    /// With finite kinematics those of a refinement have about as many steps as this, until they are found.
    times: TimeGrid,
    /// The critical step, or with finite kinematics the stable one of the start (s).
    critical_step: f64,
    /// The Courant number of steps that are to be found.
    following: Option<f64>,
}

/// The problem on its mesh and on so many refinements, which may be long.
///
/// # Errors
/// A number of refinements out of range or with much work that was not asked for, a problem that the case language
/// cannot say, a mesh that cannot be refined.
pub fn prepare(
    problem: &AnyProblem,
    times: &TimeGrid,
    options: &Options,
    (levels, long): (usize, Long),
) -> Result<Vec<Prepared>, Failure> {
    if !(1..=MOST_LEVELS).contains(&levels) {
        return Err(Failure::Argument(format!("`levels` is {levels}; give 1 to {MOST_LEVELS} refinements")));
    }
    if let Some(told) =
        Effort::of(problem, times, options.every).refined(problem.dimension(), levels).refusal_of_levels(levels, long)
    {
        return Err(Failure::Argument(told));
    }
    room(problem.mesh().element_count() << (problem.dimension() * levels))
        .map_err(|error| Failure::Memory(format!("{levels} refinements: {error}, or give fewer levels")))?;
    let stated = Source::new("the refined problem", statement(problem, None)?);
    let critical_step = first_stable_step(problem);
    let courant = times.longest_step() / critical_step;
    let mut all = vec![Prepared { problem: problem.clone(), times: times.clone(), critical_step, following: None }];
    for _ in 0..levels {
        let coarse = &all[all.len() - 1].problem;
        let mesh = coarse.mesh();
        let fine = mesh.refined().map_err(|error| Failure::Argument(format!("the mesh cannot be refined: {error}")))?;
        let initial = [coarse.initial_displacement(), coarse.initial_velocity()].map(|field| mesh.prolonged(field));
        let [displacement, velocity] = initial;
        let (problem, _) = problem_from(&stated, &fine.into(), displacement, velocity)?;
        let critical_step = first_stable_step(&problem);
        let times = TimeGrid::with_step(times.end(), courant * critical_step);
        let times = times.map_err(|error| Failure::Argument(error.to_string()))?;
        let following = problem.is_finite().then_some(courant);
        all.push(Prepared { problem, times, critical_step, following });
    }
    Ok(all)
}

/// The work before it starts.
#[must_use]
pub fn cost(prepared: &[Prepared], options: &Options) -> Cost {
    Cost::new(prepared.iter().map(|each| levels::Work::new(&each.problem, &each.times, options)).collect())
}

/// Runs all meshes and compares each with all coarser ones. After each, `done` gets the verification so far, in which
/// the mesh is the reference. If the observer breaks, the levels done remain.
///
/// # Errors
/// A probe that does not fit the body; as [`run`](crate::run::run) and [`true_errors`](crate::run::true_errors).
pub fn verify(
    prepared: &[Prepared],
    options: Options,
    probes: &[Probe],
    observer: &mut dyn Observer,
    done: &mut dyn FnMut(&Verification),
) -> Result<Verification, Failure> {
    memory::refusal(cost(prepared, &options).bytes).map_or(Ok(()), |told| Err(Failure::Memory(told)))?;
    let ordered: Vec<_> = prepared.iter().map(|each| Ordered::new(&each.problem)).collect();
    let (mut levels, mut motions, mut first_errors) = (Vec::<Level>::new(), Vec::new(), Vec::new());
    let so_far = |levels: &[Level], first_errors: &[f64]| {
        Verification::new(levels.to_vec(), Settled::last(first_errors), levels.len() < prepared.len())
    };
    let quantities = levels::quantities(probes);
    let sinks = |problem| quantities.iter().map(|quantity| quantity.sink(problem)).collect::<Result<Vec<_>, _>>();
    // A probe that does not fit is refused before the first run.
    let sinks: Vec<_> = ordered.iter().map(|each| sinks(each.problem())).collect::<Result<_, _>>()?;
    for ((each, problem), mut sinks) in prepared.iter().zip(&ordered).zip(sinks) {
        let mut comparison = Comparison::new(problem.problem());
        for (coarse, motion) in ordered.iter().zip(&motions) {
            comparison.add(coarse.problem(), motion).map_err(|error| problem.failure(error.into()))?;
        }
        // Nothing is compared with the motion of the finest.
        let mut motion = (motions.len() + 1 < prepared.len()).then(Motion::default);
        let beside = &mut ((&mut comparison, &mut motion), &mut sinks);
        let Some(times) = each.found(observer)? else { break };
        let Some(results) = whole(problem, &times, options, beside, observer)? else { break };
        let errors = comparison.finish()?;
        levels.iter_mut().zip(&errors).for_each(|(level, error)| level.compare(error));
        levels.push(each.level((&times, options), &results, &quantities, &sinks));
        first_errors.extend(errors.first().map(|error| error.mean));
        motions.extend(motion);
        done(&so_far(&levels, &first_errors));
    }
    Ok(so_far(&levels, &first_errors))
}

impl Prepared {
    /// Its instants, found if its steps follow the stiffness; none if the observer stops it.
    fn found(&self, observer: &mut dyn Observer) -> Result<Option<TimeGrid>, Failure> {
        match self.following {
            Some(courant) => following(&self.problem, self.times.end(), courant, observer),
            None => Ok(Some(self.times.clone())),
        }
    }

    fn level(
        &self,
        (times, options): (&TimeGrid, Options),
        results: &Results,
        quantities: &[Quantity],
        sinks: &[Option<ProbeSink<'_>>],
    ) -> Level {
        let Self { problem, critical_step, .. } = self;
        let (name, critical_step) = ("", *critical_step);
        let subject = Subject { name, problem, times, critical_step, held: None, checked: None, unended: None };
        let report = Report::new(&subject, options, results.findings(), 0.0);
        let followed = |(quantity, sink): (&Quantity, &Option<ProbeSink<'_>>)| Followed {
            quantity: quantity.clone(),
            value: quantity.value(&report, sink.as_ref()),
            obstruction: quantity.obstruction(problem.mesh(), &report),
        };
        Level::new(&report, quantities.iter().zip(sinks).map(followed).collect())
    }
}
