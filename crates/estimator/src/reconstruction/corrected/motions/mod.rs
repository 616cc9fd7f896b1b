//! A second solution of the motion, under the admissible contact force and with less dispersion, and three motions
//! beside it.
//!
//! Fields that balance the simulation's own displacements repeat its dispersion and hide it: the waves of the
//! simulation and those of the balance are late together. The *auxiliary solution* is balanced instead. It starts like
//! the simulation and takes the steps of the same scheme, but under the nodal forces of F_DA, and with the acceleration
//!
//! a = ã + p(M⁻¹(M − M_c))ã − (Δt²/12) M⁻¹K ã,   p(μ) = μ/2 − βμ²,   M ã = F + F_DA − K u,
//!
//! M the lumped and M_c the consistent mass. The leading errors of the lumped mass and of the central
//! differences, of the same size and of opposite sign, are thus taken out: dispersion is of fourth order on a
//! uniform bar, where at the critical step both cancel and β alone is left. ã itself, of which Γ_DA and
//! the tractions are made, balances M ã as before.
//!
//! Three more motions tell the sources of the difference of simulation and auxiliary solution apart:
//!
//! - The *half-size solution* is an auxiliary solution with three quarters of both corrections: the leading dispersion
//!   that is left is that of elements and steps half as long.
//! - The *half-step solution* has the reactions of the simulation, its lumped mass, and three quarters of the
//!   correction of the central differences: it moves like a simulation with steps half as long.
//! - The *contact difference* is the motion from rest, by the scheme of the simulation, under the difference of its
//!   reactions and the nodal forces of F_DA.
//!
//! The four motions are lanes: they are gathered, multiplied and updated together, in one pass over the mesh for a
//! step.

mod approach;
mod blocks;
#[cfg(test)]
mod comparison;
mod energies;
mod lanes;
mod pairs;
mod parts;
mod pass;
mod surface;
mod sweeps;
#[cfg(test)]
mod tests;
mod weights;

use crate::difference::Difference;
use crate::element::Element;
use crate::simd::run_task;
pub(super) use approach::{Approach, FreeMotion};
use approach::{BeforePass, NearElements};
use blocks::Blocks;
use energies::Energies;
use lanes::{FirstPair, Nodal};
use pairs::{Pair, Pairs};
use parts::{Part, Plan, View, for_all};
use pass::{Kinetic, PartPass, Pass};
use percute_core::dynamics::Dynamics;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use surface::SurfaceForces;
pub(super) use weights::Shares;
use weights::Weights;

/// An auxiliary solution whose kinetic energy is so many times the largest energy of the simulation is unstable: its
/// error would be a thousand times the energy.
const UNSTABLE: f64 = 1e6;

/// The four motions, advanced beside the simulation's steps.
#[derive(Debug)]
pub(super) struct Motions<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D, N>,
    times: &'p TimeGrid,
    blocks: Blocks,
    plan: Plan,
    pairs: Pairs,
    surface: SurfaceForces,
    near: NearElements<D>,
    weights: Weights,
    energies: Option<Energies<'p, D, N>>,
    fields: Fields,
    /// F_n (N); empty without loads.
    external: Vec<[f64; D]>,
    /// The step that has to be made from `displacement` before it is that of the present level (s).
    due: f64,
    /// Largest kinetic and strain energy of the simulation so far (J).
    peak_energy: f64,
    /// ½ v·M v of the auxiliary solution half a step after the last level (J).
    kinetic: f64,
    differences: Vec<Difference>,
}

/// Nodal fields of all motions.
#[derive(Debug)]
struct Fields {
    /// u_n (m), from the pass of level n to that of the next.
    displacement: Vec<Nodal>,
    /// v_{n+½} (m/s).
    half_step: Vec<Nodal>,
    /// Forces and ã_n during a pass, v_n after it (m/s).
    rate: Vec<Nodal>,
    /// −Kã (N).
    internal: Vec<Nodal>,
    /// M⁻¹(M − M_c)ã (m/s²).
    once: Vec<FirstPair>,
    /// (M − M_c)M⁻¹(M − M_c)ã (N).
    twice: Vec<FirstPair>,
}

