//! Fields of an estimate file over the instants of its maps.

use crate::error::{FileCause, FileError};
use crate::kind::Kind;
use crate::read::{Data, Part, reading};
use std::path::Path;

/// The contributions of the elements at the instants, and the admissible fields if present.
#[derive(Clone, Debug)]
pub struct Maps {
    /// The instants (s).
    pub instants: Vec<f64>,
    /// Their fields, as `docs/estimate.md` names them.
    pub fields: Vec<Field>,
}

/// A field over the instants.
#[derive(Clone, Debug)]
pub struct Field {
    /// Name of its data set.
    pub name: &'static str,
    /// Instants, nodes or elements, and components unless there is one.
    pub shape: Vec<usize>,
    /// Its numbers.
    pub values: Vec<f64>,
}

/// Reads the maps.
///
/// # Errors
/// As [`open`](super::open).
pub fn maps(path: impl AsRef<Path>) -> Result<Maps, FileError> {
    reading(path.as_ref(), |opened| {
        opened.expect(Kind::Estimate)?;
        let root = opened.root();
        let vtk = root.group("VTKHDF")?;
        let size = size(&vtk, &root.group("percute")?)?;
        let instants = instants(&vtk)?;
        let stored = fields(&vtk, size, instants.len())?;
        let read = |field: &Stored<'_>| {
            let Stored { name, ref shape, ref data } = *field;
            Ok(Field { name, shape: shape.clone(), values: data.floats()? })
        };
        Ok(Maps { fields: stored.iter().map(read).collect::<Result<_, FileCause>>()?, instants })
    })
}

/// Dimension, number of nodes and number of elements.
pub(super) type Size = [usize; 3];

/// A field whose shape and type have been checked.
pub(super) struct Stored<'f> {
    name: &'static str,
    shape: Vec<usize>,
    data: Data<'f>,
}

/// The instants of the maps (s); none without `Steps`, which must be there if fields are.
pub(super) fn instants(vtk: &Part<'_>) -> Result<Vec<f64>, FileCause> {
    let mapped = vtk.group("CellData")?.optional("kinetic")?.is_some();
    let steps = if mapped { Some(vtk.group("Steps")?) } else { vtk.optional_group("Steps")? };
    let Some(steps) = steps else { return Ok(Vec::new()) };
    let count = steps.integer_attribute("NSteps")?;
    let values = steps.data("Values")?;
    values.expect(&[usize::try_from(count).unwrap_or(0)], "one for each of `NSteps`")?;
    values.floats()
}

/// Finds all fields; none without instants.
pub(super) fn fields<'f>(vtk: &Part<'f>, size: Size, instants: usize) -> Result<Vec<Stored<'f>>, FileCause> {
    let [dimension, nodes, elements] = size;
    if instants == 0 {
        return Ok(Vec::new());
    }
    let cells = vtk.group("CellData")?;
    let mut all = Vec::new();
    let mut add = |part: &Part<'f>, name, rows, components| -> Result<(), FileCause> {
        all.push(found(part, name, [instants, rows, components])?);
        Ok(())
    };
    // Files without it are those of elastic materials.
    let dissipates = cells.optional("dissipation")?.is_some();
    for name in ["kinetic", "elastic", "dissipation", "contact", "total", "accumulated"] {
        if dissipates || name != "dissipation" {
            add(&cells, name, elements, 1)?;
        }
    }
    if has_admissible(vtk)? {
        let points = vtk.group("PointData")?;
        add(&points, "admissible_displacement", nodes, 3)?;
        add(&points, "admissible_velocity", nodes, 3)?;
        add(&cells, "admissible_stress", elements, dimension * dimension)?;
        add(&cells, "compatible_stress", elements, dimension * dimension)?;
        add(&cells, "admissible_acceleration", elements, 3)?;
    }
    Ok(all)
}

/// Whether there are admissible fields.
pub(super) fn has_admissible(vtk: &Part<'_>) -> Result<bool, FileCause> {
    if vtk.group("CellData")?.optional("admissible_stress")?.is_some() {
        return Ok(true);
    }
    // Contact results are nodal fields as well, but not admissible fields.
    let Some(points) = vtk.optional_group("PointData")? else { return Ok(false) };
    Ok(points.names()?.iter().any(|name| name.starts_with("admissible")))
}

fn found<'f>(part: &Part<'f>, name: &'static str, shape: [usize; 3]) -> Result<Stored<'f>, FileCause> {
    let [instants, rows, components] = shape;
    let data = part.data(name)?;
    // A single component has no dimension of its own.
    if components == 1 {
        data.expect(&[instants * rows], "instants x elements")?;
    } else {
        data.expect(&[instants * rows, components], "instants x nodes or elements, components")?;
    }
    data.check_floats()?;
    let dimensions = if components == 1 { 2 } else { 3 };
    Ok(Stored { name, shape: shape[..dimensions].to_vec(), data })
}

/// Dimension, and numbers of nodes and elements.
pub(super) fn size(vtk: &Part<'_>, ours: &Part<'_>) -> Result<Size, FileCause> {
    let dimension = ours.integer_attribute("dimension")?;
    if !(1..=3).contains(&dimension) {
        let known = "1 (bars), 2 (triangles) or 3 (tetrahedra)";
        let detail = format!("{dimension} is not a known dimension; it must be {known}");
        return Err(FileCause::Value { name: "percute.dimension".to_string(), detail });
    }
    let points = vtk.data("Points")?;
    points.expect_dimensions(2, "(nodes, 3)")?;
    let by_element = vtk.group("CellData")?.data("by_element")?;
    by_element.expect_dimensions(1, "(elements)")?;
    Ok([dimension as usize, points.shape[0], by_element.shape[0]])
}
