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
    table.only(&["point", "normal", "friction", "group"])?;
    let point = table.require("point", "a point of the plane in m")?.vector("m")?;
    let normal = table.require("normal", "a vector from the plane to the body")?.vector("")?;
    let friction = friction(table, shape)?;
    let group = table.get("group").map(|value| value.text("the name of a group of edges")).transpose()?;
    Obstacle::plane(point, normal, friction, group.map(str::to_string)).map_err(|error| {
        let key = match error {
            ObstacleError::Normal { .. } => "normal",
            ObstacleError::Point { .. } => "point",
            ObstacleError::Friction { .. } | ObstacleError::FrictionInOneDimension { .. } => "friction",
        };
        table.get(key).map_or_else(|| table.error(error.to_string()), |value| value.error(error.to_string()))
    })
}

/// Reads a coefficient of friction, which a bar does not have.
pub(super) fn friction(table: &Table<'_>, shape: Shape) -> Result<f64, CaseError> {
    match (table.get("friction"), shape) {
        (Some(value), _) => value.number(""),
        (None, Shape::Bar) => Ok(0.0),
        (None, Shape::Triangle) => table.require("friction", "the coefficient of friction, 0 or more")?.number(""),
    }
}
