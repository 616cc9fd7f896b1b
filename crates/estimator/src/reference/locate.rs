//! Where the nodes of a fine mesh lie in a coarse one.

use super::ReferenceError;
use percute_core::ids::ElementId;
use percute_core::mesh::Mesh;

/// How far outside an element, in barycentric coordinates, a node may lie by rounding: coordinates
/// are good to 1e-16 of the body's size, which is at most some 1e6 elements across.
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
        let grid = Grid::new(coarse);
        let mut places = vec![None; fine.node_count()];
        for e in (0..fine.element_count()).map(ElementId::new) {
            let points = fine.cell_points(e);
            let not_nested = || ReferenceError::NotNested { fine: e.index() };
            let centroid = std::array::from_fn(|c| points.iter().map(|p| p[c]).sum::<f64>() / N as f64);
            let element = grid.element_at(coarse, &centroid).ok_or_else(not_nested)?;
            for (node, point) in fine.cells()[e.index()].iter().zip(&points) {
                let weight = barycentric(coarse, element, point);
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

/// φ_i at a point, from its distance to the first corner.
fn barycentric<const D: usize, const N: usize>(mesh: &Mesh<D, N>, element: ElementId, point: &[f64; D]) -> [f64; N] {
    let geometry = mesh.cell_geometry(element);
    let origin = mesh.points()[mesh.cells()[element.index()][0].index()];
    let mut weight = [0.0; N];
    weight[0] = 1.0;
    for (w, gradient) in weight.iter_mut().zip(&geometry.gradients) {
        *w += (0..D).map(|c| gradient[c] * (point[c] - origin[c])).sum::<f64>();
    }
    weight
}

/// The elements of a mesh, sorted into about as many equal bins: a search looks at a few of them.
struct Grid<const D: usize> {
    low: [f64; D],
    /// Bins per length (1/m).
    scale: [f64; D],
    counts: [usize; D],
    bins: Vec<Vec<ElementId>>,
}

impl<const D: usize> Grid<D> {
    fn new<const N: usize>(mesh: &Mesh<D, N>) -> Self {
        let (low, high) = bounds(mesh.points());
        let per_side = (mesh.element_count() as f64).powf(1.0 / D as f64).ceil().max(1.0);
        let scale = std::array::from_fn(|c| per_side / (high[c] - low[c]));
        let counts = [per_side as usize; D];
        let mut grid = Self { low, scale, counts, bins: vec![Vec::new(); counts.iter().product()] };
        for e in (0..mesh.element_count()).map(ElementId::new) {
            let (low, high) = bounds(&mesh.cell_points(e));
            let (first, last) = (grid.cell(&low), grid.cell(&high));
            let mut at = first;
            loop {
                let bin = grid.bin(&at);
                grid.bins[bin].push(e);
                // Odometer over the box of bins.
                let Some(c) = (0..D).find(|&c| at[c] < last[c]) else { break };
                at[c] += 1;
                at[..c].copy_from_slice(&first[..c]);
            }
        }
        grid
    }

    /// The bin a point lies in, along each axis.
    fn cell(&self, point: &[f64; D]) -> [usize; D] {
        // A float below zero becomes 0.
        std::array::from_fn(|c| (((point[c] - self.low[c]) * self.scale[c]) as usize).min(self.counts[c] - 1))
    }

    fn bin(&self, cell: &[usize; D]) -> usize {
        (0..D).rev().fold(0, |index, c| index * self.counts[c] + cell[c])
    }

    /// The element that holds a point: of those of its bin, the one it is deepest in.
    fn element_at<const N: usize>(&self, mesh: &Mesh<D, N>, point: &[f64; D]) -> Option<ElementId> {
        let depth = |e: ElementId| barycentric(mesh, e, point).into_iter().fold(f64::INFINITY, f64::min);
        let each = self.bins[self.bin(&self.cell(point))].iter().map(|&e| (e, depth(e)));
        each.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|best| best.1 >= -OUTSIDE).map(|best| best.0)
    }
}

/// The box that encloses points.
fn bounds<const D: usize>(points: &[[f64; D]]) -> ([f64; D], [f64; D]) {
    let start = ([f64::INFINITY; D], [f64::NEG_INFINITY; D]);
    points.iter().fold(start, |(low, high), p| {
        (std::array::from_fn(|c| low[c].min(p[c])), std::array::from_fn(|c| high[c].max(p[c])))
    })
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
