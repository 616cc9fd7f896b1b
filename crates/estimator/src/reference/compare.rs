//! A simulation against a finer one.

use super::locate::Transfer;
use super::motion::Motion;
use super::{ReferenceError, TrueError, TrueErrorSample};
use crate::deformation::Deformation;
use crate::inertia::mass_product;
use percute_core::border::vectors;
use percute_core::element_state::displacement_gradient;
use percute_core::history::{SinkError, State, StateSink};
use percute_core::ids::ElementId;
use percute_core::material::{FlowForces, Law, PointLaw, Tensor, VonMises};
use percute_core::mesh::Mesh;
use percute_core::on_problem;
use percute_core::problem::{Problem, ProblemRef};
use std::fmt::Debug;

/// Instants that agree to this, relative, are the same: rounding of N·Δt against T.
const SAME_INSTANT: f64 = 1e-12;

/// Takes the steps of a reference simulation and compares any number of coarser ones with it.
///
/// At each t_n of a coarse simulation, the velocities differ by a P1 field with the values at the nodes of the
/// reference, the strains by a constant in each of its elements, that at the centroid. On a reference mesh in which the
/// coarse one is nested, both are exact; the mass is the consistent one. In time the reference is interpolated linearly
/// between its own instants.
#[derive(Debug)]
pub struct Comparison<'p>(Box<dyn Compare<'p> + 'p>);

trait Compare<'p>: StateSink + Debug {
    fn add(&mut self, run: ProblemRef<'p>, motion: &'p Motion, nested: bool) -> Result<(), ReferenceError>;
    fn finish(self: Box<Self>) -> Result<Vec<TrueError>, ReferenceError>;
}

impl<'p> Comparison<'p> {
    /// A comparison with the simulation of `problem`, whose states it must take.
    #[must_use]
    pub fn new(problem: impl Into<ProblemRef<'p>>) -> Self {
        Self::of(problem.into())
    }

    fn of(problem: ProblemRef<'p>) -> Self {
        on_problem!(problem, problem => Self(Box::new(Finer { problem, coarse: Vec::new(), before: None })))
    }

    /// Adds a simulation to compare, before it takes the first state. The results come in the
    /// order in which they were added.
    ///
    /// # Errors
    /// Meshes that are not nested or cover different bodies, a motion of another problem.
    pub fn add(&mut self, problem: impl Into<ProblemRef<'p>>, motion: &'p Motion) -> Result<(), ReferenceError> {
        self.0.add(problem.into(), motion, true)
    }

    /// As [`Comparison::add`], on a mesh that need not be nested: nodes and centroids are looked for in it.
    ///
    /// # Errors
    /// Meshes of different bodies, a motion of another problem.
    pub fn add_located(
        &mut self,
        problem: impl Into<ProblemRef<'p>>,
        motion: &'p Motion,
    ) -> Result<(), ReferenceError> {
        self.0.add(problem.into(), motion, false)
    }

    /// The true errors, one for each simulation added.
    ///
    /// # Errors
    /// A reference that ended before a simulation did.
    pub fn finish(self) -> Result<Vec<TrueError>, ReferenceError> {
        self.0.finish()
    }
}

impl StateSink for Comparison<'_> {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        self.0.accept(state)
    }
}

/// The comparison with a problem of a dimension.
#[derive(Debug)]
struct Finer<'p, const D: usize> {
    problem: &'p Problem<D>,
    coarse: Vec<Coarse<'p, D>>,
    /// The last state of the reference.
    before: Option<Instant<D>>,
}

/// One simulation under comparison.
#[derive(Debug)]
struct Coarse<'p, const D: usize> {
    problem: &'p Problem<D>,
    motion: &'p Motion,
    transfer: Transfer,
    /// Of the elements of the reference, where a material yields.
    flows: Vec<Flows>,
    samples: Vec<TrueErrorSample>,
}

/// The flow of the reference and of the simulation in an element so far.
#[derive(Clone, Debug, Default)]
struct Flows {
    last: Option<[(Vec<f64>, FlowForces); 2]>,
    /// φ(Ė_p) − Σ·Ė_p of each under the forces of the other (J/m³).
    misfit: f64,
}

