//! How good the estimate is in 2D: estimated over true error of impacts, against finer meshes.

mod body;
mod study;

pub(crate) use body::Body;
pub(crate) use study::{Case, Meshes};

pub(crate) type Failure = Box<dyn std::error::Error + Send + Sync>;
