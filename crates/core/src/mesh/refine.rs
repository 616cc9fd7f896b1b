//! Nested finer meshes.

use super::{BarMesh, ElementGroups, FacetGroups, MeshError, TriangleMesh};
use crate::ids::{ElementId, FacetId};

impl BarMesh {
    /// The mesh with each element cut in two.
    ///
    /// Nodes keep their numbers, and the middle of element e becomes node `node_count() + e`; element e becomes the elements
    /// 2 e and 2 e + 1; groups name the same ends and elements as before.
    ///
    /// # Errors
    /// A mesh so fine that middles cannot be told from ends, or with more nodes than there are numbers.
    pub fn refined(&self) -> Result<Self, MeshError> {
        let (mut points, mut cells) = (self.points.clone(), Vec::with_capacity(2 * self.element_count()));
        for cell in &self.cells {
            let [a, b] = cell.map(|node| node.index());
            cells.extend([[a, points.len()], [points.len(), b]]);
            points.push([0.5 * (points[a][0] + points[b][0])]);
        }
        let ends = |group: &Vec<FacetId>| {
            group.iter().flat_map(|f| self.facets[f.index()].nodes).map(|n| [n.index()]).collect()
        };
        let halves = |group: &Vec<ElementId>| group.iter().flat_map(|e| [2 * e.index(), 2 * e.index() + 1]).collect();
        let facets: FacetGroups<1> =
            self.facet_groups.iter().map(|(name, group)| (name.clone(), ends(group))).collect();
        let elements: ElementGroups =
            self.element_groups.iter().map(|(name, group)| (name.clone(), halves(group))).collect();
        Self::new(points, &cells, &facets, &elements)
    }
}

impl TriangleMesh {
    /// The mesh with each triangle cut into four by the middles of its edges, for true errors against a nested mesh.
    ///
    /// Nodes keep their numbers, and the middle of edge f becomes node `node_count() + f`; element e becomes the elements
    /// 4 e to 4 e + 3; groups name the same edges and elements as before. A polygon stays the polygon it was.
    ///
    /// # Errors
    /// A mesh so fine that middles cannot be told from corners, or with more nodes than there are numbers.
    pub fn refined(&self) -> Result<Self, MeshError> {
        let mut points = self.points.clone();
        points.extend(self.facets.iter().map(|facet| {
            let [p, q] = facet.nodes.map(|node| self.points[node.index()]);
            [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])]
        }));
        let middle = |facet: usize| self.node_count() + facet;
        let mut cells = Vec::with_capacity(4 * self.element_count());
        for (cell, facets) in self.cells.iter().zip(&self.cell_facets) {
            let [a, b, c] = cell.map(|node| node.index());
            let [bc, ca, ab] = facets.map(|facet| middle(facet.index()));
            cells.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        let halves = |facet: usize| {
            let [a, b] = self.facets[facet].nodes.map(|node| node.index());
            [[a, middle(facet)], [middle(facet), b]]
        };
        let edges = self.facet_groups.iter();
        let edges: FacetGroups<2> =
            edges.map(|(name, group)| (name.clone(), group.iter().flat_map(|f| halves(f.index())).collect())).collect();
        let elements = self.element_groups.iter();
        let elements: ElementGroups = elements
            .map(|(name, group)| (name.clone(), group.iter().flat_map(|e| 4 * e.index()..4 * e.index() + 4).collect()))
            .collect();
        Self::new(points, &cells, &edges, &elements)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ids::ElementId;

    /// Each of the four parts has a quarter of the area and lies in its parent; groups cover what they covered.
    #[test]
    fn parts_are_quarters() {
        let groups = ElementGroups::from([("some".to_string(), vec![3, 5])]);
        let disc = TriangleMesh::disc(0.5, 3).unwrap();
        let cells: Vec<_> = disc.cells().iter().map(|cell| cell.map(|n| n.index())).collect();
        let rim = FacetGroups::from([("rim".to_string(), vec![[19, 20], [20, 21]])]);
        let coarse = TriangleMesh::new(disc.points().to_vec(), &cells, &rim, &groups).unwrap();
        let fine = coarse.refined().unwrap();
        assert_eq!(fine.node_count(), coarse.node_count() + coarse.facets().len());
        assert_eq!(fine.points()[..coarse.node_count()], *coarse.points());
        assert_eq!((fine.element_count(), fine.reoriented_elements()), (4 * coarse.element_count(), 0));
        for e in 0..coarse.element_count() {
            let parent = coarse.cell_geometry(ElementId::new(e));
            let origin = coarse.cell_points(ElementId::new(e))[0];
            for part in 4 * e..4 * e + 4 {
                // Rounding of a few products of coordinates below 1.
                let volume = fine.cell_geometry(ElementId::new(part)).volume;
                assert!((volume - 0.25 * parent.volume).abs() < 1e-15, "part {part}");
                for p in fine.cell_points(ElementId::new(part)) {
                    let weights = parent.gradients.map(|g| g[0] * (p[0] - origin[0]) + g[1] * (p[1] - origin[1]));
                    let weights = [1.0 + weights[0], weights[1], weights[2]];
                    assert!(weights.iter().all(|w| (-1e-13..1.0 + 1e-13).contains(w)), "{weights:?}");
                }
            }
        }
        let parts: Vec<_> = fine.element_groups()["some"].iter().map(|e| e.index()).collect();
        assert_eq!(parts, [12, 13, 14, 15, 20, 21, 22, 23]);
        let length =
            |mesh: &TriangleMesh| -> f64 { mesh.facet_groups()["rim"].iter().map(|&f| mesh.facet_normal(f).1).sum() };
        assert_eq!(fine.facet_groups()["rim"].len(), 4);
        // Rounding of four lengths below 1.
        assert!((length(&fine) - length(&coarse)).abs() < 1e-15);
    }
}
