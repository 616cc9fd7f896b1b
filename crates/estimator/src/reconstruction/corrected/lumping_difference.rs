//! How lumping the mass changes an acceleration.

use percute_core::ids::ElementId;
use percute_core::material::Law;
use percute_core::problem::Problem;

/// The lumping difference M⁻¹(M − M_c) of a nodal field, 0 on prescribed components, which have the motion they must
/// have. An element gives m/(D+2) times the distance to the mean of its nodes.
pub(super) fn lumping_difference<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    inverse_mass: &[f64],
    field: &[[f64; D]],
) -> Vec<[f64; D]> {
    let mut difference = vec![[0.0; D]; field.len()];
    for (e, nodes) in problem.mesh().cells().iter().enumerate() {
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

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::ids::NodeId;
    use percute_core::material::Elastic;
    use percute_core::mesh::TriangleMesh;
    use percute_testkit::random_rectangle;

    /// Of a field on the unit square, at the nodes inside and at those on the boundary; the sides are 0 and 1 exactly.
    fn of(mesh: TriangleMesh, field: impl Fn([f64; 2]) -> [f64; 2]) -> [Vec<[f64; 2]>; 2] {
        let law = Elastic::plane_strain(70e9, 0.3, 2700.0, 1.0).unwrap();
        let problem = Problem::builder(mesh).material(law).build().unwrap();
        let nodal: Vec<_> = problem.mesh().points().iter().map(|p| field(*p)).collect();
        let inverse: Vec<_> = problem.mass().iter().map(|m| 1.0 / m).collect();
        let difference = lumping_difference(&problem, &inverse, &nodal);
        let inside = |n: usize| problem.mesh().stars().star(NodeId::new(n)).is_closed();
        [true, false].map(|wanted| (0..nodal.len()).filter(|&n| inside(n) == wanted).map(|n| difference[n]).collect())
    }

    /// Inside a uniform mesh the six triangles around a node give −(h²/6)(a_xx + a_yy + a_xy): second order.
    #[test]
    fn second_order_inside_a_uniform_mesh() {
        for n in [4, 8] {
            let h = 1.0 / n as f64;
            let mesh = TriangleMesh::rectangle(1.0, 1.0, n, n).unwrap();
            let [inside, _] = of(mesh, |[x, y]| [3.0 * x * x + x, x * y - 2.0 * y * y]);
            assert_eq!(inside.len(), (n - 1) * (n - 1));
            for value in inside {
                // Rounding of a dozen terms.
                assert!((value[0] + h * h).abs() < 1e-14 && (value[1] - 0.5 * h * h).abs() < 1e-14, "{value:?}");
            }
        }
    }

    /// The triangles around a node do not lie evenly at the boundary and in an unstructured mesh. There a linear field,
    /// whose values are of the order of h, has a difference of first order.
    #[test]
    fn first_order_elsewhere() {
        let field = |[x, _]: [f64; 2]| [x, 0.0];
        let largest = |values: &[[f64; 2]]| values.iter().fold(0.0_f64, |m, v| m.max(v[0].abs()));
        for n in [4, 8, 16] {
            let h = 1.0 / n as f64;
            let [inside, boundary] = of(TriangleMesh::rectangle(1.0, 1.0, n, n).unwrap(), field).map(|v| largest(&v));
            assert!(inside < 1e-14 && (0.1..1.0).contains(&(boundary / h)), "{n}: {inside} and {boundary}");
            let unstructured = of(random_rectangle(1.0, 1.0, n, 1).unwrap(), field).map(|v| largest(&v));
            assert!(unstructured.iter().all(|o| (0.05..1.0).contains(&(o / h))), "{n}: {unstructured:?}");
        }
    }
}
