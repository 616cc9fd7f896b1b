//! How consistent the steps of a history are: one pass over them.

use super::balance::{Balance, Terms, dot};
use super::window::{Window, windows};
use percute_core::history::{SinkError, Step, StepSource};
use percute_core::ids::ElementId;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use serde::Serialize;

/// Forces that would change the velocity of a node by this share in a step count as a term of the balance. In the flight of a
/// rigid body all others are rounding, in single precision up to 1e-4 of it.
const FLIGHT: f64 = 1e-2;

/// The figures of consistency; each is 0 in a history that fits its problem exactly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Consistency {
    /// Largest component of M a + K u − F − R at any node and instant, over the largest of its terms. The acceleration is
    /// that of the history, else that of the displacements.
    pub balance: f64,
    /// The node of this component.
    pub node: usize,
    /// Its instant (s).
    pub time: f64,
    /// Largest difference of the given accelerations from those of the displacements, over the largest acceleration.
    pub acceleration: Option<f64>,
    /// Largest difference of the given velocities from those of the displacements, over the largest velocity.
    pub velocity: Option<f64>,
    /// Largest difference of u_0 from that of the problem, over the size of the body.
    pub initial_displacement: f64,
    /// Largest difference of v_0 from that of the problem, over the largest velocity at the start.
    pub initial_velocity: f64,
    /// Largest tension, or tangential force beyond Coulomb's limit, over the largest normal force.
    pub cone: f64,
    /// Largest product of a normal force at t_n and the gap at t_{n+1}, over the largest force and the element size.
    pub gap_under_force: f64,
    /// Largest penetration, over the element size.
    pub penetration: f64,
    /// Share of the contact impulse at nodes that do not touch one step later, or of touching nodes without force.
    pub touching: f64,
    /// Largest error of the energy balance, over the largest energy or work.
    pub energy: f64,
}

/// A change of a history that is tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Trial {
    /// The contact forces of this many steps later are taken.
    pub(crate) shift: isize,
    /// Factors of R, M and K.
    pub(crate) factors: [f64; 3],
}

impl Default for Trial {
    fn default() -> Self {
        Self { shift: 0, factors: [1.0; 3] }
    }
}

/// A history with the displacements in another order of the nodes.
pub(crate) struct Reordered<'s, const D: usize> {
    pub(crate) source: &'s dyn StepSource<D>,
    /// The row of each node.
    pub(crate) rows: Vec<usize>,
}

impl<const D: usize> StepSource<D> for Reordered<'_, D> {
    fn times(&self) -> &TimeGrid {
        self.source.times()
    }

    fn count(&self) -> usize {
        self.source.count()
    }

    fn replay(&self, take: &mut dyn FnMut(&Step<'_, D>) -> Result<(), SinkError>) -> Result<(), SinkError> {
        self.source.replay(&mut |step| {
            let of = |field: &[[f64; D]]| self.rows.iter().map(|&row| field[row]).collect::<Vec<_>>();
            let (displacement, acceleration) = (of(step.displacement), step.acceleration.map(of));
            take(&Step { displacement: &displacement, acceleration: acceleration.as_deref(), ..*step })
        })
    }
}

/// Sums from which likely causes follow.
#[derive(Clone, Debug)]
pub(crate) struct Evidence<const D: usize> {
    /// Factors of R, M and K that make the residual least, each alone.
    pub(crate) best: [f64; 3],
    /// Sum of squares of the residual at each node (N²).
    pub(crate) by_node: Vec<f64>,
    /// Nodes of the surface on which a contact force acts at some instant.
    pub(crate) forced: Vec<bool>,
    /// Velocity of the first step without its forces, over v₀: the best factor; none if nothing moves at the start.
    pub(crate) speed: Option<f64>,
    /// Means of it and of v₀ (m/s).
    pub(crate) start: [[f64; D]; 2],
    /// Largest difference of −v of the last step from v₀, over the largest velocity; of u_N from u_0, over the size.
    pub(crate) reversed: [f64; 2],
}

