//! A simulation against a finer one.

use super::locate::Transfer;
use super::motion::Motion;
use super::{ReferenceError, TrueError, TrueErrorSample};
use crate::inertia::mass_product;
use percute_core::dynamics::Stiffness;
use percute_core::history::{SinkError, State, StateSink};
use percute_core::ids::ElementId;
use percute_core::material::Law;
use percute_core::problem::Problem;

/// Instants that agree to this, relative, are the same: rounding of N·Δt against T.
const SAME_INSTANT: f64 = 1e-12;

/// Takes the steps of a reference simulation and compares any number of coarser ones with it.
///
/// At each t_n of a coarse simulation, the difference of both P1 fields is a P1 field on the
/// reference mesh, in which the coarse mesh must be nested; the reference is interpolated linearly
/// in time between its own instants. The energies are exact in space, with the consistent mass.
#[derive(Debug)]
pub struct Comparison<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D, N>,
    stiffness: Stiffness<D, N>,
    coarse: Vec<Coarse<'p, D, N>>,
    /// The last state of the reference.
    before: Option<Instant<D>>,
}

/// One simulation under comparison.
#[derive(Debug)]
struct Coarse<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D, N>,
    motion: &'p Motion<D>,
    transfer: Transfer<D, N>,
    samples: Vec<TrueErrorSample>,
}

/// The reference at one of its instants.
#[derive(Clone, Debug)]
struct Instant<const D: usize> {
    time: f64,
    displacement: Vec<[f64; D]>,
    velocity: Vec<[f64; D]>,
}

impl<'p, const D: usize, const N: usize> Comparison<'p, D, N> {
    /// A comparison with the simulation of `problem`, whose states it must take.
    #[must_use]
    pub fn new(problem: &'p Problem<D, N>) -> Self {
        Self { problem, stiffness: Stiffness::new(problem), coarse: Vec::new(), before: None }
    }

    /// Adds a simulation to compare, before it takes the first state. The results come in the
    /// order in which they were added.
    ///
    /// # Errors
    /// Meshes that are not nested or cover different bodies, a motion of another problem.
    pub fn add(&mut self, problem: &'p Problem<D, N>, motion: &'p Motion<D>) -> Result<(), ReferenceError> {
        let needed = problem.mesh().node_count();
        for (field, values) in [("displacement", &motion.displacement), ("velocity", &motion.velocity)] {
            if let Some(values) = values.iter().find(|v| v.len() != needed) {
                return Err(ReferenceError::Length { field, given: values.len(), needed });
            }
        }
        let transfer = Transfer::new(problem.mesh(), self.problem.mesh())?;
        self.coarse.push(Coarse { problem, motion, transfer, samples: Vec::new() });
        Ok(())
    }

    /// The true errors, one for each simulation added.
    ///
    /// # Errors
    /// A reference that ended before a simulation did.
    pub fn finish(self) -> Result<Vec<TrueError>, ReferenceError> {
        let reference = self.before.map_or(0.0, |s| s.time);
        let error = |coarse: Coarse<'_, D, N>| {
            let end = coarse.motion.times.last().copied().unwrap_or(0.0);
            if coarse.samples.len() < coarse.motion.times.len() {
                return Err(ReferenceError::EndsEarly { reference, end });
            }
            Ok(TrueError::new(coarse.samples))
        };
        self.coarse.into_iter().map(error).collect()
    }
}

impl<const D: usize, const N: usize> StateSink<D> for Comparison<'_, D, N> {
    fn accept(&mut self, state: &State<'_, D>) -> Result<(), SinkError> {
        let displacement = state.step().displacement.to_vec();
        let now = Instant { time: state.step().time, displacement, velocity: state.velocity() };
        let before = self.before.replace(now.clone());
        let before = before.as_ref().unwrap_or(&now);
        for coarse in &mut self.coarse {
            while let Some(&time) = coarse.motion.times.get(coarse.samples.len()) {
                if time > now.time * (1.0 + SAME_INSTANT) {
                    break;
                }
                let length = now.time - before.time;
                let weight = if length > 0.0 { ((time - before.time) / length).min(1.0) } else { 1.0 };
                let sample = coarse.sample(self.problem, &self.stiffness, before, &now, weight);
                coarse.samples.push(sample);
            }
        }
        Ok(())
    }
}

impl<const D: usize, const N: usize> Coarse<'_, D, N> {
    /// The energies of the difference at the next instant; `weight` is that of `now` in the
    /// reference.
    fn sample(
        &self,
        fine: &Problem<D, N>,
        stiffness: &Stiffness<D, N>,
        before: &Instant<D>,
        now: &Instant<D>,
        weight: f64,
    ) -> TrueErrorSample {
        let n = self.samples.len();
        let difference = |own: &[[f64; D]], a: &[[f64; D]], b: &[[f64; D]]| {
            let mut difference = self.transfer.apply(self.problem.mesh(), own);
            for ((d, a), b) in difference.iter_mut().zip(a).zip(b) {
                (0..D).for_each(|c| d[c] -= (1.0 - weight) * a[c] + weight * b[c]);
            }
            difference
        };
        let displacement = difference(&self.motion.displacement[n], &before.displacement, &now.displacement);
        let velocity = difference(&self.motion.velocity[n], &before.velocity, &now.velocity);
        let mut unused = vec![[0.0; D]; displacement.len()];
        TrueErrorSample {
            time: self.motion.times[n],
            kinetic: kinetic_energy(fine, &velocity),
            elastic: stiffness.subtract_internal_forces(&displacement, &mut unused),
        }
    }
}

/// ½∫ρ|v|² of a P1 velocity, exactly.
fn kinetic_energy<const D: usize, const N: usize>(problem: &Problem<D, N>, velocity: &[[f64; D]]) -> f64 {
    let mut energy = 0.0;
    for (e, nodes) in problem.mesh().cells().iter().enumerate() {
        let id = ElementId::new(e);
        let nodal = nodes.map(|node| velocity[node.index()]);
        energy += 0.5 * mass_product(problem.material(id).density() * problem.volume(id), &nodal, &nodal);
    }
    energy
}
