//! Contact forces and touching status that follow from displacements.

use super::balance::{Balance, Terms, norm};
use super::conditions::Conditions;
use super::nearness::{ADDED, Nearness, rounding, unsure};
use super::window::{Window, rows_of, windows};
use percute_core::border::{Vector, row};
use percute_core::contact::ContactNode;
use percute_core::dynamics::critical_time_step;
use percute_core::history::{SinkError, StepSource};
use percute_core::problem::AnyProblem;
use percute_core::time::is_stable;

/// Contact forces below so many times the noise of the forces inside the body are noise.
const ABOVE: f64 = 8.0;
/// Noise changes the velocity of a node by at most this share of the largest in a step, unless it is rounding. Where
/// inertia and stiffness do not fit each other, the forces inside the body are not small either.
const LOUDEST: f64 = 1e-3;

/// A contact force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Heard {
    /// The position of its node in the contact surface.
    pub(super) at: usize,
    /// Its instant (s).
    pub(super) time: f64,
}

/// Derives contact forces and touching status.
pub(super) struct Derivation<'p> {
    balance: Balance<'p>,
    nearness: Nearness,
    /// 4/Δt_c² (1/s²), the largest eigenvalue of M⁻¹K.
    stiffest: f64,
    /// The noise of the accelerations, if it was measured, and the largest that it can be beside rounding (m/s²).
    noise: [f64; 2],
}

impl<'p> Derivation<'p> {
    /// For the steps of this source.
    pub(super) fn new(problem: &'p AnyProblem, source: &'p dyn StepSource) -> Self {
        let (critical, nearness) = (critical_time_step(problem), Nearness::new(problem));
        let stiffest = 4.0 / (critical * critical);
        Self { balance: Balance::new(problem, source.times()), nearness, stiffest, noise: [f64::INFINITY, 0.0] }
    }