/// Measures a history as it is, or with a change.
pub(crate) fn measure<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    source: &dyn StepSource<D>,
    trial: Trial,
) -> Result<(Consistency, Evidence<D>), SinkError> {
    let mut pass = Pass::new(Balance::new(problem, source.times()), trial, source.count());
    windows(source, &mut |window| {
        pass.take(window);
        Ok(())
    })?;
    Ok(pass.finish())
}

/// Size of the elements that may touch a plane (m), of all elements without planes: their shortest edge.
fn element_size<const D: usize, const N: usize>(problem: &Problem<D, N>) -> f64 {
    let mesh = problem.mesh();
    let edge = |element: ElementId| {
        let points = mesh.cell_points(element);
        let pairs = (0..N).flat_map(|i| (0..i).map(move |j| (i, j)));
        let length = |(i, j): (usize, usize)| {
            let along: [f64; D] = std::array::from_fn(|c| points[i][c] - points[j][c]);
            dot(&along, &along).sqrt()
        };
        pairs.map(length).fold(f64::INFINITY, f64::min)
    };
    let near = problem.surface().facets().iter().map(|f| mesh.facets()[f.facet.index()].owner);
    let smallest = near.map(edge).fold(f64::INFINITY, f64::min);
    if smallest.is_finite() { smallest } else { mesh.size() }
}

struct Pass<'p, const D: usize, const N: usize> {
    balance: Balance<'p, D, N>,
    trial: Trial,
    last: usize,
    size: f64,
    found: Consistency,
    evidence: Evidence<D>,
    /// Largest residual and largest term (N).
    residual: [f64; 2],
    /// Largest difference and largest value of given accelerations (m/s²) and velocities (m/s).
    acceleration: [f64; 2],
    velocity: [f64; 2],
    /// Scalar products R·R, R·(Ma + Ku − F), Ma·Ma, Ma·(F + R − Ku), Ku·Ku, Ku·(F + R − Ma).
    products: [[f64; 2]; 3],
    /// Largest normal force (N), cone excess (N), product of force and gap (N m).
    contact: [f64; 3],
    /// Impulse that does not touch and all of it; touching nodes without force and all of them.
    touching: [f64; 4],
}

impl<'p, const D: usize, const N: usize> Pass<'p, D, N> {
    fn new(balance: Balance<'p, D, N>, trial: Trial, count: usize) -> Self {
        let problem = balance.problem();
        let evidence = Evidence {
            by_node: vec![0.0; problem.mesh().node_count()],
            forced: vec![false; problem.surface().nodes().len()],
            best: [1.0; 3],
            speed: None,
            start: [[0.0; D]; 2],
            reversed: [0.0; 2],
        };
        Self {
            size: element_size(problem),
            balance,
            trial,
            last: count.saturating_sub(1),
            found: Consistency::default(),
            evidence,
            residual: [0.0; 2],
            acceleration: [0.0; 2],
            velocity: [0.0; 2],
            products: [[0.0; 2]; 3],
            contact: [0.0; 3],
            touching: [0.0; 4],
        }
    }

    fn take(&mut self, window: Window<'_, D>) {
        let now = window.now;
        let derived = self.balance.acceleration(window);
        let reaction = match self.trial.shift {
            0 => Some(&now.reaction),
            1 => window.after.map(|held| &held.reaction),
            _ => window.before.map(|held| &held.reaction),
        };
        let used = now.acceleration.as_ref().or(derived.as_ref().filter(|_| now.index > 0));
        if let (Some(used), Some(reaction)) = (used, reaction) {
            let terms = self.balance.terms(now, used);
            self.weigh(&terms, &self.nodal(reaction), now.time);
            self.fly(window);
        }
        if let Some(derived) = derived {
            self.motion(window, &derived);
            if now.index == 0 {
                self.start(window);
            }
        }
        self.touch(window);
        self.end(window);
    }

    /// R at all nodes; 0 at prescribed components.
    fn nodal(&self, reaction: &[[f64; D]]) -> Vec<[f64; D]> {
        let problem = self.balance.problem();
        let mut nodal = vec![[0.0; D]; problem.mesh().node_count()];
        for (contact, force) in problem.surface().nodes().iter().zip(reaction) {
            nodal[contact.node.index()] = *force;
        }
        problem.prescribed().iter().for_each(|p| nodal[p.node.index()][p.component] = 0.0);
        nodal
    }

