//! Contact forces and supports: the nodes that are not like all others.

use super::cells::{Cell, Cells};
use super::{Fields, MOTIONS, NodalLanes};
use percute_core::dynamics::Dynamics;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use std::ops::Range;

/// The motion of a contact node over the next step.
#[derive(Clone, Copy, Debug)]
pub(in crate::reconstruction::corrected) struct Approach<const D: usize> {
    /// Gap at the next instant without a contact force (m).
    pub(in crate::reconstruction::corrected) gap: f64,
    /// Displacement along the plane now, and at the next instant without a contact force (m).
    pub(in crate::reconstruction::corrected) along: [[f64; D]; 2],
    /// Displacement that a unit force adds until then (m/N).
    pub(in crate::reconstruction::corrected) mobility: f64,
}

/// The forces on the contact nodes and on prescribed components, by node.
#[derive(Debug)]
pub(super) struct SurfaceForces<const D: usize, const N: usize> {
    /// Contact nodes with their position in the contact surface.
    nodes: Vec<(u32, u32)>,
    /// Contact forces of all motions (N), in the same order.
    forces: Vec<NodalLanes<D>>,
    supports: Vec<Support>,
    /// Elements with a contact node, and the positions of their nodes in the contact surface.
    near: Vec<(Cell<D, N>, [Option<u32>; N])>,
    /// Forces on the auxiliary solution but those of contact (N), by position.
    before_contact: Vec<[f64; D]>,
    /// Its displacement and velocity there.
    motion: Vec<[[f64; D]; 2]>,
    approaches: Vec<Approach<D>>,
}

/// A prescribed component of a node.
#[derive(Clone, Copy, Debug)]
struct Support {
    node: u32,
    component: u32,
    /// Position among the prescribed components.
    at: usize,
    acceleration: f64,
}

impl<const D: usize, const N: usize> SurfaceForces<D, N> {
    pub(super) fn new(problem: &Problem<D, N>, cells: &Cells<D, N>) -> Self {
        let mut nodes: Vec<(u32, u32)> =
            problem.surface().nodes().iter().zip(0..).map(|(c, at)| (c.node.index() as u32, at)).collect();
        nodes.sort_unstable();
        let place = |n: u32| nodes.binary_search_by_key(&n, |(node, _)| *node).ok().map(|k| nodes[k].1);
        let near = cells.cells.iter().map(|cell| (*cell, cell.nodes.map(place)));
        let mut supports: Vec<Support> = problem.prescribed().iter().enumerate().map(Support::new).collect();
        supports.sort_by_key(|support| support.node);
        let count = nodes.len();
        Self {
            supports,
            near: near.filter(|(_, places)| places.iter().any(Option::is_some)).collect(),
            forces: vec![NodalLanes::ZERO; count],
            before_contact: vec![[0.0; D]; count],
            motion: vec![[[0.0; D]; 2]; count],
            approaches: Vec::with_capacity(count),
            nodes,
        }
    }

    /// Takes in the motion of the supports at t_n.
    pub(super) fn hold(&mut self, dynamics: &Dynamics<'_, D, N>, n: usize) {
        for support in &mut self.supports {
            support.acceleration = dynamics.prescribed_acceleration(n, support.at);
        }
    }

    /// Takes in the nodal forces of F_DA and the reactions of the simulation.
    pub(super) fn contact(&mut self, pull: &[[f64; D]], reaction: &[[f64; D]]) {
        for ((_, at), lanes) in self.nodes.iter().zip(&mut self.forces) {
            let (pull, reaction) = (pull[*at as usize], reaction[*at as usize]);
            *lanes = NodalLanes(std::array::from_fn(|c| [pull[c], pull[c], reaction[c], reaction[c] - pull[c]]));
        }
    }

