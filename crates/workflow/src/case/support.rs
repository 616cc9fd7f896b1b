//! `[[support]]`: components of the motion that are prescribed.

use super::AXES;
use super::load::table_in_time;
use super::source::CaseError;
use super::table::Table as Keys;
use crate::message::{hint, list};
use percute_core::load::{Support, Table};

const VELOCITY: &str = "{ time = [0.0, 1e-5], value = [0.0, 3.0] }";

/// Reads all supports.
pub(super) fn read<const D: usize>(root: &Keys<'_>) -> Result<Vec<Support<D>>, CaseError> {
    root.tables("support")?.iter().map(one).collect()
}

fn one<const D: usize>(table: &Keys<'_>) -> Result<Support<D>, CaseError> {
    table.only(&["group", "components", "velocity"])?;
    let group = table.require("group", "the name of a group of edges")?.text("the name of a group of edges")?;
    let order = components::<D>(table)?;
    let mut components = [false; D];
    order.iter().for_each(|&c| components[c] = true);
    let velocity = match table.get("velocity") {
        None => None,
        Some(value) => Some(motion(&value.table(&["time", "value"], VELOCITY)?, &order)?),
    };
    Ok(Support { group: group.to_string(), components, velocity })
}

/// Which components are named, in the order of the file.
fn components<const D: usize>(table: &Keys<'_>) -> Result<Vec<usize>, CaseError> {
    let value = table.require("components", "a list of axes, such as [\"x\"]")?;
    let mut order = Vec::new();
    for entry in value.list("axes, such as [\"x\"]")? {
        let name = entry.text("an axis")?;
        let known = AXES.iter().take(D).copied();
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
fn motion<const D: usize>(table: &Keys<'_>, order: &[usize]) -> Result<Table<D>, CaseError> {
    match order.len() {
        1 => spread(&table_in_time::<1>(table, "m/s")?, table, order),
        2 => spread(&table_in_time::<2>(table, "m/s")?, table, order),
        _ => spread(&table_in_time::<3>(table, "m/s")?, table, order),
    }
}

/// Puts the components named into their places.
fn spread<const C: usize, const D: usize>(
    named: &Table<C>,
    table: &Keys<'_>,
    order: &[usize],
) -> Result<Table<D>, CaseError> {
    let place = |value: &[f64; C]| {
        let mut all = [0.0; D];
        order.iter().zip(value).for_each(|(&axis, &v)| all[axis] = v);
        all
    };
    let values = named.value().iter().map(place).collect();
    Table::new(named.time().to_vec(), values).map_err(|error| table.error(error.to_string()))
}
