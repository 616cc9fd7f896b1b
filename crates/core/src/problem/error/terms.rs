//! What groups consist of, and what keeps faces from contact, in words.

use crate::cell::CellKind;
use std::fmt;

/// What a group consists of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GroupOf {
    /// Faces of a bar.
    Ends,
    /// Faces of a plane body.
    Edges,
    /// Faces of a solid.
    Faces,
    /// Elements.
    Elements,
}

impl GroupOf {
    /// The faces of an element of this shape.
    #[must_use]
    pub fn faces(shape: CellKind) -> Self {
        match shape {
            CellKind::Bar => Self::Ends,
            CellKind::Triangle => Self::Edges,
            CellKind::Tetrahedron => Self::Faces,
        }
    }
}

impl fmt::Display for GroupOf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Ends => "ends",
            Self::Edges => "edges",
            Self::Faces => "faces",
            Self::Elements => "elements",
        })
    }
}

/// What keeps a face from touching a plane (the paper's §2.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeldBy {
    /// A support, from 0.
    Support(usize),
    /// A traction, from 0.
    Traction(usize),
}

impl fmt::Display for HeldBy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Support(index) => write!(f, "held by support {}", index + 1),
            Self::Traction(index) => write!(f, "loaded by traction {}", index + 1),
        }
    }
}
