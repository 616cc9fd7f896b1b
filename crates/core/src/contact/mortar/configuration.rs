//! The contact surface at an instant: gaps and relative fields of its nodes.

use super::coupling::Coupling;
use super::dual::DualShape;
use super::side::Side;
use super::surfaces::NonMatchingSurfaces;
use crate::contact::frame::dot;
use crate::contact::surface::ContactSurface;

/// The contact surface with some displacements of the mesh. Each node has a counterpart: a plane, a node, or the other
/// side of a non-matching interface.
///
/// A node of a slave whose multiplier acts has weighted values against the master, those of its contact condition.
/// Other nodes of a non-matching interface have the value against the point of the other surface at the same ξ, or
/// against the nearest one if there is none.
#[derive(Clone, Debug)]
pub struct ContactConfiguration<'a, const D: usize> {
    surface: &'a ContactSurface<D>,
    couplings: Vec<Coupling>,
}

/// A node of a non-matching interface.
#[derive(Clone, Copy, Debug)]
enum SideNode {
    Slave(usize),
    Master(usize),
}

impl<'a, const D: usize> ContactConfiguration<'a, D> {
    pub(crate) fn new(surface: &'a ContactSurface<D>, displacement: &[[f64; D]]) -> Self {
        let mut configuration = Self { surface, couplings: vec![Coupling::default(); surface.non_matching().len()] };
        configuration.update(displacement);
        configuration
    }

    /// The same with other displacements (m).
    pub fn update(&mut self, displacement: &[[f64; D]]) {
        for (coupling, non_matching) in self.couplings.iter_mut().zip(self.surface.non_matching()) {
            *coupling = non_matching.coupling(self.surface, displacement);
        }
    }

    /// A nodal field at a node of the contact surface less that at what it faces: displacement or velocity against the
    /// obstacle.
    #[must_use]
    pub fn relative(&self, at: usize, field: &[[f64; D]]) -> [f64; D] {
        let Some((non_matching, coupling, place)) = self.place(at) else {
            return self.surface.against_obstacle(at, field);
        };
        let value = |side: &Side, node: usize, c: usize| field[self.node(side, node)][c];
        std::array::from_fn(|c| {
            let values = (|node| value(non_matching.slave(), node, c), |node| value(non_matching.master(), node, c));
            difference(non_matching, coupling, place, values)
        })
    }

    /// The gap of a node (m), eq. \[3\], with these displacements of all nodes of the mesh; infinite at a node that
    /// faces nothing.
    #[must_use]
    pub fn gap(&self, at: usize, displacement: &[[f64; D]]) -> f64 {
        let Some((non_matching, coupling, place)) = self.place(at) else {
            return self.surface.gap(at, &self.surface.against_obstacle(at, displacement));
        };
        if !faces(non_matching, coupling, place) {
            return f64::INFINITY;
        }
        let eta = |side: &Side, node: usize| non_matching.eta(self.surface, side, node, displacement);
        let gap = difference(
            non_matching,
            coupling,
            place,
            (|node| eta(non_matching.slave(), node), |node| eta(non_matching.master(), node)),
        );
        if matches!(place, SideNode::Slave(_)) { gap } else { -gap }
    }

    /// How far the condition of a node gives way (m) under the forces of all conditions (N), while a multiplier sets
    /// in: its gap is not less than minus this.
    #[must_use]
    pub fn give(&self, at: usize, forces: &[[f64; D]]) -> f64 {
        let Some((non_matching, coupling, SideNode::Slave(node))) = self.place(at) else { return 0.0 };
        let multiplier = |k: usize| {
            let press = dot(&forces[non_matching.slave().position(k)], non_matching.frame().normal());
            if coupling.is_active(k) { press / coupling.weight(k) } else { 0.0 }
        };
        if coupling.is_active(node) { coupling.give(node, multiplier) / coupling.weight(node) } else { 0.0 }
    }

