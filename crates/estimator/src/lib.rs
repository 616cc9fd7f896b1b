//! The constitutive relation error of an explicit impact simulation.
//!
//! From the steps of a simulation, an [`Estimator`] builds fields that satisfy the kinematics
//! exactly and fields that satisfy equilibrium exactly. It measures by how much they miss the
//! material, inertia and contact laws (eq. \[14\]). The origin of the steps does not matter.
//!
//! Equation numbers in brackets are those of Louf, Gallimard and Pelle, *Un estimateur d'erreur en
//! relation de comportement pour les problèmes d'impact*. All units are SI.
//!
#![doc = include_str!("method.md")]

mod acceleration;
mod blocks;
mod components;
mod concentrated;
mod contact_density;
mod deformation;
mod difference;
mod direction;
mod element;
mod error;
mod estimate;
mod estimator;
mod field_lanes;
mod increment;
mod inertia;
mod kinematic;
mod loaded;
mod map;
mod measure;
mod nodal_field;
mod numbers;
mod options;
mod parallel;
mod partition;
mod pipeline;
mod plastic;
mod pool;
mod reconstruction;
pub mod reference;
mod replay;
mod request;
mod residual;
mod sampling;
mod scratch_file;
mod smoothing;
mod sources;
mod stress;
mod time_level;
mod traction;

pub use error::{EstimateError, RunError};
pub use estimate::{ErrorMeasures, Estimate, Parts, Sample, Supplied, SurfaceEstimate};
pub use estimator::{Estimator, estimate, memory};
pub use map::{AdmissibleFields, ElementMap};
pub use options::{Ablation, Acceleration, MOST_THREADS, Options, Reconstruction, UnknownName, UnsuitableAcceleration};
pub use request::{Request, RequestError};
pub use residual::Residuals;
pub use sampling::{Sampling, UnknownSampling};
pub use scratch_file::ScratchError;
pub use sources::{Separation, Sources};
