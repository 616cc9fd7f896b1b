//! From the value classes of `percute.statement` to the statement of a problem, and back.

use crate::errors;
use percute_core::contact::{Interface, Obstacle, ObstacleError, Plane};
use percute_core::load::{BodyForce, Profile, Support, Table, TableError, Traction};
use percute_core::material::{Elastic, Hypothesis, Law, MaterialError};
use percute_core::problem::{Between, Contact};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// Names of the axes.
pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];

/// Something is wrong with `name`.
fn wrong(py: Python<'_>, name: &str, message: impl std::fmt::Display) -> PyErr {
    errors::input(py, format!("`{name}` {message}"))
}

/// A vector with a component for each axis of the mesh.
fn vector<const D: usize>(py: Python<'_>, name: &str, given: &[f64]) -> PyResult<[f64; D]> {
    let needed = if D == 1 { "one number for a bar" } else { "two numbers, x and y, for a plane body" };
    given.try_into().map_err(|_| wrong(py, name, format!("has {} numbers; it must have {needed}", given.len())))
}

/// An attribute of a value class, which has checked its type.
fn attribute<'a, 'py, T>(object: &'a Bound<'py, PyAny>, name: &str) -> PyResult<T>
where
    T: for<'b> FromPyObject<'b, 'py, Error = PyErr>,
{
    object.getattr(name)?.extract()
}

