//! By how much a density that may act off contact misses the normal contact law.
//!
//! Exactly, a normal force F_n acts at gap 0 and on no normal motion. Where it does not, the energy ∫F_n gap is
//! the misfit of the law at displacement level, finite, and zero if and only if the complementarity holds;
//! and ∫∫F_n|w_n| dt is the work that it took from the motion or gave to it, which the exact force never
//! does: it adds up, as the waves that it should have made are missing from then on. That is the work of the simulation's own
//! reactions: what stops a node within a step takes its energy, even where F_DA spreads the impulse over a time in which
//! the node rests.

use crate::kinematic::ContactTrack;
use crate::reconstruction::{Pressure, gap_energy, normal_power};
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;

/// Normal pressures on one candidate facet at the beginning and the end of each step of an interval between samples.
#[derive(Clone, Debug)]
pub(crate) struct FacetPressures<const D: usize> {
    /// Position among the candidate facets.
    pub(crate) facet: usize,
    /// First step of the interval.
    pub(crate) first: usize,
    pub(crate) steps: Vec<[Pressure<D>; 2]>,
}

/// Energies of an interval (J): at its beginning, middle and end.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NormalMisfit {
    /// ∫F_n gap.
    pub(crate) energy: [f64; 3],
    /// ∫∫F_n|w_n| dt since its beginning; the middle is that of its first step.
    pub(crate) work: [f64; 3],
}

impl NormalMisfit {
    /// Adds another facet's.
    pub(crate) fn add(&mut self, other: &Self) {
        for k in 0..3 {
            self.energy[k] += other.energy[k];
            self.work[k] += other.work[k];
        }
    }
}

impl<const D: usize> FacetPressures<D> {
    /// The misfit over the interval, for the motion in the tracks; work by the trapezoidal rule over all knots.
    pub(crate) fn misfit<const N: usize>(
        &self,
        problem: &Problem<D, N>,
        times: &TimeGrid,
        tracks: &[ContactTrack],
    ) -> NormalMisfit {
        let facet = &problem.surface().facets()[self.facet];
        let mut misfit = NormalMisfit::default();
        for (k, [start, end]) in self.steps.iter().enumerate() {
            let knot = 2 * (self.first + k);
            let middle = Pressure::middle(start, end);
            let at = |half: usize, pressure: &Pressure<D>| {
                let motion = facet.nodes.map(|at| tracks[at].at(knot + half));
                let energy = gap_energy(facet.area, &pressure.acting, &motion.map(|(_, gap)| gap.max(0.0)));
                let speed = motion.map(|(speed, _)| speed);
                (energy, normal_power(problem.mesh().simplex(), facet.area, &pressure.sudden, &speed))
            };
            let [(before, p0), (between, p1), (after, p2)] = [at(0, start), at(1, &middle), at(2, end)];
            let half = 0.5 * times.step(self.first + k);
            if k == 0 {
                misfit.energy[0] = before;
                misfit.energy[1] = between;
                misfit.work[1] = 0.5 * half * (p0 + p1);
            }
            misfit.energy[2] = after;
            misfit.work[2] += 0.5 * half * (p0 + 2.0 * p1 + p2);
        }
        misfit
    }
}
