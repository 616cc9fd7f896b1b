//! `[mesh]`: a generator, a file of Gmsh, or points, cells and groups.

use super::material::NOT_FOR_BARS;
use super::source::CaseError;
use super::table::Table;
use super::value::{Value, rows};
use crate::message::hint;
use percute_core::mesh::{Diagonals, ElementGroups, FaceRows, Mesh, MeshError};
use percute_io::FileCause;
use percute_io::gmsh::{self, GmshCause};
use std::path::PathBuf;

const RECTANGLE: &str = "{ width = 0.05, height = 0.04, nx = 20, ny = 16 }";
const DISC: &str = "{ radius = 0.05, rings = 12 }";
const BAR: &str = "{ length = 0.1, elements = 100 }";
const BOX: &str = "{ size = [0.02, 0.02, 0.02], cells = [6, 6, 6] }";
const CYLINDER: &str = "{ radius = 0.01, height = 0.04, rings = 4, layers = 16 }";
const BALL: &str = "{ radius = 0.01, rings = 6 }";
const GROUPS: &str = "{ bottom = [[0, 1], [1, 2]] }";
const ELEMENTS: &str = "{ core = [0, 1, 2] }";

/// Reads the mesh from the table and the value of the key that says how it is given.
type Reader = for<'a> fn(&Table<'a>, &Value<'a>) -> Result<Mesh, CaseError>;

const WAYS: [(&str, Reader); 8] = [
    ("rectangle", |_, value| rectangle(value)),
    ("disc", |_, value| disc(value)),
    ("bar", |_, value| bar(value)),
    ("box", |_, value| cuboid(value)),
    ("cylinder", |_, value| cylinder(value)),
    ("ball", |_, value| ball(value)),
    ("file", from_file),
    ("points", from_arrays),
];

/// Reads the mesh.
pub(super) fn read(table: &Table<'_>) -> Result<Mesh, CaseError> {
    table.only()?;
    one_way(table)
}

