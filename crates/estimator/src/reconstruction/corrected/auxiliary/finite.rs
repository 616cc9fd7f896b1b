//! The auxiliary solution of bodies that turn.
//!
//! With f the internal forces, f̄ those of smoothed stresses, ã = M⁻¹(F + F_DA − f̄(u)), o = M⁻¹(M − M_c)ã and v at
//! t_n,
//!
//! a = ã + p(M⁻¹(M − M_c))ã − (1/12) M⁻¹[f(u + Δt v + ½Δt²ã) + f(u − Δt v + ½Δt²ã) − 2 f(u)].
//!
//! The bracket is Δt² d²f/dt², without a tangent; of a linear law it is −Δt²Kã. It has the term of the changing
//! stiffness, without which a spinning body would be far off. f̄ has the stress F_E S̄_E, with S̄_E the mean of the
//! stresses of smoothed Green strains ([`crate::smoothing`]): symmetric in the present body, the slope of an energy,
//! and that of small strains where the body does not turn.

use super::approach::{ContactElements, Foreseen, FreeFlight};
use super::balance::{EnergyBalance, half_work, kinetic_energy};
use super::blocks::Blocks;
use super::internal_forces::{add_internal_forces, corner};
use super::pairs::Pairs;
use super::patch::{Factors, PatchOperator};
use super::surface::SurfaceForces;
use super::weights::{Shares, Weights, shares};
use super::{AuxiliaryLevel, SimulatedLevel, SplitLevel};
use crate::acceleration::accelerate;
use crate::element::Element;
use crate::parallel::by_pieces;
use crate::reconstruction::corrected::present_stars::PresentStars;
use crate::reconstruction::corrected::split::skew_acceleration;
use crate::smoothing::{Smoothed, SmoothedStrains, Smoothing};
use percute_core::contact::ContactNode;
use percute_core::dynamics::{self, Dynamics};
use percute_core::element_state::stretches;
use percute_core::ids::{ElementId, NodeId};
use percute_core::material::{PointLaw, Tensor, first_stress, volume_ratio};
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use std::array::from_fn;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// A motion whose kinetic energy is so many times the largest energy of the simulation is unstable: an element has been
/// turned inside out, or nearly so. Its error would be more than twice the energy.
const UNSTABLE: f64 = 4.0;

/// From the first element on whose principal stretches differ by more from 1, strains are smoothed no more, and the
/// lumped mass has the coefficients of plain strains: corners of rubber at 0.14 of the wave speed turned elements of
/// smoothed strains inside out.
const LARGE: f64 = 0.25;

/// c₁ to c₃ of plain strains: the leading error of the lumped mass, and what remains of it for waves along the axes.
const PLAIN: [f64; 3] = [0.5, -2.0 / 27.0, 0.0];

/// The auxiliary solution after the last level.
#[derive(Debug)]
pub(in crate::reconstruction::corrected) struct FiniteAuxiliary<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D>,
    times: &'p TimeGrid,
    smoothing: Arc<Smoothing>,
    weights: Weights,
    /// Those of the undeformed body.
    pairs: Pairs,
    near: ContactElements<D>,
    elements: Vec<Element<D, N>>,
    displacement: Vec<[f64; D]>,
    half_step: Vec<[f64; D]>,
    /// ã of the level that has begun (m/s²), without contact forces until these are known.
    plain: Vec<[f64; D]>,
    /// The lumping difference of ã, once, and its correction p (m/s²).
    lumping: [Vec<[f64; D]>; 2],
    strains: SmoothedStrains<f64>,
    /// F_E S̄_E (Pa).
    stresses: Vec<Tensor<D>>,
    /// Whether strains are smoothed at the level that has begun.
    smooths: bool,
    /// Whether strains have become large.
    large: bool,
    /// Whether an element has been turned inside out, of which smoothed strains know nothing.
    inside_out: bool,
    surface: SurfaceForces,
    energy_balance: EnergyBalance<D>,
}

