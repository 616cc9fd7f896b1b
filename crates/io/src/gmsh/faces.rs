//! Triangles as parts of the boundary of tetrahedra, lines of that of triangles, points as ends of bars.

use super::error::{Fault, GmshCause};
use super::groups::Sorted;
use super::nodes::{Kept, Nodes};
use super::raw::Raw;
use percute_core::cell::CellKind;
use std::collections::{BTreeMap, HashMap};

/// The boundary groups of the file.
pub(super) struct Boundary<const D: usize> {
    /// Faces of each group that lie on the boundary, by their nodes.
    pub(super) groups: BTreeMap<String, Vec<[usize; D]>>,
    /// Number of faces of each group that lie inside.
    pub(super) inner: BTreeMap<String, usize>,
}

/// Finds the faces of the physical groups; `cells` are the elements of the mesh.
pub(super) fn boundary<const D: usize, const N: usize>(
    raw: &Raw,
    nodes: &Nodes,
    kept: &Kept,
    cells: &[[usize; N]],
    faces: &Sorted<D>,
    shape: CellKind,
) -> Result<Boundary<D>, Fault> {
    let located: Vec<_> = nodes.located(&faces.elements)?.into_iter().map(|face| kept.face(face)).collect();
    let around = owners(cells, located.iter().flatten());
    let owners_of = |face: &Option<[usize; D]>| face.and_then(|f| around.get(&sorted(f)).copied()).unwrap_or(0);
    let counts: Vec<usize> = located.iter().map(owners_of).collect();
    let required = |at: usize| match shape {
        CellKind::Bar => named(faces, at),
        CellKind::Triangle | CellKind::Tetrahedron => true,
    };
    if let Some(at) = (0..counts.len()).find(|&at| counts[at] == 0 && required(at)) {
        return Err(lone(raw, faces, at));
    }
    let none = [0; D];
    let mut inner = BTreeMap::new();
    let mut groups = BTreeMap::new();
    for (name, members) in raw.named(D - 1, &faces.members, |at| at) {
        let (inside, outside): (Vec<_>, Vec<_>) = members.into_iter().partition(|&at| counts[at] > 1);
        if !inside.is_empty() {
            inner.insert(name.clone(), inside.len());
        }
        groups.insert(name, outside.into_iter().map(|at| located[at].unwrap_or(none)).collect());
    }
    Ok(Boundary { groups, inner })
}

/// Number of elements with each face, for the faces of these nodes.
fn owners<'a, const D: usize, const N: usize>(
    cells: &[[usize; N]],
    faces: impl Iterator<Item = &'a [usize; D]>,
) -> HashMap<[usize; D], usize> {
    let most = cells.iter().flatten().max().map_or(0, |most| most + 1);
    let (mut marked, mut around) = (vec![false; most], HashMap::new());
    for face in faces {
        face.iter().for_each(|&node| marked[node] = true);
        around.insert(sorted(*face), 0);
    }
    for cell in cells {
        for opposite in 0..N {
            let face: [usize; D] = std::array::from_fn(|i| cell[(opposite + 1 + i) % N]);
            if face.iter().all(|&node| marked[node]) {
                around.entry(sorted(face)).and_modify(|count| *count += 1);
            }
        }
    }
    around
}

fn sorted<const D: usize>(mut nodes: [usize; D]) -> [usize; D] {
    nodes.sort_unstable();
    nodes
}

fn named<const D: usize>(faces: &Sorted<D>, at: usize) -> bool {
    faces.members.values().any(|members| members.contains(&at))
}

fn lone<const D: usize>(raw: &Raw, faces: &Sorted<D>, at: usize) -> Fault {
    let element = &faces.elements[at];
    let with = faces.members.iter().filter(|(_, members)| members.contains(&at));
    let groups: Vec<_> = with.map(|(&tag, _)| raw.name(D - 1, tag)).collect();
    let (tag, nodes) = (element.tag, element.nodes.to_vec());
    GmshCause::Lone { dimension: D, element: tag, nodes, groups }.at(element.at)
}
