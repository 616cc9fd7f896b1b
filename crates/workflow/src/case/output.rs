//! `[output]`: the files that a run makes.

use super::keep::{self, Keep};
use super::source::CaseError;
use super::table::Table;
use crate::choice::{late, nearest, too_late};
use percute_core::time::TimeGrid;
use percute_estimator::Request;
use percute_io::is_vtkhdf_name;
use std::path::PathBuf;

/// So many instants an estimate file holds unless told otherwise: enough to watch it, and small.
const INSTANTS: usize = 50;

/// The ending of histories and estimate files.
const VTKHDF: &str = "a name that ends in .vtkhdf, from which ParaView recognises it (`percute export` writes .vtu)";

/// What is missing where a key applies to a file that no run makes.
const HISTORY: &str = "applies to the file of the history; name one in [output], as in history = \"block.vtkhdf\", or \
                       leave this out";
const ESTIMATE: &str = "applies to the estimate file; name one in [output], as in estimate = \"error.vtkhdf\", or \
                        leave this out";

/// The files that a run makes. Paths are relative to the working directory, as those of the command
/// line are.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Output {
    /// The history: all steps.
    pub history: Option<PathBuf>,
    /// The estimate: what each element contributes at some instants.
    pub estimate: Option<PathBuf>,
    /// At which.
    pub instants: Instants,
    /// Whether the estimate file holds the admissible fields too.
    pub fields: bool,
    /// The part of the run that the history keeps.
    pub keep: Keep,
}

/// Instants of an estimate file.
#[derive(Clone, Debug, PartialEq)]
pub enum Instants {
    /// At most so many, evenly spaced, the first and the last among them.
    Count(usize),
    /// The sampled steps nearest to these times (s).
    Times(Vec<f64>),
}

impl Default for Instants {
    fn default() -> Self {
        Self::Count(INSTANTS)
    }
}

impl Instants {
    /// The steps of a run over these times whose error is sampled at every `every`-th step.
    #[must_use]
    pub fn steps(&self, times: &TimeGrid, every: usize) -> Vec<usize> {
        let wanted = match self {
            Self::Count(count) => return Request::evenly(times, *count, every).steps,
            Self::Times(wanted) => wanted,
        };
        let last = times.step_count();
        let sampled: Vec<usize> = (0..last).step_by(every).chain([last]).collect();
        let mut steps: Vec<usize> = wanted.iter().map(|&t| nearest(times.instants(), &sampled, t)).collect();
        steps.sort_unstable();
        steps.dedup();
        steps
    }

    /// What is wrong with the first instant that comes after the end of a run (s).
    #[must_use]
    pub fn after(&self, end: f64) -> Option<String> {
        let Self::Times(times) = self else { return None };
        let time = *times.iter().find(|&&time| late(time, end))?;
        Some(too_late(time, end))
    }
}

/// Reads the table; everything may be left out.
pub(super) fn read(root: &Table<'_>) -> Result<Output, CaseError> {
    let mut output = Output::default();
    let Some(table) = root.single("output")? else { return Ok(output) };
    table.only()?;
    output.keep.steps = keep::steps(&table)?;
    for (key, slot) in [("history", &mut output.history), ("estimate", &mut output.estimate)] {
        if let Some(value) = table.get(key) {
            let name = value.text("the name of a file")?;
            if name.is_empty() {
                return Err(value.must_be("the name of a file, such as \"block.vtkhdf\""));
            }
            if !is_vtkhdf_name(name.as_ref()) {
                return Err(value.must_be(VTKHDF));
            }
            *slot = Some(PathBuf::from(name));
        }
    }
    if let Some(value) = table.get("instants") {
        output.instants = if value.is_list() {
            let times = value.numbers("s")?;
            if times.is_empty() || times.iter().any(|&t| t < 0.0) {
                return Err(value.must_be("a list of one time or more, none of them negative (s)"));
            }
            Instants::Times(times)
        } else {
            Instants::Count(value.count(1)?)
        };
    }
    if let Some(value) = table.get("fields") {
        if value.is_list() {
            (output.keep.fields, output.fields) = keep::fields(&value)?;
        } else {
            let allowed = "true, false, or a list of names such as [\"displacement\", \"velocity\"]";
            output.fields = value.flag().map_err(|_| value.must_be(allowed))?;
        }
    }
    Ok(output)
}

/// Refuses instants after the end of the run: they are more likely in other units.
pub(super) fn check(root: &Table<'_>, output: &Output, end: f64) -> Result<(), CaseError> {
    let Some(table) = root.single("output")? else { return Ok(()) };
    keep::check(&table, &output.keep, end)?;
    let Instants::Times(times) = &output.instants else { return Ok(()) };
    let (Some(at), Some(value)) = (times.iter().position(|&t| late(t, end)), table.get("instants")) else {
        return Ok(());
    };
    let entry = value.list("")?.swap_remove(at);
    Err(entry.error(output.instants.after(end).unwrap_or_default()))
}

/// Refuses keys that say something about a file that no run makes, history or estimate file.
pub(super) fn check_files(root: &Table<'_>, output: &Output, [history, estimate]: [bool; 2]) -> Result<(), CaseError> {
    let Some(table) = root.single("output")? else { return Ok(()) };
    let of_history = |key| (key, history, HISTORY);
    let of_estimate = |key| (key, estimate, ESTIMATE);
    let mut all = vec![of_history("every"), of_history("times"), of_estimate("instants")];
    all.extend(output.keep.fields.is_some().then_some(of_history("fields")));
    all.extend(output.fields.then_some(of_estimate("fields")));
    let mut unused = all.into_iter().filter(|(_, made, _)| !made);
    let first = unused.find_map(|(key, _, file)| Some(table.get(key)?.error(file)));
    first.map_or(Ok(()), Err)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_sampled_steps_are_taken_once() {
        let times = TimeGrid::uniform(1.0, 10).unwrap();
        let steps = |wanted: &[f64], every| Instants::Times(wanted.to_vec()).steps(&times, every);
        assert_eq!(steps(&[0.96, 0.0, 0.44, 0.41], 1), [0, 4, 10]);
        // Sampled are 0, 3, 6, 9 and the end.
        assert_eq!(steps(&[0.16, 0.4, 9.0], 3), [3, 10]);
        assert_eq!(steps(&[0.04], 100), [0]);
    }
}
