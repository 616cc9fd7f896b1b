//! The normal contact law of non-matching interfaces.
//!
//! It is measured on the partition of an instant, with the admissible motion of both surfaces. Half of each piece
//! counts in each of its elements.

use crate::contact_density::{LevelDensities, NonMatchingDensity, NonMatchingFaces, NormalMisfit, SlaveHat};
use crate::direction::along;
use crate::kinematic::{ContactMotions, NonMatchingInstant, NormalMotions};
use crate::partition::{Break, pieces};
use crate::scratch_file::{ScratchError, ScratchFile};
use percute_core::cell::face_mean;
use percute_core::contact::{Coupling, NonMatchingSurfaces};
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use std::sync::Arc;

/// The misfits of all non-matching interfaces, at the instants at hand.
#[derive(Debug)]
pub(crate) struct NonMatchingMisfit {
    faces: Vec<NonMatchingFaces>,
    /// The normal densities of the nodes of each slave at each step, of F_DA and of the reactions: see [`numbers`].
    pressures: Vec<NormalMotions>,
    /// The first half-step instant at hand, and ∫F_n gap (J) and ∫F_n|ẋ| (W) from there on, for each candidate face.
    first: usize,
    shown: Vec<Vec<[f64; 2]>>,
}

impl NonMatchingMisfit {
    pub(super) fn new<const D: usize>(problem: &Problem<D>, span: usize) -> Self {
        let store = |non_matching: &NonMatchingSurfaces<D>| {
            NormalMotions::new(NUMBERS * non_matching.slave().len(), span, ScratchFile::default())
        };
        Self {
            faces: NonMatchingFaces::all(problem),
            pressures: problem.surface().non_matching().iter().map(store).collect(),
            first: 0,
            shown: Vec::new(),
        }
    }

    /// Takes in the densities of a step.
    pub(super) fn push<const D: usize>(
        &mut self,
        problem: &Problem<D>,
        step: usize,
        densities: &LevelDensities<D>,
    ) -> Result<(), ScratchError> {
        for (k, non_matching) in problem.surface().non_matching().iter().enumerate() {
            self.pressures[k].extend()?;
            let both = [&densities.acting, &densities.sudden]
                .map(|density| numbers(&density.non_matching()[k].component(non_matching.frame().normal())));
            for (place, pair) in both[0].iter().zip(&both[1]).map(|(a, b)| [*a, *b]).enumerate() {
                self.pressures[k].write(place, step, &[pair])?;
            }
        }
        Ok(())
    }

    /// Has the misfits at hand from one half-step instant to another; the tracks have the motion.
    pub(super) fn show<const D: usize>(
        &mut self,
        problem: &Problem<D>,
        tracks: &mut ContactMotions,
        [first, last]: [usize; 2],
    ) -> Result<(), ScratchError> {
        if self.faces.is_empty() {
            return Ok(());
        }
        self.first = first;
        self.shown = vec![vec![[0.0; 2]; problem.surface().faces().len()]; last + 1 - first];
        for (index, non_matching) in problem.surface().non_matching().iter().enumerate() {
            let instants = tracks.non_matching(problem, index, first..last + 1)?;
            let steps = first / 2..last.div_ceil(2) + 1;
            let mut pressures = Vec::with_capacity(NUMBERS * non_matching.slave().len());
            for place in 0..NUMBERS * non_matching.slave().len() {
                let mut pairs = Vec::with_capacity(steps.len());
                self.pressures[index].read(place, steps.clone(), &mut pairs)?;
                pressures.push(pairs);
            }
            for (at, (instant, shown)) in instants.iter().zip(&mut self.shown).enumerate() {
                // Forces are linear in time over a step.
                let ends = [(first + at) / 2, (first + at).div_ceil(2)].map(|step| step - steps.start);
                let coupling = Arc::new(non_matching.coupling_at(&instant.shifts));
                let densities = [0, 1].map(|which| {
                    let [a, b] = ends.map(|end| density(non_matching, &coupling, |place| pressures[place][end][which]));
                    if ends[0] == ends[1] { a } else { NonMatchingDensity::mean(&a, &b, &coupling) }
                });
                measure(non_matching, &self.faces[index], (&coupling, instant), &densities, shown);
            }
        }
        Ok(())
    }

