//! By how much surfaces that touch face each other along another direction than the normal of their contact.

use super::mortar::{Side, SlidingSurfaces};
use super::surface::ContactSurface;
use super::{dot, tangent};
use crate::mesh::Mesh;
use std::collections::BTreeMap;

/// The largest angle (rad) by which surfaces of two bodies lean away from the normal of their contact where they
/// touch: that by which two edges of which all nodes have `touched` lean to the same side, and that of an edge that a
/// corner of the slave has touched. Nodes are given by their positions in the contact surface. Nodes `inside` a
/// surface, as those on a line of symmetry, are no corners. `shifts` has how far the parts of the slave of surfaces
/// that slide have moved along their tangent against the master where the surfaces are looked at (m).
#[must_use]
pub fn common_slope<const D: usize, const N: usize>(
    surface: &ContactSurface<D>,
    mesh: &Mesh<D, N>,
    touched: impl Fn(usize) -> bool,
    inside: impl Fn(usize) -> bool,
    shifts: impl Fn(&SlidingSurfaces<D>) -> Vec<f64>,
) -> f64 {
    // Bars are in a row.
    if D == 1 {
        return 0.0;
    }
    let slopes = surface.sliding().iter().map(|sliding| of_sliding(sliding, &touched, &inside, &shifts(sliding)));
    slopes.fold(of_pairs(surface, mesh, &touched), f64::max)
}

/// The lean of two edges at one place: none if one of them is level, or if they lean to different sides.
fn common(one: f64, other: f64) -> f64 {
    if one * other > 0.0 { one.abs().min(other.abs()) } else { 0.0 }
}

fn of_pairs<const D: usize, const N: usize>(
    surface: &ContactSurface<D>,
    mesh: &Mesh<D, N>,
    touched: &impl Fn(usize) -> bool,
) -> f64 {
    let opposite = |at: usize| surface.nodes()[at].opposite;
    let sorted = |mut nodes: [usize; D]| {
        nodes.sort_unstable();
        nodes
    };
    let facets: BTreeMap<[usize; D], _> = surface.facets().iter().map(|facet| (sorted(facet.nodes), facet)).collect();
    let mut largest = 0.0_f64;
    for facet in surface.facets().iter().filter(|facet| facet.nodes.iter().all(|&at| touched(at))) {
        let other = facet.nodes.map(|at| opposite(at).unwrap_or(at));
        let Some(other) = facets.get(&sorted(other)).filter(|other| other.facet != facet.facet) else { continue };
        let frame = surface.obstacles()[facet.obstacle].flat_frame();
        let (normal, along) = (frame.normal(), tangent(frame.normal()));
        let slope = |facet| {
            let outward = mesh.facet_normal(facet).0;
            (dot(&outward, &along) / dot(&outward, normal)).atan()
        };
        largest = largest.max(common(slope(facet.facet), slope(other.facet)));
    }
    largest
}

fn of_sliding<const D: usize>(
    sliding: &SlidingSurfaces<D>,
    touched: &impl Fn(usize) -> bool,
    inside: &impl Fn(usize) -> bool,
    shifts: &[f64],
) -> f64 {
    let [slave, master] = [sliding.slave(), sliding.master()].map(Line);
    let tolerance = sliding.tolerance();
    let place = |node: usize| slave.0.xi()[node] + shifts[slave.0.part_of(node)];
    let mut largest = 0.0_f64;
    for &own in slave.0.edges().iter().filter(|&&own| slave.has_touched(own, touched)) {
        let ends = [place(own) + tolerance, place(own + 1) - tolerance];
        for other in master.edges_between(ends).filter(|&other| master.has_touched(other, touched)) {
            largest = largest.max(common(slave.slope(own), master.slope(other)));
        }
    }
    let strikes = |&node: &usize| {
        let at = slave.0.position(node);
        touched(at) && !inside(at) && slave.0.is_corner(node)
    };
    for xi in (0..slave.0.len()).filter(strikes).map(place) {
        // Between two edges that lean to different sides, the direction is one between theirs.
        let slopes = master.edges_between([xi - tolerance, xi + tolerance]).map(|edge| master.slope(edge));
        largest = largest.max(slopes.reduce(|a, b| common(a, b).copysign(a)).unwrap_or(0.0).abs());
    }
    largest
}

/// A side of surfaces that slide, in the undeformed mesh.
#[derive(Clone, Copy)]
struct Line<'s>(&'s Side);

impl Line<'_> {
    /// The angle of an edge, by its first node (rad).
    fn slope(&self, first: usize) -> f64 {
        let [xi, eta] = [self.0.xi(), self.0.eta()].map(|values| values[first + 1] - values[first]);
        eta.atan2(xi)
    }

    fn has_touched(&self, first: usize, touched: &impl Fn(usize) -> bool) -> bool {
        [first, first + 1].iter().all(|&node| touched(self.0.position(node)))
    }

    /// The first nodes of the edges of one body that reach into an interval (m).
    fn edges_between(&self, [from, to]: [f64; 2]) -> impl Iterator<Item = usize> + '_ {
        let (xi, edges) = (self.0.xi(), self.0.edges());
        let begin = edges.partition_point(|&first| xi[first + 1] <= from);
        edges[begin..].iter().copied().take_while(move |&first| xi[first] < to)
    }
}
