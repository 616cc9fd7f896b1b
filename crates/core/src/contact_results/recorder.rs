//! Takes steps and keeps what contact does.

use super::resultant::{Share, Sum};
use super::status::Law;
use super::{ContactResults, ContactSteps, NodeSummary, Place, Status};
use crate::history::{SinkError, Step, StepCheck, StepSink};
use crate::obstacle::dot;
use crate::problem::Problem;
use crate::time::TimeGrid;
use thiserror::Error;

/// No room for all nodes at all instants.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{bytes} bytes for the contact results of {nodes} nodes at {instants} instants cannot be allocated in memory")]
pub struct ContactMemoryError {
    /// Bytes wanted.
    pub bytes: usize,
    /// Contact nodes.
    pub nodes: usize,
    /// Instants.
    pub instants: usize,
}

/// Keeps the contact results of the steps that it takes: beside a run or from its history the same, bit by bit. They follow from
/// displacements, reactions and touching status alone.
#[derive(Clone, Debug)]
pub struct ContactRecorder<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D, N>,
    times: &'p TimeGrid,
    check: StepCheck,
    laws: Vec<Law>,
    now: Vec<State<D>>,
    results: ContactResults<D>,
}

/// What is known of a node at the last instant taken.
#[derive(Clone, Copy, Debug)]
struct State<const D: usize> {
    displacement: [f64; D],
    force: [f64; D],
    status: Status,
}

impl<'p, const D: usize, const N: usize> ContactRecorder<'p, D, N> {
    /// Before the first step. Resultants and summaries are kept.
    #[must_use]
    pub fn new(problem: &'p Problem<D, N>, times: &'p TimeGrid) -> Self {
        let nodes = places(problem);
        let start = State { displacement: [0.0; D], force: [0.0; D], status: Status::Free };
        let results = ContactResults {
            instants: Vec::new(),
            summary: vec![NodeSummary::new(); nodes.len()],
            total: Vec::new(),
            obstacles: vec![Vec::new(); problem.obstacles().len()],
            steps: None,
            nodes,
        };
        let (laws, now) = (Law::of_surface(problem), vec![start; results.nodes.len()]);
        Self { problem, times, check: StepCheck::default(), laws, now, results }
    }

    /// Keeps all nodes at all instants too.
    ///
    /// # Errors
    /// No room for them.
    pub fn keeping_steps(mut self) -> Result<Self, ContactMemoryError> {
        let (nodes, instants) = (self.now.len(), self.times.step_count() + 1);
        let rows = nodes.saturating_mul(instants);
        let mut steps = ContactSteps::default();
        let bytes = rows.saturating_mul(ContactSteps::<D>::BYTES);
        steps.reserve(rows).map_err(|_| ContactMemoryError { bytes, nodes, instants })?;
        self.results.steps = Some(steps);
        Ok(self)
    }

    /// What contact did at the steps taken.
    #[must_use]
    pub fn finish(self) -> ContactResults<D> {
        self.results
    }

    /// Takes one node on; gives its share of the resultants.
    fn node(&mut self, at: usize, step: &Step<'_, D>) -> Share<D> {
        let Place { node, obstacle, area, point, .. } = self.results.nodes[at];
        let plane = &self.problem.obstacles()[obstacle];
        let (displacement, force) = (step.displacement[node.index()], step.reaction[at]);
        let status = self.laws[at].status(plane, &force);
        let normal_force = plane.split(&force).0;
        let summary = &mut self.results.summary[at];
        summary.at(step.time, step.touching[at], normal_force, area);
        let mut sliding = [0.0; D];
        let before = std::mem::replace(&mut self.now[at], State { displacement, force, status });
        if step.index > 0 {
            let dt = self.times.step(step.index - 1);
            let path = std::array::from_fn(|c| displacement[c] - before.displacement[c]);
            let mean = std::array::from_fn(|c| 0.5 * (before.force[c] + force[c]));
            summary.friction_energy -= dot(&plane.split(&mean).1, &path);
            summary.over(dt, [&before.force, &force], [before.status, status]);
            sliding = plane.split(&path).1.map(|way| way / dt);
        }
        let friction_energy = summary.friction_energy;
        if let Some(steps) = &mut self.results.steps {
            let slides = |status: Status| if status == Status::Free { [0.0; D] } else { sliding };
            if step.index > 0 {
                // The step that ends now is the one after the instant before.
                let row = (step.index - 1) * self.now.len() + at;
                steps.sliding_velocity[row] = slides(before.status);
            }
            steps.force.push(force);
            steps.gap.push(self.problem.surface().gap(at, &displacement, self.problem.obstacles()));
            steps.sliding_velocity.push(slides(status));
            steps.status.push(status);
            steps.friction_energy.push(friction_energy);
        }
        let place = std::array::from_fn(|c| point[c] + displacement[c]);
        Share { force, normal_force, area, status, friction_energy, place }
    }
}

impl<const D: usize, const N: usize> StepSink<D> for ContactRecorder<'_, D, N> {
    fn push(&mut self, step: &Step<'_, D>) -> Result<(), SinkError> {
        self.check.check(self.problem, self.times, step)?;
        self.check.accept(step);
        let mut sums = vec![Sum::new(); self.results.obstacles.len()];
        let mut total = Sum::new();
        for at in 0..self.now.len() {
            let share = self.node(at, step);
            sums[self.results.nodes[at].obstacle].add(&share);
            total.add(&share);
        }
        let dt = if step.index == 0 { 0.0 } else { self.times.step(step.index - 1) };
        for (sum, over_time) in sums.into_iter().zip(&mut self.results.obstacles) {
            over_time.push(sum.finish(over_time.last(), dt));
        }
        self.results.total.push(total.finish(self.results.total.last(), dt));
        self.results.instants.push(step.time);
        Ok(())
    }
}

/// The nodes of the contact surface with their shares of the candidate facets.
fn places<const D: usize, const N: usize>(problem: &Problem<D, N>) -> Vec<Place<D>> {
    let place = |(c, area): (&crate::problem::ContactNode, f64)| Place {
        node: c.node,
        obstacle: c.obstacle,
        point: problem.mesh().points()[c.node.index()],
        normal: *problem.obstacles()[c.obstacle].normal(),
        area,
    };
    problem.surface().nodes().iter().zip(problem.surface().tributary_areas()).map(place).collect()
}
