//! What a mesh file holds.

use crate::message::{counted, short};
use crate::report::summary::counts;
use crate::report::{FORMAT, Versions, Warning, reported};
use percute_io::gmsh::MeshFile;
use serde::Serialize;
use std::path::Path;

/// A mesh in a file. Lengths are those of the file: metres once multiplied by the case's `scale`.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct MeshInfo {
    pub format: u32,
    pub versions: Versions,
    pub file: String,
    pub dimension: usize,
    pub nodes: usize,
    pub elements: usize,
    pub reoriented_elements: usize,
    pub lower_corner: Vec<f64>,
    pub upper_corner: Vec<f64>,
    pub edge_groups: Vec<GroupInfo>,
    pub element_groups: Vec<GroupInfo>,
    pub warnings: Vec<Warning>,
}

/// A group of the mesh.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct GroupInfo {
    pub name: String,
    pub members: usize,
}

/// What a mesh file holds.
#[must_use]
pub fn of_mesh(path: &Path, file: &MeshFile) -> MeshInfo {
    let mesh = &file.mesh;
    let corner = |start: f64, pick: fn(f64, f64) -> f64| {
        (0..mesh.dimension()).map(|c| mesh.places().map(|p| p[c]).fold(start, pick)).collect()
    };
    let group = |(name, members): (&String, usize)| GroupInfo { name: name.clone(), members };
    MeshInfo {
        format: FORMAT,
        versions: Versions::of_this_program(),
        file: path.display().to_string(),
        dimension: mesh.dimension(),
        nodes: mesh.node_count(),
        elements: mesh.element_count(),
        reoriented_elements: mesh.reoriented_elements(),
        lower_corner: corner(f64::INFINITY, f64::min),
        upper_corner: corner(f64::NEG_INFINITY, f64::max),
        edge_groups: mesh.face_groups().iter().map(|(name, all)| group((name, all.len()))).collect(),
        element_groups: mesh.element_groups().iter().map(|(name, all)| group((name, all.len()))).collect(),
        warnings: reported(mesh).collect(),
    }
}

impl MeshInfo {
    pub(super) fn lines(&self) -> Vec<(&'static str, String)> {
        let (faces, face) = [("edges", "end"), ("edges", "edge"), ("faces", "face")][self.dimension - 1];
        let body = counts(self.dimension, self.elements, self.nodes);
        let mut lines = vec![("mesh", self.file.clone()), ("body", body)];
        let corner = |corner: &[f64]| corner.iter().map(|x| short(*x, 4)).collect::<Vec<_>>().join(", ");
        let (lower, upper) = (corner(&self.lower_corner), corner(&self.upper_corner));
        lines.push(("box", format!("({lower}) to ({upper}): metres, unless the case has a `scale`")));
        for (title, groups, member) in [(faces, &self.edge_groups, face), ("elements", &self.element_groups, "element")]
        {
            let titles = std::iter::once(title).chain(std::iter::repeat(""));
            let named =
                groups.iter().map(|group| format!("group \"{}\" of {}", group.name, counted(group.members, member)));
            lines.extend(titles.zip(named));
            if groups.is_empty() {
                lines.push((title, "no group".to_string()));
            }
        }
        lines
    }
}
