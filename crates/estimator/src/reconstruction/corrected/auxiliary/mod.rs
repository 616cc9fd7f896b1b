//! A second solution of the motion, under the admissible contact force and with less dispersion, and three motions
//! beside it.
//!
//! Fields that balance the simulation's own displacements repeat its dispersion and hide it: the waves of the
//! simulation and those of the balance are late together. The *auxiliary solution* is balanced instead. It starts like
//! the simulation and takes the steps of the same scheme, but under the nodal forces of F_DA, and with the acceleration
//!
//! a = ã + p(M⁻¹(M − M_c))ã − (Δt²/12) M⁻¹K ã,   p(μ) = c₁μ + c₂μ² − c₃μ³,   M ã = F + F_DA − K_s u,
//!
//! M the lumped and M_c the consistent mass, K_s the stiffness of smoothed strains ([`crate::smoothing`]). The leading
//! errors of the elements, of the lumped mass and of the central differences are thus taken out: dispersion is of
//! fourth order on even meshes. On bars strains stay, and at the critical step the last two errors cancel. The
//! balance is that of M ã, whose mass term is split: M ã = M_c a_c + (M − M_c) w with
//!
//! a_c = ã + c₁o,   w = (1 − c₁)ã + c₁o,   o = M⁻¹(M − M_c)ã.
//!
//! Γ_DA is made of a_c. (M − M_c) w is in each element exactly the stress τ = ρ/(D + 2) Σ w_i ⊗ d_i, d_i from the
//! centroid; its symmetric part is balanced with that of the element, its skew part as the acceleration
//! o₂ = M⁻¹ Σ|E|(τ − τˢ)∇φ.
//!
//! Three more motions tell the sources of the difference of simulation and auxiliary solution apart:
//!
//! - The *halved-elements solution* is an auxiliary solution with three quarters of all corrections: the leading
//!   dispersion that is left is that of elements and steps half as long.
//! - The *halved-step solution* has the reactions of the simulation, its lumped mass, and three quarters of the
//!   correction of the central differences: it moves like a simulation with steps half as long.
//! - The *contact difference* is the motion from rest, by the scheme of the simulation, under the difference of its
//!   reactions and the nodal forces of F_DA.
//!
//! The four motions are lanes: they are gathered, multiplied and updated together, in one pass over the mesh for a
//! step.
//!
//! Bodies that turn have a motion of their own in [`finite`], solids in [`solid`], each without those beside it.

mod approach;
mod balance;
mod blocks;
#[cfg(test)]
mod comparison;
mod either;
mod energies;
mod finite;
mod internal_forces;
mod lanes;
mod pairs;
mod parts;
mod pass;
mod patch;
mod plastic;
mod response;
mod solid;
mod stability;
mod surface;
mod sweeps;
#[cfg(test)]
mod tests;
mod weights;

use crate::difference::Difference;
use crate::element::Element;
use crate::plastic::EigenStrains;
use crate::smoothing::Smoothing;
pub(super) use approach::{Approach, Foreseen, FreeFlight, Mobility};
use approach::{BeforePass, ContactElements};
use balance::{EnergyBalance, half_work};
use blocks::Blocks;

pub(super) use either::Auxiliary;
use energies::Energies;
use lanes::{FirstPair, Gradient, Nodal};
use pairs::{PairSurroundings, Pairs, TrianglePair};
use parts::{Part, Plan, Start, StartOf, View, for_all};
use pass::{Kinetic, PartPass, Pass};
use patch::{Factors, PatchOperator};
use percute_core::dynamics::Dynamics;
use percute_core::problem::Problem;
use percute_core::simd::run_task;
use percute_core::time::TimeGrid;
use plastic::PlasticStrains;
use std::sync::Arc;
use surface::SurfaceForces;
pub(super) use weights::Shares;
use weights::Weights;

/// An auxiliary solution whose kinetic energy is so many times the largest energy of the simulation is unstable: its
/// error would be a thousand times the energy.
const UNSTABLE: f64 = 1e6;

