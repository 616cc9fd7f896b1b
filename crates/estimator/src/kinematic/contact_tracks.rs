//! The normal motion of all candidate nodes.

use super::contact_track::{ContactTrack, NormalStep};
use super::normal_motions::{NormalMotions, most_bytes};
use crate::residual::Residuals;
use crate::scratch_file::{ScratchError, ScratchFile};
use percute_core::problem::Problem;

/// The tracks of all candidate nodes of contact, and the store of their motion.
#[derive(Debug)]
pub(crate) struct ContactTracks {
    all: Vec<ContactTrack>,
    store: NormalMotions,
}

impl ContactTracks {
    /// Those of so many nodes, which begin with the first step; so many half-step instants are at hand at a time.
    pub(crate) fn new(nodes: usize, span: usize, file: ScratchFile) -> Self {
        Self { all: Vec::new(), store: NormalMotions::new(nodes, span, file) }
    }

    /// The most bytes that they take.
    pub(crate) fn memory(nodes: usize, span: usize) -> usize {
        let at_hand = nodes.saturating_mul(span).saturating_mul(size_of::<[f64; 2]>());
        nodes * size_of::<ContactTrack>() + most_bytes(nodes, span).saturating_add(at_hand)
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
            let ((gap, velocity), touching) = start(node);
            let lengths = (contact.undeformed_gap, problem.mesh().size());
            self.all.push(ContactTrack::new(node, lengths, contact.free, (gap, velocity), touching));
            self.store.write(node, 0, &[[velocity, gap]])?;
        }
        Ok(())
    }

    /// Takes in a step of each node.
    ///
    /// # Errors
    /// A temporary file that fails.
    pub(crate) fn push(&mut self, step: impl Fn(usize) -> NormalStep, tolerance: f64) -> Result<(), ScratchError> {
        self.store.extend()?;
        self.store.extend()?;
        let mut each = self.all.iter_mut().enumerate();
        each.try_for_each(|(node, track)| track.push(&mut self.store, &step(node), tolerance))
    }

    /// Takes in that no more steps come.
    ///
    /// # Errors
    /// A temporary file that fails.
    pub(crate) fn finish(&mut self, tolerance: f64) -> Result<(), ScratchError> {
        self.all.iter_mut().try_for_each(|track| track.finish(&mut self.store, tolerance))
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

    /// All of them.
    pub(crate) fn all(&self) -> &[ContactTrack] {
        &self.all
    }

    /// Adds the residuals of all nodes.
    pub(crate) fn report(&self, residuals: &mut Residuals) {
        self.all.iter().for_each(|track| track.report(residuals));
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
