//! The elements around each node, walked from facet to facet.

use super::{Facet, MeshError};
use crate::ids::{ElementId, FacetId, NodeId};

/// The stars of all nodes, one after the other.
///
/// A star of k elements is a chain: facet, element, facet, …, element, facet. An interior node of
/// a 2D mesh has a closed chain whose first and last facet are the same; in 1D, where an element
/// has a single facet at a node, the outer ends of the chain are `None`.
#[derive(Clone, Debug, Default)]
pub struct Stars {
    offsets: Vec<u32>,
    elements: Vec<ElementId>,
    links: Vec<Option<FacetId>>,
}

/// The star of one node.
#[derive(Clone, Copy, Debug)]
pub struct Star<'a> {
    /// Elements in the order of the walk.
    pub elements: &'a [ElementId],
    /// Facet before, between and after them: one more than elements.
    pub links: &'a [Option<FacetId>],
}

impl Star<'_> {
    /// Whether the chain of a star closes on itself.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.links.len() > 1 && self.links[0].is_some() && self.links[0] == self.links[self.links.len() - 1]
    }
}

impl Stars {
    /// The star of a node.
    #[must_use]
    pub fn star(&self, node: NodeId) -> Star<'_> {
        let i = node.index();
        let (start, end) = (self.offsets[i] as usize, self.offsets[i + 1] as usize);
        // Each earlier star holds one facet more than elements.
        Star { elements: &self.elements[start..end], links: &self.links[start + i..=end + i] }
    }

    /// Walks every star; a star that falls into several chains is a non-manifold node.
    pub(super) fn new<const D: usize, const N: usize>(
        node_count: usize,
        cells: &[[NodeId; N]],
        facets: &[Facet<D>],
        cell_facets: &[[FacetId; N]],
    ) -> Result<Self, MeshError> {
        let incident = incident_elements(node_count, cells);
        let mut stars = Self { offsets: vec![0], ..Self::default() };
        let sides = |element: ElementId, node: NodeId| -> [Option<FacetId>; 2] {
            let mut found = [None; 2];
            let all = cells[element.index()].iter().zip(&cell_facets[element.index()]);
            let around = all.filter(|&(&other, _)| other != node).map(|(_, &facet)| Some(facet));
            // In 1D the single facet comes last, behind the absent one.
            for (slot, facet) in found[2 - D..].iter_mut().zip(around) {
                *slot = facet;
            }
            found
        };
        for (i, around) in incident.iter().enumerate() {
            let node = NodeId::new(i);
            let is_end = |f: Option<FacetId>| f.is_none_or(|f| facets[f.index()].neighbour.is_none());
            let start = around
                .iter()
                .flat_map(|&e| sides(e, node).map(|facet| (facet, e)))
                .find(|&(facet, _)| is_end(facet))
                .unwrap_or((sides(around[0], node)[0], around[0]));

            let (mut entry, mut element) = start;
            let mut count = 0;
            stars.links.push(entry);
            loop {
                let [a, b] = sides(element, node);
                let exit = if entry == a { b } else { a };
                stars.elements.push(element);
                stars.links.push(exit);
                count += 1;
                let Some(facet) = exit.filter(|_| exit != start.0) else { break };
                let Facet { owner, neighbour, .. } = facets[facet.index()];
                let Some(next) = neighbour.map(|n| if n == element { owner } else { n }) else { break };
                (entry, element) = (exit, next);
            }
            if count != around.len() {
                return Err(MeshError::NonManifoldNode { node: i, elements: around.len(), reached: count });
            }
            stars.offsets.push(stars.elements.len() as u32);
        }
        Ok(stars)
    }
}

/// Elements that hold each node, ascending.
fn incident_elements<const N: usize>(node_count: usize, cells: &[[NodeId; N]]) -> Vec<Vec<ElementId>> {
    let mut incident = vec![Vec::new(); node_count];
    for (e, cell) in cells.iter().enumerate() {
        for node in cell {
            incident[node.index()].push(ElementId::new(e));
        }
    }
    incident
}
