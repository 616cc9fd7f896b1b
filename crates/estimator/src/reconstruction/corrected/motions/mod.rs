//! A second solution of the motion, under the admissible contact force and with less dispersion, and three motions beside it.
//!
//! Fields that balance the simulation's own displacements repeat its dispersion and hide it: the waves of the simulation and
//! those of the balance are late together. The *auxiliary solution* is balanced instead. It starts like the simulation and
//! takes the steps of the same scheme, but under the nodal forces of F_DA, and with the acceleration
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
//! - The *half-step solution* has the reactions of the simulation, its lumped mass, and three quarters of the correction of the
//!   central differences: it moves like a simulation with steps half as long.
//! - The *contact difference* is the motion from rest, by the scheme of the simulation, under the difference of its
//!   reactions and the nodal forces of F_DA.
//!
//! The four motions are lanes: they are gathered, multiplied and updated together, in one pass over the mesh for a step.

mod blocks;
mod cells;
mod energies;
mod pass;
mod surface;
mod weights;

use crate::difference::Difference;
use crate::element::Element;
use blocks::Blocks;
use cells::{Cell, Cells, NodalLumping};
use energies::Energies;
use pass::Pass;
use percute_core::dynamics::Dynamics;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
pub(super) use surface::Approach;
use surface::SurfaceForces;
pub(super) use weights::Shares;
use weights::Weights;

/// The auxiliary solution, the half-size solution, the half-step solution and the contact difference, in this order.
const MOTIONS: usize = 4;
/// The first of them, whose mass is corrected.
const LUMPED: usize = 2;

/// A nodal vector of each motion.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct NodalLanes<const D: usize>([[f64; MOTIONS]; D]);

impl<const D: usize> NodalLanes<D> {
    const ZERO: Self = Self([[0.0; MOTIONS]; D]);
}

/// An auxiliary solution whose kinetic energy is so many times the largest energy of the simulation is unstable: its error
/// would be a thousand times the energy.
const UNSTABLE: f64 = 1e6;

/// The four motions, advanced beside the simulation's steps.
#[derive(Debug)]
pub(super) struct Motions<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D, N>,
    times: &'p TimeGrid,
    cells: Cells<D, N>,
    blocks: Blocks,
    surface: SurfaceForces<D, N>,
    weights: Weights,
    energies: Option<Energies<'p, D, N>>,
    fields: Fields<D>,
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
struct Fields<const D: usize> {
    /// u_n (m), from the pass of level n to that of the next.
    displacement: Vec<NodalLanes<D>>,
    /// v_{n+½} (m/s).
    half_step: Vec<NodalLanes<D>>,
    /// Forces and ã_n during a pass, v_n after it (m/s).
    rate: Vec<NodalLanes<D>>,
    /// −Kã (N).
    internal: Vec<NodalLanes<D>>,
    /// M⁻¹(M − M_c)ã (m/s²).
    once: Vec<NodalLumping<D>>,
    /// (M − M_c)M⁻¹(M − M_c)ã (N).
    twice: Vec<NodalLumping<D>>,
    /// F_n (N); empty without loads.
    external: Vec<[f64; D]>,
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

impl<'p, const D: usize, const N: usize> Motions<'p, D, N> {
    /// About how much memory it takes (bytes).
    pub(super) fn memory(nodes: usize, elements: usize) -> usize {
        let node = 4 * size_of::<NodalLanes<D>>() + 2 * size_of::<NodalLumping<D>>() + size_of::<[f64; D]>();
        nodes.saturating_mul(node).saturating_add(elements.saturating_mul(size_of::<Cell<D, N>>()))
    }

