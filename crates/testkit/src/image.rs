//! Images of meshes under motions, and the same mesh under other numbers.

use crate::Random;
use percute_core::mesh::{ElementGroups, FaceGroups, Mesh, MeshError};

/// Arguments of [`Mesh::new`].
struct Parts<const D: usize, const N: usize> {
    points: Vec<[f64; D]>,
    cells: Vec<[usize; N]>,
    face_groups: FaceGroups<D>,
    element_groups: ElementGroups,
}

impl<const D: usize, const N: usize> Parts<D, N> {
    fn of(mesh: &Mesh) -> Self {
        let face_groups = mesh.face_groups().iter().map(|(name, faces)| {
            (name.clone(), faces.iter().map(|f| mesh.face_nodes::<D>(*f).map(|n| n.index())).collect())
        });
        let element_groups = mesh
            .element_groups()
            .iter()
            .map(|(name, elements)| (name.clone(), elements.iter().map(|e| e.index()).collect()));
        Self {
            points: mesh.points_in().to_vec(),
            cells: mesh.nodes_of::<N>().iter().map(|cell| cell.map(|n| n.index())).collect(),
            face_groups: face_groups.collect(),
            element_groups: element_groups.collect(),
        }
    }

    fn mesh(self) -> Result<Mesh, MeshError> {
        Mesh::new(self.points, &self.cells, &self.face_groups, &self.element_groups)
    }
}

/// The mesh turned about the origin by `angle` (rad); numbers and groups are kept.
///
/// # Errors
/// None beyond those of the mesh.
pub fn rotated(mesh: &Mesh, angle: f64) -> Result<Mesh, MeshError> {
    let (sin, cos) = angle.sin_cos();
    mesh.mapped(|p: &[f64; 2]| [cos * p[0] - sin * p[1], sin * p[0] + cos * p[1]])
}

/// The mesh seen in a mirror, x → −x; numbers and groups are kept.
///
/// # Errors
/// None beyond those of the mesh.
pub fn mirrored(mesh: &Mesh) -> Result<Mesh, MeshError> {
    mirror(mesh, 0)
}

/// The mesh seen in a mirror, y → −y; numbers and groups are kept.
///
/// # Errors
/// None beyond those of the mesh.
pub fn upside_down(mesh: &Mesh) -> Result<Mesh, MeshError> {
    mirror(mesh, 1)
}

fn mirror(mesh: &Mesh, axis: usize) -> Result<Mesh, MeshError> {
    let mut parts = Parts::<2, 3>::of(mesh);
    parts.points.iter_mut().for_each(|p| p[axis] = -p[axis]);
    // The mirror reverses the orientation; the core would reorient the elements and count them.
    parts.cells.iter_mut().for_each(|cell| cell.swap(1, 2));
    parts.mesh()
}

/// The mesh of a half at x ≥ 0 and its mirror image, joined where x = 0. The numbers of the half are kept. Faces at
/// x = 0 leave their groups; the image of `right` is `left`.
///
/// # Errors
/// None beyond those of the mesh.
pub(crate) fn doubled(half: &Mesh) -> Result<Mesh, MeshError> {
    let mut parts = Parts::<2, 3>::of(half);
    let image: Vec<usize> = (0..half.node_count())
        .map(|node| {
            let [x, y] = half.points_in()[node];
            if x == 0.0 {
                return node;
            }
            parts.points.push([-x, y]);
            parts.points.len() - 1
        })
        .collect();
    let count = parts.cells.len();
    parts.cells.extend_from_within(..);
    parts.cells[count..].iter_mut().for_each(|cell| *cell = [cell[0], cell[2], cell[1]].map(|node| image[node]));
    for (name, faces) in std::mem::take(&mut parts.face_groups) {
        let away = |face: &[usize; 2]| face.iter().any(|&node| image[node] != node);
        let faces: Vec<[usize; 2]> = faces.into_iter().filter(away).collect();
        let images: Vec<[usize; 2]> = faces.iter().map(|face| face.map(|node| image[node])).collect();
        let other = match name.as_str() {
            "left" => "right",
            "right" => "left",
            same => same,
        };
        for (name, faces) in [(other.to_string(), images), (name, faces)].into_iter().filter(|(_, f)| !f.is_empty()) {
            parts.face_groups.entry(name).or_default().extend(faces);
        }
    }
    for elements in parts.element_groups.values_mut() {
        let images: Vec<usize> = elements.iter().map(|element| element + count).collect();
        elements.extend(images);
    }
    parts.mesh()
}

