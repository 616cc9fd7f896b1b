//! The parallel part: stress, tractions and errors of all elements over a window of levels.
//!
//! Nothing here depends on the number of threads or on where windows end: every number is computed
//! by one task from its own data, and sums are taken over fixed blocks of elements in order.

use super::far::{self, FarSums};
use super::maps::{Balance, Maps};
use super::near::{ContactSampling, NearElement, near_elements};
use super::prepare::Preparation;
use super::sampling::{Course, Sampling};
use super::totals::{self, Worked};
use crate::element::Element;
use crate::estimate::{Estimate, Sample};
use crate::measure::ElementError;
use crate::options::{Acceleration, Options};
use crate::reconstruction;
use crate::residual::{Residuals, worse};
use crate::time_level::ForcesKnown;
use crate::traction::{Equilibrated, Equilibration};
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use rayon::ThreadPool;
use rayon::prelude::*;

/// Memory that a window may take unless told otherwise (bytes).
const MODEST_MEMORY: usize = 1 << 30;
/// More levels than this gain nothing; fewer make the maps of the elements too often.
const LEVELS: std::ops::RangeInclusive<usize> = 8..=64;
/// Elements times levels that are worked on between two looks at whether to stop: about a second.
const WORK: usize = 2_000_000;

/// Memory of one level (bytes).
fn bytes_of_level<const D: usize, const N: usize>(problem: &Problem<D, N>, options: &Options) -> usize {
    let mesh = problem.mesh();
    let fields = if options.acceleration(D) == Acceleration::Mixed { 11 } else { 8 };
    8 * D * (fields * mesh.node_count() + mesh.stars().link_count() + D * mesh.element_count())
}

/// Number of intervals worked on at once.
fn size<const D: usize, const N: usize>(problem: &Problem<D, N>, options: &Options) -> usize {
    let wanted = (WORK / problem.mesh().element_count()).clamp(*LEVELS.start(), *LEVELS.end());
    options.window.unwrap_or_else(|| wanted.min(MODEST_MEMORY / bytes_of_level(problem, options)).max(1))
}

/// About how much memory (bytes) an estimate takes beside its problem: its levels and the data that it keeps of
/// each element and sample. The queues of elements around contact nodes are not foreseen.
#[must_use]
pub fn memory<const D: usize, const N: usize>(problem: &Problem<D, N>, times: &TimeGrid, options: &Options) -> usize {
    let levels = size(problem, options).min(times.step_count()).saturating_add(1);
    // Elements are prepared twice, for the forces of the levels and for the stars.
    let element = 2 * size_of::<Element<D, N>>() + 8 * N * (D + 1) + size_of::<ElementError>();
    // At the level and half way to the next.
    let step = 2 * (size_of::<Sample>() + size_of::<ElementError>());
    let steps = times.step_count() / options.every.max(1) + 1;
    let threads = options.threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, Into::into));
    levels
        .saturating_mul(bytes_of_level(problem, options))
        .saturating_add(reconstruction::new(problem, times, options).memory(levels, threads))
        .saturating_add(element.saturating_mul(problem.mesh().element_count()))
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
    carried: Option<Equilibrated<D>>,
    levels: Vec<ForcesKnown<D>>,
    near: Vec<NearElement<D, N>>,
    is_near: Vec<bool>,
    far: FarSums,
    /// η_E of far elements.
    courses: Vec<Course>,
    pub(super) maps: Maps<D>,
    residuals: Residuals,
}

impl<'p, const D: usize, const N: usize> LevelWindow<'p, D, N> {
    pub(super) fn new(problem: &'p Problem<D, N>, times: &'p TimeGrid, options: &Options, maps: Maps<D>) -> Self {
        let near = near_elements(problem);
        let mut is_near = vec![false; problem.mesh().element_count()];
        near.iter().for_each(|n| is_near[n.element.index()] = true);
        Self {
            problem,
            times,
            equilibration: Equilibration::new(problem),
            choice: options.acceleration(D),
            size: size(problem, options),
            carried: None,
            levels: Vec::new(),
            near,
            is_near,
            far: FarSums::default(),
            courses: vec![Course::default(); problem.mesh().element_count()],
            maps,
            residuals: Residuals::default(),
        }
    }

    /// Takes in a level; works when the window is full.
    pub(super) fn push(&mut self, pool: &ThreadPool, level: ForcesKnown<D>, preparation: &Preparation<'p, D, N>) {
        self.levels.push(level);
        if self.levels.len() + usize::from(self.carried.is_some()) > self.size {
            pool.install(|| self.work(preparation));
        }
    }

    /// Works on the levels that are left and sums up.
    pub(super) fn finish(mut self, pool: &ThreadPool, preparation: &Preparation<'p, D, N>) -> Estimate<D> {
        pool.install(|| self.work(preparation));
        self.near.iter().for_each(|near| self.maps.put(&near.kept));
        let Self { problem, times, far, near, courses, residuals, .. } = self;
        let maps = self.maps.finish(problem, &self.equilibration.elements, preparation.tracks());
        totals::estimate(problem, times, preparation, Worked { far, near, courses, residuals, maps })
    }

    /// Works on the levels of the window and keeps the last for the next one.
    fn work(&mut self, preparation: &Preparation<'p, D, N>) {
        if self.levels.is_empty() {
            return;
        }
        let (first, mut levels) = self.equilibrate();
        preparation.reconstruction().improve(&self.equilibration, self.choice, &mut levels[first..]);
        self.sample(preparation, first, &levels);
        self.carried = levels.pop();
    }

    /// The level carried over and the new ones, equilibrated; the first new one is at the index returned.
    fn equilibrate(&mut self) -> (usize, Vec<Equilibrated<D>>) {
        let mut levels: Vec<_> = self.carried.take().into_iter().collect();
        let first = levels.len();
        for forces in std::mem::take(&mut self.levels) {
            let stress = self.equilibration.stress(&forces);
            let (level, miss) = self.equilibration.solve_stars(forces, stress);
            self.residuals.star_compatibility = worse(self.residuals.star_compatibility, miss);
            levels.push(level);
        }
        (first, levels)
    }

    /// Samples all elements at the levels from `first` on.
    fn sample(&mut self, preparation: &Preparation<'p, D, N>, first: usize, levels: &[Equilibrated<D>]) {
        let (problem, times, equilibration, choice) = (self.problem, self.times, &self.equilibration, self.choice);
        let (reconstruction, tracks) = (preparation.reconstruction(), preparation.tracks());
        let balance = Balance { problem, equilibration, choice, concentration: reconstruction.concentration() };
        self.maps.begin(times.instants(), &balance, &levels[first..]);
        let shared = Sampling { problem, times, equilibration, choice, maps: &self.maps };
        let blocks = far::sample(&shared, levels, first, &self.is_near, &mut self.courses);
        let context = ContactSampling { shared: &shared, reconstruction, tracks };
        self.near.par_iter_mut().for_each(|near| near.advance(&context, levels));
        let mut sums = FarSums::new(levels.len() - first, levels.len() - 1);
        for block in &blocks {
            sums.add(&block.sums);
            self.residuals.merge(&block.residuals);
            self.maps.put(&block.kept);
        }
        self.far.extend(sums);
    }
}

#[cfg(test)]
mod tests;
