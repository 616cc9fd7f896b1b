//! What a history of another program lacks, derived from the rest of it.

use super::balance::{Balance, Terms, dot};
use super::window::{Held, Window, windows};
use percute_core::contact::ContactNode;
use percute_core::dynamics::critical_time_step;
use percute_core::history::{SinkError, Step, StepSource};
use percute_core::problem::Problem;
use percute_core::time::{TimeError, TimeGrid};
use serde::Serialize;

/// Rounding of a number relative to its size, in double and in single precision.
const ROUNDING: [f64; 2] = [f64::EPSILON, f32::EPSILON as f64];
/// Roundings of displacements add up in their second difference, and in the sums over the elements of a node.
const ADDED: f64 = 16.0;

/// A part of a history that was derived.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Derived {
    /// Contact forces, from the balance.
    Reaction,
    /// Touching status, from gaps and forces.
    Touching,
}

impl Derived {
    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Reaction => "reaction",
            Self::Touching => "touching",
        }
    }
}

/// The parts that a history lacks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lacks {
    /// Contact forces; all steps have zeros in their place.
    pub reaction: bool,
    /// Touching status; all steps have `false` in its place.
    pub touching: bool,
}

/// A history with what it lacked. The last instant is left out if its contact forces are not known.
pub struct Completed<'s, const D: usize, const N: usize> {
    problem: &'s Problem<D, N>,
    source: &'s dyn StepSource<D>,
    lacks: Lacks,
    times: TimeGrid,
    count: usize,
    derived: Vec<Derived>,
}

impl<'s, const D: usize, const N: usize> Completed<'s, D, N> {
    /// Looks at a history once, to see whether its last contact forces are known.
    ///
    /// # Errors
    /// Steps that cannot be read; fewer than three instants of which the last is not known.
    pub fn new(problem: &'s Problem<D, N>, source: &'s dyn StepSource<D>, lacks: Lacks) -> Result<Self, SinkError> {
        let (times, count) = (source.times().clone(), source.count());
        let mut made = Self { problem, source, lacks, times, count, derived: Vec::new() };
        if problem.surface().nodes().is_empty() {
            return Ok(made);
        }
        let needed = made.needed_at_the_end()?;
        if lacks.reaction {
            if !made.any_reaction()? {
                // Nothing touches: the history is complete.
                made.lacks = Lacks::default();
                return Ok(made);
            }
            made.derived.push(Derived::Reaction);
        }
        if lacks.touching || lacks.reaction {
            made.lacks.touching = true;
            made.derived.push(Derived::Touching);
        }
        if needed {
            made.leave_out_the_last()?;
        }
        Ok(made)
    }

    /// The parts that were derived.
    #[must_use]
    pub fn derived(&self) -> &[Derived] {
        &self.derived
    }

    /// The last instant of the history (s), if it was left out.
    #[must_use]
    pub fn left_out(&self) -> Option<f64> {
        let last = self.source.count().checked_sub(1)?;
        (self.count <= last).then(|| self.source.times().instants()[last])
    }

    fn leave_out_the_last(&mut self) -> Result<(), TimeError> {
        self.count -= 1;
        self.times = TimeGrid::from_instants(self.times.instants()[..self.count].to_vec())?;
        Ok(())
    }

    /// Whether contact forces are needed at the last instant, but not there: all are zero, and without them a node of the
    /// surface would go into its plane in a further step.
    fn needed_at_the_end(&self) -> Result<bool, SinkError> {
        let times = self.source.times();
        let balance = Balance::new(self.problem, times);
        let last = self.source.count().saturating_sub(1);
        let mut needed = false;
        windows(self.source, &mut |window| {
            if window.now.index < last {
                return Ok(());
            }
            let Some(before) = window.before else { return Ok(()) };
            let known = window.now.acceleration.is_some();
            if !known && window.now.reaction.iter().all(|r| *r == [0.0; D]) {
                needed = enters(&balance, before, window.now);
            }
            Ok(())
        })?;
        Ok(needed)
    }

