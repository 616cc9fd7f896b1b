//! Errors about mesh files, with their places and the remedies in Gmsh.

use super::kind::ElementKind;
use crate::error::FileCause;
use percute_core::mesh::MeshError;
use std::fmt;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// An error about a mesh file. Numbers of nodes and elements are the tags that Gmsh gave them.
#[derive(Debug, Error)]
#[error("{}{}: {cause}", path.display(), at(*.place))]
pub struct GmshError {
    /// The file.
    pub path: PathBuf,
    /// Its place in the file, if there is one.
    pub place: Option<FilePlace>,
    /// What is wrong.
    pub cause: GmshCause,
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilePlace {
    /// A line of a text, from 1.
    Line(usize),
    /// A byte of a binary file, from 0.
    Byte(usize),
}

impl fmt::Display for FilePlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

fn at(place: Option<FilePlace>) -> String {
    place.map_or_else(String::new, |place| format!(", {place}"))
}

/// What is wrong.
#[derive(Debug, Error)]
#[allow(missing_docs, reason = "the messages explain the fields")]
pub enum GmshCause {
    /// The file cannot be read or created.
    #[error(transparent)]
    File(#[from] FileCause),
    /// A large file.
    #[error(
        "to read the mesh takes about {} MB of memory, which is not available; give a coarser mesh, or take a larger \
         machine or limit (`ulimit -v`)", needed / 1_000_000
    )]
    NoMemory { needed: u64 },
    /// An invalid scale.
    #[error(
        "the scale is {value:?}; it must be a positive number from 1e-12 to 1e12: metres per unit of length in the \
         file, 1e-3 for millimetres"
    )]
    Scale { value: f64 },
    /// Not a mesh file.
    #[error("this is not a Gmsh mesh: it begins with {found}; {advice}")]
    NotMsh { found: String, advice: &'static str },
    /// Another version of the format.
    #[error(
        "the file has version {found} of the MSH format; percute reads 2.2 and 4.1: \
         `gmsh old.msh -save -format msh41 -o new.msh` converts it"
    )]
    Version { found: String },
    /// An unexpected entry.
    #[error("found {found} instead of {what}; {advice}")]
    Unexpected { found: String, what: &'static str, advice: &'static str },
    /// The end of the file.
    #[error("the file ends where {what} should be: it was cut off, or its writer has not finished")]
    Cut { what: &'static str },
    /// A number of entries that the file cannot hold.
    #[error("{what} is {count}, more than the rest of the file can hold: the file was cut off or damaged")]
    Count { what: &'static str, count: u64 },
    /// A missing section.
    #[error("there is no section ${section}; in Gmsh, mesh the surfaces (2D) or volumes (3D) before saving")]
    NoSection { section: &'static str },
    /// A partitioned mesh.
    #[error(
        "the mesh is partitioned; in Gmsh, choose Mesh > Unpartition (in Python `gmsh.model.mesh.unpartition()`) and \
         save again"
    )]
    Partitioned,
    /// Elements of an unsupported kind.
    #[error(
        "element {element} is {kind}; percute takes 3-node triangles, 4-node tetrahedra (a bar: 2-node lines): {}",
        kind.advice()
    )]
    Kind {
        /// Tag of the element, or of the first of a block.
        element: u64,
        kind: ElementKind,
    },
    /// Neither triangles nor lines.
    #[error(
        "the file has neither triangles nor lines; in Gmsh, mesh the surfaces (2D) before saving. If there are \
         physical groups, Gmsh saves their members only: name the body by `Physical Surface(\"body\") = {{…}};`"
    )]
    NoElements,
    /// Surfaces whose triangles were not saved.
    #[error(
        "the file has surfaces but no triangles: with physical groups, Gmsh saves their members only. Name \
         the body by `Physical Surface(\"body\") = {{…}};` (and mesh in 2D), or save all with `Mesh.SaveAll = 1`"
    )]
    NoTriangles,
    /// A tag given twice.
    #[error("{what} {tag} is given twice; tags must differ: in Gmsh, open the mesh and save it again")]
    Twice { what: &'static str, tag: u64 },
    /// An invalid tag.
    #[error("the tag of {what} is {tag}; tags are whole numbers from 1")]
    Tag { what: &'static str, tag: i64 },
    /// An element on a missing node.
    #[error("element {element} names node {node}, which is not in $Nodes; in Gmsh, save the mesh again")]
    NoSuchNode { element: u64, node: u64 },
    /// Triangles in space.
    #[error(
        "the mesh is not in a plane z = const: node {} has z = {} m and node {} has z = {} m; {advice}",
        .nodes[0], .values[0], .nodes[1], .values[1]
    )]
    NotPlane { nodes: [u64; 2], values: [f64; 2], advice: &'static str },
    /// Lines that are not a bar along x.
    #[error(
        "the file has lines but no triangles, and the lines are not a bar along x: node {} has {axis} = {} m and node \
         {} has {axis} = {} m. For a plane body: with physical groups, Gmsh saves their members only; name \
         the body by `Physical Surface(\"body\") = {{…}};` and mesh in 2D",
        .nodes[0], .values[0], .nodes[1], .values[1]
    )]
    NotOnAxis { axis: char, nodes: [u64; 2], values: [f64; 2] },
    /// A triangle that bounds no tetrahedron, a line that bounds no triangle, or a point that bounds no line.
    #[error("{}: {}", lone(*.dimension, *.element, .nodes, .groups), lone_advice(*.dimension, .groups))]
    Lone {
        /// Dimension of the mesh: 3 for a triangle, 2 for a line, 1 for a point.
        dimension: usize,
        element: u64,
        nodes: Vec<u64>,
        groups: Vec<String>,
    },
    /// An invalid mesh, in the tags of the file.
    #[error("{error} (numbers are the tags in Gmsh){advice}")]
    Mesh { error: Box<MeshError>, advice: &'static str },
    /// A name that the format does not allow.
    #[error("the group {name:?} cannot be written: names in MSH files have no quotes and no line breaks")]
    Name { name: String },
}

