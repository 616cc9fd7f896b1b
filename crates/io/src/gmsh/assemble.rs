//! From the sections of a file to a mesh.

use super::error::{Fault, GmshCause};
use super::faces::{Boundary, boundary};
use super::groups::Sorted;
use super::nodes::{Kept, Nodes};
use super::raw::{Element, Raw};
use super::{MeshFile, import_warnings};
use percute_core::cell::cell;
use percute_core::mesh::{ImportWarning, Mesh, MeshError};
use std::mem::take;

/// Builds the mesh of a file: tetrahedra if there are any, otherwise triangles, otherwise bars.
pub(super) fn mesh(mut raw: Raw, scale: f64) -> Result<MeshFile, Fault> {
    let nodes = Nodes::new(take(&mut raw.nodes))?;
    let (points, lines, triangles) = (take(&mut raw.points), take(&mut raw.lines), take(&mut raw.triangles));
    let tetrahedra = take(&mut raw.tetrahedra);
    if !tetrahedra.is_empty() {
        let left_out =
            [import_warnings::curves(&raw, &raw.sorted(lines)?), import_warnings::points(&raw, &raw.sorted(points)?)];
        return assemble(&raw, &nodes, tetrahedra, triangles, left_out, scale);
    }
    if !triangles.is_empty() {
        let left_out = [import_warnings::points(&raw, &raw.sorted(points)?), None];
        return assemble(&raw, &nodes, triangles, lines, left_out, scale);
    }
    if lines.is_empty() {
        return Err(GmshCause::NoElements.anywhere());
    }
    if raw.surfaces || raw.names.keys().any(|&(dimension, _)| dimension == 2) {
        return Err(GmshCause::NoTriangles.anywhere());
    }
    assemble(&raw, &nodes, lines, points, [None, None], scale)
}

/// Builds a mesh of `cells`, with boundary groups from `faces`; groups of lower dimensions are left out.
fn assemble<const D: usize, const N: usize>(
    raw: &Raw,
    nodes: &Nodes,
    cells: Vec<Element<N>>,
    faces: Vec<Element<D>>,
    [first, second]: [Option<ImportWarning>; 2],
    scale: f64,
) -> Result<MeshFile, Fault> {
    let Sorted { elements, doubled, members } = raw.sorted(cells)?;
    let located = nodes.located(&elements)?;
    let kept = nodes.keep(&located, scale);
    let shape = cell::<D, N>().kind();
    let places = kept.flat::<D>(shape)?;
    let cells = kept.numbered(&located);
    let Boundary { groups, inner } = boundary(raw, nodes, &kept, &cells, &raw.sorted(faces)?, shape)?;
    let parts = raw.named(D, &members, |at| at);
    let reported = [
        import_warnings::dropped(&kept.dropped, D),
        import_warnings::doubled(&doubled),
        first,
        second,
        import_warnings::inner(&inner, D),
        import_warnings::empty(raw, D, &groups, &inner, &parts),
    ];
    let rows = groups.into_iter().map(|(name, faces)| (name, faces.into_flattened())).collect();
    let mesh = Mesh::from_rows(D, places.as_flattened(), cells.as_flattened(), (&rows, &parts))
        .map_err(|error| refused(error, &kept, &elements))?;
    let element_tags = elements.iter().map(|element| element.tag).collect();
    let large = import_warnings::large(mesh.size(), scale);
    let mesh = mesh.with_import_warnings(reported.into_iter().chain([large]).flatten().collect());
    Ok(MeshFile { mesh, node_tags: kept.tags, element_tags })
}

/// A mesh error in the tags of the file, with the place of the element.
fn refused<const N: usize>(error: MeshError, kept: &Kept, elements: &[Element<N>]) -> Fault {
    let node = |number: usize| kept.tags.get(number).map_or(number, |&tag| tag as usize);
    let element = |number: usize| elements.get(number).map_or(number, |element| element.tag as usize);
    let nodes = |numbers: Vec<usize>| numbers.into_iter().map(node).collect();
    let at = |number: usize| elements.get(number).map(|element| element.at);
    let (at, advice, error) = match error {
        MeshError::DuplicateNodes { first, second, distance } => {
            let advice = "; in Gmsh, join bodies that touch by `Coherence;` (OpenCASCADE: `BooleanFragments`) before \
                          meshing, or nodes by `Coherence Mesh;` after";
            (None, advice, MeshError::DuplicateNodes { first: node(first), second: node(second), distance })
        }
        MeshError::Degenerate { element: e, nodes: of, volume, diameter } => {
            let advice = "; in Gmsh, mesh again with another size there, or correct the geometry";
            let error = MeshError::Degenerate { element: element(e), nodes: nodes(of), volume, diameter };
            (at(e), advice, error)
        }
        MeshError::NonManifoldFace { nodes: of, elements: all } => {
            let last = all.last().and_then(|&e| at(e));
            let error =
                MeshError::NonManifoldFace { nodes: nodes(of), elements: all.into_iter().map(element).collect() };
            (last, OVERLAP, error)
        }
        MeshError::Overlap { elements: all } => {
            (at(all[1]), OVERLAP, MeshError::Overlap { elements: all.map(element) })
        }
        MeshError::PartsTouch { elements: all } => {
            let advice = "; in Gmsh, join surfaces that touch or overlap by `Coherence;` (OpenCASCADE: \
                          `BooleanFragments`) before meshing";
            (at(all[1]), advice, MeshError::PartsTouch { elements: all.map(element) })
        }
        MeshError::NonManifoldNode { node: n, elements, reached } => {
            let advice = "; in Gmsh, let the surfaces share a curve, or keep them apart";
            (None, advice, MeshError::NonManifoldNode { node: node(n), elements, reached })
        }
        MeshError::NonManifoldSolid { node: n, elements, reached } => {
            let advice = "; in Gmsh, let the volumes share a surface, or keep them apart";
            (None, advice, MeshError::NonManifoldSolid { node: node(n), elements, reached })
        }
        other => (None, "", other),
    };
    Fault { at, cause: Box::new(GmshCause::Mesh { error: Box::new(error), advice }) }
}

const OVERLAP: &str =
    "; in Gmsh, surfaces that overlap are cut apart by `Coherence;` (OpenCASCADE: `BooleanFragments`)";
