//! Sweeps: a case over values of its keys.
//!
//! The way of the data: a sweep file or Python gives [`Values`]; with a case they make a [`Plan`], one case text for
//! each list of values; [`run`] runs each in a process of its own and a folder of its own, which appears complete or
//! not at all; [`columns`] reads the documents of all runs into one table. A case is done if its folder has its text
//! and a document of this version, so that the same sweep may be run again and again, by several machines, too.

mod attempt;
mod key;
mod name;
mod plan;
mod pool;
mod table;
mod values;

pub use attempt::{State, keep_results};
pub use key::Key;
pub use plan::{Plan, Planned};
pub use pool::{Count, ENDS_WITH_INPUT, Launch, run};
pub use table::{Column, columns, states, write};
pub use values::{Values, from_json};
