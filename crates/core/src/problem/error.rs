//! What can be wrong with a problem, where it is, and what to do.

use crate::load::TableError;
use crate::material::MaterialError;
use crate::obstacle::PlaneError;
use std::fmt;
use thiserror::Error;

/// Which part of the input is at fault: a table of the case file, its position if there may be
/// several, and a key in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// `mesh`, `material`, `initial`, `obstacle`, `support`, `traction` or `body_force`.
    pub table: &'static str,
    /// Position among tables of that name, from 0.
    pub index: Option<usize>,
    /// The key, empty for the table as a whole.
    pub key: &'static str,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.table)?;
        if let Some(index) = self.index {
            write!(f, " {}", index + 1)?;
        }
        if !self.key.is_empty() {
            write!(f, ", `{}`", self.key)?;
        }
        Ok(())
    }
}

/// An error in the statement of a problem.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{place}: {cause}")]
pub struct InputError {
    /// Where.
    pub place: Place,
    /// What.
    pub cause: Cause,
}

/// What is wrong.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum Cause {
    /// A material out of range.
    #[error(transparent)]
    Material(#[from] MaterialError),
    /// A plane that is none.
    #[error(transparent)]
    Plane(#[from] PlaneError),
    /// A table out of order.
    #[error(transparent)]
    Table(#[from] TableError),
    /// A name that the mesh does not know.
    #[error("there is no group \"{name}\"; the mesh has {}", list(.known))]
    UnknownGroup {
        /// The name.
        name: String,
        /// The names that exist.
        known: Vec<String>,
    },
    /// A group without members.
    #[error("group \"{name}\" is empty")]
    EmptyGroup {
        /// The name.
        name: String,
    },
    /// More materials or body forces than can be told apart.
    #[error("there are {count} of them; at most {most} can be told apart")]
    TooMany {
        /// How many were given.
        count: usize,
        /// How many are allowed.
        most: usize,
    },
    /// No material at all, or not on all elements.
    #[error(
        "element {element} has no material ({count} such elements); give a material without a group, or one for each group"
    )]
    NoMaterial {
        /// First element without.
        element: usize,
        /// How many there are.
        count: usize,
    },
    /// Two materials on one element.
    #[error("element {element} already has material {first}; groups of materials must not overlap")]
    TwoMaterials {
        /// The element.
        element: usize,
        /// The earlier material, from 1.
        first: usize,
    },
    /// A nodal field of the wrong length.
    #[error("the field has {given} values; the mesh has {nodes} nodes")]
    FieldLength {
        /// Values given.
        given: usize,
        /// Nodes of the mesh.
        nodes: usize,
    },
    /// A nodal field with NaN or infinity.
    #[error("the value at node {node} is {value}; it must be finite")]
    FieldNotFinite {
        /// The node.
        node: usize,
        /// The value.
        value: f64,
    },
    /// A number in a load that is NaN or infinite.
    #[error("the value is not finite")]
    NotFinite,
    /// A support of nothing.
    #[error("no component is named; give at least one, as in components = [\"x\"]")]
    NoComponent,
    /// Nothing is left to move.
    #[error("the supports prescribe every component of every node; nothing is left to simulate")]
    NoFreedom,
    /// Two supports that disagree.
    #[error("component {component} of node {node} is already prescribed by support {first} with another motion")]
    ConflictingSupports {
        /// The node.
        node: usize,
        /// x, y or z.
        component: char,
        /// The earlier support, from 1.
        first: usize,
    },
    /// The initial velocity disagrees with a support.
    #[error(
        "component {component} of node {node} starts at {initial} m/s, but is prescribed {prescribed} m/s at t = 0; \
         make the two agree"
    )]
    InconsistentStart {
        /// The node.
        node: usize,
        /// x, y or z.
        component: char,
        /// Initial velocity (m/s).
        initial: f64,
        /// Prescribed velocity (m/s).
        prescribed: f64,
    },
    /// A load on a supported component.
    #[error("component {component} of the facet of nodes {nodes:?} is both loaded and supported")]
    LoadedSupport {
        /// x, y or z.
        component: char,
        /// Nodes of the facet.
        nodes: Vec<usize>,
    },
    /// Contact on a supported or loaded facet (the paper's §2.1 excludes it).
    #[error(
        "the facet of nodes {nodes:?} is supported or loaded and cannot touch a plane too; take it out of the group"
    )]
    NotFree {
        /// Nodes of the facet.
        nodes: Vec<usize>,
    },
    /// A plane that nothing can touch.
    #[error("no free facet {of} faces the plane; does its normal {normal:?} point from the plane to the body?")]
    NothingFaces {
        /// `of group "…"`, or `of the boundary`.
        of: String,
        /// The unit normal.
        normal: Vec<f64>,
    },
    /// A facet or node that could touch two planes.
    #[error(
        "node {node} could touch obstacle {first} as well as this one; \
         name for each obstacle a `group` so that no node lies in two"
    )]
    TwoPlanes {
        /// The node.
        node: usize,
        /// The earlier obstacle, from 1.
        first: usize,
    },
    /// A node behind the plane.
    #[error("node {node} starts {depth:.6e} m behind the plane; move the plane or the body apart")]
    Penetrates {
        /// The node.
        node: usize,
        /// How far behind (m).
        depth: f64,
    },
    /// A node on the plane that moves into it.
    #[error(
        "node {node} starts on the plane (gap {gap:.3e} m) and moves into it at {speed} m/s; leave a gap before the impact"
    )]
    StrikesAtStart {
        /// The node.
        node: usize,
        /// Its gap (m).
        gap: f64,
        /// Its speed towards the plane (m/s).
        speed: f64,
    },
}

impl Cause {
    /// Joins a cause to its place.
    #[must_use]
    pub fn at(self, table: &'static str, index: Option<usize>, key: &'static str) -> InputError {
        InputError { place: Place { table, index, key }, cause: self }
    }
}

/// Name of a component.
pub(crate) fn axis(component: usize) -> char {
    ['x', 'y', 'z'][component]
}

fn list(names: &[String]) -> String {
    if names.is_empty() {
        return "no groups".to_string();
    }
    names.iter().map(|n| format!("\"{n}\"")).collect::<Vec<_>>().join(", ")
}
