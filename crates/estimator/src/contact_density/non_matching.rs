//! Densities of non-matching interfaces.
//!
//! The force R_k of a node of the slave is the density R_k/w_k χ_k on its edges, or hats where edges leave the other
//! surface, and the opposite one on the master at the same place. On an edge of either surface it is linear between the
//! nodes of both and the ends of hats. All but its own stress in the elements knows the linear traction with the same
//! moments. The difference of the two balances itself; the norm of its stress has a bound, C h ∫r², for any partition
//! of the edge.

mod faces;
mod load;
mod residual;
mod residual_stress;
mod slave_hat;

use crate::direction::along;
use crate::partition::{Break, Piece, pieces};
use crate::residual::worse;
pub(crate) use faces::NonMatchingFaces;
use load::Load;
use percute_core::cell::face_mean;
use percute_core::contact::{Coupling, NonMatchingSurfaces};
use percute_core::problem::Problem;
use residual::{Stresses, of_edge};
pub(crate) use residual_stress::ResidualStress;
pub(crate) use slave_hat::SlaveHat;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The density of a non-matching interface, at an instant. Of one dimension, its normal part.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct NonMatchingDensity<const D: usize> {
    coupling: Arc<Coupling>,
    /// R_k/w_k of the nodes of the slave (N/m).
    multipliers: Vec<[f64; D]>,
    /// The tractions of other nodes, in order, but for a mean.
    hats: Vec<SlaveHat<D>>,
}

impl<const D: usize> NonMatchingDensity<D> {
    /// From the forces R_k of the nodes of the slave (N), with the coupling of the instant, and hats, in the order of
    /// their nodes.
    pub(crate) fn new(coupling: &Arc<Coupling>, force: impl Fn(usize) -> [f64; D], hats: Vec<SlaveHat<D>>) -> Self {
        Self::with_multipliers(coupling, |k| force(k).map(|f| f / coupling.weight(k)), hats)
    }

    /// The same from multipliers (N/m).
    pub(crate) fn with_multipliers(
        coupling: &Arc<Coupling>,
        multiplier: impl Fn(usize) -> [f64; D],
        hats: Vec<SlaveHat<D>>,
    ) -> Self {
        let acting = |k: usize| if coupling.is_active(k) { multiplier(k) } else { [0.0; D] };
        Self { coupling: Arc::clone(coupling), multipliers: (0..coupling.len()).map(acting).collect(), hats }
    }

    /// The mean of both with another coupling, for the middle of a step: hats of both, superposed.
    pub(crate) fn mean(first: &Self, second: &Self, coupling: &Arc<Coupling>) -> Self {
        let both = first.multipliers.iter().zip(&second.multipliers);
        let half = |(a, b): (&[f64; D], &[f64; D])| std::array::from_fn(|c| 0.5 * (a[c] + b[c]));
        let hats = first.hats.iter().chain(&second.hats);
        let hats = hats.map(|hat| SlaveHat { resultant: hat.resultant.map(|f| 0.5 * f), ..*hat }).collect();
        Self { multipliers: both.map(half).collect(), coupling: Arc::clone(coupling), hats }
    }

    /// Its component along a unit vector.
    pub(crate) fn component(&self, direction: &[f64; D]) -> NonMatchingDensity<1> {
        let of = |f: &[f64; D]| [along(f, direction)];
        let hat = |hat: &SlaveHat<D>| {
            let SlaveHat { node, edge, end, length, halvings, ref resultant } = *hat;
            SlaveHat { node, edge, end, length, halvings, resultant: of(resultant) }
        };
        NonMatchingDensity {
            coupling: Arc::clone(&self.coupling),
            multipliers: self.multipliers.iter().map(of).collect(),
            hats: self.hats.iter().map(hat).collect(),
        }
    }

    /// The multipliers (N/m).
    pub(crate) fn multipliers(&self) -> &[[f64; D]] {
        &self.multipliers
    }

    /// The hats, in the order of their nodes, but for those of a mean.
    pub(crate) fn hats(&self) -> &[SlaveHat<D>] {
        &self.hats
    }

    /// Whether there is no force.
    pub(crate) fn is_zero(&self) -> bool {
        self.multipliers.as_flattened().iter().all(|value| *value == 0.0) && self.hats.is_empty()
    }

    /// The ends of its hats.
    pub(crate) fn breaks(&self) -> Vec<Break> {
        self.hats.iter().map(SlaveHat::ends_at).collect()
    }

