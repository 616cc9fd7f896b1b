//! Nodal motion between contacts: velocity continuous and linear between the half-step instants,
//! displacement its exact integral.

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
    /// v_{n+½} by the scheme.
    half_step: Vec<[f64; D]>,
    next: usize,
}

impl<const D: usize> FreeMotion<D> {
    pub(crate) fn new<const N: usize>(problem: &Problem<D, N>) -> Self {
        Self {
            displacement: problem.initial_displacement().to_vec(),
            velocity: problem.initial_velocity().to_vec(),
            half_step: problem.initial_velocity().to_vec(),
            next: 0,
        }
    }

    /// Advances over the half steps to t_{n−½} and t_n with a_n, and returns the motion at both;
    /// at n = 0 there is no half step and the initial conditions are returned. A history may bring
    /// its own v_n; v_{n−½} then lies ½Δt_{n−1} a_n before it.
    pub(crate) fn advance<const N: usize>(
        &mut self,
        problem: &Problem<D, N>,
        times: &TimeGrid,
        acceleration: &[[f64; D]],
        given: Option<&[[f64; D]]>,
    ) -> (Option<NodalMotion<D>>, NodalMotion<D>) {
        let n = self.next;
        self.next += 1;
        let mut mid = None;
        if n > 0 {
            let half = 0.5 * times.step(n - 1);
            if let Some(given) = given {
                for (h, (v, a)) in self.half_step.iter_mut().zip(given.iter().zip(acceleration)) {
                    (0..D).for_each(|c| h[c] = v[c] - half * a[c]);
                }
            }
            let mut velocity = self.half_step.clone();
            prescribe(problem, &mut velocity, |p| {
                let v = |k: usize| problem.prescribed_velocity(p, times.instants()[k]);
                0.5 * (v(n - 1) + v(n))
            });
            self.integrate(half, &velocity);
            mid = Some(NodalMotion { displacement: self.displacement.clone(), velocity: velocity.clone() });

            // v_n = v_{n−½} + ½Δt_{n−1} a_n, [38] when the step is constant.
            match given {
                Some(given) => velocity.copy_from_slice(given),
                None => {
                    for (v, (h, a)) in velocity.iter_mut().zip(self.half_step.iter().zip(acceleration)) {
                        (0..D).for_each(|c| v[c] = h[c] + half * a[c]);
                    }
                }
            }
            prescribe(problem, &mut velocity, |p| problem.prescribed_velocity(p, times.instants()[n]));
            self.integrate(half, &velocity);
        }
        let h = times.velocity_step(n);
        for (v, a) in self.half_step.iter_mut().zip(acceleration) {
            (0..D).for_each(|c| v[c] += h * a[c]);
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
