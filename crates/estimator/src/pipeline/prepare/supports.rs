//! Whether u_CA follows the supports.

use crate::kinematic::NodalMotion;
use crate::residual::worse;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;

/// The exact displacement of the prescribed components, carried along the steps.
#[derive(Clone, Debug, Default)]
pub(super) struct SupportCheck {
    /// One for each prescribed component (m).
    pub(super) exact: Vec<f64>,
    /// How far each has been from its undeformed place (m): one that comes back leaves the rounding of its way.
    farthest: Vec<f64>,
    /// The farthest of all (m).
    longest: f64,
}

impl SupportCheck {
    /// Goes on to t_n, and returns the largest relative miss of u_CA there.
    pub(super) fn advance<const D: usize>(
        &mut self,
        problem: &Problem<D>,
        times: &TimeGrid,
        n: usize,
        motion: &NodalMotion<D>,
    ) -> f64 {
        let mut largest = 0.0;
        for (k, p) in problem.prescribed().iter().enumerate() {
            let start = problem.initial_displacement()[p.node.index()][p.component];
            if n == 0 {
                self.exact.push(start);
                self.farthest.push(start.abs());
                continue;
            }
            let velocity = |m: usize| problem.prescribed_velocity(p, times.instants()[m]);
            let exact = &mut self.exact[k];
            *exact += 0.5 * times.step(n - 1) * (velocity(n - 1) + velocity(n));
            let farthest = &mut self.farthest[k];
            *farthest = farthest.max(exact.abs());
            self.longest = self.longest.max(*farthest);
            let scale = farthest.max(1e-12 * self.longest);
            let miss = (motion.displacement()[p.node.index()][p.component] - *exact).abs();
            largest = worse(largest, if miss == 0.0 { 0.0 } else { miss / scale });
        }
        largest
    }
}
