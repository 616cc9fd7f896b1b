//! How consistent the steps of a history are: one pass over them.

use super::attempt::FALL;
use super::balance::{Balance, Motion, norm};
use super::complete::Derived;
use super::conditions::Conditions;
use super::contact::ContactCheck;
use super::ends::Ends;
use super::figures::Consistency;
use super::long_steps::at_long_steps;
use super::residual::Residual;
use super::velocities::Rates;
use super::window::{Window, windows};
use super::{take_in, widest};
use percute_core::border::Vector;
use percute_core::history::{SinkError, StepSource};
use percute_core::problem::AnyProblem;

/// Forces that would change the velocity of a node by this share in a step count as a term of the balance. In the
/// flight of a rigid body all others are rounding, in single precision up to 1e-4 of it.
const FLIGHT: f64 = 1e-2;

/// What likely causes follow from.
#[derive(Debug)]
pub(super) struct Evidence<'p> {
    pub(super) residual: Residual,
    pub(super) contact: ContactCheck<'p>,
    pub(super) ends: Ends,
    pub(super) rates: Rates,
    /// Whether velocities and accelerations are given.
    pub(super) given: [bool; 2],
}

impl Evidence<'_> {
    /// Whether no contact force was given or found, but the balance fails inside: it says nothing where one may act.
    pub(super) fn silent(&self) -> bool {
        !self.contact.forced.contains(&true) && self.residual.inside() > FALL * self.residual.norm([1.0; 4])
    }
}

/// R at all nodes (N), from those of the surface; 0 at prescribed components.
pub(super) fn nodal(problem: &AnyProblem, reaction: &[Vector]) -> Vec<Vector> {
    let mut nodal = vec![[0.0; 3]; problem.mesh().node_count()];
    for (contact, force) in problem.contact_nodes().iter().zip(reaction) {
        nodal[contact.node.index()] = *force;
    }
    problem.prescribed().iter().for_each(|p| nodal[p.node.index()][p.component] = 0.0);
    nodal
}

/// Measures a history, of which parts were derived, with the contact forces of so many steps later.
pub(super) fn measure<'p>(
    problem: &'p AnyProblem,
    source: &dyn StepSource,
    derived: &[Derived],
    shift: isize,
) -> Result<(Consistency, Evidence<'p>), SinkError> {
    let mut surface = vec![false; problem.mesh().node_count()];
    problem.contact_nodes().iter().for_each(|contact| surface[contact.node.index()] = true);
    let residual = Residual::new(surface, derived.contains(&Derived::Reaction));
    let mut pass = Pass {
        balance: Balance::new(problem, source.times()),
        shift,
        last: source.count().saturating_sub(1),
        found: Consistency::default(),
        evidence: Evidence {
            residual,
            contact: ContactCheck::new(problem),
            ends: Ends::new(),
            rates: Rates::default(),
            given: [false; 2],
        },
        acceleration: [0.0; 2],
    };
    windows(source, problem.dimension(), &mut |window| {
        pass.take(window);
        Ok(())
    })?;
    Ok(pass.finish())
}

struct Pass<'b, 'p> {
    balance: Balance<'b>,
    shift: isize,
    last: usize,
    found: Consistency,
    evidence: Evidence<'p>,
    /// Largest difference and largest value of given accelerations (m/s²).
    acceleration: [f64; 2],
}

impl<'p> Pass<'_, 'p> {
    fn take(&mut self, window: Window<'_>) {
        let (now, n) = (window.now, window.now.index);
        self.evidence.given = [now.velocity.is_some(), now.acceleration.is_some()];
        let motion = self.balance.motion(window);
        let reaction = match self.shift {
            0 => Some(&now.reaction),
            1 => window.after.map(|held| &held.reaction),
            _ => window.before.map(|held| &held.reaction),
        };
        let derived = motion.as_ref().filter(|_| n > 0).map(|motion| &motion.acceleration);
        let terms = now.acceleration.as_ref().or(derived).map(|used| self.balance.terms(now, used));
        let steps = [self.balance.times().step(n), self.balance.times().velocity_step(n)];
        if let (Some(terms), Some(reaction)) = (&terms, reaction) {
            self.evidence.residual.add(terms, &nodal(self.balance.problem(), reaction), n, now.time);
        }
        if let Some(motion) = &motion {
            let mass = self.balance.problem().mass();
            let most = motion.forward.iter().zip(mass).map(|(v, m)| m * norm(v)).fold(0.0, f64::max);
            self.evidence.residual.expect(FLIGHT * most / steps[1]);
            self.compare(window, motion);
        }
        let conditions = Conditions::of(&self.balance, window);
        self.evidence.contact.take((window, &conditions), motion.as_ref(), terms.as_ref(), steps);
        if n == self.last {
            self.evidence.ends.end(&self.balance, window);
        }
    }

    /// Compares given velocities and accelerations with those of the displacements, and the start with that of the
    /// problem.
    fn compare(&mut self, window: Window<'_>, motion: &Motion) {
        let now = window.now;
        self.evidence.rates.take(window, motion, self.balance.times());
        if now.index == 0 {
            let reaction = nodal(self.balance.problem(), &now.reaction);
            let Evidence { residual, ends, .. } = &mut self.evidence;
            let open = |node: usize| residual.is_open(node);
            ends.start((&self.balance, window), motion, (&reaction, &open), &mut self.found);
            return;
        }
        if let Some(given) = &now.acceleration {
            take_in(&mut self.acceleration, widest(given.as_flattened(), motion.acceleration.as_flattened()));
        }
    }

    fn finish(self) -> (Consistency, Evidence<'p>) {
        let Self { mut found, evidence, acceleration, balance, .. } = self;
        let given = |[difference, largest]: [f64; 2]| (largest > 0.0).then(|| difference / largest);
        found.balance = evidence.residual.relative();
        let at_long_steps = at_long_steps(balance.times(), &evidence.residual.largest_at);
        found.long_step = evidence.residual.share(at_long_steps);
        (found.node, found.time) = (evidence.residual.worst.node, evidence.residual.worst.time);
        found.acceleration = given(acceleration);
        found.velocity = evidence.rates.misfit();
        evidence.contact.enter(&mut found);
        (found, evidence)
    }
}
