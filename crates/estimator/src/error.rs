//! Reasons why an estimate cannot be made.

use crate::options::{MOST_THREADS, UnsuitableAcceleration};
use crate::request::RequestError;
use crate::scratch_file::ScratchError;
use percute_core::dynamics::SimulationError;
use percute_core::history::{SinkError, StepError};
use percute_core::message::{counted, trimmed};
use thiserror::Error;

/// Why an estimate could not be made.
#[derive(Clone, Debug, Error, PartialEq)]
#[allow(missing_docs, reason = "the messages explain the fields")]
pub enum EstimateError {
    /// An option that must be positive.
    #[error("`{name}` is 0; it must be at least 1")]
    Zero { name: &'static str },
    /// More threads than make sense.
    #[error("`threads` is {threads}; it must be a whole number from 1 to {MOST_THREADS}")]
    TooManyThreads { threads: usize },
    /// Choices that cannot be combined.
    #[error("`acceleration` {0}")]
    Acceleration(#[from] UnsuitableAcceleration),
    /// Maps that cannot be kept.
    #[error(transparent)]
    Request(#[from] RequestError),
    /// A non-matching interface, with a reconstruction that has none.
    #[error(
        "\"{}\" and \"{}\" are a non-matching interface, and only the reconstruction \"corrected\" estimates the error \
         of such contact; choose it, or define the contact as matching",
        .groups[0], .groups[1]
    )]
    NotMatching { groups: [String; 2] },
    /// A law for large displacements.
    #[error(
        "the error of bodies with finite kinematics is estimated by reconstruction = \"corrected\" with the \
         acceleration \"split\" or \"weak\" alone: give these, or leave both out"
    )]
    Finite,
    /// A body of tetrahedra, with a reconstruction that has none.
    #[error("the error of solids is estimated by reconstruction = \"corrected\" alone: give it, or leave the key out")]
    SolidReconstruction,
    /// No threads to work with.
    #[error("the threads of the estimate could not be started: {cause}")]
    Threads { cause: String },
    /// Not even one whole step.
    #[error("the history holds {}; an estimate needs at least 2", counted(*.count, "instant"))]
    TooFewSteps { count: usize },
    /// Stopped on a large mesh before any step was estimated.
    #[error("no step was estimated yet; on a mesh of this size a stop does not wait for it")]
    Stopped,
    /// A step that does not fit.
    #[error(transparent)]
    Step(#[from] StepError),
    /// A first step that is not the initial state.
    #[error("the displacement of node {node} at step 0 is not the initial displacement of the problem")]
    Start { node: usize },
    /// A first velocity that is not the initial one.
    #[error("the velocity of node {node} at step 0 is not the initial velocity of the problem")]
    StartVelocity { node: usize },
    /// A node that is said to touch at t = 0, but does not rest on its obstacle.
    #[error(
        "node {node} touches at step 0, but its gap is {} m and its normal velocity {} m/s; both must be zero",
        trimmed(*.gap, 5), trimmed(*.speed, 5)
    )]
    StartsTouching { node: usize, gap: f64, speed: f64 },
    /// Numbers too large to be squared and summed.
    #[error(
        "the error measure is not finite: some value of the problem (friction, load, stiffness) is far out of range"
    )]
    Overflow,
    /// A node that touches at step 1 from too near: no admissible velocity brings it to rest.
    #[error(
        "node {node} starts {} m from the plane or body that it may touch and touches at step 1; no admissible motion \
         exists below a gap of {} m: start further away; a history of another program needs a step of flight before it",
        // As it is printed it will do.
        trimmed(*.gap, 7), trimmed((1.0 + 1e-6) * *.smallest_gap, 7)
    )]
    StartsTooNear { node: usize, gap: f64, smallest_gap: f64 },
    /// A temporary file that failed.
    #[error(transparent)]
    Scratch(#[from] ScratchError),
    /// The auxiliary solution of `corrected` is unstable where the simulation is stable.
    #[error(
        "the auxiliary solution of `corrected` became unstable at step {step}, t = {} s: the steps of the history are \
         too long for its central differences (the longest is {} s), or density and stiffness are not those of the \
         simulation; correct them, estimate this history with reconstruction = \"consistent\", or store shorter steps",
        trimmed(*.time, 7), trimmed(*.longest_step, 5)
    )]
    AuxiliarySolution { step: usize, time: f64, longest_step: f64 },
    /// The same of a body that turns.
    #[error(
        "the auxiliary solution of `corrected` became unstable at step {step}, t = {} s, or an element of it was \
         turned inside out there: strains are too large for this mesh, or the steps of the history too long; take a \
         finer mesh, shorter steps, an earlier end or a lower speed",
        trimmed(*.time, 7)
    )]
    FiniteAuxiliarySolution { step: usize, time: f64 },
}

/// Why a simulation with its estimate, or the estimate of a history, failed.
#[derive(Debug, Error)]
pub enum RunError {
    /// The simulation failed.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// The estimate failed.
    #[error(transparent)]
    Estimate(#[from] EstimateError),
    /// The history could not be read.
    #[error("{0}")]
    Source(SinkError),
}