/// The mesh moved by `by` (m); numbers and groups are kept.
///
/// # Errors
/// None beyond those of the mesh, unless `by` is not finite.
pub fn translated<const D: usize>(mesh: &Mesh, by: [f64; D]) -> Result<Mesh, MeshError> {
    mesh.mapped(|p: &[f64; D]| std::array::from_fn(|c| p[c] + by[c]))
}

/// New numbers of nodes and elements.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Renumbering {
    /// New number of each node, by its old one.
    pub node: Vec<usize>,
    /// New number of each element, by its old one.
    pub element: Vec<usize>,
}

impl Renumbering {
    /// A nodal field in the new order.
    #[must_use]
    pub fn nodal<T: Copy>(&self, field: &[T]) -> Vec<T> {
        permuted(&self.node, field)
    }

    /// A value of each element in the new order.
    #[must_use]
    pub fn elemental<T: Copy>(&self, values: &[T]) -> Vec<T> {
        permuted(&self.element, values)
    }
}

/// `values` with entry i at place `new[i]`.
fn permuted<T: Copy>(new: &[usize], values: &[T]) -> Vec<T> {
    let mut order: Vec<usize> = (0..new.len()).collect();
    order.sort_unstable_by_key(|&i| new[i]);
    order.into_iter().map(|i| values[i]).collect()
}

/// The mesh with its nodes and elements in random order; groups name the same faces and
/// elements as before. Each element also starts at another of its nodes.
///
/// # Errors
/// None beyond those of the mesh.
pub fn renumbered(mesh: &Mesh, seed: u64) -> Result<(Mesh, Renumbering), MeshError> {
    match mesh.dimension() {
        1 => renumbered_in::<1, 2>(mesh, seed),
        _ => renumbered_in::<2, 3>(mesh, seed),
    }
}

