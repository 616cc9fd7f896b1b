//! Contact results of the steps of a run or a history.

use super::averaged::Averages;
use super::facing;
use super::nearest::LastGaps;
use super::resultant::{Share, Sum};
use super::{ContactPoint, ContactResults, ContactSteps, NodeSummary};
use crate::border::padded;
use crate::contact::Inclination;
use crate::contact::{ContactConfiguration, LEAST_PART, NonMatchingSurfaces};
use crate::contact::{Coulomb, Status, dissipation};
use crate::contact::{Frame, dot};
use crate::history::{SinkError, State, StateSink, Step, StepCheck, StepSource};
use crate::on_problem;
use crate::problem::{Problem, ProblemRef};
use crate::time::TimeGrid;
use std::fmt;
use thiserror::Error;

/// No room for all nodes at all instants.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error(
    "{bytes} bytes for the contact results of {nodes} nodes at {instants} instants cannot be allocated in memory; take \
     fewer steps, or name neither an estimate file nor a page"
)]
pub struct ContactMemoryError {
    /// Bytes wanted.
    pub bytes: usize,
    /// Contact nodes.
    pub nodes: usize,
    /// Instants.
    pub instants: usize,
}

/// Keeps the contact results of the steps that it takes: beside a run or from its history the same, bit by bit. They
/// follow from displacements, reactions and touching status alone.
#[derive(Debug)]
pub struct ContactRecorder<'p>(Box<dyn Record + 'p>);

impl<'p> ContactRecorder<'p> {
    /// Before the first step. Resultants and summaries are kept.
    #[must_use]
    pub fn new(problem: impl Into<ProblemRef<'p>>, times: &'p TimeGrid) -> Self {
        Self::of(problem.into(), times)
    }

    fn of(problem: ProblemRef<'p>, times: &'p TimeGrid) -> Self {
        Self(on_problem!(problem, problem => Box::new(Recorder::new(problem, times))))
    }

    /// Keeps all nodes at all instants too.
    ///
    /// # Errors
    /// No room for them.
    pub fn keeping_steps(mut self) -> Result<Self, ContactMemoryError> {
        self.0.keep_steps()?;
        Ok(self)
    }

    /// The contact results of the steps taken.
    #[must_use]
    pub fn finish(self) -> ContactResults {
        self.0.finish()
    }

    /// The contact results of a history. No force is computed: its steps are only checked.
    ///
    /// # Errors
    /// A step that cannot be read or does not fit.
    pub fn replay(mut self, source: &dyn StepSource) -> Result<ContactResults, SinkError> {
        let mut check = StepCheck::default();
        source.replay(&mut |step| self.0.record_checked(&mut check, step))?;
        Ok(self.finish())
    }
}

impl StateSink for ContactRecorder<'_> {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        self.0.record(state.step());
        Ok(())
    }
}

/// A recorder of either dimension.
trait Record: fmt::Debug + Send {
    fn keep_steps(&mut self) -> Result<(), ContactMemoryError>;
    fn record(&mut self, step: &Step<'_>);
    fn record_checked(&mut self, check: &mut StepCheck, step: &Step<'_>) -> Result<(), SinkError>;
    fn finish(self: Box<Self>) -> ContactResults;
}

/// The recorder with its dimension.
#[derive(Debug)]
struct Recorder<'p, const D: usize> {
    problem: &'p Problem<D>,
    times: &'p TimeGrid,
    laws: Vec<TangentialLaw>,
    now: Vec<NodeState<D>>,
    /// What the nodes face at the instant that is recorded.
    configuration: ContactConfiguration<'p, D>,
    /// The shortest edge of each node that may touch another body (m); infinite at rigid obstacles, and on a bar.
    shortest: Vec<f64>,
    inclination: Inclination<'p, D>,
    /// Area of each node (m²), on a body that turns at the instant that is recorded.
    areas: Vec<f64>,
    gaps: LastGaps,
    averages: Averages,
    results: ContactResults,
}

/// What is known of a node at the last instant taken.
#[derive(Clone, Copy, Debug)]
struct NodeState<const D: usize> {
    /// Displacement against the obstacle (m).
    relative: [f64; D],
    force: [f64; D],
    status: Status,
}

impl<'p, const D: usize> Recorder<'p, D> {
    fn new(problem: &'p Problem<D>, times: &'p TimeGrid) -> Self {
        let nodes = points(problem);
        let start = NodeState { relative: [0.0; D], force: [0.0; D], status: Status::Free };
        let results = ContactResults {
            dimension: D,
            instants: Vec::new(),
            summary: vec![NodeSummary::new(); nodes.len()],
            total: Vec::new(),
            obstacles: vec![Vec::new(); problem.obstacles().len()],
            slip: 0.0,
            penetration: 0.0,
            at_surface_end: false,
            inclination: 0.0,
            averaged_peak: None,
            nearest: None,
            steps: None,
            nodes,
        };
        let (laws, now) = (TangentialLaw::of_surface(problem), vec![start; results.nodes.len()]);
        let configuration = problem.surface().configuration(problem.initial_displacement());
        let (shortest, gaps, averages) = (shortest_edges(problem), LastGaps::default(), Averages::new(problem));
        let inclination = Inclination::new(problem.surface(), problem.mesh(), problem.on_lines_of_symmetry());
        let areas = problem.surface().tributary_areas();
        Self { problem, times, laws, now, configuration, shortest, inclination, areas, gaps, averages, results }
    }

