//! The auxiliary solution of a solid beside its plain formulas with dense matrices.

use super::super::comparison::{loaded, miss, random_field, uneven};
use super::dense::DenseSolid;
use super::*;
use crate::element::elements;
use crate::reconstruction::corrected::split::skew_acceleration;
use nalgebra::DVector;
use percute_core::material::Elastic;
use percute_core::mesh::{ElementGroups, Mesh};
use percute_testkit::Random;

/// A box of uneven tetrahedra with its groups of faces; inner nodes are moved by this part of a cell.
pub(super) fn uneven_box(size: [f64; 3], cells: [usize; 3], part: f64) -> Mesh {
    let mesh = Mesh::cuboid(size, cells).unwrap();
    let mut random = Random::new(7);
    let moved = |p: &[f64; 3]| -> [f64; 3] {
        // Places on the surface have rounding.
        let inside = (0..3).all(|c| p[c] > 0.0 && p[c] < (1.0 - 1e-9) * size[c]);
        let mut one = |c: usize| random.between(-part, part) * size[c] / cells[c] as f64;
        std::array::from_fn(|c| if inside { p[c] + one(c) } else { p[c] })
    };
    let points = mesh.points_in::<3>().iter().map(moved).collect();
    let groups = mesh.face_groups().iter().map(|(name, faces)| {
        let nodes = faces.iter().map(|f| mesh.face_nodes::<3>(*f).map(|n| n.index()));
        (name.clone(), nodes.collect())
    });
    let cells: Vec<[usize; 4]> = mesh.nodes_of::<4>().iter().map(|cell| cell.map(|n| n.index())).collect();
    Mesh::new(points, &cells, &groups.collect(), &ElementGroups::new()).unwrap()
}

/// Two materials.
pub(super) fn laws() -> [Elastic; 2] {
    [Elastic::solid(70.0, 0.3, 2.0).unwrap(), Elastic::solid(20.0, 0.45, 3.0).unwrap()]
}

fn dense(field: &[[f64; 3]]) -> DVector<f64> {
    DVector::from_column_slice(field.as_flattened())
}

fn nodal(field: &DVector<f64>) -> Vec<[f64; 3]> {
    field.as_slice().as_chunks().0.to_vec()
}

/// One motion by its formulas.
struct DenseMotion<'p> {
    problem: &'p Problem<3>,
    matrices: DenseSolid,
    damping: f64,
    displacement: DVector<f64>,
    half_step: DVector<f64>,
}

impl DenseMotion<'_> {
    /// The level n under contact forces (N), and the step to the next one: u, a_c, w and o₂.
    fn advance(
        &mut self,
        dynamics: &Dynamics<'_, 3>,
        times: &TimeGrid,
        n: usize,
        pull: &[[f64; 3]],
    ) -> [Vec<[f64; 3]>; 4] {
        let (problem, m) = (self.problem, &self.matrices);
        let mut force = vec![[0.0; 3]; problem.mesh().node_count()];
        problem.external_forces(times.instants()[n], &mut force);
        for (contact, pull) in problem.surface().nodes().iter().zip(pull) {
            (0..3).for_each(|c| force[contact.node.index()][c] += pull[c]);
        }
        let mut plain = &m.inverse_mass * (dense(&force) - &m.smoothed * &self.displacement);
        for (i, p) in problem.prescribed().iter().enumerate() {
            plain[3 * p.node.index() + p.component] = dynamics.prescribed_acceleration(n, i);
        }
        let [first, second, third] = [4.0 / 3.0, 0.4 + 5.0 / 6.0 * 4.0 / 3.0, 3.5];
        let (once, twice) = (&m.lumping * &plain, &m.lumping * &m.lumping * &plain);
        let thrice = &m.lumping * &twice;
        let consistent = &plain + &once * first + &twice * second - &thrice * third;
        let lumped = &plain * (1.0 - first) + &once * (first - second) + &twice * (second + third) - &thrice * third;
        let square = times.step(n.min(times.step_count() - 1)) * times.step(n.saturating_sub(1));
        let driven =
            &m.stiffness * &plain * (square / 12.0) + (&m.stiffness - &m.smoothed) * &self.half_step * self.damping;
        let acceleration = &consistent - &m.inverse_mass * driven;
        let (displacement, lumped) = (nodal(&self.displacement), nodal(&lumped));
        self.half_step += acceleration * times.velocity_step(n);
        self.displacement += &self.half_step * times.step(n);
        let skew = skew_acceleration::<3, 4>(problem, dynamics.inverse_mass(), &lumped, &displacement);
        [displacement, nodal(&consistent), lumped, skew]
    }
}

/// All fields under random contact forces, supports that are mirrors, one of them moving, loads and two materials;
/// steps become longer and shorter.
#[test]
fn fields_are_those_of_the_formulas() {
    let mesh = uneven_box([1.0, 0.8, 0.7], [2, 2, 3], 0.3);
    let problem = loaded::<3, 4>(&mesh, laws(), ["left", "top", "right"]);
    let times = uneven(&problem, 20);
    let (dynamics, count) = (Dynamics::new(&problem, &times), problem.mesh().node_count());
    let mut motion = SolidAuxiliary::<3, 4>::new(&problem, &times, Arc::new(Smoothing::new(&problem)), Shares::ALL);
    motion.prepare(&elements(&problem));
    let mut plain = DenseMotion {
        problem: &problem,
        matrices: DenseSolid::new(&problem, &[(0, 0.0), (2, 0.7)]),
        damping: DAMPING * element_time_step(&problem),
        displacement: dense(problem.initial_displacement()),
        half_step: dense(problem.initial_velocity()),
    };
    assert_eq!(motion.damping, plain.damping);
    let mut random = Random::new(5);
    for n in 0..=times.step_count() {
        let mut pull = random_field::<3>(problem.surface().nodes().len(), 0.1, &mut random);
        for (contact, pull) in problem.surface().nodes().iter().zip(&mut pull) {
            let held = problem.prescribed().iter().filter(|held| held.node == contact.node);
            held.for_each(|held| pull[held.component] = 0.0);
        }
        let [mut displacement, mut acceleration, mut lumped, mut skew] = [0; 4].map(|_| vec![[0.0; 3]; count]);
        let level = AuxiliaryLevel {
            displacement: &mut displacement,
            acceleration: &mut acceleration,
            split: Some(SplitLevel { lumped: &mut lumped, skew: &mut skew }),
        };
        let still = vec![[0.0; 3]; count];
        motion.begin(n);
        let simulated = SimulatedLevel { velocity: &still, strain: 0.0, reaction: &pull };
        motion.advance(&dynamics, n, &simulated, &pull, level);
        let expected = plain.advance(&dynamics, &times, n, &pull);
        let found = [displacement, acceleration, lumped, skew];
        // Rounding of some hundred terms grows with the steps.
        found.iter().zip(&expected).for_each(|(f, e)| assert!(miss(f, e) < 1e-11, "{n}: {}", miss(f, e)));
    }
}
