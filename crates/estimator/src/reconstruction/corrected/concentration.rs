//! The shapes of the tractions of nodes, with the stress of those that are narrower than their edges.

use crate::concentrated::{HATS, Hat, Pressed, StarElement, StarStress};
use crate::contact_density::{Densities, NarrowHat};
use nalgebra::DMatrix;
use percute_core::ids::ElementId;
use percute_core::material::LinearLaw;
use percute_core::problem::Problem;
use std::sync::OnceLock;

/// The stars of the nodes of the contact surface.
#[derive(Debug)]
pub(crate) struct Concentration<const D: usize> {
    nodes: Vec<NodeStar>,
    /// Gaps below this are none (m).
    tolerance: f64,
}

/// The star of one node.
#[derive(Debug)]
struct NodeStar {
    edges: Vec<CandidateEdge>,
    /// Tributary shares of the edges.
    tributary: Vec<f64>,
    /// 1 over the plane modulus (1/Pa), and section or thickness (m).
    compliance: f64,
    extent: f64,
    forms: OnceLock<StarForms>,
}

/// A candidate facet of a node.
#[derive(Clone, Copy, Debug)]
struct CandidateEdge {
    facet: usize,
    /// Position of the node in the facet, and of the node at the other end in the contact surface.
    end: usize,
    far: usize,
    /// 0 the first edge of the star, 1 the last.
    side: usize,
    area: f64,
}

/// The stress of unit hats in a star.
#[derive(Debug)]
pub(crate) struct StarForms {
    pub(crate) elements: Vec<ElementId>,
    pub(crate) stress: StarStress,
    /// ∫τ:K⁻¹τ over the star.
    energy: DMatrix<f64>,
}

impl<const D: usize> Concentration<D> {
    pub(super) fn new<const N: usize>(problem: &Problem<D, N>) -> Self {
        let nodes = (0..problem.surface().nodes().len()).map(|at| NodeStar::new(problem, at)).collect();
        Self { nodes, tolerance: problem.contact_tolerance() }
    }

    /// The shape of the traction of one node, edge by edge; none where its tributary density is best.
    pub(super) fn shape<const N: usize>(
        &self,
        problem: &Problem<D, N>,
        at: usize,
        force: &[f64; D],
        gap: &[f64],
    ) -> Option<Vec<Hat>> {
        self.pressed(problem, at, force, gap).map(|(gaps, normal)| self.of(problem, at, force, normal, &gaps).shape())
    }

    /// The gaps of the edges and the normal part of a force, where an edge leaves the plane.
    fn pressed<const N: usize>(
        &self,
        problem: &Problem<D, N>,
        at: usize,
        force: &[f64; D],
        gap: &[f64],
    ) -> Option<(Vec<f64>, f64)> {
        let open = |k: usize| gap[k].max(0.0);
        let gaps: Vec<f64> = self.nodes[at].edges.iter().map(|edge| open(edge.far) - open(at)).collect();
        if force.iter().all(|f| *f == 0.0) || gaps.iter().all(|gap| *gap <= self.tolerance) {
            return None;
        }
        let frame = problem.obstacles()[problem.surface().nodes()[at].obstacle].flat_frame();
        Some((gaps, frame.split(force).0))
    }

