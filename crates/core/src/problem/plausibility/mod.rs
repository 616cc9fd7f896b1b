//! What is possible, but more likely a slip: a mixture of units, a body that never touches, a run that is too short.

mod edge_exclusion;
mod motion;
mod moved;
mod spin;
mod time;
mod units;

pub use spin::SMALL_ROTATION;

use super::{Place, Problem, ProblemRef};
use crate::on_problem;
use crate::time::TimeGrid;
use std::fmt;

/// Something that may be meant, but more likely is not.
#[derive(Clone, Debug, PartialEq)]
pub struct PlausibilityWarning {
    /// Where.
    pub place: Place,
    /// Its name, for programs.
    pub name: &'static str,
    /// A few words.
    pub brief: String,
    /// What is the matter, with values and units, and what to do.
    pub message: String,
}

impl fmt::Display for PlausibilityWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.message)
    }
}

/// All plausibility warnings of a run, before its first step.
#[must_use]
pub fn plausibility_warnings<'p>(problem: impl Into<ProblemRef<'p>>, times: &TimeGrid) -> Vec<PlausibilityWarning> {
    warnings_of(problem.into(), times)
}

fn warnings_of(problem: ProblemRef<'_>, times: &TimeGrid) -> Vec<PlausibilityWarning> {
    on_problem!(problem, problem => all(problem, times))
}

fn all<const D: usize>(problem: &Problem<D>, times: &TimeGrid) -> Vec<PlausibilityWarning> {
    let mut all: Vec<_> = moved::plausibility_warnings(problem).collect();
    all.extend(units::plausibility_warnings(problem));
    // Checks that use the wave speed are left out if the units of the mesh or of a material are already in question.
    let mixed = all.iter().any(|plausibility_warning| {
        plausibility_warning.name == "units" && ["mesh", "material"].contains(&plausibility_warning.place.table)
    });
    let others =
        motion::plausibility_warnings(problem, times).into_iter().chain(time::plausibility_warnings(problem, times));
    let others =
        others.chain(edge_exclusion::plausibility_warnings(problem)).chain(spin::plausibility_warnings(problem, times));
    all.extend(
        others.filter(|plausibility_warning| {
            !mixed || !["supersonic", "single_step"].contains(&plausibility_warning.name)
        }),
    );
    all
}

/// What makes a start that the simulation refuses: more likely than a plane that is too near, a wrong unit.
#[derive(Clone, Debug)]
pub struct RefusedStart {
    /// The number and its unit.
    pub cause: PlausibilityWarning,
    /// Whether the number is hardly right; if not, the place of the body may be wrong as well.
    pub likely: bool,
}

/// The wrong unit that makes a start that the simulation refuses; `None` if all units seem to be right.
#[must_use]
pub fn cause_of_refused_start<'p>(problem: impl Into<ProblemRef<'p>>, times: &TimeGrid) -> Option<RefusedStart> {
    refused_start_of(problem.into(), times)
}

fn refused_start_of(problem: ProblemRef<'_>, times: &TimeGrid) -> Option<RefusedStart> {
    // The extent of the body does not change its waves.
    let units = |warning: &PlausibilityWarning| {
        ["units", "supersonic"].contains(&warning.name)
            && ["", "young", "density", "velocity"].contains(&warning.place.key)
    };
    if let Some(cause) = plausibility_warnings(problem, times).into_iter().find(units) {
        return Some(RefusedStart { cause, likely: true });
    }
    let size = on_problem!(problem, problem => problem.mesh().size());
    let cause = units::size_of_body(size, units::LARGE_IF_REFUSED)?;
    Some(RefusedStart { cause, likely: size > units::LARGE })
}

/// A plausibility warning about a key.
fn plausibility_warning(
    place: Place,
    name: &'static str,
    brief: impl Into<String>,
    message: impl Into<String>,
) -> PlausibilityWarning {
    PlausibilityWarning { place, name, brief: brief.into(), message: message.into() }
}

/// The place of a key in a table of which there may be several.
fn at(table: &'static str, index: Option<usize>, key: &'static str) -> Place {
    Place { table, index, key }
}
