//! Geometry, nodes and elements as version 4.1 writes them: the same numbers in texts and binary files.

use super::cursor::Cursor;
use super::error::{Fault, GmshCause};
use super::raw::{Head, Node, Raw};

fn tag(cursor: &mut Cursor<'_>, what: &'static str) -> Result<u64, Fault> {
    let at = cursor.at();
    let tag = cursor.size(what)?;
    if tag == 0 { Err(GmshCause::Tag { what, tag: 0 }.at(at)) } else { Ok(tag) }
}

fn count(cursor: &mut Cursor<'_>, what: &'static str, numbers: usize) -> Result<usize, Fault> {
    let count = cursor.size(what)?;
    cursor.entries(count, numbers, what)
}

/// Reads $Entities: the physical groups of points, curves, surfaces and volumes.
pub(super) fn entities(cursor: &mut Cursor<'_>, raw: &mut Raw) -> Result<(), Fault> {
    let mut counts = [0; 4];
    for slot in &mut counts {
        *slot = count(cursor, "the number of parts of the geometry", 5)?;
    }
    raw.surfaces = counts[2] > 0;
    for (dimension, many) in (0..).zip(counts) {
        for _ in 0..many {
            let entity = cursor.int("the tag of a part of the geometry")?;
            // Its position or bounding box.
            for _ in 0..if dimension == 0 { 3 } else { 6 } {
                cursor.any_real("a corner of a part of the geometry")?;
            }
            let groups = count(cursor, "the number of physical groups", 1)?;
            let mut all = Vec::new();
            for _ in 0..groups {
                // A negative group means the reverse orientation of the part.
                all.push(cursor.int("the tag of a physical group")?.saturating_abs());
            }
            raw.groups_of.insert((dimension, entity), all);
            if dimension > 0 {
                for _ in 0..count(cursor, "the number of bounding parts", 1)? {
                    cursor.int("the tag of a bounding part")?;
                }
            }
        }
    }
    Ok(())
}

/// Reads $Nodes.
pub(super) fn nodes(cursor: &mut Cursor<'_>, raw: &mut Raw) -> Result<(), Fault> {
    let blocks = count(cursor, "the number of blocks of nodes", 4)?;
    let total = count(cursor, "the number of nodes", 4)?;
    cursor.size("the least tag of all nodes")?;
    cursor.size("the largest tag of all nodes")?;
    raw.nodes.reserve(total);
    for _ in 0..blocks {
        let dimension = cursor.int("the dimension of a block of nodes")?;
        cursor.int("the part of the geometry of a block of nodes")?;
        let parametric = cursor.int("whether a block of nodes is parametric")? != 0;
        let many = count(cursor, "the number of nodes of a block", 4)?;
        let first = raw.nodes.len();
        for _ in 0..many {
            cursor.skip_if_text();
            let at = cursor.at();
            raw.nodes.push(Node { tag: tag(cursor, "a node")?, point: [0.0; 3], at });
        }
        for node in &mut raw.nodes[first..] {
            for x in &mut node.point {
                *x = cursor.real("a coordinate of a node")?;
            }
            for _ in 0..if parametric { dimension.clamp(0, 3) } else { 0 } {
                cursor.any_real("a parameter of a node")?;
            }
        }
    }
    agree(cursor, "the number of nodes", total, raw.nodes.len())
}

/// Reads $Elements.
pub(super) fn elements(cursor: &mut Cursor<'_>, raw: &mut Raw) -> Result<(), Fault> {
    let blocks = count(cursor, "the number of blocks of elements", 4)?;
    let total = count(cursor, "the number of elements", 2)?;
    cursor.size("the least tag of all elements")?;
    cursor.size("the largest tag of all elements")?;
    let mut done = 0;
    for _ in 0..blocks {
        cursor.int("the dimension of a block of elements")?;
        let entity = cursor.int("the part of the geometry of a block of elements")?;
        let kind = cursor.int("the type of elements")?;
        let many = count(cursor, "the number of elements of a block", 2)?;
        for _ in 0..many {
            cursor.skip_if_text();
            let at = cursor.at();
            let head = Head { kind, tag: tag(cursor, "an element")?, entity, group: 0, at };
            raw.element(cursor, head, |cursor| tag(cursor, "a node of an element"))?;
        }
        done += many;
    }
    agree(cursor, "the number of elements", total, done)
}

/// Compares the count at the head of a section with its entries.
fn agree(cursor: &Cursor<'_>, what: &'static str, told: usize, found: usize) -> Result<(), Fault> {
    if told == found {
        return Ok(());
    }
    let advice = "its blocks hold another number: the file was edited or damaged";
    Err(GmshCause::Unexpected { found: format!("`{told}`"), what, advice }.at(cursor.at()))
}
