//! What can be wrong with a problem, where it is, and what to do.

mod terms;

pub use terms::{GroupOf, HeldBy};

use crate::contact::ObstacleError;
use crate::load::TableError;
use crate::material::MaterialError;
use crate::message::{counted, face, named, quoted, short, trimmed, vector};
use std::fmt;
use thiserror::Error;

/// Which part of the input is at fault: a table of the case file, its position if there may be
/// several, and a key in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// `mesh`, `material`, `initial`, `obstacle`, `contact`, `support`, `traction`, `body_force` or `time`.
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
#[allow(missing_docs, reason = "the messages explain the fields")]
pub enum Cause {
    /// A material out of range.
    #[error(transparent)]
    Material(#[from] MaterialError),
    /// An obstacle that was refused.
    #[error(transparent)]
    Obstacle(#[from] ObstacleError),
    /// A table out of order.
    #[error(transparent)]
    Table(#[from] TableError),
    /// A name of no group of the mesh.
    #[error("there is no group of {of} \"{name}\"; the mesh has {}", list(*.of, .known))]
    UnknownGroup { name: String, of: GroupOf, known: Vec<String> },
    /// A group of elements where one of the boundary is needed, or the other way round.
    #[error("\"{name}\" is a group of {found}; a group of {of} is needed here: the mesh has {}", list(*.of, .known))]
    OtherGroup { name: String, found: GroupOf, of: GroupOf, known: Vec<String> },
    /// A group without members.
    #[error("group \"{name}\" is empty; give it {of}, or remove the reference to it")]
    EmptyGroup { name: String, of: GroupOf },
    /// Waves faster than light.
    #[error(
        "is {} kg/m³; with a Young's modulus of {} Pa waves would run at {} m/s, faster than light: did you \
         mix units? Steel has 7800 kg/m³ (7.8 g/cm³, 7.8e-9 t/mm³) and 210e9 Pa",
        short(*.density), short(*.young), short(*.speed)
    )]
    FasterThanLight { density: f64, young: f64, speed: f64 },
    /// A material that yields in a body that may turn.
    #[error(
        "cannot be \"finite\" where a material yields: plasticity is for small strains and rotations, up to some per \
         cent and some degrees; leave it out, or leave out `tangent` and `hardening`"
    )]
    FiniteYielding,
    /// Several bodies that may turn.
    #[error(
        "cannot be \"finite\" for {bodies} bodies: contact between bodies has the normals of the undeformed surfaces; \
         give \"small\", or one body"
    )]
    FiniteBodies { bodies: usize },
    /// A plane for some edges of a body that may turn.
    #[error(
        "cannot be given with kinematics = \"finite\": a body that turns may touch the plane with any edge; leave it \
         out"
    )]
    FiniteGroup,
    /// Materials of both kinematics.
    #[error(
        "is \"small\", and that of material {first} is \"finite\": a body turns as a whole; give all materials the same"
    )]
    MixedKinematics { first: usize },
    /// Several planes for bodies that may turn.
    #[error(
        "is one of {planes} planes; with kinematics = \"finite\" one is possible: the nodes of a body that turns would \
         have to find theirs"
    )]
    FinitePlanes { planes: usize },
    /// A law that solids do not have.
    #[error("is not possible in a solid, whose materials are elastic at small strains and rotations; leave it out")]
    SolidLaw,
    /// Several solids.
    #[error(
        "the mesh has {bodies} bodies: a solid is one body, contact between solids is not solved for; leave the others \
         out, or join them"
    )]
    SolidBodies { bodies: usize },
    /// A node of a solid that a support moves along a plane with friction.
    #[error(
        "node {node} may touch the plane and is moved along it by a support: friction of such a node of a solid is not \
         solved for; give friction = 0, or take the node out of one of the two groups"
    )]
    MovedAlong { node: usize },
    /// A node of a solid at three planes.
    #[error(
        "node {node} faces planes {} and {} too: a node may touch two; give the planes groups of faces that may touch \
         them, without a node in all three, or leave one out", .others[0], .others[1]
    )]
    ThreePlanes {
        node: usize,
        /// The earlier planes, from 1.
        others: [usize; 2],
    },
    /// More materials or body forces than can be told apart.
    #[error("{count} are given; at most {most} are possible")]
    TooMany { count: usize, most: usize },
    /// No material at all, or not on all elements.
    #[error(
        "element {element} has no material ({count} such elements); give a material without a group, or one for each \
         group"
    )]
    NoMaterial { element: usize, count: usize },
    /// Two materials on one element.
    #[error(
        "element {element} already has material {first}{}",
        if *.everywhere { ", which has no group and applies to all elements: give it a group too" }
        else { "; groups of materials must not overlap: take it out of one of them" }
    )]
    TwoMaterials {
        element: usize,
        /// The earlier material, from 1.
        first: usize,
        everywhere: bool,
    },
    /// A nodal field of the wrong length.
    #[error(
        "the field has {}, but the mesh has {}; give a value for each node, or one for all",
        counted(*.given, "value"), counted(*.nodes, "node")
    )]
    FieldLength { given: usize, nodes: usize },
    /// A nodal field with NaN or infinity.
    #[error("the value at node {node} is {value}; all values must be finite numbers")]
    FieldNotFinite { node: usize, value: f64 },
    /// A number in a load that is NaN or infinite.
    #[error("holds the number {value}; all numbers must be finite")]
    NotFinite { value: f64 },
    /// A support of nothing.
    #[error("no component is given; give at least one, as in components = [\"x\"]")]
    NoComponent,
    /// Nothing is left to move.
    #[error(
        "the supports prescribe every component of every node; nothing is left to simulate: remove a support, name \
         fewer of its components, or refine the mesh"
    )]
    NoFreedom,
    /// Two supports that disagree.
    #[error(
        "component {component} of node {node} is already prescribed by support {first} with another motion; make the \
         two agree, or take the node out of one of the groups"
    )]
    ConflictingSupports {
        node: usize,
        component: char,
        /// The earlier support, from 1.
        first: usize,
    },
    /// The initial velocity disagrees with a support.
    #[error(
        "component {component} of node {node} starts at {} m/s, but is prescribed {} m/s by a support at t = 0; \
         make the two agree, by the initial velocity or by the velocity of the support",
        trimmed(*.initial, 9), trimmed(*.prescribed, 9)
    )]
    InconsistentStart { node: usize, component: char, initial: f64, prescribed: f64 },
    /// A load on a supported component.
    #[error(
        "the {} is loaded along {component}, where a support prescribes its motion; take it out of one of the two \
         groups, or leave {component} to the load or to the support", face(.nodes)
    )]
    LoadedSupport { component: char, nodes: Vec<usize> },
    /// Contact on a supported or loaded face (the paper's §2.1 excludes it).
    #[error(
        "the {} is {by} and cannot touch a plane or another body too; take it out of one of the two groups{}",
        face(.nodes),
        if .nodes.len() == 1 { ", or give a plane in place of a bar that is held there" } else { "" }
    )]
    NotFree { nodes: Vec<usize>, by: HeldBy },
    /// The faces that face a plane are all supported or loaded.
    #[error(
        "nothing can touch the plane: the {} faces it but is {by}, and no other part of the boundary is free; \
         leave the edges free that are to touch the plane", face(.nodes)
    )]
    AllHeld {
        /// Nodes of the first face.
        nodes: Vec<usize>,
        by: HeldBy,
    },
    /// The nodes that face a plane cannot move towards it.
    #[error(
        "nothing can touch the plane: supports prescribe the motion towards it of all nodes that face it, as of node \
         {node}; leave that component free, or remove the plane"
    )]
    HeldNodes { node: usize },
    /// A plane that nothing can touch.
    #[error(
        "nothing in group \"{group}\" faces the plane: the outward normal of the group is {}, and the normal of the \
         plane, from the plane to the body, is {}; groups that face the plane: {}",
        vector(.outward), vector(.normal), named(.facing)
    )]
    NothingFaces { group: String, outward: Box<[f64]>, normal: Box<[f64]>, facing: Box<[String]> },
    /// A face that could touch two planes.
    #[error(
        "the {} faces obstacle {first} as well as this one; name for each obstacle a `group` so that no edge lies \
         in two",
        face(.nodes)
    )]
    TwoPlanes {
        nodes: Vec<usize>,
        /// The earlier obstacle, from 1.
        first: usize,
    },
    /// Two planes of a node that are almost parallel.
    #[error(
        "node {node} could touch obstacle {first} as well as this one, and the two open by {}°; a node at both needs \
         15 to 165°: name for each obstacle a `group` so that no node lies in both",
        trimmed(*.opening, 4)
    )]
    Opening {
        node: usize,
        /// The earlier obstacle, from 1.
        first: usize,
        /// The angle between the planes (degrees).
        opening: f64,
    },
    /// Two planes of a node whose cones of friction hold forces that cancel.
    #[error(
        "node {node} would jam between this obstacle and obstacle {first}, which open by {}°: the angles of friction, \
         {}° here and {}° there, must add up to less; {}",
        trimmed(*.opening, 4),
        trimmed(.angles[1], 4),
        trimmed(.angles[0], 4),
        match .limit {
            Some(limit) => format!("`friction` must be below {} here", trimmed(*limit, 4)),
            None => format!("lower `friction` of obstacle {first}"),
        }
    )]
    Jams {
        node: usize,
        /// The earlier obstacle, from 1.
        first: usize,
        /// The angle between the planes (degrees).
        opening: f64,
        /// The angles of friction of the earlier and of this obstacle (degrees).
        angles: [f64; 2],
        /// The coefficient that this obstacle must stay below, if there is one.
        limit: Option<f64>,
    },
    /// A name of no body.
    #[error("there is no body \"{name}\"; there are {}", quoted(.known))]
    UnknownBody { name: String, known: Vec<String> },
    /// Contact of one body.
    #[error("is \"{name}\" twice; a body cannot touch itself: name two bodies")]
    OneBody { name: String },
    /// Two contacts of the same bodies.
    #[error("contact of \"{}\" and \"{}\" is already stated; leave one of the two out", .bodies[0], .bodies[1])]
    SamePair { bodies: [String; 2] },
    /// Two contacts of all bodies.
    #[error("contact of all other bodies is already stated; name two bodies by `bodies`, or leave one of the two out")]
    TwoDefaults,
    /// Bodies that could touch, and no coefficient of friction.
    #[error(
        "\"{}\" and \"{}\" could touch each other, but their coefficient of friction is missing: state a contact with \
         `bodies` and `friction` for the two, or one with `friction` alone for all bodies; 0 is without friction",
        .bodies[0], .bodies[1]
    )]
    NoFriction { bodies: [String; 2] },
    /// Bodies that no straight line separates.
    #[error(
        "no straight line separates \"{}\" and \"{}\"{}: one reaches around the other, and the surfaces that may \
         touch cannot be found; name them by `groups`, for each direction two of their own", .bodies[0], .bodies[1],
        if *.halves { " with their halves beyond the line of symmetry" } else { "" }
    )]
    Interlocked { bodies: [String; 2], halves: bool },
    /// Bodies of which no edges see each other.
    #[error(
        "no free edges of \"{}\" and \"{}\" face each other: another body, a support or a load is on or between them, \
         contact with a third body uses them, or they pass each other; leave the contact out, or name the surfaces by \
         `groups`", .bodies[0], .bodies[1]
    )]
    NothingSees { bodies: [String; 2] },
    /// An edge that could touch two bodies.
    #[error(
        "the {} of \"{}\" or \"{}\" {}, and a node can touch one only; name the surfaces by `groups` that share no \
         node, or give the bodies a gap of more than an edge", face(.nodes), .bodies[0], .bodies[1],
        if *.stated {
            "is already in a contact by `groups`: if that is the contact of these two, leave one of the two out; else \
             it would touch two"
        } else {
            "could touch a third body as well"
        }
    )]
    Contested {
        nodes: Vec<usize>,
        bodies: Box<[String; 2]>,
        /// Whether that is stated, and not found.
        stated: bool,
    },
    /// An interface of a body with itself.
    #[error(
        "\"{}\" and \"{}\" belong to one body, which cannot touch itself; name groups of two bodies",
        .groups[0], .groups[1]
    )]
    SameBody { groups: [String; 2] },
    /// A side of an interface that is not on the boundary.
    #[error("the {} is inside the body; only the boundary can touch another body", face(.nodes))]
    InnerFace { nodes: Vec<usize> },
    /// A side of an interface that lies on several bodies.
    #[error(
        "group \"{group}\" lies on several bodies; it may do so if \"{other}\" is of one body and the interface is \
         non-matching (`matching = false`); else give each of them a contact of its own"
    )]
    SeveralBodies { group: String, other: String },
    /// A face that does not face the other side of its interface.
    #[error(
        "the {} does not face the other body: outward normals of the two groups must be within 60° of {} and {}; take \
         it out of the group", face(.nodes), vector(&.outward[0]), vector(&.outward[1])
    )]
    TurnedAway { nodes: Vec<usize>, outward: Box<[Vec<f64>; 2]> },
    /// Nodes of an interface that do not face each other.
    #[error(
        "the nodes of the two groups must face each other in pairs, {}; mesh both surfaces alike, and place them to \
         1e-9 of an edge",
        if counts[0] == counts[1] { format!("but node {node} is offset by {} m from the nearest one", short(*.offset)) }
        else { format!("but the groups have {} and {} nodes", .counts[0], .counts[1]) }
    )]
    NotMatching { counts: [usize; 2], node: usize, offset: f64 },
    /// Edges of an interface that do not face each other.
    #[error(
        "no edge of the other group faces the {}; give both groups the same edges, each once", face(.nodes)
    )]
    EdgesDiffer { nodes: Vec<usize> },
    /// An interface of plane stress with plane strain.
    #[error("one of the bodies is in plane stress and the other one in plane strain; give both the same `plane`")]
    PlanesDiffer,
    /// A node of an interface whose motion is prescribed.
    #[error(
        "a support prescribes the motion of node {node}, which may touch another body; leave it free, or prescribe the \
         same motion along the interface, and none across it, at the node that it faces"
    )]
    HeldPair { node: usize },
    /// A node that may slide along another body, and that a support holds or moves across the interface.
    #[error(
        "a support prescribes the motion of node {node} across the interface with another body; leave it free, or \
         prescribe its motion along the interface alone"
    )]
    HeldAcross { node: usize },
    /// Edges on both sides of an interface that slope at a line of symmetry.
    #[error(
        "the {} and the {} slope by more than 10° at a line of symmetry, where contact forces cannot be normal to both \
         slopes of the whole model; take both out of their groups, with shorter edges if they are the only ones",
        face(&.edges[0]), face(&.edges[1])
    )]
    TwoSlopes { edges: Box<[Vec<usize>; 2]> },
    /// Edges of one side of an interface that cover each other.
    #[error(
        "the {} and the {} of one group lie one above the other along the interface; take one of them out of the group",
        face(&.nodes[0]), face(&.nodes[1])
    )]
    Covered { nodes: Box<[Vec<usize>; 2]> },
    /// Contacts that share nodes with different friction.
    #[error(
        "node {node} belongs to two contacts, which are solved together, but their friction is {} and {}; give both \
         the same `friction`", short(.friction[0]), short(.friction[1])
    )]
    FrictionsDiffer { node: usize, friction: [f64; 2] },
    /// Contacts that share nodes and shall be pairs of nodes.
    #[error(
        "node {node} belongs to two contacts, which are solved together as a non-matching interface; leave `matching` \
         out of both, or make it false"
    )]
    SharedPairs { node: usize },
    /// Two contacts of the same surfaces.
    #[error(
        "contact of \"{}\" and \"{}\" is already stated; leave one of the two out", .groups[0], .groups[1]
    )]
    SameSurfaces { groups: Box<[String; 2]> },
    /// A node of an interface that may touch something else.
    #[error(
        "node {node} may already touch another obstacle, and a node can touch one only; if that is a plane, name by \
         its `group` the edges that may touch it"
    )]
    TwoContacts { node: usize },
    /// Bodies that touch where they have no contact.
    #[error(
        "elements {} and {} of two bodies touch at the start, but no contact between them has edges there: one body \
         would move through the other; state contact of the groups of these edges, or leave a gap",
        .elements[0], .elements[1]
    )]
    TouchUnstated { elements: [usize; 2] },
    /// Bodies that overlap.
    #[error(
        "the bodies overlap: node {node} of \"{}\" starts {} m inside the other body, behind \"{}\"; move them apart \
         by more than that along the normal", .groups[0], short(*.depth), .groups[1]
    )]
    Overlaps {
        node: usize,
        depth: f64,
        /// That of the node, and the other one.
        groups: Box<[String; 2]>,
    },
    /// Bodies that overlap beside the surfaces that may touch, which displacements at the start may do.
    #[error(
        "elements {} and {} of two bodies overlap with the displacements of the start; change these, or move the \
         bodies apart", .elements[0], .elements[1]
    )]
    ElementsOverlap { elements: [usize; 2] },
    /// A surface that starts behind the other one although the bodies are apart.
    #[error(
        "no body is inside another one, but node {node} of \"{}\" starts {} m behind \"{}\" along their common normal \
         {}: contact would push the bodies in a wrong direction; name by `groups` the edges that meet, with a contact \
         for each direction, or start \"{}\" farther along this normal by more than that",
        .groups[0], short(*.depth), .groups[1], vector(.normal), .groups[0]
    )]
    BehindSurface {
        node: usize,
        depth: f64,
        /// That of the node, and the other one.
        groups: Box<[String; 2]>,
        /// From the other surface to that of the node.
        normal: Box<[f64]>,
    },
    /// Surfaces that are curved or inclined against each other and so near that a mean gap is negative.
    #[error(
        "the bodies start too near: no node is inside the other body, but the gap of node {node}, as the mean over its \
         edges that contact is solved for, is {} m; move the bodies apart by more than that along the normal, or give \
         both surfaces smaller edges", trimmed(-*.depth, 4)
    )]
    TooNear { node: usize, depth: f64 },
    /// The body on the wrong side of a plane.
    #[error(
        "the whole body lies behind the plane, node {node} by {} m; the normal must point from the plane to the body: \
         should it be {}?", short(*.depth), vector(.reversed)
    )]
    Behind { node: usize, depth: f64, reversed: Vec<f64> },
    /// A node behind the plane.
    #[error(
        "the plane cuts through the body: node {node} starts {} m behind it; move the plane by more than that against \
         its normal, to {} or beyond", short(*.depth), vector(.clear)
    )]
    Penetrates { node: usize, depth: f64, clear: Vec<f64> },
    /// A node on its obstacle that moves into it.
    #[error(
        "node {node} starts on the plane or body that it may touch (gap {} m) and moves into it at {} m/s; leave a \
         gap before the impact, of more than a quarter of this speed times the first time step",
        short(*.gap), short(*.speed)
    )]
    StrikesAtStart { node: usize, gap: f64, speed: f64 },
}

impl Cause {
    /// Joins a cause to its place.
    #[must_use]
    pub fn at(self, table: &'static str, index: Option<usize>, key: &'static str) -> InputError {
        InputError { place: Place { table, index, key }, cause: self }
    }
}

fn list(of: GroupOf, names: &[String]) -> String {
    if names.is_empty() { format!("no groups of {of}") } else { quoted(names) }
}
