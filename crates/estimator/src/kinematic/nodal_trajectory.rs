//! Nodal motion between contacts: velocity continuous and linear between the half-step instants,
//! displacement its exact integral.

use crate::nodal_field::{FieldPool, NodalField};
use crate::parallel::by_pieces;
use percute_core::history::State;
use percute_core::problem::Problem;
use percute_core::simd::lanes::Value;
use percute_core::time::TimeGrid;
use std::sync::Arc;

/// u_CA and u̇_CA at all nodes at one half-step instant; the normal components at contact nodes are those of the
/// simulation.
#[derive(Clone, Debug)]
pub(crate) struct NodalMotion<const D: usize> {
    displacement: Arc<NodalField<D>>,
    velocity: Arc<NodalField<D>>,
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
    pub(crate) fn parts_mut(&mut self) -> [&mut NodalField<D>; 2] {
        [&mut self.displacement, &mut self.velocity].map(Arc::make_mut)
    }
}

/// The motion of all nodes, advanced step by step.
#[derive(Clone, Debug)]
pub(crate) struct NodalTrajectory<const D: usize> {
    now: NodalMotion<D>,
    pool: FieldPool<D>,
}

impl<const D: usize> NodalTrajectory<D> {
    pub(crate) fn new(problem: &Problem<D>, pool: &FieldPool<D>) -> Self {
        let copy = |field: &[[f64; D]]| Arc::new(pool.copy(field));
        let (displacement, velocity) = (copy(problem.initial_displacement()), copy(problem.initial_velocity()));
        Self { now: NodalMotion { displacement, velocity }, pool: pool.clone() }
    }

    /// Advances over the half steps to t_{n−½} and t_n, and returns the velocity at the first (m/s) and the motion at
    /// the second; at n = 0 there is no half step and the initial conditions are returned.
    pub(crate) fn advance(
        &mut self,
        problem: &Problem<D>,
        times: &TimeGrid,
        state: &State<'_>,
    ) -> (Option<NodalField<D>>, NodalMotion<D>) {
        let n = state.step().index;
        if n == 0 {
            return (None, self.now.clone());
        }
        let (u, v) = (self.now.displacement(), self.now.velocity());
        let quarter = 0.25 * times.step(n - 1);
        let [mut v_mid, mut u_now, mut v_now] = [(); 3].map(|()| self.pool.take());
        // Velocity is linear over each half step, displacement its exact integral.
        let displacement = |i: usize, mid: &[f64; D], now: &[f64; D]| -> [f64; D] {
            std::array::from_fn(|c| {
                let half_way = u[i][c] + quarter * (v[i][c] + mid[c]);
                half_way + quarter * (mid[c] + now[c])
            })
        };
        by_pieces((&mut u_now[..], &mut v_mid[..], &mut v_now[..]), &|first, (u_now, v_mid, v_now)| {
            for (k, ((u_now, v_mid), v_now)) in u_now.iter_mut().zip(v_mid).zip(v_now).enumerate() {
                let (mid, now) = (state.half_step()[first + k], state.velocity_of(first + k));
                *u_now = displacement(first + k, &mid, &now);
                (*v_mid, *v_now) = (mid, now);
            }
        });
        for nodes in problem.prescribed().chunk_by(|a, b| a.node == b.node) {
            let i = nodes[0].node.index();
            let (mut mid, mut now) = (state.half_step()[i], state.velocity_of(i));
            for p in nodes {
                let [before, after] = [n - 1, n].map(|k| problem.prescribed_velocity(p, times.instants()[k]));
                (mid[p.component], now[p.component]) = (0.5 * (before + after), after);
            }
            u_now[i] = displacement(i, &mid, &now);
            (v_mid[i], v_now[i]) = (mid, now);
        }
        self.now = NodalMotion { displacement: Arc::new(u_now), velocity: Arc::new(v_now) };
        (Some(v_mid), self.now.clone())
    }
}

/// u_CA in the middle of a step of this length (s), from that at its end and the velocities in the middle and at the
/// end.
#[inline(always)]
pub(crate) fn half_way<T: Value, const D: usize>(
    length: T,
    end: &[T; D],
    [mid_velocity, end_velocity]: [&[T; D]; 2],
) -> [T; D] {
    let (mut displacement, quarter) = (*end, length * 0.25);
    for c in 0..D {
        displacement[c] -= quarter * (mid_velocity[c] + end_velocity[c]);
    }
    displacement
}
