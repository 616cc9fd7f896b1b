//! The element that a point lies in.

use super::Mesh;
use crate::ids::ElementId;

/// How far outside an element, in barycentric coordinates, a point of it may lie by rounding: coordinates are good to
/// 1e-16 of the body's size, which is at most some 1e6 elements across.
const OUTSIDE: f64 = 1e-9;

/// Finds the elements of a mesh that points lie in.
///
/// The elements are sorted into about as many equal bins: a search looks at a few of them.
#[derive(Clone, Debug)]
pub struct Locator<'m, const D: usize, const N: usize> {
    mesh: &'m Mesh<D, N>,
    low: [f64; D],
    /// Bins per length (1/m).
    scale: [f64; D],
    counts: [usize; D],
    bins: Vec<Vec<ElementId>>,
}

impl<'m, const D: usize, const N: usize> Locator<'m, D, N> {
    /// Sorts the elements of a mesh.
    #[must_use]
    pub fn new(mesh: &'m Mesh<D, N>) -> Self {
        Self::of(mesh, &(0..mesh.element_count()).map(ElementId::new).collect::<Vec<_>>())
    }

    /// Sorts some elements of a mesh, such as those of one body; it finds no others.
    #[must_use]
    pub fn of(mesh: &'m Mesh<D, N>, elements: &[ElementId]) -> Self {
        let (low, high) = bounds(elements.iter().flat_map(|&e| mesh.cell_points(e)));
        let per_side = (elements.len() as f64).powf(1.0 / D as f64).ceil().max(1.0);
        let scale = std::array::from_fn(|c| per_side / (high[c] - low[c]));
        let counts = [per_side as usize; D];
        let mut locator = Self { mesh, low, scale, counts, bins: vec![Vec::new(); counts.iter().product()] };
        for &e in elements {
            let (low, high) = bounds(mesh.cell_points(e));
            let (first, last) = (locator.bin_at(&low), locator.bin_at(&high));
            for at in boxed(first, last) {
                let bin = locator.bin(&at);
                locator.bins[bin].push(e);
            }
        }
        locator
    }

    /// One for each body of a mesh, in their order.
    #[must_use]
    pub fn of_bodies(mesh: &'m Mesh<D, N>) -> Vec<Self> {
        let mut elements = vec![Vec::new(); mesh.parts()];
        for (e, body) in mesh.part_of_elements().into_iter().enumerate() {
            elements[body].push(ElementId::new(e));
        }
        elements.iter().map(|elements| Self::of(mesh, elements)).collect()
    }

    /// For each body of another mesh the one of these that has most of its elements: at a curved interface some lie in
    /// the other body.
    #[must_use]
    pub fn matching(bodies: &[Self], other: &Mesh<D, N>) -> Vec<usize> {
        let mut within = vec![vec![0_usize; bodies.len()]; other.parts()];
        for (e, body) in other.part_of_elements().into_iter().enumerate() {
            let centroid = other.centroid(ElementId::new(e));
            let found = bodies.iter().position(|locator| locator.element_at(&centroid).is_some());
            found.into_iter().for_each(|found| within[body][found] += 1);
        }
        let most = |counts: &Vec<usize>| (0..counts.len()).max_by_key(|&body| counts[body]).unwrap_or(0);
        within.iter().map(most).collect()
    }

