//! Parts of messages: numbers with their units, names and their nearest spelling.

mod number;
mod printable;
mod spelling;

pub use number::{bytes, change, numbered, percent, signed_percent, times, vector, whole_percent};
pub use percute_core::message::{counted, rounded as short, trimmed};
pub use printable::printable;
pub use spelling::{hint, list};