    /// Whether the balance has any contact force.
    fn any_reaction(&self) -> Result<bool, SinkError> {
        let derivation = Derivation::new(self.problem, self.source.times());
        let mut any = false;
        windows(self.source, &mut |window| {
            any = any || derivation.reactions(window).is_some_and(|all| all.iter().any(|r| *r != [0.0; D]));
            Ok(())
        })?;
        Ok(any)
    }
}

impl<const D: usize, const N: usize> StepSource<D> for Completed<'_, D, N> {
    fn times(&self) -> &TimeGrid {
        &self.times
    }

    fn count(&self) -> usize {
        self.count
    }

    fn replay(&self, take: &mut dyn FnMut(&Step<'_, D>) -> Result<(), SinkError>) -> Result<(), SinkError> {
        let derivation = Derivation::new(self.problem, self.source.times());
        let mut touched = None;
        windows(self.source, &mut |window| {
            let now = window.now;
            if now.index >= self.count {
                return Ok(());
            }
            let mut reaction = None;
            if self.lacks.reaction {
                reaction = Some(derivation.reactions(window).unwrap_or_else(|| vec![[0.0; D]; now.reaction.len()]));
            }
            let reaction = reaction.as_ref().unwrap_or(&now.reaction);
            let next = derivation.touching(now, window.after, reaction);
            let touching = touched.replace(next).unwrap_or_else(|| derivation.touching_at_start(reaction));
            let touching = if self.lacks.touching { &touching } else { &now.touching };
            let start = derivation.start(now);
            let displacement = start.as_deref().unwrap_or(&now.displacement);
            take(&Step { displacement, reaction, touching, ..now.step() })
        })
    }
}

/// Whether a node goes into its plane in the step after the last, without contact forces.
fn enters<const D: usize, const N: usize>(balance: &Balance<'_, D, N>, before: &Held<D>, now: &Held<D>) -> bool {
    let (problem, times, n) = (balance.problem(), balance.times(), now.index);
    let rest = vec![[0.0; D]; now.displacement.len()];
    let Terms { stiffness, load, .. } = balance.terms(now, &rest);
    let (back, dt, h) = (times.step(n - 1), times.step(n), times.velocity_step(n));
    problem.surface().nodes().iter().enumerate().filter(|(_, contact)| contact.free).any(|(at, contact)| {
        let node = contact.node.index();
        let (u, earlier) = (&now.displacement[node], &before.displacement[node]);
        let next = std::array::from_fn(|c| {
            let force = load[node][c] - stiffness[node][c];
            u[c] + dt * ((u[c] - earlier[c]) / back + h * force / problem.mass()[node])
        });
        let rounding = ADDED * rounding(&now.displacement) * size(&now.displacement);
        problem.surface().gap(at, &next) < -problem.contact_tolerance().max(rounding)
    })
}

/// The rounding of numbers: that of single precision if all of them are such.
fn rounding<const D: usize>(values: &[[f64; D]]) -> f64 {
    let single = values.iter().flatten().all(|&x| f64::from(x as f32) == x);
    ROUNDING[usize::from(single)]
}

fn size<const D: usize>(values: &[[f64; D]]) -> f64 {
    values.iter().flatten().fold(0.0, |most, x| most.max(x.abs()))
}

/// Derives contact forces and touching status.
struct Derivation<'p, const D: usize, const N: usize> {
    balance: Balance<'p, D, N>,
    /// 4/Δt_c² (1/s²), the largest eigenvalue of M⁻¹K.
    stiffest: f64,
}

impl<'p, const D: usize, const N: usize> Derivation<'p, D, N> {
    fn new(problem: &'p Problem<D, N>, times: &'p TimeGrid) -> Self {
        let critical = critical_time_step(problem);
        Self { balance: Balance::new(problem, times), stiffest: 4.0 / (critical * critical) }
    }