/// One material, stated as `name`.
pub(crate) fn material<const D: usize>(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Elastic> {
    let py = given.py();
    let (young, density): (f64, f64) = (attribute(given, "young")?, attribute(given, "density")?);
    let poisson: Option<f64> = attribute(given, "poisson")?;
    let plane: Option<String> = attribute(given, "plane")?;
    let (thickness, section): (f64, Option<f64>) = (attribute(given, "thickness")?, attribute(given, "section")?);
    let yield_stress: Option<f64> = attribute(given, "yield_stress")?;
    let bad = |key: &str, message: &str| wrong(py, &format!("{name}.{key}"), message);
    let refused = |MaterialError { name, value, unit, allowed, .. }| {
        bad(name, &format!("is {value} {unit}; it must be {allowed}"))
    };
    let yielding = |law: Elastic| yield_stress.map_or(Ok(law), |stress| law.with_yield_stress(stress));
    if D == 1 {
        for (key, there) in
            [("poisson", poisson.is_some()), ("plane", plane.is_some()), ("thickness", thickness != 1.0)]
        {
            if there {
                return Err(bad(key, "does not apply to a bar; give a `section` (m²)"));
            }
        }
        let section = section.ok_or_else(|| bad("section", "is missing: a bar needs it (m²)"))?;
        let law = Elastic::bar(young, density, section);
        return law.and_then(yielding).map_err(refused);
    }
    if section.is_some() {
        return Err(bad("section", "applies to bars only; a plane body has a `thickness` (m)"));
    }
    let poisson = poisson.ok_or_else(|| bad("poisson", "is missing: a plane body needs it"))?;
    match plane.as_deref() {
        Some("stress") => Elastic::plane_stress(young, poisson, density, thickness).and_then(yielding).map_err(refused),
        Some("strain") => Elastic::plane_strain(young, poisson, density, thickness).and_then(yielding).map_err(refused),
        Some(other) => Err(bad("plane", &format!("is {other:?}; it must be \"stress\" or \"strain\""))),
        None => Err(bad("plane", "is missing; give \"stress\" (a thin plate) or \"strain\" (a long body)")),
    }
}

/// One plane.
pub(crate) fn plane<const D: usize>(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Obstacle<D>> {
    let py = given.py();
    let point = attribute::<Option<Vec<f64>>>(given, "point")?;
    let point = point.map(|point| vector(py, &format!("{name}.point"), &point)).transpose()?;
    let normal = vector(py, &format!("{name}.normal"), &attribute::<Vec<f64>>(given, "normal")?)?;
    let (friction, group) = (attribute(given, "friction")?, attribute(given, "group")?);
    let made = match point {
        Some(point) => Obstacle::plane(point, normal, friction, group),
        // A plane that the body strikes at once is moved away by the least gap.
        None => Obstacle::plane_at_gap(attribute(given, "gap").unwrap_or(0.0), normal, friction, group),
    };
    // The message begins with the name of the value.
    made.map_err(|error: ObstacleError| errors::input(py, format!("`{name}`: {error}")))
}

/// Contact between bodies.
pub(crate) fn contact<const D: usize>(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Contact> {
    let [bodies, groups] = [attribute::<Option<[String; 2]>>(given, "bodies")?, attribute(given, "groups")?];
    let between = bodies.map(Between::Bodies).or(groups.map(Between::Groups)).unwrap_or(Between::All);
    let friction = attribute::<Option<f64>>(given, "friction")?.unwrap_or(0.0);
    let made = Contact::new::<D>(between, friction, attribute(given, "matching")?);
    made.map_err(|error: ObstacleError| errors::input(given.py(), format!("`{name}`: {error}")))
}

/// One support: `velocity` has a column for each component, in their order.
pub(crate) fn support<const D: usize>(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Support<D>> {
    let py = given.py();
    let mut order = Vec::new();
    for axis in attribute::<Vec<String>>(given, "components")? {
        let Some(at) = AXES[..D].iter().position(|known| *known == axis) else {
            let known = AXES[..D].join("\" or \"");
            return Err(wrong(py, &format!("{name}.components"), format!("names {axis:?}; it must be \"{known}\"")));
        };
        order.push(at);
    }
    let mut components = [false; D];
    order.iter().for_each(|&c| components[c] = true);
    let velocity = match attribute::<Option<Rows>>(given, "velocity")? {
        None => None,
        Some(rows) => {
            let spread = |row: &Vec<f64>| {
                let mut all = [0.0; D];
                order.iter().zip(row).for_each(|(&c, v)| all[c] = *v);
                all
            };
            Some(table(py, name, "velocity", attribute(given, "time")?, rows.0.iter().map(spread).collect())?)
        }
    };
    Ok(Support { group: attribute(given, "group")?, components, velocity })
}

/// One traction.
pub(crate) fn traction<const D: usize>(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Traction<D>> {
    let py = given.py();
    let profile = match attribute::<Option<(f64, Vec<f64>)>>(given, "profile")? {
        None => Profile::UNIFORM,
        Some((value, gradient)) => Profile { value, gradient: vector(py, &format!("{name}.profile"), &gradient)? },
    };
    Ok(Traction { group: attribute(given, "group")?, value: load(name, given)?, profile })
}

/// One body force.
pub(crate) fn body_force<const D: usize>(name: &str, given: &Bound<'_, PyAny>) -> PyResult<BodyForce<D>> {
    Ok(BodyForce { group: attribute(given, "group")?, value: load(name, given)? })
}

/// One row of numbers, or several.
struct Rows(Vec<Vec<f64>>);

impl<'a, 'py> FromPyObject<'a, 'py> for Rows {
    type Error = PyErr;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        object.extract().map(|row| Self(vec![row])).or_else(|_| object.extract().map(Self))
    }
}

fn load<const D: usize>(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Table<D>> {
    let py = given.py();
    let rows: Rows = attribute(given, "value")?;
    let values = rows.0.iter().map(|row| vector(py, &format!("{name}.value"), row)).collect::<PyResult<Vec<_>>>()?;
    table(py, name, "value", attribute(given, "time")?, values)
}

/// A table in time; without instants, the same value at all times.
fn table<const D: usize>(
    py: Python<'_>,
    name: &str,
    key: &str,
    time: Option<Vec<f64>>,
    values: Vec<[f64; D]>,
) -> PyResult<Table<D>> {
    Table::new(time.unwrap_or_else(|| vec![0.0]), values).map_err(|error| match error {
        TableError::Lengths { times, values } => {
            let message =
                format!("has {values} entries and `time` has {times}; they must be equally many, and at least one");
            wrong(py, &format!("{name}.{key}"), message)
        }
        TableError::Order { .. } => errors::input(py, format!("`{name}.time`: {error}")),
        TableError::NotFinite { .. } => errors::input(py, format!("`{name}.{key}`: {error}")),
    })
}

/// What the value class of a material takes.
pub(crate) fn material_arguments<'py>(py: Python<'py>, law: &Elastic) -> PyResult<Bound<'py, PyDict>> {
    let arguments = PyDict::new(py);
    arguments.set_item("young", law.young())?;
    arguments.set_item("density", law.density())?;
    arguments.set_item("yield_stress", law.yield_stress())?;
    if law.hypothesis() == Hypothesis::Bar {
        arguments.set_item("section", law.extent())?;
        return Ok(arguments);
    }
    arguments.set_item("poisson", law.poisson())?;
    arguments.set_item("plane", if law.hypothesis() == Hypothesis::PlaneStress { "stress" } else { "strain" })?;
    arguments.set_item("thickness", law.extent())?;
    Ok(arguments)
}

/// What the value class of a plane takes.
pub(crate) fn plane_arguments<'py, const D: usize>(
    py: Python<'py>,
    (obstacle, plane): (&Obstacle<D>, &Plane<D>),
) -> PyResult<Bound<'py, PyDict>> {
    let arguments = PyDict::new(py);
    arguments.set_item("point", tuple(py, plane.point())?)?;
    arguments.set_item("normal", tuple(py, plane.direction())?)?;
    arguments.set_item("friction", obstacle.law().friction())?;
    arguments.set_item("group", obstacle.group())?;
    Ok(arguments)
}

/// What the value class of a contact takes.
pub(crate) fn contact_arguments<'py>(py: Python<'py>, interface: &Interface) -> PyResult<Bound<'py, PyDict>> {
    let arguments = PyDict::new(py);
    arguments.set_item("groups", PyTuple::new(py, interface.groups())?)?;
    arguments.set_item("friction", interface.law().friction())?;
    if !interface.is_matching() {
        arguments.set_item("matching", false)?;
    }
    Ok(arguments)
}

