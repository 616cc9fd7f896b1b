//! Plausibility warnings about a case, with their lines.

use super::{Case, parsed, place};
use crate::case::table::Table;
use crate::memory;
use crate::message::bytes;
use crate::report::{Warning, few_samples, varying_steps};
use percute_core::problem::{Place, PlausibilityWarning, plausibility_warnings};

impl Case {
    /// Statements that are possible but more likely slips, each with its line, for use before the run. With
    /// `in_memory`, the history is kept in memory.
    #[must_use]
    pub fn plausibility_warnings(&self, in_memory: bool) -> Vec<Warning> {
        let mut all = plausibility_warnings(&self.problem, &self.times);
        let at = |table, key, Warning { name, brief, message }| PlausibilityWarning {
            place: Place { table, index: None, key },
            name,
            brief,
            message,
        };
        let few = few_samples(self.options.every, self.times.step_count());
        all.extend(few.map(|few| at("estimate", "every", few)));
        let varying = varying_steps(&self.times, self.critical_step);
        all.extend(varying.map(|varying| at("time", "steps", varying)));
        let needed = self.memory(in_memory);
        all.extend(memory::scarce(needed, memory::available(), in_memory).map(|message| {
            let place = Place { table: "mesh", index: None, key: "" };
            PlausibilityWarning { place, name: "memory", brief: format!("the run needs {}", bytes(needed)), message }
        }));
        // The lines are looked up only if there is something to say: meshes as arrays make long texts.
        if all.is_empty() { Vec::new() } else { self.at_their_lines(all) }
    }

    /// What to say if there is no memory for the run, and where: a run of millions of steps is more likely a slip in
    /// the end.
    pub(super) fn lack_of_memory(&self, estimated: bool) -> Option<(Place, String)> {
        let simulation = || memory::of_run(&self.problem, &self.times);
        let told = memory::refusal(if estimated { self.memory(false) } else { simulation() })?;
        let warnings = plausibility_warnings(&self.problem, &self.times);
        let many = warnings.into_iter().find(|warning| warning.name == "many_steps");
        Some(match many {
            Some(many) => (many.place, format!("{} As it is, {told}", many.message)),
            None => (Place { table: "mesh", index: None, key: "" }, told),
        })
    }

    /// About how many bytes a run and its estimate take; with `in_memory`, its history too.
    fn memory(&self, in_memory: bool) -> u64 {
        let Self { problem, times, options, .. } = self;
        let estimate = percute_estimator::memory(problem, times, options) as u64;
        let history = if in_memory { memory::of_history(problem, times) } else { 0 };
        let contact = self.output.estimate.as_ref().map_or(0, |_| memory::of_contact(problem, times));
        [estimate, history, contact].into_iter().fold(memory::of_run(problem, times), u64::saturating_add)
    }

    fn at_their_lines(&self, plausibility_warnings: Vec<PlausibilityWarning>) -> Vec<Warning> {
        let Ok(document) = parsed(&self.source) else { return Vec::new() };
        let root = Table::root(&self.source, document.get_ref());
        let located = |PlausibilityWarning { place, name, brief, message }| {
            let message = self.source.error(&place::find(&root, place), message).to_string();
            Warning { name, brief, message }
        };
        plausibility_warnings.into_iter().map(located).collect()
    }
}
