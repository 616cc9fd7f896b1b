//! The auxiliary solution of bodies that turn: under the admissible contact force, and with less dispersion.
//!
//! With f the internal forces, ã = M⁻¹(F + F_DA − f(u)), o = M⁻¹(M − M_c)ã and v at t_n,
//!
//! a = ã + c₁o + c₂M⁻¹(M − M_c)o − (1/12) M⁻¹[f(u + Δt v + ½Δt²ã) + f(u − Δt v + ½Δt²ã) − 2 f(u)].
//!
//! The bracket is Δt² d²f/dt², without a tangent; of a linear law it is −Δt²Kã. It has the term of the changing
//! stiffness, without which a spinning body would be far off. Strains are not smoothed.

use super::split::skew_acceleration;
use crate::acceleration::accelerate;
use crate::nodal_field::{FieldPool, NodalField};
use crate::time_level::SplitFields;
use percute_core::dynamics::{self, Dynamics};
use percute_core::history::State;
use percute_core::ids::ElementId;
use percute_core::material::Law;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;

/// c₁ and c₂: the leading error of the lumped mass, and what remains of it for waves along the axes.
const MASS: [f64; 2] = [0.5, -2.0 / 27.0];

/// A motion whose kinetic energy is so many times the largest energy of the simulation is unstable: an element has been
/// turned inside out, or nearly so.
const UNSTABLE: f64 = 100.0;

/// The auxiliary solution after the last level.
#[derive(Debug)]
pub(super) struct FiniteAuxiliary<const D: usize> {
    displacement: Vec<[f64; D]>,
    half_step: Vec<[f64; D]>,
    /// Largest energy of the simulation so far, and the kinetic energy of this motion (J).
    energies: [f64; 2],
    splits: bool,
}

/// Its fields at a level.
pub(super) struct FiniteLevel<const D: usize> {
    /// u_n (m).
    pub(super) displacement: NodalField<D>,
    /// a_c of a split mass term, else ã (m/s²).
    pub(super) acceleration: NodalField<D>,
    pub(super) split: Option<SplitFields<D>>,
}

impl<const D: usize> FiniteAuxiliary<D> {
    /// Before the first level.
    pub(super) fn new(problem: &Problem<D>, splits: bool) -> Self {
        let (displacement, half_step) = (problem.initial_displacement().to_vec(), problem.initial_velocity().to_vec());
        Self { displacement, half_step, energies: [0.0; 2], splits }
    }

    /// u at the level to come (m).
    pub(super) fn displacement(&self) -> &[[f64; D]] {
        &self.displacement
    }

    /// Whether it has become unstable.
    pub(super) fn is_unstable(&self) -> bool {
        let [simulated, own] = self.energies;
        own.is_nan() || (simulated > 0.0 && own > UNSTABLE * simulated)
    }

    /// Takes in a level under forces on the nodes of the contact surface (N), and goes on to the next one.
    pub(super) fn advance<const N: usize>(
        &mut self,
        dynamics: &Dynamics<'_, D>,
        times: &TimeGrid,
        state: &State<'_>,
        pull: &[[f64; D]],
        pool: &FieldPool<D>,
    ) -> FiniteLevel<D> {
        let (problem, inverse, n) = (dynamics.problem(), dynamics.inverse_mass(), state.step().index);
        let mut plain = pool.take();
        dynamics.forces_without_contact(n, &self.displacement, &mut plain);
        accelerate(problem, inverse, &mut plain, pull);
        let once = lumping_difference::<D, N>(problem, inverse, &plain);
        let twice = lumping_difference::<D, N>(problem, inverse, &once);
        let [last, next] = [times.step(n.saturating_sub(1)), times.step(n.min(times.step_count() - 1))];
        let back = if n == 0 { 0.0 } else { 0.5 * times.step(n - 1) };
        let bracket = self.bracket(dynamics, [back, next], &plain);
        let accelerations = corrected(inverse, &plain, [&once, &twice], (&bracket, last / next / 12.0));
        let displacement = pool.copy(&self.displacement);
        dynamics::advance(times, n, &mut self.half_step, &mut self.displacement, accelerations);
        let kinetic = |velocity: &[[f64; D]]| -> f64 {
            let moving = velocity.iter().zip(problem.mass());
            moving.map(|(v, m)| 0.5 * m * v.iter().map(|v| v * v).sum::<f64>()).sum()
        };
        let simulated = state.strain() + kinetic(state.half_step());
        self.energies = [self.energies[0].max(simulated), kinetic(&self.half_step)];
        if !self.splits {
            return FiniteLevel { displacement, acceleration: plain, split: None };
        }
        let mut lumped = pool.take();
        let [first, _] = MASS;
        for (w, (plain, once)) in lumped.iter_mut().zip(plain.iter().zip(&once)) {
            (0..D).for_each(|c| w[c] = (1.0 - first) * plain[c] + first * once[c]);
        }
        for (acceleration, once) in plain.iter_mut().zip(&once) {
            (0..D).for_each(|c| acceleration[c] += first * once[c]);
        }
        let skew = skew_acceleration::<D, N>(problem, inverse, &lumped, &displacement);
        let split = Some(SplitFields { lumped, skew: pool.copy(&skew) });
        FiniteLevel { displacement, acceleration: plain, split }
    }

