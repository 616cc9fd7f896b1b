//! Whether the corrected scheme is stable at the longest step of a run.
//!
//! At 0.9 Δt_c it is, with a margin of 2 %, on all meshes that were tried: slivers, elements a hundred times as long as
//! wide, ν up to 0.4999, materials of unlike wave speeds. Closer to the critical step, some of these let the shortest
//! waves grow. The corrections of the mass are then weakened: without them the scheme is as stable as the simulation,
//! for smoothed strains only soften the body.

use super::parts::{Part, View, for_all};
use super::pass::{PartPass, Pass};
use super::{AuxiliaryLevel, AuxiliarySolutions, MotionFields, Nodal, start_of};
use percute_core::dynamics::{critical_time_step, element_time_step, rough_field};
use percute_core::simd::run_task;

/// Up to this part of the critical step the scheme is stable. 1e-3 is the precision of the critical step.
const SAFE: f64 = 0.9 + 1e-3;
/// The longest step is tried with a margin: a mode that is just stable in it grows less than rounding shows in a run.
const MARGIN: f64 = 1.01;
/// Steps that are tried. A mode beyond the limit by a relative δ of its frequency grows by 1 + 2√(2δ) in each: where
/// the run itself would be unstable, by more than 1e6 in all, with the margin.
const STEPS: usize = 64;
/// Growth of displacements from which on the scheme is unstable. Rough displacements at rest never grow where it is
/// stable, but for the few modes within 1e-3 of the limit.
const GROWTH: f64 = 8.0;
/// The corrections are weakened by this part at a time.
const PART: f64 = 0.05;

impl<const D: usize, const N: usize> AuxiliarySolutions<'_, D, N> {
    /// Weakens the corrections of the mass until the scheme is stable.
    pub(super) fn stabilise(&mut self) {
        let longest = self.times.longest_step();
        if !self.smoothing.smooths()
            || longest <= SAFE * element_time_step(self.problem)
            || longest <= SAFE * critical_time_step(self.problem)
        {
            return;
        }
        let mut share = 1.0;
        while share > 0.0 && !self.is_stable(MARGIN * longest) {
            share = f64::max(share - PART, 0.0);
            self.weights.weaken(&self.smoothing, share);
        }
    }

    /// Whether rough displacements stay as large as they are in steps of this length (s).
    fn is_stable(&self, step: f64) -> bool {
        let count = self.problem.mesh().node_count();
        let mut fields = MotionFields::new(self.problem, &self.smoothing, self.fields.gradients.len());
        for (u, rough) in fields.displacement.iter_mut().zip(rough_field(self.problem)) {
            *u = Nodal::new([rough, [0.0; D], [0.0; D], [0.0; D]]);
        }
        fields.half_step.fill(Nodal::ZERO);
        let inverse_mass: Vec<f64> = self.problem.mass().iter().map(|m| 1.0 / m).collect();
        let [simulated, mut displacement, mut acceleration] = [0; 3].map(|_| vec![[0.0; D]; count]);
        let weights = self.weights.of_steps([step * step; 2]);
        let mut pass = Pass { simulated: &simulated, inverse_mass: &inverse_mass, weights, ..self.free_pass() };
        let start = |part: &Part| start_of(part, &self.pairs, &self.smoothing);
        let mut largest = [0.0_f64; STEPS];
        for (k, largest) in largest.iter_mut().enumerate() {
            pass.due = if k == 0 { 0.0 } else { step };
            pass.forward = if k == 0 { 0.5 * step } else { step };
            let level =
                AuxiliaryLevel { displacement: &mut displacement, acceleration: &mut acceleration, split: None };
            let work = |part: &Part, view: View<'_, D>| run_task(PartPass { pass: &pass, part, view });
            for_all((&self.plan, &start), View::new(&mut fields, level), &work);
            *largest = displacement.as_flattened().iter().fold(0.0, |m, x| m.max(x.abs()));
        }
        let (first, last) = largest.split_at(STEPS / 2);
        let over = |part: &[f64]| part.iter().copied().fold(0.0, f64::max);
        over(last) <= GROWTH * over(first)
    }
}
