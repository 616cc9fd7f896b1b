//! The mesh in a file: an unstructured grid of VTKHDF, and groups of percute.

use crate::error::FileCause;
use crate::names::{decoded, encoded};
use crate::read::{Data, Opened, Part};
use crate::write::{attribute, group, numbers, unit};
use hdf5::Group;
use hdf5::types::FixedAscii;
use percute_core::mesh::{ElementGroups, FaceRows, Mesh};

/// Numbers and names of the elements in VTK, by dimension from 1.
pub(crate) const VTK_TYPES: [(u8, &str); 3] = [(3, "VTK_LINE"), (5, "VTK_TRIANGLE"), (10, "VTK_TETRA")];

/// Name of the field with the number of the body of each element.
pub(crate) const BODY: &str = "body";
/// The library's overhead of that field in its group, with its offsets (bytes), rounded up.
const OF_BODIES: u64 = 4_000;

/// The number of the body of each element, from 0, in the order of their first nodes; none of a single body.
pub(crate) fn bodies(mesh: &Mesh) -> Option<Vec<i64>> {
    (mesh.parts() > 1).then(|| mesh.part_of_elements().into_iter().map(|body| body as i64).collect())
}

/// Bytes of these numbers in a file with so many instants.
pub(crate) fn bytes_of_bodies(mesh: &Mesh, instants: usize) -> u64 {
    if mesh.parts() > 1 { 8 * (mesh.element_count() + instants) as u64 + OF_BODIES } else { 0 }
}

/// Writes these numbers into the group of the fields of elements; gives their name with their rows in each step, none.
pub(crate) fn write_bodies(cell_data: &Group, mesh: &Mesh) -> Result<Option<(&'static str, usize)>, FileCause> {
    let Some(bodies) = bodies(mesh) else { return Ok(None) };
    numbers(cell_data, BODY, &[bodies.len()], &bodies)?;
    Ok(Some((BODY, 0)))
}

/// Vectors of a dimension, in rows, with three components each, for ParaView.
#[must_use]
pub fn in_space(values: &[f64], dimension: usize) -> Vec<f64> {
    let mut space = vec![0.0; values.len() / dimension * 3];
    for (to, from) in space.chunks_exact_mut(3).zip(values.chunks_exact(dimension)) {
        to[..dimension].copy_from_slice(from);
    }
    space
}

/// Creates the group `VTKHDF` with the grid, without its `Steps`.
pub(crate) fn write_grid(file: &Group, mesh: &Mesh) -> Result<Group, FileCause> {
    let vtk = group(file, "VTKHDF")?;
    let version = vtk.new_attr::<i64>().shape(2).create("Version").and_then(|a| a.write_raw(&[2_i64, 2]));
    version.map_err(|error| crate::library::refused(&error))?;
    let kind = FixedAscii::<16>::from_ascii(b"UnstructuredGrid");
    attribute(&vtk, "Type", kind.map_err(|_| FileCause::Damaged { detail: "a name".to_string() })?)?;
    let (nodes, cells, n) = (mesh.node_count(), mesh.element_count(), mesh.nodes_of_element());
    for (name, count) in [("NumberOfPoints", nodes), ("NumberOfCells", cells), ("NumberOfConnectivityIds", cells * n)] {
        numbers(&vtk, name, &[1], &[count as i64])?;
    }
    unit(&numbers(&vtk, "Points", &[nodes, 3], &in_space(mesh.points(), mesh.dimension()))?, "m")?;
    let connectivity: Vec<i64> = mesh.cells().flatten().map(|node| node.index() as i64).collect();
    numbers(&vtk, "Connectivity", &[cells * n], &connectivity)?;
    let offsets: Vec<i64> = (0..=cells).map(|e| (e * n) as i64).collect();
    numbers(&vtk, "Offsets", &[cells + 1], &offsets)?;
    numbers(&vtk, "Types", &[cells], &vec![VTK_TYPES[mesh.dimension() - 1].0; cells])?;
    Ok(vtk)
}

/// Creates the groups of faces and elements in the group `percute`.
pub(crate) fn write_groups(ours: &Group, mesh: &Mesh) -> Result<(), FileCause> {
    let faces = group(ours, "face_groups")?;
    for (name, members) in mesh.face_groups() {
        let nodes = members.iter().flat_map(|&face| mesh.face(face).nodes);
        let nodes: Vec<i64> = nodes.map(|node| node.index() as i64).collect();
        numbers(&faces, &encoded(name), &[members.len(), mesh.dimension()], &nodes)?;
    }
    let elements = group(ours, "element_groups")?;
    for (name, members) in mesh.element_groups() {
        let members: Vec<i64> = members.iter().map(|element| element.index() as i64).collect();
        numbers(&elements, &encoded(name), &[members.len()], &members)?;
    }
    Ok(())
}

