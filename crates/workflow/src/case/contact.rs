//! `[[contact]]`: surfaces of two bodies that may touch.

use super::source::CaseError;
use super::table::Table;
use percute_core::contact::{Interface, ObstacleError};
use percute_core::simplex::Shape;

const GROUPS: &str = "the groups of edges of two bodies that may touch, such as [\"anvil.top\", \"hammer.bottom\"]";

/// Reads all interfaces.
pub(super) fn read<const D: usize>(root: &Table<'_>, shape: Shape) -> Result<Vec<Interface>, CaseError> {
    root.tables("contact")?.iter().map(|table| one::<D>(table, shape)).collect()
}

fn one<const D: usize>(table: &Table<'_>, shape: Shape) -> Result<Interface, CaseError> {
    table.only(&["groups", "friction"])?;
    let groups = table.require("groups", GROUPS)?;
    let names = groups.list("two groups of edges")?;
    let [first, second] = names.as_slice() else { return Err(groups.must_be(GROUPS)) };
    let [first, second] = [first, second].map(|name| name.text("the name of a group of edges"));
    let friction = super::obstacle::friction(table, shape)?;
    Interface::matching::<D>(first?, second?, friction).map_err(|error| {
        let key = match error {
            ObstacleError::Friction { .. } | ObstacleError::FrictionInOneDimension { .. } => "friction",
            ObstacleError::Normal { .. } | ObstacleError::Point { .. } => "groups",
        };
        table.get(key).map_or_else(|| table.error(error.to_string()), |value| value.error(error.to_string()))
    })
}
