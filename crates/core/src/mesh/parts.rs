//! The separate parts of a mesh, which must be apart.
//!
//! Elements that share a node belong to one part. Parts may touch, but not overlap.

use super::check::DUPLICATE;
use super::topology::Faces;
use super::{Mesh, MeshError, in_kind};
use crate::cell::{Cell, cell};
use crate::ids::{ElementId, NodeId};
use std::cmp::Ordering;
use std::collections::HashMap;

/// Parts that overlap by less than this part of the size of the mesh touch: rounding of places.
const OVERLAP: f64 = 1e-12;

/// Counts the parts, and finds all pairs of elements of different ones that touch in a mesh of this size (m): they are
/// nearer than nodes that are one. `part` has the first node of the part of each node.
///
/// # Errors
/// Parts that overlap.
pub(super) fn separate<const D: usize, const N: usize>(
    kind: &dyn Cell<D, N>,
    (points, part): (&[[f64; D]], &[NodeId]),
    cells: &[[NodeId; N]],
    faces: &Faces,
    size: f64,
) -> Result<(usize, Vec<[ElementId; 2]>), MeshError> {
    let tolerance = DUPLICATE * size;
    let mut touching = Vec::new();
    let count = part.iter().enumerate().filter(|&(node, &root)| node == root.index()).count();
    if count > 1 {
        let part_of = |e: ElementId| part[cells[e.index()][0].index()];
        let corners = |e: ElementId| cells[e.index()].map(|node| points[node.index()]);
        let grid = Grid::new(points[0], (0..cells.len()).map(|e| corners(ElementId::new(e))), tolerance);
        let nearer = |a: ElementId, b: ElementId, by: f64| meet(kind, &corners(a), &corners(b), by);
        let meeting = |a: ElementId, b: ElementId| {
            nearer(a, b, tolerance)
                .then(|| if nearer(a, b, -OVERLAP * size) { Meeting::Overlaps } else { Meeting::Touches })
        };
        touching = touches(grid, cells.len(), faces, part_of, corners, meeting)?;
    }
    Ok((count, touching))
}

/// For each node the first node of its part.
pub(super) fn part_of_nodes<const N: usize>(node_count: usize, cells: &[[NodeId; N]]) -> Vec<NodeId> {
    let mut parent: Vec<NodeId> = (0..node_count).map(NodeId::new).collect();
    for cell in cells {
        for pair in cell.windows(2) {
            let (a, b) = (root(&mut parent, pair[0]), root(&mut parent, pair[1]));
            parent[a.max(b).index()] = a.min(b);
        }
    }
    for node in 0..node_count {
        parent[node] = root(&mut parent, NodeId::new(node));
    }
    parent
}

/// Follows the parents to the root, and halves the path for later searches.
fn root(parent: &mut [NodeId], mut node: NodeId) -> NodeId {
    while parent[node.index()] != node {
        let above = parent[parent[node.index()].index()];
        parent[node.index()] = above;
        node = above;
    }
    node
}

/// A smaller part of the volume of an element is rounding.
const AT_FACE: f64 = 1e-9;

impl Mesh {
    /// Two elements of different parts that overlap if each node is displaced so far (m).
    pub(crate) fn overlap_after(&self, displacement: &[f64]) -> Option<[ElementId; 2]> {
        let (points, part) = (self.displaced(displacement), self.part_of_nodes());
        let (faces, size) = (&self.faces, self.size);
        let separated = in_kind!(self, D, N => {
            separate(cell::<D, N>(), (points.as_chunks().0, &part), self.nodes_of::<N>(), faces, size)
        });
        match separated {
            Err(MeshError::PartsTouch { elements }) => Some(elements.map(ElementId::new)),
            _ => None,
        }
    }

    /// Whether a node is in an element of another part if each node is displaced so far (m).
    pub(crate) fn encloses_after(&self, displacement: &[f64], node: NodeId) -> bool {
        let (points, part) = (self.displaced(displacement), self.part_of_nodes());
        in_kind!(self, D, N => {
            let points: &[[f64; D]] = points.as_chunks().0;
            let others = self.nodes_of::<N>().iter().filter(|cell| part[cell[0].index()] != part[node.index()]);
            others.map(|cell| cell.map(|corner| points[corner.index()])).any(|corners| {
                let least = -AT_FACE * cell::<D, N>().signed_volume(&corners).abs();
                cell::<D, N>().encloses(&corners, &points[node.index()], least)
            })
        })
    }

    fn displaced(&self, displacement: &[f64]) -> Vec<f64> {
        self.points.iter().zip(displacement).map(|(point, by)| point + by).collect()
    }
}

/// How two elements meet.
#[derive(Clone, Copy, PartialEq)]
enum Meeting {
    Touches,
    Overlaps,
}

