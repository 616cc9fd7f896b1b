//! Opens a history file: everything but the steps is read and checked.

use super::elsewhere::Elsewhere;
use super::file::{FileContents, HistoryFile, Identity};
use super::nodal::{finite, nodal};
use super::rows::sums_at_an_instant;
use super::stored_part;
use super::sums::{check_fixed_part, check_rows, fixed_part, of_vectors};
use super::{DISPLACEMENT, PLASTIC};
use crate::error::{FileCause, FileError};
use crate::kind::Kind;
use crate::mesh::{read, vectors};
use crate::read::{Data, Opened, Part, reading};
use crate::write::{Case, Provenance};
use percute_core::material::VonMises;
use percute_core::time::TimeGrid;
use std::path::Path;
use std::sync::Arc;

/// Opens a history.
///
/// # Errors
/// A file that is missing, locked, damaged, of another program, another kind or another layout; a part that
/// is missing, or of a wrong type, shape or value.
pub fn open(path: impl AsRef<Path>) -> Result<HistoryFile, FileError> {
    let path = path.as_ref();
    let identity = Identity::of(path).map_err(|cause| cause.at(path))?;
    reading(path, |opened| contents(path, identity, opened))
}

/// The dimension of a history; any other file is refused.
fn dimension(opened: &Opened) -> Result<usize, FileCause> {
    opened.expect(Kind::History)?;
    match opened.root().group("percute")?.integer_attribute("dimension")? {
        dimension @ 1..=3 => Ok(dimension as usize),
        other => {
            let detail =
                format!("{other} is not a known dimension; it must be 1 (bars), 2 (triangles) or 3 (tetrahedra)");
            Err(FileCause::Value { name: "percute.dimension".to_string(), detail })
        }
    }
}

/// Whether a history has checksums: then one for each field at each instant.
fn has_checksums(ours: &Part<'_>, instants: usize, yields: bool) -> Result<bool, FileCause> {
    let Some(sums) = ours.optional("checksums")? else { return Ok(false) };
    sums.expect(&[instants, sums_at_an_instant(yields)], "one for each field at each instant")?;
    Ok(true)
}

pub(super) fn contents(path: &Path, identity: Identity, opened: &Opened) -> Result<HistoryFile, FileCause> {
    let (root, d) = (opened.root(), dimension(opened)?);
    let (vtk, ours) = (root.group("VTKHDF")?, root.group("percute")?);
    let mesh = Arc::new(read(opened, d)?);
    let nodes = mesh.node_count();
    let times = times(&vtk, &ours)?;
    let instants = times.instants().len();
    let (count, complete) = written(&vtk, &ours, instants)?;
    let (initial_displacement, stored) = fields(&vtk, instants, [nodes, d])?;
    let plastic = plastic(&vtk, instants, [mesh.element_count(), d])?;
    let kept = stored_part::read(&ours, times.instants())?;
    // Motion by the scheme follows from all steps as well.
    let supplied = if ours.has_attribute("by_scheme") { [false; 2] } else { stored };
    let initial_velocity = nodal(&ours, "initial_velocity", [nodes, d])?;
    let (contact_nodes, supplied_contact) = contact(&ours, instants, nodes, d)?;
    let statement =
        ours.optional_text("problem")?.ok_or_else(|| FileCause::MissingPart { name: "percute/problem".to_string() })?;
    let (case, provenance, elsewhere) = (case(&ours)?, provenance(&ours)?, Elsewhere::read(&ours, [nodes, d])?);
    let checksums = provenance.is_percute() && has_checksums(&ours, instants, plastic > 0)?;
    if checksums {
        let nodes = contact_nodes.iter().copied();
        let run = kept.as_ref().map_or(&[][..], |kept| kept.times.instants());
        let texts = (statement.as_str(), case.as_ref(), elsewhere.as_ref());
        check_fixed_part(&ours, fixed_part(&mesh, &initial_velocity, texts, [times.instants(), run], nodes))?;
        if count > 0 {
            check_rows(opened, "displacement", 0..1, &initial_displacement, of_vectors)?;
        }
        check_seen(&vtk, count, complete)?;
    }
    Ok(HistoryFile::new(FileContents {
        path: path.to_path_buf(),
        identity,
        bytes: opened.bytes(),
        mesh,
        statement,
        case,
        provenance,
        initial_displacement,
        elsewhere,
        initial_velocity,
        times,
        count,
        complete,
        contact_nodes,
        supplied,
        supplied_contact,
        stored,
        plastic,
        kept,
        lacks_reactions: ours.has_attribute("without_reactions"),
        checksums,
    }))
}

