//! Where the nodes of a fine mesh lie in a coarse one.

use super::ReferenceError;
use percute_core::ids::ElementId;
use percute_core::mesh::{Locator, Mesh};

/// How far outside an element, in barycentric coordinates, a node may lie by rounding; as in [`Locator`].
const OUTSIDE: f64 = 1e-9;
/// Volumes of the two bodies agree to this, relative: rounding of sums over 1e6 elements.
const SAME_BODY: f64 = 1e-9;

/// The element of the coarse mesh that a fine node lies in, and its barycentric coordinates there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place<const N: usize> {
    element: ElementId,
    weight: [f64; N],
}

/// Evaluates P1 fields of a coarse mesh at the nodes of a fine one.
#[derive(Clone, Debug)]
pub(super) struct Transfer<const D: usize, const N: usize> {
    places: Vec<Place<N>>,
}

impl<const D: usize, const N: usize> Transfer<D, N> {
    /// Places every fine node; each fine element must lie in one coarse element, so that the
    /// coarse field is linear on it.
    pub(super) fn new(coarse: &Mesh<D, N>, fine: &Mesh<D, N>) -> Result<Self, ReferenceError> {
        let locator = Locator::new(coarse);
        let mut places = vec![None; fine.node_count()];
        for e in (0..fine.element_count()).map(ElementId::new) {
            let points = fine.cell_points(e);
            let not_nested = || ReferenceError::NotNested { fine: e.index() };
            let centroid = std::array::from_fn(|c| points.iter().map(|p| p[c]).sum::<f64>() / N as f64);
            let element = locator.element_at(&centroid).ok_or_else(not_nested)?;
            for (node, point) in fine.cells()[e.index()].iter().zip(&points) {
                let weight = locator.weights(element, point);
                if weight.iter().any(|w| *w < -OUTSIDE) {
                    return Err(not_nested());
                }
                places[node.index()] = Some(Place { element, weight });
            }
        }
        let (whole, parts) = (measure(coarse), measure(fine));
        if (whole - parts).abs() > SAME_BODY * whole {
            return Err(ReferenceError::DifferentBodies { fine: parts, coarse: whole });
        }
        // Meshes have no nodes without elements, so that none is left out.
        Ok(Self { places: places.into_iter().flatten().collect() })
    }

    /// The coarse field at each fine node.
    pub(super) fn apply(&self, coarse: &Mesh<D, N>, field: &[[f64; D]]) -> Vec<[f64; D]> {
        let value = |place: &Place<N>| {
            let mut value = [0.0; D];
            for (node, weight) in coarse.cells()[place.element.index()].iter().zip(&place.weight) {
                (0..D).for_each(|c| value[c] += weight * field[node.index()][c]);
            }
            value
        };
        self.places.iter().map(value).collect()
    }
}

/// Length or area of a mesh.
fn measure<const D: usize, const N: usize>(mesh: &Mesh<D, N>) -> f64 {
    (0..mesh.element_count()).map(|e| mesh.cell_geometry(ElementId::new(e)).volume).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::mesh::{BarMesh, TriangleMesh};

    /// A linear field is the same at the nodes of both meshes, to rounding of values below 4.
    #[test]
    fn linear_fields_are_transferred_exactly() {
        let coarse = TriangleMesh::rectangle(1.0, 0.4, 5, 3).unwrap();
        let fine = TriangleMesh::rectangle(1.0, 0.4, 20, 12).unwrap();
        let field = |p: &[f64; 2]| [1.0 + 2.0 * p[0] - p[1], 0.5 * p[0] + p[1]];
        let nodal: Vec<_> = coarse.points().iter().map(field).collect();
        let values = Transfer::new(&coarse, &fine).unwrap().apply(&coarse, &nodal);
        for (value, point) in values.iter().zip(fine.points()) {
            let exact = field(point);
            assert!((0..2).all(|c| (value[c] - exact[c]).abs() < 1e-14), "{value:?} at {point:?}");
        }
    }

    #[test]
    fn meshes_that_are_not_nested_are_refused() {
        let coarse = TriangleMesh::rectangle(1.0, 1.0, 3, 3).unwrap();
        let other = TriangleMesh::rectangle(1.0, 1.0, 4, 4).unwrap();
        assert!(matches!(Transfer::new(&coarse, &other), Err(ReferenceError::NotNested { .. })));
        let larger = TriangleMesh::rectangle(2.0, 1.0, 12, 6).unwrap();
        assert!(matches!(Transfer::new(&coarse, &larger), Err(ReferenceError::NotNested { .. })));
        let (bar, part) = (BarMesh::uniform_bar(2.0, 4).unwrap(), BarMesh::uniform_bar(1.0, 8).unwrap());
        assert!(matches!(Transfer::new(&bar, &part), Err(ReferenceError::DifferentBodies { .. })));
    }
}
