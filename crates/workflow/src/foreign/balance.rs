//! The terms of the balance M a + K u = F + R at a step, eq. \[30\].

use super::window::{Held, Window};
use percute_core::dynamics::Dynamics;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;

/// The forces at all nodes at an instant (N); prescribed components are 0, supports take any force there.
#[derive(Clone, Debug)]
pub(crate) struct Terms<const D: usize> {
    /// M a.
    pub(crate) inertia: Vec<[f64; D]>,
    /// K u.
    pub(crate) stiffness: Vec<[f64; D]>,
    /// F.
    pub(crate) load: Vec<[f64; D]>,
}

/// Computes [`Terms`].
#[derive(Debug)]
pub(crate) struct Balance<'p, const D: usize, const N: usize> {
    dynamics: Dynamics<'p, D, N>,
    problem: &'p Problem<D, N>,
    times: &'p TimeGrid,
}

impl<'p, const D: usize, const N: usize> Balance<'p, D, N> {
    pub(crate) fn new(problem: &'p Problem<D, N>, times: &'p TimeGrid) -> Self {
        Self { dynamics: Dynamics::new(problem, times), problem, times }
    }

    pub(crate) fn problem(&self) -> &'p Problem<D, N> {
        self.problem
    }

    pub(crate) fn times(&self) -> &'p TimeGrid {
        self.times
    }

    /// Velocities in the steps before and after t_n (m/s), before the first step v₀; none at the last instant.
    pub(crate) fn half_steps(&self, window: Window<'_, D>) -> Option<[Vec<[f64; D]>; 2]> {
        let n = window.now.index;
        let difference = |from: &Held<D>, to: &Held<D>, dt: f64| {
            let ends = from.displacement.iter().zip(&to.displacement);
            ends.map(|(a, b)| std::array::from_fn(|c| (b[c] - a[c]) / dt)).collect::<Vec<_>>()
        };
        let back = match window.before {
            Some(before) => difference(before, window.now, self.times.step(n - 1)),
            None => self.problem.initial_velocity().to_vec(),
        };
        Some([back, difference(window.now, window.after?, self.times.step(n))])
    }

    /// a_n from the displacements (m/s²), at t_0 with v₀, eq. \[29\], \[31\]; none at the last instant.
    pub(crate) fn acceleration(&self, window: Window<'_, D>) -> Option<Vec<[f64; D]>> {
        let [back, forward] = self.half_steps(window)?;
        let h = self.times.velocity_step(window.now.index);
        let change = |(b, f): (&[f64; D], &[f64; D])| std::array::from_fn(|c| (f[c] - b[c]) / h);
        Some(back.iter().zip(&forward).map(change).collect())
    }

    /// The terms with this acceleration (m/s²).
    pub(crate) fn terms(&self, now: &Held<D>, acceleration: &[[f64; D]]) -> Terms<D> {
        let nodes = now.displacement.len();
        let mut load = vec![[0.0; D]; nodes];
        self.problem.external_forces(now.time, &mut load);
        let mut rest = load.clone();
        self.dynamics.stiffness().subtract_internal_forces(&now.displacement, &mut rest);
        let of = |a: &[f64; D], b: &[f64; D]| std::array::from_fn(|c| a[c] - b[c]);
        let mut stiffness: Vec<_> = load.iter().zip(&rest).map(|(load, rest)| of(load, rest)).collect();
        let masses = self.problem.mass().iter().zip(acceleration);
        let mut inertia: Vec<[f64; D]> = masses.map(|(m, a)| a.map(|a| m * a)).collect();
        for p in self.problem.prescribed() {
            for field in [&mut inertia, &mut stiffness, &mut load] {
                field[p.node.index()][p.component] = 0.0;
            }
        }
        Terms { inertia, stiffness, load }
    }
}

pub(crate) fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