    /// Turns forces on these nodes into accelerations: sets those on prescribed components, hands the forces on the auxiliary
    /// solution out before it adds those of contact, and keeps the contact difference at rest at supports.
    #[inline(always)]
    pub(super) fn apply(&self, range: &Range<usize>, mass: &[f64], forces: &mut [NodalLanes<D>], out: &mut [[f64; D]]) {
        let supports = between(&self.supports, range, |support| support.node);
        for support in &self.supports[supports.clone()] {
            let (node, c) = (support.node as usize, support.component as usize);
            forces[node].0[c] = [mass[node] * support.acceleration; MOTIONS];
        }
        for (out, force) in out[range.clone()].iter_mut().zip(&forces[range.clone()]) {
            *out = force.0.map(|lanes| lanes[0]);
        }
        let contacts = between(&self.nodes, range, |(node, _)| *node);
        for ((node, _), contact) in self.nodes[contacts.clone()].iter().zip(&self.forces[contacts]) {
            let force = &mut forces[*node as usize].0;
            for c in 0..D {
                (0..MOTIONS).for_each(|l| force[c][l] += contact.0[c][l]);
            }
        }
        for support in &self.supports[supports] {
            forces[support.node as usize].0[support.component as usize][MOTIONS - 1] = 0.0;
        }
    }

    /// The prescribed components of these nodes: node and component.
    #[inline(always)]
    pub(super) fn prescribed(&self, range: &Range<usize>) -> impl Iterator<Item = (usize, usize)> {
        let supports = &self.supports[between(&self.supports, range, |support| support.node)];
        supports.iter().map(|support| (support.node as usize, support.component as usize))
    }

    /// Computes the motion of the auxiliary solution at the contact nodes, and its forces there but those of contact. Its
    /// displacement has still to make the step of length `due` (s).
    pub(super) fn approach(&mut self, problem: &Problem<D, N>, cells: &Cells<D, N>, fields: &Fields<D>, due: f64) {
        let moved = |n: u32| {
            let (u, v) = (&fields.displacement[n as usize].0, &fields.half_step[n as usize].0);
            std::array::from_fn(|c| std::array::from_fn(|l| u[c][l] + due * v[c][l]))
        };
        let mut forces = vec![NodalLanes::ZERO; N];
        for (node, at) in &self.nodes {
            let (node, at) = (*node as usize, *at as usize);
            self.before_contact[at] = fields.external.get(node).copied().unwrap_or([0.0; D]);
            let displacement: [[f64; MOTIONS]; D] = moved(node as u32);
            self.motion[at] = [displacement, fields.half_step[node].0].map(|field| field.map(|lanes| lanes[0]));
        }
        for (cell, places) in &self.near {
            forces.fill(NodalLanes::ZERO);
            cells.subtract_element(cell, &cell.nodes.map(moved), &mut forces);
            for (at, force) in places.iter().zip(&forces) {
                if let Some(at) = at {
                    (0..D).for_each(|c| self.before_contact[*at as usize][c] += force.0[c][0]);
                }
            }
        }
        for support in &self.supports {
            if let Ok(k) = self.nodes.binary_search_by_key(&support.node, |(node, _)| *node) {
                let at = self.nodes[k].1 as usize;
                let needed = problem.mass()[support.node as usize] * support.acceleration;
                self.before_contact[at][support.component as usize] = needed;
            }
        }
    }

    /// The motion of all contact nodes until t_{n+1} under these forces.
    pub(super) fn approaches(
        &mut self,
        problem: &Problem<D, N>,
        inverse_mass: &[f64],
        times: &TimeGrid,
        n: usize,
    ) -> &[Approach<D>] {
        let (step, length) = (times.step(n), times.velocity_step(n));
        self.approaches.clear();
        for (at, contact) in problem.surface().nodes().iter().enumerate() {
            let mobility = step * length * inverse_mass[contact.node.index()];
            let ([now, velocity], force) = (self.motion[at], self.before_contact[at]);
            let next = std::array::from_fn(|c| now[c] + step * velocity[c] + mobility * force[c]);
            let frame = problem.obstacles()[contact.obstacle].flat_frame();
            self.approaches.push(Approach {
                gap: problem.surface().gap(at, &next),
                along: [now, next].map(|displacement| frame.split(&displacement).1),
                mobility,
            });
        }
        &self.approaches
    }
}

impl Support {
    fn new((at, component): (usize, &percute_core::problem::PrescribedComponent)) -> Self {
        Self { node: component.node.index() as u32, component: component.component as u32, at, acceleration: 0.0 }
    }
}

/// Where the nodes of a range are among sorted ones.
#[inline(always)]
fn between<T>(sorted: &[T], range: &Range<usize>, node: impl Fn(&T) -> u32) -> Range<usize> {
    let place = |limit: usize| sorted.partition_point(|one| (node(one) as usize) < limit);
    place(range.start)..place(range.end)
}
