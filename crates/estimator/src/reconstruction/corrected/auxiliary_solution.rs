//! A second solution of the motion, under the admissible contact force and with less dispersion.
//!
//! Fields that balance the simulation's own displacements repeat its dispersion and hide it: the waves of the simulation and
//! those of the balance are late together. The auxiliary solution is balanced instead. It starts like the simulation and
//! takes the steps of the same scheme, but under the nodal forces of F_DA, and with the acceleration
//!
//! a = ã + p(M⁻¹(M − M_c))ã − (Δt²/12) M⁻¹K ã,   p(μ) = μ/2 − βμ²,   M ã = F + F_DA − K u,
//!
//! M the lumped and M_c the consistent mass. The leading errors of the lumped mass and of the central
//! differences, of the same size and of opposite sign, are thus taken out: dispersion is of fourth order on a
//! uniform bar, where at the critical step both cancel and β alone is left. ã itself, of which Γ_DA and
//! the tractions are made, balances M ã as before.

use super::lumping_difference::lumping_difference;
use crate::reconstruction::SimulatedStep;
use percute_core::dynamics::Dynamics;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use std::borrow::Cow;

/// Displacement and half-step velocity, advanced beside the simulation's steps.
#[derive(Clone, Debug)]
pub(super) struct AuxiliarySolution<const D: usize> {
    displacement: Vec<[f64; D]>,
    half_step: Vec<[f64; D]>,
    correction: Vec<[f64; D]>,
    /// Whether it is made at all.
    corrected: bool,
    /// How often so far a step has been longer than both its neighbours, or shorter.
    reversals: usize,
    /// Largest kinetic and strain energy of the simulation so far (J).
    peak_energy: f64,
}

/// The motion of a contact node over the next step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Approach<const D: usize> {
    /// Gap at the next instant without a contact force (m).
    pub(super) gap: f64,
    /// Displacement along the plane now, and at the next instant without a contact force (m).
    pub(super) along: [[f64; D]; 2],
    /// Displacement that a unit force adds until then (m/N).
    pub(super) mobility: f64,
}

/// An auxiliary solution whose kinetic energy is so many times the largest energy of the simulation is unstable: its error
/// would be a thousand times the energy.
const UNSTABLE: f64 = 1e6;

/// Reversals after which corrections are no longer made. Steps that are long and short in turn drive waves that need four of
/// them for a period; the corrected scheme has such waves from shorter steps on than the plain one, and can be unstable where the
/// simulation is not. A few do no harm; and the plain scheme is as stable as the simulation.
const FEW: usize = 8;
/// Relative difference from which on a step is longer than another.
const LONGER: f64 = 1e-3;

impl<const D: usize> AuxiliarySolution<D> {
    pub(super) fn new<const N: usize>(problem: &Problem<D, N>, corrected: bool) -> Self {
        Self {
            displacement: problem.initial_displacement().to_vec(),
            half_step: problem.initial_velocity().to_vec(),
            correction: vec![[0.0; D]; problem.mesh().node_count()],
            corrected,
            reversals: 0,
            peak_energy: 0.0,
        }
    }

    /// u_n.
    pub(super) fn displacement(&self) -> &[[f64; D]] {
        &self.displacement
    }

    /// The motion of a contact node until t_{n+1} under these nodal forces (N), corrections left out.
    pub(super) fn approach<const N: usize>(
        &self,
        problem: &Problem<D, N>,
        inverse_mass: &[f64],
        times: &TimeGrid,
        (n, at): (usize, usize),
        force: &[[f64; D]],
    ) -> Approach<D> {
        let contact = &problem.surface().nodes()[at];
        let i = contact.node.index();
        let step = times.step(n);
        let mobility = step * times.velocity_step(n) * inverse_mass[i];
        let now = self.displacement[i];
        let next = std::array::from_fn(|c| now[c] + step * self.half_step[i][c] + mobility * force[i][c]);
        let frame = problem.obstacles()[contact.obstacle].flat_frame();
        Approach {
            gap: problem.surface().gap(at, &next),
            along: [now, next].map(|displacement| frame.split(&displacement).1),
            mobility,
        }
    }

    /// Takes in the energy of the simulation at a step.
    pub(super) fn watch(&mut self, simulated: &SimulatedStep<'_, D>, mass: &[f64]) {
        self.peak_energy = self.peak_energy.max(simulated.state.strain() + kinetic_energy(simulated.velocity, mass));
    }

