//! Balance of energy and impulse.

use super::work_meter::WorkMeter;
use crate::contact::{dissipation, dot};
use crate::history::{SUMS, State, Sums};
use crate::ids::NodeId;
use crate::problem::{PrescribedComponent, Problem};
use crate::ratio;
use crate::time::TimeGrid;
use serde::Serialize;

/// Energies and works at t_n (J), and the drift of the two balances so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Balance {
    /// Kinetic energy ½ v_n·M v_n.
    pub kinetic: f64,
    /// Strain energy ½ u_n·K u_n; of materials that yield that of their elastic strain.
    pub strain: f64,
    /// ∫∫σ:ε̇_p dt of materials that yield: what hardening has stored and plastic flow has dissipated.
    pub plastic_work: f64,
    /// Kinetic plus strain energy, and plastic work, at t_0.
    pub initial: f64,
    /// Work of tractions and body forces.
    pub work_of_loads: f64,
    /// Work of support reactions.
    pub work_of_supports: f64,
    /// Work of contact reactions, friction included.
    pub work_of_contact: f64,
    /// Energy dissipated by friction.
    pub friction: f64,
    /// Largest |energy − initial energy − works| so far, over the largest energy or work.
    pub energy_drift: f64,
    /// Largest |momentum − initial momentum − impulses| so far (any component), over the largest momentum or impulse.
    pub impulse_drift: f64,
    /// Momentum Σ m v_n (kg m/s); components beyond the dimension are 0.
    #[serde(skip)]
    pub momentum: [f64; 3],
    #[serde(skip)]
    largest_energy_gap: f64,
    #[serde(skip)]
    largest_energy: f64,
    #[serde(skip)]
    largest_impulse_gap: f64,
    #[serde(skip)]
    largest_impulse: f64,
}

impl Balance {
    /// Work of contact reactions, friction left out (J): at most 0, to rounding, where contact is what it should be.
    #[must_use]
    pub fn given_by_contact(&self) -> f64 {
        self.work_of_contact + self.friction
    }
}

/// Keeps the balance beside the integrator.
#[derive(Clone, Debug)]
pub(super) struct BalanceKeeper<const D: usize> {
    balance: Balance,
    loads: WorkMeter<D>,
    supports: WorkMeter<D>,
    contact: WorkMeter<D>,
    external: Vec<[f64; D]>,
    /// Components beyond the dimension are 0.
    initial_momentum: [f64; 3],
    impulse: [f64; 3],
    /// Sum of the sizes of all works put in by loads and supports (J).
    energy_put_in: f64,
    /// Largest kinetic energy that the loads or supports of one instant give by themselves (J).
    kick: f64,
    /// Kinetic energy that rounding alone may reach (J).
    rounding: f64,
}

impl<const D: usize> BalanceKeeper<D> {
    pub(super) fn new(problem: &Problem<D>, times: &TimeGrid) -> Self {
        let loaded = if problem.is_loaded() { problem.mesh().node_count() } else { 0 };
        Self {
            balance: Balance::default(),
            loads: WorkMeter::new((0..loaded).map(NodeId::new).collect()),
            supports: WorkMeter::new(problem.prescribed().iter().map(|p| p.node).collect()),
            contact: WorkMeter::new(problem.surface().nodes().iter().map(|c| c.node).collect()),
            external: vec![[0.0; D]; loaded],
            initial_momentum: [0.0; 3],
            impulse: [0.0; 3],
            energy_put_in: 0.0,
            kick: 0.0,
            rounding: rounding_energy(problem, times),
        }
    }

    /// The keeper of a run that goes on from a state, with the sums until then.
    pub(super) fn resumed(problem: &Problem<D>, times: &TimeGrid, now: &State<'_>, sums: &Sums) -> Self {
        let mut keeper = Self::new(problem, times);
        // The works of the next step begin at this state. Those until here are among the sums.
        keeper.advance_works(problem, times, now);
        keeper.numbers().into_iter().zip(sums).for_each(|(number, sum)| *number = *sum);
        keeper.balance.plastic_work = problem.plastic_work(now.step().internal);
        keeper
    }

