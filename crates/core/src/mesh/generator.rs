//! Uniform bars, rectangles and discs.

use super::{ElementGroups, FaceGroups, Mesh, MeshError, room};

/// A length that must be positive and finite.
pub(super) fn positive(name: &'static str, value: f64) -> Result<(), MeshError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(MeshError::Generator { name, value, allowed: "a positive length in metres" })
}

/// Most elements along a side. Fuzzing allows few: a short text may ask for a large mesh.
const MOST: usize = if cfg!(fuzzing) { 30 } else { 20_000_000 };

/// A number of elements that must be positive and fit into memory.
pub(super) fn count(name: &'static str, value: usize) -> Result<(), MeshError> {
    if (1..=MOST).contains(&value) {
        return Ok(());
    }
    Err(MeshError::Generator { name, value: value as f64, allowed: "a number of elements from 1 to 20 000 000" })
}

impl Mesh {
    /// A bar from 0 to `length` (m) in `elements` equal elements; its end points are the groups
    /// `start` (at 0) and `end`.
    ///
    /// # Errors
    /// A length that is not positive, or no elements.
    pub fn uniform_bar(length: f64, elements: usize) -> Result<Self, MeshError> {
        positive("length", length)?;
        count("elements", elements)?;
        room(elements)?;
        let points = (0..=elements).map(|i| [length * i as f64 / elements as f64]).collect();
        let cells: Vec<_> = (0..elements).map(|e| [e, e + 1]).collect();
        let groups = FaceGroups::from([("start".to_string(), vec![[0]]), ("end".to_string(), vec![[elements]])]);
        Self::new(points, &cells, &groups, &ElementGroups::new())
    }
}

/// The diagonals by which the cells of a rectangle are cut.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Diagonals {
    /// From the lower left to the upper right corner of each cell. Diagonals of one direction push a symmetric body
    /// aside.
    #[default]
    Right,
    /// In turn from the lower left and from the upper left corner. Symmetric if both numbers of cells are even.
    Alternating,
    /// Both: four triangles around the middle of each cell. Symmetric.
    Crossed,
}

impl Diagonals {
    /// All, by their names.
    pub const NAMES: [(&str, Self); 3] =
        [("right", Self::Right), ("alternating", Self::Alternating), ("crossed", Self::Crossed)];

    /// Those of a name; none if it is not known.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::NAMES.into_iter().find(|(known, _)| *known == name).map(|(_, diagonals)| diagonals)
    }

    /// The number of triangles in a cell.
    fn triangles(self) -> usize {
        if self == Self::Crossed { 4 } else { 2 }
    }
}

impl Mesh {
    /// The rectangle [0, width] × [0, height] (m) in nx × ny cells, each cut from its lower left
    /// to its upper right corner; its sides are the groups `left`, `right`, `bottom`, `top`.
    ///
    /// # Errors
    /// A length that is not positive, or no cells.
    pub fn rectangle(width: f64, height: f64, nx: usize, ny: usize) -> Result<Self, MeshError> {
        Self::rectangle_cut(width, height, nx, ny, Diagonals::Right)
    }

