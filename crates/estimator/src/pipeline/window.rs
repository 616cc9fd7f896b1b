//! The parallel part: stress, tractions and errors of all elements over a window of levels.
//!
//! Nothing here depends on the number of threads or on where windows end: every number is computed
//! by one task from its own data, and sums are taken over fixed blocks of elements in order.

use super::far::{FarCourse, FarSampling, FarSums};
use super::maps::{Balance, Contribution, Maps};
use super::near::ContactSampling;
use super::near_elements::{self, NearElements};
use super::prepare::Preparation;
use super::sampled_interval::SampledInterval;
use super::sampled_levels::SampledLevels;
use super::sampling::SharedData;
use super::totals::{self, Worked};
use crate::contact_density::OffContact;
use crate::difference::Difference;
use crate::element::Element;
use crate::error::EstimateError;
use crate::estimate::{Estimate, Sample};
use crate::options::{Acceleration, Options, Reconstruction};
use crate::reconstruction;
use crate::residual::{Residuals, worse};
use crate::scratch_file::{ScratchError, ScratchFile};
use crate::sources::Sources;
use crate::time_level::ForcesKnown;
use crate::traction::{EquilibratedLevels, Equilibration, KeptLevel, Then};
use percute_core::observer::StopFlag;
use percute_core::problem::Problem;
use percute_core::simd::lanes::{LANES, Lanes};
use percute_core::time::TimeGrid;
use rayon::ThreadPool;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Levels in preparation and the one that is kept for the next window.
const OTHER_LEVELS: usize = 4;

/// Memory of one level (bytes).
fn bytes_of_level<const D: usize>(problem: &Problem<D>, options: &Options) -> usize {
    let fields = if options.acceleration(D) == Acceleration::Split { 9 } else { 6 };
    size_of::<[f64; D]>() * fields * problem.mesh().node_count()
}

/// About how much memory (bytes) the steps between samples take, and what is kept of each sample beside the intervals.
fn bytes_of_auxiliary<const D: usize>(problem: &Problem<D>, steps: usize, samples: usize, pending: usize) -> usize {
    let faces = problem.surface().faces().len();
    let auxiliary = steps.saturating_mul(size_of::<Difference>()) + 2 * samples * size_of::<Sources>();
    pending.saturating_mul(OffContact::<D>::memory(faces)).saturating_add(auxiliary)
}

/// Number of levels worked on at once.
fn size(options: &Options) -> usize {
    options.window.map_or(LANES, |window| window.min(LANES))
}

/// About how much memory (bytes) an estimate takes beside its problem, [`memory`](crate::memory).
pub(crate) fn memory<const D: usize, const N: usize>(
    problem: &Problem<D>,
    times: &TimeGrid,
    options: &Options,
) -> usize {
    let levels = size(options).min(times.step_count()).saturating_add(OTHER_LEVELS);
    // Its places in the blocks of elements and stars are three for each node of it.
    let element = size_of::<Element<D, N>>() + 3 * N * size_of::<u32>() + size_of::<FarCourse<D, N>>();
    // Moments of a window.
    let link = size_of::<[Lanes; D]>();
    // At the level and half way to the next.
    let step = size_of::<SampledInterval>() + 2 * size_of::<Sample>() + size_of::<usize>();
    let spacing = options.spacing(problem, times);
    let steps = times.step_count() / spacing + 1;
    let auxiliary = if options.reconstruction == Reconstruction::Corrected {
        bytes_of_auxiliary(problem, times.step_count(), steps, levels * spacing)
    } else {
        0
    };
    levels
        .saturating_mul(bytes_of_level(problem, options))
        .saturating_add(reconstruction::memory::<D, N>(problem, options))
        .saturating_add(element.saturating_mul(problem.mesh().element_count()))
        .saturating_add(link.saturating_mul(problem.mesh().stars().link_count()))
        .saturating_add(step.saturating_mul(steps))
        .saturating_add(near_elements::memory::<D, N>(problem, steps, spacing))
        .saturating_add(auxiliary)
}

