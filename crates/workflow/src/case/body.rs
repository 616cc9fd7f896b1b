//! `[[body]]`: several bodies, each with its mesh, place, material and velocity.

use super::source::CaseError;
use super::table::Table;
use super::value::Value;
use super::{material, mesh};
use crate::message::{hint, short};
use percute_core::border::Vector;
use percute_core::cell::CellKind;
use percute_core::material::Elastic;
use percute_core::mesh::{Mesh, MeshError};
use std::path::PathBuf;

const MATERIAL: &str = "{ young = 70e9, poisson = 0.3, density = 2700.0, plane = \"stress\" }";
const BAR: &str = "{ young = 70e9, density = 2700.0, section = 1e-4 }";
const SOLID: &str = "{ young = 70e9, poisson = 0.3, density = 2700.0 }";
/// Farther away, over its size, a mesh has less than seven digits.
const FAR: f64 = 1e9;
/// What stands in each body instead.
const INSTEAD: [(&str, &str); 3] =
    [("mesh", "its mesh, such as `rectangle`"), ("material", "`material`"), ("initial", "`velocity`")];

/// Several bodies as one mesh.
pub(super) struct Bodies {
    pub(super) mesh: Mesh,
    /// The name of each body, which is the group of its elements, and its material.
    pub(super) materials: Vec<(String, Elastic)>,
    /// Initial velocity of each node (m/s), in rows.
    pub(super) velocity: Vec<f64>,
    /// The files with meshes.
    pub(super) files: Vec<PathBuf>,
}

/// One body as it is stated.
struct Stated<'a> {
    table: Table<'a>,
    name: &'a str,
    mesh: Mesh,
}

/// Reads all bodies; `None` for a case that has one only, with a table `[mesh]`.
pub(super) fn read(root: &Table<'_>) -> Result<Option<Bodies>, CaseError> {
    let tables = root.tables("body")?;
    if tables.is_empty() {
        return Ok(None);
    }
    for (key, instead) in INSTEAD {
        root.refuse(key, &format!("cannot be given together with [[body]]; each body has {instead} in its own table"))?;
    }
    let mut bodies = Vec::new();
    let mut names: Vec<&str> = Vec::new();
    for table in tables {
        table.only()?;
        let name = name(&table)?;
        if names.contains(&name.1) {
            return Err(name.0.error(format!("is \"{}\", the name of an earlier body; give each its own", name.1)));
        }
        names.push(name.1);
        let mesh = mesh::one_way(&table)?;
        bodies.push(Stated { mesh: of_group(&table, mesh)?, table, name: name.1 });
    }
    let least = bodies.iter().min_by_key(|body| body.mesh.dimension());
    if let Some(least) = least.filter(|least| bodies.iter().any(|body| body.mesh.kind() != least.mesh.kind())) {
        let [is, another] = match least.mesh.kind() {
            CellKind::Bar => ["a bar", "no bar"],
            _ => ["plane", "a solid"],
        };
        let told =
            format!("is {is}, but another body is {another}; bodies of a case are all bars, all plane or all solids");
        return Err(least.table.error(told));
    }
    joined(root, &bodies).map(Some)
}

/// The name of a body, which has no dot: a dot joins it to the names of its groups.
fn name<'a>(table: &Table<'a>) -> Result<(Value<'a>, &'a str), CaseError> {
    let value = table.require("name", "a name of the body, such as \"anvil\"")?;
    let name = value.text("a name")?;
    if name.is_empty() || name.contains('.') {
        return Err(value.must_be("a name without a dot, which joins it to the names of its groups: \"anvil.top\""));
    }
    Ok((value, name))
}

fn joined(root: &Table<'_>, bodies: &[Stated<'_>]) -> Result<Bodies, CaseError> {
    let (mut materials, mut velocity, mut placed) = (Vec::new(), Vec::new(), Vec::new());
    for Stated { table, name, mesh } in bodies {
        placed.push((*name, placed_mesh(table, mesh)?));
        materials.push(((*name).to_string(), law(table, mesh.kind())?));
        let uniform = table.get("velocity").map_or(Ok([0.0; 3]), |value| value.vector("m/s", mesh.dimension()))?;
        velocity.extend(uniform[..mesh.dimension()].repeat(mesh.node_count()));
    }
    let of_all: Vec<_> = placed.iter().map(|(name, mesh)| (*name, mesh)).collect();
    let mesh = Mesh::joined(&of_all).map_err(|error| apart(root, &of_all, &error))?;
    let files = bodies.iter().filter_map(|body| mesh::file(&body.table)).collect();
    Ok(Bodies { mesh, materials, velocity, files })
}

fn law(table: &Table<'_>, shape: CellKind) -> Result<Elastic, CaseError> {
    let example = match shape {
        CellKind::Bar => BAR,
        CellKind::Triangle => MATERIAL,
        CellKind::Tetrahedron => SOLID,
    };
    let table = table.require("material", &format!("a table, such as {example}"))?.any_table(example)?;
    table.refuse("group", "does not apply here: the material of a body is that of all its elements")?;
    material::law(&table, shape)
}

/// The mesh in its place.
fn placed_mesh(table: &Table<'_>, mesh: &Mesh) -> Result<Mesh, CaseError> {
    match mesh.kind() {
        CellKind::Bar => table.refuse("rotation", "does not apply to a bar")?,
        CellKind::Triangle => {}
        CellKind::Tetrahedron => table.refuse("rotation", "does not apply to a solid; turn its mesh, or the planes")?,
    }
    let origin = table.get("origin").map_or(Ok([0.0; 3]), |value| value.vector("m", mesh.dimension()))?;
    let angle = table.get("rotation").map_or(Ok(0.0), |value| value.number("degrees"))?;
    mesh.placed(&origin, angle).map_err(|error| match (far_origin(mesh, &origin), table.get("origin")) {
        (Some(told), Some(value)) => value.error(told),
        _ => table.error(error.to_string()),
    })
}

/// What is wrong with an origin (m) at which a mesh has no place, if it is too far away for numbers of 64 bits.
#[must_use]
pub fn far_origin(mesh: &Mesh, origin: &Vector) -> Option<String> {
    let far = origin.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    (far > FAR * mesh.size()).then(|| {
        format!(
            "is {:?} m, so far from a mesh of {} m that rounding distorts it; give a place near the \
             other bodies, in metres",
            &origin[..mesh.dimension()],
            short(mesh.size(), 3)
        )
    })
}

/// The elements of the group that is named, if one is: one of several bodies in a file.
fn of_group(table: &Table<'_>, mesh: Mesh) -> Result<Mesh, CaseError> {
    let Some(value) = table.get("group") else { return Ok(mesh) };
    let group = value.text("a group of elements")?;
    let part = mesh.part_of_group(group).ok_or_else(|| {
        let names: Vec<&str> = mesh.element_groups().keys().map(String::as_str).collect();
        let known = if names.is_empty() { "none".to_string() } else { names.join(", ") };
        value.error(format!(
            "names the group of elements \"{group}\", which is not in the mesh; it has {known}{}",
            hint(group, names)
        ))
    })?;
    part.map_err(|error| table.error(error.to_string()))
}

/// Bodies that overlap, by their names.
fn apart(root: &Table<'_>, bodies: &[(&str, &Mesh)], error: &MeshError) -> CaseError {
    let tables = root.tables("body").unwrap_or_default();
    let Some((second, message)) = Mesh::overlapping(bodies, error) else { return root.error(error.to_string()) };
    tables.get(second).map_or_else(|| root.error(&message), |table| table.error(&message))
}