    /// The normal force of each obstacle (N) up to which its nodes are free.
    fn least_forces(&self, step: &Step<'_>) -> Vec<f64> {
        let (surface, mut least) = (self.problem.surface(), vec![0.0_f64; self.results.obstacles.len()]);
        for at in surface.non_matching().iter().flat_map(NonMatchingSurfaces::positions) {
            let (obstacle, frame) = (self.results.nodes[at].obstacle, surface.frame(at, &[0.0; D]));
            least[obstacle] = least[obstacle].max(LEAST_PART * frame.split(&step.reaction()[at]).0);
        }
        least
    }

    /// Records the gaps, as long as nothing touches.
    fn gap_left(&mut self, step: &Step<'_>) {
        let touches = step.touching.contains(&true) || step.reaction.iter().any(|force| *force != 0.0);
        let gaps = (0..self.now.len()).map(|at| self.configuration.gap(at, step.displacement()));
        self.gaps.advance(step.time, touches, gaps);
    }

    /// The inclination of surfaces where forces act (rad), so far.
    fn inclination(&self) -> f64 {
        let acts = |at: usize| self.now[at].status != Status::Free;
        self.inclination.largest(self.results.inclination, acts, |non_matching| self.configuration.shifts(non_matching))
    }

    /// Records one node, which is free up to this normal force (N); returns its share of the resultants.
    fn node(&mut self, at: usize, step: &Step<'_>, least: f64) -> Share {
        let (ContactPoint { node, point, .. }, area) = (self.results.nodes[at], self.areas[at]);
        let (displacement, force) = (step.displacement::<D>()[node.index()], step.reaction::<D>()[at]);
        let surface = self.problem.surface();
        let relative = self.configuration.relative(at, step.displacement());
        let frame = surface.frame(at, &relative);
        let normal_force = frame.split(&force).0;
        let status = if normal_force <= least { Status::Free } else { self.laws[at].status(&frame, &force) };
        let is_of_pair = surface.nodes()[at].partner.is_some();
        if status != Status::Free && is_of_pair {
            let (_, aside) = frame.split(&relative);
            let slip = dot(&aside, &aside).sqrt() / self.shortest[at];
            self.results.slip = self.results.slip.max(slip);
        }
        let penetration = self.configuration.depth(at, step.displacement()) / self.shortest[at];
        self.results.penetration = self.results.penetration.max(penetration);
        let summary = &mut self.results.summary[at];
        summary.at(step.time, step.touching[at], normal_force, area);
        let mut sliding = [0.0; D];
        let before = std::mem::replace(&mut self.now[at], NodeState { relative, force, status });
        self.results.at_surface_end |= summary.first_touch.is_some() && self.configuration.is_at_end(at);
        if step.index > 0 {
            let dt = self.times.step(step.index - 1);
            let path = std::array::from_fn(|c| relative[c] - before.relative[c]);
            let mean = std::array::from_fn(|c| 0.5 * (before.force[c] + force[c]));
            summary.friction_energy += dissipation(&frame, &mean, &path);
            summary.over(dt, [&before.force, &force].map(padded), [before.status, status]);
            sliding = frame.split(&path).1.map(|way| way / dt);
        }
        let friction_energy = summary.friction_energy;
        if let Some(steps) = &mut self.results.steps {
            let slides = |status: Status| if status == Status::Free { [0.0; D] } else { sliding };
            if step.index > 0 {
                // The step that ends now is the one after the instant before.
                let row = (step.index - 1) * self.now.len() + at;
                steps.sliding_velocity[D * row..D * (row + 1)].copy_from_slice(&slides(before.status));
            }
            steps.force.extend(force);
            steps.gap.push(self.configuration.gap(at, step.displacement()));
            steps.sliding_velocity.extend(slides(status));
            steps.status.push(status);
            steps.friction_energy.push(friction_energy);
            if self.problem.is_finite() {
                steps.area.push(area);
            }
        }
        let place = std::array::from_fn(|c| if c < D { point[c] + displacement[c] } else { 0.0 });
        Share { force: padded(&force), normal_force, area, status, friction_energy, place }
    }
}

impl<const D: usize> Record for Recorder<'_, D> {
    fn keep_steps(&mut self) -> Result<(), ContactMemoryError> {
        let (nodes, instants) = (self.now.len(), self.times.step_count() + 1);
        let rows = nodes.saturating_mul(instants);
        let mut steps = ContactSteps::default();
        let bytes = rows.saturating_mul(ContactSteps::bytes(D));
        let areas = if self.problem.is_finite() { rows } else { 0 };
        let reserved = steps.reserve(rows, D).and_then(|()| steps.area.try_reserve_exact(areas));
        reserved.map_err(|_| ContactMemoryError { bytes, nodes, instants })?;
        self.results.steps = Some(steps);
        Ok(())
    }

