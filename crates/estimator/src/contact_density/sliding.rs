//! Densities of surfaces that slide along each other.
//!
//! The force R_k of a node of the slave is the density R_k/w_k χ_k on its edges, and the opposite one on the master at
//! the same place. On an edge of either surface it is linear between the nodes of both. All but its own stress in the
//! element knows the linear traction with the same moments. The difference of the two balances itself; the norm of its
//! stress has a bound, C h ∫r², for any partition of the edge.

use crate::concentrated::{StarElement, roots};
use crate::direction::along;
use crate::partition::{Piece, pieces};
use crate::residual::worse;
use percute_core::contact::{Coupling, Side, SlidingSurfaces};
use percute_core::ids::ElementId;
use percute_core::material::{Hypothesis, Law};
use percute_core::problem::Problem;
use std::sync::Arc;

/// Where ∫r² is at most this part of ∫F², the bound of its energy is not worth a better one.
const SMALL: f64 = 1e-3;

/// An edge of a surface that slides, as a candidate facet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeFacet {
    /// Position among the candidate facets.
    pub(crate) facet: usize,
    /// Position in the facet of the first and of the second node along the tangent.
    ends: [usize; 2],
    /// Its length along the tangent (m).
    length: f64,
    /// The energy of the stress of r is at most this times ∫r² dξ (m²/N).
    spread: f64,
}

/// The edges of slave and master as candidate facets.
#[derive(Clone, Debug)]
pub(crate) struct SlidingFacets {
    edges: [Vec<EdgeFacet>; 2],
}

impl SlidingFacets {
    /// Those of all surfaces that slide.
    pub(crate) fn all<const D: usize, const N: usize>(problem: &Problem<D, N>) -> Vec<Self> {
        let surface = problem.surface();
        let mut starts_at = vec![None; surface.nodes().len()];
        for (f, facet) in surface.facets().iter().enumerate() {
            let first = facet.nodes.iter().copied().min().unwrap_or(0);
            if surface.sliding_of(first).is_some() {
                starts_at[first] = Some(f);
            }
        }
        let edges = |sliding: &SlidingSurfaces<D>| {
            let one = |side: &Side, first: usize| {
                let facet = starts_at[side.position(first)]?;
                let length = side.xi()[first + 1] - side.xi()[first];
                let nodes = &surface.facets()[facet].nodes;
                let ends = [0, 1].map(|k| nodes.iter().position(|&at| at == side.position(first + k)).unwrap_or(k));
                Some(EdgeFacet { facet, ends, length, spread: spread(problem, facet) * length })
            };
            let edges = [sliding.slave(), sliding.master()];
            Self { edges: edges.map(|side| side.edges().iter().filter_map(|&first| one(side, first)).collect()) }
        };
        surface.sliding().iter().map(edges).collect()
    }

    /// The facets on which a piece is: that of the slave and that of the master.
    pub(crate) fn of(&self, piece: &Piece) -> [usize; 2] {
        [self.edges[0][piece.slave[0]].facet, self.edges[1][piece.master[0]].facet]
    }
}

/// C over the thickness, with the energy C ℓ ∫r² ds of a traction r without resultant and moment on an edge of length
/// ℓ: (0.3 + max(0, cot θ)²)/E with the smaller angle θ of the element at the edge. It is above the largest eigenvalue
/// of the edge in nine shapes of triangles.
fn spread<const D: usize, const N: usize>(problem: &Problem<D, N>, facet: usize) -> f64 {
    let (mesh, facet) = (problem.mesh(), problem.surface().facets()[facet].facet);
    let owner: ElementId = mesh.facets()[facet.index()].owner;
    let (points, law) = (mesh.points(), problem.material(owner));
    let ends = mesh.facets()[facet.index()].nodes;
    let apex = mesh.cells()[owner.index()].iter().find(|node| !ends.contains(node)).copied().unwrap_or(ends[0]);
    let arm = |from: usize, to: usize| -> [f64; D] { std::array::from_fn(|c| points[to][c] - points[from][c]) };
    let cotangent = |k: usize| {
        let (near, far) = (ends[k].index(), ends[D - 1 - k].index());
        let (edge, side) = (arm(near, far), arm(near, apex.index()));
        let cross = edge[0] * side[D - 1] - edge[D - 1] * side[0];
        along(&edge, &side) / cross.abs()
    };
    let cotangent = cotangent(0).max(cotangent(D - 1)).max(0.0);
    let modulus = match law.hypothesis() {
        Hypothesis::PlaneStrain => law.young() / (1.0 - law.poisson() * law.poisson()),
        _ => law.young(),
    };
    (0.3 + cotangent * cotangent) / modulus / law.extent()
}