/// The four motions, advanced beside the simulation's steps.
#[derive(Debug)]
pub(super) struct AuxiliarySolutions<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D>,
    times: &'p TimeGrid,
    smoothing: Arc<Smoothing>,
    blocks: Blocks,
    plan: Plan,
    pairs: Pairs,
    surface: SurfaceForces,
    near: ContactElements<D>,
    weights: Weights,
    energies: Option<Energies<'p, D, N>>,
    fields: MotionFields,
    /// F_n and the forces of plastic strains (N); empty without both.
    external: Vec<[f64; D]>,
    plastic: Option<PlasticStrains<D, N>>,
    /// The step that has to be made from `displacement` before it is that of the present level (s).
    due: f64,
    energy_balance: EnergyBalance<D>,
    differences: Vec<Difference>,
}

/// Fields of all motions.
#[derive(Debug, Default)]
struct MotionFields {
    /// u_n (m), from the pass of level n to that of the next.
    displacement: Vec<Nodal>,
    /// v_{n+½} (m/s).
    half_step: Vec<Nodal>,
    /// Forces and ã_n during a pass, v_n after it (m/s).
    rate: Vec<Nodal>,
    /// −Kã (N).
    internal: Vec<Nodal>,
    /// M⁻¹(M − M_c)ã (m/s²), and the same of it once and twice.
    lumping: [Vec<FirstPair>; 3],
    /// V∇u of elements (m³); empty where strains stay.
    gradients: Vec<Gradient>,
    /// Their sums at patches, times the weight.
    patches: Vec<Gradient>,
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
    /// a_c of a split mass term, else ã (m/s²).
    pub(super) acceleration: &'a mut [[f64; D]],
    /// The other fields of a split mass term, if it is wanted.
    pub(super) split: Option<SplitLevel<'a, D>>,
}

/// The fields of a split mass term beside a_c (m/s²).
#[derive(Debug)]
pub(super) struct SplitLevel<'a, const D: usize> {
    /// w.
    pub(super) lumped: &'a mut [[f64; D]],
    /// o₂.
    pub(super) skew: &'a mut [[f64; D]],
}

impl<'a, const D: usize> AuxiliaryLevel<'a, D> {
    /// No fields.
    fn none() -> Self {
        Self { displacement: &mut [], acceleration: &mut [], split: None }
    }

    /// The same for a shorter time.
    fn again(&mut self) -> AuxiliaryLevel<'_, D> {
        let split = self.split.as_mut().map(|split| SplitLevel { lumped: split.lumped, skew: split.skew });
        AuxiliaryLevel { displacement: self.displacement, acceleration: self.acceleration, split }
    }

    /// Cuts before a node.
    fn split(self, node: usize) -> (Self, Self) {
        let (displacement, acceleration) = (cut(self.displacement, node), cut(self.acceleration, node));
        let split = self.split.map(|split| {
            let (lumped, skew) = (cut(split.lumped, node), cut(split.skew, node));
            (SplitLevel { lumped: lumped.0, skew: skew.0 }, SplitLevel { lumped: lumped.1, skew: skew.1 })
        });
        let (first, last) = split.map_or((None, None), |(first, last)| (Some(first), Some(last)));
        (
            Self { displacement: displacement.0, acceleration: acceleration.0, split: first },
            Self { displacement: displacement.1, acceleration: acceleration.1, split: last },
        )
    }
}

/// The parts of a field before and after a place; a field that is not wanted is empty.
fn cut<T>(field: &mut [T], at: usize) -> (&mut [T], &mut [T]) {
    field.split_at_mut(at.min(field.len()))
}

impl<'p, const D: usize, const N: usize> AuxiliarySolutions<'p, D, N> {
    /// About how much memory it takes (bytes).
    pub(super) fn memory(nodes: usize, elements: usize) -> usize {
        let node = 4 * size_of::<Nodal>() + 3 * size_of::<FirstPair>() + size_of::<[f64; D]>() + size_of::<Gradient>();
        let pair = size_of::<TrianglePair>() + size_of::<PairSurroundings>() + 2 * size_of::<Gradient>();
        nodes.saturating_mul(node).saturating_add(elements.div_ceil(2).saturating_mul(pair))
    }

