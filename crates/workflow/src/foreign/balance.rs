//! The terms of the balance M a + K u = F + R at a step, eq. \[30\]; with finite kinematics K u are the internal
//! forces.

use super::window::{Held, Window, vectors_of};
use percute_core::border::Vector;
use percute_core::kernel::InternalForces;
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;

/// The forces at all nodes at an instant (N); prescribed components are 0, supports take any force there.
#[derive(Clone, Debug)]
pub(crate) struct Terms {
    /// M a.
    pub(crate) inertia: Vec<Vector>,
    /// K u.
    pub(crate) stiffness: Vec<Vector>,
    /// F.
    pub(crate) load: Vec<Vector>,
}

impl Terms {
    /// M a + K u − F at a node: the contact force there, if all fits.
    pub(crate) fn rest(&self, node: usize) -> Vector {
        std::array::from_fn(|c| self.inertia[node][c] + self.stiffness[node][c] - self.load[node][c])
    }
}

/// Velocities and acceleration that follow from displacements.
#[derive(Clone, Debug)]
pub(crate) struct Motion {
    /// v_{n−½} (m/s), v₀ at the start.
    pub(crate) back: Vec<Vector>,
    /// v_{n+½} (m/s).
    pub(crate) forward: Vec<Vector>,
    /// a_n (m/s²).
    pub(crate) acceleration: Vec<Vector>,
}

impl Motion {
    /// The largest speed in the step after t_n (m/s).
    pub(crate) fn speed(&self) -> f64 {
        self.forward.iter().map(norm).fold(0.0, f64::max)
    }
}

/// Computes [`Terms`] and [`Motion`].
#[derive(Debug)]
pub(crate) struct Balance<'p> {
    internal: InternalForces,
    problem: &'p AnyProblem,
    times: &'p TimeGrid,
}

impl<'p> Balance<'p> {
    pub(crate) fn new(problem: &'p AnyProblem, times: &'p TimeGrid) -> Self {
        Self { internal: InternalForces::new(problem), problem, times }
    }

    pub(crate) fn problem(&self) -> &'p AnyProblem {
        self.problem
    }

    pub(crate) fn times(&self) -> &'p TimeGrid {
        self.times
    }

    /// The motion around an instant, eq. \[29\], \[31\]; none at the last one.
    pub(crate) fn motion(&self, window: Window<'_>) -> Option<Motion> {
        let n = window.now.index;
        let back = match window.before {
            Some(before) => rate(&before.displacement, &window.now.displacement, self.times.step(n - 1)),
            None => vectors_of(self.problem.initial_velocity(), self.problem.dimension()),
        };
        let forward = rate(&window.now.displacement, &window.after?.displacement, self.times.step(n));
        let h = self.times.velocity_step(n);
        let change = |(b, f): (&Vector, &Vector)| std::array::from_fn(|c| (f[c] - b[c]) / h);
        let acceleration = back.iter().zip(&forward).map(change).collect();
        Some(Motion { back, forward, acceleration })
    }

    /// The displacements at t_{n+1} if no contact force acted at t_n (m): those of D and M of the step.
    pub(crate) fn predicted(&self, before: Option<&Held>, now: &Held) -> Vec<Vector> {
        let (problem, n) = (self.problem, now.index);
        let (dt, h) = (self.times.step(n), self.times.velocity_step(n));
        let started = vectors_of(problem.initial_velocity(), problem.dimension());
        let still = vec![[0.0; 3]; now.displacement.len()];
        let terms = self.terms(now, &still);
        let back = before.map(|before| (&before.displacement, self.times.step(n - 1)));
        let node = |node: usize| {
            let (u, rest) = (&now.displacement[node], terms.rest(node));
            let speed = |c: usize| match back {
                Some((earlier, back)) => (u[c] - earlier[node][c]) / back,
                None => started[node][c],
            };
            std::array::from_fn(|c| u[c] + dt * (speed(c) - h * rest[c] / problem.mass()[node]))
        };
        (0..still.len()).map(node).collect()
    }

    /// The terms with this acceleration (m/s²).
    pub(crate) fn terms(&self, now: &Held, acceleration: &[Vector]) -> Terms {
        let (d, mut rest) = (self.problem.dimension(), self.problem.external_forces(now.time));
        let mut load = vectors_of(&rest, d);
        self.internal.subtract_from_rows(now.step().displacement, &mut rest);
        let rest = vectors_of(&rest, d);
        let of = |a: &Vector, b: &Vector| std::array::from_fn(|c| a[c] - b[c]);
        let mut stiffness: Vec<_> = load.iter().zip(&rest).map(|(load, rest)| of(load, rest)).collect();
        let masses = self.problem.mass().iter().zip(acceleration);
        let mut inertia: Vec<Vector> = masses.map(|(m, a)| a.map(|a| m * a)).collect();
        for p in self.problem.prescribed() {
            for field in [&mut inertia, &mut stiffness, &mut load] {
                field[p.node.index()][p.component] = 0.0;
            }
        }
        Terms { inertia, stiffness, load }
    }
}

/// The mean velocity between two displacements dt (s) apart (m/s).
pub(crate) fn rate(from: &[Vector], to: &[Vector], dt: f64) -> Vec<Vector> {
    from.iter().zip(to).map(|(a, b)| std::array::from_fn(|c| (b[c] - a[c]) / dt)).collect()
}

pub(crate) fn norm(a: &Vector) -> f64 {
    dot(a, a).sqrt()
}

pub(crate) fn dot(a: &Vector, b: &Vector) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
