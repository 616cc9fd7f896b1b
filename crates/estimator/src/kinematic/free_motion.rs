//! Nodal motion between contacts: velocity continuous and linear between the half-step instants,
//! displacement its exact integral.

use percute_core::history::State;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;

/// u_CA and u̇_CA at all nodes at one half-step instant; the normal components at contact nodes are those of the simulation.
#[derive(Clone, Debug)]
pub(crate) struct NodalMotion<const D: usize> {
    displacement: Vec<[f64; D]>,
    velocity: Vec<[f64; D]>,
}

impl<const D: usize> NodalMotion<D> {
    /// u_CA (m).
    #[inline]
    pub(crate) fn displacement(&self) -> &[[f64; D]] {
        &self.displacement
    }

    /// u̇_CA (m/s).
    #[inline]
    pub(crate) fn velocity(&self) -> &[[f64; D]] {
        &self.velocity
    }

    /// Both, for tests that change them.
    #[cfg(test)]
    pub(crate) fn parts_mut(&mut self) -> [&mut Vec<[f64; D]>; 2] {
        [&mut self.displacement, &mut self.velocity]
    }
}

/// The motion of all nodes, advanced step by step.
#[derive(Clone, Debug)]
pub(crate) struct FreeMotion<const D: usize> {
    displacement: Vec<[f64; D]>,
    velocity: Vec<[f64; D]>,
}

impl<const D: usize> FreeMotion<D> {
    pub(crate) fn new<const N: usize>(problem: &Problem<D, N>) -> Self {
        Self { displacement: problem.initial_displacement().to_vec(), velocity: problem.initial_velocity().to_vec() }
    }

    /// Advances over the half steps to t_{n−½} and t_n, and returns the motion at both; at n = 0 there is no half step and
    /// the initial conditions are returned.
    pub(crate) fn advance<const N: usize>(
        &mut self,
        problem: &Problem<D, N>,
        times: &TimeGrid,
        state: &State<'_, D>,
    ) -> (Option<NodalMotion<D>>, NodalMotion<D>) {
        let n = state.step().index;
        let mut mid = None;
        if n > 0 {
            let half = 0.5 * times.step(n - 1);
            let mut velocity = state.half_step().to_vec();
            prescribe(problem, &mut velocity, |p| {
                let v = |k: usize| problem.prescribed_velocity(p, times.instants()[k]);
                0.5 * (v(n - 1) + v(n))
            });
            self.integrate(half, &velocity);
            mid = Some(NodalMotion { displacement: self.displacement.clone(), velocity });

            let mut velocity = state.velocity();
            prescribe(problem, &mut velocity, |p| problem.prescribed_velocity(p, times.instants()[n]));
            self.integrate(half, &velocity);
        }
        (mid, NodalMotion { displacement: self.displacement.clone(), velocity: self.velocity.clone() })
    }

    /// Exact integral of a velocity that is linear over a length of time.
    fn integrate(&mut self, length: f64, velocity: &[[f64; D]]) {
        let states = self.displacement.iter_mut().zip(&mut self.velocity).zip(velocity);
        for ((u, before), after) in states {
            for c in 0..D {
                u[c] += 0.5 * length * (before[c] + after[c]);
            }
            *before = *after;
        }
    }
}

/// Prescribed components take v_d.
fn prescribe<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    velocity: &mut [[f64; D]],
    value: impl Fn(&percute_core::problem::PrescribedComponent) -> f64,
) {
    for p in problem.prescribed() {
        velocity[p.node.index()][p.component] = value(p);
    }
}