impl<'p, const D: usize, const N: usize> FiniteAuxiliary<'p, D, N> {
    /// Before the first level.
    pub(super) fn new(problem: &'p Problem<D>, times: &'p TimeGrid, smoothing: Arc<Smoothing>, own: Shares) -> Self {
        let blocks = Blocks::new(problem.mesh());
        let pairs = Pairs::new(problem, &blocks, &smoothing, &shares(own));
        Self {
            problem,
            times,
            near: ContactElements::new(problem, &blocks, &pairs, &smoothing),
            weights: Weights::new(&smoothing, own),
            smoothing,
            pairs,
            elements: Vec::new(),
            displacement: problem.initial_displacement().to_vec(),
            half_step: problem.initial_velocity().to_vec(),
            plain: vec![[0.0; D]; problem.mesh().node_count()],
            lumping: [Vec::new(), Vec::new()],
            strains: SmoothedStrains::default(),
            stresses: Vec::new(),
            smooths: false,
            large: false,
            inside_out: false,
            surface: SurfaceForces::new(problem),
            energy_balance: EnergyBalance::new(problem),
        }
    }

    pub(super) fn prepare(&mut self, elements: &[Element<D, N>]) {
        self.elements = elements.to_vec();
        self.stresses = vec![[[0.0; D]; D]; elements.len()];
    }

    /// u at the level to come (m).
    pub(super) fn displacement(&self) -> &[[f64; D]] {
        &self.displacement
    }

    pub(super) fn energy_balance(&self) -> &EnergyBalance<D> {
        &self.energy_balance
    }

    pub(super) fn is_unstable(&self) -> bool {
        self.inside_out || self.energy_balance.is_beyond(UNSTABLE)
    }

    pub(super) fn smooths(&self) -> bool {
        self.smooths
    }

    /// The coefficients of the lumping difference at the level that has begun.
    fn mass(&self) -> [f64; 3] {
        if self.large && !self.smooths && self.weights.corrects() { PLAIN } else { self.weights.mass(0) }
    }

    /// Takes in the loads and supports of a level, and makes its acceleration without contact forces.
    pub(super) fn begin(&mut self, dynamics: &Dynamics<'_, D>, n: usize) {
        self.weights.begin(self.times, n);
        self.smooths = self.weights.smooths() && self.smoothing.smooths() && !self.large;
        let mut force = std::mem::take(&mut self.plain);
        if self.smooths {
            force.fill([0.0; D]);
            self.problem.external_forces(self.times.instants()[n], &mut force);
            self.subtract_smoothed_forces(&mut force);
            dynamics.apply_supports(n, &mut force, |_, _| ());
        } else {
            dynamics.forces_without_contact(n, &self.displacement, &mut force);
        }
        accelerate(self.problem, dynamics.inverse_mass(), &mut force, &[]);
        self.plain = force;
        self.correct_lumping(dynamics.inverse_mass());
    }

    /// Subtracts f̄(u) (N).
    fn subtract_smoothed_forces(&mut self, force: &mut [[f64; D]]) {
        let Self { problem, smoothing, elements, displacement, strains, stresses, inside_out, large, .. } = self;
        let of = Smoothed { problem: *problem, smoothing, elements };
        strains.fill_one(of, displacement);
        let (turned, strained) = (AtomicBool::new(false), AtomicBool::new(false));
        by_pieces((&mut stresses[..], &elements[..]), &|first, (stresses, elements)| {
            for (k, (stress, element)) in stresses.iter_mut().zip(elements).enumerate() {
                let gradient = element.gradient(&element.gather(displacement));
                *stress = first_stress(&gradient, &strains.of(0.0, of, ElementId::new(first + k)));
                if volume_ratio(&gradient) <= 0.0 {
                    turned.store(true, Relaxed);
                }
                if stretches(&gradient).into_iter().any(|stretch| (stretch - 1.0).abs() > LARGE) {
                    strained.store(true, Relaxed);
                }
            }
        });
        *inside_out |= turned.into_inner();
        *large |= strained.into_inner();
        add_internal_forces((problem.mesh(), elements), stresses, -1.0, force);
    }

