//! What is doubtful about a case, at its line.

use super::{CaseOf, parsed, place};
use crate::case::table::Table;
use crate::info::memory;
use crate::report::number::bytes;
use crate::report::{Warning, few_samples};
use percute_core::problem::{Place, doubts};

impl<const D: usize, const N: usize> CaseOf<D, N> {
    /// What may be meant, but more likely is not, each with its line: to be told before the run. With `in_memory`, the
    /// history is kept in memory.
    #[must_use]
    pub fn doubts(&self, in_memory: bool) -> Vec<Warning> {
        let Ok(document) = parsed(&self.source) else { return Vec::new() };
        let root = Table::root(&self.source, document.get_ref());
        let located = |place: Place, name, brief: String, message: String| {
            let message = self.source.error(&place::find(&root, place), message).to_string();
            Warning { name, brief, message }
        };
        let stated = doubts(&self.problem, &self.times);
        let mut all: Vec<Warning> =
            stated.into_iter().map(|doubt| located(doubt.place, doubt.name, doubt.brief, doubt.message)).collect();
        all.extend(few_samples(self.options.every, self.times.step_count()).map(|few| {
            let place = Place { table: "estimate", index: None, key: "every" };
            located(place, few.name, few.brief, few.message)
        }));
        let needed = memory::of_case(self, in_memory);
        all.extend(memory::scarce(needed, memory::available(), in_memory).map(|message| {
            let place = Place { table: "mesh", index: None, key: "" };
            located(place, "memory", format!("the run needs {}", bytes(needed)), message)
        }));
        all
    }
}