    /// Before the first level, with these shares of the corrections of the auxiliary solution.
    pub(super) fn new(problem: &'p Problem<D, N>, times: &'p TimeGrid, shares: Shares) -> Self {
        let cells = Cells::new(problem);
        let nodes: Vec<[u32; N]> = cells.cells.iter().map(|cell| cell.nodes).collect();
        let blocks = Blocks::usual(&nodes, problem.mesh().node_count());
        let surface = SurfaceForces::new(problem, &cells);
        Self {
            problem,
            times,
            cells,
            blocks,
            surface,
            weights: Weights::new::<D>(shares),
            energies: None,
            fields: Fields::new(problem),
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
        if !self.fields.external.is_empty() {
            self.problem.external_forces(self.times.instants()[n], &mut self.fields.external);
        }
        self.surface.hold(dynamics, n);
    }

    /// The motion of the auxiliary solution at all contact nodes until t_{n+1} without a contact force, corrections left out.
    pub(super) fn approaches(&mut self, dynamics: &Dynamics<'_, D, N>, n: usize) -> &[Approach<D>] {
        let Self { problem, times, cells, surface, fields, due, .. } = self;
        surface.approach(problem, cells, fields, *due);
        surface.approaches(problem, dynamics.inverse_mass(), times, n)
    }

    /// Takes in a level: forces of the density on the nodes of the contact surface (N). Goes on to the next half step and
    /// fills in the fields of the auxiliary solution.
    pub(super) fn advance(
        &mut self,
        dynamics: &Dynamics<'_, D, N>,
        n: usize,
        simulated: &SimulatedLevel<'_, D>,
        pull: &[[f64; D]],
        level: &mut AuxiliaryLevel<'_, D>,
    ) {
        self.surface.contact(pull, simulated.reaction);
        let pass = Pass {
            cells: &self.cells,
            blocks: &self.blocks,
            surface: &self.surface,
            mass: self.problem.mass(),
            inverse_mass: dynamics.inverse_mass(),
            simulated: simulated.velocity,
            weights: self.weights.at(self.times, n),
            due: self.due,
            back: if n == 0 { 0.0 } else { 0.5 * self.times.step(n - 1) },
            forward: self.times.velocity_step(n),
        };
        let fields = &mut self.fields;
        let kinetic = crate::simd::dispatch(
            #[inline(always)]
            || pass.run(fields, level),
        );
        self.peak_energy = self.peak_energy.max(simulated.strain + kinetic.simulated);
        self.kinetic = kinetic.auxiliary;
        self.due = self.times.step(n);
        self.differences.resize(n + 1, Difference::default());
    }

    /// Measures the difference of the simulation and the auxiliary solution at the last level taken in. Once for a level.
    pub(super) fn differ(&mut self, simulated: [&[[f64; D]]; 2], halvings: [f64; 2]) {
        let Self { energies, cells, blocks, fields, problem, differences, .. } = self;
        if let (Some(energies), Some(last)) = (energies, differences.last_mut()) {
            let mass = problem.mass();
            let measured = crate::simd::dispatch(
                #[inline(always)]
                || energies.measure(cells, blocks, mass, fields, simulated),
            );
            *last = Difference { halvings, ..measured };
        }
    }

    /// The differences at all levels so far: those that were measured.
    pub(super) fn differences(&self) -> &[Difference] {
        &self.differences
    }

    /// Whether the auxiliary solution has become unstable, as it does where a history of another scheme takes steps above the
    /// critical one. A stable one has about the energy of the simulation, an unstable one soon any.
    pub(super) fn is_unstable(&self) -> bool {
        // A body that starts unstrained at rest has no energy before it is loaded.
        self.peak_energy > 0.0 && self.kinetic > UNSTABLE * self.peak_energy
    }
}

impl<const D: usize> Fields<D> {
    fn new<const N: usize>(problem: &Problem<D, N>) -> Self {
        // The contact difference starts at rest.
        let start = |value: &[f64; D]| NodalLanes(value.map(|x| [x, x, x, 0.0]));
        let count = problem.mesh().node_count();
        Self {
            displacement: problem.initial_displacement().iter().map(start).collect(),
            half_step: problem.initial_velocity().iter().map(start).collect(),
            rate: vec![NodalLanes::ZERO; count],
            internal: vec![NodalLanes::ZERO; count],
            once: vec![NodalLumping::ZERO; count],
            twice: vec![NodalLumping::ZERO; count],
            external: if problem.is_loaded() { vec![[0.0; D]; count] } else { Vec::new() },
        }
    }
}

#[cfg(test)]
mod comparison;
#[cfg(test)]
mod tests;
