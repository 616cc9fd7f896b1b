//! A file for each instant, with an index.

use super::{Contents, vtu};
use crate::create::{Overwrite, whole};
use crate::error::FileError;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The format of an export.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// One HDF5 file with all instants.
    Vtkhdf,
    /// An XML file for each instant; with several instants also an index beside them.
    Vtu,
    /// The same, named after the index.
    Pvd,
}

/// A name whose ending is that of no format.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error(
    "the name must end in .vtkhdf (one file with all instants), .vtu or .pvd (a file for each instant and an index)"
)]
pub struct UnknownFormat;

impl Format {
    /// The format of a name, by its ending.
    ///
    /// # Errors
    /// Another ending.
    pub fn of(path: &Path) -> Result<Self, UnknownFormat> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        match ending.as_deref() {
            Some("vtkhdf") => Ok(Self::Vtkhdf),
            Some("vtu") => Ok(Self::Vtu),
            Some("pvd") => Ok(Self::Pvd),
            _ => Err(UnknownFormat),
        }
    }

    /// All files of an export of these steps, first the one to open.
    #[must_use]
    pub fn files(self, path: &Path, steps: &[usize]) -> Vec<PathBuf> {
        if self == Self::Vtkhdf || (self == Self::Vtu && steps.len() == 1) {
            return vec![path.to_path_buf()];
        }
        let digits = steps.last().map_or(1, |last| last.to_string().len());
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let each = steps.iter().map(|step| path.with_file_name(format!("{stem}_{step:0digits$}.vtu")));
        std::iter::once(path.with_extension("pvd")).chain(each).collect()
    }
}

/// An export in several files. Those written are removed if it is not finished.
pub(super) struct Series<'a> {
    contents: Contents<'a>,
    overwrite: Overwrite,
    files: Vec<PathBuf>,
    /// Whether the first file is an index.
    index: bool,
    written: usize,
    finished: bool,
}

impl<'a> Series<'a> {
    pub(super) fn new(path: &Path, format: Format, overwrite: Overwrite, contents: Contents<'a>) -> Self {
        let steps: Vec<usize> = contents.instants.iter().map(|(step, _)| *step).collect();
        let files = format.files(path, &steps);
        let index = files.len() > steps.len();
        Self { contents, overwrite, files, index, written: 0, finished: false }
    }

    /// The files of the instants.
    fn each(&self) -> &[PathBuf] {
        &self.files[usize::from(self.index)..]
    }

    pub(super) fn push(&mut self, values: &[Vec<f64>]) -> Result<(), FileError> {
        let (_, time) = self.contents.instants[self.written];
        let (path, text) = (&self.each()[self.written], vtu::text(&self.contents, time, values));
        whole(path, self.overwrite, &text).map_err(|cause| cause.at(path))?;
        self.written += 1;
        Ok(())
    }

    pub(super) fn finish(mut self) -> Result<Vec<PathBuf>, FileError> {
        if self.index {
            let path = &self.files[0];
            whole(path, self.overwrite, self.collection().as_bytes()).map_err(|cause| cause.at(path))?;
        }
        self.finished = true;
        Ok(std::mem::take(&mut self.files))
    }

    /// The index: a time and the name of a file in the same folder for each instant.
    fn collection(&self) -> String {
        let mut text =
            String::from("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n");
        for ((_, time), file) in self.contents.instants.iter().zip(self.each()) {
            let name = escaped(&file.file_name().unwrap_or_default().to_string_lossy());
            // Writing to a text does not fail.
            let _ = writeln!(text, "<DataSet timestep=\"{time:?}\" part=\"0\" file=\"{name}\"/>");
        }
        text + "</Collection>\n</VTKFile>\n"
    }
}

impl Drop for Series<'_> {
    fn drop(&mut self) {
        if !self.finished {
            for file in self.each().iter().take(self.written) {
                let _ = std::fs::remove_file(file);
            }
        }
    }
}

/// A text as the value of an attribute in XML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}