/// What the value class of a support takes.
pub(crate) fn support_arguments<'py, const D: usize>(
    py: Python<'py>,
    support: &Support<D>,
) -> PyResult<Bound<'py, PyDict>> {
    let arguments = PyDict::new(py);
    let order: Vec<usize> = (0..D).filter(|&c| support.components[c]).collect();
    arguments.set_item("group", &support.group)?;
    arguments.set_item("components", PyTuple::new(py, order.iter().map(|&c| AXES[c]))?)?;
    if let Some(table) = &support.velocity {
        let rows = table.value().iter().map(|row| order.iter().map(|&c| row[c]).collect());
        table_arguments(&arguments, "velocity", table.time(), rows.collect())?;
    }
    Ok(arguments)
}

/// What the value class of a traction takes.
pub(crate) fn traction_arguments<'py, const D: usize>(
    py: Python<'py>,
    traction: &Traction<D>,
) -> PyResult<Bound<'py, PyDict>> {
    let arguments = PyDict::new(py);
    arguments.set_item("group", &traction.group)?;
    load_arguments(&arguments, &traction.value)?;
    let profile = traction.profile;
    if profile.value != 1.0 || profile.gradient != [0.0; D] {
        arguments.set_item("profile", (profile.value, tuple(py, &profile.gradient)?))?;
    }
    Ok(arguments)
}

/// What the value class of a body force takes.
pub(crate) fn body_force_arguments<'py, const D: usize>(
    py: Python<'py>,
    force: &BodyForce<D>,
) -> PyResult<Bound<'py, PyDict>> {
    let arguments = PyDict::new(py);
    load_arguments(&arguments, &force.value)?;
    arguments.set_item("group", &force.group)?;
    Ok(arguments)
}

fn load_arguments<const D: usize>(arguments: &Bound<'_, PyDict>, table: &Table<D>) -> PyResult<()> {
    table_arguments(arguments, "value", table.time(), table.value().iter().map(|row| row.to_vec()).collect())
}

/// A table whose only instant is 0 is constant.
fn table_arguments(arguments: &Bound<'_, PyDict>, key: &str, time: &[f64], rows: Vec<Vec<f64>>) -> PyResult<()> {
    if time == [0.0] {
        return arguments.set_item(key, rows.into_iter().next());
    }
    arguments.set_item("time", time.to_vec())?;
    arguments.set_item(key, rows)
}

fn tuple<'py>(py: Python<'py>, numbers: &[f64]) -> PyResult<Bound<'py, PyTuple>> {
    PyTuple::new(py, numbers)
}
