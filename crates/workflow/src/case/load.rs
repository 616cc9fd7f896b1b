//! `[[traction]]` and `[[body_force]]`: vectors that may vary in time.

use super::source::CaseError;
use super::table::Table as Keys;
use percute_core::load::{BodyForce, Profile, Table, TableError, Traction};

const IN_TIME: &str = "; for values in time give `time` too, the instant (s) of each";
const PROFILE: &str = "{ value = 1.0, gradient = [10.0, 0.0] }";

/// Reads all tractions.
pub(super) fn tractions(root: &Keys<'_>, dimension: usize) -> Result<Vec<Traction>, CaseError> {
    let one = |table: &Keys<'_>| {
        table.only()?;
        let group = table.require("group", "the name of a group of edges")?.text("the name of a group of edges")?;
        let profile = match table.get("profile") {
            None => Profile::UNIFORM,
            Some(value) => {
                let profile = value.table(PROFILE)?;
                let value = profile.require("value", "the factor at the origin")?.number("")?;
                let gradient =
                    profile.require("gradient", "the change of the factor in 1/m")?.vector("1/m", dimension)?;
                Profile { value, gradient }
            }
        };
        Ok(Traction { group: group.to_string(), value: table_in_time(table, "Pa", dimension)?, profile })
    };
    root.tables("traction")?.iter().map(one).collect()
}

/// Reads all body forces.
pub(super) fn body_forces(root: &Keys<'_>, dimension: usize) -> Result<Vec<BodyForce>, CaseError> {
    let one = |table: &Keys<'_>| {
        table.only()?;
        let group = table.get("group").map(|value| value.text("the name of a group of elements")).transpose()?;
        Ok(BodyForce { group: group.map(str::to_string), value: table_in_time(table, "N/m³", dimension)? })
    };
    root.tables("body_force")?.iter().map(one).collect()
}

/// A constant `value`, or `time` and as many values, joined by straight lines.
pub(super) fn table_in_time(table: &Keys<'_>, unit: &str, components: usize) -> Result<Table, CaseError> {
    let value = table.require("value", &format!("a value in {unit}, or one for each `time`"))?;
    let Some(time) = table.get("time") else {
        let constant = value.vector(unit, components);
        return constant
            .map(Table::constant)
            .map_err(|error| if value.is_list() { value.error(error.message + IN_TIME) } else { error });
    };
    Table::new(time.numbers("s")?, value.vectors(unit, components)?).map_err(|error| match error {
        TableError::Lengths { .. } | TableError::NotFinite { .. } => value.error(error.to_string()),
        TableError::Order { .. } => time.error(error.to_string()),
    })
}
