//! Runs of one step or of millions, and tables that do not change while they last.

use super::{PlausibilityWarning, at, plausibility_warning};
use crate::border::Vector;
use crate::load::Table;
use crate::message::short;
use crate::problem::Problem;
use crate::time::TimeGrid;

/// More steps than this are more likely a slip in the end or in a unit.
const MANY_STEPS: usize = 1_000_000;
/// A table [`LONGER`] times the run is probably in other units if less than this part of its change precedes the end.
const UNUSED: f64 = 0.01;
/// A table that is shorter than so many times the run may extend beyond the end on purpose.
const LONGER: f64 = 100.0;

pub(super) fn plausibility_warnings<const D: usize>(
    problem: &Problem<D>,
    times: &TimeGrid,
) -> Vec<PlausibilityWarning> {
    let mut all: Vec<PlausibilityWarning> = steps(times.step_count(), times.end()).into_iter().collect();
    let stated = problem.conditions();
    let supports = stated
        .supports
        .iter()
        .enumerate()
        .filter_map(|(i, s)| Some((at("support", Some(i), "velocity"), s.velocity.as_ref()?)));
    let tractions = stated.tractions.iter().enumerate().map(|(i, t)| (at("traction", Some(i), "time"), &t.value));
    let forces = stated.body_forces.iter().enumerate().map(|(i, f)| (at("body_force", Some(i), "time"), &f.value));
    for (place, table) in supports.chain(tractions).chain(forces) {
        all.extend(unused(table, times.end()).map(|message| {
            plausibility_warning(
                place,
                "unused_table",
                format!("{}: hardly changes before `end`", place.table),
                message,
            )
        }));
    }
    all
}

fn steps(count: usize, end: f64) -> Option<PlausibilityWarning> {
    let place = at("time", None, "end");
    let shown = short(end);
    if count == 1 {
        let message = format!(
            "is {shown} s, at most one time step, too short for an impact: is it in seconds, and are lengths in metres?"
        );
        return Some(plausibility_warning(place, "single_step", "a run of one step", message));
    }
    if count <= MANY_STEPS {
        return None;
    }
    let message = format!("is {shown} s, which takes {count} steps: is it correct, and in seconds?");
    Some(plausibility_warning(place, "many_steps", format!("{count} steps"), message))
}

/// What is the matter with a table that changes after the end only.
fn unused(table: &Table, end: f64) -> Option<String> {
    let change = |from: &Vector, to: &Vector| from.iter().zip(to).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let start = table.at(0.0);
    let largest = table.value().iter().map(|value| change(&start, value)).fold(0.0, f64::max);
    let before = table.time().iter().filter(|t| (0.0..end).contains(*t)).chain([&end]);
    let used = before.map(|&t| change(&start, &table.at(t))).fold(0.0, f64::max);
    let last = table.time().last().copied().unwrap_or(0.0);
    if used >= UNUSED * largest || last <= LONGER * end {
        return None;
    }
    Some(format!(
        "its `time` runs to {} s, but the run to {} s only, and the table hardly changes by then: is `time` in \
         seconds?",
        short(last),
        short(end)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_of_one_step_and_of_more_than_a_million_have_warnings() {
        let name = |count| steps(count, 1.0).map(|plausibility_warning| plausibility_warning.name);
        assert_eq!([1, 2, MANY_STEPS, MANY_STEPS + 1].map(name), [Some("single_step"), None, None, Some("many_steps")]);
    }

    #[test]
    fn tables_that_change_in_time_have_no_warning() {
        let ramp = Table::new(vec![0.0, 10.0], vec![[0.0], [3.0]]).unwrap();
        assert!(unused(&ramp, 0.05).is_some_and(|message| message.contains("10 s")));
        assert_eq!(unused(&ramp, 0.11), None);
        let late = Table::new(vec![0.0, 10.0, 11.0], vec![[0.0], [0.0], [3.0]]).unwrap();
        assert_eq!(unused(&late, 1.0), None);
        assert_eq!(unused(&Table::constant([3.0]), 1e-9), None);
        // A pulse before the end counts, though it comes back to where it was.
        let pulse = Table::new(vec![0.0, 1.0, 2.0, 999.0], vec![[0.0], [1.0], [0.0], [1.0]]).unwrap();
        assert_eq!(unused(&pulse, 3.0), None);
    }
}
