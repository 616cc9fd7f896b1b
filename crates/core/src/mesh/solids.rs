//! Boxes, cylinders and balls of tetrahedra.

use super::generator::{count, positive};
use super::{ElementGroups, FaceGroups, Mesh, MeshError, room};
use std::collections::BTreeMap;

/// The six tetrahedra of a cell around its diagonal from the lowest to the highest corner (Kuhn): bit c of a corner is
/// its place along axis c. Cells beside each other have the same diagonals on their common face.
const KUHN: [[usize; 4]; 6] = [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];

/// The twelve corners of an icosahedron with corners at the top and the bottom, on the sphere of radius 1.
fn icosahedron() -> [[f64; 3]; 12] {
    let (height, wide) = (1.0 / 5.0_f64.sqrt(), 2.0 / 5.0_f64.sqrt());
    std::array::from_fn(|k| match k {
        0 => [0.0, 0.0, -1.0],
        11 => [0.0, 0.0, 1.0],
        _ => {
            let (upper, turn) = (k > 5, std::f64::consts::TAU / 10.0);
            let angle = turn * (2 * ((k - 1) % 5) + usize::from(upper)) as f64;
            [wide * angle.cos(), wide * angle.sin(), if upper { height } else { -height }]
        }
    })
}

/// Its twenty triangles, the nodes of each ascending.
fn icosahedron_faces() -> Vec<[usize; 3]> {
    let (low, high) = (|k: usize| 1 + k % 5, |k: usize| 6 + k % 5);
    let around = |k: usize| {
        [
            [0, low(k), low(k + 1)],
            [low(k), low(k + 1), high(k)],
            [low(k + 1), high(k), high(k + 1)],
            [high(k), high(k + 1), 11],
        ]
    };
    let mut faces: Vec<[usize; 3]> = (0..5).flat_map(around).collect();
    faces.iter_mut().for_each(|face| face.sort_unstable());
    faces
}

/// WeightedNodes that are made where they are first asked for.
struct WeightedNodes {
    /// By the weights of corners, each with the number of the corner.
    known: BTreeMap<Vec<(usize, usize)>, usize>,
    points: Vec<[f64; 3]>,
}

impl WeightedNodes {
    /// The node with these weights, at a place that is worked out for a new one.
    fn at(&mut self, weights: [(usize, usize); 3], place: impl FnOnce(&[(usize, usize)]) -> [f64; 3]) -> usize {
        let mut key: Vec<(usize, usize)> = weights.into_iter().filter(|(_, weight)| *weight > 0).collect();
        key.sort_unstable();
        if let Some(node) = self.known.get(&key) {
            return *node;
        }
        let node = self.points.len();
        self.points.push(place(&key));
        self.known.insert(key, node);
        node
    }
}

/// The faces of elements all of whose nodes are on a side, by the name of the side; bit k of `sides` of a node says
/// that it is on side k.
fn on_sides(cells: &[[usize; 4]], sides: &[u8], names: &[&str]) -> FaceGroups<3> {
    let mut groups: FaceGroups<3> = names.iter().map(|name| ((*name).to_string(), Vec::new())).collect();
    for cell in cells {
        for opposite in 0..4 {
            let face = [1, 2, 3].map(|k| cell[(opposite + k) % 4]);
            let common = face.iter().fold(u8::MAX, |common, &node| common & sides[node]);
            for (_, name) in names.iter().enumerate().filter(|(k, _)| common >> k & 1 == 1) {
                groups.entry((*name).to_string()).or_default().push(face);
            }
        }
    }
    groups
}

impl Mesh {
    /// The box [0, a] × [0, b] × [0, c] (m) in so many cells along the axes, of six tetrahedra each; its sides are the
    /// groups `left` and `right` (x), `front` and `back` (y), `bottom` and `top` (z).
    ///
    /// # Errors
    /// A length that is not positive, or no cells.
    pub fn cuboid(size: [f64; 3], cells: [usize; 3]) -> Result<Self, MeshError> {
        size.into_iter().try_for_each(|length| positive("size", length))?;
        cells.into_iter().try_for_each(|cells| count("cells", cells))?;
        let elements = cells.into_iter().fold(6, usize::saturating_mul);
        count("6 * cells", elements)?;
        room(elements)?;
        let [nx, ny, nz] = cells;
        let id = |[i, j, k]: [usize; 3]| (k * (ny + 1) + j) * (nx + 1) + i;
        let (mut points, mut sides) = (Vec::new(), Vec::new());
        for k in 0..=nz {
            for j in 0..=ny {
                for at in (0..=nx).map(|i| [i, j, k]) {
                    points.push(std::array::from_fn(|c| size[c] * at[c] as f64 / cells[c] as f64));
                    let bits = |c: usize| u8::from(at[c] == 0) << (2 * c) | u8::from(at[c] == cells[c]) << (2 * c + 1);
                    sides.push(bits(0) | bits(1) | bits(2));
                }
            }
        }
        let mut tetrahedra = Vec::with_capacity(elements);
        for k in 0..nz {
            for j in 0..ny {
                for i in 0..nx {
                    let corner = |bits: usize| id([i + (bits & 1), j + (bits >> 1 & 1), k + (bits >> 2)]);
                    tetrahedra.extend(KUHN.map(|cell| cell.map(corner)));
                }
            }
        }
        let groups = on_sides(&tetrahedra, &sides, &["left", "right", "front", "back", "bottom", "top"]);
        Self::new(points, &tetrahedra, &groups, &ElementGroups::new())
    }

