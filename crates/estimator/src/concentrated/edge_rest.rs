//! The stress of a traction on an edge less the linear one with the same moments, in the star of a node.

use super::edge_traction::EdgeTraction;
use super::star_stress::{StarElement, StarStress};
use percute_core::material::LinearLaw;

/// Break points that such a traction may have.
const POINTS: usize = 8;

/// Roots of the energies in the elements of a star (J^½), for a traction on its first (0) or its last edge (1): places
/// along the edge from the node of the star, ascending, and the values there times the length of the edge (N). None if
/// there are too many points, or if rounding spoils the stress.
pub(crate) fn roots<L: LinearLaw>(
    elements: &[StarElement<'_, L>],
    edge: usize,
    points: &[(f64, [f64; 2])],
    supported: [[bool; 2]; 2],
) -> Option<Vec<f64>> {
    let last = *points.last().filter(|_| points.len() <= POINTS)?;
    let component = |c: usize| {
        let largest = points.iter().fold(0.0_f64, |most, (_, value)| most.max(value[c].abs()));
        let scale = if largest > 0.0 { 1.0 / largest } else { 0.0 };
        let at = |k: usize| points.get(k).map_or([last.0, 0.0], |(place, value)| [*place, scale * value[c]]);
        (largest, EdgeTraction::<POINTS>(std::array::from_fn(at)))
    };
    let [x, y] = [component(0), component(1)];
    // Each component is a traction of its own, along its axis: the first column of one, the second of the other.
    let stress = StarStress::of(elements, &[(edge, x.1), (edge, y.1)], supported);
    if !stress.residuals.balanced() {
        return None;
    }
    let root = |(element, data): (usize, &StarElement<'_, L>)| {
        let energy = |i: usize, j: usize| stress.energy_in(element, i, j);
        let sum = x.0 * x.0 * energy(0, 0) + 2.0 * x.0 * y.0 * energy(0, 3) + y.0 * y.0 * energy(3, 3);
        (0.5 * sum / data.law.extent()).max(0.0).sqrt()
    };
    Some(elements.iter().enumerate().map(root).collect())
}
