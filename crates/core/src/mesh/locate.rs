//! The element that a point lies in.

use super::{Mesh, in_kind};
use crate::border::{Vector, row};
use crate::ids::ElementId;

/// How far outside an element, in barycentric coordinates, a point of it may lie by rounding: coordinates are good to
/// 1e-16 of the body's size, which is at most some 1e6 elements across.
const OUTSIDE: f64 = 1e-9;

/// Most nodes of an element.
pub const MOST_NODES: usize = 4;

/// Barycentric coordinates of a point in an element; 0 beyond its nodes.
pub type Weights = [f64; MOST_NODES];

/// Finds the elements of a mesh that points lie in.
///
/// The elements are sorted into about as many equal bins: a search looks at a few of them.
#[derive(Clone, Debug)]
pub struct Locator<'m> {
    mesh: &'m Mesh,
    low: Vector,
    /// Bins per length (1/m).
    scale: Vector,
    counts: [usize; 3],
    bins: Vec<Vec<ElementId>>,
}

impl<'m> Locator<'m> {
    /// Sorts the elements of a mesh.
    #[must_use]
    pub fn new(mesh: &'m Mesh) -> Self {
        Self::of(mesh, &(0..mesh.element_count()).map(ElementId::new).collect::<Vec<_>>())
    }

