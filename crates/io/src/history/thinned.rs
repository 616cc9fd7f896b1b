//! Histories that lack steps or fields of their run.

use super::file::HistoryFile;
use super::stored_part::ThinnedSteps;
use crate::error::{FileCause, FileError};

impl HistoryFile {
    /// Whether the file has velocities and accelerations, its own or those of the scheme.
    #[must_use]
    pub fn stored(&self) -> [bool; 2] {
        self.contents.stored
    }

    /// The steps of a thinned history in its run; none if the file has all.
    #[must_use]
    pub fn thinned_steps(&self) -> Option<&ThinnedSteps> {
        self.contents.kept.as_ref()
    }

    /// Whether the file lacks the reactions of its run.
    #[must_use]
    pub fn lacks_reactions(&self) -> bool {
        self.contents.lacks_reactions
    }

    /// Makes sure that all steps and reactions are there.
    ///
    /// # Errors
    /// A thinned history.
    pub fn expect_all(&self) -> Result<(), FileError> {
        let Some(kept) = self.thinned_steps() else { return Ok(()) };
        let (held, of) = (self.count(), kept.times.instants().len());
        let reactions = if self.lacks_reactions() { " and no reactions" } else { "" };
        Err(FileCause::Thinned { held, of, reactions }.at(self.path()))
    }
}
