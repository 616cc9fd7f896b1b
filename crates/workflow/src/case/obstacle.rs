//! `[[obstacle]]`: rigid planes.

use super::source::CaseError;
use super::table::Table;
use percute_core::contact::{AnyObstacle, ObstacleError, PlaneAt};

/// Reads all planes.
pub(super) fn read(root: &Table<'_>, dimension: usize) -> Result<Vec<AnyObstacle>, CaseError> {
    root.tables("obstacle")?.iter().map(|table| one(table, dimension)).collect()
}

fn one(table: &Table<'_>, dimension: usize) -> Result<AnyObstacle, CaseError> {
    table.only()?;
    let place = place(table, dimension)?;
    let normal = table.require("normal", "a vector from the plane to the body")?.vector("", dimension)?;
    let friction = friction(table, dimension)?;
    let group = table.get("group").map(|value| value.text("the name of a group of edges")).transpose()?;
    let group = group.map(str::to_string);
    let made = AnyObstacle::plane(dimension, place, &normal, friction, group);
    made.map_err(|error| {
        let key = match error {
            ObstacleError::Normal { .. } => "normal",
            ObstacleError::Point { .. } => "point",
            ObstacleError::Gap { .. } => "gap",
            ObstacleError::Friction { .. } | ObstacleError::FrictionInOneDimension { .. } => "friction",
        };
        table.get(key).map_or_else(|| table.error(error.to_string()), |value| value.error(error.to_string()))
    })
}

fn place(table: &Table<'_>, dimension: usize) -> Result<PlaneAt, CaseError> {
    match (table.get("point"), table.get("gap")) {
        (Some(point), None) => point.vector("m", dimension).map(PlaneAt::Point),
        // A plane that the body strikes at once is moved away by the least gap.
        (None, Some(gap)) if gap.text("").is_ok_and(|name| name == "auto") => Ok(PlaneAt::Gap(0.0)),
        (None, Some(gap)) => match gap.number("m") {
            Ok(gap) => Ok(PlaneAt::Gap(gap)),
            Err(_) => Err(gap.must_be("\"auto\" or a number in m, 0 or more")),
        },
        (Some(_), Some(gap)) => Err(gap.error("is one too many: a plane has a `point` or a `gap`")),
        (None, None) => {
            Err(table.error("`point` is missing: give a point of the plane in m, or gap = \"auto\" for the least gap"))
        }
    }
}

/// Reads a coefficient of friction, which a bar does not have.
pub(super) fn friction(table: &Table<'_>, dimension: usize) -> Result<f64, CaseError> {
    match (table.get("friction"), dimension) {
        (Some(value), _) => value.number(""),
        (None, 1) => Ok(0.0),
        (None, _) => table.require("friction", "the coefficient of friction, 0 or more")?.number(""),
    }
}
