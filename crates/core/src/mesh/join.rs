//! Several bodies as one mesh.

use super::{ElementGroups, FacetGroups, Mesh, MeshError};
use crate::ids::{ElementId, FacetId, NodeId};
use crate::simplex::{Element, Simplex};

impl<const D: usize, const N: usize> Mesh<D, N>
where
    Element<D, N>: Simplex<D, N>,
{
    /// The mesh of some bodies with their names: nodes and elements one body after the other. The elements of a body
    /// are the group of its name; the groups of its mesh become "body.group".
    ///
    /// # Errors
    /// Bodies that touch or overlap, or too many elements.
    pub fn joined(bodies: &[(&str, &Self)]) -> Result<Self, MeshError> {
        let (mut points, mut cells) = (Vec::new(), Vec::new());
        let (mut facet_groups, mut element_groups) = (FacetGroups::new(), ElementGroups::new());
        for (body, mesh) in bodies {
            let (first_node, first_element) = (points.len(), cells.len());
            points.extend_from_slice(mesh.points());
            cells.extend(mesh.plain_cells().map(|cell| cell.map(|node| first_node + node)));
            for (group, facets) in mesh.plain_facet_groups() {
                let facets = facets.into_iter().map(|nodes| nodes.map(|node| first_node + node)).collect();
                facet_groups.insert(format!("{body}.{group}"), facets);
            }
            for (group, elements) in mesh.plain_element_groups() {
                let elements = elements.into_iter().map(|element| first_element + element).collect();
                element_groups.insert(format!("{body}.{group}"), elements);
            }
            element_groups.insert((*body).to_string(), (first_element..cells.len()).collect());
        }
        Self::new(points, &cells, &facet_groups, &element_groups)
    }

    /// The mesh with its points mapped: moved, or turned.
    ///
    /// # Errors
    /// As [`Mesh::new`]: points that fall together or are not finite.
    pub fn mapped(&self, map: impl Fn(&[f64; D]) -> [f64; D]) -> Result<Self, MeshError> {
        let cells: Vec<_> = self.plain_cells().collect();
        let points = self.points().iter().map(map).collect();
        Self::new(points, &cells, &self.plain_facet_groups(), &self.plain_element_groups())
    }

    fn plain_cells(&self) -> impl Iterator<Item = [usize; N]> + '_ {
        self.cells().iter().map(|cell| cell.map(NodeId::index))
    }

    fn plain_facet_groups(&self) -> FacetGroups<D> {
        let nodes = |facet: &FacetId| self.facets()[facet.index()].nodes.map(NodeId::index);
        let groups = self.facet_groups().iter();
        groups.map(|(name, facets)| (name.clone(), facets.iter().map(nodes).collect())).collect()
    }

    fn plain_element_groups(&self) -> ElementGroups {
        let groups = self.element_groups().iter();
        groups.map(|(name, group)| (name.clone(), group.iter().copied().map(ElementId::index).collect())).collect()
    }
}
