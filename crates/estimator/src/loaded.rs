//! The faces that carry prescribed tractions.

use percute_core::ids::FaceId;
use percute_core::problem::Problem;
use std::collections::BTreeMap;

/// All faces with a load, each once, in ascending order.
#[derive(Debug)]
pub(crate) struct LoadedFaces<'p, const D: usize> {
    problem: &'p Problem<D>,
    faces: Vec<FaceId>,
}

impl<'p, const D: usize> LoadedFaces<'p, D> {
    pub(crate) fn new(problem: &'p Problem<D>) -> Self {
        let mut faces: Vec<FaceId> = problem.face_loads().iter().map(|l| l.face).collect();
        faces.sort_unstable();
        faces.dedup();
        Self { problem, faces }
    }

    pub(crate) fn faces(&self) -> &[FaceId] {
        &self.faces
    }

    /// Moments of the tractions on them at an instant (N).
    pub(crate) fn moments(&self, t: f64) -> Vec<[[f64; D]; D]> {
        let mut sums: BTreeMap<FaceId, [[f64; D]; D]> = self.faces.iter().map(|&f| (f, [[0.0; D]; D])).collect();
        for load in self.problem.face_loads() {
            let area = self.problem.face_area(load.face);
            let moments = Problem::<D>::face_moments(area, &self.problem.face_traction_at(load, t));
            if let Some(sum) = sums.get_mut(&load.face) {
                (0..D).for_each(|i| (0..D).for_each(|c| sum[i][c] += moments[i][c]));
            }
        }
        sums.into_values().collect()
    }
}