    /// The mesh.
    #[must_use]
    pub fn mesh(&self) -> &'m Mesh<D, N> {
        self.mesh
    }

    /// The element that holds a point: of those of its bin, the one that it is deepest in. None outside the mesh.
    #[must_use]
    pub fn element_at(&self, point: &[f64; D]) -> Option<ElementId> {
        let at = self.bin_at(point);
        self.deepest(point, [at, at]).filter(|(_, depth)| *depth >= -OUTSIDE).map(|(element, _)| element)
    }

    /// The element that holds a point, or one of the nearest ones if the point is outside the mesh.
    #[must_use]
    pub fn element_near(&self, point: &[f64; D]) -> ElementId {
        let at = self.bin_at(point);
        let most = self.counts.iter().copied().max().unwrap_or(1);
        let around = |reach: usize| {
            let first = at.map(|bin| bin.saturating_sub(reach));
            let last = std::array::from_fn(|c| (at[c] + reach).min(self.counts[c] - 1));
            self.deepest(point, [first, last])
        };
        // The bins beside the first one that has elements may have nearer ones.
        let reach = (0..=most).find(|&reach| around(reach).is_some()).unwrap_or(most);
        let inside = around(reach).filter(|(_, depth)| *depth >= -OUTSIDE);
        inside.or_else(|| around(reach + 1)).map_or(ElementId::new(0), |(element, _)| element)
    }

    /// φ_i of the nodes of an element at a point.
    #[must_use]
    pub fn weights(&self, element: ElementId, point: &[f64; D]) -> [f64; N] {
        let geometry = self.mesh.cell_geometry(element);
        let origin = self.mesh.points()[self.mesh.cells()[element.index()][0].index()];
        let mut weights = [0.0; N];
        weights[0] = 1.0;
        for (weight, gradient) in weights.iter_mut().zip(&geometry.gradients) {
            *weight += (0..D).map(|c| gradient[c] * (point[c] - origin[c])).sum::<f64>();
        }
        weights
    }

    /// A nodal field, linear in each element, at points of the mesh; outside it, as in the nearest element.
    #[must_use]
    pub fn values_at(&self, nodal: &[[f64; D]], points: &[[f64; D]]) -> Vec<[f64; D]> {
        let value = |point: &[f64; D]| {
            let element = self.element_near(point);
            let nodes = self.mesh.cells()[element.index()];
            let weights = self.weights(element, point);
            std::array::from_fn(|c| nodes.iter().zip(&weights).map(|(node, w)| w * nodal[node.index()][c]).sum())
        };
        points.iter().map(value).collect()
    }

    /// The element of a box of bins that a point is deepest in, and the least of its barycentric coordinates there.
    fn deepest(&self, point: &[f64; D], [first, last]: [[usize; D]; 2]) -> Option<(ElementId, f64)> {
        let depth = |e: ElementId| self.weights(e, point).into_iter().fold(f64::INFINITY, f64::min);
        let elements = boxed(first, last).flat_map(|at| &self.bins[self.bin(&at)]);
        elements.map(|&e| (e, depth(e))).max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The bin a point lies in, along each axis.
    fn bin_at(&self, point: &[f64; D]) -> [usize; D] {
        // A float below zero becomes 0.
        std::array::from_fn(|c| (((point[c] - self.low[c]) * self.scale[c]) as usize).min(self.counts[c] - 1))
    }

    fn bin(&self, at: &[usize; D]) -> usize {
        (0..D).rev().fold(0, |index, c| index * self.counts[c] + at[c])
    }
}

/// All bins from one to another.
fn boxed<const D: usize>(first: [usize; D], last: [usize; D]) -> impl Iterator<Item = [usize; D]> {
    let next = move |at: &[usize; D]| {
        let c = (0..D).find(|&c| at[c] < last[c])?;
        let mut at = *at;
        at[c] += 1;
        at[..c].copy_from_slice(&first[..c]);
        Some(at)
    };
    std::iter::successors(Some(first), next)
}

/// The box that encloses points.
fn bounds<const D: usize>(points: impl IntoIterator<Item = [f64; D]>) -> ([f64; D], [f64; D]) {
    let start = ([f64::INFINITY; D], [f64::NEG_INFINITY; D]);
    points.into_iter().fold(start, |(low, high), p| {
        (std::array::from_fn(|c| low[c].min(p[c])), std::array::from_fn(|c| high[c].max(p[c])))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{BarMesh, TriangleMesh};

    /// A linear field has its value at each point, inside and outside, to rounding of values below 8.
    #[test]
    fn linear_fields_are_exact_at_all_points() {
        let disc = TriangleMesh::disc(1.0, 4).unwrap();
        let field = |p: &[f64; 2]| [1.0 + 2.0 * p[0] - p[1], 0.5 * p[0] + p[1]];
        let nodal: Vec<_> = disc.points().iter().map(field).collect();
        let points: Vec<[f64; 2]> =
            (0..400).map(|k| [-1.5 + 0.15 * f64::from(k % 20), -1.5 + 0.15 * f64::from(k / 20)]).collect();
        let locator = Locator::new(&disc);
        for (value, point) in locator.values_at(&nodal, &points).iter().zip(&points) {
            let exact = field(point);
            assert!((0..2).all(|c| (value[c] - exact[c]).abs() < 1e-13), "{value:?} at {point:?}");
        }
    }

    /// Centroids lie in their elements, and points outside near one of the boundary.
    #[test]
    fn points_are_found_in_their_elements() {
        let mesh = TriangleMesh::rectangle(2.0, 1.0, 7, 5).unwrap().refined_where(|e| e.index() % 9 == 0).unwrap();
        let locator = Locator::new(&mesh);
        for e in (0..mesh.element_count()).map(ElementId::new) {
            let centroid = mesh.centroid(e);
            assert_eq!((locator.element_at(&centroid), locator.element_near(&centroid)), (Some(e), e));
        }
        assert_eq!(locator.element_at(&[2.1, 0.5]), None);
        let near = mesh.cell_points(locator.element_near(&[2.1, 0.5]));
        assert!(near.iter().any(|p| p[0] == 2.0 && (p[1] - 0.5).abs() < 0.25), "{near:?}");
        let bar = BarMesh::uniform_bar(1.0, 4).unwrap();
        assert_eq!(Locator::new(&bar).element_near(&[1.7]).index(), 3);
    }
}
