//! Histories in files.

mod checkpoints;
mod elsewhere;
mod file;
mod native;
mod nodal;
mod open;
mod plan;
mod queue;
mod recover;
mod resume;
mod rows;
mod source;
mod stored_part;
mod sums;
mod thinned;
mod writer;

pub use elsewhere::Elsewhere;
pub use file::{HistoryFile, NativeArray};
pub use open::open;
pub(crate) use open::{case, provenance};
pub use plan::Plan;
pub use recover::{Recovered, recover};
pub use resume::Unended;
pub use source::{HistorySource, StoredSteps};
pub use stored_part::{StoredPart, ThinnedSteps};
pub use writer::Writer;

/// Path of the displacements in a file.
const DISPLACEMENT: &str = "VTKHDF/PointData/displacement";
/// The internal variables of the elements, among the fields of cells.
const PLASTIC: &str = "plastic";
