//! Problems.

use crate::any::AnyProblem;
use crate::mesh::MeshData;
use crate::{bridge, errors, statement, view};
use numpy::{PyArray1, PyArrayDyn, PyReadonlyArray2};
use percute_core::contact::Obstacle;
use percute_core::dynamics::critical_time_step;
use percute_core::load::{BodyForce, Support, Traction};
use percute_core::material::{Elastic, Hypothesis, Law};
use percute_core::mesh::Mesh;
use percute_core::problem::{Contact, Initial, InputError, Problem};
use percute_core::simplex::ByDimension;
use percute_core::{each_dimension, map_dimension};
use percute_workflow::Failure;
use percute_workflow::case::ONE_BODY;
use percute_workflow::restated::Restated;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::{Arc, OnceLock};

/// A checked problem of either dimension.
#[pyclass(frozen, module = "percute._percute")]
pub(crate) struct ProblemData {
    pub(crate) problem: AnyProblem,
    critical_step: OnceLock<f64>,
}

/// Value objects in the order in which they were stated.
type Objects<'py> = Vec<Bound<'py, PyAny>>;
/// A nodal field: one row for all nodes, or one for each.
type Field<'py> = Option<PyReadonlyArray2<'py, f64>>;

/// What a problem takes beside its mesh.
struct Stated<const D: usize> {
    groups: Vec<Option<String>>,
    materials: Vec<Elastic>,
    obstacles: Vec<Obstacle<D>>,
    contacts: Vec<Contact>,
    /// Whether all bodies may touch each other.
    automatic: bool,
    supports: Vec<Support<D>>,
    tractions: Vec<Traction<D>>,
    body_forces: Vec<BodyForce<D>>,
    velocity: Initial<D>,
    displacement: Initial<D>,
}

impl ProblemData {
    pub(crate) fn new(problem: AnyProblem) -> Self {
        Self { problem, critical_step: OnceLock::new() }
    }

    /// Δt_c (s), computed once.
    pub(crate) fn critical_step(&self, py: Python<'_>) -> PyResult<f64> {
        if let Some(&step) = self.critical_step.get() {
            return Ok(step);
        }
        let problem = self.problem.clone();
        let step = bridge::blocking(py, None, move |_| each_dimension!(&problem, p => critical_time_step(p)))?;
        Ok(*self.critical_step.get_or_init(|| step))
    }
}

impl ProblemData {
    /// Refuses a body that starts on a plane and moves into it, for histories that are not simulated here.
    pub(crate) fn check_planes(&self, py: Python<'_>) -> PyResult<()> {
        let checked = each_dimension!(&self.problem, p => p.check_planes());
        checked.map_err(|error| errors::problem(py, &error, &[]))
    }
}

fn on<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    mesh: &Mesh<D, N>,
) -> Result<Arc<Problem<D, N>>, Failure> {
    Restated::new(problem)?.on(mesh.clone()).map(Arc::new)
}

#[pymethods]
impl ProblemData {
    /// Checks and builds; `materials` pairs each group of elements, or none, with its material. With `automatic` all
    /// bodies may touch each other.
    #[new]
    #[allow(clippy::too_many_arguments)]
    fn build(
        py: Python<'_>,
        mesh: &MeshData,
        materials: Vec<(Option<String>, Bound<'_, PyAny>)>,
        obstacles: Objects<'_>,
        contacts: Objects<'_>,
        supports: Objects<'_>,
        tractions: Objects<'_>,
        body_forces: Objects<'_>,
        velocity: Field<'_>,
        displacement: Field<'_>,
        automatic: bool,
    ) -> PyResult<Self> {
        let lists = [&obstacles, &contacts, &supports, &tractions, &body_forces];
        let fields = [&velocity, &displacement];
        let problem = match &mesh.mesh {
            ByDimension::Bar(mesh) => ByDimension::Bar(build(py, mesh, &materials, lists, fields, automatic)?),
            ByDimension::Plane(mesh) => ByDimension::Plane(build(py, mesh, &materials, lists, fields, automatic)?),
        };
        Ok(Self::new(problem))
    }

    /// A copy of the mesh.
    fn mesh(&self) -> MeshData {
        MeshData { mesh: map_dimension!(&self.problem, p => Arc::new(p.mesh().clone())) }
    }

    /// The problem on another mesh of its body.
    fn on(&self, py: Python<'_>, mesh: &MeshData) -> PyResult<Self> {
        let (problem, mesh) = (self.problem.clone(), mesh.mesh.clone());
        let made = bridge::blocking(py, None, move |_| match (&problem, &mesh) {
            (ByDimension::Bar(problem), ByDimension::Bar(mesh)) => on(problem, mesh).map(ByDimension::Bar),
            (ByDimension::Plane(problem), ByDimension::Plane(mesh)) => on(problem, mesh).map(ByDimension::Plane),
            _ => Err(Failure::Argument("`mesh` has another dimension than the mesh of the problem".to_string())),
        })?;
        made.map(Self::new).map_err(|error| errors::run(py, &error))
    }

    #[getter]
    fn critical_time_step(&self, py: Python<'_>) -> PyResult<f64> {
        self.critical_step(py)
    }

    /// The problem with planes moved away that a body is on and moves into, for steps as `simulate` takes them; none
    /// without such a plane, or if the steps make no sense.
    fn with_planes_moved(
        &self,
        py: Python<'_>,
        courant: Option<f64>,
        step: Option<f64>,
        steps: Option<Vec<f64>>,
    ) -> PyResult<Option<Self>> {
        if each_dimension!(&self.problem, p => p.check_planes()).is_ok() {
            return Ok(None);
        }
        let first = match (courant, step, steps.as_deref()) {
            (Some(courant), None, None) => courant * self.critical_step(py)?,
            (None, Some(step), None) => step,
            (None, None, Some([first, ..])) => *first,
            _ => return Ok(None),
        };
        if !(first.is_finite() && first > 0.0) {
            return Ok(None);
        }
        Ok(match &self.problem {
            ByDimension::Bar(problem) => {
                problem.with_planes_moved(first).map(|moved| ByDimension::Bar(Arc::new(moved)))
            }
            ByDimension::Plane(problem) => {
                problem.with_planes_moved(first).map(|moved| ByDimension::Plane(Arc::new(moved)))
            }
        }
        .map(Self::new))
    }

    #[getter]
    fn per_metre(&self) -> bool {
        each_dimension!(&self.problem, p => p.units().per_metre)
    }

    #[getter]
    fn mass<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        each_dimension!(&self.problem, p => view::view(py, p, |p| p.mass(), &[p.mass().len()]))
    }