/// The reference at one of its instants.
#[derive(Clone, Debug)]
struct Instant<const D: usize> {
    time: f64,
    displacement: Vec<[f64; D]>,
    velocity: Vec<[f64; D]>,
    internal: Vec<f64>,
}

impl<'p, const D: usize> Compare<'p> for Finer<'p, D> {
    fn add(&mut self, run: ProblemRef<'p>, motion: &'p Motion, nested: bool) -> Result<(), ReferenceError> {
        let Some(problem) = run.typed::<D>() else { return Err(ReferenceError::Dimension) };
        if problem.is_finite() != self.problem.is_finite() {
            return Err(ReferenceError::Kinematics);
        }
        if problem.yields() != self.problem.yields() {
            return Err(ReferenceError::Yielding);
        }
        let internal = problem.variables() * problem.mesh().element_count();
        if let Some(values) = motion.internal.iter().find(|row| row.len() != internal).filter(|_| internal > 0) {
            return Err(ReferenceError::Length { field: "internal", given: values.len(), needed: internal });
        }
        if internal > 0 && motion.internal.len() != motion.times.len() {
            let (given, needed) = (motion.internal.len(), motion.times.len());
            return Err(ReferenceError::Length { field: "internal", given, needed });
        }
        let mesh = (problem.mesh(), self.problem.mesh());
        let transfer = if nested { Transfer::nested(mesh.0, mesh.1)? } else { Transfer::located(mesh.0, mesh.1)? };
        let needed = D * problem.mesh().node_count();
        for (field, values) in [("displacement", &motion.displacement), ("velocity", &motion.velocity)] {
            if let Some(values) = values.iter().find(|v| v.len() != needed) {
                return Err(ReferenceError::Length { field, given: values.len(), needed });
            }
        }
        let flows =
            if problem.yields() { vec![Flows::default(); self.problem.mesh().element_count()] } else { Vec::new() };
        self.coarse.push(Coarse { problem, motion, transfer, flows, samples: Vec::new() });
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<Vec<TrueError>, ReferenceError> {
        let reference = self.before.map_or(0.0, |s| s.time);
        let error = |coarse: Coarse<'_, D>| {
            let end = coarse.motion.times.last().copied().unwrap_or(0.0);
            if coarse.samples.len() < coarse.motion.times.len() {
                return Err(ReferenceError::EndsEarly { reference, end });
            }
            Ok(TrueError::new(coarse.samples))
        };
        self.coarse.into_iter().map(error).collect()
    }
}

impl<const D: usize> StateSink for Finer<'_, D> {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        let displacement = state.step().displacement().to_vec();
        let (time, internal) = (state.step().time, state.step().internal.to_vec());
        let now = Instant { time, displacement, velocity: vectors(&state.velocity()).to_vec(), internal };
        let before = self.before.replace(now.clone());
        let before = before.as_ref().unwrap_or(&now);
        for coarse in &mut self.coarse {
            while let Some(&time) = coarse.motion.times.get(coarse.samples.len()) {
                if time > now.time * (1.0 + SAME_INSTANT) {
                    break;
                }
                let length = now.time - before.time;
                let weight = if length > 0.0 { ((time - before.time) / length).min(1.0) } else { 1.0 };
                let sample = coarse.sample(self.problem, before, &now, weight);
                coarse.samples.push(sample);
            }
        }
        Ok(())
    }
}

