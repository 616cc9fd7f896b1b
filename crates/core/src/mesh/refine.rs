//! Nested finer meshes.

use super::{ElementGroups, FaceRows, Mesh, MeshError, Parts, in_kind, room};
use crate::cell::{Child, cell};
use crate::ids::FaceId;

impl Mesh {
    /// The mesh with each element cut by the middles of its edges, a bar into two elements and a triangle into four,
    /// for true errors against a nested mesh.
    ///
    /// Nodes keep their numbers, and the middles of the edges follow in the order of the nodes of these edges; element
    /// e of n new ones each becomes the elements n e to n e + n − 1; groups name the same faces and elements as
    /// before. A polygon stays the polygon it was.
    ///
    /// # Errors
    /// A mesh so fine that middles cannot be told from corners, or with more nodes than there are numbers or more
    /// elements than memory can hold.
    pub fn refined(&self) -> Result<Self, MeshError> {
        in_kind!(self, D, N => self.cut_all::<D, N>())
    }

    fn cut_all<const D: usize, const N: usize>(&self) -> Result<Self, MeshError> {
        let kind = cell::<D, N>();
        let children = kind.children();
        room(self.element_count() * children.len())?;
        let edges = self.edges();
        let mut points = self.points_in::<D>().to_vec();
        let corners = self.points_in::<D>();
        points.extend(
            edges.iter().map(|&[a, b]| -> [f64; D] { std::array::from_fn(|c| 0.5 * (corners[a][c] + corners[b][c])) }),
        );
        let node = |a: usize, b: usize| match edges.binary_search(&[a.min(b), a.max(b)]) {
            Ok(edge) => self.node_count() + edge,
            // A corner: no edge joins a node with itself.
            Err(_) => a,
        };
        let cells = self.nodes_of::<N>().iter().map(|cell| cell.map(|n| n.index()));
        let cells: Vec<_> = cells.flat_map(|cell| cut(cell, children, &node)).collect();
        let face = |face: FaceId| self.face_nodes::<D>(face).map(|n| n.index());
        let faces = self.face_groups.iter().map(|(name, group)| {
            let parts = group.iter().flat_map(|&f| cut(face(f), kind.face_children(), &node));
            (name.clone(), parts.flatten().collect())
        });
        let elements = self.element_groups.iter().map(|(name, group)| {
            let parts = group.iter().flat_map(|e| (0..children.len()).map(|part| children.len() * e.index() + part));
            (name.clone(), parts.collect())
        });
        let (faces, elements): (FaceRows, ElementGroups) = (faces.collect(), elements.collect());
        Self::checked(points, &cells, (&faces, &elements), Parts::MayTouch)
    }

    /// The values at the nodes of [`Mesh::refined`] of a field that is linear in the elements, from its values at the
    /// nodes of this mesh, both in rows.
    #[must_use]
    pub fn prolonged(&self, nodal: &[f64]) -> Vec<f64> {
        let width = nodal.len() / self.node_count();
        let middle = |[a, b]: [usize; 2]| (0..width).map(move |c| 0.5 * (nodal[width * a + c] + nodal[width * b + c]));
        nodal.iter().copied().chain(self.edges().into_iter().flat_map(middle)).collect()
    }

    /// The nodes of each edge, ascending, in ascending order.
    pub(super) fn edges(&self) -> Vec<[usize; 2]> {
        let pairs = (0..self.nodes_of_element()).flat_map(|j| (0..j).map(move |i| (i, j)));
        let edges = self.cells().flat_map(|cell| pairs.clone().map(|(i, j)| [cell[i].index(), cell[j].index()]));
        let mut edges: Vec<_> = edges.map(|[a, b]| [a.min(b), a.max(b)]).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }
}

/// The children of a simplex with these nodes, where `middle` is the node between two others.
fn cut<const M: usize>(
    nodes: [usize; M],
    children: &'static [Child<M>],
    middle: &impl Fn(usize, usize) -> usize,
) -> impl Iterator<Item = [usize; M]> {
    children.iter().map(move |child| child.map(|[i, j]| middle(nodes[i], nodes[j])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ids::ElementId;
    use crate::mesh::FaceGroups;

    /// Each of the four parts has a quarter of the area and lies in its parent; groups cover what they covered.
    #[test]
    fn parts_are_quarters() {
        let groups = ElementGroups::from([("some".to_string(), vec![3, 5])]);
        let disc = Mesh::disc(0.5, 3).unwrap();
        let cells: Vec<_> = disc.nodes_of::<3>().iter().map(|cell| cell.map(|n| n.index())).collect();
        let rim = FaceGroups::from([("rim".to_string(), vec![[19, 20], [20, 21]])]);
        let coarse = Mesh::new(disc.points_in::<2>().to_vec(), &cells, &rim, &groups).unwrap();
        let fine = coarse.refined().unwrap();
        assert_eq!(fine.node_count(), coarse.node_count() + coarse.faces().len());
        assert_eq!(fine.points_in::<2>()[..coarse.node_count()], *coarse.points_in::<2>());
        assert_eq!((fine.element_count(), fine.reoriented_elements()), (4 * coarse.element_count(), 0));
        for e in 0..coarse.element_count() {
            let parent = coarse.geometry::<2, 3>(ElementId::new(e));
            let origin = coarse.corners::<2, 3>(ElementId::new(e))[0];
            for part in 4 * e..4 * e + 4 {
                // Rounding of a few products of coordinates below 1.
                let volume = fine.geometry::<2, 3>(ElementId::new(part)).volume;
                assert!((volume - 0.25 * parent.volume).abs() < 1e-15, "part {part}");
                for p in fine.corners::<2, 3>(ElementId::new(part)) {
                    let weights = parent.gradients.map(|g| g[0] * (p[0] - origin[0]) + g[1] * (p[1] - origin[1]));
                    let weights = [1.0 + weights[0], weights[1], weights[2]];
                    assert!(weights.iter().all(|w| (-1e-13..1.0 + 1e-13).contains(w)), "{weights:?}");
                }
            }
        }
        let parts: Vec<_> = fine.element_groups()["some"].iter().map(|e| e.index()).collect();
        assert_eq!(parts, [12, 13, 14, 15, 20, 21, 22, 23]);
        let length = |mesh: &Mesh| -> f64 { mesh.face_groups()["rim"].iter().map(|&f| mesh.face_normal(f).1).sum() };
        assert_eq!(fine.face_groups()["rim"].len(), 4);
        // Rounding of four lengths below 1.
        assert!((length(&fine) - length(&coarse)).abs() < 1e-15);
    }

    #[test]
    fn bars_are_halved() {
        let fine = Mesh::uniform_bar(2.0, 2).unwrap().refined().unwrap();
        assert_eq!(fine.points(), [0.0, 1.0, 2.0, 0.5, 1.5]);
        assert_eq!(
            fine.nodes_of::<2>().iter().map(|cell| cell.map(|n| n.index())).collect::<Vec<_>>(),
            [[0, 3], [3, 1], [1, 4], [4, 2]]
        );
        let coarse = Mesh::uniform_bar(2.0, 2).unwrap();
        assert_eq!(coarse.prolonged(&[1.0, 2.0, 4.0]), [1.0, 2.0, 4.0, 1.5, 3.0]);
        let end = fine.face_groups()["end"][0];
        assert_eq!(fine.face_nodes::<1>(end)[0].index(), 2);
    }
}
