//! Which side of a non-matching interface is the slave, and which side has the normal.

use super::alignment::unit;
use super::distance::nearest;
use super::sides::{Bodies, InterfaceSide};
use crate::contact::{dot, tangent};
use crate::ids::NodeId;
use crate::material::Law;

/// Surfaces that stick out beyond each other by less than this part of their length are as long as each other.
const OVERHANG: f64 = 1e-9;
/// Moduli, masses and distances that differ by a smaller part are equal.
const EQUAL: f64 = 1e-9;
/// Mean squares of deviations from a normal that differ by a smaller part are equal, and so are those of rounding.
const FLAT: f64 = 1e-9;

/// What the two sides of an interface are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Roles {
    /// The side with the multipliers.
    pub(super) slave: usize,
    /// The side that the normal stands on.
    pub(super) face: usize,
}

impl<const D: usize> Bodies<'_, D> {
    /// Which side is the slave: the one of several bodies, else the one that strikes the other side. Else it is the one
    /// that sticks out less beyond the other one; of two that do so alike, that with the shorter edges, else that of
    /// the softer body, of the lighter one, or of the one whose centre of mass is nearer. Of bodies that are all alike
    /// it is the lower or the left one.
    ///
    /// The normal stands on the surface that a corner of the slave strikes. Else it stands on the flatter one, or on
    /// the master where both are flat alike.
    pub(super) fn roles(&self, sides: &[InterfaceSide<D>; 2], displacement: &[[f64; D]]) -> Roles {
        let on_flatter = |slave: usize| Roles { slave, face: self.flatter(sides).unwrap_or(1 - slave) };
        if let Some(several) = sides.iter().position(|side| side.bodies.len() > 1) {
            return on_flatter(several);
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
        let rounding = EQUAL * lengths[0].min(lengths[1]);
        if let Some((slave, is_corner)) = self.striking(sides, [&direction, &along], rounding, displacement) {
            return if is_corner { Roles { slave, face: 1 - slave } } else { on_flatter(slave) };
        }
        let outside = lengths.map(|length| length - common);
        if (outside[0] - outside[1]).abs() > OVERHANG * lengths[0].max(lengths[1]) {
            return on_flatter(usize::from(outside[1] < outside[0]));
        }
        if sides[0].faces.len() != sides[1].faces.len() {
            return on_flatter(usize::from(sides[1].faces.len() > sides[0].faces.len()));
        }
        on_flatter(self.weaker(sides, &direction, displacement).unwrap_or_else(|| usize::from(!is_upward(&direction))))
    }

    /// The side that strikes the other one with a corner, or a flat one with a curve, and whether it is a corner: one
    /// of its nodes is nearer to the other side at the start than all nodes of that. The direction is from the first
    /// side to the second one, and lengths below `rounding` (m) are equal.
    fn striking(
        &self,
        sides: &[InterfaceSide<D>; 2],
        [direction, along]: [&[f64; D]; 2],
        rounding: f64,
        displacement: &[[f64; D]],
    ) -> Option<(usize, bool)> {
        let edges = sides.each_ref().map(|side| self.edges(side, displacement));
        let nodes = nearest(edges.each_ref().map(Vec::as_slice), direction, along, rounding);
        let strikes = |&one: &usize| {
            let (own, other) = (nodes[one], nodes[1 - one]);
            other.distance - own.distance > rounding && (own.is_corner || self.spread(&sides[1 - one]) <= FLAT)
        };
        [0, 1].into_iter().find(strikes).map(|one| (one, nodes[one].is_corner))
    }

    /// The side that is flatter, if one is.
    fn flatter(&self, sides: &[InterfaceSide<D>; 2]) -> Option<usize> {
        let spread = sides.each_ref().map(|side| self.spread(side));
        let alike = (spread[0] - spread[1]).abs() <= FLAT * (spread[0].max(spread[1]) + FLAT);
        (!alike).then_some(usize::from(spread[1] < spread[0]))
    }

    /// The unit normal from the master to the slave that stands on a side.
    pub(super) fn normal(&self, sides: &[InterfaceSide<D>; 2], Roles { slave, face }: Roles) -> [f64; D] {
        let outward = self.outward(sides)[face];
        if face == slave { outward.map(|n| -n) } else { outward }
    }

    /// The mean square of the difference of the normals of edges and their mean one, by length.
    fn spread(&self, side: &InterfaceSide<D>) -> f64 {
        let mean = unit(&side.of_whole);
        let (mut sum, mut length) = (0.0, 0.0);
        for &face in &side.faces {
            let (normal, area) = self.mesh.normal_in::<D>(face);
            let apart: [f64; D] = std::array::from_fn(|c| normal[c] - mean[c]);
            sum += area * dot(&apart, &apart);
            length += area;
        }
        sum / length
    }

    /// The side of the softer body, or of the lighter one, or of that whose centre of mass is nearer to its surface
    /// along a direction.
    fn weaker(&self, sides: &[InterfaceSide<D>; 2], direction: &[f64; D], displacement: &[[f64; D]]) -> Option<usize> {
        let less = |[first, second]: [f64; 2]| {
            ((first - second).abs() > EQUAL * first.abs().max(second.abs())).then_some(usize::from(second < first))
        };
        let masses = sides.each_ref().map(|side| self.mass_and_centre(side, displacement));
        let depth = |side: &InterfaceSide<D>, centre: &[f64; D]| {
            let count = side.nodes.len() as f64;
            let places = side.nodes.iter().map(|&node| dot(&self.place(node, displacement), direction));
            (places.sum::<f64>() / count - dot(centre, direction)).abs()
        };
        less(sides.each_ref().map(|side| self.modulus(side)))
            .or_else(|| less(masses.map(|(mass, _)| mass)))
            .or_else(|| less([0, 1].map(|side| depth(&sides[side], &masses[side].1))))
    }

    /// The mean modulus λ + 2G = ρc² at the edges of a side, by length (Pa).
    fn modulus(&self, side: &InterfaceSide<D>) -> f64 {
        let (mut sum, mut length) = (0.0, 0.0);
        for &face in &side.faces {
            let (law, area) = ((self.law)(face), self.mesh.normal_in::<D>(face).1);
            sum += area * law.wave_modulus();
            length += area;
        }
        sum / length
    }

    /// The mass (kg) and the centre of mass (m) of the first body of a side.
    fn mass_and_centre(&self, side: &InterfaceSide<D>, displacement: &[[f64; D]]) -> (f64, [f64; D]) {
        let (mut mass, mut centre) = (0.0, [0.0; D]);
        for (index, _) in self.body.iter().enumerate().filter(|(_, body)| **body == side.bodies[0]) {
            let place = self.place(NodeId::new(index), displacement);
            mass += self.mass[index];
            (0..D).for_each(|c| centre[c] += self.mass[index] * place[c]);
        }
        (mass, centre.map(|moment| moment / mass))
    }

    /// The ends of the edges of a side (m).
    fn edges(&self, side: &InterfaceSide<D>, displacement: &[[f64; D]]) -> Vec<[[f64; D]; 2]> {
        let nodes = side.faces.iter().map(|face| self.mesh.face_nodes::<D>(*face));
        nodes.map(|nodes| std::array::from_fn(|k| self.place(nodes[k.min(nodes.len() - 1)], displacement))).collect()
    }

    fn place(&self, node: NodeId, displacement: &[[f64; D]]) -> [f64; D] {
        std::array::from_fn(|c| self.mesh.points_in::<D>()[node.index()][c] + displacement[node.index()][c])
    }
}

/// The direction from the first side to the second one, midway between the normals of both.
fn between<const D: usize>(sides: &[InterfaceSide<D>; 2]) -> [f64; D] {
    let outward = sides.each_ref().map(|side| unit(&side.of_whole));
    let sum: [f64; D] = std::array::from_fn(|c| outward[0][c] - outward[1][c]);
    // Sides that do not face each other are refused later.
    if dot(&sum, &sum) < EQUAL { outward[0] } else { unit(&sum) }
}

/// Whether a direction is upward or, if it is horizontal, to the right.
fn is_upward<const D: usize>(direction: &[f64; D]) -> bool {
    let leading = direction.iter().rev().find(|component| component.abs() > EQUAL);
    leading.is_none_or(|component| *component > 0.0)
}

#[cfg(test)]
mod tests {
    use super::is_upward;

    #[test]
    fn a_direction_and_its_opposite_differ() {
        for direction in [[0.0, 1.0], [1.0, 0.0], [-0.6, 0.8], [1.0, 1e-16], [1.0, -1e-16]] {
            assert!(is_upward(&direction) && !is_upward(&direction.map(|x: f64| -x)), "{direction:?}");
        }
    }
}
