//! Contact forces and supports: the nodes that are not like all others.

use super::lanes::{Nodal, place};
use percute_core::dynamics::Dynamics;
use percute_core::problem::{PrescribedComponent, Problem};
use std::ops::Range;

/// The forces on the contact nodes and on prescribed components, by node.
#[derive(Debug)]
pub(super) struct SurfaceForces {
    /// Contact nodes with their position in the contact surface.
    nodes: Vec<(u32, u32)>,
    /// Contact forces of all motions (N), in the same order.
    forces: Vec<Nodal>,
    supports: Vec<Support>,
}

/// A prescribed component of a node.
#[derive(Clone, Copy, Debug)]
struct Support {
    node: u32,
    component: u32,
    /// Position among the prescribed components.
    at: usize,
    /// The force that its motion needs (N).
    force: f64,
}

impl SurfaceForces {
    pub(super) fn new<const D: usize>(problem: &Problem<D>) -> Self {
        let contacts = problem.surface().nodes().iter().zip(0..);
        let mut nodes: Vec<(u32, u32)> = contacts.map(|(contact, at)| (contact.node.index() as u32, at)).collect();
        nodes.sort_unstable();
        let mut supports: Vec<Support> = problem.prescribed().iter().enumerate().map(Support::new).collect();
        supports.sort_by_key(|support| support.node);
        Self { forces: vec![Nodal::ZERO; nodes.len()], nodes, supports }
    }

    /// Takes in the motion of the supports at t_n.
    pub(super) fn hold<const D: usize>(&mut self, dynamics: &Dynamics<'_, D>, n: usize) {
        let mass = dynamics.problem().mass();
        for support in &mut self.supports {
            support.force = mass[support.node as usize] * dynamics.prescribed_acceleration(n, support.at);
        }
    }

    /// Takes in the nodal forces of F_DA and the reactions of the simulation.
    pub(super) fn contact<const D: usize>(&mut self, pull: &[[f64; D]], reaction: &[[f64; D]]) {
        for ((_, at), forces) in self.nodes.iter().zip(&mut self.forces) {
            let (pull, reaction) = (pull[*at as usize], reaction[*at as usize]);
            *forces = Nodal::new([pull, pull, reaction, std::array::from_fn(|c| reaction[c] - pull[c])]);
        }
    }

    /// Sets the forces on prescribed components of these nodes and adds those of contact on others. At supports the
    /// contact difference stays at rest.
    #[inline(always)]
    pub(super) fn apply(&self, nodes: &Range<usize>, forces: &mut [Nodal]) {
        let local = |node: u32| node as usize - nodes.start;
        let supports = &self.supports[between(&self.supports, nodes, |support| support.node)];
        for support in supports {
            forces[local(support.node)].set(support.component as usize, support.force);
        }
        let contacts = between(&self.nodes, nodes, |(node, _)| *node);
        for ((node, _), contact) in self.nodes[contacts.clone()].iter().zip(&self.forces[contacts]) {
            let force = &mut forces[local(*node)].0;
            (0..force.len()).for_each(|i| force[i] += contact.0[i]);
        }
        for support in supports {
            forces[local(support.node)].0[place(3, support.component as usize)] = 0.0;
        }
    }

    /// The prescribed components of these nodes: node and component.
    #[inline(always)]
    pub(super) fn prescribed(&self, range: &Range<usize>) -> impl Iterator<Item = (usize, usize)> {
        let supports = &self.supports[between(&self.supports, range, |support| support.node)];
        supports.iter().map(|support| (support.node as usize, support.component as usize))
    }

    /// The forces that the motion of one node needs: component and force (N).
    pub(super) fn supports_of(&self, node: u32) -> impl Iterator<Item = (usize, f64)> {
        let node = node as usize;
        let supports = &self.supports[between(&self.supports, &(node..node + 1), |support| support.node)];
        supports.iter().map(|support| (support.component as usize, support.force))
    }
}

impl Support {
    fn new((at, component): (usize, &PrescribedComponent)) -> Self {
        Self { node: component.node.index() as u32, component: component.component as u32, at, force: 0.0 }
    }
}

/// Where the nodes of a range are among sorted ones.
#[inline(always)]
fn between<T>(sorted: &[T], range: &Range<usize>, node: impl Fn(&T) -> u32) -> Range<usize> {
    let first = |limit: usize| sorted.partition_point(|one| (node(one) as usize) < limit);
    first(range.start)..first(range.end)
}