    /// How deep a node of a non-matching interface is inside the other body at its own place, along the normal (m): a
    /// weighted gap that is not negative does not exclude it. 0 outside, beside the other surface and elsewhere.
    #[must_use]
    pub fn depth(&self, at: usize, displacement: &[[f64; D]]) -> f64 {
        let Some((non_matching, coupling, place)) = self.place(at) else { return 0.0 };
        let (slave, master) = (non_matching.slave(), non_matching.master());
        let eta = |side: &Side, node: usize| non_matching.eta(self.surface, side, node, displacement);
        let gap = match place {
            SideNode::Slave(node) => {
                let (places, xi) = (coupling.places(slave.part_of(node)), slave.xi()[node]);
                if aside(places, master.edges(), xi) > 0.0 {
                    return 0.0;
                }
                eta(slave, node) - interpolated(places, xi, |node| eta(master, node))
            }
            SideNode::Master(_) if !faces(non_matching, coupling, place) => return 0.0,
            SideNode::Master(_) => {
                -difference(non_matching, coupling, place, (|node| eta(slave, node), |node| eta(master, node)))
            }
        };
        (-gap).max(0.0)
    }

    /// Whether a node of a slave faces nothing, or is a corner at the end of the master: one that faces so little of
    /// its edge that its gap is a mean, or that is beyond this end by a thousandth of its edge at most.
    #[must_use]
    pub fn is_at_end(&self, at: usize) -> bool {
        self.place(at).is_some_and(|(non_matching, coupling, place)| {
            let SideNode::Slave(node) = place else { return false };
            !faces(non_matching, coupling, place) || is_corner_at_end(non_matching.slave(), coupling, node)
        })
    }

    /// Whether a node has a condition of contact of its own: of a slave it faces the master, of a master it has none.
    #[must_use]
    pub fn has_condition(&self, at: usize) -> bool {
        match self.place(at) {
            None => true,
            Some((non_matching, coupling, place)) => {
                matches!(place, SideNode::Slave(_)) && faces(non_matching, coupling, place)
            }
        }
    }

    /// The forces of these conditions (N), from those on the nodes: R_k = w_k λ_k of the multipliers of slaves, nothing
    /// on masters, elsewhere the same. D and M are those of a step if this is at its predicted displacements.
    #[must_use]
    pub fn forces(&self, reaction: &[[f64; D]]) -> Vec<[f64; D]> {
        let mut forces = reaction.to_vec();
        for (non_matching, coupling) in self.surface.non_matching().iter().zip(&self.couplings) {
            non_matching.gather(coupling, reaction, &mut forces);
        }
        forces
    }

    /// How far the parts of the slave of a non-matching interface are along the tangent against its master (m).
    pub(crate) fn shifts(&self, non_matching: usize) -> &[f64] {
        self.couplings[non_matching].shifts()
    }

    /// Masters touch where a node of their slave that touches acts on them.
    pub fn settle_masters(&self, touching: &mut [bool]) {
        for (non_matching, coupling) in self.surface.non_matching().iter().zip(&self.couplings) {
            non_matching.settle_master(coupling, touching);
        }
    }

    fn node(&self, side: &Side, node: usize) -> usize {
        self.surface.nodes()[side.position(node)].node.index()
    }

    fn place(&self, at: usize) -> Option<(&'a NonMatchingSurfaces<D>, &Coupling, SideNode)> {
        let index = self.surface.non_matching_of(at)?;
        let non_matching = &self.surface.non_matching()[index];
        let slave = non_matching.slave().node_at(at).map(SideNode::Slave);
        let place = slave.or_else(|| non_matching.master().node_at(at).map(SideNode::Master))?;
        Some((non_matching, &self.couplings[index], place))
    }
}

/// A corner that is beyond the end of its master by less than this part of its edge has a force on the whole edge: with
/// 1e-10 to 1e-4 of it, at low speed, the estimate is up to 40 times the true error, with 4e-4 and more 1.5 times.
const BEYOND: f64 = 1e-3;

