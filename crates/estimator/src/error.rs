//! What can keep an estimate from being made.

use percute_core::dynamics::SimulationError;
use thiserror::Error;

/// Why an estimate could not be made.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum EstimateError {
    /// An option that must be positive.
    #[error("`{name}` is 0; it must be at least 1")]
    Zero {
        /// The option.
        name: &'static str,
    },
    /// No threads to work with.
    #[error("the threads of the estimate could not be started: {cause}")]
    Threads {
        /// Why.
        cause: String,
    },
    /// Not even one whole step.
    #[error("the history holds {count} instants; an estimate needs at least 2")]
    TooFewSteps {
        /// How many it holds.
        count: usize,
    },
    /// Steps that do not follow each other.
    #[error("step {given} came where step {expected} was expected; steps must come in order, from 0 to {last}")]
    Order {
        /// The step given.
        given: usize,
        /// The step expected.
        expected: usize,
        /// The last step of the time grid.
        last: usize,
    },
    /// A field of the wrong length.
    #[error("step {step}: {field} has {given} values, but the problem needs {needed}")]
    Length {
        /// The step.
        step: usize,
        /// Which field.
        field: &'static str,
        /// Its length.
        given: usize,
        /// The right one.
        needed: usize,
    },
    /// NaN or infinity.
    #[error("step {step}: {field} holds a value that is not finite at position {position}")]
    NotFinite {
        /// The step.
        step: usize,
        /// Which field.
        field: &'static str,
        /// Where.
        position: usize,
    },
    /// A step at another time than the grid's.
    #[error("step {step} is at {given:e} s, but the time grid has {expected:e} s there")]
    Time {
        /// The step.
        step: usize,
        /// Its time (s).
        given: f64,
        /// The time of the grid (s).
        expected: f64,
    },
    /// A first step that is not the initial state.
    #[error("the displacement of node {node} at step 0 is not the initial displacement of the problem")]
    Start {
        /// The node.
        node: usize,
    },
    /// A node that is said to touch at t = 0, but does not rest on its plane.
    #[error(
        "node {node} touches at step 0, but its gap is {gap:e} m and its normal velocity {speed:e} m/s; both must be zero"
    )]
    StartsTouching {
        /// The node.
        node: usize,
        /// Its gap (m).
        gap: f64,
        /// Its normal velocity (m/s).
        speed: f64,
    },
    /// Numbers too large to be squared and summed.
    #[error(
        "the error measure is not finite: some value of the problem (friction, load, stiffness) is out of all proportion"
    )]
    Overflow,
    /// A node that touches at step 1 from too near: no admissible velocity brings it to rest.
    #[error(
        "node {node} starts {gap:.6e} m from its plane and touches at step 1; no admissible motion exists \
         below a gap of {smallest_gap:.6e} m"
    )]
    StartsTooNear {
        /// The node.
        node: usize,
        /// Its gap (m).
        gap: f64,
        /// The smallest gap that will do (m).
        smallest_gap: f64,
    },
}

/// Why a run, simulation and estimate together, failed.
#[derive(Debug, Error)]
pub enum RunError {
    /// The simulation failed.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// The estimate failed.
    #[error(transparent)]
    Estimate(#[from] EstimateError),
}
