//! Warnings about a file that could be read.

use super::error::quoted;
use super::groups::Sorted;
use super::header::Version;
use super::raw::Raw;
use percute_core::mesh::ImportWarning;
use std::collections::BTreeMap;

/// Largest number of tags in a message.
const SHOWN: usize = 5;
/// Bodies above this size (m) are improbable in impacts; most models in millimetres exceed it.
const LARGE: f64 = 10.0;

/// Nodes that no element uses.
pub(super) fn dropped(tags: &[u64], dimension: usize) -> Option<ImportWarning> {
    if tags.is_empty() {
        return None;
    }
    let (count, shown) = (tags.len(), shown(tags));
    let (nodes, tag, were, them) = if count == 1 {
        ("node", "tag", "was", "it; it often is the centre of an arc")
    } else {
        ("nodes", "tags", "were", "them; they often are centres of arcs")
    };
    let element = ["bar", "triangle", "tetrahedron"][dimension - 1];
    let message = format!("{count} {nodes} of the mesh file ({tag} {shown}) {were} left out: no {element} uses {them}");
    Some(ImportWarning {
        name: "dropped_nodes",
        brief: format!("{count} unused {nodes} left out"),
        message,
        groups: vec![],
    })
}

/// Elements on the nodes of others.
pub(super) fn doubled(tags: &[u64]) -> Option<ImportWarning> {
    if tags.is_empty() {
        return None;
    }
    let (count, shown) = (tags.len(), shown(tags));
    let (elements, tag, were, each) = if count == 1 {
        ("element", "tag", "was", "it has the same nodes as an earlier element, which is in the groups of both")
    } else {
        ("elements", "tags", "were", "each has the same nodes as an earlier element, which is in the groups of both")
    };
    let message = format!("{count} {elements} of the mesh file ({tag} {shown}) {were} left out: {each}");
    let brief = format!("{count} duplicate {elements} left out");
    Some(ImportWarning { name: "duplicate_elements", brief, message, groups: vec![] })
}

fn shown(tags: &[u64]) -> String {
    let mut shown: Vec<_> = tags.iter().take(SHOWN).map(u64::to_string).collect();
    if tags.len() > SHOWN {
        shown.push("…".to_string());
    }
    shown.join(", ")
}

/// Physical groups of curves, in a mesh of a solid.
pub(super) fn curves(raw: &Raw, lines: &Sorted<2>) -> Option<ImportWarning> {
    let groups: Vec<_> = lines.members.keys().map(|&tag| raw.name(1, tag)).collect();
    let message = format!(
        "{} of curves {} left out: in a mesh of a solid, surfaces and volumes can be named, curves cannot",
        quoted(&groups),
        were(&groups)
    );
    import_warning("curves_left_out", "groups of curves left out", message, groups)
}

/// Physical groups of points, in a mesh of a plane body or a solid.
pub(super) fn points(raw: &Raw, points: &Sorted<1>) -> Option<ImportWarning> {
    let groups: Vec<_> = points.members.keys().map(|&tag| raw.name(0, tag)).collect();
    let message = format!(
        "{} of points {} left out: boundaries and bodies can be named, points cannot",
        quoted(&groups),
        were(&groups)
    );
    import_warning("points_left_out", "groups of points left out", message, groups)
}

/// Parts of physical groups that lie inside the body.
pub(super) fn inner(inner: &BTreeMap<String, usize>, dimension: usize) -> Option<ImportWarning> {
    let groups: Vec<_> = inner.keys().cloned().collect();
    let count: usize = inner.values().sum();
    let (edge, edges, of) = match dimension {
        1 => ("point", "points", "points"),
        2 => ("edge", "edges", "curves"),
        _ => ("face", "faces", "surfaces"),
    };
    let (what, lie, are) = if count == 1 { (edge, "lies", "was") } else { (edges, "lie", "were") };
    let message = format!(
        "{count} {what} of {} {lie} inside the body and {are} left out: groups of {of} name parts of its boundary, \
         where it can be held, loaded or touched",
        quoted(&groups)
    );
    import_warning("inner_edges", "parts of groups inside the body left out", message, groups)
}

/// Physical groups that have a name but no elements.
pub(super) fn empty<T, U>(
    raw: &Raw,
    dimension: usize,
    faces: &BTreeMap<String, Vec<T>>,
    inner: &BTreeMap<String, usize>,
    parts: &BTreeMap<String, Vec<U>>,
) -> Option<ImportWarning> {
    let no_faces = faces.iter().filter(|(name, all)| all.is_empty() && !inner.contains_key(*name));
    let no_parts = parts.iter().filter(|(_, all)| all.is_empty());
    let mut groups: Vec<_> =
        no_faces.map(|(name, _)| name.clone()).chain(no_parts.map(|(name, _)| name.clone())).collect();
    let beyond = raw.names.iter().filter(|((of, _), _)| *of > dimension as i64);
    groups.extend(beyond.map(|(_, name)| name.clone()));
    groups.sort();
    groups.dedup();
    let reason = match raw.version {
        Version::V22 => "Gmsh writes no groups to MSH 2.2 with `Mesh.SaveAll = 1`; set it to 0, or save as 4.1",
        Version::V41 => "in Gmsh, check that each group contains entities that exist and are meshed",
    };
    let message = format!("{} {} no elements in the mesh file: {reason}", quoted(&groups), has(&groups));
    import_warning("empty_groups", "groups without elements", message, groups)
}

/// A body of improbable size without a `scale`: its unit of length is probably the millimetre.
pub(super) fn large(size: f64, scale: f64) -> Option<ImportWarning> {
    if scale != 1.0 || size <= LARGE {
        return None;
    }
    let message = format!(
        "the mesh in the file is {size:.3} m large, corner to corner: if its lengths are in millimetres, give `scale` \
         = 1e-3"
    );
    Some(ImportWarning {
        name: "large_mesh",
        brief: format!("mesh of {size:.4} m: if that is millimetres, give scale = 1e-3"),
        message,
        groups: vec![],
    })
}

fn import_warning(name: &'static str, brief: &str, message: String, groups: Vec<String>) -> Option<ImportWarning> {
    if groups.is_empty() { None } else { Some(ImportWarning { name, brief: brief.to_string(), message, groups }) }
}

fn were(groups: &[String]) -> &'static str {
    if groups.len() == 1 { "was" } else { "were" }
}

fn has(groups: &[String]) -> &'static str {
    if groups.len() == 1 { "has" } else { "have" }
}
