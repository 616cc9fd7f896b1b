//! Where the nodes and elements of a fine mesh lie in a coarse one.

use super::ReferenceError;
use percute_core::border::Vector;
use percute_core::ids::{ElementId, NodeId};
use percute_core::mesh::{Locator, Mesh, Weights};

/// How far outside an element, in barycentric coordinates, a node may lie by rounding; as in [`Locator`].
const OUTSIDE: f64 = 1e-9;
/// Volumes of nested meshes of a body agree to this, relative: rounding of sums over 1e6 elements.
const SAME_BODY: f64 = 1e-9;
/// Volumes of other meshes of a body agree to this, relative: a disc in twelve sides lacks 4.5 % of its area.
const SIMILAR_BODY: f64 = 0.05;
/// How far a node is moved into its elements, over their size, before it is looked for: more than rounding at an
/// outline that both meshes share, and less than any element of the coarse mesh.
const INWARDS: f64 = 1e-5;

/// The element of the coarse mesh that a fine node lies in, and its barycentric coordinates there.
#[derive(Clone, Copy, Debug)]
struct CoarsePoint {
    element: ElementId,
    weight: Weights,
}

/// Evaluates P1 fields of a coarse mesh on a fine one.
#[derive(Clone, Debug)]
pub(super) struct Transfer {
    /// Of each fine node.
    places: Vec<CoarsePoint>,
    /// The coarse element that has the centroid of each fine one.
    elements: Vec<ElementId>,
}

impl Transfer {
    /// Places every fine node; each fine element must lie in one coarse element, so that the
    /// coarse field is linear on it.
    pub(super) fn nested(coarse: &Mesh, fine: &Mesh) -> Result<Self, ReferenceError> {
        let locator = Locator::new(coarse);
        let mut places = vec![None; fine.node_count()];
        let mut elements = Vec::with_capacity(fine.element_count());
        for e in (0..fine.element_count()).map(ElementId::new) {
            let not_nested = || ReferenceError::NotNested { fine: e.index() };
            let element = locator.element_at(&fine.centroid(e)).ok_or_else(not_nested)?;
            for &node in fine.cell(e) {
                let weight = locator.weights(element, &fine.point(node));
                if weight.iter().any(|w| *w < -OUTSIDE) {
                    return Err(not_nested());
                }
                places[node.index()] = Some(CoarsePoint { element, weight });
            }
            elements.push(element);
        }
        same_volume(coarse, fine, SAME_BODY)?;
        // Meshes have no nodes without elements, so that none is left out.
        Ok(Self { places: places.into_iter().flatten().collect(), elements })
    }

    /// Looks for every fine node and centroid in the coarse body that covers the same place; outside it the field of
    /// the nearest element goes on.
    pub(super) fn located(coarse: &Mesh, fine: &Mesh) -> Result<Self, ReferenceError> {
        same_volume(coarse, fine, SIMILAR_BODY)?;
        let (locators, body_of) = (Locator::of_bodies(coarse), fine.part_of_elements());
        let coarse_body = matching(&locators, fine)?;
        let centroid = |e: usize| fine.centroid(ElementId::new(e));
        let of_element = |e: usize| &locators[coarse_body[body_of[e]]];
        let elements = (0..fine.element_count()).map(|e| of_element(e).element_near(&centroid(e))).collect();
        let mut places = Vec::with_capacity(fine.node_count());
        for (node, (inner, element)) in inner_points(fine).into_iter().enumerate() {
            let locator = of_element(element);
            let element = locator.element_near(&inner);
            let weight = locator.weights(element, &fine.point(NodeId::new(node)));
            if weight.iter().any(|w| *w < -1.0) {
                return Err(ReferenceError::Outside { node });
            }
            places.push(CoarsePoint { element, weight });
        }
        Ok(Self { places, elements })
    }

    /// The coarse field at each fine node.
    pub(super) fn at_nodes<const D: usize>(&self, coarse: &Mesh, field: &[[f64; D]]) -> Vec<[f64; D]> {
        let value = |place: &CoarsePoint| {
            let mut value = [0.0; D];
            for (node, weight) in coarse.cell(place.element).iter().zip(&place.weight) {
                (0..D).for_each(|c| value[c] += weight * field[node.index()][c]);
            }
            value
        };
        self.places.iter().map(value).collect()
    }

    /// The coarse element at the centroid of each fine one.
    pub(super) fn elements(&self) -> &[ElementId] {
        &self.elements
    }
}

/// Each node, moved a little towards the mean of the centroids around it, and an element at it.
fn inner_points(mesh: &Mesh) -> Vec<(Vector, usize)> {
    // Sum of the centroids, their number, the last element.
    let mut around = vec![([0.0; 3], 0.0, 0); mesh.node_count()];
    for (e, cell) in mesh.cells().enumerate() {
        let centroid = mesh.centroid(ElementId::new(e));
        for node in cell {
            let (sum, count, element) = &mut around[node.index()];
            (0..3).for_each(|c| sum[c] += centroid[c]);
            (*count, *element) = (*count + 1.0, e);
        }
    }
    let moved = |(point, (sum, count, element)): (Vector, (Vector, f64, usize))| {
        (std::array::from_fn(|c| point[c] + INWARDS * (sum[c] / count - point[c])), element)
    };
    mesh.places().zip(around).map(moved).collect()
}

