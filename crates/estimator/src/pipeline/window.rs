//! The parallel part: stress, tractions and errors of all elements over a window of levels.
//!
//! Nothing here depends on the number of threads or on where windows end: every number is computed
//! by one task from its own data, and sums are taken over fixed blocks of elements in order.

use super::BLOCK;
use super::maps::{Contribution, Maps};
use super::near::{Context, NearElement, near_elements};
use super::prepare::Preparation;
use super::totals::{self, FarSums, Worked};
use crate::element::Element;
use crate::estimate::{Estimate, Sample};
use crate::kinematic::{ContactTrack, ElementMotion, Knot};
use crate::measure::{Balanced, ElementError, ElementMeasure};
use crate::options::{Ablation, Acceleration, Options, Reconstruction};
use crate::reconstruction::TractionMinimisation;
use crate::residual::{Residuals, worse};
use crate::time_level::{Side, TimeLevel};
use crate::traction::Equilibration;
use percute_core::ids::{ElementId, NodeId};
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use rayon::ThreadPool;
use rayon::prelude::*;

/// Away from contact the pointwise equilibrium of σ_DA is checked at every instant of so many, each
/// element in its turn: the map that makes it is linear and the same at all instants, while a check
/// costs more than the measure itself.
const CHECK: usize = 64;
/// Memory that a window may take unless told otherwise (bytes).
const MODEST_MEMORY: usize = 1 << 30;
/// More levels than this gain nothing; fewer make the maps of the elements too often.
const LEVELS: std::ops::RangeInclusive<usize> = 8..=64;
/// Elements times levels that are worked on between two looks at whether to stop: about a second.
const WORK: usize = 2_000_000;

/// Memory of one level (bytes).
fn bytes_of_level<const D: usize, const N: usize>(problem: &Problem<D, N>) -> usize {
    let mesh = problem.mesh();
    8 * D * (8 * mesh.node_count() + mesh.stars().link_count() + D * mesh.element_count())
}

/// Number of intervals worked on at once.
fn size<const D: usize, const N: usize>(problem: &Problem<D, N>, options: &Options) -> usize {
    let wanted = (WORK / problem.mesh().element_count()).clamp(*LEVELS.start(), *LEVELS.end());
    options.window.unwrap_or_else(|| wanted.min(MODEST_MEMORY / bytes_of_level(problem)).max(1))
}

/// About how much memory (bytes) an estimate takes beside its problem: its levels and what it keeps of
/// each element and sample. What elements around contact nodes wait for is not foreseen.
#[must_use]
pub fn memory<const D: usize, const N: usize>(problem: &Problem<D, N>, times: &TimeGrid, options: &Options) -> usize {
    let levels = size(problem, options).min(times.step_count()).saturating_add(1);
    // Elements are prepared twice, for the levels' forces and for the stars.
    let element = 2 * size_of::<Element<D, N>>() + 8 * N * (D + 1) + size_of::<ElementError>();
    // At the level and half way to the next.
    let step = 2 * (size_of::<Sample>() + size_of::<ElementError>());
    let steps = times.step_count() / options.every.max(1) + 1;
    let elements = problem.mesh().element_count();
    let threads = options.threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, Into::into));
    let minimisation = match options.reconstruction {
        Reconstruction::Corrected => {
            TractionMinimisation::<D>::memory(problem.mesh().simplex().shape(), elements, levels, threads)
        }
        Reconstruction::Consistent | Reconstruction::Published => 0,
    };
    levels
        .saturating_mul(bytes_of_level(problem))
        .saturating_add(minimisation)
        .saturating_add(element.saturating_mul(elements))
        .saturating_add(step.saturating_mul(steps))
}

