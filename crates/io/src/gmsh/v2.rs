//! Nodes and elements in version 2.2.

use super::cursor::{Cursor, Form};
use super::error::{Fault, GmshCause};
use super::raw::{Head, Node, Raw};

/// A count, which is a line of text in binary files too.
pub(super) fn text_count(cursor: &mut Cursor<'_>, what: &'static str, numbers: usize) -> Result<usize, Fault> {
    let form = std::mem::replace(&mut cursor.form, Form::Text);
    let count = cursor.size(what);
    cursor.form = form;
    let count = count?;
    cursor.line();
    cursor.entries(count, numbers, what)
}

fn tag(cursor: &mut Cursor<'_>, what: &'static str) -> Result<u64, Fault> {
    let at = cursor.at();
    let tag = cursor.int(what)?;
    u64::try_from(tag).ok().filter(|&tag| tag > 0).ok_or_else(|| GmshCause::Tag { what, tag }.at(at))
}

/// Reads $Nodes or, with coordinates on their curves and surfaces, $ParametricNodes.
pub(super) fn nodes(cursor: &mut Cursor<'_>, raw: &mut Raw, parametric: bool) -> Result<(), Fault> {
    let count = text_count(cursor, "the number of nodes", 4)?;
    raw.nodes.reserve(count);
    for _ in 0..count {
        cursor.skip_if_text();
        let at = cursor.at();
        let tag = tag(cursor, "a node")?;
        let mut point = [0.0; 3];
        for x in &mut point {
            *x = cursor.real("a coordinate of a node")?;
        }
        raw.nodes.push(Node { tag, point, at });
        if parametric {
            let dimension = cursor.int("the dimension of a parametric node")?;
            cursor.int("the curve or surface of a parametric node")?;
            for _ in 0..if matches!(dimension, 1 | 2) { dimension } else { 0 } {
                cursor.any_real("a parameter of a node")?;
            }
        }
    }
    Ok(())
}

/// Reads $Elements.
pub(super) fn elements(cursor: &mut Cursor<'_>, raw: &mut Raw) -> Result<(), Fault> {
    let count = text_count(cursor, "the number of elements", 3)?;
    let mut done = 0;
    while done < count {
        cursor.skip_if_text();
        let at = cursor.at();
        if cursor.form == Form::Text {
            let tag = tag(cursor, "an element")?;
            let kind = cursor.int("the type of an element")?;
            let tags = cursor.int("the number of tags of an element")?;
            element(cursor, raw, Block { kind, tags, tag: Some(tag), at })?;
            done += 1;
            continue;
        }
        let kind = cursor.int("the type of elements")?;
        let many = cursor.int("the number of elements of a type")?;
        let tags = cursor.int("the number of tags of an element")?;
        let left = count - done;
        let many = usize::try_from(many).ok().filter(|many| (1..=left).contains(many)).ok_or_else(|| {
            let advice = "the counts of the section contradict each other: the file is damaged";
            GmshCause::Unexpected { found: format!("`{many}`"), what: "the number of elements of a type", advice }
                .at(at)
        })?;
        for _ in 0..many {
            element(cursor, raw, Block { kind, tags, tag: None, at: cursor.at() })?;
        }
        done += many;
    }
    Ok(())
}

/// The entries before the tags of an element; in a binary file its own tag is not among them.
struct Block {
    kind: i64,
    tags: i64,
    tag: Option<u64>,
    at: usize,
}

fn element(cursor: &mut Cursor<'_>, raw: &mut Raw, block: Block) -> Result<(), Fault> {
    let Block { kind, tags, tag: before, at } = block;
    let tag_of = |cursor: &mut Cursor<'_>| before.map_or_else(|| tag(cursor, "an element"), Ok);
    let (tag_here, mut first) = (tag_of(cursor)?, [0; 3]);
    for i in 0..tags {
        let read = cursor.int("a tag of an element")?;
        if let Some(slot) = usize::try_from(i).ok().and_then(|i| first.get_mut(i)) {
            *slot = read;
        }
    }
    let [group, entity, partitions] = first;
    if partitions != 0 {
        return Err(GmshCause::Partitioned.at(at));
    }
    // A negative group means the reverse orientation of the element.
    let head = Head { kind, tag: tag_here, entity, group: group.saturating_abs(), at };
    raw.element(cursor, head, |cursor| tag(cursor, "a node of an element"))
}
