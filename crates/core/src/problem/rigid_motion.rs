//! The rigid motion of each body in a nodal field.

use super::{Problem, ProblemRef};
use crate::border::{Vector, padded};
use crate::on_problem;
use std::array::from_fn;

/// What weighs a nodal field for the rigid motion of each body that fits it best: the mean Σmu/Σm, and the rotation
/// J⁻¹ Σm x×u with J = Σm(|x|² 1 − x xᵀ), x from the centre of mass. Fields are in rows.
#[derive(Clone, Debug)]
pub struct RigidMotion {
    dimension: usize,
    /// m of each node (kg).
    masses: Vec<f64>,
    /// x of each node (m).
    arms: Vec<Vector>,
    /// The body of each node.
    of_node: Vec<usize>,
    /// Σm of each body (kg).
    mass: Vec<f64>,
    /// J of each body (kg m²).
    inertia: Vec<[Vector; 3]>,
}

impl RigidMotion {
    /// That of all bodies of a problem.
    #[must_use]
    pub fn new<'p>(problem: impl Into<ProblemRef<'p>>) -> Self {
        fn of(problem: ProblemRef<'_>) -> RigidMotion {
            on_problem!(problem, problem => RigidMotion::of(problem))
        }
        of(problem.into())
    }

    fn of<const D: usize>(problem: &Problem<D>) -> Self {
        let (mesh, masses) = (problem.mesh(), problem.mass().to_vec());
        let (of_node, bodies) = (mesh.part_numbers(), mesh.parts());
        let (mut mass, mut centre, mut inertia) =
            (vec![0.0; bodies], vec![[0.0; 3]; bodies], vec![[[0.0; 3]; 3]; bodies]);
        let points: Vec<Vector> = mesh.points_in::<D>().iter().map(padded).collect();
        for ((&body, x), m) in of_node.iter().zip(&points).zip(&masses) {
            mass[body] += m;
            (0..3).for_each(|c| centre[body][c] += m * x[c]);
        }
        let arm = |(x, &body): (&Vector, &usize)| from_fn(|c| x[c] - centre[body][c] / mass[body]);
        let arms: Vec<Vector> = points.iter().zip(&of_node).map(arm).collect();
        for ((&body, arm), m) in of_node.iter().zip(&arms).zip(&masses) {
            let square = arm.iter().map(|x| x * x).sum::<f64>();
            for a in 0..3 {
                inertia[body][a][a] += m * square;
                (0..3).for_each(|b| inertia[body][a][b] -= m * arm[a] * arm[b]);
            }
        }
        Self { dimension: D, masses, arms, of_node, mass, inertia }
    }

    /// How far each body turns in a field of displacements (rad) or of velocities (rad/s): counterclockwise in the
    /// plane, about any axis and positive in a solid, and 0 on bars.
    #[must_use]
    pub fn rotations(&self, field: &[f64]) -> Vec<f64> {
        let size = |turned: &Vector| if self.dimension == 3 { dot(turned, turned).sqrt() } else { turned[2] };
        self.axial_rotations(field).iter().map(size).collect()
    }

    /// The same as vectors along the axes.
    #[must_use]
    pub fn axial_rotations(&self, field: &[f64]) -> Vec<Vector> {
        let mut turned = vec![[0.0; 3]; self.mass.len()];
        let nodes = self.of_node.iter().zip(&self.arms).zip(&self.masses);
        match self.dimension {
            2 => {
                for (((&body, arm), m), u) in nodes.zip(field.as_chunks::<2>().0) {
                    turned[body][2] += m * (arm[0] * u[1] - arm[1] * u[0]) / self.inertia[body][2][2];
                }
            }
            3 => {
                for (((&body, arm), m), u) in nodes.zip(field.as_chunks::<3>().0) {
                    let moment = cross(arm, u);
                    (0..3).for_each(|c| turned[body][c] += m * moment[c]);
                }
                turned.iter_mut().zip(&self.inertia).for_each(|(turned, inertia)| *turned = solve(inertia, turned));
            }
            _ => {}
        }
        turned
    }

    /// The mean of a field over each body, weighted with the mass.
    #[must_use]
    pub fn means(&self, field: &[f64]) -> Vec<Vector> {
        let mut means = vec![[0.0; 3]; self.mass.len()];
        for ((&body, m), u) in self.of_node.iter().zip(&self.masses).zip(field.chunks_exact(self.dimension)) {
            u.iter().zip(&mut means[body]).for_each(|(u, mean)| *mean += m * u / self.mass[body]);
        }
        means
    }

    /// The kinetic energy of velocities relative to the rigid motion of each body (J). The motion is subtracted before
    /// the sum: a large common velocity leaves no rounding of its energy.
    #[must_use]
    pub fn relative_kinetic_energy(&self, velocity: &[f64]) -> f64 {
        let (means, turning) = (self.means(velocity), self.axial_rotations(velocity));
        let nodes = self.of_node.iter().zip(&self.arms).zip(&self.masses).zip(velocity.chunks_exact(self.dimension));
        let twice = nodes.map(|(((&body, arm), m), v)| {
            let turned = cross(&turning[body], arm);
            let relative = |(c, v): (usize, &f64)| v - means[body][c] - turned[c];
            m * v.iter().enumerate().map(|component| relative(component).powi(2)).sum::<f64>()
        });
        0.5 * twice.sum::<f64>()
    }
}

