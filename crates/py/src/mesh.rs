//! Meshes.

use crate::any::AnyMesh;
use crate::{bridge, errors, view};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayDyn, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use percute_core::mesh::{BarMesh, Diagonals, ElementGroups, FacetGroups, Mesh, MeshError, TriangleMesh};
use percute_core::simplex::{ByDimension, Element, Simplex};
use percute_core::{each_dimension, map_dimension};
use percute_io::Overwrite;
use percute_io::gmsh::{self, Format, Version};
use percute_presentation::Body;
use percute_workflow::case::far_origin;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// A checked mesh of either dimension.
#[pyclass(frozen, module = "percute._percute")]
pub(crate) struct MeshData {
    pub(crate) mesh: AnyMesh,
}

type EdgeGroups<'py> = BTreeMap<String, PyReadonlyArray2<'py, i64>>;
type NumberGroups<'py> = BTreeMap<String, PyReadonlyArray1<'py, i64>>;

#[pymethods]
impl MeshData {
    #[staticmethod]
    fn rectangle(py: Python<'_>, width: f64, height: f64, nx: usize, ny: usize, diagonals: &str) -> PyResult<Self> {
        let cut = Diagonals::named(diagonals);
        let cut = cut.ok_or_else(|| errors::input(py, "`diagonals` has a name that is not known"))?;
        let mesh = bridge::blocking(py, None, move |_| TriangleMesh::rectangle_cut(width, height, nx, ny, cut))?;
        Ok(Self { mesh: ByDimension::Plane(Arc::new(mesh.map_err(|e| errors::input(py, e))?)) })
    }

    #[staticmethod]
    fn disc(py: Python<'_>, radius: f64, rings: usize) -> PyResult<Self> {
        let mesh = bridge::blocking(py, None, move |_| TriangleMesh::disc(radius, rings))?;
        Ok(Self { mesh: ByDimension::Plane(Arc::new(mesh.map_err(|e| errors::input(py, e))?)) })
    }

    #[staticmethod]
    fn bar(py: Python<'_>, length: f64, elements: usize) -> PyResult<Self> {
        let mesh = bridge::blocking(py, None, move |_| BarMesh::uniform_bar(length, elements))?;
        Ok(Self { mesh: ByDimension::Bar(Arc::new(mesh.map_err(|e| errors::input(py, e))?)) })
    }

    /// The mesh with each element cut into halves (a bar) or quarters, so many times.
    fn refined(&self, py: Python<'_>, times: usize) -> PyResult<Self> {
        let mut mesh = self.mesh.clone();
        for _ in 0..times {
            mesh = map_dimension!(mesh, mesh => {
                let finer = bridge::blocking(py, None, move |_| mesh.refined())?;
                Arc::new(finer.map_err(|e| errors::input(py, e))?)
            });
        }
        Ok(Self { mesh })
    }

    /// The mesh with the chosen elements cut into halves (a bar) or quarters, and the neighbours that must be cut too.
    fn refined_where(&self, py: Python<'_>, chosen: Vec<bool>) -> PyResult<Self> {
        let mesh = map_dimension!(self.mesh.clone(), mesh => {
            let chosen = chosen.clone();
            let finer = bridge::blocking(py, None, move |_| mesh.refined_where(|e| chosen[e.index()]))?;
            Arc::new(finer.map_err(|e| errors::input(py, e))?)
        });
        Ok(Self { mesh })
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
        let mesh = if points.as_array().ncols() == 1 {
            ByDimension::Bar(from_arrays(py, &points, &cells, &edge_groups, &element_groups)?)
        } else {
            ByDimension::Plane(from_arrays(py, &points, &cells, &edge_groups, &element_groups)?)
        };
        Ok(Self { mesh })
    }

