//! The sequential part: motion, contact force and ã of each step, in order.

mod impulse;
mod interval;
mod supports;
mod vibration;

use super::near_elements::span;
use super::non_matching::NonMatchingMisfit;
use super::schedule::{Decision, Schedule};
use crate::contact_density::{CornerSliding, OffContact};
use crate::element::Element;
use crate::error::EstimateError;
use crate::estimate::Supplied;
use crate::kinematic::{ContactMotions, NodalMotion, NodalTrajectory, NormalStep, half_way};
use crate::loaded::LoadedFaces;
use crate::nodal_field::{FieldPool, NodalField};
use crate::options::Options;
use crate::reconstruction::{self, BalancedFields, ReconstructionMethod, SimulatedStep};
use crate::residual::{Residuals, worse};
use crate::scratch_file::{ScratchError, ScratchFile};
use crate::time_level::{ForcesBefore, ForcesKnown, MotionKnown, SurfaceStep, TimeLevel};
pub(crate) use impulse::Impulse;
use impulse::normal_sum;
use percute_core::border::vectors;
use percute_core::dynamics::Dynamics;
use percute_core::history::{State, Step};
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use std::collections::VecDeque;
use supports::SupportCheck;
pub(crate) use vibration::Vibration;

/// Turns steps into levels whose forces are known.
#[derive(Debug)]
pub(crate) struct Preparation<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D>,
    times: &'p TimeGrid,
    dynamics: Dynamics<'p, D>,
    loaded: LoadedFaces<'p, D>,
    reconstruction: Box<dyn ReconstructionMethod<D, N> + 'p>,
    schedule: Schedule,
    motion: NodalTrajectory<D>,
    pool: FieldPool<D>,
    tracks: ContactMotions,
    non_matching: NonMatchingMisfit,
    supports: SupportCheck,
    /// The step before `current`.
    before: Option<SurfaceStep<D>>,
    /// The level at which the first step without F_DA begins.
    current: Option<ForcesBefore<D>>,
    /// The levels after it.
    motions: VecDeque<MotionKnown<D>>,
    /// Complete levels not yet handed on.
    ready: VecDeque<ForcesKnown<D>>,
    /// Densities off contact of the steps since the last sampled level that was handed on.
    off_contact: Vec<OffContact<D>>,
    /// Sliding beside nodes at two planes over these steps.
    corner_sliding: Vec<CornerSliding<D>>,
    /// Displacement of the simulation at the last level, if its difference is not measured (m).
    unmeasured: Option<NodalField<D>>,
    /// Number of steps taken in.
    count: usize,
    supplied: Supplied,
    vibration: Vibration,
    /// The level from whose forces on bodies touch.
    first_contact: Option<usize>,
    pub(crate) impulse: Impulse,
    pub(crate) residuals: Residuals,
}

impl<'p, const D: usize, const N: usize> Preparation<'p, D, N> {
    pub(super) fn new(problem: &'p Problem<D>, times: &'p TimeGrid, options: &Options) -> Self {
        let pool = FieldPool::new(problem.mesh().node_count());
        let spacing = options.spacing(problem, times);
        Self {
            problem,
            times,
            dynamics: Dynamics::new(problem, times),
            loaded: LoadedFaces::new(problem),
            reconstruction: reconstruction::new(problem, times, options),
            schedule: Schedule::new(options, problem.mesh().element_count(), times.step_count()),
            motion: NodalTrajectory::new(problem, &pool),
            pool,
            tracks: ContactMotions::new(problem, span(spacing), ScratchFile::default()),
            non_matching: NonMatchingMisfit::new(problem, span(spacing)),
            supports: SupportCheck::default(),
            before: None,
            current: None,
            motions: VecDeque::new(),
            ready: VecDeque::new(),
            off_contact: Vec::new(),
            corner_sliding: Vec::new(),
            unmeasured: None,
            count: 0,
            supplied: Supplied::default(),
            vibration: Vibration::new(problem),
            first_contact: None,
            impulse: Impulse::default(),
            residuals: Residuals::default(),
        }
    }

