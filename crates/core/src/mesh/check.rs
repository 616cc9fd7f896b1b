//! Every check that a mesh must pass.

use super::geometry::diameter;
use super::topology::Faces;
use super::{ElementGroups, FaceRows};
use crate::cell::Cell;
use crate::ids::{ElementId, FaceId, NodeId};
use crate::memory::can_be_had;
use crate::message::{face, numbers, rounded, short};
use std::collections::{BTreeMap, HashMap};
use thiserror::Error;

/// Nodes closer than this fraction of the body's size are duplicates: far above rounding, far
/// below any element.
pub(super) const DUPLICATE: f64 = 1e-10;
/// An element whose volume is below this fraction of diameterᴰ is degenerate (an angle of about
/// 1e-7 degrees): its gradients would have no correct digit left.
const DEGENERATE: f64 = 1e-9;

/// Bytes of an element while mesh and problem are made and the critical step is found: 0.69 GB for two million
/// triangles, 0.20 GB for half a million and 0.07 GB for 180 000 were measured. The figure varies because hash tables
/// double; the largest is taken. A bar takes less.
const ELEMENT: u64 = 420;

/// Makes sure that there is memory for so many elements and their problem.
///
/// # Errors
/// [`MeshError::NoMemory`].
pub fn room(elements: usize) -> Result<(), MeshError> {
    let bytes = (elements as u64).saturating_mul(ELEMENT);
    if can_be_had(bytes) { Ok(()) } else { Err(MeshError::NoMemory { elements, bytes }) }
}

/// Why a mesh was refused.
#[derive(Clone, Debug, Error, PartialEq)]
#[allow(missing_docs, reason = "the messages explain the fields")]
pub enum MeshError {
    /// No nodes or no elements.
    #[error("the mesh is empty: {nodes} nodes and {elements} elements; it needs at least one element")]
    Empty { nodes: usize, elements: usize },
    /// More entities than 32-bit indices can count.
    #[error("the mesh has {count} {what}; at most {most} can be counted")]
    TooLarge { what: &'static str, count: usize, most: usize },
    /// More elements than memory can hold.
    #[error(
        "a mesh of {elements} elements needs about {} GB with its problem, which is not available; give a coarser \
         mesh, or take a larger machine or limit (`ulimit -v`)",
        rounded(*.bytes as f64 / 1e9, 2)
    )]
    NoMemory { elements: usize, bytes: u64 },
    /// A generator was given an impossible value.
    #[error("`{name}` is {value}; it must be {allowed}")]
    Generator { name: &'static str, value: f64, allowed: &'static str },
    /// A coordinate is NaN or infinite.
    #[error("node {node} has the coordinate {value} m; coordinates must be finite")]
    NotFinite { node: usize, value: f64 },
    /// An element refers to a node that does not exist.
    #[error("element {element} names node {node}, but the mesh has nodes 0 to {last}, counted from 0")]
    NoSuchNode { element: usize, node: usize, last: usize },
    /// Nodes that no element uses.
    #[error("node {first} belongs to no element ({count} in all); remove it from the points, or name it in a cell")]
    UnusedNodes { first: usize, count: usize },
    /// Two nodes at the same place.
    #[error(
        "nodes {first} and {second} lie at one place ({} m apart): merge duplicate nodes into one",
        short(*.distance)
    )]
    DuplicateNodes { first: usize, second: usize, distance: f64 },
    /// An element without volume.
    #[error(
        "element {element} is degenerate: its nodes {nodes:?} lie at one place or {} (volume {} for a \
         diameter of {} m); move one of them, or leave the element out",
        if .nodes.len() == 4 { "in one plane" } else { "on one line" }, short(*.volume), short(*.diameter)
    )]
    Degenerate { element: usize, nodes: Vec<usize>, volume: f64, diameter: f64 },
    /// A face shared by more than two elements.
    #[error("the {} is shared by elements {}; at most two may share one", face(.nodes), numbers(.elements))]
    NonManifoldFace { nodes: Vec<usize>, elements: Vec<usize> },
    /// Two elements on the same side of a face.
    #[error(
        "elements {} and {} lie on the same side of their common edge or face: they overlap, or one is there twice; \
         leave one out",
        .elements[0], .elements[1]
    )]
    Overlap { elements: [usize; 2] },
    /// Two parts of the mesh that touch or overlap without a common node.
    #[error(
        "elements {} and {} touch or overlap, but the parts of the mesh they belong to share no node: each would move \
         through the other; let them share the nodes where they meet (mesh them as one, merge the nodes), or keep them \
         apart", .elements[0], .elements[1]
    )]
    PartsTouch { elements: [usize; 2] },
    /// A node where parts of the body touch at a point only.
    #[error(
        "at node {node} the body is connected by a point only ({reached} of its {elements} elements are joined by \
         edges); split the node or fill the gap"
    )]
    NonManifoldNode {
        node: usize,
        /// Elements around it.
        elements: usize,
        /// Elements that can be reached through faces.
        reached: usize,
    },
    /// A node where parts of a solid touch at a point or along an edge only.
    #[error(
        "at node {node} the body is connected by a point or an edge only ({reached} of its {elements} elements are \
         joined by faces); split the node or fill the gap"
    )]
    NonManifoldSolid {
        node: usize,
        /// Elements around it.
        elements: usize,
        /// Elements that can be reached through faces.
        reached: usize,
    },
    /// A group refers to a face that does not exist.
    #[error(
        "group \"{group}\" names the {}, which is not on the boundary of the mesh; a group holds edges (a bar: ends) \
         of the boundary, nodes are counted from 0", face(.nodes)
    )]
    NoSuchFace { group: String, nodes: Vec<usize> },
    /// A group refers to an element that does not exist.
    #[error("group \"{group}\" names element {element}, but the mesh has elements 0 to {last}, counted from 0")]
    NoSuchElement { group: String, element: usize, last: usize },
}

