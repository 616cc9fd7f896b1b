//! `[[support]]`: components of the motion that are prescribed.

use super::AXES;
use super::load::table_in_time;
use super::source::CaseError;
use super::table::Table as Keys;
use crate::message::{hint, list};
use percute_core::border::Vector;
use percute_core::load::{Support, Table};

const VELOCITY: &str = "{ time = [0.0, 1e-5], value = [0.0, 3.0] }";

/// Reads all supports.
pub(super) fn read(root: &Keys<'_>, dimension: usize) -> Result<Vec<Support>, CaseError> {
    root.tables("support")?.iter().map(|table| one(table, dimension)).collect()
}

fn one(table: &Keys<'_>, dimension: usize) -> Result<Support, CaseError> {
    table.only()?;
    let group = table.require("group", "the name of a group of edges")?.text("the name of a group of edges")?;
    let order = components(table, dimension)?;
    let mut components = [false; 3];
    order.iter().for_each(|&c| components[c] = true);
    let velocity = match table.get("velocity") {
        None => None,
        Some(value) => Some(motion(&value.table(VELOCITY)?, &order)?),
    };
    Ok(Support { group: group.to_string(), components, velocity })
}

/// Which components are named, in the order of the file.
fn components(table: &Keys<'_>, dimension: usize) -> Result<Vec<usize>, CaseError> {
    let value = table.require("components", "a list of axes, such as [\"x\"]")?;
    let mut order = Vec::new();
    for entry in value.list("axes, such as [\"x\"]")? {
        let name = entry.text("an axis")?;
        let known = AXES.iter().take(dimension).copied();
        let Some(axis) = known.clone().position(|axis| axis == name) else {
            return Err(entry.must_be(format!("one of {}{}", list(known.clone()), hint(name, known))));
        };
        if order.contains(&axis) {
            return Err(entry.error(format!("names `{name}` twice")));
        }
        order.push(axis);
    }
    if order.is_empty() {
        return Err(value.must_be("a list of one axis or more, such as [\"x\"]"));
    }
    Ok(order)
}

/// A velocity table: a number per instant for one component, else a list with an entry for each,
/// in their order.
fn motion(table: &Keys<'_>, order: &[usize]) -> Result<Table, CaseError> {
    let named = table_in_time(table, "m/s", order.len())?;
    let place = |value: &Vector| {
        let mut all = [0.0; 3];
        order.iter().zip(value).for_each(|(&axis, &v)| all[axis] = v);
        all
    };
    let values = named.value().iter().map(place).collect();
    Table::new(named.time().to_vec(), values).map_err(|error| table.error(error.to_string()))
}
