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

impl<const D: usize> Terms<D> {
    /// M a + K u − F at a node: the contact force there, if all fits.
    pub(crate) fn rest(&self, node: usize) -> [f64; D] {
        std::array::from_fn(|c| self.inertia[node][c] + self.stiffness[node][c] - self.load[node][c])
    }
}

/// Velocities and acceleration that follow from displacements.
#[derive(Clone, Debug)]
pub(crate) struct Motion<const D: usize> {
    /// v_{n−½} (m/s), v₀ at the start.
    pub(crate) back: Vec<[f64; D]>,
    /// v_{n+½} (m/s).
    pub(crate) forward: Vec<[f64; D]>,
    /// a_n (m/s²).
    pub(crate) acceleration: Vec<[f64; D]>,
}

impl<const D: usize> Motion<D> {
    /// The largest speed in the step after t_n (m/s).
    pub(crate) fn speed(&self) -> f64 {
        self.forward.iter().map(norm).fold(0.0, f64::max)
    }
}

/// Computes [`Terms`] and [`Motion`].
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

    /// The motion around an instant, eq. \[29\], \[31\]; none at the last one.
    pub(crate) fn motion(&self, window: Window<'_, D>) -> Option<Motion<D>> {
        let n = window.now.index;
        let back = match window.before {
            Some(before) => rate(&before.displacement, &window.now.displacement, self.times.step(n - 1)),
            None => self.problem.initial_velocity().to_vec(),
        };
        let forward = rate(&window.now.displacement, &window.after?.displacement, self.times.step(n));
        let h = self.times.velocity_step(n);
        let change = |(b, f): (&[f64; D], &[f64; D])| std::array::from_fn(|c| (f[c] - b[c]) / h);
        let acceleration = back.iter().zip(&forward).map(change).collect();
        Some(Motion { back, forward, acceleration })
    }

    /// The displacements at t_{n+1} if no contact force acted at t_n (m): those of D and M of the step.
    pub(crate) fn predicted(&self, before: Option<&Held<D>>, now: &Held<D>) -> Vec<[f64; D]> {
        let (problem, n) = (self.problem, now.index);
        let (dt, h) = (self.times.step(n), self.times.velocity_step(n));
        let still = vec![[0.0; D]; now.displacement.len()];
        let terms = self.terms(now, &still);
        let back = before.map(|before| (&before.displacement, self.times.step(n - 1)));
        let node = |node: usize| {
            let (u, rest) = (&now.displacement[node], terms.rest(node));
            let speed = |c: usize| match back {
                Some((earlier, back)) => (u[c] - earlier[node][c]) / back,
                None => problem.initial_velocity()[node][c],
            };
            std::array::from_fn(|c| u[c] + dt * (speed(c) - h * rest[c] / problem.mass()[node]))
        };
        (0..still.len()).map(node).collect()
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

/// The mean velocity between two displacements dt (s) apart (m/s).
pub(crate) fn rate<const D: usize>(from: &[[f64; D]], to: &[[f64; D]], dt: f64) -> Vec<[f64; D]> {
    from.iter().zip(to).map(|(a, b)| std::array::from_fn(|c| (b[c] - a[c]) / dt)).collect()
}

pub(crate) fn norm<const D: usize>(a: &[f64; D]) -> f64 {
    dot(a, a).sqrt()
}

pub(crate) fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
