//! The evidence: the paper's tables and figures, exact solutions, and how good the estimate is, computed again.
//!
//! A [`Part`] computes one [`Section`]: text, [`table::Table`]s and figures that are drawn from their numbers. A
//! [`Reproduction`] makes parts one after the other and keeps a folder with all that is done: a page, the figures, the
//! numbers. Nothing is read but what the program holds.

pub mod chart;
mod effort;
mod error;
mod folder;
pub mod pack;
mod page;
mod part;
mod raster;
mod section;
pub mod table;
mod tally;

pub use effort::Effort;
pub use error::ReproduceError;
pub use folder::{numbers, prepare};
pub use page::{html, markdown};
pub use part::PARTS;
pub use raster::{Raster, SCALE};
pub use section::{Figure, Item, Section};
pub use tally::{Tally, weight};

use percute_core::observer::Observer;
use percute_workflow::message::hint;
use std::path::{Path, PathBuf};

/// One part of the evidence.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// Its name on the command line.
    pub key: &'static str,
    /// What it shows, in a line.
    pub title: &'static str,
    /// Computes it.
    pub make: fn(&Effort, &mut dyn Observer) -> Result<Section, ReproduceError>,
}

/// The parts of these names, in the order of the page; all of them if none is named.
///
/// # Errors
/// [`ReproduceError::UnknownPart`].
pub fn parts<S: AsRef<str>>(names: &[S]) -> Result<Vec<Part>, ReproduceError> {
    let known = || PARTS.iter().map(|part| part.key);
    if let Some(name) = names.iter().map(AsRef::as_ref).find(|&name| known().all(|key| key != name)) {
        return Err(ReproduceError::UnknownPart {
            given: name.to_string(),
            hint: hint(name, known()),
            known: known().collect::<Vec<_>>().join(", "),
        });
    }
    let wanted = |part: &&Part| names.is_empty() || names.iter().any(|name| name.as_ref() == part.key);
    Ok(PARTS.iter().filter(wanted).copied().collect())
}

/// Parts on their way into a folder.
pub struct Reproduction {
    folder: PathBuf,
    effort: Effort,
    raster: Raster,
    sections: Vec<Section>,
}

impl Reproduction {
    /// Begins in a folder, which is made unless it is there.
    ///
    /// # Errors
    /// As [`prepare`].
    pub fn begin(folder: &Path, effort: Effort, overwrite: bool) -> Result<Self, ReproduceError> {
        prepare(folder, overwrite)?;
        Ok(Self { folder: folder.to_path_buf(), effort, raster: Raster::new(), sections: Vec::new() })
    }

    /// Computes a part and writes it; the page then shows it with those made before.
    ///
    /// # Errors
    /// [`ReproduceError::Interrupted`] if the observer breaks, [`ReproduceError::Part`] if the part fails: the folder
    /// then holds what it held before. What cannot be written.
    pub fn make(&mut self, part: &Part, observer: &mut dyn Observer) -> Result<(), ReproduceError> {
        let section = (part.make)(&self.effort, observer).map_err(|cause| match cause {
            ReproduceError::Interrupted => cause,
            cause => ReproduceError::Part { part: part.key, cause: Box::new(cause) },
        })?;
        folder::write_section(&self.folder, &section, &self.raster)?;
        self.sections.push(section);
        folder::write_pages(&self.folder, &self.sections, &self.effort)
    }

    /// The sections made so far.
    #[must_use]
    pub fn sections(&self) -> &[Section] {
        &self.sections
    }

    /// The page.
    #[must_use]
    pub fn page(&self) -> PathBuf {
        self.folder.join(folder::PAGE)
    }
}
