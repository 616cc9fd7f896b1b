//! What all measurements of speed share: one block, its product K·u, and timed runs.

mod block;
mod csr;
mod order;
mod run;
mod setup;
mod small;
mod two_blocks;

pub use block::{Block, Motion, SIZES, material, problem};
pub use csr::Csr;
pub use order::Order;
pub use run::{Clock, estimated, processor, simulated, steps, wall};
pub use setup::setup;
pub use small::{Small, small};
pub use two_blocks::{Contact, two_blocks};

/// Any failure of a measurement.
pub type Failure = Box<dyn std::error::Error + Send + Sync>;