/// Levels in work, and what has been summed so far.
#[derive(Debug)]
pub(crate) struct Window<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D, N>,
    times: &'p TimeGrid,
    equilibration: Equilibration<'p, D, N>,
    /// What improves the tractions of the reading `corrected`.
    minimisation: Option<TractionMinimisation<D>>,
    choice: Acceleration,
    /// Number of intervals worked on at once.
    size: usize,
    levels: Vec<TimeLevel<D>>,
    /// Whether the first level was the last of the window before.
    carried: bool,
    /// Weight of the work of normal forces off contact.
    normal_work: f64,
    near: Vec<NearElement<D, N>>,
    is_near: Vec<bool>,
    far: FarSums,
    /// Time integral of η_E, and η_E at the last level, of far elements.
    progress: Vec<(f64, f64)>,
    pub(super) maps: Maps<D>,
    residuals: Residuals,
}

impl<'p, const D: usize, const N: usize> Window<'p, D, N> {
    pub(super) fn new(problem: &'p Problem<D, N>, times: &'p TimeGrid, options: &Options, maps: Maps<D>) -> Self {
        let near = near_elements(problem);
        let mut is_near = vec![false; problem.mesh().element_count()];
        near.iter().for_each(|n| is_near[n.element.index()] = true);
        let equilibration = Equilibration::new(problem);
        let minimisation =
            options.reconstruction == Reconstruction::Corrected && options.ablation != Ablation::LeastEnergy;
        Self {
            problem,
            times,
            minimisation: if minimisation { TractionMinimisation::new(problem, &equilibration.elements) } else { None },
            equilibration,
            choice: options.acceleration,
            size: size(problem, options),
            levels: Vec::new(),
            carried: false,
            normal_work: match options.ablation {
                Ablation::NormalWork => 0.0,
                Ablation::DoubledWork => 2.0,
                _ => 1.0,
            },
            near,
            is_near,
            far: FarSums::default(),
            progress: vec![(0.0, 0.0); problem.mesh().element_count()],
            maps,
            residuals: Residuals::default(),
        }
    }

    /// Takes in a level; works when the window is full.
    pub(super) fn push(&mut self, pool: &ThreadPool, level: TimeLevel<D>, tracks: &[ContactTrack]) {
        self.levels.push(level);
        if self.levels.len() > self.size {
            self.work(pool, tracks);
        }
    }

    /// Works on what is left and sums up.
    pub(super) fn finish(mut self, pool: &ThreadPool, preparation: &Preparation<'p, D, N>) -> Estimate<D> {
        self.work(pool, preparation.tracks());
        self.near.iter().for_each(|near| self.maps.put(&near.kept));
        let Self { problem, times, far, near, progress, residuals, .. } = self;
        let maps = self.maps.finish(problem, &self.equilibration.elements, preparation.tracks());
        totals::estimate(problem, times, preparation, Worked { far, near, progress, residuals, maps })
    }

    /// Works on the levels of the window and keeps the last for the next one.
    fn work(&mut self, pool: &ThreadPool, tracks: &[ContactTrack]) {
        let first = usize::from(self.carried);
        if self.levels.len() <= first {
            return;
        }
        pool.install(|| {
            self.stresses(first);
            self.stars(first);
            if let Some(minimisation) = &self.minimisation {
                minimisation.improve(self.problem, &self.equilibration, self.choice, &mut self.levels[first..]);
            }
            let (problem, times, equilibration, choice) = (self.problem, self.times, &self.equilibration, self.choice);
            self.maps.begin(problem, times.instants(), equilibration, choice, &self.levels[first..]);
            self.far_elements(first);
            let (equilibration, maps, normal_work) = (&self.equilibration, &self.maps, self.normal_work);
            let context = Context { problem, times, equilibration, choice, normal_work, tracks, maps };
            self.near.par_iter_mut().for_each(|near| near.advance(&context, &self.levels));
        });
        let last = self.levels.len() - 1;
        self.levels.swap(0, last);
        self.levels.truncate(1);
        self.carried = true;
    }

