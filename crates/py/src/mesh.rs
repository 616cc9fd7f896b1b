//! Meshes.

use crate::{bridge, errors, view};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayDyn, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use percute_core::mesh::{Diagonals, ElementGroups, FaceRows, Mesh, MeshError};
use percute_io::Overwrite;
use percute_io::gmsh::{self, MeshFormat, Version};
use percute_presentation::Body;
use percute_workflow::case::far_origin;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// A checked mesh of any dimension.
#[pyclass(frozen, module = "percute._percute")]
pub(crate) struct MeshData {
    pub(crate) mesh: Arc<Mesh>,
}

type EdgeGroups<'py> = BTreeMap<String, PyReadonlyArray2<'py, i64>>;
type NumberGroups<'py> = BTreeMap<String, PyReadonlyArray1<'py, i64>>;

#[pymethods]
impl MeshData {
    #[staticmethod]
    fn rectangle(py: Python<'_>, width: f64, height: f64, nx: usize, ny: usize, diagonals: &str) -> PyResult<Self> {
        let cut = Diagonals::named(diagonals);
        let cut = cut.ok_or_else(|| errors::input(py, "`diagonals` has a name that is not known"))?;
        made(py, move || Mesh::rectangle_cut(width, height, nx, ny, cut))
    }

    #[staticmethod]
    fn disc(py: Python<'_>, radius: f64, rings: usize) -> PyResult<Self> {
        made(py, move || Mesh::disc(radius, rings))
    }

    #[staticmethod]
    fn bar(py: Python<'_>, length: f64, elements: usize) -> PyResult<Self> {
        made(py, move || Mesh::uniform_bar(length, elements))
    }

