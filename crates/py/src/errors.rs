//! From errors of Rust to the exceptions of `percute.errors`.

use percute_core::contact_results::ContactMemoryError;
use percute_core::dynamics::SimulationError;
use percute_core::history::{MemoryError, SinkError};
use percute_core::mesh::MeshError;
use percute_core::problem::{Cause, HeldBy, InputError, Place};
use percute_estimator::{EstimateError, RunError};
use percute_io::gmsh::{GmshCause, GmshError};
use percute_io::{FileCause, FileError};
use percute_workflow::message::hint;
use percute_workflow::{Failure, inconsistency, kept_results};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyType;
use std::path::Path;

/// An exception of this name from `percute.errors`.
fn exception(py: Python<'_>, name: &str, message: &str) -> PyErr {
    static MODULE: PyOnceLock<Py<PyModule>> = PyOnceLock::new();
    let module = MODULE.get_or_try_init(py, || py.import("percute.errors").map(Bound::unbind));
    let class = module.and_then(|m| m.bind(py).getattr(name)?.cast_into::<PyType>().map_err(PyErr::from));
    class.map_or_else(|error| error, |class| PyErr::from_type(class, (message.to_string(),)))
}

/// The root of all.
pub(crate) fn percute_error(py: Python<'_>, message: &str) -> PyErr {
    exception(py, "PercuteError", message)
}

/// The exception with what was done before it as an attribute, such as the history or its file.
pub(crate) fn with<'py>(py: Python<'py>, error: PyErr, name: &str, done: Option<impl IntoPyObject<'py>>) -> PyErr {
    if let Some(done) = done {
        // One that takes no attributes is raised all the same.
        let _ = error.value(py).setattr(name, done);
    }
    error
}

/// Bad input.
pub(crate) fn input(py: Python<'_>, message: impl ToString) -> PyErr {
    exception(py, "InputError", &message.to_string())
}

/// A problem that was refused, with the argument's name; `groups` are the keys of `material`.
pub(crate) fn problem(py: Python<'_>, error: &InputError, groups: &[Option<String>]) -> PyErr {
    input(py, format!("`{}`: {}", argument(error.place, groups), cause(&error.cause)))
}

/// The argument of `Problem` and `simulate` at a place.
pub(crate) fn argument(place: Place, groups: &[Option<String>]) -> String {
    let index = place.index.unwrap_or(0);
    let (list, key) = match (place.table, place.key) {
        ("initial", "velocity") => ("initial_velocity".to_string(), ""),
        ("initial", _) => ("initial_displacement".to_string(), ""),
        ("time", key) => (key.to_string(), ""),
        ("material", key) => match groups.get(index) {
            // The group is the key of the dictionary.
            Some(Some(group)) => (format!("material[{group:?}]"), if key == "group" { "" } else { key }),
            _ => ("material".to_string(), key),
        },
        (table, key) => {
            let list = match table {
                "obstacle" => "obstacles",
                "contact" => "contacts",
                "support" => "supports",
                "traction" => "tractions",
                "body_force" => "body_forces",
                other => other,
            };
            (place.index.map_or_else(|| list.to_string(), |i| format!("{list}[{i}]")), key)
        }
    };
    if key.is_empty() { list } else { format!("{list}.{key}") }
}

/// Causes that count from 1 or speak of a case file, in the words of Python.
fn cause(cause: &Cause) -> String {
    match cause {
        Cause::TwoPlanes { first, .. } | Cause::Opening { first, .. } | Cause::Jams { first, .. } => {
            cause.to_string().replace(&format!("obstacle {first}"), &format!("obstacles[{}]", first - 1))
        }
        Cause::ConflictingSupports { node, component, first } => format!(
            "component {component} of node {node} is already prescribed by supports[{}] with another motion; make the \
             two agree, or take the node out of one of the groups",
            first - 1
        ),
        Cause::NotFree { by, .. } | Cause::AllHeld { by, .. } => {
            let list = match by {
                HeldBy::Support(index) => format!("held by supports[{index}]"),
                HeldBy::Traction(index) => format!("loaded by tractions[{index}]"),
            };
            cause.to_string().replace(&by.to_string(), &list)
        }
        Cause::UnknownGroup { name, known, .. } => cause.to_string() + &hint(name, known.iter().map(String::as_str)),
        Cause::TwoMaterials { element, .. } => {
            format!("element {element} already has a material; the groups of materials must not overlap")
        }
        Cause::NoMaterial { element, count } => format!(
            "element {element} has no material ({count} such elements); give one material, or one for each group of \
             elements"
        ),
        other => other.to_string(),
    }
}

