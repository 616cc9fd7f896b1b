//! Problems.

use crate::mesh::MeshData;
use crate::{bridge, errors, statement, view};
use numpy::{PyArray1, PyArrayDyn, PyReadonlyArray2};
use percute_core::contact::AnyObstacle;
use percute_core::dynamics::{critical_time_step, first_stable_step};
use percute_core::material::{Elastic, Hypothesis, Law};
use percute_core::mesh::Mesh;
use percute_core::problem::{AnyProblem, Statement};
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
        let step = bridge::blocking(py, None, move |_| critical_time_step(&problem))?;
        Ok(*self.critical_step.get_or_init(|| step))
    }

    /// The step (s) that a Courant number, if it is given, refers to: Δt_c, or the stable step at the start of a body
    /// that may turn.
    pub(crate) fn stable_step(&self, py: Python<'_>, courant: Option<f64>) -> PyResult<f64> {
        match courant.is_some() && self.problem.is_finite() {
            true => Ok(first_stable_step(&self.problem)),
            false => self.critical_step(py),
        }
    }

    /// Refuses a body that starts on a plane and moves into it, for histories that are not simulated here.
    pub(crate) fn check_planes(&self, py: Python<'_>) -> PyResult<()> {
        self.problem.check_planes().map_err(|error| errors::problem(py, &error, &[]))
    }

    fn view<'py>(
        &self,
        py: Python<'py>,
        numbers: for<'a> fn(&'a AnyProblem) -> &'a [f64],
        shape: &[usize],
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        view::view(py, &Arc::new(self.problem.clone()), numbers, shape)
    }

    /// The shape of a field of vectors at the nodes.
    fn shape(&self) -> [usize; 2] {
        [self.problem.mesh().node_count(), self.problem.dimension()]
    }
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
        build(py, &mesh.mesh, &materials, lists, fields, automatic).map(Self::new)
    }

    /// A copy of the mesh.
    fn mesh(&self) -> MeshData {
        MeshData { mesh: self.problem.mesh().clone() }
    }

    /// The problem on another mesh of its body.
    fn on(&self, py: Python<'_>, mesh: &MeshData) -> PyResult<Self> {
        let (problem, mesh) = (self.problem.clone(), mesh.mesh.clone());
        if problem.dimension() != mesh.dimension() {
            return Err(errors::input(py, "`mesh` has another dimension than the mesh of the problem"));
        }
        let made = bridge::blocking(py, None, move |_| Restated::new(&problem)?.on(&mesh))?;
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
        if self.problem.check_planes().is_ok() {
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
        Ok(self.problem.with_planes_moved(first).map(Self::new))
    }

    #[getter]
    fn per_metre(&self) -> bool {
        self.problem.units().per_metre
    }

    #[getter]
    fn mass<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.view(py, |problem| problem.mass(), &[self.problem.mesh().node_count()])
    }

    #[getter]
    fn initial_displacement<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.view(py, AnyProblem::initial_displacement, &self.shape())
    }

    #[getter]
    fn initial_velocity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.view(py, AnyProblem::initial_velocity, &self.shape())
    }

    #[getter]
    fn contact_nodes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        view::column(py, self.problem.contact_nodes(), |c| c.node.index() as i64)
    }

    #[getter]
    fn wave_speed(&self) -> f64 {
        self.problem.materials().iter().map(Elastic::wave_speed).fold(0.0, f64::max)
    }

    /// σ_xx, σ_yy and σ_xy of a unit strain ε_xx, ε_xx and 2ε_xy, and σ_zz of a unit tr ε, for each element (Pa).
    fn stiffness<'py>(&self, py: Python<'py>) -> [Bound<'py, PyArray1<f64>>; 4] {
        let of = |number: fn(&Elastic) -> f64| {
            let materials: Vec<f64> = self.problem.materials().iter().map(number).collect();
            let numbers = self.problem.element_material().iter().map(|m| materials[usize::from(*m)]);
            PyArray1::from_iter(py, numbers)
        };
        [of(|m| unit(m)[0][0]), of(|m| unit(m)[1][1]), of(shear), of(across)]
    }

    /// Groups and arguments of the materials.
    fn materials<'py>(&self, py: Python<'py>) -> PyResult<Vec<(Option<String>, Bound<'py, PyDict>)>> {
        let materials = &self.problem.conditions().materials;
        materials.iter().map(|(group, law)| Ok((group.clone(), statement::material_arguments(py, law)?))).collect()
    }

    /// Arguments of the planes.
    fn obstacles<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let planes = self.problem.obstacles().filter(AnyObstacle::is_plane);
        planes.map(|plane| statement::plane_arguments(py, &plane, self.problem.dimension())).collect()
    }

    /// Arguments of the contacts of bodies.
    fn contacts<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let interfaces = &self.problem.conditions().interfaces;
        interfaces.iter().map(|interface| statement::contact_arguments(py, interface)).collect()
    }

    /// Arguments of the supports.
    fn supports<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let supports = &self.problem.conditions().supports;
        supports.iter().map(|s| statement::support_arguments(py, s, self.problem.dimension())).collect()
    }

    /// Arguments of the tractions.
    fn tractions<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let tractions = &self.problem.conditions().tractions;
        tractions.iter().map(|t| statement::traction_arguments(py, t, self.problem.dimension())).collect()
    }

    /// Arguments of the body forces.
    fn body_forces<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let forces = &self.problem.conditions().body_forces;
        forces.iter().map(|f| statement::body_force_arguments(py, f, self.problem.dimension())).collect()
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

