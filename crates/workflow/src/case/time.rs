//! `[time]`: the end of the run and its steps.

use super::source::CaseError;
use super::table::Table;
use super::value::Value;
use crate::message::trimmed;
use percute_core::time::{TimeError, TimeGrid, is_stable};

/// How the steps were stated.
enum Steps<'a> {
    Courant(f64, Value<'a>),
    Step(f64, Value<'a>),
    Each(Vec<f64>, Value<'a>),
}

/// The table, read but not yet compared with the critical step.
pub(super) struct Wanted<'a> {
    end: Option<(f64, Value<'a>)>,
    steps: Steps<'a>,
}

/// Reads the table.
pub(super) fn read<'a>(root: &Table<'a>) -> Result<Wanted<'a>, CaseError> {
    let table = root
        .single("time")?
        .ok_or_else(|| root.error("the table [time] is missing: give `end` in s and, say, courant = 0.9"))?;
    table.only(&["end", "courant", "step", "steps"])?;
    let ways: Vec<Value<'_>> = ["courant", "step", "steps"].iter().filter_map(|key| table.get(key)).collect();
    if ways.len() != 1 {
        let message = "needs exactly one of `courant` (0 to 1), `step` (s) and `steps` (a list in s)";
        let surplus = |second: &Value<'_>| second.error(format!("is one too many: [time] {message}"));
        return Err(ways.get(1).map_or_else(|| table.error(message), surplus));
    }
    let steps = if let Some(value) = table.get("courant") {
        let courant = value.number("")?;
        if !(courant > 0.0 && courant <= 1.0) {
            return Err(value.must_be("above 0 and at most 1: the step over the critical step"));
        }
        Steps::Courant(courant, value)
    } else if let Some(value) = table.get("step") {
        Steps::Step(positive(&value)?, value)
    } else {
        let value = table.require("steps", "a list in s")?;
        let steps = value.list("steps in s")?.iter().map(positive).collect::<Result<_, _>>()?;
        Steps::Each(steps, value)
    };
    let end = match (&steps, table.get("end")) {
        (_, Some(value)) => Some((positive(&value)?, value)),
        (Steps::Each(..), None) => None,
        (_, None) => return Err(table.error("`end` is missing: give the end of the run in s")),
    };
    Ok(Wanted { end, steps })
}

fn positive(value: &Value<'_>) -> Result<f64, CaseError> {
    let seconds = value.number("s")?;
    if seconds > 0.0 { Ok(seconds) } else { Err(value.must_be("a positive number in s")) }
}

impl Wanted<'_> {
    /// The instants, with no step above the critical one.
    pub(super) fn grid(&self, critical: f64) -> Result<TimeGrid, CaseError> {
        let end = self.end.as_ref().map_or(0.0, |(end, _)| *end);
        match &self.steps {
            Steps::Courant(courant, at) => TimeGrid::with_step(end, courant * critical).map_err(|e| refused(at, &e)),
            Steps::Step(step, at) => {
                below(*step, critical, at)?;
                TimeGrid::with_step(end, *step).map_err(|e| refused(at, &e))
            }
            Steps::Each(steps, at) => {
                let entries = at.list("steps in s")?;
                steps.iter().zip(&entries).try_for_each(|(step, entry)| below(*step, critical, entry))?;
                let grid = TimeGrid::from_steps(steps).map_err(|e| refused(at, &e))?;
                self.agrees(&grid)?;
                Ok(grid)
            }
        }
    }

    fn agrees(&self, grid: &TimeGrid) -> Result<(), CaseError> {
        match &self.end {
            Some((end, at)) if !grid.ends_at(*end) => {
                let (given, sum) = (at.shown(), trimmed(grid.end(), 10));
                Err(at.error(format!(
                    "is {given} s, but `steps` add up to {sum} s; leave `end` out or make the two agree"
                )))
            }
            _ => Ok(()),
        }
    }
}

fn below(step: f64, critical: f64, at: &Value<'_>) -> Result<(), CaseError> {
    if is_stable(step, critical) {
        return Ok(());
    }
    let given = at.shown();
    Err(at.error(format!(
        "is {given} s; it must be at most the critical step of this mesh, {critical:.7e} s, or the run is unstable: \
         give less, or courant = 0.9"
    )))
}

fn refused(at: &Value<'_>, error: &TimeError) -> CaseError {
    at.error(error.to_string())
}