    /// The meshes of several bodies as one, each with its name.
    #[staticmethod]
    fn joined(py: Python<'_>, bodies: Vec<(String, PyRef<'_, Self>)>) -> PyResult<Self> {
        let (mut bars, mut plane) = (Vec::new(), Vec::new());
        for (name, body) in bodies {
            match &body.mesh {
                ByDimension::Bar(mesh) => bars.push((name, mesh.clone())),
                ByDimension::Plane(mesh) => plane.push((name, mesh.clone())),
            }
        }
        Ok(Self {
            mesh: match plane.is_empty() {
                true => ByDimension::Bar(joined(py, bars)?),
                false => ByDimension::Plane(joined(py, plane)?),
            },
        })
    }

    /// The mesh with its origin in another place, turned about it by an angle (degrees).
    fn placed(&self, py: Python<'_>, origin: Vec<f64>, degrees: f64) -> PyResult<Self> {
        let mesh = map_dimension!(&self.mesh, mesh => {
            let origin = std::array::from_fn(|c| origin.get(c).copied().unwrap_or_default());
            let far = || far_origin(mesh, &origin).map(|far| format!("`origin` {far}"));
            let told = |error: MeshError| far().unwrap_or_else(|| error.to_string());
            Arc::new(mesh.placed(&origin, degrees).map_err(|error| errors::input(py, told(error)))?)
        });
        Ok(Self { mesh })
    }

    /// The elements of a group as a mesh of their own; None if there is no such group.
    fn part_of_group(&self, py: Python<'_>, group: &str) -> PyResult<Option<Self>> {
        let mesh = map_dimension!(&self.mesh, mesh => {
            let Some(part) = mesh.part_of_group(group) else { return Ok(None) };
            Arc::new(part.map_err(|e| errors::input(py, e))?)
        });
        Ok(Some(Self { mesh }))
    }

    /// A mesh in a file of Gmsh.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf, scale: f64) -> PyResult<Self> {
        let read = bridge::blocking(py, None, move |_| gmsh::read(&path, scale))?;
        let read = read.map_err(|error| errors::gmsh(py, &error))?;
        Ok(Self { mesh: map_dimension!(read, read => Arc::new(read.mesh)) })
    }

    /// Writes a file of Gmsh, of version 2.2 if it is `old` and of 4.1 otherwise.
    fn write(&self, py: Python<'_>, path: PathBuf, old: bool, binary: bool, overwrite: bool) -> PyResult<()> {
        let format = Format { version: if old { Version::V22 } else { Version::V41 }, binary };
        let overwrite = Overwrite::allowed(overwrite);
        let written = each_dimension!(&self.mesh, mesh => {
            let mesh = mesh.clone();
            bridge::blocking(py, None, move |_| gmsh::write(&path, overwrite, &mesh, format))?
        });
        written.map_err(|error| errors::gmsh(py, &error))
    }

    /// What was reported when it was read.
    fn import_warnings(&self) -> Vec<String> {
        let warnings = each_dimension!(&self.mesh, mesh => mesh.import_warnings());
        warnings.iter().map(|warning| warning.message.clone()).collect()
    }

    /// The closed lines around bodies and holes, by their nodes.
    fn outline<'py>(&self, py: Python<'py>) -> Vec<Bound<'py, PyArray1<i64>>> {
        let lines = each_dimension!(&self.mesh, mesh => Body::new(mesh).outline());
        lines.iter().map(|line| view::column(py, &line[..line.len() - 1], |&node| node as i64)).collect()
    }

    /// Area (m²) or length (m) of each element.
    fn areas<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let areas = each_dimension!(&self.mesh, mesh => mesh.volumes());
        view::column(py, &areas, |&area| area)
    }

    #[getter]
    fn dimension(&self) -> usize {
        match self.mesh {
            ByDimension::Bar(_) => 1,
            ByDimension::Plane(_) => 2,
        }
    }

    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        each_dimension!(&self.mesh, mesh => {
            view::view(py, mesh, |m| m.points().as_flattened(), &[mesh.node_count(), self.dimension()])
        })
    }

    #[getter]
    fn cells<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<u32>>> {
        let shape = [each_dimension!(&self.mesh, mesh => mesh.element_count()), self.dimension() + 1];
        each_dimension!(&self.mesh, mesh => view::view(py, mesh, |m| view::numbers(m.cells().as_flattened()), &shape))
    }

    /// Name of each group of facets, with the nodes of each of its facets.
    #[getter]
    fn edge_groups<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        each_dimension!(&self.mesh, mesh => {
            let groups = PyDict::new(py);
            for (name, facets) in mesh.facet_groups() {
                let nodes = facets.iter().flat_map(|f| mesh.facets()[f.index()].nodes).map(|n| n.index() as i64);
                groups.set_item(name, rows(py, nodes.collect(), self.dimension())?)?;
            }
            Ok(groups)
        })
    }

    /// Name of each group of elements, with their numbers.
    #[getter]
    fn element_groups<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        each_dimension!(&self.mesh, mesh => {
            let groups = PyDict::new(py);
            for (name, elements) in mesh.element_groups() {
                groups.set_item(name, view::column(py, elements, |e| e.index() as i64))?;
            }
            Ok(groups)
        })
    }

    /// The number of the body of each element.
    #[getter]
    fn bodies<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        let bodies = each_dimension!(&self.mesh, mesh => mesh.part_of_elements());
        view::column(py, &bodies, |&body| body as i64)
    }

    #[getter]
    fn size(&self) -> f64 {
        each_dimension!(&self.mesh, mesh => mesh.size())
    }

    #[getter]
    fn reoriented_elements(&self) -> usize {
        each_dimension!(&self.mesh, mesh => mesh.reoriented_elements())
    }
}