    /// f(u + Δt v + ½Δt²ã) + f(u − Δt v + ½Δt²ã) − 2 f(u) (N), with v = v_{n−½} + `back` ã.
    fn bracket(&self, dynamics: &Dynamics<'_, D>, [back, step]: [f64; 2], plain: &[[f64; D]]) -> Vec<[f64; D]> {
        let mut forces = vec![[0.0; D]; plain.len()];
        dynamics.subtract_internal_forces(&self.displacement, &mut forces);
        forces.as_flattened_mut().iter_mut().for_each(|f| *f *= -2.0);
        for sign in [step, -step] {
            let moved = self.displacement.iter().zip(&self.half_step).zip(plain).map(|((u, v), a)| {
                std::array::from_fn(|c| u[c] + sign * (v[c] + back * a[c]) + 0.5 * step * step * a[c])
            });
            dynamics.subtract_internal_forces(&moved.collect::<Vec<_>>(), &mut forces);
        }
        // The forces were subtracted.
        forces.as_flattened_mut().iter_mut().for_each(|f| *f = -*f);
        dynamics.problem().prescribed().iter().for_each(|p| forces[p.node.index()][p.component] = 0.0);
        forces
    }
}

/// ã + c₁o + c₂M⁻¹(M − M_c)o less this share of M⁻¹ of the bracket.
fn corrected<'a, const D: usize>(
    inverse: &'a [f64],
    plain: &'a [[f64; D]],
    [once, twice]: [&'a [[f64; D]]; 2],
    (bracket, share): (&'a [[f64; D]], f64),
) -> impl Iterator<Item = [f64; D]> + 'a {
    let [first, second] = MASS;
    (0..plain.len()).map(move |i| {
        std::array::from_fn(|c| {
            plain[i][c] + first * once[i][c] + second * twice[i][c] - share * bracket[i][c] * inverse[i]
        })
    })
}

/// M⁻¹(M − M_c) of a nodal field, 0 on prescribed components: an element gives m/(D+2) times the distance to the mean
/// of its nodes.
fn lumping_difference<const D: usize, const N: usize>(
    problem: &Problem<D>,
    inverse_mass: &[f64],
    field: &[[f64; D]],
) -> Vec<[f64; D]> {
    let mut difference = vec![[0.0; D]; field.len()];
    for (e, nodes) in problem.mesh().nodes_of::<N>().iter().enumerate() {
        let id = ElementId::new(e);
        let share = problem.material(id).density() * problem.volume(id) / (D + 2) as f64;
        for c in 0..D {
            let mean = nodes.iter().map(|n| field[n.index()][c]).sum::<f64>() / N as f64;
            nodes.iter().for_each(|n| difference[n.index()][c] += share * (field[n.index()][c] - mean));
        }
    }
    for (value, inverse) in difference.iter_mut().zip(inverse_mass) {
        (0..D).for_each(|c| value[c] *= inverse);
    }
    problem.prescribed().iter().for_each(|p| difference[p.node.index()][p.component] = 0.0);
    difference
}