    /// Adds the balance of an instant.
    fn weigh(&mut self, terms: &Terms<D>, reaction: &[[f64; D]], time: f64) {
        let [of_r, of_m, of_k] = self.trial.factors;
        for (node, force) in reaction.iter().enumerate() {
            for (c, r) in force.iter().enumerate() {
                let (r, a) = (of_r * r, of_m * terms.inertia[node][c]);
                let (k, f) = (of_k * terms.stiffness[node][c], terms.load[node][c]);
                let rest = a + k - f - r;
                self.residual[1] = [r, a, k, f].iter().fold(self.residual[1], |most, x| most.max(x.abs()));
                if rest.abs() > self.residual[0] {
                    self.residual[0] = rest.abs();
                    (self.found.node, self.found.time) = (node, time);
                }
                self.evidence.by_node[node] += rest * rest;
                let rest = [(r, a + k - f), (a, f + r - k), (k, f + r - a)];
                for (sums, (term, rest)) in self.products.iter_mut().zip(rest) {
                    sums[0] += term * term;
                    sums[1] += term * rest;
                }
            }
        }
    }

    /// Takes in the force that the velocities of a step are compared with.
    fn fly(&mut self, window: Window<'_, D>) {
        let Some([_, forward]) = self.balance.half_steps(window) else { return };
        let mass = self.balance.problem().mass();
        let most = forward.iter().zip(mass).map(|(v, m)| m * dot(v, v).sqrt()).fold(0.0, f64::max);
        self.residual[1] = self.residual[1].max(FLIGHT * most / self.balance.times().velocity_step(window.now.index));
    }

    /// Compares given velocities and accelerations with those of the displacements.
    fn motion(&mut self, window: Window<'_, D>, derived: &[[f64; D]]) {
        let n = window.now.index;
        if n == 0 {
            return;
        }
        if let Some(given) = &window.now.acceleration {
            compare(&mut self.acceleration, given, derived);
        }
        let halves = self.balance.half_steps(window);
        if let (Some(given), Some([back, _])) = (&window.now.velocity, halves) {
            let half = 0.5 * self.balance.times().step(n - 1);
            let of = |(v, a): (&[f64; D], &[f64; D])| std::array::from_fn(|c| v[c] + half * a[c]);
            let derived: Vec<_> = back.iter().zip(derived).map(of).collect();
            compare(&mut self.velocity, given, &derived);
        }
    }

    /// Compares the state at the start with that of the problem.
    fn start(&mut self, window: Window<'_, D>) {
        let (problem, now) = (self.balance.problem(), window.now);
        let mut moved = [0.0; 2];
        compare(&mut moved, &now.displacement, problem.initial_displacement());
        self.found.initial_displacement = moved[0] / problem.mesh().size();
        let Some([_, forward]) = self.balance.half_steps(window) else { return };
        let Terms { stiffness, load, .. } = self.balance.terms(now, &forward);
        let (h, reaction) = (self.balance.times().velocity_step(0), self.nodal(&now.reaction));
        let without = |(node, v): (usize, &[f64; D])| {
            std::array::from_fn(|c| {
                v[c] - h / problem.mass()[node] * (load[node][c] - stiffness[node][c] + reaction[node][c])
            })
        };
        let mut started: Vec<[f64; D]> = match &now.velocity {
            Some(given) => given.clone(),
            None => forward.iter().enumerate().map(without).collect(),
        };
        let stated = problem.initial_velocity();
        problem.prescribed().iter().for_each(|p| {
            started[p.node.index()][p.component] = stated[p.node.index()][p.component];
        });
        let mut speeds = [0.0; 2];
        compare(&mut speeds, &started, stated);
        let largest = stated.iter().flatten().fold(speeds[1], |most, v| most.max(v.abs()));
        self.found.initial_velocity = ratio(speeds[0], largest);
        let (along, own): (f64, f64) = started
            .iter()
            .zip(stated)
            .fold((0.0, 0.0), |(along, own), (v, v0)| (along + dot(v, v0), own + dot(v0, v0)));
        self.evidence.speed = (own > 0.0).then(|| along / own);
        let mean =
            |field: &[[f64; D]]| std::array::from_fn(|c| field.iter().map(|v| v[c]).sum::<f64>() / field.len() as f64);
        self.evidence.start = [mean(&started), mean(stated)];
    }