    /// The problem.
    pub(super) fn problem(&self) -> &'p AnyProblem {
        self.balance.problem()
    }

    /// The conditions of the step after an instant.
    pub(super) fn conditions(&self, window: Window<'_>) -> Conditions<'p> {
        Conditions::of(&self.balance, window)
    }

    /// Looks at a history without contact forces: measures the noise of its accelerations inside the body. The first
    /// contact forces at planes or between pairs of nodes, and the first on non-matching interfaces.
    pub(super) fn listen(&mut self, source: &dyn StepSource) -> Result<[Option<Heard>; 2], SinkError> {
        let (mut inside, mut loudest) = (0.0_f64, 0.0_f64);
        windows(source, self.balance.problem().dimension(), &mut |window| {
            let Some(motion) = self.balance.motion(window) else { return Ok(()) };
            if window.now.acceleration.is_none() {
                inside = inside.max(self.inside(&self.balance.terms(window.now, &motion.acceleration)));
                loudest = loudest.max(LOUDEST * motion.speed() / self.balance.times().velocity_step(window.now.index));
            }
            Ok(())
        })?;
        if inside > 0.0 {
            self.noise = [ABOVE * inside, loudest];
        }
        let mut heard = [None; 2];
        windows(source, self.balance.problem().dimension(), &mut |window| {
            let forces = self.reactions(window).into_iter().flatten();
            for (at, _) in forces.enumerate().filter(|(_, force)| *force != [0.0; 3]) {
                let slides = self.problem().non_matching_of(at).is_some();
                heard[usize::from(slides)].get_or_insert(Heard { at, time: window.now.time });
            }
            Ok(())
        })?;
        Ok(heard)
    }

    /// The largest acceleration that the forces leave at a node that can touch no plane (m/s²).
    fn inside(&self, terms: &Terms) -> f64 {
        let problem = self.balance.problem();
        let mut left: Vec<f64> =
            problem.mass().iter().enumerate().map(|(node, mass)| norm(&terms.rest(node)) / mass).collect();
        problem.contact_nodes().iter().for_each(|contact| left[contact.node.index()] = 0.0);
        left.into_iter().fold(0.0, f64::max)
    }

    /// R_n of the surface: M a + K u − F where a plane can act, without what is noise. None if a_n is not known.
    pub(super) fn reactions(&self, window: Window<'_>) -> Option<Vec<Vector>> {
        let (problem, now, n) = (self.balance.problem(), window.now, window.now.index);
        let acceleration = match &now.acceleration {
            Some(given) => given.clone(),
            None => self.balance.motion(window)?.acceleration,
        };
        let terms = self.balance.terms(now, &acceleration);
        let unsure = unsure([window.before, Some(now), window.after]);
        let curvature = self.stiffest + 4.0 / (self.balance.times().step(n) * self.balance.times().velocity_step(n));
        let [measured, loudest] = self.noise;
        let noise = measured.min(loudest.max(ADDED * unsure * curvature));
        let (conditions, places, near) =
            (self.conditions(window), self.places(window), self.nearness.tolerance(unsure));
        let of = |(at, contact): (usize, &ContactNode)| {
            let node = contact.node.index();
            let force = terms.rest(node);
            let acts =
                contact.free && conditions.nearest(at, &places) <= near && norm(&force) > noise * problem.mass()[node];
            if acts { force } else { [0.0; 3] }
        };
        let mut all: Vec<_> = problem.contact_nodes().iter().enumerate().map(of).collect();
        super::pairs::make_opposite(problem, &mut all);
        Some(all)
    }

    /// The displacements at which a node that touches in the step after t_n may be on its plane: those of t_n and
    /// t_{n+1}. The step of the solver after a sample is at most the critical one.
    fn places(&self, window: Window<'_>) -> Vec<Vec<f64>> {
        let (now, critical) = (window.now, 2.0 / self.stiffest.sqrt());
        let held = [Some(now), window.after].into_iter().flatten();
        let mut places: Vec<Vec<f64>> = held.map(|held| held.step().displacement.to_vec()).collect();
        let sampled = !is_stable(self.balance.times().step(now.index), critical);
        if let Some(velocity) = now.step().velocity.filter(|_| sampled) {
            let step = |(u, v): (&f64, &f64)| u + critical * v;
            places.push(now.step().displacement.iter().zip(velocity).map(step).collect());
        }
        places
    }

    /// Whether a force at t_n is more than the rounding of a gap: it moves the node by more in the step.
    fn acts(&self, at: usize, n: usize, force: &Vector) -> bool {
        let (problem, times) = (self.balance.problem(), self.balance.times());
        let n = n.min(times.step_count() - 1);
        let mass = problem.moved_mass(at);
        norm(force) * times.step(n) * times.velocity_step(n) > mass * problem.contact_tolerance()
    }

    /// Touching status at t_{n+1}: a force acts at t_n.
    pub(super) fn touching(&self, window: Window<'_>, reaction: &[f64]) -> Vec<bool> {
        let (conditions, places) = (self.conditions(window), self.places(window));
        let near = self.nearness.tolerance(unsure([Some(window.now), window.after]));
        let nodes = self.balance.problem().contact_nodes();
        let (forces, d) = (conditions.forces(reaction), self.problem().dimension());
        let touches = |at: usize| {
            let gap = || conditions.nearest(at, &places) + conditions.give(at, &forces);
            nodes[at].free && self.acts(at, window.now.index, &row(&forces, at, d)) && gap() <= near
        };
        let mut touching: Vec<bool> = (0..nodes.len()).map(touches).collect();
        conditions.settle_masters(&mut touching);
        touching
    }

    /// Touching status at t_0: a node at rest on its plane on which a force acts.
    pub(super) fn touching_at_start(&self, window: Window<'_>, reaction: &[f64]) -> Vec<bool> {
        let (problem, conditions) = (self.balance.problem(), self.conditions(window));
        let starts = problem.starts_of_contact();
        let forces = conditions.forces(reaction);
        let touches = |at: usize| {
            let (gap, speed) = starts[at];
            let force = row(&forces, at, problem.dimension());
            self.acts(at, 0, &force) && gap <= problem.contact_tolerance() && speed.abs() <= problem.speed_tolerance()
        };
        let mut touching: Vec<bool> = (0..starts.len()).map(touches).collect();
        conditions.settle_masters(&mut touching);
        touching
    }

    /// Whether a node goes into its plane in the step after the last, without contact forces.
    pub(super) fn enters(&self, window: Window<'_>) -> bool {
        let (problem, now) = (self.balance.problem(), window.now);
        let tolerance = problem.contact_tolerance().max(ADDED * rounding(&now.displacement));
        let next = rows_of(&self.balance.predicted(window.before, now), problem.dimension());
        let conditions = self.conditions(window);
        let free = problem.contact_nodes().iter().enumerate().filter(|(_, contact)| contact.free);
        free.into_iter().any(|(at, _)| conditions.gap(at, &next) < -tolerance)
    }
}