    /// Prepares the element data of the reconstruction.
    pub(super) fn prepare(&mut self, elements: &[Element<D, N>]) {
        self.reconstruction.prepare(elements);
    }

    pub(super) fn reconstruction(&self) -> &dyn ReconstructionMethod<D, N> {
        &*self.reconstruction
    }

    /// Number of steps taken in.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// The fields that the history brings of its own.
    pub(super) fn supplied(&self) -> Supplied {
        self.supplied
    }

    /// Samples these steps as well; they are in increasing order.
    pub(super) fn request(&mut self, steps: &[usize]) {
        self.schedule.request(steps);
    }

    /// Whether the middles of intervals between samples are estimated.
    pub(super) fn estimates_middles(&self) -> bool {
        self.schedule.is_automatic()
    }

    /// The largest energies of deformation and vibration.
    pub(super) fn vibration(&self) -> &Vibration {
        &self.vibration
    }

    /// The level from whose forces on bodies touch; the first one where none do.
    pub(super) fn first_contact(&self) -> usize {
        self.first_contact.unwrap_or(0)
    }

    pub(super) fn tracks(&self) -> &ContactMotions {
        &self.tracks
    }

    /// The tracks, for tests.
    #[cfg(test)]
    pub(super) fn tracks_mut(&mut self) -> &mut ContactMotions {
        &mut self.tracks
    }

    /// Has the normal motion of the candidate nodes at hand from one known instant to another.
    pub(super) fn show(&mut self, instants: [usize; 2]) -> Result<(), ScratchError> {
        self.tracks.show(instants)?;
        self.non_matching.show(self.problem, &mut self.tracks, instants)
    }

    /// The normal misfit of non-matching interfaces, at the instants at hand.
    pub(super) fn non_matching(&self) -> &NonMatchingMisfit {
        &self.non_matching
    }

    /// Refuses a step that does not fit.
    pub(super) fn check(&self, step: &Step<'_>) -> Result<(), EstimateError> {
        match step.index {
            0 => self.check_start(step),
            1 => self.check_first_touch(step),
            _ => self.reconstruction.check(step),
        }
    }

    /// The first step is the initial state, and a node that touches in it rests on its plane.
    fn check_start(&self, step: &Step<'_>) -> Result<(), EstimateError> {
        let problem = self.problem;
        let tolerance = problem.contact_tolerance();
        for (node, (u, u0)) in step.displacement::<D>().iter().zip(problem.initial_displacement()).enumerate() {
            if u.iter().zip(u0).any(|(a, b)| (a - b).abs() > tolerance) {
                return Err(EstimateError::Start { node });
            }
        }
        for (node, (v, v0)) in
            vectors::<D>(step.velocity.unwrap_or_default()).iter().zip(problem.initial_velocity()).enumerate()
        {
            if v.iter().zip(v0).any(|(a, b)| (a - b).abs() > problem.speed_tolerance()) {
                return Err(EstimateError::StartVelocity { node });
            }
        }
        let surface = problem.surface();
        let configuration = surface.configuration(step.displacement());
        // A node of a master touches where a multiplier acts on it, at any gap of its own.
        let touches = |at: usize| step.touching[at] && configuration.has_condition(at);
        for (at, contact) in surface.nodes().iter().enumerate().filter(|&(at, _)| touches(at)) {
            let (node, gap) = (contact.node.index(), configuration.gap(at, step.displacement()));
            let velocity = configuration.relative(at, problem.initial_velocity());
            let speed = problem.obstacles()[contact.obstacle].flat_frame().split(&velocity).0;
            if gap > tolerance || speed.abs() > problem.speed_tolerance() {
                return Err(EstimateError::StartsTouching { node, gap, speed });
            }
        }
        Ok(())
    }

