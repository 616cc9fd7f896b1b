//! Tractions of nodes, as wide as their gaps and the stress under them make best, and their stress.
//!
//! The force of a node as a density that is linear over whole edges acts where the edges leave the plane. The energy of
//! the gap under it is linear in the force, while the square of the true error is quadratic: at low speed, the estimate
//! of a corner or a curve would be many times too large.

mod auxiliary_forces;
mod bracket;
mod faced;
mod isolated_contact;
mod star;

use crate::concentrated::{HATS, HatStress, LoadedStar, ShapeCosts, StarResiduals, StarStress, TractionShape, place};
use crate::contact_density::NarrowHat;
use crate::residual::{Residuals, worse};
use crate::stress::StressResiduals;
pub(super) use auxiliary_forces::{AuxiliaryForces, Known};
use faced::NodeCosts;
pub(super) use faced::{Faced, Reach};
use percute_core::ids::ElementId;
use percute_core::material::Law;
use percute_core::problem::Problem;
use star::NodeStar;
use std::cell::Cell;
use std::cmp::Ordering;
use std::collections::BTreeSet;
use std::sync::OnceLock;

/// The stars of the nodes of the contact surface, and the stress of their hats, made at first use.
#[derive(Debug)]
pub(crate) struct Concentration<const D: usize> {
    nodes: Vec<NodeStar>,
    /// That of the first node of congruent stars.
    stresses: Vec<OnceLock<StarStress>>,
    /// Gaps below this are none (m).
    tolerance: f64,
}

impl<const D: usize> Concentration<D> {
    pub(super) fn new(problem: &Problem<D>) -> Self {
        let nodes = NodeStar::all(problem);
        let stresses = nodes.iter().map(|_| OnceLock::new()).collect();
        Self { nodes, stresses, tolerance: problem.contact_tolerance() }
    }

    /// About how much memory the stresses take (bytes) of the stars of which an edge leaves the plane at the beginning.
    pub(super) fn memory(&self, problem: &Problem<D>) -> usize {
        let gap = problem.surface().gaps(problem.initial_displacement());
        let needed = (0..self.nodes.len()).filter(|&at| self.gaps(at, &Faced::WHOLE, &gap).is_some());
        let stars: BTreeSet<usize> = needed.map(|at| self.nodes[at].alike).collect();
        let memory = |star: &NodeStar| StarStress::memory(star.elements.len(), star.sides.len());
        stars.into_iter().map(|at| memory(&self.nodes[at])).sum()
    }

    /// The shape of the traction of one node under a force (N), which is given as it is and pulled back. None where its
    /// tributary density is best: where no edge leaves the plane, where a hat as wide as a part that is faced is best,
    /// or where rounding spoils the stress of hats. An auxiliary contact force has its own shape.
    pub(super) fn shape(
        &self,
        problem: &Problem<D>,
        at: usize,
        faced: &Faced,
        [force, pulled]: [&[f64; D]; 2],
        gap: &[f64],
        own: Option<TractionShape>,
    ) -> Option<TractionShape> {
        let frame = problem.obstacles()[problem.surface().nodes()[at].obstacle].flat_frame();
        let normal = frame.split(force).0;
        if normal.partial_cmp(&0.0) != Some(Ordering::Greater) {
            return None;
        }
        let gaps = self.gaps(at, faced, gap)?;
        let shape = match own {
            Some(own) => own,
            None => self.costs(problem, at, faced, &pulled.map(|f| f / normal), &gaps)?.shape(normal),
        };
        // The density over a part is as good as a hat that is as wide: flat surfaces keep it.
        let widest = faced.reach.map(|reach| reach.halvings());
        let mut hats = shape.iter().zip(widest).filter(|(hat, widest)| *widest > 0 && hat.share > 0.0);
        hats.all(|(hat, widest)| hat.halvings > widest).then_some(shape)
    }

    /// The shape at the other one of two nodes that touch.
    pub(super) fn facing(
        &self,
        problem: &Problem<D>,
        [at, partner]: [usize; 2],
        shape: &TractionShape,
    ) -> TractionShape {
        shape.reordered(self.facing_edges(problem, partner, at))
    }

    /// What a node faces on the edges to other nodes, of which these parts face it; its compliance makes that of the
    /// node so many times larger.
    pub(super) fn faced(&self, at: usize, compliance: f64, reach: impl Fn(usize) -> Reach) -> Faced {
        let edges = &self.nodes[at].edges;
        Faced { compliance, reach: std::array::from_fn(|k| edges.get(k).map_or(Reach::WHOLE, |edge| reach(edge.far))) }
    }

