//! The stars of the nodes of the contact surface, and their stresses, which congruent stars share.

use crate::concentrated::{StarElement, StarFrame, StarStress};
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
    /// The corner of each element at the node.
    pub(super) corners: Vec<usize>,
    /// The first edge of the star, but global axes where there are supports, which are in these.
    pub(super) frame: StarFrame,
    pub(super) edges: Vec<CandidateEdge>,
    /// 0 the first edge of the star, 1 the last: those of all candidate edges, of either plane of a node at two.
    pub(super) sides: Vec<usize>,
    /// The position of each edge among them.
    pub(super) places: Vec<usize>,
    /// The first slot of the node in the contact surface.
    pub(super) first: usize,
    /// Tributary shares of the edges.
    pub(super) tributary: Vec<f64>,
    /// 1 over plane modulus and thickness (m/N), their mean over the elements.
    pub(super) compliance: f64,
    /// Supported components of the first and the last edge of the star.
    supported: [[bool; 2]; 2],
    /// The first node with a congruent star.
    pub(super) alike: usize,
}

/// A candidate face of a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct CandidateEdge {
    pub(super) face: usize,
    /// Position of the node in the face.
    pub(super) end: usize,
    /// The node at the other end, by its position in the contact surface.
    pub(super) far: usize,
    /// 0 the first edge of the star, 1 the last.
    side: usize,
    pub(super) area: f64,
}

impl NodeStar {
    /// Those of all nodes of the contact surface.
    pub(super) fn all<const D: usize>(problem: &Problem<D>) -> Vec<Self> {
        let surface = problem.surface();
        let mut edges = vec![Vec::new(); surface.nodes().len()];
        for (face, candidate) in surface.faces().iter().enumerate() {
            for (end, &at) in candidate.nodes.iter().enumerate() {
                let star = problem.mesh().stars().star(surface.nodes()[at].node);
                let side = usize::from(star.links[0] != Some(candidate.face));
                edges[at].push(CandidateEdge {
                    face,
                    end,
                    far: candidate.nodes[(end + 1) % D],
                    side,
                    area: candidate.area,
                });
            }
        }
        let sides = |at: usize| {
            let beside = surface.nodes()[at].second_slot;
            let both = [Some(at), beside].into_iter().flatten().flat_map(|at| &edges[at]);
            let mut sides: Vec<usize> = both.map(|edge| edge.side).collect();
            sides.sort_unstable();
            sides
        };
        let sides: Vec<_> = (0..edges.len()).map(sides).collect();
        let mut first = HashMap::new();
        let star = |(at, (edges, sides)): (usize, (Vec<CandidateEdge>, Vec<usize>))| {
            let mut star = Self::new(problem, at, edges, sides);
            star.alike = *first.entry(star.congruence(problem)).or_insert(at);
            star
        };
        edges.into_iter().zip(sides).enumerate().map(star).collect()
    }

    fn new<const D: usize>(problem: &Problem<D>, at: usize, mut edges: Vec<CandidateEdge>, sides: Vec<usize>) -> Self {
        edges.sort_by_key(|edge| edge.side);
        let node = problem.surface().nodes()[at].node;
        let star = problem.mesh().stars().star(node);
        let elements = star.elements.to_vec();
        let total: f64 = edges.iter().map(|edge| edge.area).sum();
        let compliance = |&id: &ElementId| {
            let (law, (alpha, beta)) = (problem.material(id), problem.material(id).compliance::<D>());
            (alpha - beta) / law.extent() / elements.len() as f64
        };
        let supported = [star.links.first(), star.links.last()].map(|link| {
            let supported = link.copied().flatten().map_or([false; D], |face| problem.supported(face));
            [supported[0], supported[D - 1]]
        });
        let corner = |&id: &ElementId| problem.mesh().local_node(id, node).unwrap_or(0);
        let mut made = Self {
            places: edges.iter().map(|edge| sides.partition_point(|side| *side < edge.side)).collect(),
            sides,
            first: problem.surface().first_entry(at),
            tributary: edges.iter().map(|edge| edge.area / total).collect(),
            compliance: elements.iter().map(compliance).sum(),
            corners: elements.iter().map(corner).collect(),
            frame: StarFrame([1.0, 0.0]),
            elements,
            edges,
            supported,
            alike: at,
        };
        if !supported.as_flattened().contains(&true) {
            let [x, y] = made.ends(problem, 0)[0];
            made.frame = StarFrame([x / x.hypot(y), y / x.hypot(y)]);
        }
        made
    }

    /// The other corners of an element, from the node (m), in the frame. Rounding does not grow with the distance of
    /// the body from the origin.
    fn ends<const D: usize>(&self, problem: &Problem<D>, position: usize) -> [[f64; 2]; 2] {
        let (points, cell) = (problem.mesh().points_in::<D>(), problem.mesh().cell(self.elements[position]));
        let (corners, own) = (cell.len(), self.corners[position]);
        let origin = points[cell[own].index()];
        [1, corners - 1].map(|next| {
            let point = points[cell[(own + next) % corners].index()];
            self.frame.own([0, D - 1].map(|c| point[c] - origin[c]))
        })
    }

    /// The same numbers for stars whose unit hats have the same stresses.
    fn congruence<const D: usize>(&self, problem: &Problem<D>) -> Vec<i64> {
        let mut numbers: Vec<i64> = self.sides.iter().map(|&side| side as i64).collect();
        numbers.extend(self.supported.as_flattened().iter().map(|&supported| i64::from(supported)));
        for (position, id) in self.elements.iter().enumerate() {
            numbers.push(i64::from(problem.element_material()[id.index()]));
            let ends = self.ends(problem, position);
            numbers
                .extend(ends.as_flattened().iter().map(|x| (x / (CONGRUENT * problem.mesh().size())).round() as i64));
        }
        numbers
    }

    /// The position of each edge among the candidate edges of the star.
    pub(super) fn own_places(&self) -> [usize; 2] {
        [0, 1].map(|edge| self.places.get(edge).copied().unwrap_or(edge))
    }

    /// The stresses of unit hats.
    pub(super) fn stress<const D: usize>(&self, problem: &Problem<D>) -> StarStress {
        let element = |(position, &id): (usize, &ElementId)| StarElement {
            ends: self.ends(problem, position),
            law: problem.material(id),
        };
        let elements: Vec<_> = self.elements.iter().enumerate().map(element).collect();
        StarStress::new(&elements, &self.sides, self.supported)
    }
}