    /// u_0 of the problem where that of the history differs by rounding alone.
    fn start(&self, now: &Held<D>) -> Option<Vec<[f64; D]>> {
        let stated = self.balance.problem().initial_displacement();
        if now.index > 0 || stated == now.displacement {
            return None;
        }
        let tolerance = 2.0 * f64::from(f32::EPSILON) * size(stated);
        let same = |(a, b): (&[f64; D], &[f64; D])| (0..D).all(|c| (a[c] - b[c]).abs() <= tolerance);
        stated.iter().zip(&now.displacement).all(same).then(|| stated.to_vec())
    }

    /// R_n of the surface: M a + K u − F where a plane can act, without what is rounding. None if a_n is not known.
    fn reactions(&self, window: Window<'_, D>) -> Option<Vec<[f64; D]>> {
        let (problem, now) = (self.balance.problem(), window.now);
        let acceleration = match &now.acceleration {
            Some(given) => given.clone(),
            None => self.balance.acceleration(window)?,
        };
        let Terms { inertia, stiffness, load, .. } = self.balance.terms(now, &acceleration);
        let places = [window.before, Some(now), window.after];
        let unsure = places.into_iter().flatten().map(|held| rounding(&held.displacement) * size(&held.displacement));
        let unsure = ADDED * unsure.fold(0.0, f64::max);
        let n = now.index;
        let curvature = self.stiffest + 4.0 / (self.balance.times().step(n) * self.balance.times().velocity_step(n));
        let of = |(at, contact): (usize, &ContactNode)| {
            let node = contact.node.index();
            let force = std::array::from_fn(|c| inertia[node][c] + stiffness[node][c] - load[node][c]);
            let near = self.gaps(at, now, window.after).into_iter().any(|gap| gap <= self.tolerance(unsure));
            let noise = unsure * problem.mass()[node] * curvature;
            let acts = contact.free && near && dot(&force, &force).sqrt() > noise;
            if acts { force } else { [0.0; D] }
        };
        Some(problem.surface().nodes().iter().enumerate().map(of).collect())
    }

    fn tolerance(&self, unsure: f64) -> f64 {
        self.balance.problem().contact_tolerance().max(unsure)
    }

    /// Gaps of a node at t_n and, if there is one, at t_{n+1}.
    fn gaps(&self, at: usize, now: &Held<D>, after: Option<&Held<D>>) -> Vec<f64> {
        let surface = self.balance.problem().surface();
        let node = surface.nodes()[at].node.index();
        [Some(now), after].into_iter().flatten().map(|held| surface.gap(at, &held.displacement[node])).collect()
    }

    /// Touching status at t_{n+1}: a force acts at t_n.
    fn touching(&self, now: &Held<D>, after: Option<&Held<D>>, reaction: &[[f64; D]]) -> Vec<bool> {
        let places = [Some(now), after].into_iter().flatten();
        let unsure = places.map(|held| rounding(&held.displacement) * size(&held.displacement)).fold(0.0, f64::max);
        let touches = |(at, force): (usize, &[f64; D])| {
            let near = self.gaps(at, now, after).into_iter().any(|gap| gap <= self.tolerance(ADDED * unsure));
            *force != [0.0; D] && near && self.balance.problem().surface().nodes()[at].free
        };
        reaction.iter().enumerate().map(touches).collect()
    }

    /// Touching status at t_0: a node at rest on its plane on which a force acts.
    fn touching_at_start(&self, reaction: &[[f64; D]]) -> Vec<bool> {
        let problem = self.balance.problem();
        let touches = |(at, force): (usize, &[f64; D])| {
            let (gap, speed) = problem.start_of_contact(at);
            *force != [0.0; D] && gap <= problem.contact_tolerance() && speed.abs() <= problem.speed_tolerance()
        };
        reaction.iter().enumerate().map(touches).collect()
    }
}
