//! The normal contact law of surfaces that slide along each other.
//!
//! It is measured on the partition of an instant, with the admissible motion of both surfaces. Half of each piece
//! counts in each of its elements.

use crate::contact_density::{LevelDensities, NormalMisfit, SlidingFacets, density_on};
use crate::direction::along;
use crate::kinematic::{ContactTracks, NormalMotions, SlidingInstant};
use crate::partition::pieces;
use crate::scratch_file::{ScratchError, ScratchFile};
use percute_core::contact::SlidingSurfaces;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;

/// The misfits of all surfaces that slide, at the instants at hand.
#[derive(Debug)]
pub(crate) struct SlidingMisfit {
    facets: Vec<SlidingFacets>,
    /// Normal multipliers of F_DA, and those of the reactions (N/m), of the nodes of each slave at each step.
    pressures: Vec<NormalMotions>,
    /// The first half-step instant at hand, and ∫F_n gap (J) and ∫F_n|ẋ| (W) from there on, for each candidate facet.
    first: usize,
    shown: Vec<Vec<[f64; 2]>>,
}

impl SlidingMisfit {
    pub(super) fn new<const D: usize, const N: usize>(problem: &Problem<D, N>, span: usize) -> Self {
        let store =
            |sliding: &SlidingSurfaces<D>| NormalMotions::new(sliding.slave().len(), span, ScratchFile::default());
        Self {
            facets: SlidingFacets::all(problem),
            pressures: problem.surface().sliding().iter().map(store).collect(),
            first: 0,
            shown: Vec::new(),
        }
    }

    /// Takes in the densities of a step.
    pub(super) fn push<const D: usize, const N: usize>(
        &mut self,
        problem: &Problem<D, N>,
        step: usize,
        densities: &LevelDensities<D>,
    ) -> Result<(), ScratchError> {
        for (k, sliding) in problem.surface().sliding().iter().enumerate() {
            self.pressures[k].extend()?;
            let both = [&densities.acting, &densities.sudden].map(|density| density.sliding()[k].multipliers());
            for node in 0..sliding.slave().len() {
                let pair = both.map(|multipliers| along(&multipliers[node], sliding.frame().normal()));
                self.pressures[k].write(node, step, &[pair])?;
            }
        }
        Ok(())
    }

    /// Has the misfits at hand from one half-step instant to another; the tracks have the motion.
    pub(super) fn show<const D: usize, const N: usize>(
        &mut self,
        problem: &Problem<D, N>,
        tracks: &mut ContactTracks,
        [first, last]: [usize; 2],
    ) -> Result<(), ScratchError> {
        if self.facets.is_empty() {
            return Ok(());
        }
        self.first = first;
        self.shown = vec![vec![[0.0; 2]; problem.surface().facets().len()]; last + 1 - first];
        for (index, sliding) in problem.surface().sliding().iter().enumerate() {
            let instants = tracks.sliding(problem, index, first..last + 1)?;
            let steps = first / 2..last.div_ceil(2) + 1;
            let mut pressures = Vec::with_capacity(sliding.slave().len());
            for node in 0..sliding.slave().len() {
                let mut pairs = Vec::with_capacity(steps.len());
                self.pressures[index].read(node, steps.clone(), &mut pairs)?;
                pressures.push(pairs);
            }
            for (at, (instant, shown)) in instants.iter().zip(&mut self.shown).enumerate() {
                // Forces are linear in time over a step.
                let ends = [(first + at) / 2, (first + at).div_ceil(2)].map(|step| step - steps.start);
                let pressure = |node: usize, which: usize| {
                    0.5 * (pressures[node][ends[0]][which] + pressures[node][ends[1]][which])
                };
                measure((problem, sliding), &self.facets[index], instant, &pressure, shown);
            }
        }
        Ok(())
    }

    /// The misfit on a candidate facet over the interval between two steps, with this weight of the work.
    pub(super) fn over(&self, facet: usize, steps: [usize; 2], times: &TimeGrid, weight: f64) -> NormalMisfit {
        let mut misfit = NormalMisfit::default();
        if self.shown.is_empty() {
            return misfit;
        }
        let at = |instant: usize| self.shown[instant - self.first][facet];
        for step in steps[0]..steps[1] {
            let [p0, p1, p2] = [0, 1, 2].map(|k| at(2 * step + k)[1]);
            let half = 0.5 * weight * times.step(step);
            if step == steps[0] {
                misfit.work[1] = 0.5 * half * (p0 + p1);
            }
            misfit.work[2] += 0.5 * half * (p0 + 2.0 * p1 + p2);
        }
        misfit.energy = [2 * steps[0], 2 * steps[0] + 1, 2 * steps[1]].map(|instant| at(instant)[0]);
        misfit
    }
}

/// Adds ∫F_n gap and ∫F_n|ẋ| at an instant; `pressure` gives the multiplier of a node of the slave, of F_DA or of the
/// reactions (N/m).
fn measure<const D: usize, const N: usize>(
    (problem, sliding): (&Problem<D, N>, &SlidingSurfaces<D>),
    facets: &SlidingFacets,
    instant: &SlidingInstant,
    pressure: &impl Fn(usize, usize) -> f64,
    sums: &mut [[f64; 2]],
) {
    let coupling = sliding.coupling_at(&instant.shifts);
    let acts = |node: usize, which: usize| if coupling.is_active(node) { pressure(node, which) } else { 0.0 };
    if (0..coupling.len()).all(|node| acts(node, 0) == 0.0 && acts(node, 1) == 0.0) {
        return;
    }
    for piece in pieces(sliding, &coupling) {
        let [acting, sudden] = [0, 1].map(|which| density_on(&coupling, &piece, |node| acts(node, which)));
        let [slave, master] =
            [piece.slave_values(|node| instant.eta[0][node]), piece.master_values(|node| instant.eta[1][node])];
        let energy = piece.product(acting, [0, 1].map(|end| (slave[end] - master[end]).max(0.0)));
        let at_ends = |values: [f64; 2]| -> [f64; D] { std::array::from_fn(|end| values[end]) };
        let [own, other] = &instant.speed;
        let [own, other] = [piece.slave_values(|node| own[node]), piece.master_values(|node| other[node])];
        let (force, speed) = (at_ends(sudden), at_ends([0, 1].map(|end| own[end] + other[end])));
        let power = |weights: &[f64; D]| along(weights, &force) * along(weights, &speed).abs();
        let power = piece.length * problem.mesh().simplex().facet_mean(&speed, &power);
        for facet in facets.of(&piece) {
            sums[facet][0] += 0.5 * energy;
            sums[facet][1] += 0.5 * power;
        }
    }
}
