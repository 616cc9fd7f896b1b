//! The true error of a motion of tetrahedra against exact fields.

use percute_core::border::vectors;
use percute_core::ids::ElementId;
use percute_core::material::{Law, LinearLaw};
use percute_core::problem::Problem;
use percute_estimator::reference::Motion;

/// Exact stress (Pa) and velocity (m/s) at a point and an instant.
pub(super) type Exact<'a> = dyn Fn([f64; 3], f64) -> ([[f64; 3]; 3], [f64; 3]) + 'a;

/// Gauss points on (0, 1) with their weights, exact to degree 5.
const LINE: [(f64, f64); 3] =
    [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

/// Barycentric points and weights of a tetrahedron: a cube of Gauss points that is folded up.
fn points() -> Vec<([f64; 4], f64)> {
    let mut points = Vec::new();
    for (a, i) in LINE {
        for (b, j) in LINE {
            for (c, k) in LINE {
                let (x, y) = (a, b * (1.0 - a));
                let z = c * (1.0 - a) * (1.0 - b);
                points.push(([1.0 - x - y - z, x, y, z], 6.0 * i * j * k * (1.0 - a).powi(2) * (1.0 - b)));
            }
        }
    }
    points
}

/// Largest and mean true error (J^½) at every so many steps, by the trapezoidal rule.
pub(super) fn true_error(problem: &Problem<3>, motion: &Motion, every: usize, exact: &Exact<'_>) -> [f64; 2] {
    let last = motion.times.len() - 1;
    let sampled: Vec<usize> = (0..=last).filter(|n| n % every == 0 || *n == last).collect();
    let squares: Vec<f64> = sampled.iter().map(|&n| square(problem, motion, n, exact)).collect();
    let largest = squares.iter().fold(0.0_f64, |m, s| m.max(*s));
    let times: Vec<f64> = sampled.iter().map(|&n| motion.times[n]).collect();
    let strips = (1..times.len()).map(|k| 0.5 * (squares[k] + squares[k - 1]) * (times[k] - times[k - 1]));
    [largest.sqrt(), (strips.sum::<f64>() / motion.times[last]).sqrt()]
}

fn square(problem: &Problem<3>, motion: &Motion, n: usize, exact: &Exact<'_>) -> f64 {
    let (mesh, points) = (problem.mesh(), points());
    let [u, v] = [&motion.displacement[n], &motion.velocity[n]].map(|field| vectors::<3>(field));
    let mut sum = 0.0;
    for e in (0..mesh.element_count()).map(ElementId::new) {
        let (law, geometry, nodes) = (problem.material(e), mesh.geometry::<3, 4>(e), mesh.nodes_of::<4>()[e.index()]);
        let (corners, v) = (mesh.corners::<3, 4>(e), nodes.map(|n| v[n.index()]));
        let mut gradient = [[0.0; 3]; 3];
        for (node, shape) in nodes.iter().zip(&geometry.gradients) {
            (0..9).for_each(|k| gradient[k / 3][k % 3] += u[node.index()][k / 3] * shape[k % 3]);
        }
        let stress = law.stress(&gradient);
        for (at, weight) in &points {
            let mean =
                |f: &[[f64; 3]; 4]| -> [f64; 3] { std::array::from_fn(|c| (0..4).map(|k| at[k] * f[k][c]).sum()) };
            let (exact_stress, exact_velocity) = exact(mean(&corners), motion.times[n]);
            let own = mean(&v);
            let difference = [0, 1, 2].map(|a| [0, 1, 2].map(|b| stress[a][b] - exact_stress[a][b]));
            let speed: f64 = (0..3).map(|c| (own[c] - exact_velocity[c]).powi(2)).sum();
            let density = 2.0 * law.complementary_energy(&difference) + law.density() * speed;
            sum += 0.5 * geometry.volume * weight * density;
        }
    }
    sum
}