    /// The same with a choice of diagonals. The middles of crossed cells are the last nodes.
    ///
    /// # Errors
    /// A length that is not positive, or no cells.
    pub fn rectangle_cut(
        width: f64,
        height: f64,
        nx: usize,
        ny: usize,
        diagonals: Diagonals,
    ) -> Result<Self, MeshError> {
        positive("width", width)?;
        positive("height", height)?;
        count("nx", nx)?;
        count("ny", ny)?;
        count("nx * ny", nx.saturating_mul(ny))?;
        let elements = diagonals.triangles() * nx * ny;
        if diagonals == Diagonals::Crossed {
            count("4 * nx * ny", elements)?;
        }
        room(elements)?;
        let id = |i: usize, j: usize| j * (nx + 1) + i;
        let mut points = Vec::with_capacity((nx + 1) * (ny + 1));
        for j in 0..=ny {
            for i in 0..=nx {
                points.push([width * i as f64 / nx as f64, height * j as f64 / ny as f64]);
            }
        }
        let mut cells = Vec::with_capacity(elements);
        for j in 0..ny {
            for i in 0..nx {
                let corners = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
                let [a, b, c, d] = corners;
                match diagonals {
                    Diagonals::Alternating if (i + j) % 2 == 1 => cells.extend([[a, b, d], [b, c, d]]),
                    Diagonals::Right | Diagonals::Alternating => cells.extend([[a, b, c], [a, c, d]]),
                    Diagonals::Crossed => {
                        let [low, high] = [points[a], points[c]];
                        let middle = points.len();
                        points.push([0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])]);
                        cells.extend((0..4).map(|k| [corners[k], corners[(k + 1) % 4], middle]));
                    }
                }
            }
        }
        let groups = FaceGroups::from([
            ("bottom".to_string(), (0..nx).map(|i| [id(i, 0), id(i + 1, 0)]).collect()),
            ("top".to_string(), (0..nx).map(|i| [id(i, ny), id(i + 1, ny)]).collect()),
            ("left".to_string(), (0..ny).map(|j| [id(0, j), id(0, j + 1)]).collect()),
            ("right".to_string(), (0..ny).map(|j| [id(nx, j), id(nx, j + 1)]).collect()),
        ]);
        Self::new(points, &cells, &groups, &ElementGroups::new())
    }

    /// A disc of this radius (m) around the origin, in `rings` rings: 6 rings² triangles of nearly one size, on 6 k
    /// equal arcs around ring k. Its outline, which starts at the lowest point, is the group `boundary`.
    ///
    /// # Errors
    /// A radius that is not positive, or no rings.
    pub fn disc(radius: f64, rings: usize) -> Result<Self, MeshError> {
        positive("radius", radius)?;
        // 1825 rings have 20 million triangles.
        if !(1..=1825).contains(&rings) {
            return Err(MeshError::Generator {
                name: "rings",
                value: rings as f64,
                allowed: "a number of rings from 1 to 1825",
            });
        }
        room(6 * rings * rings)?;
        let first = |k: usize| if k == 0 { 0 } else { 3 * k * (k - 1) + 1 };
        let id = |k: usize, j: usize| if k == 0 { 0 } else { first(k) + j % (6 * k) };
        let mut points = vec![[0.0, 0.0]];
        for k in 1..=rings {
            let ring = radius * k as f64 / rings as f64;
            points.extend((0..6 * k).map(|j| {
                let angle = std::f64::consts::TAU * j as f64 / (6 * k) as f64;
                [ring * angle.sin(), -ring * angle.cos()]
            }));
        }
        let mut cells = Vec::with_capacity(6 * rings * rings);
        for k in 1..=rings {
            for sextant in 0..6 {
                let (inner, outer) = (sextant * (k - 1), sextant * k);
                for j in 0..k {
                    cells.push([id(k - 1, inner + j), id(k, outer + j), id(k, outer + j + 1)]);
                    if j + 1 < k {
                        cells.push([id(k - 1, inner + j), id(k, outer + j + 1), id(k - 1, inner + j + 1)]);
                    }
                }
            }
        }
        let outline = (0..6 * rings).map(|j| [id(rings, j), id(rings, j + 1)]).collect();
        let groups = FaceGroups::from([("boundary".to_string(), outline)]);
        Self::new(points, &cells, &groups, &ElementGroups::new())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ids::ElementId;

    fn area(mesh: &Mesh) -> f64 {
        (0..mesh.element_count()).map(|e| mesh.volume(ElementId::new(e))).sum()
    }

    /// The triangles by the places of their nodes, each in order, of the mesh or of its image x ↦ 3 − x.
    fn triangles(mesh: &Mesh, mirrored: bool) -> Vec<[[u64; 2]; 3]> {
        let place = |p: [f64; 2]| [if mirrored { 3.0 - p[0] } else { p[0] }, p[1]].map(f64::to_bits);
        let mut found: Vec<_> =
            mesh.nodes_of::<3>().iter().map(|cell| cell.map(|k| place(mesh.points_in()[k.index()]))).collect();
        found.iter_mut().for_each(|triangle| triangle.sort_unstable());
        found.sort_unstable();
        found
    }

    /// All coordinates are multiples of 3/8 and exact, so that mirror images have the same bits.
    #[test]
    fn rectangles_are_cut_by_each_diagonal() {
        let cut = |diagonals| Mesh::rectangle_cut(3.0, 2.0, 4, 2, diagonals).unwrap();
        for (name, diagonals) in Diagonals::NAMES {
            let (mesh, count) = (cut(diagonals), if diagonals == Diagonals::Crossed { 32 } else { 16 });
            assert_eq!((mesh.element_count(), mesh.reoriented_elements()), (count, 0), "{name}");
            assert!((area(&mesh) - 6.0).abs() < 1e-14, "{name}: rounding of a sum of 32 terms");
            let symmetric = triangles(&mesh, false) == triangles(&mesh, true);
            assert_eq!(symmetric, diagonals != Diagonals::Right, "{name}");
            // The corners of the cells, and so the sides, have the same numbers with all diagonals.
            assert_eq!(mesh.points()[..30], cut(Diagonals::Right).points()[..], "{name}");
        }
        let many = Mesh::rectangle_cut(1.0, 1.0, 6_000_000, 1, Diagonals::Crossed).unwrap_err();
        assert!(many.to_string().contains("4 * nx * ny"), "{many}");
    }

    /// The disc has the area of its regular outline of 6 n sides, ½ 6n r² sin(2π/6n); its lowest node lies at (0, −r)
    /// exactly, and each node has its mirror image.
    #[test]
    fn a_disc_is_a_regular_polygon() {
        for rings in [1, 2, 7] {
            let disc = Mesh::disc(0.5, rings).unwrap();
            assert_eq!((disc.element_count(), disc.node_count()), (6 * rings * rings, 3 * rings * (rings + 1) + 1));
            assert_eq!((disc.reoriented_elements(), disc.face_groups()["boundary"].len()), (0, 6 * rings));
            let area = area(&disc);
            let sides = 6.0 * rings as f64;
            let exact = 0.5 * sides * 0.25 * (std::f64::consts::TAU / sides).sin();
            // Rounding of a sum of at most 300 terms.
            assert!((area - exact).abs() < 1e-13 * exact, "{area} {exact}");
            assert_eq!(disc.points_in::<2>().iter().filter(|p| **p == [0.0, -0.5]).count(), 1);
            for p in disc.points_in::<2>() {
                let image = |q: &&[f64; 2]| (q[0] + p[0]).abs() + (q[1] - p[1]).abs() < 1e-15;
                assert_eq!(disc.points_in::<2>().iter().filter(image).count(), 1, "{p:?}");
            }
        }
    }
}