fn build(
    py: Python<'_>,
    mesh: &Arc<Mesh>,
    materials: &[(Option<String>, Bound<'_, PyAny>)],
    lists: [&Objects<'_>; 5],
    fields: [&Field<'_>; 2],
    automatic: bool,
) -> PyResult<AnyProblem> {
    let dimension = mesh.dimension();
    let law = |(group, law): &(Option<String>, Bound<'_, PyAny>)| {
        let name = group.as_ref().map_or_else(|| "material".to_string(), |group| format!("material[{group:?}]"));
        Ok((group.clone(), statement::material(&name, law, dimension)?))
    };
    let of_all = |given: &Bound<'_, PyAny>| -> PyResult<bool> {
        Ok(given.getattr("groups")?.is_none() && given.getattr("bodies")?.is_none())
    };
    for (index, contact) in lists[1].iter().enumerate().filter(|_| mesh.parts() < 2) {
        if of_all(contact)? {
            return Err(errors::input(py, format!("`contacts[{index}]`: {ONE_BODY}")));
        }
    }
    let stated = Statement {
        materials: materials.iter().map(law).collect::<PyResult<_>>()?,
        obstacles: each(lists[0], "obstacles", |name, plane| statement::plane(name, plane, dimension))?,
        contacts: each(lists[1], "contacts", |name, contact| statement::contact(name, contact, dimension))?,
        automatic_contact: automatic,
        planes_to_be_moved: true,
        supports: each(lists[2], "supports", |name, support| statement::support(name, support, dimension))?,
        tractions: each(lists[3], "tractions", |name, traction| statement::traction(name, traction, dimension))?,
        body_forces: each(lists[4], "body_forces", |name, force| statement::body_force(name, force, dimension))?,
        gravity: None,
        velocity: field(py, "initial_velocity", fields[0], dimension)?,
        displacement: field(py, "initial_displacement", fields[1], dimension)?,
    };
    let groups: Vec<_> = stated.materials.iter().map(|(group, _)| group.clone()).collect();
    let mesh = mesh.clone();
    let built = bridge::blocking(py, None, move |_| AnyProblem::new(&mesh, &stated))?;
    built.map_err(|error| errors::problem(py, &error, &groups))
}

/// Reads each object of a list under its name.
fn each<T>(
    objects: &Objects<'_>,
    list: &str,
    read: impl Fn(&str, &Bound<'_, PyAny>) -> PyResult<T>,
) -> PyResult<Vec<T>> {
    objects.iter().enumerate().map(|(i, object)| read(&format!("{list}[{i}]"), object)).collect()
}

/// A field in rows: nothing if none is given.
fn field(py: Python<'_>, name: &str, given: &Field<'_>, dimension: usize) -> PyResult<Vec<f64>> {
    let Some(array) = given else { return Ok(Vec::new()) };
    let columns = array.as_array().ncols();
    if columns != dimension {
        let needed = if dimension == 1 { "one number for a bar" } else { "two numbers, x and y, for a plane body" };
        let message = format!(
            "`{name}` has {columns} numbers in a row; it must have {needed}: one row for all nodes, or one for each"
        );
        return Err(errors::input(py, message));
    }
    if array.as_array().nrows() == 0 {
        return Err(errors::input(py, format!("`{name}` has no row; give one row for all nodes, or one for each")));
    }
    Ok(array.as_slice()?.to_vec())
}
