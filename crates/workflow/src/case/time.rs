//! `[time]`: the end of the run and its steps.

use super::source::CaseError;
use super::table::Table;
use super::value::Value;
use crate::message::trimmed;
use crate::report::unstable_steps;
use crate::until::{Until, no_rebound};
use percute_core::problem::AnyProblem;
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
    rebound: Option<UntilRebound<'a>>,
    steps: Steps<'a>,
}

/// `end = "rebound"`: its place, the latest end, and how long the run goes on after contact (s).
struct UntilRebound<'a> {
    end: Value<'a>,
    longest: f64,
    after: Option<f64>,
}

/// Reads the table.
pub(super) fn read<'a>(root: &Table<'a>) -> Result<Wanted<'a>, CaseError> {
    let table = root
        .single("time")?
        .ok_or_else(|| root.error("the table [time] is missing: give `end` in s and, say, courant = 0.9"))?;
    table.only()?;
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
    let rebound = rebound(&table, &steps)?;
    let end = match (&steps, table.get("end")) {
        _ if rebound.is_some() => None,
        (_, Some(value)) => Some((positive(&value)?, value)),
        (Steps::Each(..), None) => None,
        (_, None) => return Err(table.error("`end` is missing: give the end of the run in s")),
    };
    Ok(Wanted { end, rebound, steps })
}

/// Reads `end = "rebound"`, and the keys that need it.
fn rebound<'a>(table: &Table<'a>, steps: &Steps<'_>) -> Result<Option<UntilRebound<'a>>, CaseError> {
    let Some(end) = table.get("end").filter(|end| end.text("").is_ok()) else {
        let surplus = ["longest", "after"].iter().find_map(|key| table.get(key));
        let refuse = |value: Value<'_>| Err(value.error("needs end = \"rebound\": give this, or leave the key out"));
        return surplus.map_or(Ok(None), refuse);
    };
    if end.text("")? != "rebound" {
        return Err(end.must_be("a positive number in s, or \"rebound\""));
    }
    if let Steps::Each(_, at) = steps {
        return Err(at.error("have an end of their own: with end = \"rebound\" give `courant` or `step`"));
    }
    let at = table.get("longest").ok_or_else(|| end.error("needs `longest`: the latest end in s"))?;
    let after = table.get("after").map(|after| positive(&after)).transpose()?;
    Ok(Some(UntilRebound { longest: positive(&at)?, end, after }))
}

fn positive(value: &Value<'_>) -> Result<f64, CaseError> {
    let seconds = value.number("s")?;
    if seconds > 0.0 { Ok(seconds) } else { Err(value.must_be("a positive number in s")) }
}

impl Wanted<'_> {
    /// The end with the rebound, if the run ends so; it needs a plane.
    pub(super) fn until(&self, problem: &AnyProblem, critical: f64) -> Result<Option<Until>, CaseError> {
        let Some(UntilRebound { end, longest, after }) = &self.rebound else { return Ok(None) };
        if let Some(told) = no_rebound(problem) {
            return Err(end.error(format!("= {told}")));
        }
        Ok(Some(Until::new(problem, *longest, *after, self.first_step(critical))))
    }

    /// The Courant number, if that was stated.
    pub(super) fn courant(&self) -> Option<f64> {
        match self.steps {
            Steps::Courant(courant, _) => Some(courant),
            Steps::Step(..) | Steps::Each(..) => None,
        }
    }

    /// The first step as it was stated (s): before it is fitted to an end, which hardly makes it longer.
    pub(super) fn first_step(&self, critical: f64) -> f64 {
        match &self.steps {
            Steps::Courant(courant, _) => courant * critical,
            Steps::Step(step, _) => *step,
            Steps::Each(steps, _) => steps.first().copied().unwrap_or(critical),
        }
    }

    /// The instants, with no step above the critical one; to the latest end, if the run ends with the rebound.
    pub(super) fn grid(&self, critical: f64) -> Result<TimeGrid, CaseError> {
        let latest = self.rebound.as_ref().map_or(0.0, |rebound| rebound.longest);
        let end = self.end.as_ref().map_or(latest, |(end, _)| *end);
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
                unstable_steps(&grid, critical).map_or(Ok(grid), |told| Err(at.error(told)))
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