    /// A cylinder of this radius and height (m) on the plane z = 0 around the axis z: [`Mesh::disc`] with so many
    /// rings, in so many layers. Its surface is the groups `bottom`, `top` and `side`.
    ///
    /// # Errors
    /// A length that is not positive, no rings or no layers.
    pub fn cylinder(radius: f64, height: f64, rings: usize, layers: usize) -> Result<Self, MeshError> {
        positive("height", height)?;
        count("layers", layers)?;
        let disc = Self::disc(radius, rings)?;
        let elements = (3 * disc.element_count()).saturating_mul(layers);
        count("18 * rings² * layers", elements)?;
        room(elements)?;
        let (base, outer) = (disc.points_in::<2>(), disc.node_count() - 6 * rings);
        let (mut points, mut sides) = (Vec::new(), Vec::new());
        for layer in 0..=layers {
            let z = height * layer as f64 / layers as f64;
            points.extend(base.iter().map(|[x, y]| [*x, *y, z]));
            let ends = u8::from(layer == 0) | u8::from(layer == layers) << 1;
            sides.extend((0..base.len()).map(|node| ends | u8::from(node >= outer) << 2));
        }
        let mut tetrahedra = Vec::with_capacity(elements);
        for layer in 0..layers {
            for cell in disc.nodes_of::<3>() {
                let mut low = cell.map(|node| layer * base.len() + node.index());
                // Diagonals go from the lower of two nodes up: those of prisms beside each other are the same.
                low.sort_unstable();
                let ([a, b, c], [d, e, f]) = (low, low.map(|node| node + base.len()));
                tetrahedra.extend([[a, b, c, f], [a, b, e, f], [a, d, e, f]].map(|cell| oriented(&points, cell)));
            }
        }
        let groups = on_sides(&tetrahedra, &sides, &["bottom", "top", "side"]);
        Self::new(points, &tetrahedra, &groups, &ElementGroups::new())
    }

    /// A ball of this radius (m) around the origin: an icosahedron in so many rings, which become spheres, of 20 rings³
    /// tetrahedra. Its lowest node is at z = −radius; its surface is the group `boundary`.
    ///
    /// # Errors
    /// A radius that is not positive, or no rings.
    pub fn ball(radius: f64, rings: usize) -> Result<Self, MeshError> {
        positive("radius", radius)?;
        // 100 rings have 20 million tetrahedra.
        if !(1..=100).contains(&rings) {
            let allowed = "a number of rings from 1 to 100";
            return Err(MeshError::Generator { name: "rings", value: rings as f64, allowed });
        }
        let elements = 20 * rings.pow(3);
        room(elements)?;
        let corners = icosahedron();
        let mut nodes = WeightedNodes { known: BTreeMap::new(), points: Vec::new() };
        let place = |weights: &[(usize, usize)]| {
            let ring: usize = weights.iter().map(|(_, weight)| weight).sum();
            let sum: [f64; 3] = std::array::from_fn(|c| {
                weights.iter().map(|(corner, weight)| *weight as f64 * corners[*corner][c]).sum()
            });
            let length = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
            let scale = if ring == 0 { 0.0 } else { radius * ring as f64 / rings as f64 / length };
            sum.map(|x| scale * x)
        };
        let mut tetrahedra = Vec::with_capacity(elements);
        for [a, b, c] in icosahedron_faces() {
            // The part i ≥ j ≥ k of a grid of cells is a tetrahedron: from the middle to a, then to b, then to c.
            let mut node = |[i, j, k]: [usize; 3]| nodes.at([(a, i - j), (b, j - k), (c, k)], place);
            for i in 0..rings {
                for j in 0..=i {
                    for k in 0..=j {
                        for cell in KUHN {
                            let at = cell.map(|bits| [i + (bits & 1), j + (bits >> 1 & 1), k + (bits >> 2)]);
                            if at.iter().all(|[i, j, k]| i >= j && j >= k) {
                                tetrahedra.push(at.map(&mut node));
                            }
                        }
                    }
                }
            }
        }
        let outer = |key: &Vec<(usize, usize)>| key.iter().map(|(_, weight)| weight).sum::<usize>() == rings;
        let mut sides = vec![0; nodes.points.len()];
        nodes.known.iter().filter(|(key, _)| outer(key)).for_each(|(_, node)| sides[*node] = 1);
        let tetrahedra: Vec<_> = tetrahedra.into_iter().map(|cell| oriented(&nodes.points, cell)).collect();
        let groups = on_sides(&tetrahedra, &sides, &["boundary"]);
        Self::new(nodes.points, &tetrahedra, &groups, &ElementGroups::new())
    }
}