fn dot(a: &Vector, b: &Vector) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// J⁻¹ b of a symmetric J.
fn solve(matrix: &[Vector; 3], b: &Vector) -> Vector {
    let [x, y, z] = matrix;
    let rows = [cross(y, z), cross(z, x), cross(x, y)];
    let determinant = dot(x, &rows[0]);
    from_fn(|c| dot(&[rows[0][c], rows[1][c], rows[2][c]], b) / determinant)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Elastic;
    use crate::mesh::{ElementGroups, FaceGroups, Mesh};

    /// Two squares of 1 m, apart, of 2 kg each.
    fn squares() -> Problem<2> {
        let here = Mesh::rectangle(1.0, 1.0, 3, 2).unwrap();
        let points = here.points_in::<2>().iter().map(|[x, y]| [x + 5.0, *y]).collect();
        let cells: Vec<_> = here.nodes_of::<3>().iter().map(|cell| cell.map(|node| node.index())).collect();
        let there = Mesh::new(points, &cells, &FaceGroups::new(), &ElementGroups::new()).unwrap();
        let mesh = Mesh::joined(&[("a", &here), ("b", &there)]).unwrap();
        let law = Elastic::plane_strain(1.0, 0.2, 2.0, 1.0).unwrap();
        Problem::<2>::builder(mesh).material(law).build().unwrap()
    }

    /// Each body moves and turns in its own way, 400 m/s apart, and one of them stretches besides: the energy is that
    /// of the stretch alone: without shear it is orthogonal to the rest.
    #[test]
    fn only_the_rest_of_a_rigid_motion_has_energy() {
        let problem = squares();
        let rigid = RigidMotion::new(&problem);
        let [spin, stretch] = [3.0, 1e-3];
        let field: Vec<[f64; 2]> = (0..problem.mesh().node_count())
            .map(|i| {
                let ([x, y, _], first) = (rigid.arms[i], rigid.of_node[i] == 0);
                if first {
                    [400.0 - spin * y, 2.0 + spin * x]
                } else {
                    [-30.0 + stretch * x + 5.0 * y, stretch * y - 5.0 * x]
                }
            })
            .collect();
        let expected: f64 = (0..field.len())
            .filter(|&i| rigid.of_node[i] == 1)
            .map(|i| 0.5 * problem.mass()[i] * stretch.powi(2) * rigid.arms[i].iter().map(|x| x * x).sum::<f64>())
            .sum();
        let found = rigid.relative_kinetic_energy(field.as_flattened());
        // Rounding of 400 m/s, 1e-13, squared and beside 1e-3.
        assert!((found - expected).abs() < 1e-9 * expected, "{found} for {expected}");
        assert!((rigid.rotations(field.as_flattened())[0] - spin).abs() < 1e-12);
        assert!((rigid.rotations(field.as_flattened())[1] + 5.0).abs() < 1e-12);
    }

    #[test]
    fn a_bar_does_not_turn() {
        let mesh = Mesh::uniform_bar(2.0, 4).unwrap();
        let problem = Problem::<1>::builder(mesh).material(Elastic::bar(1.0, 1.0, 1.0).unwrap()).build().unwrap();
        let rigid = RigidMotion::new(&problem);
        let field: Vec<[f64; 1]> = problem.mesh().points_in::<1>().iter().map(|[x]| [7.0 + (x - 1.0)]).collect();
        // Masses of ¼, ½, ½, ½, ¼ kg at −1, −½, 0, ½, 1 m.
        assert!((rigid.relative_kinetic_energy(field.as_flattened()) - 0.375).abs() < 1e-14);
        assert_eq!(rigid.rotations(field.as_flattened()), [0.0]);
    }
}