/// The density of two surfaces that slide, at an instant.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SlidingDensity<const D: usize> {
    coupling: Arc<Coupling>,
    /// R_k/w_k of the nodes of the slave (N/m).
    multipliers: Vec<[f64; D]>,
}

impl<const D: usize> SlidingDensity<D> {
    /// From the forces R_k of the nodes of the slave (N), with the coupling of the instant.
    pub(crate) fn new(coupling: &Arc<Coupling>, force: impl Fn(usize) -> [f64; D]) -> Self {
        let multiplier = |k: usize| {
            if coupling.is_active(k) { force(k).map(|f| f / coupling.weight(k)) } else { [0.0; D] }
        };
        Self { coupling: Arc::clone(coupling), multipliers: (0..coupling.len()).map(multiplier).collect() }
    }

    /// The mean of both with another coupling, for the middle of a step.
    pub(crate) fn mean(first: &Self, second: &Self, coupling: Coupling) -> Self {
        let both = first.multipliers.iter().zip(&second.multipliers);
        let half = |(a, b): (&[f64; D], &[f64; D])| std::array::from_fn(|c| 0.5 * (a[c] + b[c]));
        Self { multipliers: both.map(half).collect(), coupling: Arc::new(coupling) }
    }

    /// The multipliers (N/m).
    pub(crate) fn multipliers(&self) -> &[[f64; D]] {
        &self.multipliers
    }

    /// Whether there is no force.
    pub(crate) fn is_zero(&self) -> bool {
        self.multipliers.as_flattened().iter().all(|value| *value == 0.0)
    }

    /// The density on the slave at the ends of a piece (N/m).
    fn on(&self, piece: &Piece) -> [[f64; D]; 2] {
        let components: [[f64; 2]; D] =
            std::array::from_fn(|c| density_on(&self.coupling, piece, |node| self.multipliers[node][c]));
        [0, 1].map(|end| components.map(|ends| ends[end]))
    }

    /// Adds the linear tractions with the same moments to those of facets (Pa).
    pub(crate) fn apply<const N: usize>(
        &self,
        (problem, sliding): (&Problem<D, N>, &SlidingSurfaces<D>),
        facets: &SlidingFacets,
        linear: &mut [[[f64; D]; D]],
    ) {
        for (edge, load) in self.loads(sliding, facets) {
            let area = problem.surface().facets()[edge.facet].area;
            for k in 0..2 {
                let (value, nodal) = (&mut linear[edge.facet][edge.ends[k]], load.nodal(k));
                (0..D).for_each(|c| value[c] += nodal[c] / area);
            }
        }
    }

    /// How far it is outside of Coulomb's cone, and how far the tractions on both surfaces (Pa) are from opposite
    /// forces and couples. Both are relative.
    pub(crate) fn residuals<const N: usize>(
        &self,
        (problem, sliding): (&Problem<D, N>, &SlidingSurfaces<D>),
        facets: &SlidingFacets,
        linear: &[[[f64; D]; D]],
    ) -> [f64; 2] {
        let size = |f: &[f64; D]| f.iter().map(|x| x * x).sum::<f64>().sqrt();
        let largest = self.multipliers.iter().map(size).fold(0.0, worse);
        if largest == 0.0 {
            return [0.0; 2];
        }
        let outside = self.multipliers.iter().map(|f| {
            let [tangential, normal] = sliding.law().excess(sliding.frame(), f);
            worse(tangential, normal) / size(f).max(1e-12 * largest)
        });
        let (mut force, mut couple, mut scale) = ([0.0; D], 0.0, 0.0);
        let xi = [sliding.slave().xi(), sliding.master().xi()];
        for (side, edges) in facets.edges.iter().enumerate() {
            for (edge, first) in edges.iter().zip([sliding.slave(), sliding.master()][side].edges()) {
                let facet = &problem.surface().facets()[edge.facet];
                // Places on the slave are those of the master that it faces.
                let moved = if side == 0 { self.coupling.shifts()[sliding.slave().part_of(*first)] } else { 0.0 };
                let moments = Problem::<D, N>::facet_moments(facet.area, &linear[edge.facet]);
                for k in 0..2 {
                    let moment = moments[edge.ends[k]];
                    (0..D).for_each(|c| force[c] += moment[c]);
                    couple += (xi[side][first + k] + moved) * along(&moment, sliding.frame().normal());
                    scale += size(&moment);
                }
            }
        }
        let couple = couple.abs() / problem.mesh().size();
        [outside.fold(0.0, worse), worse(size(&force), couple) / scale.max(f64::MIN_POSITIVE)]
    }

