//! The normal motion of all candidate nodes.

use super::contact_motion::{ContactMotion, NormalStep};
use super::non_matching::{NonMatchingInstant, NonMatchingMotion};
use super::normal_motions::{NormalMotions, most_bytes};
use crate::estimate::SurfaceEstimate;
use crate::residual::Residuals;
use crate::scratch_file::{ScratchError, ScratchFile};
use percute_core::problem::Problem;
use std::ops::Range;

/// The tracks of all candidate nodes of contact, and the store of their motion.
#[derive(Debug)]
pub(crate) struct ContactMotions {
    all: Vec<ContactMotion>,
    store: NormalMotions,
    /// The motions of non-matching interfaces. Their nodes have tracks of the change that it brings.
    non_matching: Vec<NonMatchingMotion>,
    residuals: Residuals,
}

impl ContactMotions {
    /// Those of a problem, which begin with the first step; so many half-step instants are at hand at a time.
    pub(crate) fn new<const D: usize>(problem: &Problem<D>, span: usize, file: ScratchFile) -> Self {
        let surface = problem.surface();
        Self {
            all: Vec::new(),
            store: NormalMotions::new(surface.nodes().len(), span, file),
            non_matching: (0..surface.non_matching().len())
                .map(|index| NonMatchingMotion::new(problem, index, span))
                .collect(),
            residuals: Residuals::default(),
        }
    }

    /// The most bytes that they take.
    pub(crate) fn memory<const D: usize>(problem: &Problem<D>, span: usize) -> usize {
        let nodes = problem.surface().nodes().len();
        let at_hand = nodes.saturating_mul(span).saturating_mul(size_of::<[f64; 2]>());
        let non_matching: usize =
            problem.surface().non_matching().iter().map(|non_matching| non_matching.positions().count()).sum();
        let non_matching = if non_matching > 0 { super::non_matching::memory(non_matching) } else { 0 };
        nodes * size_of::<ContactMotion>()
            + most_bytes(nodes, span).saturating_add(at_hand).saturating_add(non_matching)
    }

    /// Begins with the gap (m) and normal velocity (m/s) of each node at t = 0, and whether it touches.
    ///
    /// # Errors
    /// A temporary file that fails.
    pub(crate) fn begin<const D: usize>(
        &mut self,
        problem: &Problem<D>,
        start: impl Fn(usize) -> ((f64, f64), bool),
    ) -> Result<(), ScratchError> {
        self.store.extend()?;
        for (node, contact) in problem.surface().nodes().iter().enumerate() {
            if problem.surface().non_matching_of(node).is_some() {
                self.all.push(ContactMotion::of_change(node));
                continue;
            }
            let ((gap, velocity), touching) = start(node);
            let lengths = (contact.undeformed_gap, problem.mesh().size());
            self.all.push(ContactMotion::new(node, lengths, contact.free, (gap, velocity), touching));
            self.store.write(node, 0, &[[velocity, gap]])?;
        }
        Ok(())
    }

    /// Takes in a step of each node, but for those of non-matching interfaces.
    ///
    /// # Errors
    /// A temporary file that fails.
    pub(crate) fn push<const D: usize>(
        &mut self,
        problem: &Problem<D>,
        step: impl Fn(usize) -> NormalStep,
    ) -> Result<(), ScratchError> {
        self.store.extend()?;
        self.store.extend()?;
        let tolerance = problem.contact_tolerance();
        for (node, track) in self.all.iter_mut().enumerate() {
            if problem.surface().non_matching_of(node).is_none() {
                track.push(&mut self.store, &step(node), tolerance)?;
            }
        }
        Ok(())
    }

    /// Takes in non-matching interfaces at the end of a half step of this length (s), with displacement (m) and
    /// velocity (m/s) of the nodes of the mesh.
    ///
    /// # Errors
    /// A temporary file that fails.
    pub(crate) fn slide<const D: usize>(
        &mut self,
        problem: &Problem<D>,
        half: f64,
        motion: impl Fn(usize) -> [[f64; D]; 2],
    ) -> Result<(), ScratchError> {
        self.non_matching.iter_mut().try_for_each(|non_matching| non_matching.push(problem, half, &motion))
    }

    /// Takes in which nodes of non-matching interfaces touch at a step.
    pub(crate) fn touch<const D: usize>(&mut self, problem: &Problem<D>, step: usize, touching: &[bool]) {
        self.non_matching.iter_mut().for_each(|non_matching| non_matching.touch(problem, step, touching));
    }

    /// Takes in that no more steps come.
    ///
    /// # Errors
    /// A temporary file that fails.
    pub(crate) fn finish<const D: usize>(&mut self, problem: &Problem<D>) -> Result<(), ScratchError> {
        let Self { all, store, non_matching, residuals } = self;
        for non_matching in non_matching {
            non_matching.finish(problem, residuals, |node, from, motion| store.write(node, from, motion))?;
        }
        let tolerance = problem.contact_tolerance();
        for (node, track) in all.iter_mut().enumerate() {
            match problem.surface().non_matching_of(node) {
                Some(_) => track.reach(store.count()),
                None => track.finish(store, tolerance)?,
            }
        }
        Ok(())
    }

    /// A non-matching interface at some instants that are at hand, in the admissible motion.
    ///
    /// # Errors
    /// A temporary file that fails.
    pub(crate) fn non_matching<const D: usize>(
        &mut self,
        problem: &Problem<D>,
        index: usize,
        instants: Range<usize>,
    ) -> Result<Vec<NonMatchingInstant>, ScratchError> {
        let Self { all, non_matching, .. } = self;
        non_matching[index].instants(problem, instants, |node, instant| all[node].at(instant).1)
    }

    /// Number of instants at which the motion of all nodes is known; `None` without nodes.
    pub(crate) fn known(&self) -> Option<usize> {
        self.all.iter().map(ContactMotion::known).min()
    }

    /// Has the motion at hand from one known instant to another, and forgets that of earlier ones.
    ///
    /// # Errors
    /// A temporary file that fails.
    pub(crate) fn show(&mut self, instants: [usize; 2]) -> Result<(), ScratchError> {
        self.store.forget(instants[0]);
        self.all.iter_mut().try_for_each(|track| track.show(&mut self.store, instants))
    }

    /// What is known of non-matching interfaces at the end of the run.
    pub(crate) fn surfaces(&self) -> Vec<SurfaceEstimate> {
        self.non_matching.iter().map(NonMatchingMotion::summary).collect()
    }

    /// All of them.
    pub(crate) fn all(&self) -> &[ContactMotion] {
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
