//! The stress of a density on an edge beside that of the linear traction with the same moments.
//!
//! It balances itself. Any stress that does so may be taken: the one of least energy among a bound in the element of
//! the edge, the stress in the star of a node, that in the element, cut where the density has its peak, and one of two
//! parts where this is close to a node.

use super::faces::EdgeFace;
use super::load::{Load, place_in};
use super::residual_stress::ResidualStress;
use crate::concentrated::{EdgeRest, RestStress, StarElement, rest_stress};
use percute_core::ids::ElementId;
use percute_core::problem::Problem;

/// Where ∫r² is at most this part of ∫F², the bound of its energy is not worth a better one.
const SMALL: f64 = 1e-3;

/// Nearer to a node than this part of the edge, a place does not cut the triangle: the slender part would lose all
/// digits. It is no simple fraction, so that rounding does not choose at a place of a regular mesh.
const SLENDER: f64 = 0.0077;

/// Elements with such stresses.
pub(super) type Stresses = Vec<(ElementId, ResidualStress)>;

/// The stress of one edge.
pub(super) fn of_edge<const D: usize>(problem: &Problem<D>, edge: &EdgeFace, load: &Load<D>) -> Stresses {
    let (id, rest) = (owner(problem, edge), load.rest(edge));
    let mut least = vec![(id, ResidualStress::inside((edge.spread * rest).sqrt()))];
    if rest <= SMALL * load.square(edge) {
        return least;
    }
    let (corners, load) = (corners(problem, edge), &load.without_slivers(edge));
    let mut take = |other: Option<Stresses>| {
        if let Some(other) = other.filter(|other| total(other) < total(&least)) {
            least = other;
        }
    };
    (0..2).for_each(|end| take(in_star(problem, edge, end, load)));
    for place in load.peaks() {
        take(in_cut_triangle((problem, edge), corners, place, load).map(|stress| vec![(id, stress)]));
        (0..2).for_each(|end| take(close_to_a_node(problem, edge, (end, place), load)));
    }
    least
}

/// The stress of a load with a peak close to the node at an end, in two steps: first that of its difference to a linear
/// traction on a part of the edge, in the similar part of the element, then that of this traction in the star of the
/// node.
fn close_to_a_node<const D: usize>(
    problem: &Problem<D>,
    edge: &EdgeFace,
    (end, place): (usize, f64),
    load: &Load<D>,
) -> Option<Stresses> {
    let part = Some(load.part_at(end, place)).filter(|part| *part < 1.0)?;
    let [beside, whole] = load.spread_over(part, end, edge);
    let corners = corners(problem, edge);
    let similar = |corner: [f64; 2]| [0, 1].map(|c| corners[end][c] + part * (corner[c] - corners[end][c]));
    let place = place_in(part, end, place);
    let short = EdgeFace { length: part * edge.length, spread: part * edge.spread, ..*edge };
    let cut = in_cut_triangle((problem, &short), corners.map(similar), place, &beside)?;
    let mut stresses = in_star(problem, edge, end, &whole)?;
    stresses.push((owner(problem, edge), cut));
    Some(stresses)
}

/// The stress in the star of the node at an end of the edge; none if rounding spoils it.
fn in_star<const D: usize>(problem: &Problem<D>, edge: &EdgeFace, end: usize, load: &Load<D>) -> Option<Stresses> {
    let (mesh, candidate) = (problem.mesh(), &problem.surface().faces()[edge.face]);
    let node = problem.surface().nodes()[candidate.nodes[edge.ends[end]]].node;
    let star = mesh.stars().star(node);
    let corners = |&id: &ElementId| {
        let (points, cell) = (mesh.points_in::<D>(), mesh.cell(id));
        let (corners, own) = (cell.len(), mesh.local_node(id, node).unwrap_or(0));
        let point = |next: usize| points[cell[(own + next) % corners].index()];
        let arm = |next: usize| [0, D - 1].map(|c| point(next)[c] - point(0)[c]);
        StarElement { ends: [arm(1), arm(corners - 1)], law: problem.material(id) }
    };
    let elements: Vec<_> = star.elements.iter().map(corners).collect();
    let supported = [star.links.first(), star.links.last()].map(|link| {
        let supported = link.copied().flatten().map_or([false; D], |face| problem.supported(face));
        [supported[0], supported[D - 1]]
    });
    let mut rests = [EdgeRest::default(), EdgeRest::default()];
    let (load, difference) = load.with_equal_ways([0.0, 1.0][end], edge);
    rests[usize::from(star.links[0] != Some(candidate.face))] = load.seen_from(end, edge);
    let stresses = rest_stress(&elements, &rests, supported)?;
    let of = |(&id, stress): (&ElementId, &RestStress)| {
        let at = mesh.local_node(id, node).unwrap_or(0);
        (id, ResidualStress { inside: 0.0, shared: stress.root, products: stress.products(at) })
    };
    let rest = (owner(problem, edge), ResidualStress::inside((edge.spread * difference).sqrt()));
    Some(star.elements.iter().zip(&stresses).map(of).chain((difference > 0.0).then_some(rest)).collect())
}