    /// The elements with a stress beside that of these tractions, and the root of its energy, or a bound of it (J^½).
    pub(crate) fn beside<const N: usize>(
        &self,
        (problem, sliding): (&Problem<D, N>, &SlidingSurfaces<D>),
        facets: &SlidingFacets,
    ) -> Vec<(ElementId, f64)> {
        self.loads(sliding, facets).iter().flat_map(|(edge, load)| load.beside(problem, edge)).collect()
    }

    /// The loads of the edges that have any, of both surfaces.
    fn loads(&self, sliding: &SlidingSurfaces<D>, facets: &SlidingFacets) -> Vec<(EdgeFacet, Load<D>)> {
        if self.is_zero() {
            return Vec::new();
        }
        let mut loads = facets.edges.each_ref().map(|edges| vec![Load::<D>::default(); edges.len()]);
        for piece in pieces(sliding, &self.coupling) {
            let values = self.on(&piece);
            loads[0][piece.slave[0]].add(&piece, piece.on_slave, values, 1.0);
            loads[1][piece.master[0]].add(&piece, piece.on_master, values, -1.0);
        }
        let all = facets.edges.iter().flatten().copied().zip(loads.into_iter().flatten());
        all.filter(|(_, load)| !load.spans.is_empty()).collect()
    }

    /// The power of the misfit of Coulomb's law, μF_n|w_t| + w_t·F_t, half of it on each of the facets of a piece (W).
    /// `slip` has the tangential velocity of the nodes of slave and master (m/s).
    pub(crate) fn friction_power<const N: usize>(
        &self,
        problem: &Problem<D, N>,
        sliding: &SlidingSurfaces<D>,
        slip: &[Vec<f64>; 2],
        mut add: impl FnMut(&Piece, f64),
    ) {
        let (law, simplex) = (sliding.law(), problem.mesh().simplex());
        let (normal, tangent) = (sliding.frame().normal(), sliding.tangent());
        for piece in pieces(sliding, &self.coupling) {
            let [slave, master] = [piece.slave_values(|node| slip[0][node]), piece.master_values(|node| slip[1][node])];
            let values = self.on(&piece);
            let at_ends = |value: &dyn Fn(usize) -> f64| -> [f64; D] { std::array::from_fn(value) };
            let sliding = at_ends(&|end| slave[end] - master[end]);
            let (press, drag) =
                (at_ends(&|end| along(&values[end], normal)), at_ends(&|end| along(&values[end], tangent)));
            let power = |weights: &[f64; D]| {
                law.misfit(along(weights, &press), along(weights, &drag), along(weights, &sliding))
            };
            add(&piece, piece.length * simplex.facet_mean(&sliding, &power));
        }
    }
}

/// Σ λ_k χ_k at the ends of a piece, from the multipliers λ_k of the nodes of the slave.
pub(crate) fn density_on(coupling: &Coupling, piece: &Piece, multiplier: impl Fn(usize) -> f64) -> [f64; 2] {
    let [edge, first] = piece.slave;
    let (shape, values) = (coupling.shape(edge), [multiplier(first), multiplier(first + 1)]);
    piece.on_slave.map(|second| {
        let part = shape.density(second);
        part[0] * values[0] + part[1] * values[1]
    })
}

/// The density on an edge: between break points.
#[derive(Clone, Debug)]
struct Load<const D: usize> {
    moments: [[f64; D]; 2],
    /// Places of the ends along the edge, from 0 to 1, and values there (N/m).
    spans: Vec<([f64; 2], [[f64; D]; 2])>,
}

impl<const D: usize> Default for Load<D> {
    fn default() -> Self {
        Self { moments: [[0.0; D]; 2], spans: Vec::new() }
    }
}

impl<const D: usize> Load<D> {
    fn add(&mut self, piece: &Piece, places: [f64; 2], values: [[f64; D]; 2], sign: f64) {
        let values = values.map(|value| value.map(|f| sign * f));
        let first = places.map(|place| 1.0 - place);
        for c in 0..D {
            let component = values.map(|value| value[c]);
            self.moments[0][c] += piece.product(first, component);
            self.moments[1][c] += piece.product(places, component);
        }
        self.spans.push((places, values));
    }