fn renumbered_in<const D: usize, const N: usize>(mesh: &Mesh, seed: u64) -> Result<(Mesh, Renumbering), MeshError> {
    let mut random = Random::new(seed);
    let node = random.permutation(mesh.node_count());
    let element = random.permutation(mesh.element_count());
    let mut parts = Parts::<D, N>::of(mesh);
    for cell in &mut parts.cells {
        *cell = cell.map(|n| node[n]);
        if N % 2 == 1 {
            // A rotation of an odd number of nodes keeps the orientation.
            cell.rotate_left((random.bits() % N as u64) as usize);
        }
    }
    parts.cells = permuted(&element, &parts.cells);
    parts.points = permuted(&node, &parts.points);
    parts.face_groups.values_mut().flatten().for_each(|face| *face = face.map(|n| node[n]));
    parts.element_groups.values_mut().flatten().for_each(|e| *e = element[*e]);
    Ok((parts.mesh()?, Renumbering { node, element }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{disc, random_rectangle};
    use percute_core::ids::{ElementId, NodeId};

    /// A mesh with both kinds of groups.
    fn grouped() -> Mesh {
        let mut parts = Parts::<2, 3>::of(&random_rectangle(2.0, 1.0, 5, 9).unwrap());
        parts.element_groups.insert("some".to_string(), vec![0, 3, 7]);
        parts.mesh().unwrap()
    }

    /// Total of a function of the outward normals over a group, weighted with lengths.
    fn normals(mesh: &Mesh, group: &str) -> [f64; 2] {
        mesh.face_groups()[group]
            .iter()
            .map(|&f| mesh.normal_in::<2>(f))
            .fold([0.0; 2], |sum, (n, length)| [sum[0] + n[0] * length, sum[1] + n[1] * length])
    }

    /// Lengths are of order 1, so that 1e-13 is rounding of a few operations.
    fn close(a: [f64; 2], b: [f64; 2]) -> bool {
        (a[0] - b[0]).abs() < 1e-13 && (a[1] - b[1]).abs() < 1e-13
    }

    /// The bottom of the rectangle, with −2 e_y for its normals, turns to +2 e_x by a quarter.
    #[test]
    fn a_quarter_turn() {
        let mesh = grouped();
        let image = rotated(&mesh, std::f64::consts::FRAC_PI_2).unwrap();
        for (p, q) in mesh.points_in::<2>().iter().zip(image.points_in()) {
            assert!(close(*q, [-p[1], p[0]]));
        }
        assert!(close(normals(&mesh, "bottom"), [0.0, -2.0]));
        assert!(close(normals(&image, "bottom"), [2.0, 0.0]));
        assert_eq!((image.reoriented_elements(), image.cell_rows()), (0, mesh.cell_rows()));
        assert_eq!(image.element_groups(), mesh.element_groups());
    }

    #[test]
    fn a_mirror_image_needs_no_mending() {
        let mesh = grouped();
        let image = mirrored(&mesh).unwrap();
        assert_eq!(image.reoriented_elements(), 0);
        assert!(close(normals(&mesh, "left"), [-1.0, 0.0]));
        assert!(close(normals(&image, "left"), [1.0, 0.0]));
        assert_eq!(mirrored(&image).unwrap().points(), mesh.points());
    }

    #[test]
    fn a_translation() {
        let mesh = disc(1.0, 0.4).unwrap();
        let image = translated(&mesh, [3.0, -2.0]).unwrap();
        for (p, q) in mesh.points_in::<2>().iter().zip(image.points_in()) {
            assert!(close(*q, [p[0] + 3.0, p[1] - 2.0]));
        }
        assert_eq!(image.face_groups(), mesh.face_groups());
    }

    /// Under its new number each node is where it was, each element has the same corners, and
    /// groups hold the same faces and elements.
    #[test]
    fn renumbering_moves_nothing() {
        let mesh = grouped();
        let (image, new) = renumbered(&mesh, 4).unwrap();
        assert_ne!(new.node, (0..mesh.node_count()).collect::<Vec<_>>());
        assert_eq!(new.nodal(mesh.points_in::<2>()), image.points_in());
        assert_eq!(image.reoriented_elements(), 0);
        for old in 0..mesh.element_count() {
            let mut expected: Vec<usize> = mesh.nodes_of::<3>()[old].iter().map(|n| new.node[n.index()]).collect();
            let mut found: Vec<usize> = image.nodes_of::<3>()[new.element[old]].iter().map(|n| n.index()).collect();
            expected.sort_unstable();
            found.sort_unstable();
            assert_eq!(expected, found);
        }
        for group in ["left", "right", "bottom", "top"] {
            assert!(close(normals(&mesh, group), normals(&image, group)), "{group}");
        }
        let centre =
            |mesh: &Mesh, e: &ElementId| mesh.corners::<2, 3>(*e).iter().map(|p| p[0] + 10.0 * p[1]).sum::<f64>();
        let total = |mesh: &Mesh| mesh.element_groups()["some"].iter().map(|e| centre(mesh, e)).sum::<f64>();
        // Sums of nine coordinates of order 10, in another order.
        assert!((total(&mesh) - total(&image)).abs() < 1e-12);
    }

    #[test]
    fn bars_can_be_renumbered() {
        let mesh = Mesh::uniform_bar(1.0, 7).unwrap();
        let (image, new) = renumbered(&mesh, 1).unwrap();
        assert_eq!(image.reoriented_elements(), 0);
        let end = image.face(image.face_groups()["end"][0]).nodes[0];
        assert_eq!((end, image.points()[end.index()]), (NodeId::new(new.node[7]), 1.0));
    }
}