/// The same tetrahedron, positively oriented.
fn oriented(points: &[[f64; 3]], cell: [usize; 4]) -> [usize; 4] {
    let corners = cell.map(|node| points[node]);
    let [a, b, c, d] = cell;
    if crate::cell::cell::<3, 4>().signed_volume(&corners) < 0.0 { [a, b, d, c] } else { cell }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    fn volume(mesh: &Mesh) -> f64 {
        mesh.volumes().iter().sum()
    }

    fn area(mesh: &Mesh, group: &str) -> f64 {
        mesh.face_groups()[group].iter().map(|face| mesh.face_normal(*face).1).sum()
    }

    /// Volume and sides of a box; the groups hold the whole boundary.
    #[test]
    fn a_box_has_six_sides() {
        let mesh = Mesh::cuboid([2.0, 3.0, 5.0], [2, 3, 4]).unwrap();
        assert_eq!((mesh.element_count(), mesh.node_count(), mesh.reoriented_elements()), (144, 60, 0));
        // Rounding of sums of some 100 terms.
        assert!((volume(&mesh) - 30.0).abs() < 1e-12);
        let sides = [("left", 15.0), ("right", 15.0), ("front", 10.0), ("back", 10.0), ("bottom", 6.0), ("top", 6.0)];
        for (side, expected) in sides {
            assert!((area(&mesh, side) - expected).abs() < 1e-12, "{side}");
        }
        let all: usize = mesh.face_groups().values().map(Vec::len).sum();
        assert_eq!(all, mesh.boundary().count());
    }

    /// The cylinder on the regular polygon of 6 n sides.
    #[test]
    fn a_cylinder_is_a_prism() {
        for rings in [1, 3] {
            let mesh = Mesh::cylinder(0.5, 2.0, rings, 2).unwrap();
            assert_eq!((mesh.element_count(), mesh.reoriented_elements()), (36 * rings * rings, 0));
            let sides = 6.0 * rings as f64;
            let base = 0.5 * sides * 0.25 * (TAU / sides).sin();
            assert!((volume(&mesh) - 2.0 * base).abs() < 1e-12);
            assert!((area(&mesh, "bottom") - base).abs() < 1e-12 && (area(&mesh, "top") - base).abs() < 1e-12);
            assert!((area(&mesh, "side") - 2.0 * sides * (PI / sides).sin()).abs() < 1e-12);
            let all: usize = mesh.face_groups().values().map(Vec::len).sum();
            assert_eq!(all, mesh.boundary().count());
        }
    }

    /// The ball fills its sphere with order 2, has one lowest node, and all elements have the same order of size.
    #[test]
    fn a_ball_is_round() {
        let off = |rings: usize| {
            let mesh = Mesh::ball(0.5, rings).unwrap();
            assert_eq!((mesh.element_count(), mesh.reoriented_elements()), (20 * rings.pow(3), 0));
            assert_eq!(mesh.face_groups()["boundary"].len(), mesh.boundary().count());
            assert_eq!(mesh.points_in::<3>().iter().filter(|p| **p == [0.0, 0.0, -0.5]).count(), 1);
            let volumes = mesh.volumes();
            let ends = volumes.iter().fold([f64::INFINITY, 0.0_f64], |[low, high], v| [low.min(*v), high.max(*v)]);
            assert!(ends[1] < 5.0 * ends[0], "{ends:?}");
            1.0 - volume(&mesh) / (PI / 6.0)
        };
        let [coarse, fine] = [4, 8].map(off);
        assert!(coarse > 0.0 && (3.6..4.2).contains(&(coarse / fine)), "{coarse} {fine}");
    }
}