/// In a final file the instants are those visible to VTK: a second count of them.
fn check_seen(vtk: &Part<'_>, count: usize, complete: bool) -> Result<(), FileCause> {
    let seen = vtk.group("Steps")?.integer_attribute("NSteps")?;
    if !complete || seen == count.max(1) as i64 {
        return Ok(());
    }
    let detail = format!("{count} instants, but {seen} are visible to VTK");
    Err(FileCause::Value { name: "percute/steps_written".to_string(), detail })
}

/// The initial displacement, and whether velocities and accelerations are given; all of their shapes are
/// checked.
fn fields(vtk: &Part<'_>, instants: usize, [nodes, dimension]: [usize; 2]) -> Result<(Vec<f64>, [bool; 2]), FileCause> {
    let missing = || FileCause::MissingPart { name: DISPLACEMENT.to_string() };
    let displacement = field(vtk, "displacement", instants, nodes)?.ok_or_else(missing)?;
    let initial = vectors(&displacement, &displacement.float_rows(0..nodes)?, dimension)?;
    finite(DISPLACEMENT, &initial, dimension)?;
    let velocity = field(vtk, "velocity", instants, nodes)?.is_some();
    let acceleration = field(vtk, "acceleration", instants, nodes)?.is_some();
    Ok((initial, [velocity, acceleration]))
}

/// The number of internal variables of an element.
fn plastic(vtk: &Part<'_>, instants: usize, [elements, dimension]: [usize; 2]) -> Result<usize, FileCause> {
    let Some(fields) = vtk.optional_group("CellData")? else { return Ok(0) };
    let Some(data) = fields.optional(PLASTIC)? else { return Ok(0) };
    let count = VonMises::count(dimension);
    data.expect(&[instants.saturating_mul(elements), count], "(instants x elements, variables), step after step")?;
    data.check_floats()?;
    Ok(count)
}

/// All instants. In an incomplete file they are stored beside those visible to VTK.
fn times(vtk: &Part<'_>, ours: &Part<'_>) -> Result<TimeGrid, FileCause> {
    let seen = || vtk.group("Steps")?.data("Values");
    let values = ours.optional("times")?.map_or_else(seen, Ok)?;
    values.expect_dimensions(1, "(instants)")?;
    TimeGrid::from_instants(values.floats()?).map_err(|cause| FileCause::Times { name: values.name, cause })
}

/// Number of complete instants, and whether the file is final.
fn written(vtk: &Part<'_>, ours: &Part<'_>, instants: usize) -> Result<(usize, bool), FileCause> {
    let Some(counter) = ours.optional("steps_written")? else {
        // A file that was written in one piece.
        let steps = vtk.group("Steps")?;
        if steps.has_attribute("NSteps") {
            let told = steps.integer_attribute("NSteps")?;
            if told != instants as i64 {
                let detail = format!("{told} steps, but there are {instants} instants");
                return Err(FileCause::Value { name: "VTKHDF/Steps.NSteps".to_string(), detail });
            }
        }
        return Ok((instants, true));
    };
    let count = single(&counter)?;
    let good = usize::try_from(count).ok().filter(|&count| count <= instants);
    let Some(count) = good else {
        let detail = format!("{count} instants, but the file has room for {instants}");
        return Err(FileCause::Value { name: counter.name, detail });
    };
    let complete = match ours.optional("complete")? {
        Some(flag) => single(&flag)? != 0,
        None => true,
    };
    Ok((count, complete))
}

