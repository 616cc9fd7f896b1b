//! The auxiliary solution of solids of linear tetrahedra: one motion, small strains.
//!
//! With K_s of strains smoothed over edges and nodes ([`crate::smoothing`]), M ã = F + F_DA − K_s u, μ = 1 − M⁻¹M_c,
//! o = μã and v at the half step before,
//!
//! a = ã + p(μ)ã − (Δt²/12) M⁻¹Kã − ζΔt_c M⁻¹(K − K_s)v,   p(μ) = c₁μ + c₂μ² − c₃μ³.
//!
//! Contact drives short waves, which K_s made softer than K. The last term damps these: K − K_s is 0 for rigid motions,
//! never negative, and of third order for long waves. The mass term is split with all of p:
//!
//! a_c = ã + p(μ)ã,   w = (1 − c₁)ã + (c₁ − c₂)o + (c₂ + c₃)μo − c₃μ²o,   M ã = M_c a_c + (M − M_c)w.

#[cfg(test)]
mod comparison;
#[cfg(test)]
mod dense;
mod lumping;
mod motion;
mod operator;
mod stability;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod waves;

use super::balance::{EnergyBalance, half_work, kinetic_energy};
use super::surface::SurfaceForces;
use super::weights::{Shares, Weights};
use super::{AuxiliaryLevel, SimulatedLevel, SplitLevel, UNSTABLE};
use crate::element::Element;
use crate::smoothing::Smoothing;
use motion::{CorrectionWeights, SolidMotion};
use operator::SolidOperator;
use percute_core::dynamics::{Dynamics, element_time_step};
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use std::sync::Arc;

/// ζΔt_c over the bound of Δt_c from single elements, which neither numbers nor planes of symmetry change: ζ is 0.19 on
/// cubes cut into six. With half of it slivers let short waves grow to three times the error; with 1.5 times it, some
/// meshes are unstable at 0.9 Δt_c.
const DAMPING: f64 = 0.25;

/// The auxiliary solution after the last level.
#[derive(Debug)]
pub(in crate::reconstruction::corrected) struct SolidAuxiliary<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D>,
    times: &'p TimeGrid,
    weights: Weights,
    /// ζΔt_c (s).
    damping: f64,
    operator: SolidOperator<'p, D, N>,
    motion: SolidMotion<D, N>,
    /// Loads and contact forces (N).
    external: Vec<[f64; D]>,
    surface: SurfaceForces,
    energy_balance: EnergyBalance<D>,
}

impl<'p, const D: usize, const N: usize> SolidAuxiliary<'p, D, N> {
    /// About how much memory it takes (bytes).
    pub(super) fn memory(nodes: usize, elements: usize) -> usize {
        // Sixteen nodal fields, and the table of neighbours, some fourteen for a node.
        let node = 16 * size_of::<[f64; D]>() + 14 * size_of::<[f64; 2]>();
        // Strains, sums of some 1.4 patches and two sets of forces; corners.
        let element = size_of::<Element<D, N>>() + 15 * size_of::<f64>() + 2 * size_of::<[[f64; D]; N]>() + 4 * N;
        nodes.saturating_mul(node).saturating_add(elements.saturating_mul(element))
    }

    /// Before the first level.
    pub(super) fn new(problem: &'p Problem<D>, times: &'p TimeGrid, smoothing: Arc<Smoothing>, own: Shares) -> Self {
        Self {
            problem,
            times,
            weights: Weights::new(&smoothing, own),
            damping: DAMPING * element_time_step(problem),
            operator: SolidOperator::new(problem, smoothing),
            motion: SolidMotion::new(problem.initial_displacement(), problem.initial_velocity()),
            external: vec![[0.0; D]; problem.mesh().node_count()],
            surface: SurfaceForces::new(problem),
            energy_balance: EnergyBalance::new(problem),
        }
    }

    /// Takes in the data of the elements, and makes sure that the scheme is stable.
    pub(super) fn prepare(&mut self, elements: &[Element<D, N>]) {
        self.operator.elements = elements.to_vec();
        self.stabilise();
    }

    pub(super) fn energy_balance(&self) -> &EnergyBalance<D> {
        &self.energy_balance
    }

    pub(super) fn is_unstable(&self) -> bool {
        self.energy_balance.is_beyond(UNSTABLE)
    }

    /// Whether strains are smoothed at the level that has begun.
    pub(super) fn smooths(&self) -> bool {
        self.weights.smooths() && self.operator.smoothing.smooths()
    }

    /// Takes in the loads of a level. Levels come in order.
    pub(super) fn begin(&mut self, n: usize) {
        self.weights.begin(self.times, n);
        match self.problem.is_loaded() {
            true => self.problem.external_forces(self.times.instants()[n], &mut self.external),
            false => self.external.fill([0.0; D]),
        }
    }

    /// The weights with these steps after and before a level; that before it is none at the start.
    fn correction(&self, times: &TimeGrid, n: usize) -> CorrectionWeights {
        let smooths = self.smooths();
        CorrectionWeights {
            mass: self.weights.mass(0),
            time: self.weights.at(times, n).time[0].0[0],
            damping: if smooths { self.damping } else { 0.0 },
            smooths,
            last_step: (n > 0).then(|| times.step(n - 1)),
        }
    }

    /// Takes in a level under forces on the nodes of the contact surface (N), and goes on to the next one.
    pub(super) fn advance(
        &mut self,
        dynamics: &Dynamics<'_, D>,
        n: usize,
        simulated: &SimulatedLevel<'_, D>,
        pull: &[[f64; D]],
        level: AuxiliaryLevel<'_, D>,
    ) {
        let (problem, times, weights) = (self.problem, self.times, self.correction(self.times, n));
        for (contact, pull) in problem.surface().nodes().iter().zip(pull) {
            (0..D).for_each(|c| self.external[contact.node.index()][c] += pull[c]);
        }
        self.motion.respond(&self.operator, &weights, &self.external);
        for (i, p) in problem.prescribed().iter().enumerate() {
            self.motion.plain[p.node.index()][p.component] = dynamics.prescribed_acceleration(n, i);
        }
        self.motion.correct(&self.operator, &weights, level.split.is_some());
        self.write(level);
        let before = self.half_work(pull, if n == 0 { 0.0 } else { times.step(n - 1) });
        self.motion.advance(&self.operator, &weights, (times, n));
        let after = self.half_work(pull, times.step(n));
        let kinetic = |velocity: &[[f64; D]]| kinetic_energy(problem, velocity);
        let energies = [simulated.strain + kinetic(simulated.velocity), kinetic(&self.motion.half_step)];
        self.energy_balance.add(problem, energies, simulated.velocity, before + after);
    }

    /// Fills in the fields of the level.
    fn write(&self, level: AuxiliaryLevel<'_, D>) {
        let SolidMotion { displacement, plain, consistent, lumped, skew, .. } = &self.motion;
        level.displacement.copy_from_slice(displacement);
        level.acceleration.copy_from_slice(if level.split.is_some() { consistent } else { plain });
        if let Some(split) = level.split {
            let SplitLevel { lumped: w, skew: o } = split;
            w.copy_from_slice(lumped);
            o.copy_from_slice(skew);
        }
    }

    /// The work of contact over half of a step (J).
    fn half_work(&self, pull: &[[f64; D]], step: f64) -> f64 {
        half_work((self.problem, &self.surface), |node| self.motion.half_step[node], pull, step)
    }
}