impl<const D: usize> Coarse<'_, D> {
    /// The energies of the difference at the next instant; `weight` is that of `now` in the
    /// reference.
    fn sample(&mut self, fine: &Problem<D>, before: &Instant<D>, now: &Instant<D>, weight: f64) -> TrueErrorSample {
        let (n, mesh) = (self.samples.len(), self.problem.mesh());
        let between = |a: &[f64; D], b: &[f64; D]| std::array::from_fn(|c| (1.0 - weight) * a[c] + weight * b[c]);
        let mut velocity = self.transfer.at_nodes(mesh, vectors(&self.motion.velocity[n]));
        for (v, (a, b)) in velocity.iter_mut().zip(before.velocity.iter().zip(&now.velocity)) {
            let reference: [f64; D] = between(a, b);
            (0..D).for_each(|c| v[c] -= reference[c]);
        }
        let reference =
            before.displacement.iter().zip(&now.displacement).map(|(a, b)| between(a, b)).collect::<Vec<_>>();
        let own = gradients::<D>(mesh, vectors(&self.motion.displacement[n]));
        let mut sample = TrueErrorSample { time: self.motion.times[n], ..Default::default() };
        let mut nodal: Vec<[f64; D]> = Vec::new();
        let mix = |a: f64, b: f64| (1.0 - weight) * a + weight * b;
        let internal: Vec<f64> = before.internal.iter().zip(&now.internal).map(|(a, b)| mix(*a, *b)).collect();
        let count = fine.variables();
        for (e, coarse) in self.transfer.elements().iter().enumerate() {
            let (id, law) = (ElementId::new(e), fine.material(ElementId::new(e)));
            let mut gradient = displacement_gradient(fine.mesh(), id, &reference);
            let own = &own[coarse.index()];
            let energy = if law.hardening().is_some() {
                let (row, coarse) =
                    (&internal[count * e..][..count], &self.motion.internal[n][count * coarse.index()..]);
                let states = [(&gradient, row), (own, &coarse[..count])];
                let [elastic, plastic] = self.flows[e].advance(&VonMises::new(law), states);
                sample.dissipation += fine.volume(id) * plastic;
                elastic
            } else if law.is_finite() {
                let stress = [&gradient, own].map(|h| Deformation::new(h).second_stress(&law.respond(h, &mut []).0));
                let entry = |a: usize, b: usize| stress[0][a][b] - stress[1][a][b];
                let misfit: Tensor<D> = std::array::from_fn(|a| std::array::from_fn(|b| entry(a, b)));
                let strain = law.stress_metric(own).strain(&misfit);
                0.5 * misfit.iter().flatten().zip(strain.iter().flatten()).map(|(s, e)| s * e).sum::<f64>()
            } else {
                (0..D).for_each(|a| (0..D).for_each(|b| gradient[a][b] -= own[a][b]));
                law.strain_energy(&gradient)
            };
            nodal.clear();
            nodal.extend(fine.mesh().cell(id).iter().map(|node| velocity[node.index()]));
            let volume = fine.volume(id);
            sample.kinetic += 0.5 * mass_product(law.density() * volume, &nodal, &nodal);
            sample.elastic += volume * energy;
        }
        sample
    }
}

impl Flows {
    /// Goes on to the gradients and internal variables of both. Gives the energies of their difference (J/m³), elastic
    /// and plastic; forces on the flow are the means of both ends of the step.
    fn advance<const D: usize>(&mut self, law: &VonMises, states: [(&Tensor<D>, &[f64]); 2]) -> [f64; 2] {
        let now = states.map(|(gradient, internal)| {
            (internal.to_vec(), law.forces::<D>(&law.state::<f64, D>(gradient, internal), internal))
        });
        if let Some(last) = &self.last {
            for (flow, other) in [(0, 1), (1, 0)] {
                let [start, end] = [last, &now].map(|at| at[other].1.misfit::<D>(&last[flow].0, &now[flow].0));
                self.misfit += 0.5 * (start + end);
            }
        }
        let [a, b] = states;
        let gradient = std::array::from_fn(|i| std::array::from_fn(|j| a.0[i][j] - b.0[i][j]));
        let internal: Vec<f64> = a.1.iter().zip(b.1).map(|(a, b)| a - b).collect();
        self.last = Some(now);
        let elastic = law.state::<f64, D>(&gradient, &internal).elastic_energy;
        [elastic, law.hardening_distance::<D>(a.1, b.1) + self.misfit]
    }
}

/// ∂u/∂x of each element.
fn gradients<const D: usize>(mesh: &Mesh, displacement: &[[f64; D]]) -> Vec<Tensor<D>> {
    (0..mesh.element_count()).map(|e| displacement_gradient(mesh, ElementId::new(e), displacement)).collect()
}

#[cfg(test)]
mod tests;