    #[staticmethod]
    fn r#box(py: Python<'_>, size: [f64; 3], cells: [usize; 3]) -> PyResult<Self> {
        made(py, move || Mesh::cuboid(size, cells))
    }

    #[staticmethod]
    fn cylinder(py: Python<'_>, radius: f64, height: f64, rings: usize, layers: usize) -> PyResult<Self> {
        made(py, move || Mesh::cylinder(radius, height, rings, layers))
    }

    #[staticmethod]
    fn ball(py: Python<'_>, radius: f64, rings: usize) -> PyResult<Self> {
        made(py, move || Mesh::ball(radius, rings))
    }

    /// The mesh with each element cut into halves (a bar), quarters or eighths, so many times.
    fn refined(&self, py: Python<'_>, times: usize) -> PyResult<Self> {
        let mesh = self.mesh.clone();
        made(py, move || (0..times).try_fold(Mesh::clone(&mesh), |mesh, _| mesh.refined()))
    }

    /// The mesh with the chosen elements cut into halves (a bar), quarters or eighths, and the neighbours that must be
    /// cut.
    fn refined_where(&self, py: Python<'_>, chosen: Vec<bool>) -> PyResult<Self> {
        let mesh = self.mesh.clone();
        made(py, move || mesh.refined_where(|e| chosen[e.index()]))
    }

    /// A mesh from contiguous arrays whose shapes have been checked.
    #[staticmethod]
    fn from_arrays(
        py: Python<'_>,
        points: PyReadonlyArray2<'_, f64>,
        cells: PyReadonlyArray2<'_, i64>,
        edge_groups: EdgeGroups<'_>,
        element_groups: NumberGroups<'_>,
    ) -> PyResult<Self> {
        let dimension = points.as_array().ncols();
        let points = points.as_slice()?.to_vec();
        let cells = indices(py, "cells", cells.as_slice()?, dimension + 1)?;
        let (mut edges, mut elements) = (FaceRows::new(), ElementGroups::new());
        for (name, members) in edge_groups {
            let told = format!("{}_groups[{name:?}]", if dimension == 3 { "face" } else { "edge" });
            edges.insert(name, indices(py, &told, members.as_slice()?, dimension)?);
        }
        for (name, members) in element_groups {
            let told = format!("element_groups[{name:?}]");
            elements.insert(name, indices(py, &told, members.as_slice()?, 1)?);
        }
        made(py, move || Mesh::from_rows(dimension, &points, &cells, (&edges, &elements)))
    }

    /// The meshes of several bodies as one, each with its name.
    #[staticmethod]
    fn joined(py: Python<'_>, bodies: Vec<(String, PyRef<'_, Self>)>) -> PyResult<Self> {
        let bodies: Vec<_> = bodies.into_iter().map(|(name, body)| (name, body.mesh.clone())).collect();
        let joined = move |_| {
            let bodies: Vec<_> = bodies.iter().map(|(name, mesh)| (name.as_str(), &**mesh)).collect();
            Mesh::joined(&bodies).map_err(|error| match Mesh::overlapping(&bodies, &error) {
                Some((second, told)) => format!("`bodies[{second}]`: \"{}\" {told}", bodies[second].0),
                None => format!("`bodies`: {error}"),
            })
        };
        let mesh = bridge::blocking(py, None, joined)?.map_err(|told| errors::input(py, told))?;
        Ok(Self { mesh: mesh.into() })
    }

    /// The mesh with its origin in another place, turned about it by an angle (degrees).
    fn placed(&self, py: Python<'_>, origin: Vec<f64>, degrees: f64) -> PyResult<Self> {
        let origin = std::array::from_fn(|c| origin.get(c).copied().unwrap_or_default());
        let far = || far_origin(&self.mesh, &origin).map(|far| format!("`origin` {far}"));
        let told = |error: MeshError| far().unwrap_or_else(|| error.to_string());
        let mesh = self.mesh.placed(&origin, degrees).map_err(|error| errors::input(py, told(error)))?;
        Ok(Self { mesh: mesh.into() })
    }

    /// The elements of a group as a mesh of their own; None if there is no such group.
    fn part_of_group(&self, py: Python<'_>, group: &str) -> PyResult<Option<Self>> {
        let part = self.mesh.part_of_group(group).transpose().map_err(|error| errors::input(py, error))?;
        Ok(part.map(|mesh| Self { mesh: mesh.into() }))
    }

    /// A mesh in a file of Gmsh.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf, scale: f64) -> PyResult<Self> {
        let read = bridge::blocking(py, None, move |_| gmsh::read(&path, scale))?;
        let read = read.map_err(|error| errors::gmsh(py, &error))?;
        Ok(Self { mesh: read.mesh.into() })
    }

    /// Writes a file of Gmsh, of version 2.2 if it is `old` and of 4.1 otherwise.
    fn write(&self, py: Python<'_>, path: PathBuf, old: bool, binary: bool, overwrite: bool) -> PyResult<()> {
        let format = MeshFormat { version: if old { Version::V22 } else { Version::V41 }, binary };
        let overwrite = Overwrite::allowed(overwrite);
        let mesh = self.mesh.clone();
        let written = bridge::blocking(py, None, move |_| gmsh::write(&path, overwrite, &mesh, format))?;
        written.map_err(|error| errors::gmsh(py, &error))
    }

    /// What was reported when it was read.
    fn import_warnings(&self) -> Vec<String> {
        let warnings = self.mesh.import_warnings();
        warnings.iter().map(|warning| warning.message.clone()).collect()
    }

    /// The closed lines around bodies and holes, by their nodes.
    fn outline<'py>(&self, py: Python<'py>) -> Vec<Bound<'py, PyArray1<i64>>> {
        let lines = Body::new(&self.mesh).outline();
        lines.iter().map(|line| view::column(py, &line[..line.len() - 1], |&node| node as i64)).collect()
    }

    /// Area (m²), length (m) or volume (m³) of each element.
    fn areas<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let areas = self.mesh.volumes();
        view::column(py, &areas, |&area| area)
    }

    #[getter]
    fn dimension(&self) -> usize {
        self.mesh.dimension()
    }

    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let shape = [self.mesh.node_count(), self.dimension()];
        view::view(py, &self.mesh, Mesh::points, &shape)
    }

    #[getter]
    fn cells<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<u32>>> {
        let shape = [self.mesh.element_count(), self.dimension() + 1];
        view::view(py, &self.mesh, |mesh| view::numbers(mesh.cell_rows()), &shape)
    }

    /// Name of each group of faces, with the nodes of each of its faces.
    #[getter]
    fn edge_groups<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let groups = PyDict::new(py);
        for (name, faces) in self.mesh.face_groups() {
            let nodes = faces.iter().flat_map(|&f| self.mesh.face(f).nodes).map(|n| n.index() as i64);
            groups.set_item(name, rows(py, nodes.collect(), self.dimension())?)?;
        }
        Ok(groups)
    }

    /// Name of each group of elements, with their numbers.
    #[getter]
    fn element_groups<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let groups = PyDict::new(py);
        for (name, elements) in self.mesh.element_groups() {
            groups.set_item(name, view::column(py, elements, |e| e.index() as i64))?;
        }
        Ok(groups)
    }

    /// The number of the body of each element.
    #[getter]
    fn bodies<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        let bodies = self.mesh.part_of_elements();
        view::column(py, &bodies, |&body| body as i64)
    }

    #[getter]
    fn size(&self) -> f64 {
        self.mesh.size()
    }

    #[getter]
    fn reoriented_elements(&self) -> usize {
        self.mesh.reoriented_elements()
    }
}

fn rows<'py>(py: Python<'py>, numbers: Vec<i64>, columns: usize) -> PyResult<Bound<'py, PyArray2<i64>>> {
    let array = numbers.into_pyarray(py);
    let array = array.reshape([array.len()? / columns, columns])?;
    array.readwrite().make_nonwriteable();
    Ok(array)
}

fn made(py: Python<'_>, work: impl FnOnce() -> Result<Mesh, MeshError> + Send + 'static) -> PyResult<MeshData> {
    let mesh = bridge::blocking(py, None, move |_| work())?.map_err(|error| errors::input(py, error))?;
    Ok(MeshData { mesh: mesh.into() })
}

/// Indices, none of them negative, with so many in a row.
fn indices(py: Python<'_>, name: &str, numbers: &[i64], columns: usize) -> PyResult<Vec<usize>> {
    if let Some(at) = numbers.iter().position(|&n| n < 0) {
        let message = format!("`{name}`: entry {} is {}; numbers are counted from 0", at / columns, numbers[at]);
        return Err(errors::input(py, message));
    }
    Ok(numbers.iter().map(|&n| n as usize).collect())
}
