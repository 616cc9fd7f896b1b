//! Reads an estimate file except its maps, which are only checked.

use super::maps::{fields, has_admissible, instants, size};
use crate::error::{FileCause, FileError};
use crate::history::{case, provenance};
use crate::kind::Kind;
use crate::mesh;
use crate::read::{Data, Opened, Part, reading};
use crate::write::{Case, Provenance};
use percute_core::mesh::Mesh;
use percute_estimator::{Parts, Sample};
use std::path::Path;

/// The contents of an estimate file.
#[derive(Clone, Debug)]
pub struct EstimateFile {
    /// Size of the file (bytes).
    pub bytes: u64,
    /// Its writer.
    pub provenance: Provenance,
    /// The problem in the language of the case files.
    pub statement: String,
    /// The case file as given.
    pub case: Option<Case>,
    /// The document that `--json` printed.
    pub report: String,
    /// 1 (bars), 2 (triangles) or 3 (tetrahedra).
    pub dimension: usize,
    /// Number of nodes.
    pub nodes: usize,
    /// Number of elements.
    pub elements: usize,
    /// The mesh.
    pub mesh: Mesh,
    /// Instants of the maps (s).
    pub instants: Vec<f64>,
    /// Whether the maps hold admissible fields.
    pub fields: bool,
    /// η and d over time.
    pub over_time: Vec<Sample>,
    /// e_E of each element (J^½), eq. \[20\].
    pub by_element: Vec<f64>,
}

/// Opens an estimate file.
///
/// # Errors
/// As for a history: a file that is missing, locked, damaged, of another program, another kind or another
/// layout; a part that is missing, or of a wrong type or shape.
pub fn open(path: impl AsRef<Path>) -> Result<EstimateFile, FileError> {
    reading(path.as_ref(), |opened| {
        opened.expect(Kind::Estimate)?;
        contents(opened)
    })
}

fn contents(opened: &Opened) -> Result<EstimateFile, FileCause> {
    let root = opened.root();
    let (vtk, ours) = (root.group("VTKHDF")?, root.group("percute")?);
    let [dimension, nodes, elements] = size(&vtk, &ours)?;
    let mesh = mesh::read(opened, dimension)?;
    let by_element = vtk.group("CellData")?.data("by_element")?;
    by_element.expect(&[mesh.element_count()], "one for each element")?;
    let instants = instants(&vtk)?;
    fields(&vtk, [dimension, nodes, elements], instants.len())?;
    let text = |name: &str| -> Result<String, FileCause> {
        let missing = || FileCause::MissingPart { name: format!("percute/{name}") };
        ours.optional_text(name)?.ok_or_else(missing)
    };
    Ok(EstimateFile {
        bytes: opened.bytes(),
        provenance: provenance(&ours)?,
        statement: text("problem")?,
        case: case(&ours)?,
        report: text("report")?,
        dimension,
        nodes,
        elements,
        mesh,
        fields: !instants.is_empty() && has_admissible(&vtk)?,
        instants,
        over_time: over_time(&ours.group("over_time")?)?,
        by_element: finite(&by_element)?,
    })
}

/// Numbers of the elements, all of them finite.
fn finite(data: &Data<'_>) -> Result<Vec<f64>, FileCause> {
    let values = data.floats()?;
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(values),
        Some(element) => {
            let detail = format!("element {element} has {}; all values must be finite", values[element]);
            Err(FileCause::Value { name: data.name.clone(), detail })
        }
    }
}

fn over_time(group: &Part<'_>) -> Result<Vec<Sample>, FileCause> {
    let time = column(group, "time", None)?;
    let of = |name| column(group, name, Some(time.len()));
    let [kinetic, elastic, contact, reference] = [of("kinetic")?, of("elastic")?, of("contact")?, of("reference")?];
    // Files without it are those of elastic materials.
    let dissipation = match group.optional("dissipation")? {
        Some(_) => of("dissipation")?,
        None => vec![0.0; time.len()],
    };
    // The sum of the parts is computed again.
    of("total")?;
    let sample = |k: usize| {
        let [kinetic, elastic, dissipation, contact] = [&kinetic, &elastic, &dissipation, &contact].map(|part| part[k]);
        let parts = Parts { kinetic, elastic, dissipation, contact };
        Sample { time: time[k], parts, reference: reference[k] }
    };
    Ok((0..time.len()).map(sample).collect())
}

fn column(group: &Part<'_>, name: &str, length: Option<usize>) -> Result<Vec<f64>, FileCause> {
    let data = group.data(name)?;
    data.expect_dimensions(1, "(instants)")?;
    if let Some(length) = length {
        data.expect(&[length], "one for each instant")?;
    }
    data.floats()
}
