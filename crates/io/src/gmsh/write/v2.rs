//! Nodes and elements of version 2.2.

use super::parts::{GroupedPart, Parts};
use super::sink::Sink;
use crate::gmsh::kind::numbers;
use percute_core::ids::{ElementId, FaceId, NodeId};
use percute_core::mesh::Mesh;

/// An element in one of its groups.
struct Entry {
    tag: usize,
    group: usize,
    part: usize,
    nodes: Vec<usize>,
}

pub(super) fn write(out: &mut Sink, mesh: &Mesh, parts: &Parts) {
    out.line("$Nodes");
    out.line(&mesh.node_count().to_string());
    for node in 0..mesh.node_count() {
        out.int(node + 1);
        mesh.point(NodeId::new(node)).into_iter().for_each(|x| out.real(x));
        out.row();
    }
    end(out, "$EndNodes");
    let mut next = mesh.element_count() + 1;
    let cell = |cell: usize| mesh.cell(ElementId::new(cell)).iter().map(|node| node.index() + 1).collect();
    let cells = entries(&parts.cells, &mut next, |cell| Some(cell + 1), cell);
    let face = |face: usize| mesh.face(FaceId::new(face)).nodes.iter().map(|node| node.index() + 1).collect();
    let faces = entries(&parts.faces, &mut next, |_| None, face);
    out.line("$Elements");
    out.line(&(cells.len() + faces.len()).to_string());
    let [of_faces, of_cells] = numbers(mesh.kind());
    for (kind, entries) in [(of_faces, faces), (of_cells, cells)] {
        if out.is_binary() && !entries.is_empty() {
            [kind as usize, entries.len(), 2].into_iter().for_each(|number| out.int(number));
        }
        for Entry { tag, group, part, nodes } in entries {
            out.int(tag);
            if !out.is_binary() {
                [kind as usize, 2].into_iter().for_each(|number| out.int(number));
            }
            [group, part].into_iter().chain(nodes).for_each(|number| out.int(number));
            out.row();
        }
    }
    end(out, "$EndElements");
}

fn end(out: &mut Sink, name: &str) {
    if out.is_binary() {
        out.line("");
    }
    out.line(name);
}

/// Elements, once for each of their groups: the first under its own tag, if it has one, the others under new ones.
fn entries(
    parts: &[GroupedPart],
    next: &mut usize,
    own: impl Fn(usize) -> Option<usize>,
    nodes: impl Fn(usize) -> Vec<usize>,
) -> Vec<Entry> {
    let mut new = || {
        *next += 1;
        *next - 1
    };
    let mut entries = Vec::new();
    for (part, GroupedPart { groups, members }) in parts.iter().enumerate() {
        let groups = if groups.is_empty() { &[0][..] } else { groups };
        for &member in members {
            for (i, &group) in groups.iter().enumerate() {
                let tag = own(member).filter(|_| i == 0).unwrap_or_else(&mut new);
                entries.push(Entry { tag, group, part: part + 1, nodes: nodes(member) });
            }
        }
    }
    entries
}