    /// Foresees the motion at all contact nodes until t_{n+1}, after `begin`: without contact forces that of the whole
    /// correction; under them that of the undeformed body, turned with the stars. None once strains are large.
    pub(super) fn foresee<'a>(&'a mut self, n: usize, stars: &'a PresentStars<'_, D>) -> Option<Foreseen<'a, D>> {
        if self.large {
            return None;
        }
        let (problem, times) = (self.problem, self.times);
        let steps = [times.step(n), times.velocity_step(n)];
        let (plain, [_, lumped]) = (&self.plain, &self.lumping);
        let (around, time) = (self.steps_around(n), self.time_share(n));
        let flight = |contact: &ContactNode| {
            let i = contact.node.index();
            let bracket = self.bracket_at(contact.node, around);
            let acceleration: [f64; D] =
                from_fn(|c| plain[i][c] + lumped[i][c] - time * bracket[c] / problem.mass()[i]);
            let (now, velocity) = (self.displacement[i], self.half_step[i]);
            let next = from_fn(|c| now[c] + steps[0] * (velocity[c] + steps[1] * acceleration[c]));
            FreeFlight { displacements: [now, next], mobility: steps[0] * steps[1] / problem.mass()[i] }
        };
        let flights = problem.surface().nodes().iter().map(flight).collect();
        self.near.set_free(flights);
        let factors = Factors::new(&self.weights.at(times, n));
        let operator = PatchOperator { laws: &self.pairs.laws, weights: &self.weights };
        let square = steps[0] * steps[1];
        Some(Foreseen { problem, near: &self.near, operator, factors, square, turned: Some(stars) })
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
        let (problem, times, inverse_mass) = (self.problem, self.times, dynamics.inverse_mass());
        self.add_contact(inverse_mass, pull);
        let (around, time) = (self.steps_around(n), self.time_share(n));
        let bracket = self.bracket(dynamics, around);
        self.write(inverse_mass, level);
        let before = self.half_work(pull, 2.0 * around[0]);
        let Self { half_step, displacement, plain, lumping: [_, lumped], .. } = self;
        let accelerations =
            (0..plain.len()).map(|i| from_fn(|c| plain[i][c] + lumped[i][c] - time * bracket[i][c] * inverse_mass[i]));
        dynamics::advance(times, n, half_step, displacement, accelerations);
        let after = self.half_work(pull, around[1]);
        let kinetic = |velocity: &[[f64; D]]| kinetic_energy(problem, velocity);
        let energies = [simulated.strain + kinetic(simulated.velocity), kinetic(&self.half_step)];
        self.energy_balance.add(problem, energies, simulated.velocity, before + after);
    }

    /// Fills in the fields of the level.
    fn write(&self, inverse_mass: &[f64], level: AuxiliaryLevel<'_, D>) {
        level.displacement.copy_from_slice(&self.displacement);
        let [first, ..] = self.mass();
        let fields = || self.plain.iter().zip(&self.lumping[0]);
        let share = if level.split.is_some() { first } else { 0.0 };
        for (acceleration, (plain, once)) in level.acceleration.iter_mut().zip(fields()) {
            *acceleration = from_fn(|c| plain[c] + share * once[c]);
        }
        if let Some(SplitLevel { lumped, skew }) = level.split {
            for (w, (plain, once)) in lumped.iter_mut().zip(fields()) {
                *w = from_fn(|c| (1.0 - first) * plain[c] + first * once[c]);
            }
            skew.copy_from_slice(&skew_acceleration::<D, N>(self.problem, inverse_mass, lumped, level.displacement));
        }
    }

    /// The work of contact over half of a step (J).
    fn half_work(&self, pull: &[[f64; D]], step: f64) -> f64 {
        half_work((self.problem, &self.surface), |node| self.half_step[node], pull, step)
    }

    /// From v_{n−½} to v_n, and the step from t_n on (s).
    fn steps_around(&self, n: usize) -> [f64; 2] {
        let back = if n == 0 { 0.0 } else { 0.5 * self.times.step(n - 1) };
        [back, self.times.step(n.min(self.times.step_count() - 1))]
    }

    /// The share of M⁻¹ of the bracket in the acceleration.
    fn time_share(&self, n: usize) -> f64 {
        let [_, next] = self.steps_around(n);
        self.weights.at(self.times, n).time[0].0[0] / (next * next)
    }

    /// f(u + Δt v + ½Δt²ã) + f(u − Δt v + ½Δt²ã) − 2 f(u) (N), with v = v_{n−½} + `back` ã.
    fn bracket(&self, dynamics: &Dynamics<'_, D>, around: [f64; 2]) -> Vec<[f64; D]> {
        let mut forces = vec![[0.0; D]; self.plain.len()];
        dynamics.subtract_internal_forces(&self.displacement, &mut forces);
        forces.as_flattened_mut().iter_mut().for_each(|f| *f *= -2.0);
        let mut moved = vec![[0.0; D]; self.plain.len()];
        for sign in [1.0, -1.0] {
            by_pieces(&mut moved[..], &|first, moved| {
                moved.iter_mut().zip(first..).for_each(|(moved, i)| *moved = self.moved(i, sign, around));
            });
            dynamics.subtract_internal_forces(&moved, &mut forces);
        }
        // The forces were subtracted.
        forces.as_flattened_mut().iter_mut().for_each(|f| *f = -*f);
        self.problem.prescribed().iter().for_each(|p| forces[p.node.index()][p.component] = 0.0);
        forces
    }

    /// The same at one node.
    fn bracket_at(&self, node: NodeId, around: [f64; 2]) -> [f64; D] {
        let mut force = [0.0; D];
        for &id in self.problem.mesh().stars().star(node).elements {
            let (element, law) = (&self.elements[id.index()], self.problem.material(id));
            for (sign, factor) in [(1.0, 1.0), (-1.0, 1.0), (0.0, -2.0)] {
                let places = element.nodes.map(|node| match sign {
                    0.0 => self.displacement[node.index()],
                    _ => self.moved(node.index(), sign, around),
                });
                let (stress, _) = law.respond(&element.gradient(&places), &mut []);
                let internal = element.internal_force(corner(element, node), &stress);
                (0..D).for_each(|c| force[c] += factor * internal[c]);
            }
        }
        self.problem.prescribed().iter().filter(|p| p.node == node).for_each(|p| force[p.component] = 0.0);
        force
    }

    /// u ± Δt v + ½Δt²ã of a node.
    fn moved(&self, i: usize, sign: f64, [back, step]: [f64; 2]) -> [f64; D] {
        let (u, v, a) = (&self.displacement[i], &self.half_step[i], &self.plain[i]);
        from_fn(|c| u[c] + sign * step * (v[c] + back * a[c]) + 0.5 * step * step * a[c])
    }

    /// Makes the lumping difference of ã and its correction: an element gives m/(D+2) times the distance to the mean of
    /// its nodes.
    fn correct_lumping(&mut self, inverse_mass: &[f64]) {
        let mass = self.mass();
        let mut last = Vec::new();
        for (k, factor) in mass.into_iter().enumerate() {
            let next = self.lumping_difference(if k == 0 { &self.plain } else { &last }, inverse_mass);
            let sum = &mut self.lumping[1];
            sum.resize(next.len(), [0.0; D]);
            for (sum, next) in sum.as_flattened_mut().iter_mut().zip(next.as_flattened()) {
                *sum = if k == 0 { factor * next } else { *sum + factor * next };
            }
            last = next;
            if k == 0 {
                self.lumping[0].clone_from(&last);
            }
        }
    }

    /// M⁻¹(M − M_c) of a nodal field, 0 on prescribed components.
    fn lumping_difference(&self, field: &[[f64; D]], inverse_mass: &[f64]) -> Vec<[f64; D]> {
        let mut difference = vec![[0.0; D]; field.len()];
        for element in &self.elements {
            let (share, values) = (lumped_share(element), element.gather(field));
            let mut mean = values[0];
            (1..N).for_each(|i| (0..D).for_each(|c| mean[c] += values[i][c]));
            for (node, value) in element.nodes.iter().zip(&values) {
                let difference = &mut difference[node.index()];
                (0..D).for_each(|c| difference[c] += share * (value[c] - mean[c] / N as f64));
            }
        }
        for (difference, inverse) in difference.iter_mut().zip(inverse_mass) {
            difference.iter_mut().for_each(|x| *x *= inverse);
        }
        self.problem.prescribed().iter().for_each(|p| difference[p.node.index()][p.component] = 0.0);
        difference
    }

    /// Adds contact forces (N) to ã, and their part of the lumping difference and of its correction around their nodes.
    fn add_contact(&mut self, inverse_mass: &[f64], pull: &[[f64; D]]) {
        let mut field = BTreeMap::new();
        for (contact, pull) in self.problem.surface().nodes().iter().zip(pull).filter(|(_, pull)| **pull != [0.0; D]) {
            let i = contact.node.index();
            let sum: &mut [f64; D] = field.entry(i).or_insert([0.0; D]);
            (0..D).for_each(|c| sum[c] += pull[c] * inverse_mass[i]);
        }
        add(&mut self.plain, &field, 1.0);
        for (k, factor) in self.mass().into_iter().enumerate() {
            field = self.lumping_difference_of(&field, inverse_mass);
            let [once, sum] = &mut self.lumping;
            add(sum, &field, factor);
            if k == 0 {
                add(once, &field, 1.0);
            }
        }
    }

    /// The lumping difference of a field of few nodes.
    fn lumping_difference_of(&self, field: &FewNodes<D>, inverse_mass: &[f64]) -> FewNodes<D> {
        let mut difference = FewNodes::new();
        for (&node, value) in field {
            for element in self.problem.mesh().stars().star(NodeId::new(node)).elements {
                let element = &self.elements[element.index()];
                for other in element.nodes.map(NodeId::index) {
                    let own = if other == node { 1.0 } else { 0.0 };
                    let share = lumped_share(element) * (own - 1.0 / N as f64) * inverse_mass[other];
                    let sum = difference.entry(other).or_insert([0.0; D]);
                    (0..D).for_each(|c| sum[c] += share * value[c]);
                }
            }
        }
        for held in self.problem.prescribed() {
            if let Some(value) = difference.get_mut(&held.node.index()) {
                value[held.component] = 0.0;
            }
        }
        difference
    }
}