/// A level of the simulation.
#[derive(Clone, Copy, Debug)]
pub(super) struct SimulatedLevel<'a, const D: usize> {
    /// u̇_CA (m/s).
    pub(super) velocity: &'a [[f64; D]],
    /// Strain energy (J).
    pub(super) strain: f64,
    /// Reactions at the nodes of the contact surface (N).
    pub(super) reaction: &'a [[f64; D]],
}

/// The fields of the auxiliary solution at a level.
#[derive(Debug)]
pub(super) struct AuxiliaryLevel<'a, const D: usize> {
    /// u_n (m).
    pub(super) displacement: &'a mut [[f64; D]],
    /// Forces but those of contact, with those of supports (N).
    pub(super) force: &'a mut [[f64; D]],
    /// M⁻¹(M − M_c)ã (m/s²), if it is wanted.
    pub(super) lumping_difference: Option<&'a mut [[f64; D]]>,
}

impl<'a, const D: usize> AuxiliaryLevel<'a, D> {
    /// No fields.
    fn none() -> Self {
        Self { displacement: &mut [], force: &mut [], lumping_difference: None }
    }

    /// The same for a shorter time.
    fn again(&mut self) -> AuxiliaryLevel<'_, D> {
        AuxiliaryLevel {
            displacement: self.displacement,
            force: self.force,
            lumping_difference: self.lumping_difference.as_deref_mut(),
        }
    }

    /// Cuts before a node.
    fn split(self, node: usize) -> (Self, Self) {
        let (displacement, force) = (cut(self.displacement, node), cut(self.force, node));
        let lumping = self.lumping_difference.map(|field| cut(field, node));
        let (first, last) = lumping.map_or((None, None), |(first, last)| (Some(first), Some(last)));
        (
            Self { displacement: displacement.0, force: force.0, lumping_difference: first },
            Self { displacement: displacement.1, force: force.1, lumping_difference: last },
        )
    }
}

/// The parts of a field before and after a place; a field that is not wanted is empty.
fn cut<T>(field: &mut [T], at: usize) -> (&mut [T], &mut [T]) {
    field.split_at_mut(at.min(field.len()))
}

impl<'p, const D: usize, const N: usize> Motions<'p, D, N> {
    /// About how much memory it takes (bytes).
    pub(super) fn memory(nodes: usize, elements: usize) -> usize {
        let node = 4 * size_of::<Nodal>() + 2 * size_of::<FirstPair>() + size_of::<[f64; D]>();
        nodes.saturating_mul(node).saturating_add(elements.div_ceil(2).saturating_mul(size_of::<Pair>()))
    }

    /// Before the first level, with these shares of the corrections of the auxiliary solution.
    pub(super) fn new(problem: &'p Problem<D, N>, times: &'p TimeGrid, shares: Shares) -> Self {
        let blocks = Blocks::new(problem.mesh().cells(), problem.mesh().node_count());
        Self::on_blocks(problem, times, shares, blocks)
    }

    /// The same with blocks of another size.
    fn on_blocks(problem: &'p Problem<D, N>, times: &'p TimeGrid, shares: Shares, blocks: Blocks) -> Self {
        let pairs = Pairs::new(problem, &blocks);
        Self {
            problem,
            times,
            near: NearElements::new(problem, &blocks, &pairs),
            plan: Plan::new(&blocks),
            blocks,
            pairs,
            surface: SurfaceForces::new(problem),
            weights: Weights::new::<D>(shares),
            energies: None,
            fields: Fields::new(problem),
            external: if problem.is_loaded() { vec![[0.0; D]; problem.mesh().node_count()] } else { Vec::new() },
            due: 0.0,
            peak_energy: 0.0,
            kinetic: 0.0,
            differences: Vec::new(),
        }
    }

    /// Prepares the energies of differences.
    pub(super) fn prepare(&mut self, elements: &[Element<D, N>]) {
        self.energies = Some(Energies::new(self.problem, elements));
    }

