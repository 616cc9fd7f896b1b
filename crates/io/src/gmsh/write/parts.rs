//! A mesh as parts of a geometry: elements that are in the same groups.

use percute_core::cell::CellKind;
use percute_core::mesh::Mesh;
use std::collections::BTreeMap;

/// Elements or faces that are in the same groups.
pub(super) struct GroupedPart {
    /// Tags of their physical groups.
    pub(super) groups: Vec<usize>,
    /// Their numbers.
    pub(super) members: Vec<usize>,
}

/// Parts of both dimensions; the tag of a part is its position plus 1.
pub(super) struct Parts {
    /// Dimension, tag and name of the physical groups.
    pub(super) names: Vec<(usize, usize, String)>,
    /// Parts of the boundary, of faces that are in a group.
    pub(super) faces: Vec<GroupedPart>,
    /// Parts of the body.
    pub(super) cells: Vec<GroupedPart>,
}

impl Parts {
    pub(super) fn of(mesh: &Mesh) -> Self {
        let mut names = Vec::new();
        let mut faces = BTreeMap::<usize, Vec<usize>>::new();
        for (name, members) in mesh.face_groups() {
            names.push((mesh.dimension() - 1, names.len() + 1, name.clone()));
            members.iter().for_each(|face| faces.entry(face.index()).or_default().push(names.len()));
        }
        let mut cells = vec![Vec::new(); mesh.element_count()];
        for (name, members) in mesh.element_groups() {
            names.push((mesh.dimension(), names.len() + 1, name.clone()));
            members.iter().for_each(|cell| cells[cell.index()].push(names.len()));
        }
        let faces = parts(faces.into_iter());
        // A point of the geometry is one point.
        let alone = |GroupedPart { groups, members }: GroupedPart| {
            members.into_iter().map(move |face| GroupedPart { groups: groups.clone(), members: vec![face] })
        };
        let faces = match mesh.kind() {
            CellKind::Bar => faces.into_iter().flat_map(alone).collect(),
            CellKind::Triangle | CellKind::Tetrahedron => faces,
        };
        Self { names, faces, cells: parts(cells.into_iter().enumerate()) }
    }
}

fn parts(entries: impl Iterator<Item = (usize, Vec<usize>)>) -> Vec<GroupedPart> {
    let mut parts = BTreeMap::<Vec<usize>, Vec<usize>>::new();
    entries.for_each(|(member, groups)| parts.entry(groups).or_default().push(member));
    parts.into_iter().map(|(groups, members)| GroupedPart { groups, members }).collect()
}