    /// Whether it has become unstable, as it does where a history of another scheme takes steps above the critical one. A
    /// stable one has about the energy of the simulation, an unstable one soon any.
    pub(super) fn is_unstable(&self, mass: &[f64]) -> bool {
        // A body that starts unstrained at rest has no energy before it is loaded.
        self.peak_energy > 0.0 && kinetic_energy(&self.half_step, mass) > UNSTABLE * self.peak_energy
    }

    /// Goes on from t_n to t_{n+1} with ã_n, and with its lumping difference if it is known already; after the last step
    /// there is nowhere to go.
    pub(super) fn advance<const N: usize>(
        &mut self,
        problem: &Problem<D, N>,
        dynamics: &Dynamics<'_, D, N>,
        times: &TimeGrid,
        n: usize,
        acceleration: &[[f64; D]],
        once: Option<&[[f64; D]]>,
    ) {
        if n == times.step_count() {
            return;
        }
        self.reversals += usize::from(reverses(times, n));
        if self.reversals > FEW {
            self.correction.fill([0.0; D]);
        } else if self.corrected {
            self.correct(problem, dynamics, times.step(n) * times.step(n.saturating_sub(1)), acceleration, once);
        }
        let corrected = acceleration.iter().zip(&self.correction).map(|(a, b)| std::array::from_fn(|c| a[c] + b[c]));
        percute_core::dynamics::advance(times, n, &mut self.half_step, &mut self.displacement, corrected);
    }

    /// p(M⁻¹(M − M_c))ã − (Δt²/12) M⁻¹K ã, but for prescribed components, which have the motion they must have.
    fn correct<const N: usize>(
        &mut self,
        problem: &Problem<D, N>,
        dynamics: &Dynamics<'_, D, N>,
        square_of_step: f64,
        acceleration: &[[f64; D]],
        once: Option<&[[f64; D]]>,
    ) {
        let difference = |field: &[[f64; D]]| lumping_difference(problem, dynamics.inverse_mass(), field);
        let once = once.map_or_else(|| Cow::Owned(difference(acceleration)), Cow::Borrowed);
        let twice = difference(&once);
        self.correction.fill([0.0; D]);
        dynamics.stiffness().subtract_internal_forces(acceleration, &mut self.correction);
        let (time, damping) = (square_of_step / 12.0, damping::<D>());
        let parts = self.correction.iter_mut().zip(dynamics.inverse_mass()).zip(once.iter().zip(&twice));
        for ((value, inverse), (once, twice)) in parts {
            (0..D).for_each(|c| value[c] = time * inverse * value[c] + 0.5 * once[c] - damping * twice[c]);
        }
        problem.prescribed().iter().for_each(|p| self.correction[p.node.index()][p.component] = 0.0);
    }
}

/// β of p(μ) = μ/2 − βμ².
///
/// The eigenvalues μ of an element are 0 and (D+1)/(D+2). In 2D, without β the shortest waves would be unstable from 0.97 of
/// the critical step on. With the β that makes p ≤ ⅓, x(1 + p − x/12) ≤ 4 for all x = Δt²ω² ≤ 4: the auxiliary solution is
/// stable wherever the simulation is. In 1D this β is 0. But there the simulation takes the critical step exactly, its
/// shortest wave grows with time once it is excited, and an auxiliary solution with the same growth does not show it. With
/// β ≥ 1/36 the auxiliary solution does not grow, at the price of a larger estimate at that step. This changes errors of
/// the order that is left anyway.
fn damping<const D: usize>() -> f64 {
    let largest = (D + 1) as f64 / (D + 2) as f64;
    ((0.5 * largest - 1.0 / 3.0) / (largest * largest)).max(1.0 / 36.0)
}

/// Whether the step before t_n is longer than those beside it, or shorter.
fn reverses(times: &TimeGrid, n: usize) -> bool {
    let change = |k: usize| times.step(k) / times.step(k - 1) - 1.0;
    n >= 2 && change(n) * change(n - 1) < 0.0 && change(n).abs().min(change(n - 1).abs()) > LONGER
}

/// ½ v·M v (J).
fn kinetic_energy<const D: usize>(velocity: &[[f64; D]], mass: &[f64]) -> f64 {
    velocity.iter().zip(mass).map(|(v, m)| 0.5 * m * v.iter().map(|v| v * v).sum::<f64>()).sum()
}

#[cfg(test)]
mod tests;
