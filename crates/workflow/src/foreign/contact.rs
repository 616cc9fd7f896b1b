//! Contact forces against gaps, touching status and Coulomb's law.

use super::balance::{Motion, Terms, dot, norm};
use super::conditions::Conditions;
use super::figures::Consistency;
use super::gaps::Gaps;
use super::interface_balance::InterfaceBalance;
use super::nearness::{ADDED, Nearness, unsure};
use super::window::{Window, rows_of, vectors_of};
use percute_core::border::Vector;
use percute_core::contact::{ContactNode, Frame};
use percute_core::problem::AnyProblem;

/// A force that changes the velocity of its node by less than this share of the largest in a step may be rounding.
const FAINT: f64 = 1e-6;
/// Nodes slide if they are faster than this share of the fastest node; noise of 1e-9 m is slower.
const SLIDING: f64 = 1e-2;

/// Sums over the nodes of a plane and all instants.
#[derive(Clone, Debug)]
struct PlaneSums {
    /// ∑μR_n|w_t|Δt, ∑R_n|w_t|Δt and −∑R_t·w_t Δt of sliding nodes (J).
    slide: [f64; 3],
    /// Gaps under contact forces, and where the balance needs a force but there is none.
    forced: Gaps,
    missing: Gaps,
}

impl PlaneSums {
    fn new(nodes: usize) -> Self {
        Self { slide: [0.0; 3], forced: Gaps::new(nodes), missing: Gaps::new(nodes) }
    }

    /// The misfit of Coulomb's law (J).
    fn misfit(&self) -> f64 {
        self.slide[0] - self.slide[2]
    }
}

/// Contact of all nodes and instants.
#[derive(Debug)]
pub(super) struct ContactCheck<'p> {
    problem: &'p AnyProblem,
    nearness: Nearness,
    /// Of each plane.
    planes: Vec<PlaneSums>,
    /// The forces of the instant before (N), and the gaps at its end (m).
    before: Option<(Vec<Vector>, Vec<f64>)>,
    /// Of each non-matching interface.
    interface_balance: Vec<InterfaceBalance>,
    /// Nodes of the surface on which a force acts at some instant.
    pub(super) forced: Vec<bool>,
    /// Largest normal force (N), cone excess (N), product of force and gap (N m), penetration (m).
    largest: [f64; 4],
    /// ∑R p (N m), ∑R² (N²) and ∑p² (m²) of normal forces and penetrations at the same instant.
    pressed: [f64; 3],
    /// ∑R p (N m) and ∑p² (m²) of each node, while it is pressed behind its plane.
    springs: Vec<[f64; 2]>,
    /// The largest rounding of displacements (m).
    unsure: f64,
    /// Disagreements of status and force: as given, if the status is a step early, and if it is a step late.
    pub(super) disagree: [usize; 3],
    /// Changes of status and of forces.
    changes: [usize; 2],
}

impl<'p> ContactCheck<'p> {
    pub(super) fn new(problem: &'p AnyProblem) -> Self {
        Self {
            problem,
            nearness: Nearness::new(problem),
            planes: vec![PlaneSums::new(problem.contact_nodes().len()); problem.obstacle_count()],
            before: None,
            interface_balance: vec![InterfaceBalance::default(); problem.non_matching_count()],
            forced: vec![false; problem.contact_nodes().len()],
            largest: [0.0; 4],
            pressed: [0.0; 3],
            springs: vec![[0.0; 2]; problem.contact_nodes().len()],
            unsure: 0.0,
            disagree: [0; 3],
            changes: [0; 2],
        }
    }

