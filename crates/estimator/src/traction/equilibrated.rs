//! Time levels with equilibrated tractions, side by side.

use crate::time_level::ForcesKnown;
use percute_core::ids::ElementId;
use percute_core::simd::lanes::Lanes;
use rayon::prelude::*;
use std::sync::Arc;

/// At most [`LANES`](percute_core::simd::lanes::LANES) levels of which all fields are known. Only
/// [`Equilibration`](super::Equilibration) makes them.
#[derive(Clone, Debug, Default)]
pub(crate) struct EquilibratedLevels<const D: usize> {
    pub(super) forces: Vec<ForcesKnown<D>>,
    /// Largest nodal force of any element (N).
    pub(super) force_scale: Lanes,
    /// Projected traction moments on the links of all stars (N).
    pub(super) moments: Vec<[Lanes; D]>,
    /// Those around contact nodes before t_n, where the contact force jumps there.
    pub(super) moments_before: Vec<Option<Vec<[f64; D]>>>,
}

/// One of these levels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EquilibratedLevel<'a, const D: usize> {
    forces: &'a ForcesKnown<D>,
    force_scale: f64,
    moments: LinkMoments<'a, D>,
    pub(super) moments_before: Option<&'a [[f64; D]]>,
}

/// The moments of a level on links of stars (N).
#[derive(Clone, Copy, Debug)]
enum LinkMoments<'a, const D: usize> {
    /// On some links: their numbers, in order, and their moments.
    Some(&'a [u32], &'a [[f64; D]]),
    Lane(&'a [[Lanes; D]], usize),
}

/// A level that is kept for the interval that begins there.
#[derive(Clone, Debug)]
pub(crate) struct KeptLevel<const D: usize> {
    forces: ForcesKnown<D>,
    force_scale: f64,
    links: Arc<[u32]>,
    moments: Vec<[f64; D]>,
}

impl<const D: usize> EquilibratedLevels<D> {
    /// Room for moments on so many links. All threads fill it: on a large mesh the system takes longer to give the
    /// memory than the star problems of a level.
    pub(crate) fn with_links(count: usize) -> Self {
        let mut levels = Self::default();
        (0..count).into_par_iter().map(|_| [Lanes::ZERO; D]).collect_into_vec(&mut levels.moments);
        levels
    }

    /// Number of levels.
    pub(crate) fn len(&self) -> usize {
        self.forces.len()
    }

    /// One of them.
    pub(crate) fn level(&self, k: usize) -> EquilibratedLevel<'_, D> {
        EquilibratedLevel {
            forces: &self.forces[k],
            force_scale: self.force_scale.0[k],
            moments: LinkMoments::Lane(&self.moments, k),
            moments_before: self.moments_before[k].as_deref(),
        }
    }

    /// The fields that the stars were solved for.
    pub(crate) fn forces(&self) -> &[ForcesKnown<D>] {
        &self.forces
    }

    /// f_d on an element (N/m³).
    pub(crate) fn body_force(&self, element: ElementId) -> [Lanes; D] {
        let of = |k: usize, c: usize| {
            self.forces.get(k).and_then(|f| f.level.body_force.get(element.index())).map_or(0.0, |f| f[c])
        };
        std::array::from_fn(|c| Lanes::at_levels(|k| of(k, c)))
    }

    /// Largest nodal force of any element (N).
    pub(crate) fn force_scale(&self) -> Lanes {
        self.force_scale
    }

    /// The moments on the links of all stars (N).
    pub(crate) fn moments(&self) -> &[[Lanes; D]] {
        &self.moments
    }

    /// The same, for changes that balance. No instant of these levels may be a jump.
    pub(crate) fn all_moments_mut(&mut self) -> &mut [[Lanes; D]] {
        &mut self.moments
    }

    /// For tests that spoil them.
    #[cfg(test)]
    pub(crate) fn forces_mut(&mut self) -> &mut [ForcesKnown<D>] {
        &mut self.forces
    }

    /// Takes the last level out, with the moments on some links, in order, and frees the fields of the others.
    pub(crate) fn keep_last(&mut self, links: &Arc<[u32]>) -> Option<KeptLevel<D>> {
        let forces = self.forces.pop()?;
        let lane = self.forces.len();
        self.forces.clear();
        self.moments_before.clear();
        Some(KeptLevel {
            forces,
            force_scale: self.force_scale.0[lane],
            moments: links.iter().map(|&link| self.moments[link as usize].map(|m| m.0[lane])).collect(),
            links: Arc::clone(links),
        })
    }
}

impl<const D: usize> KeptLevel<D> {
    pub(crate) fn level(&self) -> EquilibratedLevel<'_, D> {
        EquilibratedLevel {
            forces: &self.forces,
            force_scale: self.force_scale,
            moments: LinkMoments::Some(&self.links, &self.moments),
            moments_before: None,
        }
    }
}

impl<'a, const D: usize> EquilibratedLevel<'a, D> {
    /// n.
    #[inline]
    pub(crate) fn index(&self) -> usize {
        self.forces.level.index
    }

    /// The fields that the stars were solved for.
    #[inline]
    pub(crate) fn forces(&self) -> &'a ForcesKnown<D> {
        self.forces
    }

    /// Largest nodal force of any element (N).
    #[inline]
    pub(crate) fn force_scale(&self) -> f64 {
        self.force_scale
    }

    #[inline]
    pub(super) fn moment(&self, link: usize) -> [f64; D] {
        match self.moments {
            LinkMoments::Some(links, moments) => {
                let at = links.partition_point(|&kept| (kept as usize) < link);
                assert_eq!(links[at] as usize, link, "only the links of near elements are kept");
                moments[at]
            }
            LinkMoments::Lane(moments, lane) => moments[link].map(|m| m.0[lane]),
        }
    }
}
