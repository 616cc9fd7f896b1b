//! The elements of a solid over which strains are averaged: those at each edge and around each node, of one material.

use super::mirrors::Mirrors;
use percute_core::ids::{ElementId, NodeId};
use percute_core::problem::Problem;

/// Patches of an element: those of its edges, then those of its nodes.
pub(crate) const PATCHES: usize = 10;

/// Edges of an element.
const EDGES: usize = 6;

/// The patches of a solid. Those of a node and of the edges from there to nodes of higher numbers follow each other, so
/// that neighbours are close together.
#[derive(Clone, Debug, Default)]
pub(crate) struct SolidPatches {
    /// Those of each element.
    of_element: Vec<[u32; PATCHES]>,
    /// Where the elements of each patch begin.
    starts: Vec<u32>,
    elements: Vec<u32>,
    /// (1 − β)/(6V) at an edge, β/(4V) around a node, V the volume of the patch (1/m³).
    weights: Vec<f64>,
    /// The axes across which a plane of symmetry passes through the edge or node, one bit each.
    mirrors: Vec<u8>,
}

/// An element at an edge, or around a node: then the edge has this node alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Incidence {
    other: NodeId,
    material: u16,
    element: u32,
    /// Its place among the patches of the element.
    place: u8,
}

impl SolidPatches {
    /// Those of a problem of tetrahedra, with this share β of nodes.
    pub(super) fn new<const D: usize>(problem: &Problem<D>, nodes: f64) -> Self {
        let (mesh, mirrors) = (problem.mesh(), Mirrors::new(problem));
        let mut made = Self { of_element: vec![[0; PATCHES]; mesh.element_count()], ..Self::default() };
        let mut around = Vec::new();
        for node in (0..mesh.node_count()).map(NodeId::new) {
            incidences(problem, node, &mut around);
            for patch in around.chunk_by(|a, b| (a.other, a.material) == (b.other, b.material)) {
                let other = patch[0].other;
                let share = if other == node { nodes / 4.0 } else { (1.0 - nodes) / EDGES as f64 };
                made.add(problem, patch, share, mirrors.across([node, other]));
            }
        }
        made.starts.push(made.elements.len() as u32);
        made
    }

    fn add<const D: usize>(&mut self, problem: &Problem<D>, patch: &[Incidence], share: f64, mirrors: u8) {
        let mut volume = 0.0;
        self.starts.push(self.elements.len() as u32);
        for one in patch {
            self.of_element[one.element as usize][usize::from(one.place)] = self.weights.len() as u32;
            self.elements.push(one.element);
            volume += problem.volume(ElementId::new(one.element as usize));
        }
        self.weights.push(share / volume);
        self.mirrors.push(mirrors);
    }

    /// Number of patches.
    #[inline(always)]
    pub(crate) fn count(&self) -> usize {
        self.weights.len()
    }

    /// The patches of an element.
    #[inline(always)]
    pub(crate) fn of_element(&self, element: usize) -> &[u32; PATCHES] {
        &self.of_element[element]
    }

    /// The elements of a patch.
    #[inline(always)]
    pub(crate) fn elements(&self, patch: usize) -> &[u32] {
        &self.elements[self.starts[patch] as usize..self.starts[patch + 1] as usize]
    }

    /// The weight of Σ|E|ε_E of a patch in the strain of each of its elements (1/m³).
    #[inline(always)]
    pub(crate) fn weight(&self, patch: usize) -> f64 {
        self.weights[patch]
    }

    /// The axes across which a plane of symmetry passes through a patch, one bit each.
    #[inline(always)]
    pub(crate) fn mirrors(&self, patch: usize) -> u8 {
        self.mirrors[patch]
    }
}

/// The elements around a node and at its edges to nodes of higher numbers, by edges and materials.
fn incidences<const D: usize>(problem: &Problem<D>, node: NodeId, around: &mut Vec<Incidence>) {
    let (mesh, laws) = (problem.mesh(), problem.element_material());
    around.clear();
    for element in mesh.stars().star(node).elements {
        let cell = mesh.cell(*element);
        let Some(own) = cell.iter().position(|other| *other == node) else { continue };
        for (corner, &other) in cell.iter().enumerate().filter(|(_, other)| **other >= node) {
            let place = if corner == own { EDGES + own } else { edge(own, corner) };
            let element = element.index();
            around.push(Incidence { other, material: laws[element], element: element as u32, place: place as u8 });
        }
    }
    around.sort_unstable();
}

/// The number of the edge between two nodes of an element.
fn edge(a: usize, b: usize) -> usize {
    let (low, high) = (a.min(b), a.max(b));
    high * (high - 1) / 2 + low
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::material::Elastic;
    use percute_core::mesh::{ElementGroups, Mesh};
    use std::collections::BTreeSet;

    /// A box of two materials, one of them in every third element.
    fn mixed() -> Problem<3> {
        let mesh = Mesh::cuboid([1.0, 0.8, 0.7], [2, 3, 2]).unwrap();
        let cells: Vec<[usize; 4]> = mesh.nodes_of::<4>().iter().map(|cell| cell.map(NodeId::index)).collect();
        let group = |soft: bool| (0..cells.len()).filter(|e| (e % 3 == 0) == soft).collect();
        let groups = ElementGroups::from([("soft".to_string(), group(true)), ("hard".to_string(), group(false))]);
        let mesh = Mesh::new(mesh.points_in::<3>().to_vec(), &cells, &Default::default(), &groups).unwrap();
        Problem::<3>::builder(mesh)
            .material_of("hard", Elastic::solid(70.0, 0.3, 2.0).unwrap())
            .material_of("soft", Elastic::solid(20.0, 0.45, 3.0).unwrap())
            .build()
            .unwrap()
    }

    /// The patch of an edge or a node has all elements there of one material and no others, and the weights of a
    /// strain sum up to 1.
    #[test]
    fn patches_are_edges_and_nodes_in_a_material() {
        let problem = mixed();
        let (mesh, laws) = (problem.mesh(), problem.element_material());
        let patches = SolidPatches::new(&problem, 0.2);
        for e in 0..mesh.element_count() {
            let cell = mesh.cell(ElementId::new(e));
            let mut sum = 0.0;
            for (place, &patch) in patches.of_element(e).iter().enumerate() {
                let pair = (0..4).flat_map(|b| (0..b).map(move |a| [a, b])).find(|[a, b]| edge(*a, *b) == place);
                let [a, b] = pair.unwrap_or([place.saturating_sub(EDGES); 2]).map(|i| cell[i]);
                let has = |other: &usize| {
                    let nodes = mesh.cell(ElementId::new(*other));
                    laws[*other] == laws[e] && nodes.contains(&a) && nodes.contains(&b)
                };
                let expected: BTreeSet<usize> = (0..mesh.element_count()).filter(has).collect();
                let found: BTreeSet<usize> = patches.elements(patch as usize).iter().map(|e| *e as usize).collect();
                assert_eq!(found, expected, "{e}, {place}");
                sum += patches.weight(patch as usize)
                    * found.iter().map(|e| problem.volume(ElementId::new(*e))).sum::<f64>();
            }
            assert!((sum - 1.0).abs() < 1e-14, "{sum}");
        }
        assert!((0..patches.count()).all(|patch| patches.mirrors(patch) == 0));
    }
}