    /// Before the first level, with these shares of the corrections of the auxiliary solution.
    pub(super) fn new(problem: &'p Problem<D>, times: &'p TimeGrid, smoothing: Arc<Smoothing>, shares: Shares) -> Self {
        let blocks = Blocks::new(problem.mesh());
        Self::on_blocks(problem, times, smoothing, shares, blocks)
    }

    /// The same with blocks of another size.
    fn on_blocks(
        problem: &'p Problem<D>,
        times: &'p TimeGrid,
        smoothing: Arc<Smoothing>,
        shares: Shares,
        blocks: Blocks,
    ) -> Self {
        let pairs = Pairs::new(problem, &blocks, &smoothing, &weights::shares(shares));
        let (plan, near) = (Plan::new(&blocks), ContactElements::new(problem, &blocks, &pairs, &smoothing));
        Self {
            problem,
            times,
            near,
            plan,
            fields: MotionFields::new(problem, &smoothing, pairs.places(0..blocks.count()).len()),
            blocks,
            pairs,
            surface: SurfaceForces::new(problem),
            weights: Weights::new(&smoothing, shares),
            smoothing,
            energies: None,
            external: match problem.is_loaded() || problem.yields() {
                true => vec![[0.0; D]; problem.mesh().node_count()],
                false => Vec::new(),
            },
            plastic: None,
            due: 0.0,
            energy_balance: EnergyBalance::new(problem),
            differences: Vec::new(),
        }
    }

    /// Prepares the energies of differences, and makes sure that the scheme is stable.
    pub(super) fn prepare(&mut self, elements: &[Element<D, N>]) {
        self.stabilise();
        self.plastic = PlasticStrains::new(self.problem, elements);
        self.energies = self.plastic.is_none().then(|| Energies::new(self.problem, elements));
    }

    /// Takes in the loads and supports of a level. Levels come in order.
    pub(super) fn begin(&mut self, dynamics: &Dynamics<'_, D>, n: usize) {
        if !self.external.is_empty() {
            self.problem.external_forces(self.times.instants()[n], &mut self.external);
        }
        self.surface.hold(dynamics, n);
        self.weights.begin(self.times, n);
        let (smooths, of) = (self.smooths(), (self.problem, &*self.smoothing));
        if let Some(plastic) = &mut self.plastic {
            let MotionFields { displacement, half_step, .. } = &self.fields;
            plastic.advance(of, (displacement, half_step, self.due), smooths, &mut self.external);
        }
    }

    /// Whether strains are smoothed at the level that has begun.
    pub(super) fn smooths(&self) -> bool {
        self.weights.corrects() && self.smoothing.smooths()
    }

