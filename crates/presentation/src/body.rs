//! A mesh to draw.

use percute_core::ids::NodeId;
use percute_core::mesh::Mesh;
use std::collections::{BTreeMap, HashSet};

/// A mesh in the plane; a bar lies on the axis x.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// 1 (bars) or 2 (triangles).
    pub(crate) dimension: usize,
    /// Coordinates of the nodes (m).
    pub(crate) points: Vec<[f64; 2]>,
    /// For each node the first node of its part; parts have no common nodes.
    pub(crate) part: Vec<usize>,
    /// Nodes of the elements, one element after the other.
    cells: Vec<usize>,
    /// Names of the groups of edges and of elements, and their members.
    pub(crate) groups: [Vec<(String, usize)>; 2],
}

impl Body {
    /// That of a mesh.
    #[must_use]
    pub fn new(mesh: &Mesh) -> Self {
        let faces = mesh.face_groups().iter().map(|(name, members)| (name.clone(), members.len()));
        let elements = mesh.element_groups().iter().map(|(name, members)| (name.clone(), members.len()));
        Self {
            dimension: mesh.dimension(),
            points: mesh.places().map(|[x, y, _]| [x, y]).collect(),
            part: mesh.part_of_nodes().into_iter().map(NodeId::index).collect(),
            cells: mesh.cells().flatten().copied().map(NodeId::index).collect(),
            groups: [faces.collect(), elements.collect()],
        }
    }

    /// Number of elements.
    pub(crate) fn elements(&self) -> usize {
        self.cells.len() / (self.dimension + 1)
    }

    /// Corners of an element (m).
    pub(crate) fn corners(&self, element: usize) -> impl Iterator<Item = [f64; 2]> {
        let count = self.dimension + 1;
        self.cells[element * count..(element + 1) * count].iter().map(|&node| self.points[node])
    }

    /// Corners of the bounding box (m).
    pub(crate) fn bounds(&self) -> [[f64; 2]; 2] {
        let extreme = |pick: fn(f64, f64) -> f64| {
            [0, 1].map(|c| self.points.iter().map(|p| p[c]).reduce(pick).unwrap_or_default())
        };
        [extreme(f64::min), extreme(f64::max)]
    }

    /// The lines around the body and its holes, counterclockwise and clockwise, each with its first node at the end
    /// again; none of a bar or a solid.
    #[must_use]
    pub fn outline(&self) -> Vec<Vec<usize>> {
        if self.dimension != 2 {
            return Vec::new();
        }
        let sides = self.cells.chunks_exact(3).flat_map(|c| [[c[0], c[1]], [c[1], c[2]], [c[2], c[0]]]);
        let all: HashSet<[usize; 2]> = sides.collect();
        // The two elements at an inner edge go along it in opposite directions.
        let mut after: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        all.iter().filter(|[a, b]| !all.contains(&[*b, *a])).for_each(|&[a, b]| after.entry(a).or_default().push(b));
        after.values_mut().for_each(|next| next.sort_unstable());
        let mut lines = Vec::new();
        while let Some(&start) = after.keys().next() {
            let mut line = vec![start];
            while let Some(next) = after.get_mut(&line[line.len() - 1]) {
                let node = next.pop();
                if next.is_empty() {
                    after.remove(&line[line.len() - 1]);
                }
                line.extend(node);
            }
            lines.push(line);
        }
        lines
    }

    /// Mean edge of a square with the area of an element (m), of a bar its mean length.
    pub(crate) fn mean_size(&self) -> f64 {
        let size = |e: usize| {
            let c: Vec<[f64; 2]> = self.corners(e).collect();
            let side = |k: usize| [c[k][0] - c[0][0], c[k][1] - c[0][1]];
            if self.dimension == 1 {
                return side(1)[0].abs();
            }
            let (a, b) = (side(1), side(2));
            0.5 * (a[0] * b[1] - a[1] * b[0]).abs()
        };
        let mean = (0..self.elements()).map(size).sum::<f64>() / self.elements().max(1) as f64;
        if self.dimension == 1 { mean } else { mean.sqrt() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::mesh::Mesh;

    #[test]
    fn the_outline_goes_around_the_body_and_its_hole() {
        // A ring: an outer and an inner square, two triangles at each side.
        let outer = [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0]];
        let inner = [[1.0, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0]];
        let cells: Vec<[usize; 3]> =
            (0..4).flat_map(|k| [[k, (k + 1) % 4, 4 + k], [(k + 1) % 4, 4 + (k + 1) % 4, 4 + k]]).collect();
        let mesh = Mesh::new([outer, inner].concat(), &cells, &Default::default(), &Default::default());
        assert_eq!(Body::new(&mesh.unwrap()).outline(), [vec![0, 1, 2, 3, 0], vec![4, 7, 6, 5, 4]]);
        assert!(Body::new(&Mesh::uniform_bar(1.0, 3).unwrap()).outline().is_empty());
    }
}
