//! The residuals of densities: Coulomb's cone and the contact zone.

use super::{StepDensities, SurfaceSteps};
use crate::residual::{Residuals, worse};
use percute_core::problem::Problem;

/// Checks that the densities of a step are in the cone and, unless they may act `off_contact`, act only where both
/// nodes of a face touch throughout the step.
pub(crate) fn check<const D: usize>(
    problem: &Problem<D>,
    steps: &SurfaceSteps<'_, D>,
    densities: &StepDensities<D>,
    off_contact: bool,
    residuals: &mut Residuals,
) {
    for densities in [&densities.start, &densities.end] {
        residuals.hat_shares = worse(residuals.hat_shares, densities.shares());
        let [cone, opposite] = densities.non_matching_residuals(problem);
        residuals.cone = worse(residuals.cone, cone);
        residuals.opposite_forces = worse(residuals.opposite_forces, opposite);
        let size = |f: &[f64; D]| f.iter().map(|x| x * x).sum::<f64>().sqrt();
        let largest = densities.iter().flatten().map(size).fold(0.0, worse);
        if largest == 0.0 {
            continue;
        }
        for (face, density) in problem.surface().faces().iter().zip(densities.wide()) {
            let obstacle = &problem.obstacles()[face.obstacle];
            let touches = face.nodes.iter().all(|&k| steps.now.touching[k] && steps.next.touching[k]);
            for f in density.iter().filter(|f| **f != [0.0; D]) {
                let scale = size(f).max(1e-12 * largest);
                let [tangential, normal] = obstacle.law().excess(&obstacle.flat_frame(), f);
                let outside = worse(tangential, normal);
                residuals.cone = worse(residuals.cone, outside / scale);
                let off = if touches || off_contact { 0.0 } else { size(f) / scale };
                residuals.force_off_contact = worse(residuals.force_off_contact, off);
            }
        }
        // The shares of hats are between 0 and 1: each is in the cone if the force of its node is.
        let largest = densities.hats().iter().map(|hat| size(&hat.resultant)).fold(0.0, worse);
        for hat in densities.hats() {
            let obstacle = &problem.obstacles()[problem.surface().faces()[hat.face].obstacle];
            let [tangential, normal] = obstacle.law().excess(&obstacle.flat_frame(), &hat.resultant);
            let outside = worse(tangential, normal);
            let scale = size(&hat.resultant).max(1e-12 * largest).max(f64::MIN_POSITIVE);
            residuals.hat_cone = worse(residuals.hat_cone, outside / scale);
        }
    }
}
