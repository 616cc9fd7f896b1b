//! Pictures of the error of each element.

mod bar;
pub(crate) mod canvas;
mod file;
mod frame;
mod plane_body;

pub use file::{check_path, write};

use percute_core::problem::{BarProblem, TriangleProblem};
use percute_workflow::report::Report;
use thiserror::Error;

/// Why a picture could not be drawn.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("the picture could not be drawn: {0}")]
pub struct DrawError(String);

impl DrawError {
    /// An error of the drawing library.
    pub(crate) fn from_library(error: impl std::fmt::Display) -> Self {
        Self(error.to_string())
    }
}

/// A body whose error can be drawn.
pub trait Drawn {
    /// The error e_E of each element (eq. \[20\]) as an SVG document: on the mesh of a plane body, along a
    /// bar.
    ///
    /// # Errors
    /// What the drawing library reports.
    fn draw(&self, report: &Report) -> Result<String, DrawError>;
}

impl Drawn for BarProblem {
    fn draw(&self, report: &Report) -> Result<String, DrawError> {
        bar::draw(self, report)
    }
}

impl Drawn for TriangleProblem {
    fn draw(&self, report: &Report) -> Result<String, DrawError> {
        plane_body::draw(self, report)
    }
}