    /// The misfit on a candidate face over the interval between two steps, with this weight of the work.
    pub(super) fn over(&self, face: usize, steps: [usize; 2], times: &TimeGrid, weight: f64) -> NormalMisfit {
        let mut misfit = NormalMisfit::default();
        if self.shown.is_empty() {
            return misfit;
        }
        let at = |instant: usize| self.shown[instant - self.first][face];
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

/// Numbers of a node: its multiplier, and for the hats on the edges before and after it a resultant and halvings.
const NUMBERS: usize = 5;

/// The numbers of all nodes of a slave.
fn numbers(density: &NonMatchingDensity<1>) -> Vec<f64> {
    let mut numbers: Vec<f64> = density.multipliers().iter().flat_map(|[value]| [*value, 0.0, 0.0, 0.0, 0.0]).collect();
    for hat in density.hats() {
        let place = NUMBERS * hat.node + 3 - 2 * hat.end;
        numbers[place] = hat.resultant[0];
        numbers[place + 1] = hat.halvings as f64;
    }
    numbers
}

/// The density that such numbers are of.
fn density<const D: usize>(
    non_matching: &NonMatchingSurfaces<D>,
    coupling: &Arc<Coupling>,
    number: impl Fn(usize) -> f64,
) -> NonMatchingDensity<1> {
    let slave = non_matching.slave();
    let mut hats = Vec::new();
    for (node, end) in (0..slave.len()).flat_map(|node| [(node, 1), (node, 0)]) {
        let place = NUMBERS * node + 3 - 2 * end;
        let resultant = number(place);
        if resultant != 0.0 {
            hats.extend(SlaveHat::new(slave, (node, end), number(place + 1) as usize, [resultant]));
        }
    }
    NonMatchingDensity::with_multipliers(coupling, |node| [number(NUMBERS * node)], hats)
}

/// Adds ∫F_n gap and ∫F_n|ẋ| at an instant, of the densities of F_DA and of the reactions.
fn measure<const D: usize>(
    non_matching: &NonMatchingSurfaces<D>,
    faces: &NonMatchingFaces,
    (coupling, instant): (&Coupling, &NonMatchingInstant),
    densities: &[NonMatchingDensity<1>; 2],
    sums: &mut [[f64; 2]],
) {
    if densities.iter().all(NonMatchingDensity::is_zero) {
        return;
    }
    let breaks: Vec<Break> = densities.iter().flat_map(NonMatchingDensity::breaks).collect();
    for piece in pieces(non_matching, coupling).flat_map(|piece| piece.cut(&breaks)) {
        let [acting, sudden] = densities.each_ref().map(|density| density.on(&piece).map(|[value]| value));
        let [slave, master] =
            [piece.slave_values(|node| instant.eta[0][node]), piece.master_values(|node| instant.eta[1][node])];
        let energy = piece.product(acting, [0, 1].map(|end| (slave[end] - master[end]).max(0.0)));
        let at_ends = |values: [f64; 2]| -> [f64; D] { std::array::from_fn(|end| values[end]) };
        let [own, other] = &instant.speed;
        let [own, other] = [piece.slave_values(|node| own[node]), piece.master_values(|node| other[node])];
        let (force, speed) = (at_ends(sudden), at_ends([0, 1].map(|end| own[end] + other[end])));
        let power = |weights: &[f64; D]| along(weights, &force) * along(weights, &speed).abs();
        let power = piece.length * face_mean(&speed, power);
        for face in faces.of(&piece) {
            sums[face][0] += 0.5 * energy;
            sums[face][1] += 0.5 * power;
        }
    }
}
