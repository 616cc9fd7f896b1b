//! Pictures of the error of each element.

mod bar;
mod canvas;
mod file;
mod frame;
mod plane_body;

pub use file::{check_path, write};

use crate::case::Case;
use crate::report::Report;
use thiserror::Error;

/// Why a picture could not be drawn.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("the picture could not be drawn: {0}")]
pub struct DrawError(String);

impl DrawError {
    /// An error of the drawing library.
    fn from_library(error: impl std::fmt::Display) -> Self {
        Self(error.to_string())
    }
}

/// The error e_E of each element (eq. \[20\]) as an SVG document: on the mesh of a plane body, along
/// a bar.
///
/// # Errors
/// What the drawing library reports.
pub fn draw(case: &Case, report: &Report) -> Result<String, DrawError> {
    match case {
        Case::Bar(case) => bar::draw(case, report),
        Case::Plane(case) => plane_body::draw(case, report),
    }
}