    /// A node that touches at step 1 must start at least |v_n|Δt₀/4 away, or P_CA has no solution.
    fn check_first_touch(&self, step: &Step<'_>) -> Result<(), EstimateError> {
        let Some(start) = &self.current else { return Ok(()) };
        let surface = self.problem.surface();
        let displacement = self.problem.initial_displacement();
        let configuration = surface.configuration(displacement);
        for (at, contact) in surface.nodes().iter().enumerate() {
            if step.touching[at] && !start.forces.level.surface.touching[at] && surface.leads(at) {
                let frame = self.problem.obstacles()[contact.obstacle].flat_frame();
                let velocity = frame.split(&configuration.relative(at, self.problem.initial_velocity())).0;
                let gap = configuration.gap(at, displacement);
                let smallest_gap = -0.25 * velocity * self.times.step(0);
                if gap < smallest_gap {
                    return Err(EstimateError::StartsTooNear { node: contact.node.index(), gap, smallest_gap });
                }
            }
        }
        Ok(())
    }

    /// Takes in one step.
    pub(super) fn push(&mut self, state: &State<'_>) -> Result<(), ScratchError> {
        let (problem, step, n) = (self.problem, state.step(), state.step().index);
        self.count += 1;
        self.supplied = Supplied { velocity: step.velocity.is_some(), acceleration: step.acceleration.is_some() };
        let decision = self.decide(step);
        if decision.before {
            self.differ_at_last();
        }
        let (mid_velocity, now) = self.motion.advance(problem, self.times, state);
        self.track_contact(step, mid_velocity.as_deref(), &now)?;
        self.residuals.supports = worse(self.residuals.supports, self.supports.advance(problem, self.times, n, &now));

        let simulated = SimulatedStep { state, velocity: now.velocity() };
        let balanced = self.reconstruction.advance(&self.dynamics, &simulated, &self.pool);
        self.unmeasured = None;
        if decision.now {
            self.reconstruction.differ([step.displacement(), now.velocity()]);
        } else if self.reconstruction.differences().is_some() {
            self.unmeasured = Some(self.pool.copy(step.displacement()));
        }
        let BalancedFields { displacement, inertia, contact, densities, split, smoothed, plastic } = balanced;
        if let Some(densities) = &densities {
            self.non_matching.push(problem, n, densities)?;
        }
        let level = TimeLevel {
            index: n,
            displacement,
            body_force: problem.body_force_at(self.times.instants()[n]),
            load_moments: self.loaded.moments(self.times.instants()[n]),
            surface: SurfaceStep {
                reaction: step.reaction().to_vec(),
                force: contact,
                densities,
                touching: step.touching.to_vec(),
                gap: problem.surface().gaps(step.displacement()),
            },
            split,
            smoothed,
            plastic,
            energies: energies(problem, state),
        };
        let motion = MotionKnown { level, now, mid_velocity, inertia };
        if n == 0 {
            self.check_initial(&motion.now);
            self.current = Some(self.first(motion));
            return Ok(());
        }
        self.motions.push_back(motion);
        if n >= 2 {
            self.complete_interval();
        }
        Ok(())
    }

    /// Takes in that no more steps come.
    pub(super) fn finish(&mut self) -> Result<(), ScratchError> {
        // The last level of an interrupted run is sampled as well.
        if self.schedule.finish(self.count - 1) {
            self.differ_at_last();
        }
        self.complete_interval();
        // No step follows: the contact force does not jump at the last level.
        if let Some(ForcesBefore { forces: last, .. }) = self.current.take() {
            self.impulse.add_last(self.problem, self.times, last.level.index, &last.level.surface.reaction);
            self.ready.push_back(last);
        }
        self.tracks.finish(self.problem)
    }

