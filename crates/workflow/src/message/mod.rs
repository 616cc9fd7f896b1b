//! Parts of messages: numbers with their units, names and their nearest spelling.

mod number;
mod spelling;

pub use number::{bytes, change, counted, numbered, percent, short, times, trimmed, vector, whole_percent};
pub use spelling::{hint, list};
