//! Geometry, nodes and elements of version 4.1.

use super::parts::{GroupedPart, Parts};
use super::sink::Sink;
use crate::gmsh::kind::numbers;
use percute_core::ids::{ElementId, FaceId, NodeId};
use percute_core::mesh::Mesh;

pub(super) fn write(out: &mut Sink, mesh: &Mesh, parts: &Parts) {
    out.line("$Entities");
    entities(out, mesh, parts);
    end(out, "$EndEntities");
    out.line("$Nodes");
    let nodes = mesh.node_count();
    row(out, &[1, nodes, 1, nodes]);
    // All nodes are assigned to the first part of the body; the true assignment is not needed.
    head(out, [mesh.dimension(), 1, 0], nodes);
    (1..=nodes).for_each(|tag| row(out, &[tag]));
    for node in 0..nodes {
        mesh.point(NodeId::new(node)).into_iter().for_each(|x| out.real(x));
        out.row();
    }
    end(out, "$EndNodes");
    out.line("$Elements");
    elements(out, mesh, parts);
    end(out, "$EndElements");
}

fn row(out: &mut Sink, sizes: &[usize]) {
    sizes.iter().for_each(|&size| out.size(size));
    out.row();
}

fn head(out: &mut Sink, ints: [usize; 3], count: usize) {
    ints.into_iter().for_each(|number| out.int(number));
    row(out, &[count]);
}

fn end(out: &mut Sink, name: &str) {
    if out.is_binary() {
        out.line("");
    }
    out.line(name);
}

fn entities(out: &mut Sink, mesh: &Mesh, parts: &Parts) {
    let (mut counts, d) = ([0; 4], mesh.dimension());
    counts[d - 1] = parts.faces.len();
    counts[d] = parts.cells.len();
    row(out, &counts);
    let extreme = |pick: fn(f64, f64) -> f64| {
        let points = (0..mesh.node_count()).map(|node| mesh.point(NodeId::new(node)));
        points.reduce(|a, b| std::array::from_fn(|c| pick(a[c], b[c]))).unwrap_or([0.0; 3])
    };
    let around = [extreme(f64::min), extreme(f64::max)];
    let point = |part: &GroupedPart| mesh.face(FaceId::new(part.members[0])).nodes[0];
    for (dimension, all) in [(d - 1, &parts.faces), (d, &parts.cells)] {
        for (at, part) in all.iter().enumerate() {
            out.int(at + 1);
            if dimension == 0 {
                mesh.point(point(part)).into_iter().for_each(|x| out.real(x));
            } else {
                around.as_flattened().iter().for_each(|&x| out.real(x));
            }
            out.size(part.groups.len());
            part.groups.iter().for_each(|&group| out.int(group));
            if dimension > 0 {
                out.size(0);
            }
            out.row();
        }
    }
}

fn elements(out: &mut Sink, mesh: &Mesh, parts: &Parts) {
    let faces: usize = parts.faces.iter().map(|part| part.members.len()).sum();
    let total = mesh.element_count() + faces;
    row(out, &[parts.faces.len() + parts.cells.len(), total, 1, total]);
    let [of_faces, of_cells] = numbers(mesh.kind());
    let mut tag = mesh.element_count();
    for (at, part) in parts.faces.iter().enumerate() {
        head(out, [mesh.dimension() - 1, at + 1, of_faces as usize], part.members.len());
        for &face in &part.members {
            tag += 1;
            out.size(tag);
            mesh.face(FaceId::new(face)).nodes.iter().for_each(|node| out.size(node.index() + 1));
            out.row();
        }
    }
    for (at, part) in parts.cells.iter().enumerate() {
        head(out, [mesh.dimension(), at + 1, of_cells as usize], part.members.len());
        for &cell in &part.members {
            out.size(cell + 1);
            mesh.cell(ElementId::new(cell)).iter().for_each(|node| out.size(node.index() + 1));
            out.row();
        }
    }
}
