//! `[[obstacle]]`: rigid planes.

use super::source::CaseError;
use super::table::Table;
use percute_core::contact::{Obstacle, ObstacleError};
use percute_core::simplex::Shape;

/// Reads all planes.
pub(super) fn read<const D: usize>(root: &Table<'_>, shape: Shape) -> Result<Vec<Obstacle<D>>, CaseError> {
    root.tables("obstacle")?.iter().map(|table| one(table, shape)).collect()
}

fn one<const D: usize>(table: &Table<'_>, shape: Shape) -> Result<Obstacle<D>, CaseError> {
    table.only(&["point", "gap", "normal", "friction", "group"])?;
    let place = place(table)?;
    let normal = table.require("normal", "a vector from the plane to the body")?.vector("")?;
    let friction = friction(table, shape)?;
    let group = table.get("group").map(|value| value.text("the name of a group of edges")).transpose()?;
    let group = group.map(str::to_string);
    let made = match place {
        Place::Point(point) => Obstacle::plane(point, normal, friction, group),
        Place::Gap(gap) => Obstacle::plane_at_gap(gap, normal, friction, group),
    };
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

/// The place of a plane.
enum Place<const D: usize> {
    /// A point on it (m).
    Point([f64; D]),
    /// Its distance from the nearest node at the start (m).
    Gap(f64),
}

fn place<const D: usize>(table: &Table<'_>) -> Result<Place<D>, CaseError> {
    match (table.get("point"), table.get("gap")) {
        (Some(point), None) => point.vector("m").map(Place::Point),
        // A plane that the body strikes at once is moved away by the least gap.
        (None, Some(gap)) if gap.text("").is_ok_and(|name| name == "auto") => Ok(Place::Gap(0.0)),
        (None, Some(gap)) => match gap.number("m") {
            Ok(gap) => Ok(Place::Gap(gap)),
            Err(_) => Err(gap.must_be("\"auto\" or a number in m, 0 or more")),
        },
        (Some(_), Some(gap)) => Err(gap.error("is one too many: a plane has a `point` or a `gap`")),
        (None, None) => {
            Err(table.error("`point` is missing: give a point of the plane in m, or gap = \"auto\" for the least gap"))
        }
    }
}

/// Reads a coefficient of friction, which a bar does not have.
pub(super) fn friction(table: &Table<'_>, shape: Shape) -> Result<f64, CaseError> {
    match (table.get("friction"), shape) {
        (Some(value), _) => value.number(""),
        (None, Shape::Bar) => Ok(0.0),
        (None, Shape::Triangle) => table.require("friction", "the coefficient of friction, 0 or more")?.number(""),
    }
}