pub(super) fn points<const D: usize>(points: &[[f64; D]]) -> Result<(), MeshError> {
    for (node, point) in points.iter().enumerate() {
        if let Some(&value) = point.iter().find(|x| !x.is_finite()) {
            return Err(MeshError::NotFinite { node, value });
        }
    }
    Ok(())
}

/// Typed cells, all of whose nodes exist, and all nodes of which are used.
pub(super) fn cells<const N: usize>(node_count: usize, cells: &[[usize; N]]) -> Result<Vec<[NodeId; N]>, MeshError> {
    let most = u32::MAX as usize / 4;
    if node_count == 0 || cells.is_empty() {
        return Err(MeshError::Empty { nodes: node_count, elements: cells.len() });
    }
    for (what, count) in [("nodes", node_count), ("elements", cells.len())] {
        if count > most {
            return Err(MeshError::TooLarge { what, count, most });
        }
    }
    let mut used = vec![false; node_count];
    for (element, cell) in cells.iter().enumerate() {
        for &node in cell {
            *used.get_mut(node).ok_or(MeshError::NoSuchNode { element, node, last: node_count - 1 })? = true;
        }
    }
    if let Some(first) = used.iter().position(|used| !used) {
        return Err(MeshError::UnusedNodes { first, count: used.iter().filter(|used| !**used).count() });
    }
    Ok(cells.iter().map(|cell| cell.map(NodeId::new)).collect())
}

/// Searches for duplicates part by part, of which `part` has the first node for each node.
pub(super) fn duplicate_points_of_parts<const D: usize>(
    points: &[[f64; D]],
    part: &[NodeId],
    size: f64,
) -> Result<(), MeshError> {
    let mut nodes: Vec<usize> = (0..points.len()).collect();
    nodes.sort_by_key(|&node| part[node]);
    let of_one = |a: &usize, b: &usize| part[*a] == part[*b];
    nodes.chunk_by(of_one).try_for_each(|nodes| duplicate_points(points, nodes.iter().copied(), size))
}

