//! How the motion begins: jumps of loads, of the velocity, and strains at the start, from which fronts of stress run.

use crate::report::rebound::{Rebound, strongest};
use percute_core::border::Vector;
use percute_core::contact_results::ContactResults;
use percute_core::dynamics::time_step_of_element;
use percute_core::element_state::ElementState;
use percute_core::ids::ElementId;
use percute_core::material::Law;
use percute_core::problem::AnyProblem;

/// A traction that would reach its largest value within so many critical steps of the largest element is a jump for the
/// mesh, on bars and in plane bodies: with shorter rises, the index of the mean is below that of bodies that vibrate.
/// studies/beyond.py: 0.83 to 0.94 for up to 16 steps on a bar, 0.95 and less for 3 in a block.
const STEEP: [f64; 2] = [24.0, 8.0];
/// Tractions below this part of the stress of the impact, ρ c V, may jump: they have 1 % of its energy.
const LITTLE: f64 = 0.1;
/// A velocity that changes by more than this part of its range within one element jumps there. The vibrations of
/// effectivity-turning.csv change by up to 0.18 of it, on their coarsest meshes.
const OF_RANGE: f64 = 0.5;
/// Strains of initial displacements below this part of displacement over size are rounding, of coordinates with nine
/// digits.
const ROUNDING: f64 = 1e-9;
/// A body of which tractions make more than this part of the speed before contact is pushed to its plane: most of it.
const MOST: f64 = 0.5;

/// What no case of the evidence has at its start. Their bodies fly free of stress, or are loaded by body forces alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Onset {
    /// Whether a traction jumps, at the start or later.
    pub(super) load_jumps: bool,
    /// Whether the velocity jumps inside a body.
    pub(super) velocity_jumps: bool,
    /// Whether initial displacements strain a body.
    pub(super) strained: bool,
    /// Whether most of the speed of a body at its plane is that of tractions.
    pub(super) pushed: bool,
}

impl Onset {
    /// `speed` is that of the impact (m/s), if there is one.
    pub(super) fn new(
        problem: &AnyProblem,
        results: &ContactResults,
        rebound: Option<&Rebound>,
        speed: Option<f64>,
    ) -> Self {
        Self {
            load_jumps: load_jumps(problem, results.instants.last().copied().unwrap_or(0.0), speed),
            velocity_jumps: velocity_jumps(problem),
            strained: is_strained(problem),
            pushed: rebound.is_some_and(|rebound| is_pushed(problem, results, rebound)),
        }
    }
}

/// Whether a traction is not zero at the start, or changes up to the end (s) faster than the mesh resolves, by more
/// than little of what an impact at this speed (m/s) makes.
fn load_jumps(problem: &AnyProblem, end: f64, speed: Option<f64>) -> bool {
    if problem.face_loads().is_empty() {
        return false;
    }
    let longest = problem.mesh().elements().map(|element| time_step_of_element(problem, element)).fold(0.0, f64::max);
    let window = STEEP[usize::from(problem.dimension() > 1)] * longest;
    let impedances = problem.materials().iter().map(|law| law.density() * law.wave_speed());
    let least = LITTLE * speed.unwrap_or(0.0).max(0.0) * impedances.fold(f64::INFINITY, f64::min);
    problem.face_loads().iter().any(|load| {
        let table = &problem.traction_tables()[load.table];
        let factor = load.profile.iter().fold(0.0_f64, |most, factor| most.max(factor.abs()));
        let most = largest(table.value().as_flattened());
        let is_steep = |(times, values): (&[f64], &[Vector])| {
            let change = largest(&std::array::from_fn::<_, 3, _>(|c| values[1][c] - values[0][c]));
            times[0] < end && times[1] > 0.0 && change * window > most * (times[1] - times[0])
        };
        let at_start = factor * largest(&table.at(0.0)) > least;
        let later = || table.time().windows(2).zip(table.value().windows(2)).any(is_steep);
        at_start || (factor * most > least && later())
    })
}

/// Whether the velocity changes within one element by most of its range, other than by a rotation.
fn velocity_jumps(problem: &AnyProblem) -> bool {
    let (mesh, velocity, d) = (problem.mesh(), problem.initial_velocity(), problem.dimension());
    let range = |c: usize| {
        let [low, high] = velocity
            .chunks_exact(d)
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v[c]), high.max(v[c])]);
        high - low
    };
    let whole = (0..d).map(range).fold(0.0, f64::max);
    // A triangle is at least as high as the inverse of the largest gradient of its shape functions.
    let change = |element: ElementId| {
        let squares = mesh.gradients(element).into_iter().map(|g| g.iter().map(|x| x * x).sum::<f64>());
        let rate = largest(ElementState::new(problem, element, velocity, &[]).strain.as_flattened());
        rate / squares.fold(0.0, f64::max).sqrt()
    };
    whole > 0.0 && (0..mesh.element_count()).map(ElementId::new).any(|element| change(element) > OF_RANGE * whole)
}

/// Whether an element is strained at the start.
fn is_strained(problem: &AnyProblem) -> bool {
    let (mesh, displacement) = (problem.mesh(), problem.initial_displacement());
    let limit = ROUNDING * largest(displacement) / mesh.size();
    let strained = |element: ElementId| {
        largest(ElementState::new(problem, element, displacement, &[]).strain.as_flattened()) > limit
    };
    limit > 0.0 && (0..mesh.element_count()).map(ElementId::new).any(strained)
}

/// Whether most of the speed with which the body arrives at its plane is not that of the start, and tractions act.
fn is_pushed(problem: &AnyProblem, results: &ContactResults, rebound: &Rebound) -> bool {
    let Some(frame) = strongest(problem, results).filter(|_| !problem.face_loads().is_empty()) else { return false };
    let (mass, velocity) = (problem.mass(), problem.initial_velocity());
    let velocity = || velocity.chunks_exact(problem.dimension());
    let component = |c: usize| mass.iter().zip(velocity()).map(|(m, v)| m * v.get(c).unwrap_or(&0.0)).sum();
    let momentum: Vector = std::array::from_fn(component);
    let at_start = frame.split(&momentum).0 / mass.iter().sum::<f64>();
    -at_start < MOST * -rebound.normal_before
}

/// The largest entry of vectors, without its sign.
fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |most, entry| most.max(entry.abs()))
}
