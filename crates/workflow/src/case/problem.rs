//! The statement of the problem, handed to the core, which checks it as a whole.

use super::body::Bodies;
use super::source::CaseError;
use super::table::Table;
use super::value::Value;
use super::{contact, load, material, obstacle, place, support};
use crate::message::hint;
use percute_core::mesh::{ImportWarning, Mesh};
use percute_core::problem::{Builder, Cause, Initial, InputError, Place, Problem};

/// Reads all that makes the problem on a mesh.
pub(super) fn read<const D: usize, const N: usize>(
    root: &Table<'_>,
    mesh: Mesh<D, N>,
) -> Result<Problem<D, N>, CaseError> {
    let import_warnings = mesh.import_warnings().to_vec();
    let builder = with_start(root, mesh)?.planes_to_be_moved();
    builder.build().map_err(|error| located(root, &error, &import_warnings))
}

/// Reads all that makes the problem of several bodies.
pub(super) fn of_bodies<const D: usize, const N: usize>(
    root: &Table<'_>,
    bodies: Bodies<D, N>,
) -> Result<Problem<D, N>, CaseError> {
    let Bodies { mesh, materials, velocity, .. } = bodies;
    let mut builder = Problem::builder(mesh).initial_velocity(Initial::Nodal(velocity)).automatic_contact();
    builder = builder.planes_to_be_moved();
    for (body, law) in materials {
        builder = builder.material_of(body, law);
    }
    build(root, surroundings(root, builder)?)
}

/// Finds mistakes that do not depend on the size of the mesh, with a small one that has the same groups. A plane that
/// cuts through the body does so at a corner, too; `nodes` are the numbers of the corners in the large mesh, if it has
/// the same body.
pub(super) fn check_coarsest<const D: usize, const N: usize>(
    root: &Table<'_>,
    mesh: Mesh<D, N>,
    nodes: &[usize],
) -> Result<(), CaseError> {
    let Err(InputError { place, cause }) = with_start(root, mesh)?.build() else { return Ok(()) };
    let cause = match (cause, nodes) {
        (cause @ Cause::UnknownGroup { .. }, _) => cause,
        (Cause::Penetrates { node, depth, clear }, [_, ..]) => Cause::Penetrates { node: nodes[node], depth, clear },
        (Cause::Behind { node, depth, reversed }, [_, ..]) => Cause::Behind { node: nodes[node], depth, reversed },
        _ => return Ok(()),
    };
    Err(located(root, &InputError { place, cause }, &[]))
}

/// Reads all that makes the problem, and does not check it as a whole.
fn with_start<const D: usize, const N: usize>(root: &Table<'_>, mesh: Mesh<D, N>) -> Result<Builder<D, N>, CaseError> {
    let mut builder = stated(root, mesh)?;
    if let Some(table) = root.single("initial")? {
        table.only(&["velocity", "displacement"])?;
        if let Some(value) = table.get("velocity") {
            builder = builder.initial_velocity(field(&value, "m/s")?);
        }
        if let Some(value) = table.get("displacement") {
            builder = builder.initial_displacement(field(&value, "m")?);
        }
    }
    Ok(builder)
}

/// Reads materials, planes, contacts of bodies, supports and loads.
pub(super) fn stated<const D: usize, const N: usize>(
    root: &Table<'_>,
    mesh: Mesh<D, N>,
) -> Result<Builder<D, N>, CaseError> {
    let shape = mesh.simplex().shape();
    let mut builder = Problem::builder(mesh);
    for (group, law) in material::read(root, shape)? {
        builder = match group {
            Some(group) => builder.material_of(group, law),
            None => builder.material(law),
        };
    }
    surroundings(root, builder)
}

/// Reads planes, contacts of bodies, supports, loads and weight.
fn surroundings<const D: usize, const N: usize>(
    root: &Table<'_>,
    mut builder: Builder<D, N>,
) -> Result<Builder<D, N>, CaseError> {
    let (shape, parts) = (builder.mesh().simplex().shape(), builder.mesh().parts());
    for contact in contact::read::<D>(root, shape, parts)? {
        builder = builder.contact(contact);
    }
    for plane in obstacle::read(root, shape)? {
        builder = builder.obstacle(plane);
    }
    for support in support::read(root)? {
        builder = builder.support(support);
    }
    for traction in load::tractions(root)? {
        builder = builder.traction(traction);
    }
    for force in load::body_forces(root)? {
        builder = builder.body_force(force);
    }
    match root.get("gravity") {
        Some(gravity) => Ok(builder.gravity(gravity.vector("m/s²")?)),
        None => Ok(builder),
    }
}

/// Has the core check the problem as a whole.
pub(super) fn build<const D: usize, const N: usize>(
    root: &Table<'_>,
    builder: Builder<D, N>,
) -> Result<Problem<D, N>, CaseError> {
    builder.build().map_err(|error| located(root, &error, &[]))
}

/// One vector for all nodes, or a list with one for each.
fn field<const D: usize>(value: &Value<'_>, unit: &str) -> Result<Initial<D>, CaseError> {
    let entries = if value.is_list() { value.list("")? } else { Vec::new() };
    // A bar has at least two nodes: a list of one number is the same for all of them.
    let nodal = if D == 1 { entries.len() > 1 } else { entries.first().is_some_and(Value::is_list) };
    if nodal { value.vectors(unit).map(Initial::Nodal) } else { value.vector(unit).map(Initial::Uniform) }
}

/// An error of the core, at its place in the file.
fn located(root: &Table<'_>, error: &InputError, import_warnings: &[ImportWarning]) -> CaseError {
    let mut message = error.cause.to_string();
    if let Cause::UnknownGroup { name, known, .. } = &error.cause {
        message += &hint(name, known.iter().map(String::as_str));
    }
    if let Cause::UnknownGroup { name, .. } | Cause::EmptyGroup { name, .. } = &error.cause {
        let of_group = import_warnings.iter().filter(|import_warning| import_warning.groups.contains(name));
        of_group.for_each(|import_warning| message += &format!("; {}", import_warning.message));
    }
    if let (Cause::UnknownGroup { name, .. }, true) = (&error.cause, in_file(root)) {
        let what = if matches!(error.place.table, "material" | "body_force") { "Surface" } else { "Curve" };
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