/// Whether a node of a slave is a corner at the end of its master: on one of its edges it has the only multiplier, or
/// the master covers this edge from a place close to the node on.
fn is_corner_at_end(slave: &Side, coupling: &Coupling, node: usize) -> bool {
    let at_end = |first: usize, end: usize| {
        let edge = slave.edges().binary_search(&first);
        edge.is_ok_and(|edge| {
            let (xi, segments) = (slave.xi(), coupling.segments_of(edge));
            let covered = [segments.first().map(|s| s.ends[0]), segments.last().map(|s| s.ends[1])][end];
            let beyond = covered.map(|covered| (covered - xi[first + end]).abs() / (xi[first + 1] - xi[first]));
            let is_beyond = beyond.is_some_and(|beyond| beyond > 0.0 && beyond < BEYOND);
            slave.corners(edge)[end] && (coupling.shape(edge) == DualShape::One(end) || is_beyond)
        })
    };
    at_end(node, 0) || node.checked_sub(1).is_some_and(|first| at_end(first, 1))
}

/// Whether a node faces the other surface.
fn faces<const D: usize>(non_matching: &NonMatchingSurfaces<D>, coupling: &Coupling, place: SideNode) -> bool {
    match place {
        SideNode::Slave(node) => coupling.is_active(node),
        SideNode::Master(node) => {
            let slave = non_matching.slave();
            (0..slave.parts().len()).any(|part| beside(slave, part, coupling.places(part)[node]) <= 0.0)
        }
    }
}

/// The value at a node less that at what it faces, of a field on the slave and one on the master.
fn difference<const D: usize>(
    non_matching: &NonMatchingSurfaces<D>,
    coupling: &Coupling,
    place: SideNode,
    (slave, master): (impl Fn(usize) -> f64, impl Fn(usize) -> f64),
) -> f64 {
    match place {
        SideNode::Slave(node) if coupling.is_active(node) => {
            coupling.difference(node, slave, master) / coupling.weight(node)
        }
        SideNode::Slave(node) => {
            let places = coupling.places(non_matching.slave().part_of(node));
            slave(node) - interpolated(places, non_matching.slave().xi()[node], master)
        }
        SideNode::Master(node) => {
            // The body that it faces, or is nearest to.
            let side = non_matching.slave();
            let away = |part: &usize| beside(side, *part, coupling.places(*part)[node]);
            let part = (0..side.parts().len()).min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(0);
            let nodes = side.parts()[part].nodes.clone();
            let first = nodes.start;
            master(node) - interpolated(&side.xi()[nodes], coupling.places(part)[node], |k| slave(first + k))
        }
    }
}

/// How far a place is beside the edges of a part (m); 0 on one of them.
fn beside(side: &Side, part: usize, place: f64) -> f64 {
    aside(side.xi(), &side.edges()[side.parts()[part].edges.clone()], place)
}

/// The same of edges by their first nodes, with the places of all nodes.
fn aside(xi: &[f64], edges: &[usize], place: f64) -> f64 {
    let after = edges.partition_point(|&first| xi[first] <= place);
    let before = after.checked_sub(1).map_or(f64::INFINITY, |edge| place - xi[edges[edge] + 1]);
    before.min(edges.get(after).map_or(f64::INFINITY, |&first| xi[first] - place)).max(0.0)
}

/// The value at a place of a field that is linear between nodes at these places, and constant beyond.
fn interpolated(places: &[f64], place: f64, field: impl Fn(usize) -> f64) -> f64 {
    let after = places.partition_point(|&other| other <= place);
    if after == 0 || after == places.len() {
        return field(after.saturating_sub(1));
    }
    let part = (place - places[after - 1]) / (places[after] - places[after - 1]);
    field(after - 1) + part * (field(after) - field(after - 1))
}
