//! The instants, as VTKHDF has them: a static mesh under fields that change.

use crate::create::refused;
use crate::error::FileCause;
use crate::write::{attribute, group, numbers, unit};
use hdf5::Group;

/// A name and how many rows of it an instant has; none for a field that does not change.
type Field<'a> = (&'a str, usize);

/// Makes `VTKHDF/Steps`, of which VTK reads the first `valid` instants.
pub(crate) fn write_steps(
    vtk: &Group,
    instants: &[f64],
    valid: usize,
    points: &[Field<'_>],
    cells: &[Field<'_>],
) -> Result<(), FileCause> {
    let steps = group(vtk, "Steps")?;
    attribute(&steps, "NSteps", valid as i64)?;
    let count = instants.len();
    unit(&numbers(&steps, "Values", &[count], instants)?, "s")?;
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

/// Notes how many instants VTK may read.
pub(crate) fn note_steps(file: &hdf5::File, count: usize) -> Result<(), FileCause> {
    let noted = file
        .group("VTKHDF/Steps")
        .and_then(|steps| steps.attr("NSteps"))
        .and_then(|attribute| attribute.write_scalar(&(count as i64)));
    noted.map_err(|error| refused(&error))
}