/// The corners of the element of an edge: its first and its second end, and the one opposite.
fn corners<const D: usize>(problem: &Problem<D>, edge: &EdgeFace) -> [[f64; 2]; 3] {
    let (mesh, candidate) = (problem.mesh(), &problem.surface().faces()[edge.face]);
    let ends = edge.ends.map(|end| problem.surface().nodes()[candidate.nodes[end]].node);
    let cell = mesh.cell(owner(problem, edge));
    let apex = cell.iter().find(|node| !ends.contains(node)).copied().unwrap_or(ends[0]);
    [ends[0], ends[1], apex].map(|node| [0, D - 1].map(|c| mesh.points_in::<D>()[node.index()][c]))
}

/// The stress in a triangle on an edge, cut from a place on the edge to the corner opposite; none if a part would be
/// slender. A support of the edge is not made use of.
fn in_cut_triangle<const D: usize>(
    (problem, edge): (&Problem<D>, &EdgeFace),
    [a, b, opposite]: [[f64; 2]; 3],
    place: f64,
    load: &Load<D>,
) -> Option<ResidualStress> {
    if place.min(1.0 - place) < SLENDER {
        return None;
    }
    let at = [0, 1].map(|c| a[c] * (1.0 - place) + b[c] * place);
    let [before, after, up] = [a, b, opposite].map(|corner| [0, 1].map(|c| corner[c] - at[c]));
    let (load, difference) = load.with_equal_ways(place, edge);
    let [first, second] = load.around(place, edge);
    // Counterclockwise.
    let (fan, rests) = if after[0] * up[1] > after[1] * up[0] {
        ([after, up, before], [second, first])
    } else {
        ([before, up, after], [first, second])
    };
    let law = problem.material(owner(problem, edge));
    let elements = cut_fan(fan).map(|ends| StarElement { ends, law });
    let stresses = rest_stress(&elements, &rests, [[false; 2]; 2])?;
    let square: f64 = stresses.iter().map(|stress| stress.root * stress.root).sum();
    Some(ResidualStress::inside(square.sqrt() + (edge.spread * difference).sqrt()))
}

/// A fan of four triangles around the origin between three points: both angles are cut into halves, because the stress
/// of a force at the origin needs more than two triangles.
fn cut_fan([a, b, c]: [[f64; 2]; 3]) -> [[[f64; 2]; 2]; 4] {
    let halfway = |a: [f64; 2], b: [f64; 2]| {
        let [p, q] = [a, b].map(|x| x[0].hypot(x[1]));
        [0, 1].map(|c| (q * a[c] + p * b[c]) / (p + q))
    };
    let (d, e) = (halfway(a, b), halfway(b, c));
    [[a, d], [d, b], [b, e], [e, c]]
}

fn owner<const D: usize>(problem: &Problem<D>, edge: &EdgeFace) -> ElementId {
    problem.mesh().face(problem.surface().faces()[edge.face].face).owner
}