    fn of<'a, const N: usize>(
        &'a self,
        problem: &Problem<D, N>,
        at: usize,
        force: &[f64; D],
        normal: f64,
        gaps: &'a [f64],
    ) -> Pressed<'a> {
        let star = &self.nodes[at];
        Pressed {
            force: [0, 1].map(|c| force[c] / star.extent),
            normal: normal / star.extent,
            compliance: star.compliance,
            gaps,
            tributary: &star.tributary,
            energy: &self.forms(problem, at).energy,
        }
    }

    /// The normal force (N), at most `most` with this direction, under which the auxiliary solution's node comes to its
    /// plane with the local compliance of its traction. `None` where the mesh has this compliance: where a hat is as wide
    /// as its edge. `prediction` is the gap without the force (m), `mobility` the way that a unit force gives (m/N).
    pub(super) fn own_force<const N: usize>(
        &self,
        problem: &Problem<D, N>,
        at: usize,
        (most, direction): (f64, &[f64; D]),
        (prediction, mobility): (f64, f64),
        gap: &[f64],
    ) -> Option<f64> {
        let force = |normal: f64| direction.map(|d| normal * d);
        let (gaps, _) = self.pressed(problem, at, &force(most), gap)?;
        let shape = |normal: f64| self.of(problem, at, &force(normal), normal, &gaps);
        if shape(most).shape().iter().any(|hat| hat.share > 1e-6 && hat.halvings == 0) {
            return None;
        }
        let remaining = |normal: f64| {
            let pressed = shape(normal);
            let best = pressed.shape();
            let open: f64 = best.iter().zip(&gaps).map(|(hat, gap)| hat.share * gap * hat.far()).sum();
            prediction + normal * mobility + open + pressed.stress(&best) / pressed.normal
        };
        if prediction >= 0.0 {
            return Some(0.0);
        }
        if remaining(most) <= 0.0 {
            return Some(most);
        }
        let (mut low, mut high) = (0.0, most);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if remaining(middle) < 0.0 { low = middle } else { high = middle }
        }
        Some(0.5 * (low + high))
    }

    /// The stress of unit hats, made at first use.
    pub(crate) fn forms<const N: usize>(&self, problem: &Problem<D, N>, at: usize) -> &StarForms {
        self.nodes[at].forms.get_or_init(|| StarForms::new(problem, at, &self.nodes[at].edges))
    }

    /// The hats of a shape, and the density on one facet (Pa) of those as wide as their edges.
    pub(super) fn hats<'a>(
        &'a self,
        at: usize,
        shape: &'a [Hat],
        force: &'a [f64; D],
    ) -> impl Iterator<Item = NarrowHat<D>> + 'a {
        let edges = self.nodes[at].edges.iter().zip(shape).enumerate();
        edges.filter(|(_, (_, hat))| hat.halvings > 0 && hat.share > 0.0).map(move |(edge, (candidate, hat))| NarrowHat {
            node: at,
            facet: candidate.facet,
            end: candidate.end,
            edge,
            halvings: hat.halvings,
            resultant: force.map(|f| hat.share * f),
        })
    }

    /// The density at the node (Pa) on one of its facets, of a hat as wide as the edge.
    pub(super) fn wide(&self, at: usize, facet: usize, shape: &[Hat], force: &[f64; D]) -> [f64; D] {
        let edges = self.nodes[at].edges.iter().zip(shape);
        let found = edges.filter(|(edge, hat)| edge.facet == facet && hat.halvings == 0).next();
        found.map_or([0.0; D], |(edge, hat)| force.map(|f| D as f64 * hat.share * f / edge.area))
    }

    /// From the node to the centroid of its traction (m).
    pub(super) fn centroid<const N: usize>(&self, problem: &Problem<D, N>, at: usize, shape: &[Hat]) -> [f64; D] {
        let surface = problem.surface();
        let mut centroid = [0.0; D];
        for (edge, hat) in self.nodes[at].edges.iter().zip(shape) {
            let (near, far) = (surface.point(at), surface.point(edge.far));
            (0..D).for_each(|c| centroid[c] += hat.share * hat.far() * (far[c] - near[c]));
        }
        centroid
    }

    /// The derivatives of the products of the stress of hats with the admissible stress, in the tractions of elements.
    pub(super) fn add_slopes<const N: usize>(
        &self,
        problem: &Problem<D, N>,
        densities: &Densities<D>,
        mut add: impl FnMut(ElementId, &[[[f64; D]; D]; N]),
    ) {
        for hat in densities.hats() {
            let (forms, extent) = (self.forms(problem, hat.node), self.extent(hat.node));
            for (&element, product) in forms.elements.iter().zip(&forms.stress.product) {
                let mut gradient = [[[0.0; D]; D]; N];
                for (c, force) in hat.resultant.iter().enumerate() {
                    let column = product.column(2 * (HATS * hat.edge + hat.halvings - 1) + c);
                    for (value, entry) in gradient.iter_mut().flatten().flatten().zip(column.iter()) {
                        *value += entry * force / extent;
                    }
                }
                add(element, &gradient);
            }
        }
    }

    /// Section or thickness at a node (m).
    pub(crate) fn extent(&self, at: usize) -> f64 {
        self.nodes[at].extent
    }
}

impl NodeStar {
    fn new<const D: usize, const N: usize>(problem: &Problem<D, N>, at: usize) -> Self {
        let (surface, mesh) = (problem.surface(), problem.mesh());
        let star = mesh.stars().star(surface.nodes()[at].node);
        let ends = [star.links[0], star.links[star.links.len() - 1]];
        let edge = |(facet, candidate): (usize, &percute_core::contact::ContactFacet<D>)| {
            let end = candidate.nodes.iter().position(|&k| k == at)?;
            let side = ends.iter().position(|link| *link == Some(candidate.facet))?;
            let far = candidate.nodes[(end + 1) % D];
            Some(CandidateEdge { facet, end, far, side, area: candidate.area })
        };
        let mut edges: Vec<CandidateEdge> = surface.facets().iter().enumerate().filter_map(edge).collect();
        edges.sort_by_key(|edge| edge.side);
        let total: f64 = edges.iter().map(|edge| edge.area).sum();
        let law = problem.material(star.elements[0]);
        let (alpha, beta) = law.compliance::<D>();
        Self {
            tributary: edges.iter().map(|edge| edge.area / total).collect(),
            edges,
            compliance: alpha - beta,
            extent: percute_core::material::Law::extent(law),
            forms: OnceLock::new(),
        }
    }
}

impl StarForms {
    fn new<const D: usize, const N: usize>(problem: &Problem<D, N>, at: usize, edges: &[CandidateEdge]) -> Self {
        let (mesh, node) = (problem.mesh(), problem.surface().nodes()[at].node);
        let star = mesh.stars().star(node);
        let element = |&id: &ElementId| {
            let points = mesh.cell_points(id);
            let corners = std::array::from_fn(|i| [points[i][0], points[i][D - 1]]);
            StarElement { corners, at: mesh.local_node(id, node).unwrap_or(0), law: problem.material(id) }
        };
        let elements: Vec<_> = star.elements.iter().map(element).collect();
        let sides: Vec<usize> = edges.iter().map(|edge| edge.side).collect();
        let stress = StarStress::new(&elements, &sides);
        let size = stress.energy[0].ncols();
        let energy = stress.energy.iter().fold(DMatrix::zeros(size, size), |sum, one| sum + one);
        Self { elements: star.elements.to_vec(), stress, energy }
    }
}
