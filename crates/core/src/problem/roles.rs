//! Which of two surfaces that slide is the slave, and the normal of both.

use super::sides::{Bodies, Side, unit};
use crate::contact::{dot, tangent};
use crate::ids::NodeId;

/// Surfaces that stick out beyond each other by less than this part of their length are as long as each other.
const OVERHANG: f64 = 1e-9;
/// The square of the length of a vector that has no direction.
const EQUAL: f64 = 1e-9;
/// Mean squares of deviations from a normal that differ by a smaller part are equal, and so are those of rounding.
const FLAT: f64 = 1e-9;

impl<const D: usize, const N: usize> Bodies<'_, D, N> {
    /// Which side is the slave: the one of several bodies, else the one that sticks out less beyond the other one at
    /// the start; of two that do so alike, that with the shorter edges.
    pub(super) fn slave(&self, sides: &[Side<D>; 2], displacement: &[[f64; D]]) -> usize {
        if let Some(several) = sides.iter().position(|side| side.bodies.len() > 1) {
            return several;
        }
        let direction = between(sides);
        let along = tangent(&direction);
        let places = sides.each_ref().map(|side| side.nodes.iter().map(|&node| self.place(node, displacement)));
        let [first, second] = places.map(|places| {
            places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], place| {
                let xi = dot(&place, &along);
                [low.min(xi), high.max(xi)]
            })
        });
        let common = (first[1].min(second[1]) - first[0].max(second[0])).max(0.0);
        let lengths = [first, second].map(|[low, high]| high - low);
        let outside = lengths.map(|length| length - common);
        if (outside[0] - outside[1]).abs() > OVERHANG * lengths[0].max(lengths[1]) {
            return usize::from(outside[1] < outside[0]);
        }
        usize::from(sides[1].facets.len() > sides[0].facets.len())
    }

    /// The unit normal from the master to the slave: that of the flatter surface, along which a corner of the other one
    /// slides, or of the master where both are flat alike.
    pub(super) fn normal(&self, sides: &[Side<D>; 2], slave: usize) -> [f64; D] {
        let spread = sides.each_ref().map(|side| self.spread(side));
        let alike = (spread[0] - spread[1]).abs() <= FLAT * (spread[0].max(spread[1]) + FLAT);
        let flatter = if alike { 1 - slave } else { usize::from(spread[1] < spread[0]) };
        let outward = unit(&sides[flatter].outward);
        if flatter == slave { outward.map(|n| -n) } else { outward }
    }

    /// The mean square of the difference of the normals of edges and their mean one, by length.
    fn spread(&self, side: &Side<D>) -> f64 {
        let mean = unit(&side.outward);
        let (mut sum, mut length) = (0.0, 0.0);
        for &facet in &side.facets {
            let (normal, area) = self.mesh.facet_normal(facet);
            let apart: [f64; D] = std::array::from_fn(|c| normal[c] - mean[c]);
            sum += area * dot(&apart, &apart);
            length += area;
        }
        sum / length
    }

    fn place(&self, node: NodeId, displacement: &[[f64; D]]) -> [f64; D] {
        std::array::from_fn(|c| self.mesh.points()[node.index()][c] + displacement[node.index()][c])
    }
}

/// The direction from the first side to the second one, midway between the normals of both.
fn between<const D: usize>(sides: &[Side<D>; 2]) -> [f64; D] {
    let outward = sides.each_ref().map(|side| unit(&side.outward));
    let sum: [f64; D] = std::array::from_fn(|c| outward[0][c] - outward[1][c]);
    // Sides that do not face each other are refused later.
    if dot(&sum, &sum) < EQUAL { outward[0] } else { unit(&sum) }
}
