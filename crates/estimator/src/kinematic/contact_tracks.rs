//! The normal motion of all candidate nodes.

use super::contact_track::{ContactTrack, NormalStep};
use super::normal_motions::{NormalMotions, most_bytes};
use super::sliding::{SlidingInstant, SlidingMotion};
use crate::estimate::SurfaceEstimate;
use crate::residual::Residuals;
use crate::scratch_file::{ScratchError, ScratchFile};
use percute_core::problem::Problem;
use std::ops::Range;

/// The tracks of all candidate nodes of contact, and the store of their motion.
#[derive(Debug)]
pub(crate) struct ContactTracks {
    all: Vec<ContactTrack>,
    store: NormalMotions,
    /// The motions of surfaces that slide along each other. Their nodes have tracks of the change that it brings.
    sliding: Vec<SlidingMotion>,
    residuals: Residuals,
}

impl ContactTracks {
    /// Those of a problem, which begin with the first step; so many half-step instants are at hand at a time.
    pub(crate) fn new<const D: usize, const N: usize>(problem: &Problem<D, N>, span: usize, file: ScratchFile) -> Self {
        let surface = problem.surface();
        Self {
            all: Vec::new(),
            store: NormalMotions::new(surface.nodes().len(), span, file),
            sliding: (0..surface.sliding().len()).map(|index| SlidingMotion::new(problem, index, span)).collect(),
            residuals: Residuals::default(),
        }
    }

    /// The most bytes that they take.
    pub(crate) fn memory<const D: usize, const N: usize>(problem: &Problem<D, N>, span: usize) -> usize {
        let nodes = problem.surface().nodes().len();
        let at_hand = nodes.saturating_mul(span).saturating_mul(size_of::<[f64; 2]>());
        let sliding: usize = problem.surface().sliding().iter().map(|sliding| sliding.positions().count()).sum();
        let sliding = if sliding > 0 { super::sliding::memory(sliding) } else { 0 };
        nodes * size_of::<ContactTrack>() + most_bytes(nodes, span).saturating_add(at_hand).saturating_add(sliding)
    }

    /// Begins with the gap (m) and normal velocity (m/s) of each node at t = 0, and whether it touches.
    ///
    /// # Errors
    /// A temporary file that fails.
    pub(crate) fn begin<const D: usize, const N: usize>(
        &mut self,
        problem: &Problem<D, N>,
        start: impl Fn(usize) -> ((f64, f64), bool),
    ) -> Result<(), ScratchError> {
        self.store.extend()?;
        for (node, contact) in problem.surface().nodes().iter().enumerate() {
            if problem.surface().sliding_of(node).is_some() {
                self.all.push(ContactTrack::of_change(node));
                continue;
            }
            let ((gap, velocity), touching) = start(node);
            let lengths = (contact.undeformed_gap, problem.mesh().size());
            self.all.push(ContactTrack::new(node, lengths, contact.free, (gap, velocity), touching));
            self.store.write(node, 0, &[[velocity, gap]])?;
        }
        Ok(())
    }

    /// Takes in a step of each node, but for those of surfaces that slide.
    ///
    /// # Errors
    /// A temporary file that fails.
    pub(crate) fn push<const D: usize, const N: usize>(
        &mut self,
        problem: &Problem<D, N>,
        step: impl Fn(usize) -> NormalStep,
    ) -> Result<(), ScratchError> {
        self.store.extend()?;
        self.store.extend()?;
        let tolerance = problem.contact_tolerance();
        for (node, track) in self.all.iter_mut().enumerate() {
            if problem.surface().sliding_of(node).is_none() {
                track.push(&mut self.store, &step(node), tolerance)?;
            }
        }
        Ok(())
    }

    /// Takes in surfaces that slide at the end of a half step of this length (s), with displacement (m) and velocity
    /// (m/s) of the nodes of the mesh.
    ///
    /// # Errors
    /// A temporary file that fails.
    pub(crate) fn slide<const D: usize, const N: usize>(
        &mut self,
        problem: &Problem<D, N>,
        half: f64,
        motion: impl Fn(usize) -> [[f64; D]; 2],
    ) -> Result<(), ScratchError> {
        self.sliding.iter_mut().try_for_each(|sliding| sliding.push(problem, half, &motion))
    }

    /// Takes in which nodes of surfaces that slide touch at a step.
    pub(crate) fn touch<const D: usize, const N: usize>(
        &mut self,
        problem: &Problem<D, N>,
        step: usize,
        touching: &[bool],
    ) {
        self.sliding.iter_mut().for_each(|sliding| sliding.touch(problem, step, touching));
    }

    /// Takes in that no more steps come.
    ///
    /// # Errors
    /// A temporary file that fails.
    pub(crate) fn finish<const D: usize, const N: usize>(
        &mut self,
        problem: &Problem<D, N>,
    ) -> Result<(), ScratchError> {
        let Self { all, store, sliding, residuals } = self;
        for sliding in sliding {
            sliding.finish(problem, residuals, |node, from, motion| store.write(node, from, motion))?;
        }
        let tolerance = problem.contact_tolerance();
        for (node, track) in all.iter_mut().enumerate() {
            match problem.surface().sliding_of(node) {
                Some(_) => track.reach(store.count()),
                None => track.finish(store, tolerance)?,
            }
        }
        Ok(())
    }

    /// Two surfaces that slide at some instants that are at hand, in the admissible motion.
    ///
    /// # Errors
    /// A temporary file that fails.
    pub(crate) fn sliding<const D: usize, const N: usize>(
        &mut self,
        problem: &Problem<D, N>,
        index: usize,
        instants: Range<usize>,
    ) -> Result<Vec<SlidingInstant>, ScratchError> {
        let Self { all, sliding, .. } = self;
        sliding[index].instants(problem, instants, |node, instant| all[node].at(instant).1)
    }

    /// Number of instants at which the motion of all nodes is known; `None` without nodes.
    pub(crate) fn known(&self) -> Option<usize> {
        self.all.iter().map(ContactTrack::known).min()
    }

    /// Has the motion at hand from one known instant to another, and forgets that of earlier ones.
    ///
    /// # Errors
    /// A temporary file that fails.
    pub(crate) fn show(&mut self, instants: [usize; 2]) -> Result<(), ScratchError> {
        self.store.forget(instants[0]);
        self.all.iter_mut().try_for_each(|track| track.show(&mut self.store, instants))
    }

    /// What is known of surfaces that slide at the end of the run.
    pub(crate) fn surfaces(&self) -> Vec<SurfaceEstimate> {
        self.sliding.iter().map(SlidingMotion::summary).collect()
    }

    /// All of them.
    pub(crate) fn all(&self) -> &[ContactTrack] {
        &self.all
    }

    /// Adds the residuals of all nodes.
    pub(crate) fn report(&self, residuals: &mut Residuals) {
        self.all.iter().for_each(|track| track.report(residuals));
        residuals.merge(&self.residuals);
    }

    /// Takes any memory.
    #[cfg(test)]
    pub(crate) fn lift_limit(&mut self) {
        self.store.lift_limit();
    }

    /// Bytes in memory.
    #[cfg(test)]
    pub(crate) fn held(&self) -> usize {
        self.store.held()
    }
}