fn lone(dimension: usize, element: u64, nodes: &[u64], groups: &[String]) -> String {
    let groups = if groups.is_empty() { String::new() } else { format!(", in {},", quoted(groups)) };
    let [what, part, of] = match dimension {
        1 => ["point", "an end", "line"],
        2 => ["line", "an edge", "triangle"],
        _ => ["triangle", "a face", "tetrahedron"],
    };
    format!("the {what} {element} of nodes {nodes:?}{groups} is not {part} of any {of}")
}

fn lone_advice(dimension: usize, groups: &[String]) -> &'static str {
    match (groups.is_empty(), dimension) {
        (true, 3) => {
            "a mesh cannot have tetrahedra and plane bodies; in Gmsh, delete the surface, or save without it by \
             `Mesh.SaveAll = 0`"
        }
        (false, 3) => {
            "percute takes no plane bodies beside solids; in Gmsh, take the surface out of its group, or, where it \
             should bound a volume, join the two by `Coherence;` (OpenCASCADE: `BooleanFragments`)"
        }
        (true, _) => {
            "a mesh cannot have triangles and bars; in Gmsh, delete the curve, or save without it by `Mesh.SaveAll = 0`"
        }
        (false, 2) => {
            "percute takes no bars beside triangles; in Gmsh, take the curve out of its group, or, where it should \
             bound a surface, join the two by `Coherence;` (OpenCASCADE: `BooleanFragments`)"
        }
        (false, _) => "in Gmsh, take the point out of its group",
    }
}

/// A cause with the byte of its place.
#[derive(Debug)]
pub(super) struct Fault {
    pub(super) at: Option<usize>,
    pub(super) cause: Box<GmshCause>,
}

impl GmshCause {
    /// Places the cause at this byte.
    pub(super) fn at(self, byte: usize) -> Fault {
        Fault { at: Some(byte), cause: Box::new(self) }
    }

    /// A cause without a place.
    pub(super) fn anywhere(self) -> Fault {
        Fault { at: None, cause: Box::new(self) }
    }
}

impl Fault {
    /// Adds the file to the error, with a line number for a text.
    pub(super) fn of(self, path: &Path, bytes: &[u8], text: bool) -> GmshError {
        let place = self.at.map(|byte| {
            let before = bytes.get(..byte).unwrap_or(bytes);
            if text {
                FilePlace::Line(1 + before.iter().filter(|&&b| b == b'\n').count())
            } else {
                FilePlace::Byte(byte)
            }
        });
        GmshError { path: path.to_path_buf(), place, cause: *self.cause }
    }
}

/// Names in a sentence.
pub(super) fn quoted(names: &[String]) -> String {
    let all: Vec<_> = names.iter().map(|name| format!("\"{name}\"")).collect();
    let what = if names.len() == 1 { "the physical group" } else { "the physical groups" };
    format!("{what} {}", all.join(", "))
}
