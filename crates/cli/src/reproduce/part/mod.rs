//! The parts, in the order of the page.

mod block;
mod table1;

use super::Part;

/// All parts, in the order of the page.
pub const PARTS: &[Part] = &[table1::PART];