    /// The next complete level that is sampled; others only carry the integral of ã on, and leave it their densities
    /// off contact.
    pub(super) fn next_ready(&mut self) -> Option<ForcesKnown<D>> {
        while let Some(mut level) = self.ready.pop_front() {
            level.off_contact.drain(..).for_each(|step| step.add_to(&mut self.off_contact));
            self.corner_sliding.append(&mut level.corner_sliding);
            if self.schedule.is_sampled(level.level.index) {
                level.off_contact = std::mem::take(&mut self.off_contact);
                level.corner_sliding = std::mem::take(&mut self.corner_sliding);
                self.vibration.take(level.level.energies, level.now.motion.velocity().as_flattened());
                return Some(level);
            }
        }
        None
    }

    /// Measures the difference of simulation and auxiliary solution at the last level, which has turned out to be
    /// sampled.
    fn differ_at_last(&mut self) {
        if let (Some(last), Some(unmeasured)) = (self.motions.back(), &self.unmeasured) {
            self.reconstruction.differ([unmeasured, last.now.velocity()]);
        }
    }

    /// Which levels a step makes samples; notes the first contact.
    fn decide(&mut self, step: &Step<'_>) -> Decision {
        let force = normal_sum(self.problem, step.reaction());
        if force != 0.0 || step.touching.contains(&true) {
            self.first_contact.get_or_insert(step.index);
        }
        self.schedule.advance(step.index, step.touching, force)
    }

    /// Hands the normal motion of the candidate nodes to their tracks.
    fn track_contact(
        &mut self,
        step: &Step<'_>,
        mid_velocity: Option<&[[f64; D]]>,
        now: &NodalMotion<D>,
    ) -> Result<(), ScratchError> {
        let (problem, surface) = (self.problem, self.problem.surface());
        let normal = |at: usize, velocity: &[[f64; D]]| {
            let frame = problem.obstacles()[surface.nodes()[at].obstacle].flat_frame();
            frame.split(&surface.against_obstacle(at, velocity)).0
        };
        let velocity = now.velocity();
        self.tracks.touch(problem, step.index, step.touching);
        let at_end = |i: usize| [now.displacement()[i], velocity[i]];
        let Some(mid) = mid_velocity else {
            self.tracks.slide(problem, 0.0, at_end)?;
            let gap = |at: usize| surface.gap(at, &surface.against_obstacle(at, now.displacement()));
            return self.tracks.begin(problem, |at| ((gap(at), normal(at, velocity)), step.touching[at]));
        };
        let half = 0.5 * self.times.step(step.index - 1);
        let at_middle = |i: usize| [half_way(2.0 * half, &now.displacement()[i], [&mid[i], &velocity[i]]), mid[i]];
        self.tracks.slide(problem, half, at_middle)?;
        self.tracks.slide(problem, half, at_end)?;
        let normal_step =
            |at| NormalStep { half, velocity: [normal(at, mid), normal(at, velocity)], touching: step.touching[at] };
        self.tracks.push(problem, normal_step)
    }

    /// The initial conditions hold by construction; checked all the same.
    fn check_initial(&mut self, motion: &NodalMotion<D>) {
        let fields = [
            (motion.displacement(), self.problem.initial_displacement()),
            (motion.velocity(), self.problem.initial_velocity()),
        ];
        for (made, given) in fields {
            let largest = given.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
            for (a, b) in made.iter().flatten().zip(given.iter().flatten()) {
                let scale = b.abs().max(1e-12 * largest).max(f64::MIN_POSITIVE);
                let residual = (a - b).abs() / scale;
                self.residuals.initial_conditions = worse(self.residuals.initial_conditions, residual);
            }
        }
    }
}

/// Strain energy and plastic work (J).
fn energies<const D: usize>(problem: &Problem<D>, state: &State<'_>) -> [f64; 2] {
    let plastic = problem.plastic_work(state.step().internal);
    [state.strain() - plastic, plastic]
}

#[cfg(test)]
mod tests;
