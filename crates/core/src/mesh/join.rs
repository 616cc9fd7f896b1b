//! Several bodies as one mesh.

use super::{ElementGroups, FacetGroups, Mesh, MeshError};
use crate::ids::{FacetId, NodeId};
use crate::simplex::{Element, Simplex};

impl<const D: usize, const N: usize> Mesh<D, N>
where
    Element<D, N>: Simplex<D, N>,
{
    /// The mesh of some bodies with their names: nodes and elements one body after the other. The elements of a body are
    /// the group of its name; the groups of its mesh become "body.group".
    ///
    /// # Errors
    /// Bodies that touch or overlap, or too many elements.
    pub fn joined(bodies: &[(&str, &Self)]) -> Result<Self, MeshError> {
        let (mut points, mut cells) = (Vec::new(), Vec::new());
        let (mut facet_groups, mut element_groups) = (FacetGroups::new(), ElementGroups::new());
        for (body, mesh) in bodies {
            let (first, first_element) = (points.len(), cells.len());
            let node = |node: &NodeId| first + node.index();
            points.extend_from_slice(mesh.points());
            cells.extend(mesh.cells().iter().map(|cell| cell.each_ref().map(node)));
            for (group, facets) in mesh.facet_groups() {
                let nodes = |facet: &FacetId| mesh.facets()[facet.index()].nodes.each_ref().map(node);
                facet_groups.insert(format!("{body}.{group}"), facets.iter().map(nodes).collect());
            }
            for (group, elements) in mesh.element_groups() {
                let elements = elements.iter().map(|element| first_element + element.index());
                element_groups.insert(format!("{body}.{group}"), elements.collect());
            }
            element_groups.insert((*body).to_string(), (first_element..cells.len()).collect());
        }
        Self::new(points, &cells, &facet_groups, &element_groups)
    }

    /// The mesh moved by a vector (m).
    ///
    /// # Errors
    /// As [`Mesh::new`]: so far away from the origin that nodes fall together.
    pub fn moved(&self, by: [f64; D]) -> Result<Self, MeshError> {
        let points = self.points().iter().map(|point| std::array::from_fn(|c| point[c] + by[c])).collect();
        let cells: Vec<_> = self.cells().iter().map(|cell| cell.map(NodeId::index)).collect();
        let facets = |facets: &Vec<FacetId>| {
            facets.iter().map(|facet| self.facets()[facet.index()].nodes.map(NodeId::index)).collect()
        };
        let facet_groups = self.facet_groups().iter().map(|(name, group)| (name.clone(), facets(group))).collect();
        let elements = |(name, group): (&String, &Vec<crate::ids::ElementId>)| {
            (name.clone(), group.iter().map(|element| element.index()).collect())
        };
        Self::new(points, &cells, &facet_groups, &self.element_groups().iter().map(elements).collect())
    }
}