    /// All numbers that one step hands to the next.
    pub(super) fn sums(&mut self) -> Sums {
        self.numbers().map(|number| *number)
    }

    fn numbers(&mut self) -> [&mut f64; SUMS] {
        let Self { balance, initial_momentum, impulse, energy_put_in, kick, .. } = self;
        let Balance {
            kinetic,
            strain,
            initial,
            work_of_loads,
            work_of_supports,
            work_of_contact,
            friction,
            energy_drift,
            impulse_drift,
            momentum,
            largest_energy_gap,
            largest_energy,
            largest_impulse_gap,
            largest_impulse,
            // It follows from the internal variables.
            plastic_work: _,
        } = balance;
        let [[x, y, z], [initial_x, initial_y, initial_z], [impulse_x, impulse_y, impulse_z]] =
            [momentum, initial_momentum, impulse].map(<[f64; 3]>::each_mut);
        [
            kinetic,
            strain,
            initial,
            work_of_loads,
            work_of_supports,
            work_of_contact,
            friction,
            energy_drift,
            impulse_drift,
            x,
            y,
            z,
            largest_energy_gap,
            largest_energy,
            largest_impulse_gap,
            largest_impulse,
            initial_x,
            initial_y,
            initial_z,
            impulse_x,
            impulse_y,
            impulse_z,
            energy_put_in,
            kick,
        ]
    }

    pub(super) fn balance(&self) -> &Balance {
        &self.balance
    }

    /// Adds one instant and returns whether the energy is plausible: at most ten times the sum of the initial energy
    /// and the work of loads and supports. Only an unstable run exceeds this limit. The kinetic energy that a load
    /// gives to a body at rest before it has done any work, and rounding, are allowed for.
    pub(super) fn record(&mut self, problem: &Problem<D>, times: &TimeGrid, now: &State<'_>) -> bool {
        let total_force = self.advance_works(problem, times, now);
        let b = &mut self.balance;
        let (kinetic, momentum) = now.energies::<D>(problem.mass());
        b.plastic_work = problem.plastic_work(now.step().internal);
        (b.kinetic, b.strain) = (kinetic, now.strain() - b.plastic_work);
        b.momentum[..D].copy_from_slice(&momentum);
        let energy = b.kinetic + b.strain + b.plastic_work;
        if now.step().index == 0 {
            b.initial = energy;
            self.initial_momentum = b.momentum;
            b.largest_impulse = b.largest_impulse.max(momentum_of_bodies(problem));
        }
        let forward = times.velocity_step(now.step().index) - now.back();
        for c in 0..D {
            self.impulse[c] += now.back() * total_force[c];
            let gap = momentum[c] - self.initial_momentum[c] - self.impulse[c];
            b.largest_impulse_gap = b.largest_impulse_gap.max(gap.abs());
            b.largest_impulse = b.largest_impulse.max(momentum[c].abs()).max(self.impulse[c].abs());
            self.impulse[c] += forward * total_force[c];
        }
        let works = [b.work_of_loads, b.work_of_supports, b.work_of_contact];
        b.largest_energy_gap = b.largest_energy_gap.max((energy - b.initial - works.iter().sum::<f64>()).abs());
        b.largest_energy = works.iter().fold(b.largest_energy.max(energy), |m, w| m.max(w.abs()));
        b.energy_drift = ratio(b.largest_energy_gap, b.largest_energy);
        b.impulse_drift = ratio(b.largest_impulse_gap, b.largest_impulse);
        energy.is_finite() && energy <= 10.0 * (b.initial + self.energy_put_in + self.kick) + self.rounding
    }