/// Where parts meet, an element at the boundary of one of them meets an element of the other: only
/// cells of the grid with elements at the boundary are kept, far fewer than there are elements.
fn touches<const D: usize, const N: usize>(
    mut grid: Grid<D>,
    element_count: usize,
    faces: &Faces,
    part_of: impl Fn(ElementId) -> NodeId,
    corners: impl Fn(ElementId) -> [[f64; D]; N],
    meeting: impl Fn(ElementId, ElementId) -> Option<Meeting>,
) -> Result<Vec<[ElementId; 2]>, MeshError> {
    let mut touching = Vec::new();
    let mut outer = vec![false; element_count];
    for (owner, _) in faces.sides.iter().filter(|(_, neighbour)| neighbour.is_none()) {
        outer[owner.index()] = true;
    }
    for at_boundary in [true, false] {
        for element in (0..element_count).filter(|&e| outer[e] == at_boundary).map(ElementId::new) {
            for key in grid.keys(&corners(element)) {
                if at_boundary {
                    grid.cells.entry(key).or_default();
                }
                let Some(there) = grid.cells.get_mut(&key) else { continue };
                for &other in there.iter().filter(|&&other| part_of(other) != part_of(element)) {
                    let pair = [element.min(other), element.max(other)];
                    match meeting(element, other) {
                        None => {}
                        Some(Meeting::Touches) => touching.push(pair),
                        Some(Meeting::Overlaps) => {
                            return Err(MeshError::PartsTouch { elements: pair.map(ElementId::index) });
                        }
                    }
                }
                there.push(element);
            }
        }
    }
    // Two elements may meet in several cells of the grid.
    touching.sort_unstable();
    touching.dedup();
    Ok(touching)
}

/// Elements by place, in cells of the elements' root mean square extent: an element of extent d lies
/// in at most (d/spacing + 2)ᴰ cells, so that all together lie in a bounded number of cells each.
struct Grid<const D: usize> {
    origin: [f64; D],
    spacing: f64,
    margin: f64,
    cells: HashMap<[i64; D], Vec<ElementId>>,
}

impl<const D: usize> Grid<D> {
    /// An empty grid for these elements, each of which reaches `margin` (m) beyond its corners.
    fn new<const N: usize>(
        origin: [f64; D],
        elements: impl ExactSizeIterator<Item = [[f64; D]; N]> + Clone,
        margin: f64,
    ) -> Self {
        let extents = elements.map(|corners| {
            let [low, high] = bounds(&corners);
            (0..D).map(|c| high[c] - low[c]).fold(0.0, f64::max)
        });
        // Relative to the largest, whose square might underflow.
        let (count, largest) = (extents.len() as f64, extents.clone().fold(f64::MIN_POSITIVE, f64::max));
        let square: f64 = extents.map(|extent| (extent / largest) * (extent / largest)).sum();
        let spacing = (largest * (square / count).sqrt()).max(f64::MIN_POSITIVE);
        Self { origin, spacing, margin, cells: HashMap::new() }
    }

    /// The cells of the grid that an element reaches.
    fn keys<const N: usize>(&self, corners: &[[f64; D]; N]) -> impl Iterator<Item = [i64; D]> + use<D, N> {
        let [low, high] = bounds(corners);
        let key = |x: f64, c: usize| ((x - self.origin[c]) / self.spacing).floor() as i64;
        let first: [i64; D] = std::array::from_fn(|c| key(low[c] - self.margin, c));
        let last: [i64; D] = std::array::from_fn(|c| key(high[c] + self.margin, c));
        // Like an odometer: the first axis goes round, then the next one moves on.
        std::iter::successors(Some(first), move |key| {
            let c = (0..D).find(|&c| key[c] < last[c])?;
            Some(std::array::from_fn(|a| match a.cmp(&c) {
                Ordering::Less => first[a],
                Ordering::Equal => key[a] + 1,
                Ordering::Greater => key[a],
            }))
        })
    }
}

/// Lowest and highest coordinates.
fn bounds<const D: usize, const N: usize>(corners: &[[f64; D]; N]) -> [[f64; D]; 2] {
    [f64::min, f64::max].map(|pick| std::array::from_fn(|c| corners.iter().map(|p| p[c]).fold(corners[0][c], pick)))
}

/// Whether two simplices are at most `tolerance` apart: then no direction separates them by more.
fn meet<const D: usize, const N: usize>(
    kind: &dyn Cell<D, N>,
    a: &[[f64; D]; N],
    b: &[[f64; D]; N],
    tolerance: f64,
) -> bool {
    // Corners at one place have no direction.
    let between = a.iter().flat_map(|p| b.iter().map(move |q| std::array::from_fn(|c| q[c] - p[c])));
    let between = between.filter(|direction: &[f64; D]| *direction != [0.0; D]);
    !kind.separating_directions(a, b).into_iter().chain(between).any(|direction| gap(a, b, direction) > tolerance)
}

/// How far two simplices are apart along a direction (m), negative if they overlap there.
fn gap<const D: usize, const N: usize>(a: &[[f64; D]; N], b: &[[f64; D]; N], direction: [f64; D]) -> f64 {
    let length = direction.iter().fold(0.0, |length: f64, x| length.hypot(*x));
    // From a corner, not from an origin that may be far away.
    let along = |p: &[f64; D]| (0..D).map(|c| (p[c] - a[0][c]) * (direction[c] / length)).sum::<f64>();
    let span = |corners: &[[f64; D]; N]| {
        corners.iter().map(along).fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    };
    let ([low_a, high_a], [low_b, high_b]) = (span(a), span(b));
    (low_b - high_a).max(low_a - high_b)
}