    /// Gaps at the far ends of the edges of a node less its own; none where no edge leaves the plane.
    fn gaps(&self, at: usize, faced: &Faced, gap: &[f64]) -> Option<Vec<f64>> {
        let open = |k: usize| gap[k].max(0.0);
        let gaps: Vec<f64> = self.nodes[at].edges.iter().map(|edge| open(edge.far) - open(at)).collect();
        let leaves = gaps.iter().any(|gap| *gap > self.tolerance);
        leaves.then(|| gaps.iter().zip(faced.reach).map(|(gap, reach)| gap / reach.known).collect())
    }

    /// The cost of shapes under a force with this direction, its normal part 1; none if rounding spoils the stress of
    /// hats, or hats would be narrower than any.
    fn costs<'a>(
        &'a self,
        problem: &Problem<D>,
        at: usize,
        faced: &Faced,
        direction: &[f64; D],
        gaps: &[f64],
    ) -> Option<NodeCosts<'a>> {
        let (nodes, star) = (problem.surface().nodes(), &self.nodes[at]);
        let widest = faced.reach.map(|reach| reach.halvings());
        if widest.into_iter().any(|widest| widest > HATS) {
            return None;
        }
        let (mut stars, mut compliance) = (Vec::with_capacity(2), 0.0);
        for node in [Some(at), nodes[at].partner].into_iter().flatten() {
            let (other, stress) = (&self.nodes[node], self.stress(problem, node));
            if !stress.residuals.balanced() {
                return None;
            }
            compliance += other.compliance;
            let edges = if node == at { star.own_places() } else { self.facing_edges(problem, at, node) };
            stars.push(LoadedStar { energy: &stress.energy, frame: other.frame, edges });
        }
        let shapes = ShapeCosts::new([direction[0], direction[D - 1]], compliance, gaps, &star.tributary, stars);
        Some(NodeCosts { shapes, compliance: faced.compliance, widest, found: Cell::default() })
    }

    /// The nodes at the far ends of the edges of a node.
    pub(super) fn far_nodes(&self, at: usize) -> [Option<usize>; 2] {
        std::array::from_fn(|edge| self.nodes[at].edges.get(edge).map(|edge| edge.far))
    }

    /// Whether a node at the other end of a wide edge has a force, by edge and by node.
    fn touches_beside(&self, at: usize, wide: impl Iterator<Item = bool>, forces: &[[f64; D]]) -> bool {
        self.nodes[at].edges.iter().zip(wide).any(|(edge, wide)| wide && forces[edge.far] != [0.0; D])
    }

    /// The position of the edge of another node that faces each edge of a node.
    fn facing_edges(&self, problem: &Problem<D>, at: usize, other: usize) -> [usize; 2] {
        let nodes = problem.surface().nodes();
        std::array::from_fn(|edge| {
            let far = self.nodes[at].edges.get(edge).and_then(|edge| nodes[edge.far].partner);
            self.nodes[other].edges.iter().position(|edge| Some(edge.far) == far).unwrap_or(edge)
        })
    }

    fn stress(&self, problem: &Problem<D>, at: usize) -> &StarStress {
        let alike = self.nodes[at].alike;
        self.stresses[alike].get_or_init(|| self.nodes[alike].stress(problem))
    }

    /// The narrow hats of a shape.
    pub(super) fn hats<'a>(
        &'a self,
        at: usize,
        shape: &'a TractionShape,
        [force, pulled]: [&'a [f64; D]; 2],
    ) -> impl Iterator<Item = NarrowHat<D>> + 'a {
        let star = &self.nodes[at];
        let edges = star.edges.iter().zip(&star.places).zip(shape.iter());
        edges.filter(|(_, hat)| hat.halvings > 0 && hat.share != 0.0).map(move |((candidate, &edge), hat)| NarrowHat {
            node: at,
            star: star.first,
            face: candidate.face,
            end: candidate.end,
            edge,
            halvings: hat.halvings,
            resultant: force.map(|f| hat.share * f),
            pulled: pulled.map(|f| hat.share * f),
        })
    }

    /// On each edge of a node, the node at its other end, the halvings of its hat, narrow or not, and the resultant
    /// (N).
    pub(super) fn shares<'a>(
        &'a self,
        at: usize,
        shape: &'a TractionShape,
        force: &'a [f64; D],
    ) -> impl Iterator<Item = (usize, usize, [f64; D])> + 'a {
        let hats = self.nodes[at].edges.iter().zip(shape.iter()).filter(|(_, hat)| hat.share != 0.0);
        hats.map(|(edge, hat)| (edge.far, hat.halvings, force.map(|f| hat.share * f)))
    }

    /// The density at the node (Pa) on one of its faces, of a hat as wide as the edge.
    pub(super) fn wide(&self, at: usize, face: usize, shape: &TractionShape, force: &[f64; D]) -> [f64; D] {
        let mut edges = self.nodes[at].edges.iter().zip(shape.iter());
        let found = edges.find(|(edge, hat)| edge.face == face && hat.halvings == 0);
        found.map_or([0.0; D], |(edge, hat)| force.map(|f| D as f64 * hat.share * f / edge.area))
    }

    /// By how far the tractions on the edges of a node, narrow hats and densities as wide as edges, are from shares of
    /// its force: each at least 0, their sum 1.
    pub(super) fn share_residual(
        &self,
        at: usize,
        shape: &TractionShape,
        force: &[f64; D],
        narrow: &[NarrowHat<D>],
    ) -> f64 {
        let square: f64 = force.iter().map(|f| f * f).sum::<f64>().max(f64::MIN_POSITIVE);
        let wide = self.nodes[at].edges.iter().map(|edge| {
            let density = self.wide(at, edge.face, shape, force);
            density.map(|f| f * edge.area / D as f64)
        });
        let (mut rest, mut residual) = (*force, 0.0);
        for resultant in narrow.iter().map(|hat| hat.resultant).chain(wide) {
            let share: f64 = resultant.iter().zip(force).map(|(r, f)| r * f / square).sum();
            residual = worse(residual, -share);
            (0..D).for_each(|c| rest[c] -= resultant[c]);
        }
        worse(residual, (rest.iter().map(|f| f * f).sum::<f64>() / square).sqrt())
    }

    /// From the node to the centroid of its traction (m), of this shape or tributary; with the displacements of all
    /// nodes of a body that turns.
    pub(super) fn centroid(
        &self,
        problem: &Problem<D>,
        at: usize,
        shape: Option<&TractionShape>,
        displacement: &[[f64; D]],
    ) -> [f64; D] {
        let surface = problem.surface();
        let place = |at: usize| {
            let moved = displacement.get(surface.nodes()[at].node.index());
            std::array::from_fn(|c| surface.point(at)[c] + moved.map_or(0.0, |moved| moved[c]))
        };
        let (star, mut centroid) = (&self.nodes[at], [0.0; D]);
        for (k, edge) in star.edges.iter().enumerate() {
            let wide = || star.tributary[k] / (D + 1) as f64;
            let share = shape.and_then(|shape| shape.get(k)).map_or_else(wide, |hat| hat.share * hat.far());
            let (near, far): ([f64; D], [f64; D]) = (place(at), place(edge.far));
            (0..D).for_each(|c| centroid[c] += share * (far[c] - near[c]));
        }
        centroid
    }

    /// Calls `with` for each element of each star, with the stress of these hats, which are sorted by stars.
    pub(crate) fn each_element(
        &self,
        problem: &Problem<D>,
        hats: &[NarrowHat<D>],
        mut with: impl FnMut(ElementId, &HatStress<'_>),
    ) {
        for hats in hats.chunk_by(|a, b| a.star == b.star) {
            for &element in &self.nodes[hats[0].node].elements {
                self.in_element(problem, hats, element).iter().for_each(|stress| with(element, stress));
            }
        }
    }

    /// The stress of hats of one star in an element of it.
    pub(crate) fn in_element(
        &self,
        problem: &Problem<D>,
        hats: &[NarrowHat<D>],
        element: ElementId,
    ) -> Option<HatStress<'_>> {
        let at = hats.first()?.node;
        let (star, extent) = (&self.nodes[at], problem.material(element).extent());
        let position = star.elements.iter().position(|&other| other == element)?;
        let one = |hat: &NarrowHat<D>| {
            let (edge, halvings) = (hat.edge, hat.halvings);
            let resultant = star.frame.own([hat.pulled[0], hat.pulled[D - 1]]);
            resultant.into_iter().enumerate().map(move |(c, f)| (place(edge, halvings, c), f / extent))
        };
        Some(HatStress {
            star: self.stress(problem, at),
            frame: star.frame,
            element: position,
            at: star.corners[position],
            resultants: hats.iter().flat_map(one).collect(),
        })
    }

    /// Takes in the residuals of all stresses that have been made and are in use.
    pub(crate) fn add_residuals(&self, residuals: &mut Residuals) {
        let made = self.stresses.iter().filter_map(OnceLock::get).map(|stress| stress.residuals);
        for made in made.filter(StarResiduals::balanced) {
            residuals.hat_resultants = worse(residuals.hat_resultants, made.resultants);
            let StressResiduals { divergence, edges, inner } = made.stress;
            residuals.hat_stress = [divergence, edges, inner].into_iter().fold(residuals.hat_stress, worse);
        }
    }
}

#[cfg(test)]
mod tests;