    /// Adds the works of the step that ends at this instant; returns the sum of all external forces.
    fn advance_works(&mut self, problem: &Problem<D>, times: &TimeGrid, now: &State<'_>) -> [f64; D] {
        let first = now.step().index == 0;
        let mut total = [0.0; D];
        let mut add = |force: &[f64; D]| (0..D).for_each(|c| total[c] += force[c]);
        let b = &mut self.balance;
        let put_in = &mut self.energy_put_in;

        if !self.external.is_empty() {
            problem.external_forces(times.instants()[now.step().index], &mut self.external);
            self.external.iter().for_each(&mut add);
            let h = times.velocity_step(now.step().index);
            let given = self.external.iter().zip(now.inverse_mass()).map(|(f, m)| dot(f, f) * m).sum::<f64>();
            self.kick = self.kick.max(0.5 * h * h * given);
            let (mut work, external) = (0.0, &self.external);
            self.loads.advance(now.step().displacement(), |i| external[i], |_, mean, path| work += dot(&mean, &path));
            if !first {
                b.work_of_loads += work;
                *put_in += work.abs();
            }
        }

        let along = |i: usize| {
            let mut force = [0.0; D];
            force[problem.prescribed()[i].component] = now.support_reaction()[i];
            force
        };
        (0..now.support_reaction().len()).for_each(|i| add(&along(i)));
        let moving = |p: &PrescribedComponent| {
            // a_n already prepares the next velocity.
            let next = (now.step().index + 1).min(times.step_count());
            let v = [now.step().index, next].map(|n| problem.prescribed_velocity(p, times.instants()[n]));
            0.5 * problem.mass()[p.node.index()] * v[0].abs().max(v[1].abs()).powi(2)
        };
        self.kick = self.kick.max(problem.prescribed().iter().map(moving).sum());
        let mut work = 0.0;
        self.supports.advance(now.step().displacement(), along, |_, mean, path| work += dot(&mean, &path));
        if !first {
            b.work_of_supports += work;
            *put_in += work.abs();
        }

        now.step().reaction().iter().for_each(&mut add);
        let [work, friction] = contact_works(&mut self.contact, problem, now);
        if !first {
            b.work_of_contact += work;
            b.friction += friction;
        }
        total
    }
}

/// Work of contact reactions and dissipation since the last call (J).
fn contact_works<const D: usize>(meter: &mut WorkMeter<D>, problem: &Problem<D>, now: &State<'_>) -> [f64; 2] {
    let (surface, u, reaction) = (problem.surface(), now.step().displacement::<D>(), now.step().reaction());
    let (mut work, mut friction) = (0.0, 0.0);
    meter.advance(
        u,
        |i| reaction[i],
        |i, mean, path| {
            work += dot(&mean, &path);
            friction += dissipation(&surface.frame(i, &u[surface.nodes()[i].node.index()]), &mean, &path);
        },
    );
    [work, friction]
}

/// Rounding of the displacements, some 1e-16 of their size, moves nodes by as much in a step; the
/// factor covers its growth over any number of steps.
fn rounding_energy<const D: usize>(problem: &Problem<D>, times: &TimeGrid) -> f64 {
    let largest = problem.initial_displacement().iter().flatten().fold(0.0_f64, |m, u| m.max(u.abs()));
    let step = (0..times.step_count()).map(|n| times.step(n)).fold(f64::INFINITY, f64::min);
    let speed = 1e-10 * largest / step;
    problem.mass().iter().sum::<f64>() * speed * speed
}

/// Σ m|v| along the axis on which it is largest (kg m/s), of several bodies, whose momenta may cancel; 0 of one.
fn momentum_of_bodies<const D: usize>(problem: &Problem<D>) -> f64 {
    if problem.mesh().parts() == 1 {
        return 0.0;
    }
    let nodes = || problem.mass().iter().zip(problem.initial_velocity());
    (0..D).map(|c| nodes().map(|(m, v)| m * v[c].abs()).sum()).fold(0.0, f64::max)
}