fn single(data: &Data<'_>) -> Result<i64, FileCause> {
    match data.integers()?.as_slice() {
        [value] => Ok(*value),
        _ => Err(FileCause::Shape {
            name: data.name.clone(),
            given: data.shape.clone(),
            needed: "a single number".to_string(),
        }),
    }
}

/// A field over time, if present: its shape, its type and its step offsets for VTK.
fn field<'f>(vtk: &Part<'f>, name: &str, instants: usize, nodes: usize) -> Result<Option<Data<'f>>, FileCause> {
    let Some(field) = vtk.group("PointData")?.optional(name)? else { return Ok(None) };
    let rows = instants.saturating_mul(nodes);
    field.expect(&[rows, 3], "(instants x nodes, 3), step after step")?;
    field.check_floats()?;
    let steps = vtk.group("Steps")?;
    let offsets = steps.optional_group("PointDataOffsets")?.map(|group| group.optional(name)).transpose()?.flatten();
    if let Some(offsets) = offsets {
        offsets.expect(&[instants], "one for each instant")?;
        let starts = offsets.integers()?;
        if let Some(n) = (0..instants).find(|&n| starts[n] != (n * nodes) as i64) {
            let detail = format!("entry {n} is {}; it must be {}", starts[n], n * nodes);
            return Err(FileCause::Value { name: offsets.name, detail });
        }
    }
    Ok(Some(field))
}

/// Nodes of the rows of the contact data, if any, and whether forces and touching status are there. Status without
/// forces is not read: it does not follow from the scheme.
fn contact(
    ours: &Part<'_>,
    instants: usize,
    nodes: usize,
    dimension: usize,
) -> Result<(Vec<usize>, [bool; 2]), FileCause> {
    let Some(contact) = ours.optional_group("contact")? else { return Ok((Vec::new(), [false; 2])) };
    let listed = contact.data("nodes")?;
    listed.expect_dimensions(1, "(contact nodes)")?;
    let of_rows = listed.indices(nodes, "nodes")?;
    let mut sorted = of_rows.clone();
    sorted.sort_unstable();
    // A node at two planes stands in it twice.
    if let Some(three) = sorted.windows(3).find(|three| three[0] == three[2]) {
        let detail = format!("node {} occurs in it three times", three[0]);
        return Err(FileCause::Value { name: listed.name, detail });
    }
    let count = of_rows.len();
    let missing = |name: &str| match provenance(ours)?.is_percute() {
        true => contact.data(name).map(Some),
        false => contact.optional(name),
    };
    let (reaction, touching) = (missing("reaction")?, missing("touching")?);
    if let Some(reaction) = &reaction {
        reaction.expect(&[instants, count, dimension], "(instants, contact nodes, dimension)")?;
        reaction.check_floats()?;
    }
    if let Some(touching) = &touching {
        touching.expect(&[instants, count], "(instants, contact nodes)")?;
    }
    match reaction {
        Some(_) => Ok((of_rows, [true, touching.is_some()])),
        None => Ok((Vec::new(), [false; 2])),
    }
}

pub(crate) fn case(ours: &Part<'_>) -> Result<Option<Case>, FileCause> {
    let Some(text) = ours.optional_text("case")? else { return Ok(None) };
    Ok(Some(Case { name: ours.optional_text("case_name")?.unwrap_or_default(), text }))
}

pub(crate) fn provenance(ours: &Part<'_>) -> Result<Provenance, FileCause> {
    let text = |name| ours.any_text_attribute(name);
    Ok(Provenance { program: text("program")?, architecture: text("architecture")?, system: text("system")? })
}
