//! The inclination of surfaces in contact to the common normal of their contact.

use super::mortar::{NonMatchingSurfaces, Side};
use super::surface::ContactSurface;
use super::{dot, tangent};
use crate::mesh::Mesh;
use std::collections::BTreeMap;

/// The inclination of the edges of two bodies to the normal of their contact, in the undeformed mesh.
#[derive(Clone, Debug)]
pub struct Inclination<'s, const D: usize> {
    surface: &'s ContactSurface<D>,
    /// Edges of pairs inclined to the same side, by the positions of their nodes, each with its angle (rad).
    pairs: Vec<([usize; D], f64)>,
    non_matching: Vec<Slopes>,
    /// Whether each node is inside a surface although it is at its end, as on a line of symmetry.
    inside: Vec<bool>,
}

/// The angles of the edges of the slave and of the master of non-matching interfaces (rad).
#[derive(Clone, Debug)]
struct Slopes {
    slave: Vec<f64>,
    master: Vec<f64>,
    /// The largest angle of the master: no edge and no corner has a larger one.
    largest: f64,
}

/// Smaller angles (rad) are rounding of a normal.
const LEVEL: f64 = 1e-9;

impl<'s, const D: usize> Inclination<'s, D> {
    /// Of all contacts between bodies. Nodes `inside` a surface, by their positions, are no corners.
    #[must_use]
    pub fn new(surface: &'s ContactSurface<D>, mesh: &Mesh, inside: Vec<bool>) -> Self {
        // Bars are in a row.
        let (pairs, non_matching) = if D == 1 {
            (Vec::new(), Vec::new())
        } else {
            (pairs(surface, mesh), surface.non_matching().iter().map(Slopes::new).collect())
        };
        Self { surface, pairs, non_matching, inside }
    }

    /// The largest inclination (rad) of the surfaces at an instant, or `least` if that is larger: the common angle of
    /// two edges inclined to the same side, with forces on all of their nodes, and the angle of an edge at which a
    /// force acts on a corner of the slave. `acts` says whether a force acts on a node. `shifts` has how far
    /// the parts of the slave are along the tangent against the master (m), of non-matching interfaces, by their
    /// number.
    #[must_use]
    pub fn largest<'a>(&self, least: f64, acts: impl Fn(usize) -> bool, shifts: impl Fn(usize) -> &'a [f64]) -> f64 {
        let paired = self.pairs.iter().filter(|(nodes, angle)| *angle > least && nodes.iter().all(|&at| acts(at)));
        let mut largest = paired.fold(least, |most, (_, angle)| most.max(*angle));
        for (index, slopes) in self.non_matching.iter().enumerate().filter(|(_, slopes)| slopes.largest > least) {
            let found = self.of_non_matching((&self.surface.non_matching()[index], slopes), &acts, shifts(index));
            largest = largest.max(found);
        }
        largest
    }

    fn of_non_matching(
        &self,
        (non_matching, slopes): (&NonMatchingSurfaces<D>, &Slopes),
        acts: &impl Fn(usize) -> bool,
        shifts: &[f64],
    ) -> f64 {
        let (slave, master, tolerance) = (non_matching.slave(), non_matching.master(), non_matching.tolerance());
        let acts_on = |side: &Side, first: usize| [first, first + 1].iter().all(|&node| acts(side.position(node)));
        let place = |node: usize| slave.xi()[node] + shifts[slave.part_of(node)];
        let mut largest = 0.0_f64;
        for (edge, &own) in slave.edges().iter().enumerate().filter(|(_, own)| acts_on(slave, **own)) {
            let ends = [place(own) + tolerance, place(own + 1) - tolerance];
            let faced = edges_between(master, ends).filter(|&other| acts_on(master, master.edges()[other]));
            largest = faced.fold(largest, |most, other| most.max(common(slopes.slave[edge], slopes.master[other])));
        }
        let strikes = |&node: &usize| {
            let at = slave.position(node);
            slave.is_corner(node) && acts(at) && !self.inside[at]
        };
        for xi in (0..slave.len()).filter(strikes).map(place) {
            let faced = edges_between(master, [xi - tolerance, xi + tolerance]);
            largest = largest.max(inclination_at(&slopes.master, faced));
        }
        largest
    }
}

/// The inclination of the edges at a place. Between two inclined to different sides, the direction is one between
/// theirs.
fn inclination_at(slopes: &[f64], edges: impl Iterator<Item = usize>) -> f64 {
    edges.map(|edge| slopes[edge]).reduce(|a, b| common(a, b).copysign(a)).unwrap_or(0.0).abs()
}

impl Slopes {
    fn new<const D: usize>(non_matching: &NonMatchingSurfaces<D>) -> Self {
        let [slave, master] = [non_matching.slave(), non_matching.master()].map(|side| {
            let slope = |&first: &usize| {
                let [xi, eta] = [side.xi(), side.eta()].map(|values| values[first + 1] - values[first]);
                let angle = eta.atan2(xi);
                if angle.abs() <= LEVEL { 0.0 } else { angle }
            };
            side.edges().iter().map(slope).collect::<Vec<f64>>()
        });
        let largest = master.iter().fold(0.0, |most: f64, slope| most.max(slope.abs()));
        Self { slave, master, largest }
    }
}

/// The common inclination of two edges at one place: none if one of them is level, or if they are inclined to
/// different sides.
fn common(one: f64, other: f64) -> f64 {
    if one * other > 0.0 { one.abs().min(other.abs()) } else { 0.0 }
}

/// The edges of pairs of nodes that are inclined to the same side, each with its angle (rad).
fn pairs<const D: usize>(surface: &ContactSurface<D>, mesh: &Mesh) -> Vec<([usize; D], f64)> {
    let partner = |at: usize| surface.nodes()[at].partner;
    let sorted = |mut nodes: [usize; D]| {
        nodes.sort_unstable();
        nodes
    };
    let faces: BTreeMap<[usize; D], _> = surface.faces().iter().map(|face| (sorted(face.nodes), face)).collect();
    let mut inclined = Vec::new();
    for face in surface.faces() {
        let other = face.nodes.map(|at| partner(at).unwrap_or(at));
        let Some(other) = faces.get(&sorted(other)).filter(|other| other.face != face.face) else { continue };
        let frame = surface.obstacles()[face.obstacle].flat_frame();
        let (normal, along) = (frame.normal(), tangent(frame.normal()));
        let slope = |face| {
            let outward = mesh.normal_in::<D>(face).0;
            (dot(&outward, &along) / dot(&outward, normal)).atan()
        };
        let angle = common(slope(face.face), slope(other.face));
        if angle > LEVEL {
            inclined.push((face.nodes, angle));
        }
    }
    inclined
}

/// The edges of a side of one body that reach into an interval (m).
fn edges_between(side: &Side, [from, to]: [f64; 2]) -> impl Iterator<Item = usize> + '_ {
    let (xi, edges) = (side.xi(), side.edges());
    let begin = edges.partition_point(|&first| xi[first + 1] <= from);
    (begin..edges.len()).take_while(move |&edge| xi[edges[edge]] < to)
}