/// The sum of the roots, which is to be small: they are added to those of other stresses.
fn total(stresses: &Stresses) -> f64 {
    stresses.iter().map(|(_, stress)| stress.root()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::material::Elastic;
    use std::f64::consts::{LN_2, PI};

    const YOUNG: f64 = 70e9;

    /// Energies in both halves of a triangle with this apex over an edge from 0 to 1, cut at a place of the edge. A
    /// unit force acts there along a direction: hats of this width on both sides.
    fn energies(apex: [f64; 2], place: f64, width: f64, direction: [f64; 2]) -> Option<[f64; 2]> {
        let stresses = stresses(apex, place, width, direction)?;
        let half = |k: usize| stresses[k..k + 2].iter().map(|stress| stress.root * stress.root).sum();
        Some([half(0), half(2)])
    }

    /// The other corners of the four parts of the triangle, from the place.
    fn parts(apex: [f64; 2], place: f64) -> [[[f64; 2]; 2]; 4] {
        cut_fan([[1.0 - place, 0.0], [apex[0] - place, apex[1]], [-place, 0.0]])
    }

    /// The stress in them.
    fn stresses(apex: [f64; 2], place: f64, width: f64, direction: [f64; 2]) -> Option<Vec<RestStress>> {
        let law = Elastic::plane_stress(YOUNG, 0.3, 2700.0, 1.0).unwrap();
        let elements = parts(apex, place).map(|ends| StarElement { ends, law: &law });
        // The far moment of the linear traction with the resultant and the centroid of the hats, which is the place.
        let nodal = [4.0 - 6.0 * place, 6.0 * place - 2.0];
        let linear = |at: f64| nodal[0] * (1.0 - at) + nodal[1] * at;
        let rest = |end: f64| {
            let length = (end - place).abs();
            let scaled = |value: f64| direction.map(|d| d * value * length);
            let points = vec![(0.0, scaled(1.0 / width)), (width / length, scaled(0.0))];
            EdgeRest { points, linear: [place, end].map(|at| scaled(linear(at))) }
        };
        rest_stress(&elements, &[rest(1.0), rest(0.0)], [[false; 2]; 2])
    }

    /// A stress inside a triangle, without tractions on its other edges, does no work on a constant strain: its
    /// products with the loads of a constant stress cancel.
    #[test]
    fn stresses_inside_do_no_work_on_a_constant_strain() {
        for (apex, place) in [([0.0, 1.0], 0.5), ([0.5, 0.8], 0.4), ([0.2, 0.5], 0.7)] {
            let stresses = stresses(apex, place, 1e-2, [0.6, 0.8]).unwrap();
            for [xx, yy, xy] in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [3.0, -2.0, 1.5]] {
                let (mut sum, mut largest) = (0.0, 0.0_f64);
                for (stress, [first, second]) in stresses.iter().zip(parts(apex, place)) {
                    let corners = [[0.0; 2], first, second];
                    let products = stress.products(0);
                    for k in 0..6 {
                        let (a, b) = (corners[(k / 2 + 1) % 3], corners[(k / 2 + 2) % 3]);
                        let normal = [b[1] - a[1], a[0] - b[0]];
                        let traction = [xx * normal[0] + xy * normal[1], xy * normal[0] + yy * normal[1]];
                        for c in 0..2 {
                            let work = traction[c] * products[2 * k + c];
                            sum += work;
                            largest = largest.max(work.abs());
                        }
                    }
                }
                // Rounding of the star problem.
                assert!(sum.abs() < 1e-11 * largest, "{apex:?}: {sum} {largest}");
            }
        }
    }

    /// Close to the place the stress is that of a force on a half-plane: each octave costs P²/E ln 2/π along the
    /// normal. Eight sectors meet there: the energy is larger by some percent.
    #[test]
    fn octaves_in_a_cut_element_cost_the_energy_of_the_radial_field() {
        let exact = LN_2 / PI / YOUNG;
        for (apex, place) in [([0.0, 1.0], 0.5), ([0.5, 0.8], 0.4), ([0.2, 0.5], 0.7)] {
            let total = |width: f64| energies(apex, place, width, [0.0, 1.0]).unwrap().iter().sum::<f64>();
            let octave = (total(1.0 / 1024.0) - total(1.0 / 512.0)) / exact;
            assert!((1.0..1.5).contains(&octave), "{apex:?} {place}: {octave}");
        }
    }

    /// Cuts as near to a node as they may be leave stresses that balance.
    #[test]
    fn cuts_keep_their_digits() {
        for apex in [[0.0, 1.0], [0.5, 0.8], [0.2, 0.5], [-0.5, 0.4], [1.3, 0.6]] {
            for place in [SLENDER, 2.0 * SLENDER, 0.3, 1.0 - SLENDER] {
                for width in [1e-1, 1e-2, 1e-3, 1e-4] {
                    let found = energies(apex, place, width * SLENDER, [0.6, 0.8]);
                    assert!(found.is_some(), "{apex:?} {place} {width}");
                }
            }
        }
    }

    /// The mirror image of a triangle and its load has the same energies.
    #[test]
    fn mirrored_loads_have_the_same_energies() {
        for direction in [[0.0, 1.0], [1.0, 0.0], [0.6, 0.8]] {
            let [a, b] = energies([0.3, 0.7], 0.35, 1e-2, direction).unwrap();
            let [c, d] = energies([0.7, 0.7], 0.65, 1e-2, [-direction[0], direction[1]]).unwrap();
            // Rounding of some hundred operations.
            assert!((a - d).abs() < 1e-10 * a && (b - c).abs() < 1e-10 * b, "{direction:?}: {a} {b} {c} {d}");
        }
    }
}
