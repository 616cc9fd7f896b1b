//! Solids of tetrahedra against exact solutions.

mod column;
mod exact;
mod impacts;
mod vibration;

use exact::{Exact, true_error};
use percute_core::dynamics::{critical_time_step, simulate};
use percute_core::ids::NodeId;
use percute_core::mesh::{ElementGroups, FaceGroups, Mesh};
use percute_core::observer::Unobserved;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use percute_estimator::reference::Motion;
use percute_estimator::{Estimate, Estimator, Options, Sampling};
use percute_testkit::Random;

/// A box whose inner nodes are moved at random, by up to so much of a cell, and those of its sides along them.
pub(crate) fn random_box(size: [f64; 3], cells: [usize; 3], part: f64, seed: u64) -> Mesh {
    let (mesh, mut random) = (Mesh::cuboid(size, cells).unwrap(), Random::new(seed));
    let points = mesh.points_in::<3>().iter().map(|point| {
        std::array::from_fn(|c| {
            let inside = point[c] > 1e-9 * size[c] && point[c] < (1.0 - 1e-9) * size[c];
            let by = random.between(-part, part) * size[c] / cells[c] as f64;
            if inside { point[c] + by } else { point[c] }
        })
    });
    let cells: Vec<_> = mesh.nodes_of::<4>().iter().map(|cell| cell.map(NodeId::index)).collect();
    let groups: FaceGroups<3> = mesh
        .face_groups()
        .iter()
        .map(|(name, faces)| {
            (name.clone(), faces.iter().map(|f| mesh.face_nodes::<3>(*f).map(NodeId::index)).collect())
        })
        .collect();
    Mesh::new(points.collect(), &cells, &groups, &ElementGroups::new()).unwrap()
}

/// An estimate and the true error (J^½), largest and mean.
struct Run {
    estimate: Estimate,
    largest: f64,
    mean: f64,
}

impl Run {
    /// Simulates, estimates every some steps and compares with the exact fields at the same instants.
    fn new(problem: &Problem<3>, (end, courant): (f64, f64), samples: usize, exact: &Exact<'_>) -> Self {
        let times = TimeGrid::with_step(end, courant * critical_time_step(problem)).unwrap();
        let every = (times.step_count() / samples).max(1);
        let options = Options { every: Sampling::Every(every), ..Options::default() };
        let mut sink = (Motion::default(), Estimator::new(problem, &times, options).unwrap());
        simulate(problem, &times, &mut sink, &mut Unobserved).unwrap();
        let (motion, estimator) = sink;
        let estimate = estimator.finish().unwrap();
        let [largest, mean] = true_error(problem, &motion, every, exact);
        Self { estimate, largest, mean }
    }

    /// Estimate over true error, largest and mean.
    fn effectivity(&self) -> [f64; 2] {
        [self.estimate.error.sup / self.largest, self.estimate.error.mean / self.mean]
    }
}