    /// Foresees the motion of the auxiliary solution at all contact nodes until t_{n+1}, after `begin`.
    pub(super) fn foresee(&mut self, n: usize) -> Foreseen<'_, D> {
        let Self { problem, times, pairs, surface, near, fields, external, due, weights, .. } = self;
        let operator = PatchOperator { laws: &pairs.laws, weights };
        let (factors, steps) = (Factors::new(&weights.at(times, n)), [times.step(n), times.velocity_step(n)]);
        near.foresee(problem, &BeforePass { operator, surface, fields, external, due: *due, factors, steps });
        Foreseen { problem, near, operator, factors, square: steps[0] * steps[1], turned: None }
    }

    /// Takes in a level: forces of the density on the nodes of the contact surface (N). Goes on to the next half step
    /// and fills in the fields of the auxiliary solution.
    pub(super) fn advance(
        &mut self,
        dynamics: &Dynamics<'_, D>,
        n: usize,
        simulated: &SimulatedLevel<'_, D>,
        pull: &[[f64; D]],
        level: AuxiliaryLevel<'_, D>,
    ) {
        self.surface.contact(pull, simulated.reaction);
        let before = self.half_work(pull);
        let mut fields = std::mem::take(&mut self.fields);
        let pass = Pass {
            external: &self.external,
            inverse_mass: dynamics.inverse_mass(),
            simulated: simulated.velocity,
            weights: self.weights.at(self.times, n),
            due: self.due,
            back: if n == 0 { 0.0 } else { 0.5 * self.times.step(n - 1) },
            forward: self.times.velocity_step(n),
            ..self.free_pass()
        };
        let work = |part: &Part, view: View<'_, D>| run_task(PartPass { pass: &pass, part, view });
        let start = |part: &Part| start_of(part, &self.pairs, &self.smoothing);
        let kinetic = for_all((&self.plan, &start), View::new(&mut fields, level), &work);
        self.fields = fields;
        let sum = |of: fn(&Kinetic) -> f64| 0.5 * kinetic.iter().map(of).sum::<f64>();
        let energies = [simulated.strain + sum(|k| k.simulated), sum(|k| k.auxiliary)];
        self.due = self.times.step(n);
        let work = before + self.half_work(pull);
        self.energy_balance.add(self.problem, energies, simulated.velocity, work);
        self.differences.resize(n + 1, Difference::default());
    }

    /// The work of contact over half of the step that has still to be made (J).
    fn half_work(&self, pull: &[[f64; D]]) -> f64 {
        let velocity = |node: usize| self.fields.half_step[node].of(0);
        half_work((self.problem, &self.surface), velocity, pull, self.due)
    }

    /// A pass that makes nothing move.
    fn free_pass(&self) -> Pass<'_, D> {
        Pass {
            pairs: &self.pairs,
            smoothing: &self.smoothing,
            blocks: &self.blocks,
            surface: &self.surface,
            external: &[],
            mass: self.problem.mass(),
            inverse_mass: &[],
            simulated: &[],
            weights: self.weights.of_steps([0.0; 2]),
            due: 0.0,
            back: 0.0,
            forward: 0.0,
        }
    }

    /// Measures the difference of the simulation and the auxiliary solution at the last level taken in. Once for a
    /// level.
    pub(super) fn differ(&mut self, simulated: [&[[f64; D]]; 2], halvings: [f64; 2]) {
        if let (Some(energies), Some(last)) = (&self.energies, self.differences.last_mut()) {
            let start = |part: &Part| start_of(part, &self.pairs, &self.smoothing);
            let of = (&self.pairs, &self.blocks, (&self.plan, &start as StartOf<'_>));
            let measured = energies.measure(of, &mut self.fields, simulated);
            *last = Difference { halvings, ..measured };
        }
    }

    /// The differences at all levels so far: those that were measured. None where a material yields: the energies of
    /// differences are elastic ones.
    pub(super) fn differences(&self) -> Option<&[Difference]> {
        self.energies.as_ref().map(|_| &self.differences[..])
    }

    /// ε* of all elements at the level that has begun, where a material yields.
    pub(super) fn eigenstrains(&self) -> Option<&EigenStrains> {
        self.plastic.as_ref().map(PlasticStrains::eigenstrains)
    }

    /// The energies of the simulation and of this motion.
    pub(super) fn energy_balance(&self) -> &EnergyBalance<D> {
        &self.energy_balance
    }

    /// Whether the auxiliary solution has become unstable.
    pub(super) fn is_unstable(&self) -> bool {
        self.energy_balance.is_beyond(UNSTABLE)
    }
}

/// Where the fields of a part begin.
fn start_of(part: &Part, pairs: &Pairs, smoothing: &Smoothing) -> Start {
    let (gradient, patch) = (pairs.places(part.blocks.clone()).start, smoothing.patches(&part.nodes).start);
    Start { node: part.nodes.start, gradient, patch }
}

impl MotionFields {
    fn new<const D: usize>(problem: &Problem<D>, smoothing: &Smoothing, places: usize) -> Self {
        let count = problem.mesh().node_count();
        Self {
            displacement: problem.initial_displacement().iter().map(Nodal::all_but_contact).collect(),
            half_step: problem.initial_velocity().iter().map(Nodal::all_but_contact).collect(),
            rate: vec![Nodal::ZERO; count],
            internal: vec![Nodal::ZERO; count],
            lumping: std::array::from_fn(|_| vec![FirstPair::ZERO; count]),
            gradients: vec![Gradient::ZERO; places],
            patches: vec![Gradient::ZERO; smoothing.patch_count()],
        }
    }
}
