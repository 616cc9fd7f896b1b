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
    /// −Kã (N), and 0 on prescribed components.
    internal: Vec<[f64; D]>,
    /// ã with its correction, from t_n on.
    acceleration: Vec<[f64; D]>,
    /// The same up to t_n: it does not depend on the next step.
    before: Vec<[f64; D]>,
    shares: Shares,
    /// How often so far a step has been longer than both its neighbours, or shorter.
    reversals: usize,
    /// Largest kinetic and strain energy of the simulation so far (J).
    peak_energy: f64,
}

/// Which part of each correction is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Shares {
    /// That of the lumped mass.
    pub(super) mass: f64,
    /// That of the central differences.
    pub(super) time: f64,
}

impl Shares {
    /// Both corrections.
    pub(super) const ALL: Self = Self { mass: 1.0, time: 1.0 };
    /// None: the scheme of the simulation.
    pub(super) const NONE: Self = Self { mass: 0.0, time: 0.0 };
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
    pub(super) fn new<const N: usize>(problem: &Problem<D, N>, shares: Shares) -> Self {
        Self {
            displacement: problem.initial_displacement().to_vec(),
            half_step: problem.initial_velocity().to_vec(),
            internal: vec![[0.0; D]; problem.mesh().node_count()],
            acceleration: vec![[0.0; D]; problem.mesh().node_count()],
            before: vec![[0.0; D]; problem.mesh().node_count()],
            shares,
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

    /// One at rest, without initial fields.
    pub(super) fn at_rest<const N: usize>(problem: &Problem<D, N>, shares: Shares) -> Self {
        let zero = vec![[0.0; D]; problem.mesh().node_count()];
        Self { displacement: zero.clone(), half_step: zero, ..Self::new(problem, shares) }
    }

    /// Takes in ã_n, with its lumping difference if it is known already.
    pub(super) fn accelerate<const N: usize>(
        &mut self,
        problem: &Problem<D, N>,
        dynamics: &Dynamics<'_, D, N>,
        times: &TimeGrid,
        n: usize,
        acceleration: &[[f64; D]],
        once: Option<&[[f64; D]]>,
    ) {
        self.before.copy_from_slice(acceleration);
        self.acceleration.copy_from_slice(acceleration);
        self.reversals += usize::from(n < times.step_count() && reverses(times, n));
        if self.reversals <= FEW && self.shares != Shares::NONE {
            let (next, last) = (times.step(n.min(times.step_count() - 1)), times.step(n.saturating_sub(1)));
            self.correct(problem, dynamics, [next * last, last * last], acceleration, once);
        }
    }

    /// v_n, once ã_n is known.
    pub(super) fn velocity(&self, times: &TimeGrid, n: usize) -> Vec<[f64; D]> {
        let back = if n == 0 { 0.0 } else { 0.5 * times.step(n - 1) };
        let each = |(v, a): (&[f64; D], &[f64; D])| std::array::from_fn(|c| v[c] + back * a[c]);
        self.half_step.iter().zip(&self.before).map(each).collect()
    }

    /// Goes on from t_n to t_{n+1}; the last step has no next.
    pub(super) fn advance(&mut self, times: &TimeGrid, n: usize) {
        if n < times.step_count() {
            let acceleration = self.acceleration.iter().copied();
            percute_core::dynamics::advance(times, n, &mut self.half_step, &mut self.displacement, acceleration);
        }
    }

    /// Adds p(M⁻¹(M − M_c))ã − (Δt²/12) M⁻¹K ã, but for prescribed components, which have the motion they must have. Δt² is the
    /// first of the squares (s²) for the acceleration from t_n on, the second for that before.
    fn correct<const N: usize>(
        &mut self,
        problem: &Problem<D, N>,
        dynamics: &Dynamics<'_, D, N>,
        squares: [f64; 2],
        acceleration: &[[f64; D]],
        once: Option<&[[f64; D]]>,
    ) {
        let Shares { mass, time } = self.shares;
        let difference = |field: &[[f64; D]]| lumping_difference(problem, dynamics.inverse_mass(), field);
        let lumping = (mass != 0.0).then(|| {
            let once = once.map_or_else(|| Cow::Owned(difference(acceleration)), Cow::Borrowed);
            let twice = difference(&once);
            (once, twice)
        });
        self.internal.fill([0.0; D]);
        dynamics.stiffness().subtract_internal_forces(acceleration, &mut self.internal);
        for p in problem.prescribed() {
            self.internal[p.node.index()][p.component] = 0.0;
        }
        let damping = mass * damping::<D>();
        for (total, square) in [&mut self.acceleration, &mut self.before].into_iter().zip(squares) {
            let time = time * square / 12.0;
            for (i, (total, inverse)) in total.iter_mut().zip(dynamics.inverse_mass()).enumerate() {
                for c in 0..D {
                    let mut correction = time * inverse * self.internal[i][c];
                    if let Some((once, twice)) = &lumping {
                        correction = correction + 0.5 * mass * once[i][c] - damping * twice[i][c];
                    }
                    total[c] += correction;
                }
            }
        }
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
