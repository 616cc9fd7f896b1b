//! The rotation of each body in a nodal field.

use super::Problem;

/// What weighs a nodal field for the rotation of each body: that of the rigid rotation which fits it best,
/// Σm x×u / Σm|x|², x from the centre of mass.
#[derive(Clone, Debug)]
pub struct Levers<const D: usize> {
    /// m x / Σm|x|² of each node (1/m); none on a bar.
    levers: Vec<[f64; D]>,
    /// The body of each node.
    of_node: Vec<usize>,
    bodies: usize,
}

impl<const D: usize> Levers<D> {
    /// Those of all bodies of a problem.
    #[must_use]
    pub fn new<const N: usize>(problem: &Problem<D, N>) -> Self {
        let (mesh, masses) = (problem.mesh(), problem.mass());
        let (mut of_node, bodies) = (mesh.part_numbers(), mesh.parts());
        if D != 2 {
            of_node.clear();
        }
        let (mut mass, mut centre, mut inertia) = (vec![0.0; bodies], vec![[0.0; D]; bodies], vec![0.0; bodies]);
        for ((&body, x), m) in of_node.iter().zip(mesh.points()).zip(masses) {
            mass[body] += m;
            (0..D).for_each(|c| centre[body][c] += m * x[c]);
        }
        let from_centre =
            |body: usize, x: &[f64; D]| -> [f64; D] { std::array::from_fn(|c| x[c] - centre[body][c] / mass[body]) };
        for ((&body, x), m) in of_node.iter().zip(mesh.points()).zip(masses) {
            inertia[body] += m * from_centre(body, x).iter().map(|x| x * x).sum::<f64>();
        }
        let lever = |((&body, x), m): ((&usize, &[f64; D]), &f64)| from_centre(body, x).map(|x| m * x / inertia[body]);
        let levers = of_node.iter().zip(mesh.points()).zip(masses).map(lever).collect();
        Self { levers, of_node, bodies }
    }

    /// How far each body turns, counterclockwise, in a field of displacements (rad) or of velocities (rad/s); 0 on
    /// bars.
    #[must_use]
    pub fn rotations(&self, field: &[[f64; D]]) -> Vec<f64> {
        let mut turned = vec![0.0; self.bodies];
        for ((&body, lever), u) in self.of_node.iter().zip(&self.levers).zip(field) {
            turned[body] += lever[0] * u[1] - lever[1] * u[0];
        }
        turned
    }
}