    /// The density on the slave at the ends of a piece (N/m), inside of which no hat ends.
    pub(crate) fn on(&self, piece: &Piece) -> [[f64; D]; 2] {
        let mut values = self.wide_on(piece);
        let own = self.hats.iter().filter(|hat| hat.edge == piece.slave[0]);
        own.for_each(|hat| add(&mut values, hat.on(piece)));
        values
    }

    /// The same without hats: Σ λ_k χ_k.
    fn wide_on(&self, piece: &Piece) -> [[f64; D]; 2] {
        let [edge, first] = piece.slave;
        let (shape, [a, b]) = (self.coupling.shape(edge), [first, first + 1].map(|k| &self.multipliers[k]));
        piece.on_slave.map(|second| {
            let part = shape.density(second);
            std::array::from_fn(|c| part[0] * a[c] + part[1] * b[c])
        })
    }

    /// Adds the linear tractions with the same moments to those of faces (Pa), but those of narrow hats on the slave,
    /// which are hats of their node.
    pub(crate) fn apply(
        &self,
        (problem, non_matching): (&Problem<D>, &NonMatchingSurfaces<D>),
        faces: &NonMatchingFaces,
        linear: &mut [[[f64; D]; D]],
    ) {
        let narrow: Vec<&SlaveHat<D>> = self.hats.iter().filter(|hat| hat.is_narrow()).collect();
        for ((side, edge), load) in self.wide(non_matching).into_iter().chain(self.narrow(non_matching, &narrow)) {
            let edge = &faces.edges[side][edge];
            let area = problem.surface().faces()[edge.face].area;
            for k in 0..2 {
                let (value, nodal) = (&mut linear[edge.face][edge.ends[k]], load.nodal(k));
                (0..D).for_each(|c| value[c] += nodal[c] / area);
            }
        }
    }

    /// How far it is outside of Coulomb's cone, and how far the tractions on both surfaces (Pa) are from opposite
    /// forces and couples. Both are relative.
    pub(crate) fn residuals(
        &self,
        (problem, non_matching): (&Problem<D>, &NonMatchingSurfaces<D>),
        faces: &NonMatchingFaces,
        linear: &[[[f64; D]; D]],
    ) -> [f64; 2] {
        let size = |f: &[f64; D]| f.iter().map(|x| x * x).sum::<f64>().sqrt();
        if self.is_zero() {
            return [0.0; 2];
        }
        let outside = |forces: &[[f64; D]]| {
            let least = 1e-12 * forces.iter().map(size).fold(0.0, worse);
            let one = |f: &[f64; D]| {
                let [tangential, normal] = non_matching.law().excess(non_matching.frame(), f);
                worse(tangential, normal) / size(f).max(least).max(f64::MIN_POSITIVE)
            };
            forces.iter().map(one).fold(0.0, worse)
        };
        let resultants: Vec<[f64; D]> = self.hats.iter().map(|hat| hat.resultant).collect();
        let outside = worse(outside(&self.multipliers), outside(&resultants));
        let (mut force, mut couple, mut scale) = ([0.0; D], 0.0, 0.0);
        let xi = [non_matching.slave().xi(), non_matching.master().xi()];
        for (side, edges) in faces.edges.iter().enumerate() {
            for (edge, first) in edges.iter().zip([non_matching.slave(), non_matching.master()][side].edges()) {
                let face = &problem.surface().faces()[edge.face];
                // Places on the slave are those of the master that it faces.
                let moved = if side == 0 { self.coupling.shifts()[non_matching.slave().part_of(*first)] } else { 0.0 };
                let moments = Problem::<D>::face_moments(face.area, &linear[edge.face]);
                for k in 0..2 {
                    let moment = moments[edge.ends[k]];
                    (0..D).for_each(|c| force[c] += moment[c]);
                    couple += (xi[side][first + k] + moved) * along(&moment, non_matching.frame().normal());
                    scale += size(&moment);
                }
            }
        }
        let couple = couple.abs() / problem.mesh().size();
        [outside, worse(size(&force), couple) / scale.max(f64::MIN_POSITIVE)]
    }

    /// The elements with stresses beside that of linear tractions and of the hats of nodes.
    pub(crate) fn residual(
        &self,
        (problem, non_matching): (&Problem<D>, &NonMatchingSurfaces<D>),
        faces: &NonMatchingFaces,
    ) -> Stresses {
        let of_edge = |loads: Loads<D>| {
            let one =
                |((side, edge), load): (&(usize, usize), &Load<D>)| of_edge(problem, &faces.edges[*side][*edge], load);
            loads.iter().flat_map(one).collect::<Stresses>()
        };
        // Each node with hats by itself: they have one place on the master.
        let narrow: Vec<&SlaveHat<D>> = self.hats.iter().filter(|hat| hat.is_narrow()).collect();
        let narrow = narrow.chunk_by(|a, b| a.node == b.node).map(|hats| self.narrow(non_matching, hats));
        std::iter::once(self.wide(non_matching)).chain(narrow).flat_map(of_edge).collect()
    }

