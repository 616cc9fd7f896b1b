//! The stars of the nodes of the contact surface, and their stresses, which congruent stars share.

use crate::concentrated::{StarElement, StarStress};
use percute_core::ids::ElementId;
use percute_core::material::{Law, LinearLaw};
use percute_core::problem::Problem;
use std::collections::HashMap;

/// Corners of congruent stars differ by less than this part of the size of the mesh: by rounding.
const CONGRUENT: f64 = 1e-13;

/// The star of one node.
#[derive(Debug)]
pub(super) struct NodeStar {
    pub(super) elements: Vec<ElementId>,
    pub(super) edges: Vec<CandidateEdge>,
    /// Tributary shares of the edges.
    pub(super) tributary: Vec<f64>,
    /// 1 over plane modulus and thickness (m/N), their mean over the elements.
    pub(super) compliance: f64,
    /// Supported components of the first and the last edge of the star.
    supported: [[bool; 2]; 2],
    /// The first node with a congruent star.
    pub(super) alike: usize,
}

/// A candidate facet of a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct CandidateEdge {
    pub(super) facet: usize,
    /// Position of the node in the facet.
    pub(super) end: usize,
    /// The node at the other end, by its position in the contact surface.
    pub(super) far: usize,
    /// 0 the first edge of the star, 1 the last.
    side: usize,
    pub(super) area: f64,
}

impl NodeStar {
    /// Those of all nodes of the contact surface.
    pub(super) fn all<const D: usize, const N: usize>(problem: &Problem<D, N>) -> Vec<Self> {
        let surface = problem.surface();
        let mut edges = vec![Vec::new(); surface.nodes().len()];
        for (facet, candidate) in surface.facets().iter().enumerate() {
            for (end, &at) in candidate.nodes.iter().enumerate() {
                let star = problem.mesh().stars().star(surface.nodes()[at].node);
                let side = usize::from(star.links[0] != Some(candidate.facet));
                edges[at].push(CandidateEdge {
                    facet,
                    end,
                    far: candidate.nodes[(end + 1) % D],
                    side,
                    area: candidate.area,
                });
            }
        }
        let mut first = HashMap::new();
        let star = |(at, edges): (usize, Vec<CandidateEdge>)| {
            let mut star = Self::new(problem, at, edges);
            star.alike = *first.entry(star.congruence(problem, at)).or_insert(at);
            star
        };
        edges.into_iter().enumerate().map(star).collect()
    }

    fn new<const D: usize, const N: usize>(problem: &Problem<D, N>, at: usize, mut edges: Vec<CandidateEdge>) -> Self {
        edges.sort_by_key(|edge| edge.side);
        let elements = problem.mesh().stars().star(problem.surface().nodes()[at].node).elements.to_vec();
        let total: f64 = edges.iter().map(|edge| edge.area).sum();
        let compliance = |&id: &ElementId| {
            let (law, (alpha, beta)) = (problem.material(id), problem.material(id).compliance::<D>());
            (alpha - beta) / law.extent() / elements.len() as f64
        };
        let links = problem.mesh().stars().star(problem.surface().nodes()[at].node).links;
        let supported = [links.first(), links.last()].map(|link| {
            let supported = link.copied().flatten().map_or([false; D], |facet| problem.supported(facet));
            [supported[0], supported[D - 1]]
        });
        Self {
            tributary: edges.iter().map(|edge| edge.area / total).collect(),
            compliance: elements.iter().map(compliance).sum(),
            elements,
            edges,
            supported,
            alike: at,
        }
    }

    /// The same numbers for stars whose unit hats have the same stresses.
    fn congruence<const D: usize, const N: usize>(&self, problem: &Problem<D, N>, at: usize) -> Vec<i64> {
        let (mesh, node) = (problem.mesh(), problem.surface().nodes()[at].node);
        let origin = mesh.points()[node.index()];
        let mut numbers: Vec<i64> = self.edges.iter().map(|edge| edge.side as i64).collect();
        numbers.extend(self.supported.as_flattened().iter().map(|&supported| i64::from(supported)));
        for &id in &self.elements {
            numbers.push(mesh.local_node(id, node).unwrap_or(0) as i64);
            numbers.push(i64::from(problem.element_material()[id.index()]));
            let offsets = mesh.cell_points(id).into_iter().flat_map(|p| (0..D).map(move |c| p[c] - origin[c]));
            numbers.extend(offsets.map(|x| (x / (CONGRUENT * mesh.size())).round() as i64));
        }
        numbers
    }

    /// The stresses of unit hats.
    pub(super) fn stress<const D: usize, const N: usize>(&self, problem: &Problem<D, N>, at: usize) -> StarStress {
        let (mesh, node) = (problem.mesh(), problem.surface().nodes()[at].node);
        let origin = mesh.points()[node.index()];
        let element = |&id: &ElementId| {
            let points = mesh.cell_points(id);
            // From the node: rounding does not grow with the distance of the body from the origin.
            let corners = std::array::from_fn(|i| [0, D - 1].map(|c| points[i][c] - origin[c]));
            StarElement { corners, at: mesh.local_node(id, node).unwrap_or(0), law: problem.material(id) }
        };
        let elements: Vec<_> = self.elements.iter().map(element).collect();
        let sides: Vec<usize> = self.edges.iter().map(|edge| edge.side).collect();
        StarStress::new(&elements, &sides, self.supported)
    }
}
