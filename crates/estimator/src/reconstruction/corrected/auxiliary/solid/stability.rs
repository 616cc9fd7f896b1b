//! Whether the corrected scheme of a solid is stable at the longest step of a run.
//!
//! At 0.9 Δt_c it is on most meshes. Those of few nodes that are almost incompressible, and some at the critical step,
//! let the shortest waves grow. The corrections of the mass and the damping are then weakened together: without them
//! the scheme is as stable as the simulation. The steps of a trial cost as much as the tractions of one level, so that
//! each run has one.

use super::SolidAuxiliary;
use super::motion::SolidMotion;
use percute_core::dynamics::rough_field;
use percute_core::time::TimeGrid;

/// The longest step is tried with a margin: a mode that is just stable in it grows less than rounding shows in a run.
const MARGIN: f64 = 1.01;
/// Steps that are tried.
const STEPS: usize = 64;
/// Growth of displacements, from the first half of the steps to the second one, from which on the scheme is unstable.
const GROWTH: f64 = 8.0;
/// The corrections are weakened by this part at a time.
const PART: f64 = 0.05;

impl<const D: usize, const N: usize> SolidAuxiliary<'_, D, N> {
    /// Weakens the corrections of the mass and the damping until the scheme is stable.
    pub(super) fn stabilise(&mut self) {
        let (whole, mut share) = (self.damping, 1.0);
        while self.smooths() && share > 0.0 && !self.is_stable() {
            share = f64::max(share - PART, 0.0);
            self.weights.weaken(&self.operator.smoothing, share);
            self.damping = share * whole;
        }
    }

    /// Whether rough displacements stay as large as they are in steps that are longer than any of the run.
    fn is_stable(&self) -> bool {
        let rough = rough_field(self.problem);
        let end = MARGIN * self.times.longest_step() * STEPS as f64;
        let Ok(times) = TimeGrid::uniform(end, STEPS) else { return true };
        let rest = vec![[0.0; D]; rough.len()];
        let mut motion = SolidMotion::<D, N>::new(&rough, &rest);
        let mut largest = [0.0_f64; STEPS];
        for (n, largest) in largest.iter_mut().enumerate() {
            let weights = self.correction(&times, n);
            motion.respond(&self.operator, &weights, &rest);
            motion.correct(&self.operator, &weights, false);
            motion.advance(&self.operator, &weights, (&times, n));
            *largest = motion.displacement.as_flattened().iter().fold(0.0, |m, x| m.max(x.abs()));
        }
        let (first, last) = largest.split_at(STEPS / 2);
        let over = |part: &[f64]| part.iter().copied().fold(0.0, f64::max);
        over(last) <= GROWTH * over(first)
    }
}
