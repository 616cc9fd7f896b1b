//! Elements without a candidate node of contact, sampled as soon as a level is equilibrated.

use super::maps::Contribution;
use super::sampling::{ContactPart, Course, ElementInterval, ElementSampler, Sampling};
use crate::element::BLOCK;
use crate::measure::ElementError;
use crate::residual::Residuals;
use crate::time_level::{Side, Velocities};
use crate::traction::Equilibrated;
use percute_core::ids::ElementId;
use rayon::prelude::*;

/// Away from contact the pointwise equilibrium of σ_DA is checked at every level of so many: a check costs more than the
/// measure itself.
const CHECK: usize = 64;

/// Sums over far elements at the levels and in the middles between them.
#[derive(Clone, Debug, Default)]
pub(crate) struct FarSums {
    pub(crate) levels: Vec<ElementError>,
    pub(crate) mids: Vec<ElementError>,
}

impl FarSums {
    pub(crate) fn new(levels: usize, mids: usize) -> Self {
        Self { levels: vec![ElementError::default(); levels], mids: vec![ElementError::default(); mids] }
    }

    /// Adds another block of elements.
    pub(crate) fn add(&mut self, other: &Self) {
        self.levels.iter_mut().zip(&other.levels).for_each(|(a, b)| a.add(b));
        self.mids.iter_mut().zip(&other.mids).for_each(|(a, b)| a.add(b));
    }

    /// Appends a later window.
    pub(crate) fn extend(&mut self, later: Self) {
        self.levels.extend(later.levels);
        self.mids.extend(later.mids);
    }
}

/// The results of the far elements in one window.
pub(super) struct FarBlock {
    pub(super) sums: FarSums,
    pub(super) residuals: Residuals,
    pub(super) kept: Vec<Contribution>,
}

/// Samples all far elements at the levels from `first` on, by blocks, in their order. Earlier levels were sampled before.
pub(super) fn sample<const D: usize, const N: usize>(
    shared: &Sampling<'_, '_, D, N>,
    levels: &[Equilibrated<D>],
    first: usize,
    is_near: &[bool],
    courses: &mut [Course],
) -> Vec<FarBlock> {
    let block = |(block, courses): (usize, &mut [Course])| {
        let sums = FarSums::new(levels.len() - first, levels.len() - 1);
        let mut found = FarBlock { sums, residuals: Residuals::default(), kept: Vec::new() };
        for (k, course) in courses.iter_mut().enumerate() {
            let id = block * BLOCK + k;
            if !is_near[id] {
                let sampler = ElementSampler::new(shared, ElementId::new(id));
                found.sample(&sampler, levels, first, course);
            }
        }
        found
    };
    courses.par_chunks_mut(BLOCK).enumerate().map(block).collect()
}

impl FarBlock {
    /// Adds one element.
    fn sample<const D: usize, const N: usize>(
        &mut self,
        sampler: &ElementSampler<'_, '_, D, N>,
        levels: &[Equilibrated<D>],
        first: usize,
        course: &mut Course,
    ) {
        let balanced = |level| sampler.balanced(level, &[None; N], Side::After);
        let gather = |velocities: &Velocities<D>| sampler.velocities(velocities);
        let mut before = balanced(&levels[0]);
        let begins = first == 0;
        if begins {
            sampler.check(&before, &levels[0], CHECK, &mut self.residuals);
        }
        for (k, pair) in levels.windows(2).enumerate() {
            let (from, to) = (&pair[0], &pair[1]);
            let after = balanced(to);
            sampler.check(&after, to, CHECK, &mut self.residuals);
            let start = (begins && k == 0).then(|| gather(&from.forces().now));
            let mid = to.forces().mid.as_ref().filter(|_| to.index() == from.index() + 1).map(gather);
            let interval = ElementInterval {
                steps: [from.index(), to.index()],
                balanced: [&before, &after],
                start: start.as_ref(),
                mid: mid.as_ref(),
                end: &gather(&to.forces().now),
                contact: [ContactPart::default(); 3],
                hats: [&[]; 3],
            };
            let [start, middle, end] = sampler.sample(&interval, course, &mut self.kept);
            if begins && k == 0 {
                self.sums.levels[0].add(&start.error);
            }
            self.sums.mids[k].add(&middle.error);
            self.sums.levels[k + 1 - first].add(&end.error);
            before = after;
        }
    }
}
