//! The part of a run that its history keeps: `every`, `times` and `fields` of `[output]`.

use super::source::CaseError;
use super::table::Table;
use super::value::Value;
use crate::choice::{StepChoice, late, too_late};
use crate::message::hint;
use percute_core::time::TimeGrid;
use percute_io::history::StoredPart;

/// Fields of a history.
pub const FIELDS: [&str; 4] = ["displacement", "velocity", "acceleration", "reaction"];
/// The name in `fields` for the admissible fields of the estimate file.
const ADMISSIBLE: &str = "admissible";

/// The part of a run that its history keeps; by default all.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Keep {
    /// Its steps; the first and the last are kept as well.
    pub steps: StepChoice,
    /// Names out of [`FIELDS`]; displacements are always kept. By default all, if steps are left out.
    pub fields: Option<Vec<String>>,
}

impl Keep {
    /// What the history of a run over these instants keeps; none if all.
    #[must_use]
    pub fn of(&self, times: &TimeGrid) -> Option<StoredPart> {
        if self.steps == StepChoice::All && self.fields.is_none() {
            return None;
        }
        let last = times.step_count();
        // Times were checked; a step after the last has no place.
        let mut steps = self.steps.of(times.instants()).unwrap_or_default();
        steps.extend([0, last]);
        steps.sort_unstable();
        steps.dedup();
        let has = |name: &str| self.fields.as_ref().is_none_or(|fields| fields.iter().any(|field| field == name));
        Some(StoredPart { steps, velocity: has(FIELDS[1]), acceleration: has(FIELDS[2]), reaction: has(FIELDS[3]) })
    }

    /// The fault of a name of a field, if it is none of a history.
    #[must_use]
    pub fn unknown(name: &str) -> Option<String> {
        let wrong = !FIELDS.contains(&name);
        wrong.then(|| {
            format!("{name:?} is no field of a history; choose from {}{}", FIELDS.join(", "), hint(name, FIELDS))
        })
    }
}

/// Reads `every` and `times`.
pub(super) fn steps(table: &Table<'_>) -> Result<StepChoice, CaseError> {
    match (table.get("every"), table.get("times")) {
        (Some(_), Some(times)) => Err(times.error("is given beside `every`; give one of them")),
        (Some(every), None) => every.count(1).map(StepChoice::Every),
        (None, Some(value)) => {
            let times = value.numbers("s")?;
            if times.is_empty() || times.iter().any(|&t| t < 0.0) {
                return Err(value.must_be("a list of one time or more, none of them negative (s)"));
            }
            Ok(StepChoice::Times(times))
        }
        (None, None) => Ok(StepChoice::All),
    }
}

/// Reads a list of `fields`: those of the history, if it names any, and whether the estimate file has the admissible
/// ones.
pub(super) fn fields(value: &Value<'_>) -> Result<(Option<Vec<String>>, bool), CaseError> {
    let (mut kept, mut admissible) = (Vec::new(), false);
    for entry in value.list("names")? {
        match entry.text("the name of a field")? {
            ADMISSIBLE => admissible = true,
            name => match Keep::unknown(name) {
                Some(told) => return Err(entry.error(format!("{told}; \"admissible\" are those of the estimate file"))),
                None => kept.push(name.to_string()),
            },
        }
    }
    Ok(((!kept.is_empty()).then_some(kept), admissible))
}

/// Refuses times after the end of the run.
pub(super) fn check(table: &Table<'_>, keep: &Keep, end: f64) -> Result<(), CaseError> {
    let (StepChoice::Times(times), Some(value)) = (&keep.steps, table.get("times")) else { return Ok(()) };
    match times.iter().position(|&t| late(t, end)) {
        Some(at) => Err(value.list("")?.swap_remove(at).error(too_late(times[at], end))),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_and_the_last_step_are_kept() {
        let times = TimeGrid::uniform(1.0, 10).unwrap();
        let keep = |steps, fields: Option<&[&str]>| {
            let fields = fields.map(|names| names.iter().map(ToString::to_string).collect());
            Keep { steps, fields }.of(&times)
        };
        assert_eq!(keep(StepChoice::All, None), None);
        let kept = keep(StepChoice::Times(vec![0.42]), None).unwrap();
        assert_eq!((kept.steps, kept.velocity, kept.acceleration, kept.reaction), (vec![0, 4, 10], true, true, true));
        let kept = keep(StepChoice::Every(4), Some(&["velocity"])).unwrap();
        assert_eq!(
            (kept.steps, kept.velocity, kept.acceleration, kept.reaction),
            (vec![0, 4, 8, 10], true, false, false)
        );
        assert_eq!(keep(StepChoice::All, Some(&["reaction"])).unwrap().steps.len(), 11);
    }
}
