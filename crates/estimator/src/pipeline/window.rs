//! The parallel part: stress, tractions and errors of all elements over a window of levels.
//!
//! Nothing here depends on the number of threads or on where windows end: every number is computed
//! by one task from its own data, and sums are taken over fixed blocks of elements in order.

use super::far::{self, FarCourse, FarSums};
use super::maps::{Balance, Maps};
use super::near::{ContactSampling, NearElement, near_elements};
use super::prepare::Preparation;
use super::sampled_levels::SampledLevels;
use super::sampling::Sampling;
use super::totals::{self, Worked};
use crate::element::Element;
use crate::estimate::{Estimate, Sample};
use crate::lanes::{LANES, Lanes};
use crate::measure::ElementError;
use crate::options::{Acceleration, Options};
use crate::reconstruction;
use crate::residual::{Residuals, worse};
use crate::time_level::ForcesKnown;
use crate::traction::{EquilibratedLevels, Equilibration, KeptLevel};
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use rayon::ThreadPool;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Levels in preparation and the one that is kept for the next window.
const OTHER_LEVELS: usize = 4;

/// Memory of one level (bytes).
fn bytes_of_level<const D: usize, const N: usize>(problem: &Problem<D, N>, options: &Options) -> usize {
    let fields = if options.acceleration(D) == Acceleration::Mixed { 11 } else { 8 };
    size_of::<[f64; D]>() * fields * problem.mesh().node_count()
}

/// Number of levels worked on at once.
fn size(options: &Options) -> usize {
    options.window.map_or(LANES, |window| window.min(LANES))
}

/// About how much memory (bytes) an estimate takes beside its problem: its levels and the data that it keeps of
/// each element and sample. The queues of elements around contact nodes are not foreseen.
#[must_use]
pub fn memory<const D: usize, const N: usize>(problem: &Problem<D, N>, times: &TimeGrid, options: &Options) -> usize {
    let levels = size(options).min(times.step_count()).saturating_add(OTHER_LEVELS);
    // Its places in the blocks of elements and stars are three for each node of it.
    let element = size_of::<Element<D, N>>() + 3 * N * size_of::<u32>() + size_of::<FarCourse<D, N>>();
    // Moments of a window.
    let link = size_of::<[Lanes; D]>();
    // At the level and half way to the next.
    let step = 2 * (size_of::<Sample>() + size_of::<ElementError>());
    let spacing = options.every.spacing(problem.mesh().element_count(), times.step_count());
    let steps = times.step_count() / spacing + 1;
    levels
        .saturating_mul(bytes_of_level(problem, options))
        .saturating_add(reconstruction::new(problem, times, options).memory())
        .saturating_add(element.saturating_mul(problem.mesh().element_count()))
        .saturating_add(link.saturating_mul(problem.mesh().stars().link_count()))
        .saturating_add(step.saturating_mul(steps))
}

/// Levels in work, and the sums so far.
#[derive(Debug)]
pub(crate) struct LevelWindow<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D, N>,
    times: &'p TimeGrid,
    pub(super) equilibration: Equilibration<'p, D, N>,
    choice: Acceleration,
    /// Number of intervals worked on at once.
    size: usize,
    /// The last level of the window before.
    carried: Option<KeptLevel<D>>,
    levels: Vec<ForcesKnown<D>>,
    /// Memory of the levels at work.
    equilibrated: EquilibratedLevels<D>,
    near: Vec<NearElement<D, N>>,
    is_near: Vec<bool>,
    /// The links by which the stars of their nodes enter and leave them, in order.
    near_links: Arc<[u32]>,
    far: FarSums,
    /// Far elements so far.
    courses: Vec<FarCourse<D, N>>,
    pub(super) maps: Maps<D>,
    residuals: Residuals,
}

impl<'p, const D: usize, const N: usize> LevelWindow<'p, D, N> {
    pub(super) fn new(problem: &'p Problem<D, N>, times: &'p TimeGrid, options: &Options, maps: Maps<D>) -> Self {
        let near = near_elements(problem);
        let mut is_near = vec![false; problem.mesh().element_count()];
        near.iter().for_each(|n| is_near[n.element.index()] = true);
        let equilibration = Equilibration::new(problem);
        let links = near.iter().flat_map(|n| equilibration.elements[n.element.index()].links);
        let near_links: BTreeSet<u32> = links.flat_map(|link| [link, link + 1]).collect();
        Self {
            problem,
            times,
            equilibration,
            near_links: near_links.into_iter().collect(),
            choice: options.acceleration(D),
            size: size(options),
            carried: None,
            levels: Vec::new(),
            equilibrated: EquilibratedLevels::default(),
            near,
            is_near,
            far: FarSums::default(),
            courses: vec![FarCourse::default(); problem.mesh().element_count()],
            maps,
            residuals: Residuals::default(),
        }
    }

    /// Takes in a level; works when the window is full.
    pub(super) fn push(&mut self, pool: &ThreadPool, level: ForcesKnown<D>, preparation: &Preparation<'p, D, N>) {
        self.levels.push(level);
        if self.levels.len() >= self.size {
            pool.install(|| self.work(preparation));
        }
    }

    /// Works on the levels that are left and sums up.
    pub(super) fn finish(mut self, pool: &ThreadPool, preparation: &Preparation<'p, D, N>) -> Estimate<D> {
        pool.install(|| self.work(preparation));
        self.near.iter().for_each(|near| self.maps.put(&near.kept));
        let Self { problem, times, far, near, courses, residuals, .. } = self;
        let maps = self.maps.finish(problem, &self.equilibration.elements, preparation.tracks());
        let integrals = courses.iter().map(|course| course.course.integral).collect();
        totals::estimate(problem, times, preparation, Worked { far, near, integrals, residuals, maps })
    }

    /// Works on the levels of the window and keeps the last for the next one.
    fn work(&mut self, preparation: &Preparation<'p, D, N>) {
        if self.levels.is_empty() {
            return;
        }
        let mut levels = std::mem::take(&mut self.equilibrated);
        let miss = self.equilibration.solve(std::mem::take(&mut self.levels), &mut levels);
        self.residuals.star_compatibility = worse(self.residuals.star_compatibility, miss);
        preparation.reconstruction().improve(&self.equilibration, self.choice, &mut levels);
        self.sample(preparation, &levels);
        self.carried = levels.keep_last(&self.near_links);
        self.equilibrated = levels;
    }

    /// Samples all elements at some levels.
    fn sample(&mut self, preparation: &Preparation<'p, D, N>, levels: &EquilibratedLevels<D>) {
        let (problem, times, equilibration, choice) = (self.problem, self.times, &self.equilibration, self.choice);
        let (reconstruction, tracks) = (preparation.reconstruction(), preparation.tracks());
        let balance = Balance { problem, equilibration, choice, concentration: reconstruction.concentration() };
        self.maps.begin(times.instants(), &balance, levels);
        let shared = Sampling { problem, times, equilibration, choice, maps: &self.maps };
        let sampled = SampledLevels { before: self.carried.as_ref().map(KeptLevel::level), levels };
        let (residuals, kept) = far::sample(&shared, &sampled, &self.is_near, &mut self.courses, &mut self.far);
        let context = ContactSampling { shared: &shared, reconstruction, tracks };
        self.near.par_iter_mut().for_each(|near| near.advance(&context, &sampled));
        self.residuals.merge(&residuals);
        self.maps.put(&kept);
    }
}

#[cfg(test)]
mod tests;
