//! One of two dimensions: which one is known only once Python has said it.

use percute_core::mesh::{BarMesh, TriangleMesh};
use percute_core::problem::{BarProblem, TriangleProblem};
use std::sync::Arc;

/// Something of a bar or of a plane body.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Any<B, P> {
    /// Of a bar: 1D.
    Bar(B),
    /// Of a plane body: 2D.
    Plane(P),
}

/// A mesh of either dimension, shared.
pub(crate) type AnyMesh = Any<Arc<BarMesh>, Arc<TriangleMesh>>;
/// A problem of either dimension, shared.
pub(crate) type AnyProblem = Any<Arc<BarProblem>, Arc<TriangleProblem>>;

/// Does the same in both dimensions.
macro_rules! each {
    ($any:expr, $it:ident => $body:expr) => {
        match $any {
            $crate::any::Any::Bar($it) => $body,
            $crate::any::Any::Plane($it) => $body,
        }
    };
}

/// The same, keeping the dimension of the result.
macro_rules! map {
    ($any:expr, $it:ident => $body:expr) => {
        match $any {
            $crate::any::Any::Bar($it) => $crate::any::Any::Bar($body),
            $crate::any::Any::Plane($it) => $crate::any::Any::Plane($body),
        }
    };
}

pub(crate) use {each, map};
