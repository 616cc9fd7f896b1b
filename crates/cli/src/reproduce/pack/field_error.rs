//! The error of a bar's fields against any exact solution, in the energy norm.

use super::trial::Trial;
use percute_core::ids::ElementId;

/// Points in each element: the exact field may jump inside of one, which is then cut to 1/16 of it at worst, 1/16 of what
/// the scheme smears.
const POINTS: usize = 8;

/// √((1/T)∫e² dt) over the t_n (J^½), e² the kinetic plus strain energy of the difference between the simulation and an exact solution
/// that gives velocity (m/s) and normal force (N) at x and t, as eq. \[60\].
pub(super) fn mean_error(trial: &Trial<1, 2>, exact: impl Fn(f64, f64) -> (f64, f64)) -> f64 {
    let squares: Vec<f64> = (0..trial.times().len()).map(|n| square(trial, n, &exact)).collect();
    let times = trial.times();
    let strip = |n: usize| 0.5 * (times[n + 1] - times[n]) * (squares[n] + squares[n + 1]);
    let integral: f64 = (0..times.len() - 1).map(strip).sum();
    (integral / trial.case.times.end()).sqrt()
}

/// e² at t_n (J).
fn square(trial: &Trial<1, 2>, n: usize, exact: &impl Fn(f64, f64) -> (f64, f64)) -> f64 {
    let (problem, time) = (&trial.case.problem, trial.times()[n]);
    let (u, v) = (&trial.motion.displacement[n], &trial.motion.velocity[n]);
    let element = |e: usize| {
        let element = ElementId::new(e);
        let nodes = problem.mesh().cells()[e].map(|n| n.index());
        let [x0, x1] = problem.mesh().cell_points(element).map(|p| p[0]);
        let law = problem.material(element);
        let stiffness = law.young() * law.extent();
        let force = stiffness * (u[nodes[1]][0] - u[nodes[0]][0]) / (x1 - x0);
        let [v0, v1] = nodes.map(|n| v[n][0]);
        let point = |k: usize| {
            let s = (k as f64 + 0.5) / POINTS as f64;
            let (velocity, normal_force) = exact(x0 + s * (x1 - x0), time);
            let (dv, df) = (v0 + s * (v1 - v0) - velocity, force - normal_force);
            law.density() * law.extent() * dv * dv + df * df / stiffness
        };
        0.5 * (x1 - x0) / POINTS as f64 * (0..POINTS).map(point).sum::<f64>()
    };
    (0..problem.mesh().element_count()).map(element).sum()
}
