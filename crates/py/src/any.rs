//! Meshes and problems of either dimension, shared.

use percute_core::mesh::{BarMesh, TriangleMesh};
use percute_core::problem::{BarProblem, TriangleProblem};
use percute_core::simplex::ByDimension;
use std::sync::Arc;

/// A mesh of either dimension, shared.
pub(crate) type AnyMesh = ByDimension<Arc<BarMesh>, Arc<TriangleMesh>>;
/// A problem of either dimension, shared.
pub(crate) type AnyProblem = ByDimension<Arc<BarProblem>, Arc<TriangleProblem>>;