/// For each body of the fine mesh the coarse one; each has one.
fn matching(locators: &[Locator<'_>], fine: &Mesh) -> Result<Vec<usize>, ReferenceError> {
    let matched = Locator::matching(locators, fine);
    let once = (0..locators.len()).all(|coarse| matched.iter().filter(|&&found| found == coarse).count() == 1);
    if once { Ok(matched) } else { Err(ReferenceError::OtherBodies { fine: fine.parts(), coarse: locators.len() }) }
}

fn same_volume(coarse: &Mesh, fine: &Mesh, tolerance: f64) -> Result<(), ReferenceError> {
    let (whole, parts) = (measure(coarse), measure(fine));
    let differ = (whole - parts).abs() > tolerance * whole;
    if differ { Err(ReferenceError::DifferentBodies { fine: parts, coarse: whole }) } else { Ok(()) }
}

/// Length or area of a mesh.
fn measure(mesh: &Mesh) -> f64 {
    mesh.volumes().iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn linear(p: &[f64; 2]) -> [f64; 2] {
        [1.0 + 2.0 * p[0] - p[1], 0.5 * p[0] + p[1]]
    }

    /// A linear field is the same at the nodes of both meshes, nested or not, inside or outside, to rounding of values
    /// below 4.
    #[test]
    fn linear_fields_are_transferred_exactly() {
        let rectangle = |n| Mesh::rectangle(1.0, 0.4, n, n).unwrap();
        let disc = |rings| Mesh::disc(0.5, rings).unwrap();
        let nested = Transfer::nested(&rectangle(5), &rectangle(20)).unwrap();
        let located = Transfer::located(&rectangle(5), &rectangle(13)).unwrap();
        let outside = Transfer::located(&disc(3), &disc(8)).unwrap();
        for (transfer, coarse, fine) in
            [(nested, rectangle(5), rectangle(20)), (located, rectangle(5), rectangle(13)), (outside, disc(3), disc(8))]
        {
            let nodal: Vec<_> = coarse.points_in().iter().map(linear).collect();
            for (value, point) in transfer.at_nodes(&coarse, &nodal).iter().zip(fine.points_in()) {
                let exact = linear(point);
                assert!((0..2).all(|c| (value[c] - exact[c]).abs() < 1e-14), "{value:?} at {point:?}");
            }
        }
    }

    /// Of bodies that touch, each fine one finds its own coarse one, in any order, also where a curve crosses the
    /// interface.
    #[test]
    fn bodies_find_themselves() {
        let block = |y: f64, n| Mesh::rectangle(1.0, 0.4, n, n).unwrap().placed(&[-0.5, y, 0.0], 0.0).unwrap();
        let disc = |rings| Mesh::disc(0.5, rings).unwrap();
        let coarse = Mesh::joined(&[("block", &block(-0.9, 4)), ("disc", &disc(3))]).unwrap();
        let fine = Mesh::joined(&[("disc", &disc(10)), ("block", &block(-0.9, 9))]).unwrap();
        let transfer = Transfer::located(&coarse, &fine).unwrap();
        let (of_coarse, of_fine) = (coarse.part_of_elements(), fine.part_of_elements());
        assert!(transfer.elements().iter().zip(&of_fine).all(|(e, body)| of_coarse[e.index()] == 1 - body));
        // The nodes of the disc at (0, −½) and of the block below it.
        let body_of_node = fine.part_numbers();
        assert!(transfer.places.iter().zip(body_of_node).all(|(p, body)| of_coarse[p.element.index()] == 1 - body));
        let apart = Mesh::joined(&[("disc", &disc(3)), ("block", &block(-5.0, 4))]).unwrap();
        let refused = Transfer::located(&apart, &fine).unwrap_err();
        assert!(matches!(refused, ReferenceError::OtherBodies { .. } | ReferenceError::Outside { .. }), "{refused:?}");
    }

    #[test]
    fn meshes_that_are_not_nested_are_refused() {
        let coarse = Mesh::rectangle(1.0, 1.0, 3, 3).unwrap();
        let other = Mesh::rectangle(1.0, 1.0, 4, 4).unwrap();
        assert!(matches!(Transfer::nested(&coarse, &other), Err(ReferenceError::NotNested { .. })));
        let larger = Mesh::rectangle(2.0, 1.0, 12, 6).unwrap();
        assert!(matches!(Transfer::nested(&coarse, &larger), Err(ReferenceError::NotNested { .. })));
        let (bar, part) = (Mesh::uniform_bar(2.0, 4).unwrap(), Mesh::uniform_bar(1.0, 8).unwrap());
        assert!(matches!(Transfer::nested(&bar, &part), Err(ReferenceError::DifferentBodies { .. })));
    }

    #[test]
    fn other_bodies_are_refused() {
        let coarse = Mesh::rectangle(1.0, 1.0, 8, 8).unwrap();
        let slender = Mesh::rectangle(2.0, 0.5, 8, 8).unwrap();
        assert!(matches!(Transfer::located(&coarse, &slender), Err(ReferenceError::Outside { .. })));
        let larger = Mesh::rectangle(1.06, 1.0, 8, 8).unwrap();
        assert!(matches!(Transfer::located(&coarse, &larger), Err(ReferenceError::DifferentBodies { .. })));
    }
}