/// Levels in work, and the sums so far.
#[derive(Debug)]
pub(crate) struct LevelWindow<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D>,
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
    near: NearElements<D, N>,
    is_near: Vec<bool>,
    /// The links by which the stars of their nodes enter and leave them, in order.
    near_links: Arc<[u32]>,
    /// Sums over far elements from the last level on.
    far: FarSums,
    /// All intervals so far; the last ones lack the near elements that wait.
    intervals: Vec<SampledInterval>,
    /// Far elements so far.
    courses: Vec<FarCourse<D, N>>,
    pub(super) maps: Maps,
    residuals: Residuals,
    /// Work was stopped: the levels from then on are not estimated.
    stopped: bool,
}

impl<'p, const D: usize, const N: usize> LevelWindow<'p, D, N> {
    pub(super) fn new(problem: &'p Problem<D>, times: &'p TimeGrid, options: &Options, maps: Maps) -> Self {
        let near = NearElements::new(problem, ScratchFile::default());
        let mut is_near = vec![false; problem.mesh().element_count()];
        near.all.iter().for_each(|n| is_near[n.element.index()] = true);
        let equilibration = Equilibration::new(problem);
        let links = near.all.iter().flat_map(|n| equilibration.elements[n.element.index()].links);
        let near_links: BTreeSet<u32> = links.flatten().map(|link| link.place() as u32).collect();
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
            intervals: Vec::new(),
            courses: vec![FarCourse::default(); problem.mesh().element_count()],
            maps,
            residuals: Residuals::default(),
            stopped: false,
        }
    }

    /// The near elements, for tests.
    #[cfg(test)]
    pub(super) fn near_mut(&mut self) -> &mut NearElements<D, N> {
        &mut self.near
    }

    /// Has the memory of the first window at hand: a stop waits for that window, but not for this.
    pub(super) fn make_room(&mut self) {
        self.equilibrated = EquilibratedLevels::with_links(self.problem.mesh().stars().link_count());
    }

    /// Leaves a window in its middle once the flag is up, and gives up its levels.
    pub(super) fn stop_at(&mut self, flag: StopFlag) {
        self.equilibration.stop = flag;
    }

    /// Takes in a level; works when the window is full.
    pub(super) fn push(
        &mut self,
        pool: &ThreadPool,
        level: ForcesKnown<D>,
        preparation: &mut Preparation<'p, D, N>,
    ) -> Result<(), ScratchError> {
        self.levels.push(level);
        if self.levels.len() >= self.size { pool.install(|| self.work(preparation)) } else { Ok(()) }
    }

    /// Works on the levels that are left and sums up.
    pub(super) fn finish(
        mut self,
        pool: &ThreadPool,
        preparation: &mut Preparation<'p, D, N>,
    ) -> Result<Estimate, EstimateError> {
        pool.install(|| self.work(preparation).and_then(|()| self.catch_up(preparation)))?;
        if self.intervals.is_empty() {
            return Err(EstimateError::Stopped);
        }
        // The sums over time begin when the memory of levels is free.
        let Self {
            problem,
            times,
            intervals,
            near,
            courses,
            residuals,
            maps,
            equilibration,
            levels,
            equilibrated,
            carried,
            ..
        } = self;
        let near = near.into_elements();
        drop((levels, equilibrated, carried));
        let maps = maps.finish(problem, &equilibration.elements);
        let integrals = courses.iter().map(|course| course.course.integral).collect();
        let worked = Worked { intervals, near, integrals, residuals, maps };
        Ok(totals::estimate(problem, times, preparation, worked))
    }

    /// Works on the levels of the window and keeps the last for the next one.
    fn work(&mut self, preparation: &mut Preparation<'p, D, N>) -> Result<(), ScratchError> {
        self.stopped |= self.equilibration.stop.is_up();
        if self.levels.is_empty() || self.stopped {
            self.levels.clear();
            return Ok(());
        }
        let mut levels = std::mem::take(&mut self.equilibrated);
        let (reconstruction, choice) = (preparation.reconstruction(), self.choice);
        let forces = std::mem::take(&mut self.levels);
        let sampled = self.sample(&mut levels, |equilibration, levels, then| {
            reconstruction.equilibrate(equilibration, choice, forces, levels, then)
        })?;
        let Some(kept) = sampled else {
            self.stopped = true;
            return Ok(());
        };
        let (equilibration, concentration) = (&self.equilibration, reconstruction.concentration());
        let balance = Balance { problem: self.problem, equilibration, choice, concentration };
        self.maps.begin(self.times.instants(), &balance, &levels);
        self.maps.put(&kept);
        self.carried = levels.keep_last(&self.near_links);
        self.equilibrated = levels;
        self.catch_up(preparation)
    }

    /// Samples all elements at some levels, each part of the mesh as soon as its tractions are there. Returns the
    /// contributions of far elements to maps; none if it is stopped, and then no sum is changed.
    fn sample(
        &mut self,
        levels: &mut EquilibratedLevels<D>,
        equilibrate: impl FnOnce(&Equilibration<'p, D, N>, &mut EquilibratedLevels<D>, Then<'_, D>) -> f64,
    ) -> Result<Option<Vec<Contribution>>, ScratchError> {
        let (problem, times, equilibration, choice) = (self.problem, self.times, &self.equilibration, self.choice);
        let shared = SharedData { problem, times, equilibration, choice, maps: &self.maps };
        let before = self.carried.as_ref().map(KeptLevel::level);
        let mut far = FarSampling::new(&shared, before, &self.is_near, &mut self.courses);
        let miss = equilibrate(equilibration, levels, &mut |levels, part| far.sample(levels, part.elements.clone()));
        if equilibration.stop.is_up() {
            far.undo();
            return Ok(None);
        }
        let (residuals, kept) = far.finish(levels, &mut self.far);
        let (sampled, first) = (SampledLevels { before, levels }, self.intervals.len());
        for (k, interval) in sampled.intervals().enumerate() {
            let far = [self.far.levels[k], self.far.mids[k], self.far.levels[k + 1]];
            self.intervals.push(SampledInterval::new(times, interval.map(|level| level.index()), far));
        }
        self.far.levels.drain(..self.intervals.len() - first);
        self.far.mids.clear();
        self.near.append(&shared, &sampled, first..self.intervals.len())?;
        self.residuals.merge(&residuals);
        self.residuals.star_compatibility = worse(self.residuals.star_compatibility, miss);
        Ok(Some(kept))
    }

    /// Samples near elements as far as the motion of all contact nodes is known.
    fn catch_up(&mut self, preparation: &mut Preparation<'p, D, N>) -> Result<(), ScratchError> {
        let (problem, times, equilibration, choice) = (self.problem, self.times, &self.equilibration, self.choice);
        let fastest = problem.initial_velocity().iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
        while let Some(known) = self.near.first_known(preparation.tracks(), &self.intervals) {
            let intervals = &mut self.intervals[known];
            if let [first, ..] = intervals {
                let (from, to) = (first.levels[0], intervals[intervals.len() - 1].levels[1]);
                preparation.show([2 * from, 2 * to])?;
                self.maps.settle(problem, preparation.tracks().all(), to);
            }
            let shared = SharedData { problem, times, equilibration, choice, maps: &self.maps };
            let (reconstruction, tracks) = (preparation.reconstruction(), preparation.tracks().all());
            let non_matching = preparation.non_matching();
            self.near.sample(
                &ContactSampling { shared: &shared, reconstruction, fastest, tracks, non_matching },
                intervals,
            )?;
            self.near.put(&mut self.maps);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
