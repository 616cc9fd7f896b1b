//! The sections of a file, in any order; unused sections are skipped.

use super::cursor::{Cursor, Form, shown};
use super::error::{Fault, GmshCause};
use super::header::{self, Version};
use super::raw::Raw;
use super::{names, v2, v4};
use std::path::Path;

/// Possible first sections of a file.
const FIRST: [&str; 13] = [
    "MeshFormat",
    "Comments",
    "PhysicalNames",
    "Entities",
    "PartitionedEntities",
    "Nodes",
    "ParametricNodes",
    "Elements",
    "Periodic",
    "GhostElements",
    "Parametrizations",
    "NodeData",
    "ElementData",
];

/// Reads all sections of the file at `path`, whose ending suggests another format in errors.
pub(super) fn read(cursor: &mut Cursor<'_>, path: &Path) -> Result<Raw, Fault> {
    let (mut raw, mut version, mut seen) = (Raw::default(), None, [false; 2]);
    while let Some(name) = begin(cursor, path)? {
        match (name, version) {
            ("MeshFormat", None) => {
                let found = header::read(cursor)?;
                version = Some(found);
                raw.version = found;
            }
            ("PhysicalNames", _) => names::read(cursor, &mut raw.names)?,
            ("PartitionedEntities" | "GhostElements", _) => return Err(GmshCause::Partitioned.at(cursor.at())),
            ("Nodes" | "ParametricNodes" | "Elements" | "Entities", None) => {
                return Err(GmshCause::NoSection { section: "MeshFormat before all others" }.at(cursor.at()));
            }
            ("Nodes" | "ParametricNodes", Some(Version::V22)) => v2::nodes(cursor, &mut raw, name != "Nodes")?,
            ("Nodes", Some(Version::V41)) => v4::nodes(cursor, &mut raw)?,
            ("Elements", Some(Version::V22)) => v2::elements(cursor, &mut raw)?,
            ("Elements", Some(Version::V41)) => v4::elements(cursor, &mut raw)?,
            ("Entities", Some(Version::V41)) => v4::entities(cursor, &mut raw)?,
            (other, _) => return_to_text(cursor, other)?,
        }
        seen[0] |= matches!(name, "Nodes" | "ParametricNodes");
        seen[1] |= name == "Elements";
        end(cursor, name)?;
    }
    let needed = [("MeshFormat", version.is_some()), ("Nodes", seen[0]), ("Elements", seen[1])];
    match needed.into_iter().find(|(_, seen)| !seen) {
        Some((section, _)) => Err(GmshCause::NoSection { section }.anywhere()),
        None => Ok(raw),
    }
}

/// Reads the first line of a section and returns its name; `None` at the end of the file.
fn begin<'a>(cursor: &mut Cursor<'a>, path: &Path) -> Result<Option<&'a str>, Fault> {
    let first = cursor.at() <= 3;
    cursor.skip_space();
    let (at, rest) = (cursor.at(), cursor.rest());
    if rest.is_empty() && !first {
        return Ok(None);
    }
    let name = cursor.line().strip_prefix(b"$").and_then(|name| std::str::from_utf8(name).ok());
    match name {
        Some("NOD" | "NOE") => Err(GmshCause::Version { found: "1".to_string() }.at(at)),
        Some(name) if first && !FIRST.contains(&name) && find(cursor.rest(), &format!("$End{name}")).is_none() => {
            // Other formats have comments that begin with `$`.
            Err(no_mesh(rest, path).at(at))
        }
        Some(name) => Ok(Some(name)),
        None if first => Err(no_mesh(rest, path).at(at)),
        None => {
            let advice = "sections begin with `$` and their name; the file is damaged, or was not written by Gmsh";
            Err(GmshCause::Unexpected { found: shown(rest), what: "the beginning of a section", advice }.at(at))
        }
    }
}

/// The first position of a text.
fn find(bytes: &[u8], text: &str) -> Option<usize> {
    bytes.windows(text.len()).position(|window| window == text.as_bytes())
}

fn no_mesh(rest: &[u8], path: &Path) -> GmshCause {
    let ending = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("geo"));
    let begins = ["Point(", "SetFactory(", "Mesh.", "//"].iter().any(|word| rest.starts_with(word.as_bytes()));
    let advice = if !rest.is_empty() && !rest.starts_with(b"<") && (ending || begins) {
        "a script (.geo) has no mesh yet: `gmsh -2 block.geo -o block.msh` makes it"
    } else {
        "in Gmsh, save as .msh (version 4.1 or 2.2). Other formats: `percute.Mesh.read(…).write(\"block.msh\")` in \
         Python, with the extra `mesh`"
    };
    GmshCause::NotMsh { found: if rest.is_empty() { "nothing, it is empty".to_string() } else { shown(rest) }, advice }
}

/// Skips the contents of a section.
fn return_to_text(cursor: &mut Cursor<'_>, name: &str) -> Result<(), Fault> {
    let mark = format!("$End{name}");
    let found = find(cursor.rest(), &mark);
    let what = "the end of a section";
    let length = found.ok_or_else(|| GmshCause::Cut { what }.at(cursor.at()))?;
    cursor.take(length, what).map(|_| ())
}

/// Reads the last line of a section.
fn end(cursor: &mut Cursor<'_>, name: &str) -> Result<(), Fault> {
    cursor.skip_space();
    let (at, rest) = (cursor.at(), cursor.rest());
    if rest.is_empty() {
        return Err(GmshCause::Cut { what: "the end of a section" }.at(at));
    }
    if cursor.line().strip_prefix(b"$End") == Some(name.as_bytes()) {
        return Ok(());
    }
    let advice = match cursor.form {
        Form::Text => "the section is longer than its counts say: it was edited, or not written by Gmsh",
        Form::Binary { .. } => "the file is damaged, or was sent as a text",
    };
    Err(GmshCause::Unexpected { found: shown(rest), what: "the end of the section", advice }.at(at))
}