    /// Cone, gaps and touching status.
    fn touch(&mut self, window: Window<'_, D>) {
        let (problem, now) = (self.balance.problem(), window.now);
        for (at, contact) in problem.surface().nodes().iter().enumerate() {
            let node = contact.node.index();
            let frame = problem.surface().frame(at, &now.displacement[node]);
            let obstacle = &problem.obstacles()[contact.obstacle];
            let force = now.reaction[at];
            let (normal, _) = frame.split(&force);
            let [slip, tension] = obstacle.law().excess(&frame, &force);
            let slip = if contact.guided { 0.0 } else { slip };
            self.contact[0] = self.contact[0].max(normal);
            self.contact[1] = self.contact[1].max(slip).max(tension);
            self.evidence.forced[at] |= force != [0.0; D];
            if contact.free && now.index > 0 {
                let gap = problem.surface().gap(at, &now.displacement[node]);
                self.found.penetration = self.found.penetration.max(-gap / self.size);
            }
            let Some(after) = window.after else { continue };
            let gap = problem.surface().gap(at, &after.displacement[node]);
            self.contact[2] = self.contact[2].max(normal.max(0.0) * gap);
            let size = dot(&force, &force).sqrt();
            self.touching[1] += size;
            if !after.touching[at] {
                self.touching[0] += size;
            } else {
                self.touching[3] += 1.0;
                self.touching[2] += f64::from(u8::from(size == 0.0));
            }
        }
    }

    /// Compares the end with the start, as in a history that runs backwards.
    fn end(&mut self, window: Window<'_, D>) {
        let (Some(before), problem) = (window.before, self.balance.problem()) else { return };
        if window.now.index < self.last {
            return;
        }
        let dt = self.balance.times().step(window.now.index - 1);
        let ends = before.displacement.iter().zip(&window.now.displacement);
        let back: Vec<_> = ends.map(|(a, b)| std::array::from_fn(|c| (a[c] - b[c]) / dt)).collect();
        let (mut speeds, mut places) = ([0.0; 2], [0.0; 2]);
        compare(&mut speeds, &back, problem.initial_velocity());
        compare(&mut places, &window.now.displacement, problem.initial_displacement());
        self.evidence.reversed = [ratio(speeds[0], speeds[1]), places[0] / problem.mesh().size()];
    }

    fn finish(self) -> (Consistency, Evidence<D>) {
        let Self { mut found, mut evidence, residual, acceleration, velocity, products, contact, touching, .. } = self;
        let given = |[difference, largest]: [f64; 2]| (largest > 0.0).then(|| difference / largest);
        found.balance = ratio(residual[0], residual[1]);
        found.acceleration = given(acceleration);
        found.velocity = given(velocity);
        found.cone = ratio(contact[1], contact[0].max(contact[1]));
        found.gap_under_force = ratio(contact[2], contact[0] * self.size);
        found.touching = ratio(touching[0], touching[1]).max(ratio(touching[2], touching[3]));
        evidence.best = products.map(|[own, with]| if own > 0.0 { with / own } else { 1.0 });
        (found, evidence)
    }
}

/// Takes in the largest difference and the largest value of the first.
fn compare<const D: usize>(largest: &mut [f64; 2], given: &[[f64; D]], other: &[[f64; D]]) {
    for (a, b) in given.iter().flatten().zip(other.iter().flatten()) {
        largest[0] = largest[0].max((a - b).abs());
        largest[1] = largest[1].max(a.abs());
    }
}

/// a/b, and 0 where both are.
fn ratio(a: f64, b: f64) -> f64 {
    if a == 0.0 { 0.0 } else { a / b }
}