    /// Takes in an instant with its conditions, its motion in a step of Δt (s) with h (s), and the terms of its
    /// balance.
    pub(super) fn take(
        &mut self,
        (window, conditions): (Window<'_>, &Conditions<'_>),
        motion: Option<&Motion>,
        terms: Option<&Terms>,
        [dt, h]: [f64; 2],
    ) {
        let (problem, now) = (self.problem, window.now);
        self.unsure = self.unsure.max(unsure([Some(now)]));
        let speed = motion.map_or(0.0, Motion::speed);
        let least = SLIDING * speed;
        // Status is derived without forces that move a node by rounding.
        let rounding = problem.contact_tolerance() / (dt * h);
        let faint = |at: usize, mass: f64| (FAINT * speed / h * mass).max(rounding * problem.moved_mass(at));
        let (rows, before, d) = (conditions.forces(now.step().reaction), self.before.take(), problem.dimension());
        let forces = vectors_of(&rows, d);
        for (non_matching, balance) in self.interface_balance.iter_mut().enumerate() {
            balance.take(&problem.sides_of_non_matching(non_matching), &now.reaction, &forces);
        }
        let forward = motion.map(|motion| rows_of(&motion.forward, d));
        let mut gaps = vec![f64::INFINITY; forces.len()];
        for (at, contact) in problem.contact_nodes().iter().enumerate() {
            let node = contact.node.index();
            let frame = problem.frame(at);
            self.forced[at] |= now.reaction[at] != [0.0; 3];
            self.press(at, &frame, &forces[at], before.as_ref().map(|(_, gaps)| gaps[at]));
            let (Some(after), Some(forward)) = (window.after, &forward) else { continue };
            let moved = after.step().displacement;
            if !conditions.holds(at) {
                continue;
            }
            gaps[at] = conditions.gap(at, moved) + conditions.give(at, &rows);
            let place = [gaps[at], along(&frame, &problem.contact_point(at), &after.displacement[node], d)];
            let path = frame.split(&conditions.relative(at, moved)).0;
            self.gap(at, (&frame, place, path), (&forces[at], terms.map(|terms| terms.rest(node))));
            if contact.free {
                let earlier = before.as_ref().map(|(forces, _)| &forces[at]);
                self.status(
                    [now, after].map(|held| held.touching[at]),
                    (&forces[at], earlier),
                    faint(at, problem.mass()[node]),
                );
                let velocity = conditions.relative(at, forward);
                self.slide(contact, &frame, (&forces[at], &velocity), [dt, least]);
            }
        }
        self.before = Some((forces, gaps));
    }

    /// The cone, and penetration, from the gap at this instant (m).
    fn press(&mut self, at: usize, frame: &Frame<3>, force: &Vector, gap: Option<f64>) {
        let contact = &self.problem.contact_nodes()[at];
        let [slip, tension] = self.problem.obstacle(contact.obstacle).law().excess(frame, force);
        let slip = if contact.guided { 0.0 } else { slip };
        let normal = frame.split(force).0;
        self.largest[0] = self.largest[0].max(normal);
        self.largest[1] = self.largest[1].max(slip).max(tension);
        if let Some(gap) = gap.filter(|gap| contact.free && gap.is_finite()) {
            self.largest[3] = self.largest[3].max(-gap);
            if normal > 0.0 {
                let terms = [-gap * normal, normal * normal, gap * gap];
                self.pressed.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
                if gap < 0.0 {
                    self.springs[at].iter_mut().zip([terms[0], terms[2]]).for_each(|(sum, term)| *sum += term);
                }
            }
        }
    }

    /// The gap at t_{n+1} under a force at t_n, or where the balance needs one, with the path along the normal so far.
    fn gap(
        &mut self,
        at: usize,
        (frame, place, path): (&Frame<3>, [f64; 2], f64),
        (force, needed): (&Vector, Option<Vector>),
    ) {
        let (contact, [gap, _]) = (&self.problem.contact_nodes()[at], place);
        let normal = frame.split(force).0.max(0.0);
        self.largest[2] = self.largest[2].max(normal * gap);
        if !contact.free {
            return;
        }
        let plane = &mut self.planes[contact.obstacle];
        plane.forced.add(at, normal, place, path);
        if *force == [0.0; 3] {
            let needed = needed.map_or(0.0, |needed| frame.split(&needed).0.max(0.0));
            plane.missing.add(at, needed, place, path);
        }
    }

    /// Touching status at t_n and t_{n+1} against the force at t_n and the one before; forces below `faint` (N) are
    /// none or any.
    fn status(&mut self, [now, after]: [bool; 2], (force, before): (&Vector, Option<&Vector>), faint: f64) {
        let disagree =
            |touches: bool, force: &Vector| usize::from(if touches { *force == [0.0; 3] } else { norm(force) > faint });
        self.disagree[0] += disagree(after, force);
        self.disagree[1] += disagree(now, force);
        self.changes[0] += usize::from(after != now);
        if let Some(before) = before {
            self.disagree[2] += disagree(after, before);
            self.changes[1] += usize::from((norm(force) > faint) != (norm(before) > faint));
        }
    }

