//! The checksums of a history: one of all that does not change in time, and one of each field at each instant.

use super::elsewhere::Elsewhere;
use super::rows::FIELDS;
use crate::checksum::Checksum;
use crate::error::FileCause;
use crate::read::{Opened, Part};
use crate::write::Case;
use percute_core::mesh::Mesh;
use std::ops::Range;

/// The checksum of all that does not change in time: mesh, initial velocity, texts (statement, case and origin),
/// instants and contact nodes. `run` has all instants of the run of a thinned history, and is empty for others.
pub(super) fn fixed_part(
    mesh: &Mesh,
    initial_velocity: &[f64],
    (statement, case, elsewhere): (&str, Option<&Case>, Option<&Elsewhere>),
    [times, run]: [&[f64]; 2],
    contact_nodes: impl IntoIterator<Item = usize>,
) -> i64 {
    let all = Checksum::new().mesh(mesh).numbers(initial_velocity).text(statement);
    let all = case.map_or(all, |case| all.text(&case.name).text(&case.text));
    let all = elsewhere
        .map_or(all, |origin| all.text(&origin.program).text(&origin.derived()).numbers(&origin.initial_displacement));
    let all = all.numbers(times).indices(contact_nodes);
    if run.is_empty() { all.stored() } else { all.numbers(run).stored() }
}

/// Compares the stored checksum of that part.
pub(super) fn check_fixed_part(ours: &Part<'_>, found: i64) -> Result<(), FileCause> {
    let Some(stored) = ours.optional("checksum")? else { return Ok(()) };
    if stored.integers()? == [found] {
        return Ok(());
    }
    Err(FileCause::Checksum {
        name: "mesh, initial fields, statement, case, program, instants or contact nodes".to_string(),
        step: None,
    })
}

/// Compares the checksums of a field at some instants with those of the numbers read, `row` for each instant.
pub(super) fn check_rows<T>(
    opened: &Opened,
    field: &str,
    steps: Range<usize>,
    values: &[T],
    sum: impl Fn(&[T]) -> Checksum,
) -> Result<(), FileCause> {
    let ours = opened.root().group("percute")?;
    let Some(stored) = ours.optional("checksums")? else { return Ok(()) };
    let rows = stored.integer_rows(steps.clone())?;
    let row = values.len() / steps.len().max(1);
    let found = (0..steps.len()).map(|k| sum(&values[k * row..(k + 1) * row]));
    compare(field, steps, found, &rows)
}

/// Compares the checksums found of a field at some instants with the rows of `checksums` there.
pub(super) fn compare(
    field: &str,
    steps: impl ExactSizeIterator<Item = usize>,
    found: impl Iterator<Item = Checksum>,
    rows: &[i64],
) -> Result<(), FileCause> {
    let Some(column) = FIELDS.iter().position(|name| *name == field) else { return Ok(()) };
    let width = rows.len() / steps.len().max(1);
    let differs = |(k, (_, sum)): &(usize, (usize, Checksum))| rows.get(width * k + column) != Some(&sum.stored());
    match steps.zip(found).enumerate().find(differs) {
        None => Ok(()),
        Some((_, (step, _))) => Err(FileCause::Checksum { name: field.to_string(), step: Some(step) }),
    }
}

/// The checksum of nodal vectors.
pub(super) fn of_vectors(values: &[f64]) -> Checksum {
    Checksum::new().numbers(values)
}

/// The checksum of touching status.
pub(super) fn of_flags(values: &[bool]) -> Checksum {
    Checksum::new().indices(values.iter().map(|&touches| touches.into()))
}