/// Searches for duplicates among some nodes in neighbouring cells of a fine grid.
pub(super) fn duplicate_points<const D: usize>(
    points: &[[f64; D]],
    nodes: impl ExactSizeIterator<Item = usize>,
    size: f64,
) -> Result<(), MeshError> {
    let spacing = (DUPLICATE * size).max(f64::MIN_POSITIVE);
    let origin = points[0];
    let mut grid: HashMap<[i64; D], usize> = HashMap::with_capacity(nodes.len());
    for (second, point) in nodes.map(|node| (node, &points[node])) {
        let mut key = [0; D];
        for c in 0..D {
            key[c] = ((point[c] - origin[c]) / spacing).floor() as i64;
        }
        for shift in 0..3_usize.pow(D as u32) {
            let mut near = key;
            for c in 0..D {
                near[c] = near[c].saturating_add(shift as i64 / 3_i64.pow(c as u32) % 3 - 1);
            }
            if let Some(&first) = grid.get(&near) {
                let distance = point.iter().zip(&points[first]).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
                if distance <= spacing {
                    return Err(MeshError::DuplicateNodes { first, second, distance });
                }
            }
        }
        grid.insert(key, second);
    }
    Ok(())
}

/// Reorients negatively oriented elements and counts them; refuses degenerate ones.
pub(super) fn orient<const D: usize, const N: usize>(
    kind: &dyn Cell<D, N>,
    points: &[[f64; D]],
    cells: &mut [[NodeId; N]],
) -> Result<usize, MeshError> {
    let mut reoriented = 0;
    for (element, cell) in cells.iter_mut().enumerate() {
        let corners = cell.map(|node| points[node.index()]);
        let (volume, diameter) = (kind.signed_volume(&corners), diameter(&corners));
        if volume.abs() <= DEGENERATE * diameter.powi(D as i32) {
            let nodes = cell.iter().map(|n| n.index()).collect();
            return Err(MeshError::Degenerate { element, nodes, volume, diameter });
        }
        if volume < 0.0 {
            cell.swap(N - 2, N - 1);
            reoriented += 1;
        }
    }
    Ok(reoriented)
}

pub(super) fn face_groups(
    faces: &Faces,
    node_count: usize,
    groups: &FaceRows,
) -> Result<BTreeMap<String, Vec<FaceId>>, MeshError> {
    let find = |group: &String, nodes: &[usize]| {
        let missing = || MeshError::NoSuchFace { group: group.clone(), nodes: nodes.to_vec() };
        if nodes.iter().any(|&n| n >= node_count) {
            return Err(missing());
        }
        let mut sorted: Vec<NodeId> = nodes.iter().copied().map(NodeId::new).collect();
        sorted.sort_unstable();
        let at = faces.find(&sorted).ok_or_else(missing)?;
        if faces.get(at).neighbour.is_some() { Err(missing()) } else { Ok(FaceId::new(at)) }
    };
    let mut named = BTreeMap::new();
    for (group, members) in groups {
        let mut ids =
            members.chunks_exact(faces.width).map(|nodes| find(group, nodes)).collect::<Result<Vec<_>, _>>()?;
        ids.sort_unstable();
        ids.dedup();
        named.insert(group.clone(), ids);
    }
    Ok(named)
}

pub(super) fn element_groups(
    element_count: usize,
    groups: &ElementGroups,
) -> Result<BTreeMap<String, Vec<ElementId>>, MeshError> {
    let mut named = BTreeMap::new();
    for (group, members) in groups {
        if let Some(&element) = members.iter().find(|&&e| e >= element_count) {
            return Err(MeshError::NoSuchElement { group: group.clone(), element, last: element_count - 1 });
        }
        let mut ids: Vec<_> = members.iter().map(|&e| ElementId::new(e)).collect();
        ids.sort_unstable();
        ids.dedup();
        named.insert(group.clone(), ids);
    }
    Ok(named)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 2³⁰ elements and more than 2³²/4 are too many. Elements without nodes take no memory.
    #[test]
    fn too_large() {
        const MANY: usize = 1 << 30;
        static CELLS: [[usize; 0]; MANY] = [[]; MANY];
        let most = u32::MAX as usize / 4;
        assert_eq!(cells(1, &CELLS).unwrap_err(), MeshError::TooLarge { what: "elements", count: MANY, most });
    }
}
