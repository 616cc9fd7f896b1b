//! The instants in VTKHDF: a static mesh with fields over time.

use crate::error::FileCause;
use crate::library::refused;
use crate::write::{attribute, group, numbers, unit};
use hdf5::dataset::AllocTime;
use hdf5::{Extent, Group};

/// A name and its number of rows for each instant; none for a constant field.
pub(crate) type StepField<'a> = (&'a str, usize);

/// Creates `VTKHDF/Steps` for all these instants; only the first is visible to VTK at first.
pub(crate) fn write_steps(
    vtk: &Group,
    instants: &[f64],
    points: &[StepField<'_>],
    cells: &[StepField<'_>],
) -> Result<(), FileCause> {
    let steps = group(vtk, "Steps")?;
    let count = instants.len();
    attribute(&steps, "NSteps", 1_i64)?;
    // One chunk with space for all values; only their number grows.
    let values = steps.new_dataset::<f64>().shape(Extent::new(count, Some(count))).chunk([count]);
    let values = values.alloc_time(Some(AllocTime::Early)).create("Values").map_err(|error| refused(&error))?;
    values.resize([1]).and_then(|()| values.write_raw(&instants[..1])).map_err(|error| refused(&error))?;
    unit(&values, "s")?;
    let same = |value: i64| vec![value; count];
    for name in ["PartOffsets", "PointOffsets", "CellOffsets", "ConnectivityIdOffsets"] {
        numbers(&steps, name, &[count], &same(0))?;
    }
    numbers(&steps, "NumberOfParts", &[count], &same(1))?;
    for (group_name, fields) in [("PointDataOffsets", points), ("CellDataOffsets", cells)] {
        if fields.is_empty() {
            continue;
        }
        let offsets = group(&steps, group_name)?;
        for (name, rows) in fields {
            let starts: Vec<i64> = (0..count).map(|n| (n * rows) as i64).collect();
            numbers(&offsets, name, &[count], &starts)?;
        }
    }
    Ok(())
}

/// Writes the instants for VTK; [`note_steps`] then sets their number.
pub(crate) fn give_steps(vtk: &Group, instants: &[f64]) -> hdf5::Result<()> {
    let values = vtk.group("Steps")?.dataset("Values")?;
    values.resize([instants.len()])?;
    values.write_raw(instants)
}

/// Sets the number of instants for VTK. `Values` must have the same length: with more, VTK writes beyond its memory.
pub(crate) fn note_steps(vtk: &Group, count: usize) -> hdf5::Result<()> {
    vtk.group("Steps")?.attr("NSteps")?.write_scalar(&(count as i64))
}