/// Reads the mesh of a table that may have other keys too.
pub(super) fn one_way(table: &Table<'_>) -> Result<Mesh, CaseError> {
    let ways: Vec<_> = WAYS.iter().filter_map(|(key, reader)| Some((table.get(key)?, reader))).collect();
    let [(value, reader)] = ways.as_slice() else {
        let message = "needs exactly one of `rectangle`, `disc`, `bar`, `box`, `cylinder`, `ball`, `file` and `points` \
                       (the last with `cells`)";
        let surplus = |(second, _): &(Value<'_>, _)| second.error(format!("is one too many: a body {message}"));
        return Err(ways.get(1).map_or_else(|| table.error(message), surplus));
    };
    if table.get("points").is_none() {
        for key in ["cells", "edge_groups", "face_groups", "element_groups"] {
            let why = "goes with `points`; a mesh that is generated or in a file has its own elements and groups";
            table.refuse(key, why)?;
        }
    }
    if table.get("file").is_none() {
        table.refuse("scale", "goes with `file`; all other lengths are in metres")?;
    }
    reader(table, value)
}

/// An error of a case whose mesh was read as a bar: perhaps a plane body was meant, and its triangles were not saved.
pub(super) fn of_lines_only(table: &Table<'_>, mut error: CaseError) -> CaseError {
    if table.get("file").is_some() && error.message.contains(NOT_FOR_BARS) {
        error.message += "; the mesh file has lines only: for a plane body, name it in Gmsh by \
                          `Physical Surface(\"body\") = {…};`, because with physical groups Gmsh saves their \
                          members only";
    }
    error
}

/// A mesh of more elements than this is large: to make it takes more than a tenth of a second.
const LARGE: usize = 100_000;

/// The coarsest mesh of the same kind, with the same groups, for checks of other tables before a large mesh is made.
pub(super) struct Coarsest {
    pub(super) mesh: Mesh,
    /// The number of each of its nodes in the large mesh; empty if it is not the same body.
    pub(super) nodes: Vec<usize>,
}

/// That of a mesh which is generated and large.
pub(super) fn coarsest(table: &Table<'_>) -> Option<Coarsest> {
    let count = |of: &str, key: &str| {
        table.get(of).and_then(|value| value.table("").ok()?.get(key)?.count(1).ok()).unwrap_or(1)
    };
    let sides = ["nx", "ny"].map(|side| count("rectangle", side));
    let rings = count("disc", "rings");
    let elements = count("bar", "elements");
    if sides[0].saturating_mul(sides[1]).max(rings.saturating_mul(rings)).max(elements) <= LARGE {
        return None;
    }
    let length =
        |of: &str, key: &str| table.get(of)?.table("").ok()?.get(key)?.number("m").ok().filter(|length| *length > 0.0);
    let [nx, ny] = sides;
    // Beyond all that a mesh may have, the large mesh is refused.
    let above = ny.saturating_mul(nx.saturating_add(1));
    let corners = || vec![0, nx, above, above.saturating_add(nx)];
    let rectangle = |width, height| Mesh::rectangle(width, height, 1, 1);
    let (made, nodes) = match ["rectangle", "disc", "bar"].map(|key| table.get(key).is_some()) {
        [true, false, false] => {
            let size = ["width", "height"].map(|side| length("rectangle", side));
            match size {
                [Some(width), Some(height)] => (rectangle(width, height), corners()),
                _ => (rectangle(1.0, 1.0), Vec::new()),
            }
        }
        // The outline of the coarsest lies inside that of the disc.
        [false, true, false] => (Mesh::disc(1.0, 1), Vec::new()),
        [false, false, true] => {
            let size = length("bar", "length");
            (Mesh::uniform_bar(size.unwrap_or(1.0), 1), size.map_or_else(Vec::new, |_| vec![0, elements]))
        }
        _ => return None,
    };
    Some(Coarsest { mesh: made.ok()?, nodes })
}

/// The file that the mesh is in, if it is in one.
pub(super) fn file(table: &Table<'_>) -> Option<PathBuf> {
    let value = table.get("file")?;
    Some(value.source.beside(value.text("").ok()?.as_ref()))
}

/// Metres per unit of length in the file that the mesh is in; 1 where it states none.
pub(super) fn scale(table: &Table<'_>) -> f64 {
    table.get("scale").and_then(|scale| scale.number("").ok()).unwrap_or(1.0)
}

/// A mesh in a file of Gmsh, relative to the folder of the case.
fn from_file(table: &Table<'_>, value: &Value<'_>) -> Result<Mesh, CaseError> {
    let file = value.source.beside(value.text("the name of a Gmsh file, such as \"block.msh\"")?.as_ref());
    let scale = table
        .get("scale")
        .map_or(Ok(1.0), |scale| scale.number("metres per unit of length in the file: 1e-3 for millimetres"))?;
    match gmsh::read(&file, scale) {
        Ok(read) => Ok(read.mesh),
        Err(error) => match (&error.cause, table.get("scale")) {
            (GmshCause::Scale { .. }, Some(scale)) => Err(scale.error(error.cause.to_string())),
            (GmshCause::File(FileCause::Missing), _) => {
                Err(value.error(format!("{error}; names are relative to the folder of the case file")))
            }
            _ => Err(value.error(error.to_string())),
        },
    }
}

fn rectangle(value: &Value<'_>) -> Result<Mesh, CaseError> {
    let table = value.table(RECTANGLE)?;
    let length = |key| table.require(key, "a length in m")?.number("m");
    let count = |key| table.require(key, "a number of cells")?.count(1);
    let (width, height, nx, ny) = (length("width")?, length("height")?, count("nx")?, count("ny")?);
    let diagonals = table.get("diagonals").map_or(Ok(Diagonals::default()), |value| diagonals(&value))?;
    Mesh::rectangle_cut(width, height, nx, ny, diagonals).map_err(|error| generator(&table, &error))
}

fn diagonals(value: &Value<'_>) -> Result<Diagonals, CaseError> {
    let [right, alternating, crossed] = Diagonals::NAMES.map(|(name, _)| name);
    let allowed = format!("one of \"{right}\", \"{alternating}\", \"{crossed}\"");
    let name = value.text(&allowed)?;
    let hint = || hint(name, Diagonals::NAMES.map(|(name, _)| name));
    Diagonals::named(name).ok_or_else(|| value.must_be(format!("{allowed}{}", hint())))
}

fn disc(value: &Value<'_>) -> Result<Mesh, CaseError> {
    let table = value.table(DISC)?;
    let radius = table.require("radius", "a length in m")?.number("m")?;
    let rings = table.require("rings", "a number of rings")?.count(1)?;
    Mesh::disc(radius, rings).map_err(|error| generator(&table, &error))
}

fn bar(value: &Value<'_>) -> Result<Mesh, CaseError> {
    let table = value.table(BAR)?;
    let length = table.require("length", "a length in m")?.number("m")?;
    let elements = table.require("elements", "a number of elements")?.count(1)?;
    Mesh::uniform_bar(length, elements).map_err(|error| generator(&table, &error))
}

fn cuboid(value: &Value<'_>) -> Result<Mesh, CaseError> {
    let table = value.table(BOX)?;
    let size = table.require("size", "three lengths in m")?.vector("m", 3)?;
    let cells = table.require("cells", "three numbers of cells")?;
    let of_axis: Vec<usize> = cells.nodes(3)?;
    Mesh::cuboid(size, [of_axis[0], of_axis[1], of_axis[2]]).map_err(|error| generator(&table, &error))
}

fn cylinder(value: &Value<'_>) -> Result<Mesh, CaseError> {
    let table = value.table(CYLINDER)?;
    let [radius, height] = [length(&table, "radius")?, length(&table, "height")?];
    let rings = table.require("rings", "a number of rings")?.count(1)?;
    let layers = table.require("layers", "a number of layers")?.count(1)?;
    Mesh::cylinder(radius, height, rings, layers).map_err(|error| generator(&table, &error))
}

fn ball(value: &Value<'_>) -> Result<Mesh, CaseError> {
    let table = value.table(BALL)?;
    let rings = table.require("rings", "a number of rings")?.count(1)?;
    Mesh::ball(length(&table, "radius")?, rings).map_err(|error| generator(&table, &error))
}

fn length(table: &Table<'_>, key: &str) -> Result<f64, CaseError> {
    table.require(key, "a length in m")?.number("m")
}

/// A generator's error, at the key that it names.
fn generator(table: &Table<'_>, error: &MeshError) -> CaseError {
    let value = match error {
        MeshError::Generator { name, .. } => table.get(name),
        _ => None,
    };
    value.map_or_else(|| table.error(error.to_string()), |value| value.error(error.to_string()))
}

fn from_arrays(table: &Table<'_>, points: &Value<'_>) -> Result<Mesh, CaseError> {
    let entries = points.list("points, each its coordinates in m")?;
    let coordinates = entries.first().and_then(|first| Some(first.list("").ok()?.len()));
    let dimension = match coordinates {
        None | Some(1) => 1,
        Some(3) => 3,
        Some(_) => 2,
    };
    let (key, other) = if dimension == 3 { ("face_groups", "edge_groups") } else { ("edge_groups", "face_groups") };
    table
        .refuse(other, &format!("does not apply to points with {dimension} coordinates; name the groups by `{key}`"))?;
    arrays(table, dimension, key)
}

/// A mesh from points, cells, groups of faces and groups of elements.
fn arrays(table: &Table<'_>, dimension: usize, of_faces: &str) -> Result<Mesh, CaseError> {
    let points = table.require("points", "the coordinates of the nodes in m")?.vectors("m", dimension)?;
    let points = rows(points, dimension);
    let cells = table.require("cells", "the node numbers of each element, counted from 0")?;
    let cells = nodes(&cells.list("elements, each the numbers of its nodes")?, dimension + 1)?;
    let mut faces = FaceRows::new();
    if let Some(groups) = table.get(of_faces) {
        for (name, members) in groups.any_table(GROUPS)?.entries() {
            let members = members.list("edges (a bar: points, a solid: faces), each the numbers of its nodes")?;
            faces.insert(name.to_string(), nodes(&members, dimension)?);
        }
    }
    let mut elements = ElementGroups::new();
    if let Some(groups) = table.get("element_groups") {
        for (name, members) in groups.any_table(ELEMENTS)?.entries() {
            let members = members.list("element numbers, counted from 0")?;
            elements.insert(name.to_string(), members.iter().map(|m| m.count(0)).collect::<Result<_, _>>()?);
        }
    }
    Mesh::from_rows(dimension, &points, &cells, (&faces, &elements)).map_err(|error| array_error(table, &error))
}

/// The numbers of so many nodes in each entry, in rows.
fn nodes(entries: &[Value<'_>], count: usize) -> Result<Vec<usize>, CaseError> {
    let rows: Vec<Vec<usize>> = entries.iter().map(|entry| entry.nodes(count)).collect::<Result<_, _>>()?;
    Ok(rows.concat())
}

/// The entry of the arrays that an error of the mesh is about.
fn array_error(table: &Table<'_>, error: &MeshError) -> CaseError {
    let entry = |key: &str, at: usize| table.get(key)?.list("").ok()?.into_iter().nth(at);
    let named = |key: &str, group: &str| table.get(key)?.any_table("").ok()?.get(group);
    let value = match error {
        MeshError::Empty { .. } => table.get("cells"),
        MeshError::NotFinite { node, .. } | MeshError::UnusedNodes { first: node, .. } => entry("points", *node),
        MeshError::DuplicateNodes { second, .. } => entry("points", *second),
        MeshError::NoSuchNode { element, .. } | MeshError::Degenerate { element, .. } => entry("cells", *element),
        MeshError::NonManifoldFace { elements, .. } => entry("cells", elements.last().copied().unwrap_or(0)),
        MeshError::Overlap { elements } | MeshError::PartsTouch { elements } => entry("cells", elements[1]),
        MeshError::NonManifoldNode { node, .. } | MeshError::NonManifoldSolid { node, .. } => entry("points", *node),
        MeshError::NoSuchFace { group, .. } => named("edge_groups", group).or_else(|| named("face_groups", group)),
        MeshError::NoSuchElement { group, .. } => named("element_groups", group),
        MeshError::Generator { .. } | MeshError::TooLarge { .. } | MeshError::NoMemory { .. } => None,
    };
    value.map_or_else(|| table.error(error.to_string()), |value| value.error(error.to_string()))
}