    #[getter]
    fn initial_displacement<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        each_dimension!(&self.problem, p => view::field(py, p, |p| p.initial_displacement(), &[p.mesh().node_count()]))
    }

    #[getter]
    fn initial_velocity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        each_dimension!(&self.problem, p => view::field(py, p, |p| p.initial_velocity(), &[p.mesh().node_count()]))
    }

    #[getter]
    fn contact_nodes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        each_dimension!(&self.problem, p => view::column(py, p.surface().nodes(), |c| c.node.index() as i64))
    }

    #[getter]
    fn wave_speed(&self) -> f64 {
        each_dimension!(&self.problem, p => p.materials().iter().map(Elastic::wave_speed).fold(0.0, f64::max))
    }

    /// σ_xx, σ_yy and σ_xy of a unit strain ε_xx, ε_xx and 2ε_xy, and σ_zz of a unit tr ε, for each element (Pa).
    fn stiffness<'py>(&self, py: Python<'py>) -> [Bound<'py, PyArray1<f64>>; 4] {
        each_dimension!(&self.problem, p => {
            let of = |number: fn(&Elastic) -> f64| {
                let materials: Vec<f64> = p.materials().iter().map(number).collect();
                let numbers = p.element_material().iter().map(|m| materials[usize::from(*m)]);
                PyArray1::from_iter(py, numbers)
            };
            [of(|m| unit(m)[0][0]), of(|m| unit(m)[1][1]), of(shear), of(across)]
        })
    }

    /// Groups and arguments of the materials.
    fn materials<'py>(&self, py: Python<'py>) -> PyResult<Vec<(Option<String>, Bound<'py, PyDict>)>> {
        let materials = each_dimension!(&self.problem, p => &p.statement().materials);
        materials.iter().map(|(group, law)| Ok((group.clone(), statement::material_arguments(py, law)?))).collect()
    }

    /// Arguments of the planes.
    fn obstacles<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        each_dimension!(&self.problem, p => {
            let planes = p.obstacles().iter().filter_map(|obstacle| Some((obstacle, obstacle.as_plane()?)));
            planes.map(|plane| statement::plane_arguments(py, plane)).collect()
        })
    }

    /// Arguments of the contacts of bodies.
    fn contacts<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let interfaces = each_dimension!(&self.problem, p => &p.statement().interfaces);
        interfaces.iter().map(|interface| statement::contact_arguments(py, interface)).collect()
    }

    /// Arguments of the supports.
    fn supports<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        each_dimension!(&self.problem, p => {
            p.statement().supports.iter().map(|s| statement::support_arguments(py, s)).collect()
        })
    }

    /// Arguments of the tractions.
    fn tractions<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        each_dimension!(&self.problem, p => {
            p.statement().tractions.iter().map(|t| statement::traction_arguments(py, t)).collect()
        })
    }

    /// Arguments of the body forces.
    fn body_forces<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        each_dimension!(&self.problem, p => {
            p.statement().body_forces.iter().map(|f| statement::body_force_arguments(py, f)).collect()
        })
    }
}