    /// Takes in the loads and supports of a level. Levels come in order.
    pub(super) fn begin(&mut self, dynamics: &Dynamics<'_, D, N>, n: usize) {
        if !self.external.is_empty() {
            self.problem.external_forces(self.times.instants()[n], &mut self.external);
        }
        self.surface.hold(dynamics, n);
    }

    /// The motion of the auxiliary solution at all contact nodes until t_{n+1} without a contact force, corrections
    /// left out.
    pub(super) fn free_motions(&mut self, dynamics: &Dynamics<'_, D, N>, n: usize) -> &[FreeMotion<D>] {
        let Self { times, pairs, surface, near, fields, external, due, .. } = self;
        let before = BeforePass { laws: &pairs.laws, surface, fields, external, due: *due };
        near.motions(dynamics, (times, n), &before)
    }

    /// Takes in a level: forces of the density on the nodes of the contact surface (N). Goes on to the next half step
    /// and fills in the fields of the auxiliary solution.
    pub(super) fn advance(
        &mut self,
        dynamics: &Dynamics<'_, D, N>,
        n: usize,
        simulated: &SimulatedLevel<'_, D>,
        pull: &[[f64; D]],
        level: AuxiliaryLevel<'_, D>,
    ) {
        self.surface.contact(pull, simulated.reaction);
        let pass = Pass {
            pairs: &self.pairs,
            blocks: &self.blocks,
            surface: &self.surface,
            external: &self.external,
            mass: self.problem.mass(),
            inverse_mass: dynamics.inverse_mass(),
            simulated: simulated.velocity,
            weights: self.weights.at(self.times, n),
            due: self.due,
            back: if n == 0 { 0.0 } else { 0.5 * self.times.step(n - 1) },
            forward: self.times.velocity_step(n),
        };
        let work = |part: &Part, view: View<'_, D>| run_task(PartPass { pass: &pass, part, view });
        let kinetic = for_all(&self.plan, View::new(&mut self.fields, level), &work);
        let sum = |of: fn(&Kinetic) -> f64| 0.5 * kinetic.iter().map(of).sum::<f64>();
        self.peak_energy = self.peak_energy.max(simulated.strain + sum(|k| k.simulated));
        self.kinetic = sum(|k| k.auxiliary);
        self.due = self.times.step(n);
        self.differences.resize(n + 1, Difference::default());
    }

    /// Measures the difference of the simulation and the auxiliary solution at the last level taken in. Once for a
    /// level.
    pub(super) fn differ(&mut self, simulated: [&[[f64; D]]; 2], halvings: [f64; 2]) {
        if let (Some(energies), Some(last)) = (&self.energies, self.differences.last_mut()) {
            let measured = energies.measure((&self.pairs, &self.blocks, &self.plan), &mut self.fields, simulated);
            *last = Difference { halvings, ..measured };
        }
    }

    /// The differences at all levels so far: those that were measured.
    pub(super) fn differences(&self) -> &[Difference] {
        &self.differences
    }

    /// Whether the auxiliary solution has become unstable, as it does where a history of another scheme takes steps
    /// above the critical one. A stable one has about the energy of the simulation, an unstable one soon any.
    pub(super) fn is_unstable(&self) -> bool {
        // A body that starts unstrained at rest has no energy before it is loaded.
        self.peak_energy > 0.0 && self.kinetic > UNSTABLE * self.peak_energy
    }
}

impl Fields {
    fn new<const D: usize, const N: usize>(problem: &Problem<D, N>) -> Self {
        let count = problem.mesh().node_count();
        Self {
            displacement: problem.initial_displacement().iter().map(Nodal::all_but_contact).collect(),
            half_step: problem.initial_velocity().iter().map(Nodal::all_but_contact).collect(),
            rate: vec![Nodal::ZERO; count],
            internal: vec![Nodal::ZERO; count],
            once: vec![FirstPair::ZERO; count],
            twice: vec![FirstPair::ZERO; count],
        }
    }
}