    /// σ_h of every element, and the largest nodal force.
    fn stresses(&mut self, first: usize) {
        let (problem, elements) = (self.problem, &self.equilibration.elements);
        for level in &mut self.levels[first..] {
            let mut stress = vec![[[0.0; D]; D]; elements.len()];
            let largest = stress.par_chunks_mut(BLOCK).zip(elements.par_chunks(BLOCK)).enumerate().map(
                |(block, (stress, elements))| {
                    let mut largest: f64 = 0.0;
                    for (k, (stress, element)) in stress.iter_mut().zip(elements).enumerate() {
                        let law = problem.material(ElementId::new(block * BLOCK + k));
                        *stress = law.stress(&element.gradient(&element.gather(&level.displacement)));
                        largest = largest.max(largest_force(element, stress, &level.acceleration));
                    }
                    largest
                },
            );
            level.force_scale = largest.reduce(|| 0.0, f64::max);
            level.stress = stress;
        }
    }

    /// The star problems of all nodes.
    fn stars(&mut self, first: usize) {
        let stars = self.problem.mesh().stars();
        let nodes = self.problem.mesh().node_count();
        for level in &mut self.levels[first..] {
            let mut flux = vec![[0.0; D]; stars.link_count()];
            let mut blocks = Vec::with_capacity(nodes.div_ceil(BLOCK));
            let mut rest = flux.as_mut_slice();
            for start in (0..nodes).step_by(BLOCK) {
                let end = (start + BLOCK).min(nodes);
                let links = stars.link_range(NodeId::new(end - 1)).end - stars.link_range(NodeId::new(start)).start;
                let (block, others) = rest.split_at_mut(links);
                blocks.push((start..end, block));
                rest = others;
            }
            let (equilibration, here) = (&self.equilibration, &*level);
            let solve = |(nodes, mut block): (std::ops::Range<usize>, &mut [[f64; D]])| {
                let mut worst: f64 = 0.0;
                for node in nodes.map(NodeId::new) {
                    let (flux, others) = std::mem::take(&mut block).split_at_mut(stars.link_range(node).len());
                    block = others;
                    let acceleration = &here.acceleration[node.index()];
                    let star = equilibration.solve_star(here, node, acceleration, &here.density_after, flux);
                    worst = worse(worst, equilibration.star_residual(star, here, node));
                }
                worst
            };
            let miss = blocks.into_par_iter().map(solve).reduce(|| 0.0, worse);
            self.residuals.star_compatibility = worse(self.residuals.star_compatibility, miss);
            level.flux = flux;
            let miss = contact_stars(self.problem, &self.equilibration, level);
            self.residuals.star_compatibility = worse(self.residuals.star_compatibility, miss);
        }
    }

    /// Errors of the elements away from contact, summed by blocks.
    fn far_elements(&mut self, first: usize) {
        let blocks = self.progress.par_chunks_mut(BLOCK).zip(self.equilibration.elements.par_chunks(BLOCK));
        let shared = Shared {
            problem: self.problem,
            equilibration: &self.equilibration,
            choice: self.choice,
            levels: &self.levels,
            first,
            times: self.times,
            maps: &self.maps,
        };
        let is_near = &self.is_near;
        let none = || FarSums::new(self.levels.len() - first, self.levels.len() - 1);
        let results: Vec<FarBlock> = blocks
            .enumerate()
            .map(|(block, (progress, elements))| {
                let mut found = FarBlock { sums: none(), residuals: Residuals::default(), kept: Vec::new() };
                for (k, (element, progress)) in elements.iter().zip(progress).enumerate() {
                    let id = block * BLOCK + k;
                    if !is_near[id] {
                        shared.one_element(ElementId::new(id), element, progress, &mut found);
                    }
                }
                found
            })
            .collect();
        let mut window = none();
        for block in &results {
            window.add(&block.sums);
            self.residuals.merge(&block.residuals);
            self.maps.put(&block.kept);
        }
        self.far.extend(window);
    }
}

/// What a block of far elements leaves in a window.
struct FarBlock {
    sums: FarSums,
    residuals: Residuals,
    kept: Vec<Contribution>,
}

