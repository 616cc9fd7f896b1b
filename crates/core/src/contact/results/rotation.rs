//! How far bodies turn: strains and rotations are small by assumption.

use crate::problem::Problem;

/// Instants from one that is looked at to the next one. A free body turns evenly.
const EVERY: usize = 64;

/// The largest rotation of a plane body, of those that fit its displacements best: Σm x×u / Σm|x|², x from the centre
/// of mass.
#[derive(Clone, Debug)]
pub(super) struct Rotation<const D: usize> {
    /// m x / Σm|x|² of each node (1/m); none on a bar.
    levers: Vec<[f64; D]>,
    /// The body of each node.
    bodies: Vec<usize>,
    /// How far each body has turned at an instant (rad).
    turned: Vec<f64>,
    last: usize,
}

impl<const D: usize> Rotation<D> {
    /// Of all bodies of a problem, in a run of so many steps.
    pub(super) fn new<const N: usize>(problem: &Problem<D, N>, steps: usize) -> Self {
        let (mesh, masses) = (problem.mesh(), problem.mass());
        let mut bodies = mesh.part_numbers();
        let count = bodies.iter().max().map_or(0, |last| last + 1);
        if D != 2 {
            bodies.clear();
        }
        let (mut mass, mut centre, mut inertia) = (vec![0.0; count], vec![[0.0; D]; count], vec![0.0; count]);
        for ((&body, x), m) in bodies.iter().zip(mesh.points()).zip(masses) {
            mass[body] += m;
            (0..D).for_each(|c| centre[body][c] += m * x[c]);
        }
        let from_centre =
            |body: usize, x: &[f64; D]| -> [f64; D] { std::array::from_fn(|c| x[c] - centre[body][c] / mass[body]) };
        for ((&body, x), m) in bodies.iter().zip(mesh.points()).zip(masses) {
            inertia[body] += m * from_centre(body, x).iter().map(|x| x * x).sum::<f64>();
        }
        let lever = |((&body, x), m): ((&usize, &[f64; D]), &f64)| from_centre(body, x).map(|x| m * x / inertia[body]);
        let levers = bodies.iter().zip(mesh.points()).zip(masses).map(lever).collect();
        Self { levers, bodies, turned: vec![0.0; count], last: steps }
    }

    /// The largest rotation of a body at an instant with these displacements (rad), or 0 where none is looked for.
    pub(super) fn at(&mut self, instant: usize, displacement: &[[f64; D]]) -> f64 {
        if !instant.is_multiple_of(EVERY) && instant != self.last {
            return 0.0;
        }
        self.turned.fill(0.0);
        for ((&body, lever), u) in self.bodies.iter().zip(&self.levers).zip(displacement) {
            self.turned[body] += lever[0] * u[1] - lever[1] * u[0];
        }
        self.turned.iter().fold(0.0, |largest: f64, turned| largest.max(turned.abs()))
    }
}