/// A nodal field that is 0 at all nodes but these.
type FewNodes<const D: usize> = BTreeMap<usize, [f64; D]>;

/// Adds so many times the values of few nodes.
fn add<const D: usize>(field: &mut [[f64; D]], few: &FewNodes<D>, factor: f64) {
    few.iter().for_each(|(&node, value)| (0..D).for_each(|c| field[node][c] += factor * value[c]));
}

/// m/(D+2) of an element (kg).
fn lumped_share<const D: usize, const N: usize>(element: &Element<D, N>) -> f64 {
    element.nodal_mass * N as f64 / (D + 2) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::elements;
    use percute_core::material::{Elastic, HyperelasticLaw, Kinematics};
    use percute_testkit::{Random, random_rectangle};

    /// The forces of smoothed strains are the slope of an energy: their changes are symmetric, ∂f_i/∂u_j = ∂f_j/∂u_i.
    /// In a body that has turned by 1 rad and strained by some per cent; differences with 1e-6 of the size leave 1e-8.
    #[test]
    fn smoothed_forces_have_an_energy() {
        for law in [HyperelasticLaw::NeoHookean, HyperelasticLaw::SaintVenantKirchhoff, HyperelasticLaw::Hencky] {
            let rubber = Elastic::plane_strain(1.0, 0.47, 1.0, 1.0).unwrap();
            let problem = Problem::<2>::builder(random_rectangle(1.0, 0.8, 3, 3).unwrap())
                .material(rubber.with_kinematics(Kinematics::Finite(law)).unwrap())
                .build()
                .unwrap();
            let times = TimeGrid::uniform(1.0, 10).unwrap();
            let smoothing = Arc::new(Smoothing::new(&problem));
            let mut auxiliary = FiniteAuxiliary::<2, 3>::new(&problem, &times, smoothing, Shares::ALL);
            auxiliary.prepare(&elements(&problem));
            let (mut random, (sine, cosine)) = (Random::new(2), 1.0_f64.sin_cos());
            let points = problem.mesh().points_in::<2>();
            let mut turned = |[x, y]: [f64; 2]| {
                let noise: [f64; 2] = from_fn(|_| random.between(-0.02, 0.02));
                [cosine * x - sine * y - x + noise[0], sine * x + cosine * y - y + noise[1]]
            };
            let start: Vec<[f64; 2]> = points.iter().map(|p| turned(*p)).collect();
            let count = 2 * start.len();
            let mut forces = |dof: usize, change: f64| {
                auxiliary.displacement.clone_from(&start);
                auxiliary.displacement.as_flattened_mut()[dof] += change;
                let mut force = vec![[0.0; 2]; start.len()];
                auxiliary.subtract_smoothed_forces(&mut force);
                force.as_flattened().to_vec()
            };
            let columns: Vec<Vec<f64>> = (0..count)
                .map(|dof| {
                    let [more, less] = [1e-6, -1e-6].map(|change| forces(dof, change));
                    more.iter().zip(&less).map(|(more, less)| (more - less) / 2e-6).collect()
                })
                .collect();
            let largest = columns.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
            for i in 0..count {
                for j in 0..i {
                    let apart = (columns[i][j] - columns[j][i]).abs();
                    assert!(apart < 1e-8 * largest, "{law:?}: {apart} of {largest}");
                }
            }
        }
    }
}
