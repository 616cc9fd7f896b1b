//! Parts of messages: numbers with their units, names and their nearest spelling.

mod number;
mod spelling;

pub use number::{bytes, counted, percent, short, trimmed};
pub use spelling::{hint, list};