fn rows<'py>(py: Python<'py>, numbers: Vec<i64>, columns: usize) -> PyResult<Bound<'py, PyArray2<i64>>> {
    let array = numbers.into_pyarray(py);
    let array = array.reshape([array.len()? / columns, columns])?;
    array.readwrite().make_nonwriteable();
    Ok(array)
}

fn joined<const D: usize, const N: usize>(
    py: Python<'_>,
    bodies: Vec<(String, Arc<Mesh<D, N>>)>,
) -> PyResult<Arc<Mesh<D, N>>>
where
    Element<D, N>: Simplex<D, N>,
{
    let made = bridge::blocking(py, None, move |_| {
        let bodies: Vec<_> = bodies.iter().map(|(name, mesh)| (name.as_str(), &**mesh)).collect();
        Mesh::joined(&bodies).map_err(|error| match Mesh::overlapping(&bodies, &error) {
            Some((second, told)) => format!("`bodies[{second}]`: \"{}\" {told}", bodies[second].0),
            None => format!("`bodies`: {error}"),
        })
    })?;
    made.map(Arc::new).map_err(|told| errors::input(py, told))
}

fn from_arrays<const D: usize, const N: usize>(
    py: Python<'_>,
    points: &PyReadonlyArray2<'_, f64>,
    cells: &PyReadonlyArray2<'_, i64>,
    edge_groups: &EdgeGroups<'_>,
    element_groups: &NumberGroups<'_>,
) -> PyResult<Arc<Mesh<D, N>>>
where
    Element<D, N>: Simplex<D, N>,
{
    let points = points.as_slice()?.as_chunks::<D>().0.to_vec();
    let cells = indices::<N>(py, "cells", cells.as_slice()?)?;
    let mut edges = FacetGroups::new();
    for (name, members) in edge_groups {
        edges.insert(name.clone(), indices(py, &format!("edge_groups[{name:?}]"), members.as_slice()?)?);
    }
    let mut elements = ElementGroups::new();
    for (name, members) in element_groups {
        let members = indices::<1>(py, &format!("element_groups[{name:?}]"), members.as_slice()?)?;
        elements.insert(name.clone(), members.into_iter().flatten().collect());
    }
    let mesh = bridge::blocking(py, None, move |_| Mesh::new(points, &cells, &edges, &elements))?;
    mesh.map(Arc::new).map_err(|error| errors::input(py, error))
}

/// Rows of indices, none of them negative.
fn indices<const C: usize>(py: Python<'_>, name: &str, numbers: &[i64]) -> PyResult<Vec<[usize; C]>> {
    if let Some(at) = numbers.iter().position(|&n| n < 0) {
        let message = format!("`{name}`: entry {} is {}; numbers are counted from 0", at / C, numbers[at]);
        return Err(errors::input(py, message));
    }
    Ok(numbers.as_chunks::<C>().0.iter().map(|row| row.map(|n| n as usize)).collect())
}