    /// Sorts some elements of a mesh, such as those of one body; it finds no others.
    #[must_use]
    pub fn of(mesh: &'m Mesh, elements: &[ElementId]) -> Self {
        let [low, high] = bounds(elements.iter().flat_map(|&e| mesh.cell(e)).map(|&node| mesh.point(node)));
        let dimension = mesh.dimension();
        let per_side = (elements.len() as f64).powf(1.0 / dimension as f64).ceil().max(1.0);
        let scale = std::array::from_fn(|c| if c < dimension { per_side / (high[c] - low[c]) } else { 0.0 });
        let counts = std::array::from_fn(|c| if c < dimension { per_side as usize } else { 1 });
        let mut locator = Self { mesh, low, scale, counts, bins: vec![Vec::new(); counts.iter().product()] };
        for &e in elements {
            let [low, high] = bounds(mesh.cell(e).iter().map(|&node| mesh.point(node)));
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
    pub fn of_bodies(mesh: &'m Mesh) -> Vec<Self> {
        let mut elements = vec![Vec::new(); mesh.parts()];
        for (e, body) in mesh.part_of_elements().into_iter().enumerate() {
            elements[body].push(ElementId::new(e));
        }
        elements.iter().map(|elements| Self::of(mesh, elements)).collect()
    }

    /// For each body of another mesh the one of these that has most of its elements: at a curved interface some lie in
    /// the other body.
    #[must_use]
    pub fn matching(bodies: &[Self], other: &Mesh) -> Vec<usize> {
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
    pub fn mesh(&self) -> &'m Mesh {
        self.mesh
    }

    /// The element that holds a point: of those of its bin, the one that it is deepest in. None outside the mesh.
    #[must_use]
    pub fn element_at(&self, point: &Vector) -> Option<ElementId> {
        let at = self.bin_at(point);
        self.deepest(point, [at, at]).filter(|(_, depth)| *depth >= -OUTSIDE).map(|(element, _)| element)
    }

    /// The element that holds a point, or one of the nearest ones if the point is outside the mesh.
    #[must_use]
    pub fn element_near(&self, point: &Vector) -> ElementId {
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
    pub fn weights(&self, element: ElementId, point: &Vector) -> Weights {
        in_kind!(self.mesh, D, N => {
            let geometry = self.mesh.geometry::<D, N>(element);
            let origin = self.mesh.points_in::<D>()[self.mesh.cell(element)[0].index()];
            let mut weights = [0.0; MOST_NODES];
            weights[0] = 1.0;
            for (weight, gradient) in weights.iter_mut().zip(&geometry.gradients) {
                *weight += (0..D).map(|c| gradient[c] * (point[c] - origin[c])).sum::<f64>();
            }
            weights
        })
    }

    /// The field, linear in the elements, at points, from its values at the nodes; all in rows. Points outside have the
    /// values that the field of the nearest element has there.
    #[must_use]
    pub fn values_at(&self, nodal: &[f64], points: &[f64]) -> Vec<f64> {
        let dimension = self.mesh.dimension();
        let value = |point: &[f64]| {
            let point = row(point, 0, dimension);
            let element = self.element_near(&point);
            let (nodes, weights) = (self.mesh.cell(element), self.weights(element, &point));
            let component = move |c: usize| {
                nodes.iter().zip(&weights).map(|(node, w)| w * nodal[dimension * node.index() + c]).sum::<f64>()
            };
            (0..dimension).map(component)
        };
        points.chunks_exact(dimension).flat_map(value).collect()
    }

    /// The element of a box of bins that a point is deepest in, and the least of its barycentric coordinates there.
    fn deepest(&self, point: &Vector, [first, last]: [[usize; 3]; 2]) -> Option<(ElementId, f64)> {
        let count = self.mesh.nodes_of_element();
        let depth = |e: ElementId| self.weights(e, point)[..count].iter().copied().fold(f64::INFINITY, f64::min);
        let elements = boxed(first, last).flat_map(|at| &self.bins[self.bin(&at)]);
        elements.map(|&e| (e, depth(e))).max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The bin a point lies in, along each axis.
    fn bin_at(&self, point: &Vector) -> [usize; 3] {
        // A float below zero becomes 0.
        std::array::from_fn(|c| (((point[c] - self.low[c]) * self.scale[c]) as usize).min(self.counts[c] - 1))
    }

    fn bin(&self, at: &[usize; 3]) -> usize {
        (0..3).rev().fold(0, |index, c| index * self.counts[c] + at[c])
    }
}

/// All bins from one to another.
fn boxed(first: [usize; 3], last: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    let next = move |at: &[usize; 3]| {
        let c = (0..3).find(|&c| at[c] < last[c])?;
        let mut at = *at;
        at[c] += 1;
        at[..c].copy_from_slice(&first[..c]);
        Some(at)
    };
    std::iter::successors(Some(first), next)
}

/// The box that encloses points.
fn bounds(points: impl IntoIterator<Item = Vector>) -> [Vector; 2] {
    let start = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    points.into_iter().fold(start, |[low, high], p| {
        [std::array::from_fn(|c| low[c].min(p[c])), std::array::from_fn(|c| high[c].max(p[c]))]
    })
}

impl Mesh {
    /// The part of this mesh that each part of another mesh of the same bodies is. None for a mesh of another
    /// dimension.
    #[must_use]
    pub fn matching_parts(&self, other: &Self) -> Option<Vec<usize>> {
        (self.dimension() == other.dimension()).then(|| Locator::matching(&Locator::of_bodies(self), other))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A linear field has its value at each point, inside and outside, to rounding of values below 8.
    #[test]
    fn linear_fields_are_exact_at_all_points() {
        let disc = Mesh::disc(1.0, 4).unwrap();
        let field = |p: &[f64; 2]| [1.0 + 2.0 * p[0] - p[1], 0.5 * p[0] + p[1]];
        let nodal: Vec<f64> = disc.points_in().iter().flat_map(field).collect();
        let points: Vec<[f64; 2]> =
            (0..400).map(|k| [-1.5 + 0.15 * f64::from(k % 20), -1.5 + 0.15 * f64::from(k / 20)]).collect();
        let locator = Locator::new(&disc);
        for (value, point) in locator.values_at(&nodal, points.as_flattened()).as_chunks::<2>().0.iter().zip(&points) {
            let exact = field(point);
            assert!((0..2).all(|c| (value[c] - exact[c]).abs() < 1e-13), "{value:?} at {point:?}");
        }
    }

    /// Centroids lie in their elements, and points outside near one of the boundary.
    #[test]
    fn points_are_found_in_their_elements() {
        let mesh = Mesh::rectangle(2.0, 1.0, 7, 5).unwrap().refined_where(|e| e.index() % 9 == 0).unwrap();
        let locator = Locator::new(&mesh);
        for e in (0..mesh.element_count()).map(ElementId::new) {
            let centroid = mesh.centroid(e);
            assert_eq!((locator.element_at(&centroid), locator.element_near(&centroid)), (Some(e), e));
        }
        assert_eq!(locator.element_at(&[2.1, 0.5, 0.0]), None);
        let near = mesh.corners::<2, 3>(locator.element_near(&[2.1, 0.5, 0.0]));
        assert!(near.iter().any(|p| p[0] == 2.0 && (p[1] - 0.5).abs() < 0.25), "{near:?}");
        let bar = Mesh::uniform_bar(1.0, 4).unwrap();
        assert_eq!(Locator::new(&bar).element_near(&[1.7, 0.0, 0.0]).index(), 3);
    }
}