    fn record_checked(&mut self, check: &mut StepCheck, step: &Step<'_>) -> Result<(), SinkError> {
        check.advance(self.problem, self.times, step)?;
        self.record(step);
        Ok(())
    }

    fn finish(self: Box<Self>) -> ContactResults {
        ContactResults { nearest: self.gaps.nearest(), averaged_peak: self.averages.peak(), ..self.results }
    }

    /// Records a checked step.
    fn record(&mut self, step: &Step<'_>) {
        let mut sums = vec![Sum::new(); self.results.obstacles.len()];
        let mut total = Sum::new();
        self.configuration.update(step.displacement());
        self.gap_left(step);
        let least = self.least_forces(step);
        if self.problem.is_finite() {
            self.areas = facing::areas(self.problem, step.displacement());
        }
        let length = self.times.velocity_step(step.index);
        let over = [self.times.instants()[step.index] + 0.5 * self.times.step(step.index), length];
        let mut averaged = 0.0;
        for at in 0..self.now.len() {
            let obstacle = self.results.nodes[at].obstacle;
            let share = self.node(at, step, least[obstacle]);
            sums[obstacle].add(&share);
            // Two bodies that touch have one contact, that of the first one.
            let average = self.averages.node(at, over, share.normal_force, share.area);
            if self.problem.surface().is_of_first(at) {
                total.add(&share);
                averaged += average;
            }
        }
        self.averages.sum(step.time, averaged);
        self.results.inclination = self.inclination();
        let dt = if step.index == 0 { 0.0 } else { self.times.step(step.index - 1) };
        for (sum, over_time) in sums.into_iter().zip(&mut self.results.obstacles) {
            over_time.push(sum.finish(over_time.last(), dt));
        }
        self.results.total.push(total.finish(self.results.total.last(), dt));
        self.results.instants.push(step.time);
    }
}

/// The nodes of the contact surface with their shares of the candidate faces.
fn points<const D: usize>(problem: &Problem<D>) -> Vec<ContactPoint> {
    let surface = problem.surface();
    let point = |(at, area): (usize, f64)| {
        let (node, obstacle, point) = (surface.nodes()[at].node, surface.nodes()[at].obstacle, surface.point(at));
        let normal = padded(surface.obstacles()[obstacle].frame_at(point).normal());
        ContactPoint { node, obstacle, point: padded(point), normal, area }
    };
    surface.tributary_areas().into_iter().enumerate().map(point).collect()
}

/// The shortest edge of each node that may touch another body (m), infinite at others.
fn shortest_edges<const D: usize>(problem: &Problem<D>) -> Vec<f64> {
    let (surface, mut shortest) = (problem.surface(), vec![f64::INFINITY; problem.surface().nodes().len()]);
    for face in surface.faces().iter().filter(|_| D > 1) {
        let (_, length) = problem.mesh().normal_in::<D>(face.face);
        let is_of_body = |at: usize| surface.nodes()[at].partner.is_some() || surface.non_matching_of(at).is_some();
        for &at in face.nodes.iter().filter(|&&at| is_of_body(at)) {
            shortest[at] = shortest[at].min(length);
        }
    }
    shortest
}

/// The law of the tangential motion of one node.
#[derive(Clone, Copy, Debug)]
enum TangentialLaw {
    /// Friction alone.
    Friction(Coulomb),
    /// A support holds the node along the obstacle, as on a plane of symmetry.
    Held,
    /// A support moves the node along the obstacle.
    Moved,
}

impl TangentialLaw {
    /// One for each node of the contact surface.
    fn of_surface<const D: usize>(problem: &Problem<D>) -> Vec<Self> {
        let law = |contact: &crate::contact::ContactNode| {
            if !contact.guided || D == 3 {
                return Self::Friction(problem.obstacles()[contact.obstacle].law());
            }
            let moved = problem.prescribed().iter().any(|p| p.node == contact.node && p.motion.is_some());
            if moved { Self::Moved } else { Self::Held }
        };
        problem.surface().nodes().iter().map(law).collect()
    }

    /// The status under a reaction (N).
    fn status<const D: usize>(self, frame: &Frame<D>, reaction: &[f64; D]) -> Status {
        match self {
            Self::Friction(law) => law.status(frame, reaction),
            _ if frame.split(reaction).0 <= 0.0 => Status::Free,
            Self::Held => Status::Stick,
            Self::Moved => Status::Slip,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Obstacle;

    #[test]
    fn supports_decide_the_status_of_guided_nodes() {
        let frame = Obstacle::plane([0.0, 0.0], [0.0, 1.0], 0.5, None).unwrap().flat_frame();
        assert_eq!(TangentialLaw::Held.status(&frame, &[0.0, 1.0]), Status::Stick);
        assert_eq!(TangentialLaw::Moved.status(&frame, &[0.0, 1.0]), Status::Slip);
        assert_eq!(TangentialLaw::Held.status(&frame, &[0.0, 0.0]), Status::Free);
    }
}
