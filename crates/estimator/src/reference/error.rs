//! What can keep a true error from being computed.

use percute_core::history::StepError;
use thiserror::Error;

/// Why a simulation could not be compared with its reference.
#[derive(Clone, Debug, Error, PartialEq)]
#[allow(missing_docs, reason = "the messages explain the fields")]
pub enum ReferenceError {
    /// A step that does not fit.
    #[error(transparent)]
    Step(#[from] StepError),
    /// Fields of another problem.
    #[error("{field} has {given} values, but the problem needs {needed}")]
    Length { field: &'static str, given: usize, needed: usize },
    /// Meshes that are not nested.
    #[error(
        "element {fine} of the reference mesh does not lie in one element of the mesh that is compared; \
         the reference must be made by cutting each element into smaller ones"
    )]
    NotNested { fine: usize },
    /// Meshes of which one has other bodies than the other.
    #[error(
        "the reference mesh has {fine} bodies and the mesh that is compared {coarse}, or they lie elsewhere; both must \
         be meshes of the same bodies"
    )]
    OtherBodies { fine: usize, coarse: usize },
    /// Outlines that are far from each other.
    #[error(
        "node {node} of the reference mesh lies outside the mesh that is compared, by more than the height of the \
         nearest element; both must be meshes of the same bodies"
    )]
    Outside { node: usize },
    /// Another body.
    #[error("the reference mesh covers {fine:.6e}, the mesh that is compared {coarse:.6e} (m in 1D, m² in 2D)")]
    DifferentBodies { fine: f64, coarse: f64 },
    /// A bar and a plane body.
    #[error("the reference has another dimension than the simulation that is compared")]
    Dimension,
    /// Small and finite kinematics.
    #[error("the reference has other kinematics than the simulation that is compared; give both the same")]
    Kinematics,
    /// Materials that yield in one of both only.
    #[error(
        "materials yield in the reference or in the simulation that is compared, but not in both; give both the same"
    )]
    Yielding,
    /// An exact elastic solution for a bar that yields.
    #[error("the exact solution is that of an elastic bar, and the material of the simulation yields")]
    ElasticSolution,
    /// A reference that stops too early.
    #[error("the reference ends at {reference:.6e} s, before the end of the simulation at {end:.6e} s")]
    EndsEarly { reference: f64, end: f64 },
    /// A simulation that is not the one the exact solution is for.
    #[error("`{name}` is {given:.9e} in the simulation and {exact:.9e} in the exact solution")]
    AnotherBar { name: &'static str, given: f64, exact: f64 },
}