/// Stress of a unit strain along x (Pa).
fn unit(material: &Elastic) -> [[f64; 2]; 2] {
    material.stress(&[[1.0, 0.0], [0.0, 0.0]])
}

/// G (Pa).
fn shear(material: &Elastic) -> f64 {
    material.young() / (2.0 * (1.0 + material.poisson()))
}

/// λ of plane strain, where σ_zz = λ tr ε; else 0 (Pa).
fn across(material: &Elastic) -> f64 {
    if material.hypothesis() == Hypothesis::PlaneStrain { unit(material)[1][1] } else { 0.0 }
}

fn build<const D: usize, const N: usize>(
    py: Python<'_>,
    mesh: &Arc<Mesh<D, N>>,
    materials: &[(Option<String>, Bound<'_, PyAny>)],
    lists: [&Objects<'_>; 5],
    fields: [&Field<'_>; 2],
    automatic: bool,
) -> PyResult<Arc<Problem<D, N>>> {
    let law = |(group, law): &(Option<String>, Bound<'_, PyAny>)| {
        let name = group.as_ref().map_or_else(|| "material".to_string(), |group| format!("material[{group:?}]"));
        statement::material::<D>(&name, law)
    };
    let of_all = |given: &Bound<'_, PyAny>| -> PyResult<bool> {
        Ok(given.getattr("groups")?.is_none() && given.getattr("bodies")?.is_none())
    };
    for (index, contact) in lists[1].iter().enumerate().filter(|_| mesh.parts() < 2) {
        if of_all(contact)? {
            return Err(errors::input(py, format!("`contacts[{index}]`: {ONE_BODY}")));
        }
    }
    let stated = Stated {
        groups: materials.iter().map(|(group, _)| group.clone()).collect(),
        materials: materials.iter().map(law).collect::<PyResult<_>>()?,
        obstacles: each(lists[0], "obstacles", statement::plane)?,
        contacts: each(lists[1], "contacts", statement::contact::<D>)?,
        automatic,
        supports: each(lists[2], "supports", statement::support)?,
        tractions: each(lists[3], "tractions", statement::traction)?,
        body_forces: each(lists[4], "body_forces", statement::body_force)?,
        velocity: field(py, "initial_velocity", fields[0])?,
        displacement: field(py, "initial_displacement", fields[1])?,
    };
    let (mesh, groups) = (mesh.clone(), stated.groups.clone());
    let built = bridge::blocking(py, None, move |_| assemble(&mesh, stated))?;
    built.map(Arc::new).map_err(|error| errors::problem(py, &error, &groups))
}

fn assemble<const D: usize, const N: usize>(mesh: &Mesh<D, N>, stated: Stated<D>) -> Result<Problem<D, N>, InputError> {
    let mut builder =
        Problem::builder(mesh.clone()).initial_velocity(stated.velocity).initial_displacement(stated.displacement);
    for (group, law) in stated.groups.into_iter().zip(stated.materials) {
        builder = match group {
            Some(group) => builder.material_of(group, law),
            None => builder.material(law),
        };
    }
    builder = stated.obstacles.into_iter().fold(builder, |b, plane| b.obstacle(plane));
    builder = stated.contacts.into_iter().fold(builder, |b, contact| b.contact(contact));
    if stated.automatic {
        builder = builder.automatic_contact();
    }
    builder = stated.supports.into_iter().fold(builder, |b, support| b.support(support));
    builder = stated.tractions.into_iter().fold(builder, |b, traction| b.traction(traction));
    builder = stated.body_forces.into_iter().fold(builder, |b, force| b.body_force(force));
    builder.planes_to_be_moved().build()
}

/// Reads each object of a list under its name.
fn each<T>(
    objects: &Objects<'_>,
    list: &str,
    read: impl Fn(&str, &Bound<'_, PyAny>) -> PyResult<T>,
) -> PyResult<Vec<T>> {
    objects.iter().enumerate().map(|(i, object)| read(&format!("{list}[{i}]"), object)).collect()
}

/// A mesh has two nodes or more: one row is for all.
fn field<const D: usize>(py: Python<'_>, name: &str, given: &Field<'_>) -> PyResult<Initial<D>> {
    let Some(array) = given else { return Ok(Initial::Uniform([0.0; D])) };
    let columns = array.as_array().ncols();
    if columns != D {
        let needed = if D == 1 { "one number for a bar" } else { "two numbers, x and y, for a plane body" };
        let message = format!(
            "`{name}` has {columns} numbers in a row; it must have {needed}: one row for all nodes, or one for each"
        );
        return Err(errors::input(py, message));
    }
    let rows = array.as_slice()?.as_chunks::<D>().0;
    Ok(if let [row] = rows { Initial::Uniform(*row) } else { Initial::Nodal(rows.to_vec()) })
}
