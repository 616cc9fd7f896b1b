//! `[[body]]`: several bodies, each with its mesh, place, material and velocity.

use super::source::CaseError;
use super::table::Table;
use super::value::Value;
use super::{material, mesh};
use percute_core::material::Elastic;
use percute_core::mesh::{AnyMesh, Mesh, MeshError};
use percute_core::simplex::{Element, Shape, Simplex};
use std::path::PathBuf;

const KEYS: [&str; 5] = ["name", "origin", "rotation", "material", "velocity"];
const MATERIAL: &str = "{ young = 70e9, poisson = 0.3, density = 2700.0, plane = \"stress\" }";
const BAR: &str = "{ young = 70e9, density = 2700.0, section = 1e-4 }";
/// What stands in each body instead.
const INSTEAD: [(&str, &str); 3] =
    [("mesh", "its mesh, such as `rectangle`"), ("material", "`material`"), ("initial", "`velocity`")];

/// Several bodies as one mesh.
pub(super) struct Bodies<const D: usize, const N: usize> {
    pub(super) mesh: Mesh<D, N>,
    /// The name of each body, which is the group of its elements, and its material.
    pub(super) materials: Vec<(String, Elastic)>,
    /// Initial velocity of each node (m/s).
    pub(super) velocity: Vec<[f64; D]>,
    /// The files with meshes.
    pub(super) files: Vec<PathBuf>,
}

/// Bodies of either dimension.
pub(super) enum AnyBodies {
    Bars(Box<Bodies<1, 2>>),
    Plane(Box<Bodies<2, 3>>),
}

/// One body as it is stated.
struct Stated<'a, const D: usize, const N: usize> {
    table: Table<'a>,
    name: &'a str,
    mesh: Mesh<D, N>,
}

/// Reads all bodies; `None` for a case that has one only, with a table `[mesh]`.
pub(super) fn read(root: &Table<'_>) -> Result<Option<AnyBodies>, CaseError> {
    let tables = root.tables("body")?;
    if tables.is_empty() {
        return Ok(None);
    }
    for (key, instead) in INSTEAD {
        root.refuse(key, &format!("stands beside [[body]]; each body has {instead} in its own table"))?;
    }
    let (mut bars, mut plane) = (Vec::new(), Vec::new());
    let mut names: Vec<&str> = Vec::new();
    for table in tables {
        table.only(&[&KEYS[..], &mesh::KEYS].concat())?;
        let name = name(&table)?;
        if names.contains(&name.1) {
            return Err(name.0.error(format!("is \"{}\", the name of an earlier body; give each its own", name.1)));
        }
        names.push(name.1);
        match mesh::one_way(&table)? {
            AnyMesh::Bar(mesh) => bars.push(Stated { table, name: name.1, mesh }),
            AnyMesh::Plane(mesh) => plane.push(Stated { table, name: name.1, mesh }),
        }
    }
    if let (Some(bar), Some(_)) = (bars.first(), plane.first()) {
        return Err(bar.table.error("is a bar, but another body is plane; bodies of a case are all bars or all plane"));
    }
    Ok(Some(match plane.is_empty() {
        true => AnyBodies::Bars(Box::new(joined(root, &bars, placed_bar)?)),
        false => AnyBodies::Plane(Box::new(joined(root, &plane, placed_plane)?)),
    }))
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

fn joined<const D: usize, const N: usize>(
    root: &Table<'_>,
    bodies: &[Stated<'_, D, N>],
    place: impl Fn(&Table<'_>, &Mesh<D, N>) -> Result<Mesh<D, N>, CaseError>,
) -> Result<Bodies<D, N>, CaseError>
where
    Element<D, N>: Simplex<D, N>,
{
    let (mut materials, mut velocity, mut placed) = (Vec::new(), Vec::new(), Vec::new());
    for Stated { table, name, mesh } in bodies {
        placed.push((*name, place(table, mesh)?));
        materials.push(((*name).to_string(), law(table, mesh.simplex().shape())?));
        let uniform = table.get("velocity").map_or(Ok([0.0; D]), |value| value.vector("m/s"))?;
        velocity.extend(vec![uniform; mesh.node_count()]);
    }
    let of_all: Vec<_> = placed.iter().map(|(name, mesh)| (*name, mesh)).collect();
    let mesh = Mesh::joined(&of_all).map_err(|error| apart(root, &of_all, &error))?;
    let files = bodies.iter().filter_map(|body| mesh::file(&body.table)).collect();
    Ok(Bodies { mesh, materials, velocity, files })
}

fn law(table: &Table<'_>, shape: Shape) -> Result<Elastic, CaseError> {
    let example = if shape == Shape::Bar { BAR } else { MATERIAL };
    let table = table.require("material", &format!("a table, such as {example}"))?.any_table(example)?;
    table.refuse("group", "does not apply here: the material of a body is that of all its elements")?;
    material::law(&table, shape)
}

fn placed_bar(table: &Table<'_>, mesh: &Mesh<1, 2>) -> Result<Mesh<1, 2>, CaseError> {
    table.refuse("rotation", "does not apply to a bar")?;
    let [origin] = origin(table)?;
    mesh.mapped(|point| [origin + point[0]]).map_err(|error| table.error(error.to_string()))
}

fn placed_plane(table: &Table<'_>, mesh: &Mesh<2, 3>) -> Result<Mesh<2, 3>, CaseError> {
    let [x, y] = origin(table)?;
    let angle = table.get("rotation").map_or(Ok(0.0), |value| value.number("degrees"))?;
    // A body that is not turned keeps the bits of its mesh.
    let (sin, cos) = angle.to_radians().sin_cos();
    let place = |p: &[f64; 2]| [x + (cos * p[0] - sin * p[1]), y + (sin * p[0] + cos * p[1])];
    mesh.mapped(place).map_err(|error| table.error(error.to_string()))
}

fn origin<const D: usize>(table: &Table<'_>) -> Result<[f64; D], CaseError> {
    table.get("origin").map_or(Ok([0.0; D]), |value| value.vector("m"))
}

/// Bodies that touch or overlap, by their names.
fn apart<const D: usize, const N: usize>(
    root: &Table<'_>,
    bodies: &[(&str, &Mesh<D, N>)],
    error: &MeshError,
) -> CaseError {
    let body_of = |mut at: usize, count: fn(&Mesh<D, N>) -> usize| {
        let here = |(_, mesh): &(&str, &Mesh<D, N>)| {
            let before = at;
            at = at.wrapping_sub(count(mesh));
            before < count(mesh)
        };
        bodies.iter().position(here).unwrap_or(0)
    };
    let tables = root.tables("body").unwrap_or_default();
    match error {
        MeshError::PartsTouch { .. } | MeshError::DuplicateNodes { .. } => {
            let [first, second] = match *error {
                MeshError::PartsTouch { elements } => elements.map(|element| body_of(element, Mesh::element_count)),
                MeshError::DuplicateNodes { first, second, .. } => {
                    [first, second].map(|node| body_of(node, Mesh::node_count))
                }
                _ => [0, 0],
            };
            let message = format!(
                "touches or overlaps \"{}\"; leave a gap between bodies, of more than a quarter of their relative \
                 speed times the first step",
                bodies[first].0
            );
            tables.get(second).map_or_else(|| root.error(&message), |table| table.error(&message))
        }
        _ => root.error(error.to_string()),
    }
}
