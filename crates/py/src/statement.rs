//! From the value classes of `percute.statement` to the statement of a problem, and back.

use crate::errors;
use percute_core::border::{Vector, row};
use percute_core::contact::{AnyObstacle, Interface, ObstacleError, PlaneAt};
use percute_core::load::{BodyForce, Profile, Support, Table, TableError, Traction};
use percute_core::material::{Elastic, Hypothesis, Kinematics, Law, MaterialError};
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
fn vector(py: Python<'_>, name: &str, given: &[f64], dimension: usize) -> PyResult<Vector> {
    if given.len() != dimension {
        let needed = match dimension {
            1 => "one number for a bar",
            2 => "two numbers, x and y, for a plane body",
            _ => "three numbers, x, y and z, for a solid",
        };
        return Err(wrong(py, name, format!("has {} numbers; it must have {needed}", given.len())));
    }
    Ok(row(given, 0, dimension))
}

/// An attribute of a value class, which has checked its type.
fn attribute<'a, 'py, T>(object: &'a Bound<'py, PyAny>, name: &str) -> PyResult<T>
where
    T: for<'b> FromPyObject<'b, 'py, Error = PyErr>,
{
    object.getattr(name)?.extract()
}

/// One material, stated as `name`.
pub(crate) fn material(name: &str, given: &Bound<'_, PyAny>, dimension: usize) -> PyResult<Elastic> {
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
    let kinematics: (Option<String>, Option<String>) = (attribute(given, "kinematics")?, attribute(given, "law")?);
    let kinematics = Kinematics::from_names(kinematics.0.as_deref(), kinematics.1.as_deref());
    let kinematics = kinematics.map_err(|(key, told)| bad(key, told))?;
    let stated: [Option<f64>; 3] =
        [attribute(given, "tangent")?, attribute(given, "hardening")?, attribute(given, "kinematic")?];
    let yielding = |law: Elastic| law.with_yielding(yield_stress, stated)?.with_kinematics(kinematics);
    let of_plane = [("plane", plane.is_some()), ("thickness", thickness != 1.0)];
    let only_without = |other: (&str, bool), body: &str| {
        let there = of_plane.into_iter().chain([other]).find(|(_, there)| *there);
        there.map_or(Ok(()), |(key, _)| Err(bad(key, &format!("does not apply to {body}"))))
    };
    if dimension == 1 {
        only_without(("poisson", poisson.is_some()), "a bar; give a `section` (m²)")?;
        let section = section.ok_or_else(|| bad("section", "is missing: a bar needs it (m²)"))?;
        let law = Elastic::bar(young, density, section);
        return law.and_then(yielding).map_err(refused);
    }
    if dimension == 3 {
        let whole = "a solid, which is whole in all three dimensions; leave it out";
        only_without(("section", section.is_some()), whole)?;
        let poisson = poisson.ok_or_else(|| bad("poisson", "is missing: a solid needs it"))?;
        return Elastic::solid(young, poisson, density).and_then(yielding).map_err(refused);
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
pub(crate) fn plane(name: &str, given: &Bound<'_, PyAny>, dimension: usize) -> PyResult<AnyObstacle> {
    let py = given.py();
    let point = attribute::<Option<Vec<f64>>>(given, "point")?;
    let point = point.map(|point| vector(py, &format!("{name}.point"), &point, dimension)).transpose()?;
    let normal = vector(py, &format!("{name}.normal"), &attribute::<Vec<f64>>(given, "normal")?, dimension)?;
    let (friction, group) = (attribute(given, "friction")?, attribute(given, "group")?);
    let place = match point {
        Some(point) => PlaneAt::Point(point),
        // A plane that the body strikes at once is moved away by the least gap.
        None => PlaneAt::Gap(attribute(given, "gap").unwrap_or(0.0)),
    };
    let made = AnyObstacle::plane(dimension, place, &normal, friction, group);
    // The message begins with the name of the value.
    made.map_err(|error: ObstacleError| errors::input(py, format!("`{name}`: {error}")))
}

/// Contact between bodies.
pub(crate) fn contact(name: &str, given: &Bound<'_, PyAny>, dimension: usize) -> PyResult<Contact> {
    let [bodies, groups] = [attribute::<Option<[String; 2]>>(given, "bodies")?, attribute(given, "groups")?];
    let between = bodies.map(Between::Bodies).or(groups.map(Between::Groups)).unwrap_or(Between::All);
    let friction = attribute::<Option<f64>>(given, "friction")?.unwrap_or(0.0);
    let made = Contact::new(dimension, between, friction, attribute(given, "matching")?);
    made.map_err(|error: ObstacleError| errors::input(given.py(), format!("`{name}`: {error}")))
}

/// One support: `velocity` has a column for each component, in their order.
pub(crate) fn support(name: &str, given: &Bound<'_, PyAny>, dimension: usize) -> PyResult<Support> {
    let py = given.py();
    let mut order = Vec::new();
    for axis in attribute::<Vec<String>>(given, "components")? {
        let Some(at) = AXES[..dimension].iter().position(|known| *known == axis) else {
            let known = AXES[..dimension].join("\" or \"");
            return Err(wrong(py, &format!("{name}.components"), format!("names {axis:?}; it must be \"{known}\"")));
        };
        order.push(at);
    }
    let mut components = [false; 3];
    order.iter().for_each(|&c| components[c] = true);
    let velocity = match attribute::<Option<Rows>>(given, "velocity")? {
        None => None,
        Some(rows) => {
            let spread = |row: &Vec<f64>| {
                let mut all = [0.0; 3];
                order.iter().zip(row).for_each(|(&c, v)| all[c] = *v);
                all
            };
            Some(table(py, name, "velocity", attribute(given, "time")?, rows.0.iter().map(spread).collect())?)
        }
    };
    Ok(Support { group: attribute(given, "group")?, components, velocity })
}

/// One traction.
pub(crate) fn traction(name: &str, given: &Bound<'_, PyAny>, dimension: usize) -> PyResult<Traction> {
    let py = given.py();
    let profile = match attribute::<Option<(f64, Vec<f64>)>>(given, "profile")? {
        None => Profile::UNIFORM,
        Some((value, gradient)) => {
            Profile { value, gradient: vector(py, &format!("{name}.profile"), &gradient, dimension)? }
        }
    };
    Ok(Traction { group: attribute(given, "group")?, value: load(name, given, dimension)?, profile })
}

/// One body force.
pub(crate) fn body_force(name: &str, given: &Bound<'_, PyAny>, dimension: usize) -> PyResult<BodyForce> {
    Ok(BodyForce { group: attribute(given, "group")?, value: load(name, given, dimension)? })
}

/// One row of numbers, or several.
struct Rows(Vec<Vec<f64>>);

impl<'a, 'py> FromPyObject<'a, 'py> for Rows {
    type Error = PyErr;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        object.extract().map(|row| Self(vec![row])).or_else(|_| object.extract().map(Self))
    }
}

fn load(name: &str, given: &Bound<'_, PyAny>, dimension: usize) -> PyResult<Table> {
    let py = given.py();
    let rows: Rows = attribute(given, "value")?;
    let values =
        rows.0.iter().map(|row| vector(py, &format!("{name}.value"), row, dimension)).collect::<PyResult<Vec<_>>>()?;
    table(py, name, "value", attribute(given, "time")?, values)
}

/// A table in time; without instants, the same value at all times.
fn table(py: Python<'_>, name: &str, key: &str, time: Option<Vec<f64>>, values: Vec<Vector>) -> PyResult<Table> {
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
    arguments.set_item("hardening", law.hardening().map(|hardening| hardening.modulus()))?;
    arguments.set_item("kinematic", law.hardening().map(|hardening| hardening.kinematic()))?;
    let (kinematics, finite) = law.kinematics().names();
    arguments.set_item("kinematics", kinematics)?;
    arguments.set_item("law", finite)?;
    if law.hypothesis() == Hypothesis::Bar {
        arguments.set_item("section", law.extent())?;
        return Ok(arguments);
    }
    arguments.set_item("poisson", law.poisson())?;
    if law.hypothesis() == Hypothesis::Solid {
        return Ok(arguments);
    }
    arguments.set_item("plane", if law.hypothesis() == Hypothesis::PlaneStress { "stress" } else { "strain" })?;
    arguments.set_item("thickness", law.extent())?;
    Ok(arguments)
}

/// What the value class of a plane takes.
pub(crate) fn plane_arguments<'py>(
    py: Python<'py>,
    plane: &AnyObstacle,
    dimension: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let arguments = PyDict::new(py);
    for (key, vector) in ["point", "normal"].into_iter().zip(plane.as_plane().iter().flatten()) {
        arguments.set_item(key, tuple(py, &vector[..dimension])?)?;
    }
    arguments.set_item("friction", plane.law().friction())?;
    arguments.set_item("group", plane.group())?;
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
pub(crate) fn support_arguments<'py>(
    py: Python<'py>,
    support: &Support,
    dimension: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let arguments = PyDict::new(py);
    let order: Vec<usize> = (0..dimension).filter(|&c| support.components[c]).collect();
    arguments.set_item("group", &support.group)?;
    arguments.set_item("components", PyTuple::new(py, order.iter().map(|&c| AXES[c]))?)?;
    if let Some(table) = &support.velocity {
        let rows = table.value().iter().map(|row| order.iter().map(|&c| row[c]).collect());
        table_arguments(&arguments, "velocity", table.time(), rows.collect())?;
    }
    Ok(arguments)
}

/// What the value class of a traction takes.
pub(crate) fn traction_arguments<'py>(
    py: Python<'py>,
    traction: &Traction,
    dimension: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let arguments = PyDict::new(py);
    arguments.set_item("group", &traction.group)?;
    load_arguments(&arguments, &traction.value, dimension)?;
    let profile = traction.profile;
    if profile.value != 1.0 || profile.gradient != [0.0; 3] {
        arguments.set_item("profile", (profile.value, tuple(py, &profile.gradient[..dimension])?))?;
    }
    Ok(arguments)
}

/// What the value class of a body force takes.
pub(crate) fn body_force_arguments<'py>(
    py: Python<'py>,
    force: &BodyForce,
    dimension: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let arguments = PyDict::new(py);
    load_arguments(&arguments, &force.value, dimension)?;
    arguments.set_item("group", &force.group)?;
    Ok(arguments)
}

fn load_arguments(arguments: &Bound<'_, PyDict>, table: &Table, dimension: usize) -> PyResult<()> {
    table_arguments(
        arguments,
        "value",
        table.time(),
        table.value().iter().map(|row| row[..dimension].to_vec()).collect(),
    )
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
