//! Motions beside the simulation and the auxiliary solution, which tell the sources of their difference apart.
//!
//! - The *contact difference* is the motion from rest, by the scheme of the simulation, under the difference of its
//!   reactions and the nodal forces of F_DA.
//! - The *half-size solution* is an auxiliary solution with three quarters of both corrections: the leading dispersion
//!   that is left is that of elements and steps half as long.
//! - The *half-step solution* has the reactions of the simulation, its lumped mass, and three quarters of the correction of the
//!   central differences: it moves like a simulation with steps half as long.

use super::auxiliary_solution::{AuxiliarySolution, Shares};
use super::energy_products::{EnergyProducts, Motion};
use crate::acceleration::accelerate;
use crate::contact_density::Densities;
use crate::difference::Difference;
use crate::element::Element;
use crate::reconstruction::SimulatedStep;
use percute_core::dynamics::Dynamics;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;

/// The corrections that elements and steps, or steps alone, half as long need no more: errors are of second order.
const QUARTERS: f64 = 0.75;

/// The auxiliary solution at a level, as it is compared.
#[derive(Clone, Copy)]
pub(super) struct AuxiliaryLevel<'a, const D: usize> {
    pub(super) solution: &'a AuxiliarySolution<D>,
    /// Its forces but those of contact (N).
    pub(super) force: &'a [[f64; D]],
    /// The forces of which its density is made (N).
    pub(super) contact: &'a [[f64; D]],
    pub(super) density: &'a Densities<D>,
    /// Those that the density does on the nodes of the contact surface (N).
    pub(super) pull: &'a [[f64; D]],
}

/// The motions, and the energies of their differences so far.
#[derive(Debug)]
pub(super) struct ComparedMotions<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D, N>,
    times: &'p TimeGrid,
    products: EnergyProducts<'p, D, N>,
    half_size: AuxiliarySolution<D>,
    half_step: AuxiliarySolution<D>,
    /// From the first contact force on.
    contact: Option<AuxiliarySolution<D>>,
    differences: Vec<Difference>,
}

impl<'p, const D: usize, const N: usize> ComparedMotions<'p, D, N> {
    pub(super) fn new(problem: &'p Problem<D, N>, times: &'p TimeGrid, elements: &[Element<D, N>]) -> Self {
        let shared = |mass| AuxiliarySolution::new(problem, Shares { mass, time: QUARTERS });
        Self {
            problem,
            times,
            products: EnergyProducts::new(problem, elements),
            half_size: shared(QUARTERS),
            half_step: shared(0.0),
            contact: None,
            differences: Vec::new(),
        }
    }

    /// At each level so far.
    pub(super) fn differences(&self) -> &[Difference] {
        &self.differences
    }

    /// Takes in a level and goes on to the next one.
    pub(super) fn advance(
        &mut self,
        dynamics: &Dynamics<'_, D, N>,
        simulated: &SimulatedStep<'_, D>,
        auxiliary: &AuxiliaryLevel<'_, D>,
    ) {
        let (problem, times, step) = (self.problem, self.times, simulated.state.step());
        let n = step.index;
        let (u, v) = (auxiliary.solution.displacement(), auxiliary.solution.velocity(times, n));
        let from_auxiliary = |displacement: &[[f64; D]], velocity: &[[f64; D]], force: &[[f64; D]]| Motion {
            displacement: minus(displacement, u),
            velocity: minus(velocity, &v),
            // External forces are the same.
            internal: minus(auxiliary.force, force),
        };
        let force = simulated.state.force_without_contact(problem.surface());
        let simulation = from_auxiliary(step.displacement, simulated.velocity, &force);
        let [half_size, half_step] =
            [(&mut self.half_size, auxiliary.pull), (&mut self.half_step, step.reaction)].map(|(solution, contact)| {
                let mut force = vec![[0.0; D]; u.len()];
                dynamics.forces_without_contact(n, solution.displacement(), &mut force);
                let acceleration = accelerate(problem, dynamics.inverse_mass(), force.clone(), contact);
                solution.accelerate(problem, dynamics, times, n, &acceleration, None);
                let motion = from_auxiliary(solution.displacement(), &solution.velocity(times, n), &force);
                solution.advance(times, n);
                motion
            });
        let contact = self.contact_difference(dynamics, n, &minus(step.reaction, auxiliary.pull));
        let near = self.products.near(&simulation);
        let [energy, product, square, half_size, half_step] =
            self.products.energies([&simulation, &contact, &half_size, &half_step]);
        self.differences.push(Difference {
            energy,
            near,
            contact: product,
            dispersion: energy - 2.0 * product + square,
            half_size,
            half_step,
            halvings: halvings(auxiliary),
        });
    }

    /// The contact difference at t_n, under this difference of the contact forces (N).
    fn contact_difference(&mut self, dynamics: &Dynamics<'_, D, N>, n: usize, contact: &[[f64; D]]) -> Motion<D> {
        let problem = self.problem;
        if self.contact.is_none() && contact.iter().flatten().all(|f| *f == 0.0) {
            return Motion::default();
        }
        let motion = self.contact.get_or_insert_with(|| AuxiliarySolution::at_rest(problem, Shares::NONE));
        let mut force = vec![[0.0; D]; problem.mesh().node_count()];
        dynamics.stiffness().subtract_internal_forces(motion.displacement(), &mut force);
        let mut acceleration = accelerate(problem, dynamics.inverse_mass(), force.clone(), contact);
        for p in problem.prescribed() {
            acceleration[p.node.index()][p.component] = 0.0;
        }
        motion.accelerate(problem, dynamics, self.times, n, &acceleration, None);
        let displacement = motion.displacement().to_vec();
        let velocity = motion.velocity(self.times, n);
        motion.advance(self.times, n);
        Motion { displacement, velocity, internal: force.into_iter().map(|f| f.map(|f| -f)).collect() }
    }
}

/// ΣF²k and ΣF² over the nodes, with the contact force F and the halvings k of its hats.
fn halvings<const D: usize>(auxiliary: &AuxiliaryLevel<'_, D>) -> [f64; 2] {
    let size = |force: &[f64; D]| force.iter().map(|f| f * f).sum::<f64>().sqrt();
    let hats = auxiliary.density.hats().iter();
    let narrow = hats.map(|hat| size(&hat.resultant) * size(&auxiliary.contact[hat.node]) * hat.halvings as f64);
    [narrow.sum(), auxiliary.contact.iter().flatten().map(|f| f * f).sum()]
}

fn minus<const D: usize>(a: &[[f64; D]], b: &[[f64; D]]) -> Vec<[f64; D]> {
    a.iter().zip(b).map(|(a, b)| std::array::from_fn(|c| a[c] - b[c])).collect()
}
