//! The raw contents of the sections of a file.

use super::cursor::Cursor;
use super::error::{Fault, GmshCause};
use super::header::Version;
use super::kind::{ElementKind, LINE, POINT, TETRAHEDRON, TRIANGLE};
use std::collections::{BTreeMap, HashMap};

/// An element of `N` nodes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Element<const N: usize> {
    pub(super) tag: u64,
    /// Tag of the part of the geometry that it belongs to.
    pub(super) entity: i64,
    /// Tag of its physical group, in version 2.2; 0 for none.
    pub(super) group: i64,
    pub(super) nodes: [u64; N],
    /// Its first byte in the file.
    pub(super) at: usize,
}

/// A node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) tag: u64,
    pub(super) point: [f64; 3],
    /// Its first byte in the file.
    pub(super) at: usize,
}

/// A dimension with a tag.
pub(super) type Tagged = (i64, i64);

/// The contents of a file.
#[derive(Debug, Default)]
pub(super) struct Raw {
    pub(super) version: Version,
    pub(super) nodes: Vec<Node>,
    pub(super) points: Vec<Element<1>>,
    pub(super) lines: Vec<Element<2>>,
    pub(super) triangles: Vec<Element<3>>,
    pub(super) tetrahedra: Vec<Element<4>>,
    /// Names of physical groups.
    pub(super) names: BTreeMap<Tagged, String>,
    /// Physical groups of the parts of the geometry, in version 4.1.
    pub(super) groups_of: HashMap<Tagged, Vec<i64>>,
    /// Whether the geometry has surfaces.
    pub(super) surfaces: bool,
}

/// Kind and groups of an element, which precede its nodes.
#[derive(Clone, Copy)]
pub(super) struct Head {
    pub(super) kind: i64,
    pub(super) tag: u64,
    pub(super) entity: i64,
    pub(super) group: i64,
    pub(super) at: usize,
}

impl Raw {
    /// Reads the nodes of an element by `node` and keeps it, if its kind is supported.
    pub(super) fn element(
        &mut self,
        cursor: &mut Cursor<'_>,
        head: Head,
        node: impl Fn(&mut Cursor<'_>) -> Result<u64, Fault>,
    ) -> Result<(), Fault> {
        match head.kind {
            TETRAHEDRON => self.tetrahedra.push(with_nodes(cursor, head, node)?),
            TRIANGLE => self.triangles.push(with_nodes(cursor, head, node)?),
            LINE => self.lines.push(with_nodes(cursor, head, node)?),
            POINT => self.points.push(with_nodes(cursor, head, node)?),
            kind => return Err(GmshCause::Kind { element: head.tag, kind: ElementKind(kind) }.at(head.at)),
        }
        Ok(())
    }
}

fn with_nodes<const N: usize>(
    cursor: &mut Cursor<'_>,
    head: Head,
    node: impl Fn(&mut Cursor<'_>) -> Result<u64, Fault>,
) -> Result<Element<N>, Fault> {
    let mut nodes = [0; N];
    for slot in &mut nodes {
        *slot = node(cursor)?;
    }
    let Head { tag, entity, group, at, .. } = head;
    Ok(Element { tag, entity, group, nodes, at })
}
