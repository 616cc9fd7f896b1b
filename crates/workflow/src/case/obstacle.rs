//! `[[obstacle]]`: rigid planes.

use super::source::CaseError;
use super::table::Table;
use percute_core::obstacle::{Plane, PlaneError};

/// Reads all planes.
pub(super) fn read<const D: usize>(root: &Table<'_>) -> Result<Vec<Plane<D>>, CaseError> {
    root.tables("obstacle")?.iter().map(one).collect()
}

fn one<const D: usize>(table: &Table<'_>) -> Result<Plane<D>, CaseError> {
    table.only(&["point", "normal", "friction", "group"])?;
    let point = table.require("point", "a point of the plane in m")?.vector("m")?;
    let normal = table.require("normal", "a vector from the plane to the body")?.vector("")?;
    let friction = match table.get("friction") {
        Some(value) => value.number("")?,
        None if D == 1 => 0.0,
        None => table.require("friction", "the coefficient of friction, 0 or more")?.number("")?,
    };
    let group = table.get("group").map(|value| value.text("the name of a group of edges")).transpose()?;
    Plane::new(point, normal, friction, group.map(str::to_string)).map_err(|error| {
        let key = match error {
            PlaneError::Normal { .. } => "normal",
            PlaneError::Point { .. } => "point",
            PlaneError::Friction { .. } | PlaneError::FrictionInOneDimension { .. } => "friction",
        };
        table.get(key).map_or_else(|| table.error(error.to_string()), |value| value.error(error.to_string()))
    })
}