    /// Friction over a step of dt (s) in which the node moves; at less than `least` (m/s), it sticks but for noise.
    fn slide(
        &mut self,
        contact: &ContactNode,
        frame: &Frame<3>,
        (force, velocity): (&Vector, &Vector),
        [dt, least]: [f64; 2],
    ) {
        let ((normal, friction), (_, sliding)) = (frame.split(force), frame.split(velocity));
        let speed = norm(&sliding);
        if contact.guided || normal <= 0.0 || speed <= least || speed * dt <= ADDED * self.unsure {
            return;
        }
        let limit = self.problem.obstacle(contact.obstacle).law().limit(normal);
        let terms = [limit * speed, normal * speed, -dot(&friction, &sliding)];
        let sums = &mut self.planes[contact.obstacle].slide;
        sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term * dt);
    }

    /// The first plane at another place than the contact, with the mean gap (m) and its slope along the plane: under
    /// forces, or where they are missing.
    pub(super) fn offset(&self, missing: bool) -> Option<(usize, [f64; 2])> {
        let tolerance = self.nearness.tolerance(self.unsure);
        let of = |plane: &PlaneSums| if missing { plane.missing.line() } else { plane.forced.line() };
        let gaps = self.planes.iter().enumerate().filter_map(|(k, plane)| of(plane).map(|line| (k, line)));
        gaps.into_iter().find(|(_, line)| line.size > tolerance).map(|(k, line)| (k, [line.mean, line.slope]))
    }

    /// Factors of the displacements, one for each plane with contact, that bring the contact onto it.
    pub(super) fn paths(&self) -> Vec<f64> {
        let all = self.planes.iter();
        all.filter_map(|plane| plane.forced.path().or_else(|| plane.missing.path())).collect()
    }

    /// The plane with the largest misfit of friction, and the coefficient of the history there, the mean of |R_t|/R_n.
    pub(super) fn friction(&self) -> Option<(usize, f64)> {
        let planes = self.planes.iter().enumerate();
        let (k, plane) = planes.max_by(|(_, a), (_, b)| a.misfit().abs().total_cmp(&b.misfit().abs()))?;
        let [_, normal, tangential] = plane.slide;
        (normal > 0.0).then(|| (k, tangential / normal))
    }

    /// The normal force over the penetration (N/m) of each position that was pressed behind its plane.
    pub(super) fn springs(&self) -> impl Iterator<Item = (usize, f64)> {
        let pressed = self.springs.iter().enumerate().filter(|(_, [_, square])| *square > 0.0);
        pressed.map(|(at, [product, square])| (at, product / square))
    }

    /// Whether a force acts on non-matching interfaces.
    pub(super) fn slides(&self) -> bool {
        (0..self.forced.len()).any(|at| self.forced[at] && self.problem.non_matching_of(at).is_some())
    }

    /// What is wrong with forces on non-matching interfaces.
    pub(super) fn unbalanced_interface(&self) -> String {
        let all = self.interface_balance.iter().enumerate();
        let worst = all.max_by(|(_, a), (_, b)| a.share().total_cmp(&b.share()));
        worst.map_or(String::new(), |(non_matching, balance)| balance.cause(self.problem, non_matching))
    }

    /// Enters the figures.
    pub(super) fn enter(&self, found: &mut Consistency) {
        let ([normal, excess, product, depth], size) = (self.largest, self.nearness.element);
        found.cone = super::ratio(excess, normal.max(excess));
        found.interface_balance = self.interface_balance.iter().map(InterfaceBalance::share).reduce(f64::max);
        found.gap_under_force = super::ratio(product, normal * size);
        found.penetration = depth / size;
        let [product, force, path] = self.pressed;
        found.penalty = (force * path > 0.0).then(|| product / (force * path).sqrt());
        let gaps = self.planes.iter().filter_map(|plane| plane.forced.common());
        found.plane = gaps.map(|gap| (gap - ADDED * self.unsure).max(0.0) / size).fold(0.0, f64::max);
        let [limit, misfit] = self.planes.iter().fold([0.0; 2], |[limit, misfit], plane| {
            [limit + plane.slide[0], misfit + if plane.slide[0] > 0.0 { plane.misfit().abs() } else { 0.0 }]
        });
        found.slip = (limit > 0.0).then(|| misfit / limit);
        let changes = self.changes[0].max(self.changes[1]).max(1);
        found.touching = self.disagree[0] as f64 / changes as f64;
    }
}

/// The place of a node along its plane (m), from the left to the right as seen with the normal upwards; 0 of a bar.
fn along(frame: &Frame<3>, point: &Vector, displacement: &Vector, dimension: usize) -> f64 {
    match (frame.normal(), dimension) {
        (&[x, y, _], 2) => y * (point[0] + displacement[0]) - x * (point[1] + displacement[1]),
        _ => 0.0,
    }
}