    /// The linear traction with the same moments, at a node (N).
    fn nodal(&self, end: usize) -> [f64; D] {
        std::array::from_fn(|c| 4.0 * self.moments[end][c] - 2.0 * self.moments[1 - end][c])
    }

    /// The elements with the stress of r, and the root of its energy (J^½): the element of the edge with the bound, or
    /// those of the star of a node, where the load ends on the edge and this is less.
    fn beside<const N: usize>(&self, problem: &Problem<D, N>, edge: &EdgeFacet) -> Vec<(ElementId, f64)> {
        let (mesh, rest) = (problem.mesh(), self.rest(edge.length));
        let facet = problem.surface().facets()[edge.facet].facet;
        let mut least = vec![(mesh.facets()[facet.index()].owner, (edge.spread * rest).sqrt())];
        let total = |all: &[(ElementId, f64)]| all.iter().map(|(_, root)| root).sum::<f64>();
        if rest <= SMALL * self.square(edge.length) {
            return least;
        }
        for end in 0..2 {
            let Some(other) = self.in_star(problem, edge, end) else { continue };
            if total(&other) < total(&least) {
                least = other;
            }
        }
        least
    }

    /// The same in the star of the node at an end of the edge; none if rounding spoils its stress.
    fn in_star<const N: usize>(
        &self,
        problem: &Problem<D, N>,
        edge: &EdgeFacet,
        end: usize,
    ) -> Option<Vec<(ElementId, f64)>> {
        let (mesh, facet) = (problem.mesh(), &problem.surface().facets()[edge.facet]);
        let node = problem.surface().nodes()[facet.nodes[edge.ends[end]]].node;
        let star = mesh.stars().star(node);
        let corners = |&id: &ElementId| {
            let (points, own) = (mesh.cell_points(id), mesh.local_node(id, node).unwrap_or(0));
            let arm = |next: usize| [0, D - 1].map(|c| points[(own + next) % N][c] - points[own][c]);
            StarElement { ends: [arm(1), arm(N - 1)], law: problem.material(id) }
        };
        let elements: Vec<_> = star.elements.iter().map(corners).collect();
        let supported = [star.links.first(), star.links.last()].map(|link| {
            let supported = link.copied().flatten().map_or([false; D], |facet| problem.supported(facet));
            [supported[0], supported[D - 1]]
        });
        let side = usize::from(star.links[0] != Some(facet.facet));
        let roots = roots(&elements, side, &self.points(end, edge.length), supported)?;
        Some(star.elements.iter().copied().zip(roots).collect())
    }

    /// Places from an end on, ascending, and the density there times the length of the edge (N).
    fn points(&self, end: usize, length: f64) -> Vec<(f64, [f64; 2])> {
        let vector = |value: &[f64; D]| [value[0] * length, value[D - 1] * length];
        let all = self.spans.iter().flat_map(|(places, values)| [0, 1].map(|k| (places[k], vector(&values[k]))));
        if end == 0 { all.collect() } else { all.map(|(place, value)| (1.0 - place, value)).rev().collect() }
    }

    /// ∫F² over the edge (N²/m).
    fn square(&self, length: f64) -> f64 {
        let of = |(places, values): &([f64; 2], [[f64; D]; 2])| -> f64 {
            let sum = (0..D).map(|c| [values[0][c], values[1][c]]).map(|[a, b]| a * a + a * b + b * b);
            (places[1] - places[0]) * length / 3.0 * sum.sum::<f64>()
        };
        self.spans.iter().map(of).sum()
    }

    /// ∫r² over the edge of this length (N²/m), with the difference r of the density and that linear traction.
    fn rest(&self, length: f64) -> f64 {
        let linear = [self.nodal(0), self.nodal(1)];
        let at = |place: f64, c: usize| (linear[0][c] * (1.0 - place) + linear[1][c] * place) / length;
        let (mut sum, mut reached) = (0.0, 0.0);
        let mut add = |[from, to]: [f64; 2], values: [[f64; D]; 2]| {
            for c in 0..D {
                let [a, b] = [values[0][c] - at(from, c), values[1][c] - at(to, c)];
                sum += (to - from) * length / 3.0 * (a * a + a * b + b * b);
            }
        };
        for &(places, values) in &self.spans {
            add([reached, places[0]], [[0.0; D]; 2]);
            add(places, values);
            reached = places[1];
        }
        add([reached, 1.0], [[0.0; D]; 2]);
        sum
    }
}

#[cfg(test)]
mod tests;