    /// The loads of all but narrow hats, on both surfaces.
    fn wide(&self, non_matching: &NonMatchingSurfaces<D>) -> Loads<D> {
        if self.is_zero() {
            return Loads::new();
        }
        let mut loads = Loads::new();
        for piece in pieces(non_matching, &self.coupling) {
            let mut values = self.wide_on(&piece);
            let own = self.hats.iter().filter(|hat| hat.edge == piece.slave[0] && !hat.is_narrow());
            own.for_each(|hat| add(&mut values, hat.on(&piece)));
            load(&mut loads, (0, piece.slave[0]), &piece, (piece.on_slave, values));
            load(&mut loads, (1, piece.master[0]), &piece, (piece.on_master, opposite(values)));
        }
        loads
    }

    /// The loads of some narrow hats, on the master.
    fn narrow(&self, non_matching: &NonMatchingSurfaces<D>, hats: &[&SlaveHat<D>]) -> Loads<D> {
        let mut loads = Loads::new();
        if hats.is_empty() {
            return loads;
        }
        let breaks: Vec<Break> = hats.iter().map(|hat| hat.ends_at()).collect();
        for piece in pieces(non_matching, &self.coupling) {
            let own: Vec<_> = hats.iter().filter(|hat| hat.edge == piece.slave[0]).collect();
            if own.is_empty() {
                continue;
            }
            for piece in piece.cut(&breaks) {
                let mut values = [[0.0; D]; 2];
                own.iter().for_each(|hat| add(&mut values, hat.on(&piece)));
                load(&mut loads, (1, piece.master[0]), &piece, (piece.on_master, opposite(values)));
            }
        }
        loads
    }

    /// The power of the misfit of Coulomb's law, μF_n|w_t| + w_t·F_t, half of it on each of the faces of a piece (W).
    /// `slip` has the tangential velocity of the nodes of slave and master (m/s).
    pub(crate) fn friction_power(
        &self,
        non_matching: &NonMatchingSurfaces<D>,
        slip: &[Vec<f64>; 2],
        mut add: impl FnMut(&Piece, f64),
    ) {
        let law = non_matching.law();
        let (normal, tangent) = (non_matching.frame().normal(), non_matching.tangent());
        let breaks = self.breaks();
        for piece in pieces(non_matching, &self.coupling).flat_map(|piece| piece.cut(&breaks)) {
            let [slave, master] = [piece.slave_values(|node| slip[0][node]), piece.master_values(|node| slip[1][node])];
            let values = self.on(&piece);
            let at_ends = |value: &dyn Fn(usize) -> f64| -> [f64; D] { std::array::from_fn(value) };
            let sliding = at_ends(&|end| slave[end] - master[end]);
            let (press, drag) =
                (at_ends(&|end| along(&values[end], normal)), at_ends(&|end| along(&values[end], tangent)));
            let power = |weights: &[f64; D]| {
                law.misfit(along(weights, &press), along(weights, &drag), along(weights, &sliding))
            };
            add(&piece, piece.length * face_mean(&sliding, power));
        }
    }
}

/// The loads of edges, by side (0 the slave) and position among its edges.
type Loads<const D: usize> = BTreeMap<(usize, usize), Load<D>>;

/// Adds a piece with these places and values at its ends (N/m) to the load of an edge.
fn load<const D: usize>(
    loads: &mut Loads<D>,
    edge: (usize, usize),
    piece: &Piece,
    (places, values): ([f64; 2], [[f64; D]; 2]),
) {
    if values.as_flattened().iter().any(|value| *value != 0.0) {
        loads.entry(edge).or_default().add(piece, places, values);
    }
}

fn opposite<const D: usize>(values: [[f64; D]; 2]) -> [[f64; D]; 2] {
    values.map(|value| value.map(|f| -f))
}

fn add<const D: usize>(sum: &mut [[f64; D]; 2], values: [[f64; D]; 2]) {
    sum.as_flattened_mut().iter_mut().zip(values.as_flattened()).for_each(|(sum, value)| *sum += value);
}

#[cfg(test)]
mod tests;