/// What the far elements of a window share.
struct Shared<'a, 'p, const D: usize, const N: usize> {
    problem: &'p Problem<D, N>,
    equilibration: &'a Equilibration<'p, D, N>,
    choice: Acceleration,
    levels: &'a [TimeLevel<D>],
    first: usize,
    times: &'p TimeGrid,
    maps: &'a Maps<D>,
}

impl<const D: usize, const N: usize> Shared<'_, '_, D, N> {
    /// Adds one element's errors at all samples of the window.
    fn one_element(&self, id: ElementId, element: &Element<D, N>, progress: &mut (f64, f64), found: &mut FarBlock) {
        let measure = ElementMeasure::new(self.problem, element, id, self.choice);
        let error = |balanced: &Balanced<D, N>, knot: &Knot<D>| {
            measure.error(balanced, &element.gather(&knot.increment), &ElementMotion::gather(knot, &element.nodes))
        };
        let mut before: Option<Balanced<D, N>> = None;
        for (k, level) in self.levels.iter().enumerate() {
            let now = measure.balanced(self.equilibration, level, &[None; N], Side::After);
            let mut middle = ElementError::default();
            if let (Some(before), Some(mid)) = (&before, self.mid(k)) {
                middle = error(&Balanced::middle(before, &now), mid);
                found.sums.mids[k - 1].add(&middle);
            }
            if k >= self.first {
                measure.check_resultants(&now, level.force_scale, &mut found.residuals);
                if (level.index + id.index()).is_multiple_of(CHECK) {
                    measure.check_stress(&now, level.force_scale, &mut found.residuals);
                }
                let end = error(&now, &level.knot);
                found.sums.levels[k - self.first].add(&end);
                if let Some(from) = k.checked_sub(1).map(|k| &self.levels[k]) {
                    let instants = self.times.instants();
                    let length = instants[level.index] - instants[from.index];
                    let has_middle = self.mid(k).is_some();
                    progress.0 +=
                        totals::trapezoid(length, progress.1, has_middle.then(|| middle.total()), end.total());
                }
                progress.1 = end.total();
                if self.maps.want(level.index) {
                    let (step, accumulated) = (level.index, progress.0);
                    found.kept.push(Contribution { element: id, step, error: end, contact: 0.0, accumulated });
                }
            }
            before = Some(now);
        }
    }

    /// The knot between levels k − 1 and k, if they are one step apart.
    fn mid(&self, k: usize) -> Option<&Knot<D>> {
        let single = k > 0 && self.levels[k].index == self.levels[k - 1].index + 1;
        self.levels[k].mid.as_ref().filter(|_| single)
    }
}

/// Largest |Vσ∇φ_i| and lumped inertia force of an element (N).
fn largest_force<const D: usize, const N: usize>(
    element: &Element<D, N>,
    stress: &[[f64; D]; D],
    acceleration: &[[f64; D]],
) -> f64 {
    let mut largest: f64 = 0.0;
    for i in 0..N {
        let internal = element.internal_force(i, stress);
        let a = &acceleration[element.nodes[i].index()];
        for c in 0..D {
            largest = largest.max(internal[c].abs()).max((element.nodal_mass * a[c]).abs());
        }
    }
    largest
}

/// The stars of contact nodes once more, with the values before t_n.
fn contact_stars<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    equilibration: &Equilibration<'_, D, N>,
    level: &mut TimeLevel<D>,
) -> f64 {
    let mut flux = vec![[0.0; D]; equilibration.contact_links.last().copied().unwrap_or(0)];
    let mut worst: f64 = 0.0;
    for (at, contact) in problem.surface().nodes().iter().enumerate() {
        let links = equilibration.contact_links[at]..equilibration.contact_links[at + 1];
        let acceleration = &level.acceleration_before[at];
        let star = equilibration.solve_star(level, contact.node, acceleration, &level.density_before, &mut flux[links]);
        worst = worse(worst, equilibration.star_residual(star, level, contact.node));
    }
    level.flux_before = flux;
    worst
}

#[cfg(test)]
mod tests;