/// A simulation that failed.
pub(crate) fn simulation(py: Python<'_>, error: &SimulationError) -> PyErr {
    match error {
        SimulationError::StartsTooNear { obstacle, .. } => input(py, format!("`obstacles[{obstacle}].point`: {error}")),
        SimulationError::Sink { cause, .. } => match cause.downcast_ref::<MemoryError>() {
            Some(MemoryError::Full { .. }) => input(py, format!("`store`: {cause}")),
            _ => steps(py, cause),
        },
        SimulationError::Times(error) => input(py, error),
        SimulationError::Unstable { .. }
        | SimulationError::InsideOut { .. }
        | SimulationError::StepTooLong { .. }
        | SimulationError::Missed { .. } => exception(py, "SimulationError", &error.to_string()),
    }
}

/// An estimate that failed.
fn estimate(py: Python<'_>, error: &RunError) -> PyErr {
    match error {
        RunError::Simulation(error) => simulation(py, error),
        RunError::Estimate(
            EstimateError::Zero { .. }
            | EstimateError::TooManyThreads { .. }
            | EstimateError::Acceleration(_)
            | EstimateError::Finite
            | EstimateError::SolidReconstruction
            | EstimateError::Request(_),
        ) => input(py, error),
        RunError::Estimate(EstimateError::Scratch(_)) => {
            let resumes =
                "; a history that was stored in a file has the steps so far: `percute.resume` continues the run";
            exception(py, "StorageError", &format!("{error}{resumes}"))
        }
        RunError::Estimate(_) => exception(py, "EstimateError", &error.to_string()),
        RunError::Source(cause) => steps(py, cause),
    }
}

/// A run or an estimate that failed.
pub(crate) fn run(py: Python<'_>, error: &Failure) -> PyErr {
    match error {
        Failure::Run(error) => estimate(py, error),
        Failure::File(error) => file(py, error),
        Failure::Inconsistent { file, contradiction } => {
            input(py, inconsistency(file.as_deref(), contradiction, "force=True"))
        }
        other => output(py, other),
    }
}

/// Steps that could not be handed on or read.
pub(crate) fn steps(py: Python<'_>, error: &SinkError) -> PyErr {
    if let Some(error) = error.downcast_ref::<FileError>() {
        return file(py, error);
    }
    match error.is::<ContactMemoryError>() {
        true => input(py, error),
        false => exception(py, "EstimateError", &error.to_string()),
    }
}

/// A file that could not be made, written or read.
pub(crate) fn file(py: Python<'_>, error: &FileError) -> PyErr {
    of_file(py, &error.path, &error.cause, &error.to_string())
}

/// The same of a mesh file.
pub(crate) fn gmsh(py: Python<'_>, error: &GmshError) -> PyErr {
    match &error.cause {
        GmshCause::File(cause) => of_file(py, &error.path, cause, &error.to_string()),
        cause @ GmshCause::Scale { .. } => input(py, format!("`scale`: {cause}")),
        GmshCause::Name { .. } | GmshCause::NoMemory { .. } => input(py, error),
        GmshCause::Mesh { error: mesh, .. } if matches!(**mesh, MeshError::NoMemory { .. }) => input(py, error),
        _ => exception(py, "FileFormatError", &error.to_string()),
    }
}

fn of_file(py: Python<'_>, path: &Path, cause: &FileCause, message: &str) -> PyErr {
    let name = match cause {
        FileCause::Missing => "MissingFileError",
        FileCause::Exists => {
            let message = format!("{}: the file exists already; give another name, or overwrite=True", path.display());
            return exception(py, "ExistingFileError", &message);
        }
        FileCause::NotAFile => "StorageError",
        FileCause::Thinned { .. } | FileCause::Mesh(MeshError::NoMemory { .. }) => "InputError",
        cause if cause.is_of_the_system() => "StorageError",
        _ => "FileFormatError",
    };
    exception(py, name, message)
}

/// A stored history that cannot be used.
pub(crate) fn failure(py: Python<'_>, error: &Failure) -> PyErr {
    match error {
        Failure::File(error) => file(py, error),
        other => exception(py, "FileFormatError", &other.to_string()),
    }
}

/// A file that is not to be made.
pub(crate) fn output(py: Python<'_>, error: &Failure) -> PyErr {
    match error {
        Failure::Exists { what, file } => {
            let file = file.display();
            let message = format!("{what} {file}: the file exists already; give another name, or overwrite=True");
            exception(py, "ExistingFileError", &message)
        }
        Failure::Results { folder, cases } => {
            exception(py, "ExistingFileError", &kept_results(folder, cases, "overwrite=True"))
        }
        Failure::NoFolder { .. } => exception(py, "MissingFileError", &error.to_string()),
        Failure::Unwritable { .. } => exception(py, "StorageError", &error.to_string()),
        other => input(py, other.to_string()),
    }
}
