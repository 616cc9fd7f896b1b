//! Kinds of elements by their numbers in Gmsh.

use percute_core::cell::CellKind;
use std::fmt;

/// Numbers of the kinds that are read.
pub(super) const POINT: i64 = 15;
pub(super) const LINE: i64 = 1;
pub(super) const TRIANGLE: i64 = 2;
pub(super) const TETRAHEDRON: i64 = 4;

/// Numbers of the faces and of the elements of a mesh.
pub(super) fn numbers(shape: CellKind) -> [i64; 2] {
    match shape {
        CellKind::Bar => [POINT, LINE],
        CellKind::Triangle => [LINE, TRIANGLE],
        CellKind::Tetrahedron => [TRIANGLE, TETRAHEDRON],
    }
}

/// An unsupported kind of elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ElementKind(pub i64);

impl ElementKind {
    fn shape(self) -> &'static str {
        match self.0 {
            1 | 8 | 26..=28 | 62..=66 => "line",
            2 | 9 | 20..=25 | 42..=46 | 52..=56 => "triangle",
            3 | 10 | 16 | 36..=41 | 47..=51 | 57..=61 => "quadrangle",
            4 | 11 | 29..=35 | 71..=79 => "tetrahedron",
            5 | 12 | 17 | 92..=105 => "hexahedron",
            6 | 13 | 18 | 90 | 91 | 106..=112 => "prism",
            7 | 14 | 19 | 118..=131 => "pyramid",
            _ => "element of another kind",
        }
    }

    fn is_linear(self) -> bool {
        (1..=7).contains(&self.0)
    }

    /// The remedy in Gmsh.
    #[must_use]
    pub fn advice(self) -> &'static str {
        match self.shape() {
            "quadrangle" => "set `Mesh.RecombineAll = 0`, take out `Recombine Surface`, and mesh again",
            "line" | "triangle" | "tetrahedron" => "set `Mesh.ElementOrder = 1` (or `SetOrder 1;`) and save again",
            "hexahedron" | "prism" | "pyramid" => {
                "take out `Transfinite Volume`, `Recombine Surface` and layers with `Recombine`, set \
                 `Mesh.SubdivisionAlgorithm = 0`, and mesh the volumes again (`gmsh -3`)"
            }
            _ => "mesh plane surfaces by triangles, or volumes by tetrahedra",
        }
    }
}

impl fmt::Display for ElementKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let order = if self.is_linear() || self.shape().starts_with("element") { "" } else { " of higher order" };
        let article = if self.shape().starts_with('e') { "an" } else { "a" };
        write!(f, "{article} {}{order} (Gmsh's type {})", self.shape(), self.0)
    }
}
