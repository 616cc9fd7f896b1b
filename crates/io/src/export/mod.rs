//! Fields at chosen instants in files for ParaView: one VTKHDF file, or a VTU file for each instant with an index
//! (PVD).

mod base64;
mod series;
mod vtkhdf;
mod vtu;

pub use crate::mesh::in_space;
pub use series::{Format, UnknownFormat};

use crate::create::Overwrite;
use crate::error::FileError;
use percute_core::mesh::Mesh;
use series::Series;
use std::path::{Path, PathBuf};
use vtkhdf::Single;

/// The place of the rows of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldPlace {
    /// One row for each node.
    Nodes,
    /// One row for each element.
    Elements,
}

/// A field of an export.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExportField {
    /// Its name in the file.
    pub name: &'static str,
    /// Its unit; in VTKHDF an attribute.
    pub unit: &'static str,
    /// Numbers in a row: 1, 3 (a vector) or 9 (a tensor).
    pub components: usize,
    /// Its place.
    pub place: FieldPlace,
}

/// What an export holds: fields over instants, each a step of the run and its time (s).
#[derive(Clone, Copy, Debug)]
pub struct Contents<'a> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// The fields.
    pub fields: &'a [ExportField],
    /// Steps and times (s), ascending.
    pub instants: &'a [(usize, f64)],
}

impl Contents<'_> {
    fn rows(&self, place: FieldPlace) -> usize {
        match place {
            FieldPlace::Nodes => self.mesh.node_count(),
            FieldPlace::Elements => self.mesh.element_count(),
        }
    }
}

/// Writes an export, instant after instant. Without [`ExportWriter::finish`] no file remains.
pub struct ExportWriter<'a>(WriterKind<'a>);

enum WriterKind<'a> {
    Single(Single<'a>),
    Series(Series<'a>),
}

impl<'a> ExportWriter<'a> {
    /// Begins an export; the ending of the name says its format.
    ///
    /// # Errors
    /// An existing file, a folder that is missing or not writable, a disk without enough space.
    pub fn new(path: &Path, format: Format, overwrite: Overwrite, contents: Contents<'a>) -> Result<Self, FileError> {
        Ok(Self(match format {
            Format::Vtkhdf => WriterKind::Single(Single::new(path, overwrite, contents)?),
            Format::Vtu | Format::Pvd => WriterKind::Series(Series::new(path, format, overwrite, contents)),
        }))
    }

    /// Writes the next instant: the rows of each field.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn push(&mut self, values: &[Vec<f64>]) -> Result<(), FileError> {
        match &mut self.0 {
            WriterKind::Single(single) => single.push(values),
            WriterKind::Series(series) => series.push(values),
        }
    }

    /// Completes the export and returns its files, first the one to open.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn finish(self) -> Result<Vec<PathBuf>, FileError> {
        match self.0 {
            WriterKind::Single(single) => single.finish(),
            WriterKind::Series(series) => series.finish(),
        }
    }
}
