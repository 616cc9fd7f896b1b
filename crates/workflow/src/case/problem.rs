//! The statement of the problem, handed to the core, which checks it as a whole.

use super::body::Bodies;
use super::source::CaseError;
use super::table::Table;
use super::value::{Value, rows};
use super::{contact, load, material, obstacle, place, support};
use crate::message::hint;
use percute_core::mesh::{ImportWarning, Mesh};
use percute_core::problem::{AnyProblem, Cause, InputError, Place, Statement};
use std::sync::Arc;

/// Reads all that makes the problem on a mesh.
pub(super) fn read(root: &Table<'_>, mesh: &Arc<Mesh>) -> Result<AnyProblem, CaseError> {
    let stated = Statement { planes_to_be_moved: true, ..with_start(root, mesh)? };
    AnyProblem::new(mesh, &stated).map_err(|error| located(root, &error, (mesh.dimension(), mesh.import_warnings())))
}

/// Reads all that makes the problem of several bodies.
pub(super) fn of_bodies(root: &Table<'_>, bodies: Bodies) -> Result<AnyProblem, CaseError> {
    let Bodies { mesh, materials, velocity, .. } = bodies;
    let stated = Statement {
        materials: materials.into_iter().map(|(body, law)| (Some(body), law)).collect(),
        velocity,
        automatic_contact: true,
        planes_to_be_moved: true,
        ..surroundings(root, &mesh)?
    };
    build(root, &mesh.into(), &stated)
}

/// Finds mistakes that do not depend on the size of the mesh, with a small one that has the same groups. A plane that
/// cuts through the body does so at a corner, too; `nodes` are the numbers of the corners in the large mesh, if it has
/// the same body.
pub(super) fn check_coarsest(root: &Table<'_>, mesh: &Arc<Mesh>, nodes: &[usize]) -> Result<(), CaseError> {
    let built = AnyProblem::new(mesh, &with_start(root, mesh)?);
    let Err(InputError { place, cause }) = built else { return Ok(()) };
    let cause = match (cause, nodes) {
        (cause @ Cause::UnknownGroup { .. }, _) => cause,
        (Cause::Penetrates { node, depth, clear }, [_, ..]) => Cause::Penetrates { node: nodes[node], depth, clear },
        (Cause::Behind { node, depth, reversed }, [_, ..]) => Cause::Behind { node: nodes[node], depth, reversed },
        _ => return Ok(()),
    };
    Err(located(root, &InputError { place, cause }, (mesh.dimension(), &[])))
}

/// Reads all that makes the problem, and does not check it as a whole.
fn with_start(root: &Table<'_>, mesh: &Mesh) -> Result<Statement, CaseError> {
    let mut stated = stated(root, mesh)?;
    if let Some(table) = root.single("initial")? {
        table.only()?;
        let field =
            |key: &str, unit: &str| table.get(key).map_or(Ok(Vec::new()), |v| field(&v, unit, mesh.dimension()));
        (stated.velocity, stated.displacement) = (field("velocity", "m/s")?, field("displacement", "m")?);
    }
    Ok(stated)
}

/// Reads materials, planes, contacts of bodies, supports and loads.
pub(super) fn stated(root: &Table<'_>, mesh: &Mesh) -> Result<Statement, CaseError> {
    let materials = material::read(root, mesh.kind())?;
    Ok(Statement { materials, ..surroundings(root, mesh)? })
}

/// Reads planes, contacts of bodies, supports, loads and weight.
fn surroundings(root: &Table<'_>, mesh: &Mesh) -> Result<Statement, CaseError> {
    let dimension = mesh.dimension();
    let contacts = contact::read(root, dimension, mesh.parts())?;
    Ok(Statement {
        contacts,
        obstacles: obstacle::read(root, dimension)?,
        supports: support::read(root, dimension)?,
        tractions: load::tractions(root, dimension)?,
        body_forces: load::body_forces(root, dimension)?,
        gravity: root.get("gravity").map(|gravity| gravity.vector("m/s²", dimension)).transpose()?,
        ..Statement::default()
    })
}

/// Has the core check the problem as a whole.
pub(super) fn build(root: &Table<'_>, mesh: &Arc<Mesh>, stated: &Statement) -> Result<AnyProblem, CaseError> {
    AnyProblem::new(mesh, stated).map_err(|error| located(root, &error, (mesh.dimension(), &[])))
}

/// One vector for all nodes, or a list with one for each, in rows.
fn field(value: &Value<'_>, unit: &str, dimension: usize) -> Result<Vec<f64>, CaseError> {
    let entries = if value.is_list() { value.list("")? } else { Vec::new() };
    // A bar has at least two nodes: a list of one number is the same for all of them.
    let nodal = if dimension == 1 { entries.len() > 1 } else { entries.first().is_some_and(Value::is_list) };
    let vectors = if nodal { value.vectors(unit, dimension)? } else { vec![value.vector(unit, dimension)?] };
    Ok(rows(vectors, dimension))
}

/// An error of the core, at its place in the file.
fn located(root: &Table<'_>, error: &InputError, (dimension, import_warnings): (usize, &[ImportWarning])) -> CaseError {
    let mut message = error.cause.to_string();
    if let Cause::UnknownGroup { name, known, .. } = &error.cause {
        message += &hint(name, known.iter().map(String::as_str));
    }
    if let Cause::UnknownGroup { name, .. } | Cause::EmptyGroup { name, .. } = &error.cause {
        let of_group = import_warnings.iter().filter(|import_warning| import_warning.groups.contains(name));
        of_group.for_each(|import_warning| message += &format!("; {}", import_warning.message));
    }
    if let (Cause::UnknownGroup { name, .. }, true) = (&error.cause, in_file(root)) {
        let what = match error.place.table {
            "material" | "body_force" if dimension == 3 => "Volume",
            "material" | "body_force" => "Surface",
            _ if dimension == 3 => "Surface",
            _ => "Curve",
        };
        message += &format!("; in Gmsh, `Physical {what}(\"{name}\") = {{…}};` names one, before the mesh is saved");
    }
    // Planes are stated in metres: a body read in millimetres reaches far beyond them.
    let large = import_warnings.iter().find(|import_warning| import_warning.name == "large_mesh");
    let of_plane = error.place.table == "obstacle"
        && !matches!(error.cause, Cause::UnknownGroup { .. } | Cause::EmptyGroup { .. });
    if let (Some(large), true) = (large, of_plane) {
        let place = Place { table: "mesh", index: None, key: "file" };
        return root.source.error(&place::find(root, place), format!("{}. As it is, {message}", large.message));
    }
    root.source.error(&place::find(root, error.place), message)
}

/// Whether the mesh is one of Gmsh's files.
fn in_file(root: &Table<'_>) -> bool {
    root.single("mesh").is_ok_and(|mesh| mesh.is_some_and(|mesh| mesh.get("file").is_some()))
}
