//! The nodes of a file in the order of their tags.

use super::error::{Fault, GmshCause};
use super::raw::{Element, Node};
use percute_core::cell::CellKind;
use percute_core::mesh::MeshError;

/// Tolerance of a plane or line, as a fraction of the body size; smaller distances are rounding. It is also the
/// distance below which two nodes coincide.
const FLAT: f64 = 1e-10;

/// Nodes by increasing tags.
pub(super) struct Nodes {
    sorted: Vec<Node>,
}

/// Nodes that are kept, with the number that each node of the file has among them.
pub(super) struct Kept {
    pub(super) tags: Vec<u64>,
    /// Coordinates (m).
    points: Vec<[f64; 3]>,
    numbers: Vec<usize>,
    /// Tags of the nodes that are left out.
    pub(super) dropped: Vec<u64>,
}

impl Nodes {
    pub(super) fn new(mut nodes: Vec<Node>) -> Result<Self, Fault> {
        nodes.sort_by_key(|node| node.tag);
        if let Some(pair) = nodes.windows(2).find(|pair| pair[0].tag == pair[1].tag) {
            return Err(GmshCause::Twice { what: "node", tag: pair[1].tag }.at(pair[1].at));
        }
        Ok(Self { sorted: nodes })
    }

    /// The position of a node among those of the file.
    fn find(&self, tag: u64) -> Option<usize> {
        let first = self.sorted.first()?.tag;
        // Tags are without gaps in most files.
        let guess = usize::try_from(tag.checked_sub(first)?).ok()?;
        if self.sorted.get(guess).is_some_and(|node| node.tag == tag) {
            return Some(guess);
        }
        self.sorted.binary_search_by_key(&tag, |node| node.tag).ok()
    }

    /// The nodes of elements, as positions among those of the file.
    pub(super) fn located<const N: usize>(&self, elements: &[Element<N>]) -> Result<Vec<[usize; N]>, Fault> {
        let located = |element: &Element<N>| {
            let mut nodes = [0; N];
            for (slot, &node) in nodes.iter_mut().zip(&element.nodes) {
                let missing = || GmshCause::NoSuchNode { element: element.tag, node }.at(element.at);
                *slot = self.find(node).ok_or_else(missing)?;
            }
            Ok(nodes)
        };
        elements.iter().map(located).collect()
    }

    /// Keeps the nodes of these elements; `scale` is metres per unit of length.
    pub(super) fn keep<const N: usize>(&self, cells: &[[usize; N]], scale: f64) -> Kept {
        let mut numbers = vec![usize::MAX; self.sorted.len()];
        cells.iter().flatten().for_each(|&node| numbers[node] = 0);
        let (mut tags, mut points, mut dropped) = (Vec::new(), Vec::new(), Vec::new());
        for (number, node) in numbers.iter_mut().zip(&self.sorted) {
            if *number == usize::MAX {
                dropped.push(node.tag);
                continue;
            }
            *number = tags.len();
            tags.push(node.tag);
            points.push(node.point.map(|x| x * scale));
        }
        Kept { tags, points, numbers, dropped }
    }
}

impl Kept {
    /// Elements by the numbers of their nodes; all must be kept.
    pub(super) fn numbered<const N: usize>(&self, cells: &[[usize; N]]) -> Vec<[usize; N]> {
        cells.iter().map(|cell| cell.map(|node| self.numbers[node])).collect()
    }

    /// A face by the numbers of its nodes, if all are kept.
    pub(super) fn face<const D: usize>(&self, nodes: [usize; D]) -> Option<[usize; D]> {
        let numbers = nodes.map(|node| self.numbers[node]);
        numbers.iter().all(|&n| n != usize::MAX).then_some(numbers)
    }

    /// The points without their constant coordinates: z in the plane, y and z on a line.
    pub(super) fn flat<const D: usize>(&self, shape: CellKind) -> Result<Vec<[f64; D]>, Fault> {
        if let Some(node) = self.points.iter().position(|p| p.iter().any(|x| !x.is_finite())) {
            let value = self.points[node].into_iter().find(|x| !x.is_finite()).unwrap_or(f64::NAN);
            let error = Box::new(MeshError::NotFinite { node: self.tags[node] as usize, value });
            return Err(GmshCause::Mesh { error, advice: "; is the scale correct?" }.anywhere());
        }
        let extents: Vec<_> = (0..3).map(|axis| self.extent(axis)).collect();
        let size = extents.iter().map(|e| (e.1[1] - e.1[0]).powi(2)).sum::<f64>().sqrt();
        let flat = |axis: usize| extents[axis].1[1] - extents[axis].1[0] <= FLAT * size;
        for axis in D..3 {
            if flat(axis) {
                continue;
            }
            let (nodes, values) = extents[axis];
            let advice = match [flat(0), flat(1)] {
                [_, true] => "it lies in a plane y = const: `Rotate {{1,0,0},{0,0,0},-Pi/2} {Surface{:};}` turns it",
                [true, _] => "it lies in a plane x = const: `Rotate {{0,1,0},{0,0,0},Pi/2} {Surface{:};}` turns it",
                _ => {
                    "if this is the surface of a solid, mesh its volume by `gmsh -3` and save it, by `Physical \
                     Volume` if there are physical groups"
                }
            };
            let cause = match shape {
                CellKind::Bar => GmshCause::NotOnAxis { axis: ['x', 'y', 'z'][axis], nodes, values },
                CellKind::Triangle | CellKind::Tetrahedron => GmshCause::NotPlane { nodes, values, advice },
            };
            return Err(cause.anywhere());
        }
        Ok(self.points.iter().map(|point| std::array::from_fn(|c| point[c])).collect())
    }

    /// The smallest and largest coordinate, with the tags of their nodes.
    fn extent(&self, axis: usize) -> ([u64; 2], [f64; 2]) {
        let (mut ends, mut values) = ([0; 2], [self.points.first().map_or(0.0, |p| p[axis]); 2]);
        for (node, point) in self.points.iter().enumerate() {
            if point[axis] < values[0] {
                (ends[0], values[0]) = (node, point[axis]);
            }
            if point[axis] > values[1] {
                (ends[1], values[1]) = (node, point[axis]);
            }
        }
        (ends.map(|node| self.tags.get(node).copied().unwrap_or(0)), values)
    }
}
