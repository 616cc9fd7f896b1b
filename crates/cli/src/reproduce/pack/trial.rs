//! Runs of the pack, with all that is compared.

use super::super::{ReproduceError, Tally};
use super::text::CaseText;
use percute_core::contact_results::{ContactRecorder, ContactResults};
use percute_core::dynamics::Simulation;
use percute_estimator::reference::{Motion, Recorder};
use percute_workflow::case::CaseOf;

/// A case and what came out of it.
pub(super) struct Trial<const D: usize, const N: usize> {
    pub(super) case: CaseOf<D, N>,
    /// u_n and v_n at all t_n.
    pub(super) motion: Motion<D>,
    pub(super) contact: ContactResults<D>,
    pub(super) simulation: Simulation,
}

/// Runs a bar.
pub(super) fn bar(text: &CaseText, tally: &mut Tally<'_>) -> Result<Trial<1, 2>, ReproduceError> {
    run(text.read_bar()?, tally)
}

/// Runs a plane body.
pub(super) fn plane(text: &CaseText, tally: &mut Tally<'_>) -> Result<Trial<2, 3>, ReproduceError> {
    run(text.read_plane()?, tally)
}

fn run<const D: usize, const N: usize>(
    case: CaseOf<D, N>,
    tally: &mut Tally<'_>,
) -> Result<Trial<D, N>, ReproduceError> {
    let recorder = Recorder::new(&case.problem, &case.times);
    let contact = ContactRecorder::new(&case.problem, &case.times).keeping_steps();
    let mut sinks = (recorder, contact.map_err(percute_workflow::Failure::from)?);
    let simulation = tally.simulate(1.0, &case.problem, &case.times, &mut sinks)?;
    let (motion, contact) = (sinks.0.finish(), sinks.1.finish());
    Ok(Trial { motion, contact, simulation, case })
}

impl<const D: usize, const N: usize> Trial<D, N> {
    /// t_n (s).
    pub(super) fn times(&self) -> &[f64] {
        &self.motion.times
    }

    /// The longest step (s).
    pub(super) fn step(&self) -> f64 {
        self.case.times.longest_step()
    }

    /// Mass (kg).
    pub(super) fn mass(&self) -> f64 {
        self.case.problem.mass().iter().sum()
    }

    /// The n that is nearest to a time.
    pub(super) fn nearest(&self, time: f64) -> usize {
        let after = self.times().partition_point(|t| *t < time);
        let before = after.saturating_sub(1);
        let last = self.times().len() - 1;
        let apart = |n: usize| (self.times()[n] - time).abs();
        if after <= last && apart(after) <= apart(before) { after } else { before }
    }

    /// The mean of a nodal field, weighted with the masses.
    fn mean(&self, field: &[[f64; D]]) -> [f64; D] {
        let mut sum = [0.0; D];
        for (value, mass) in field.iter().zip(self.case.problem.mass()) {
            (0..D).for_each(|c| sum[c] += mass * value[c]);
        }
        sum.map(|s| s / self.mass())
    }

    /// Displacement of the centre of mass at t_n (m).
    pub(super) fn mean_displacement(&self, n: usize) -> [f64; D] {
        self.mean(&self.motion.displacement[n])
    }

    /// Its velocity (m/s).
    pub(super) fn mean_velocity(&self, n: usize) -> [f64; D] {
        self.mean(&self.motion.velocity[n])
    }

    /// Its displacement at any time, on straight lines between the t_n (m).
    pub(super) fn mean_displacement_at(&self, time: f64) -> [f64; D] {
        let after = self.times().partition_point(|t| *t < time).clamp(1, self.times().len() - 1);
        let (t0, t1) = (self.times()[after - 1], self.times()[after]);
        let (a, b) = (self.mean_displacement(after - 1), self.mean_displacement(after));
        std::array::from_fn(|c| a[c] + (b[c] - a[c]) * (time - t0) / (t1 - t0))
    }

    /// Kinetic plus strain energy at t_n (J).
    pub(super) fn energy(&self, n: usize) -> f64 {
        let balance = &self.simulation.balance_over_time[n];
        balance.kinetic + balance.strain
    }

    /// Normal force of all nodes together at t_n (N).
    pub(super) fn normal_force(&self, n: usize) -> f64 {
        self.contact.total[n].normal_force
    }

    /// The steps from `from` to `to` (s).
    pub(super) fn between(&self, from: f64, to: f64) -> impl Iterator<Item = usize> + '_ {
        (0..self.times().len()).filter(move |&n| self.times()[n] >= from && self.times()[n] <= to)
    }

    /// Mean normal force at the t_n between two times (N).
    pub(super) fn mean_force(&self, from: f64, to: f64) -> f64 {
        let (sum, count) =
            self.between(from, to).fold((0.0, 0_usize), |(sum, count), n| (sum + self.normal_force(n), count + 1));
        sum / count.max(1) as f64
    }

    /// For how long there is a force at the first node of the contact surface, between two times (s).
    pub(super) fn contact_time(&self, from: f64, to: f64) -> f64 {
        self.between(from, to).filter(|&n| self.normal_force(n) > 0.0).count() as f64 * self.step()
    }
}