/// Reads the mesh: points, elements and groups, with their order and orientation.
pub(crate) fn read(opened: &Opened, dimension: usize) -> Result<Mesh, FileCause> {
    let root = opened.root();
    let (vtk, ours) = (root.group("VTKHDF")?, root.group("percute")?);
    let points = vtk.data("Points")?;
    points.expect_dimensions(2, "(nodes, 3)")?;
    let nodes = points.shape[0];
    let points = vectors(&points, &points.floats()?, dimension)?;
    let (cells, count_of_cells) = cells(&vtk, dimension, nodes)?;
    for (name, count) in [("NumberOfPoints", nodes), ("NumberOfCells", count_of_cells)] {
        let Some(data) = vtk.optional(name)? else { continue };
        if let Some(other) = data.integers()?.into_iter().find(|&n| n != count as i64) {
            let detail = format!("{other} does not fit the mesh, which has {count}");
            return Err(FileCause::Value { name: data.name, detail });
        }
    }
    let mut faces = FaceRows::new();
    for_each_group(&ours, "face_groups", |name, members| {
        let count = members.shape.first().copied().unwrap_or(0);
        members.expect(&[count, dimension], "the nodes of each face")?;
        faces.insert(name, members.indices(nodes, "nodes")?);
        Ok(())
    })?;
    let mut elements = ElementGroups::new();
    for_each_group(&ours, "element_groups", |name, members| {
        members.expect_dimensions(1, "(elements)")?;
        elements.insert(name, members.indices(count_of_cells, "elements")?);
        Ok(())
    })?;
    Ok(Mesh::bodies_from_rows(dimension, &points, &cells, (&faces, &elements))?)
}

fn for_each_group(
    ours: &Part<'_>,
    kind: &str,
    mut take: impl FnMut(String, &Data<'_>) -> Result<(), FileCause>,
) -> Result<(), FileCause> {
    let Some(groups) = ours.optional_group(kind)? else { return Ok(()) };
    groups.names()?.iter().try_for_each(|link| take(decoded(link), &groups.data(link)?))
}

/// The nodes of all elements, in rows, and the number of elements.
fn cells(vtk: &Part<'_>, dimension: usize, nodes: usize) -> Result<(Vec<usize>, usize), FileCause> {
    let n = dimension + 1;
    let connectivity = vtk.data("Connectivity")?;
    connectivity.expect_dimensions(1, "(elements x nodes of each)")?;
    let count = connectivity.shape[0] / n;
    connectivity.expect(&[count * n], &format!("{n} nodes for each element"))?;
    let types = vtk.data("Types")?;
    types.expect(&[count], "one type for each element")?;
    let (needed, shape) = VTK_TYPES[dimension - 1];
    if let Some(other) = types.integers()?.into_iter().find(|&t| t != i64::from(needed)) {
        let detail =
            format!("an element has the type {other}; in dimension {dimension} all must be {needed} ({shape})");
        return Err(FileCause::Value { name: types.name, detail });
    }
    let offsets = vtk.data("Offsets")?;
    offsets.expect(&[count + 1], "one more than elements")?;
    let offsets_given = offsets.integers()?;
    if let Some(at) = (0..=count).find(|&e| offsets_given[e] != (e * n) as i64) {
        let detail = format!("entry {at} is {}; it must be {}", offsets_given[at], at * n);
        return Err(FileCause::Value { name: offsets.name, detail });
    }
    Ok((connectivity.indices(nodes, "nodes")?, count))
}

/// Vectors of a dimension, in rows, from the three components stored; the others must be zero.
pub(crate) fn vectors(data: &Data<'_>, values: &[f64], dimension: usize) -> Result<Vec<f64>, FileCause> {
    data.expect(&[data.shape[0], 3], "three components")?;
    let (stored, _) = values.as_chunks::<3>();
    if let Some(at) = stored.iter().position(|v| v[dimension..].iter().any(|x| *x != 0.0)) {
        let row = stored[at];
        let detail =
            format!("row {at} is {row:?}; components beyond the dimension of the problem, {dimension}, must be 0");
        return Err(FileCause::Value { name: data.name.clone(), detail });
    }
    Ok(stored.iter().flat_map(|v| &v[..dimension]).copied().collect())
}
