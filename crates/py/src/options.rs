//! Options of an estimate, and the instants of its maps.

use crate::errors;
use percute_core::time::TimeGrid;
use percute_estimator::{Acceleration, Options, Request, Sampling, UnknownName};
use percute_workflow::case::Instants;
use percute_workflow::message::hint;
use percute_workflow::run::Analysis;
use pyo3::prelude::*;

/// At which instants maps are kept: so many, or near these times (s).
#[derive(FromPyObject)]
pub(crate) enum Wanted {
    Count(usize),
    Times(Vec<f64>),
}

impl From<Wanted> for Instants {
    fn from(wanted: Wanted) -> Self {
        match wanted {
            Wanted::Count(count) => Self::Count(count),
            Wanted::Times(times) => Self::Times(times),
        }
    }
}

/// At which steps the error is sampled, as Python has it: so many steps apart, or a name.
#[derive(FromPyObject, IntoPyObject)]
pub(crate) enum Every {
    Steps(usize),
    Name(String),
}

impl Every {
    /// The option of the estimate.
    pub(crate) fn sampling(&self, py: Python<'_>) -> PyResult<Sampling> {
        match self {
            Self::Steps(steps) => Ok(Sampling::Every(*steps)),
            Self::Name(name) if *name == Sampling::Auto.to_string() => Ok(Sampling::Auto),
            Self::Name(name) => {
                let wrong = format!("`every` is \"{name}\"; it must be \"auto\" or a number of steps, at least 1");
                Err(errors::input(py, wrong))
            }
        }
    }
}

impl From<Sampling> for Every {
    fn from(sampling: Sampling) -> Self {
        match sampling {
            Sampling::Auto => Self::Name(sampling.to_string()),
            Sampling::Every(steps) => Self::Steps(steps),
        }
    }
}

/// Reconstruction, Γ_DA unless it is left to the reconstruction, and `every`, as Python has them.
pub(crate) type Stated = (String, Option<String>, Every);

/// Options of an estimate, for Python.
pub(crate) fn stated(options: &Options) -> Stated {
    (options.reconstruction.to_string(), options.acceleration.map(|name| name.to_string()), options.every.into())
}

/// Options of an estimate by their names.
pub(crate) fn options(
    py: Python<'_>,
    reconstruction: &str,
    acceleration: Option<&str>,
    every: &Every,
) -> PyResult<Options> {
    let unknown = |name: &str, error: UnknownName| {
        let hint = hint(&error.given, error.known.iter().copied());
        errors::input(py, format!("`{name}`: {error}{hint}"))
    };
    let reconstruction = reconstruction.parse().map_err(|error| unknown("reconstruction", error))?;
    let acceleration = acceleration.map(str::parse::<Acceleration>).transpose();
    let acceleration = acceleration.map_err(|error| unknown("acceleration", error))?;
    let unsuitable = acceleration.and_then(|one| one.check(reconstruction).err());
    if let Some(error) = unsuitable {
        return Err(errors::input(py, format!("`acceleration` {error}")));
    }
    Ok(Options { reconstruction, acceleration, every: every.sampling(py)?, ..Options::default() })
}

/// The analysis of steps; without `instants`, no maps are kept.
pub(crate) fn analysis(
    options: Options,
    instants: Option<&Instants>,
    fields: bool,
    contact_steps: bool,
    times: &TimeGrid,
) -> Analysis {
    let steps = instants.map_or_else(Vec::new, |wanted| wanted.steps(times, options.every.stride()));
    Analysis { options, request: Request { steps, fields }, contact_steps }
}
