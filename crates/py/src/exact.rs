//! The exact impact of a bar.

use crate::any::Any;
use crate::history::HistoryData;
use crate::reference::{Told, told};
use crate::run::{Run, Stoppable};
use crate::{door, errors};
use numpy::{PyArray1, PyReadonlyArray1};
use percute_core::history::StepSource;
use percute_estimator::reference::{Recorder, ReferenceError, TrueError, bar_impact_error};
use percute_exact::BarImpact;
use pyo3::prelude::*;
use std::sync::Arc;

/// The exact solution of a bar that strikes a plane.
#[pyclass(frozen, module = "percute._percute")]
pub(crate) struct BarImpactData {
    exact: BarImpact,
}

/// Places (m) and as many instants (s).
type Points<'py> = PyReadonlyArray1<'py, f64>;

#[pymethods]
impl BarImpactData {
    /// Checks that all numbers are positive.
    #[new]
    fn positive(
        py: Python<'_>,
        length: f64,
        young: f64,
        density: f64,
        section: f64,
        speed: f64,
        gap: f64,
    ) -> PyResult<Self> {
        let numbers = [
            ("length", length, "m"),
            ("young", young, "Pa"),
            ("density", density, "kg/m³"),
            ("section", section, "m²"),
            ("speed", speed, "m/s"),
            ("gap", gap, "m"),
        ];
        for (name, value, unit) in numbers {
            if !(value > 0.0 && value.is_finite()) {
                return Err(errors::input(py, &format!("`{name}` is {value} {unit}; it must be positive and finite")));
            }
        }
        Ok(Self { exact: BarImpact { length, young, density, section, speed, gap } })
    }

    #[getter]
    fn wave_speed(&self) -> f64 {
        self.exact.wave_speed()
    }

    #[getter]
    fn impact_time(&self) -> f64 {
        self.exact.impact_time()
    }

    #[getter]
    fn release_time(&self) -> f64 {
        self.exact.release_time()
    }

    fn displacement<'py>(
        &self,
        py: Python<'py>,
        x: Points<'py>,
        t: Points<'py>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.at(py, &x, &t, BarImpact::displacement)
    }

    fn velocity<'py>(&self, py: Python<'py>, x: Points<'py>, t: Points<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.at(py, &x, &t, BarImpact::velocity)
    }

    fn normal_force<'py>(
        &self,
        py: Python<'py>,
        x: Points<'py>,
        t: Points<'py>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.at(py, &x, &t, BarImpact::normal_force)
    }

    fn contact_force<'py>(
        &self,
        py: Python<'py>,
        x: Points<'py>,
        t: Points<'py>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.at(py, &x, &t, |exact, _, t| exact.contact_force(t))
    }

    /// The true error of a history: sup, mean, and time, kinetic and elastic part at each instant.
    fn error<'py>(&self, py: Python<'py>, history: &HistoryData) -> PyResult<Told<'py>> {
        let Any::Bar(run) = &history.run else {
            return Err(errors::input(py, "`history` is that of a plane body; the exact solution is that of a bar"));
        };
        let (run, exact) = (run.clone(), self.exact);
        let outcome = door::through(py, None, move |watch| true_error(&run, &exact, watch))?;
        let error = outcome.map_err(|message| errors::input(py, &format!("`history`: {message}")))?;
        told(py, &error)
    }
}

impl BarImpactData {
    fn at<'py>(
        &self,
        py: Python<'py>,
        x: &Points<'_>,
        t: &Points<'_>,
        field: fn(&BarImpact, f64, f64) -> f64,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let places = x.as_slice()?.iter();
        if let Some(x) = places.clone().find(|x| !(0.0..=self.exact.length).contains(*x)) {
            return Err(errors::input(
                py,
                &format!("`x` holds {x} m; it must lie in the bar, from 0 to {} m", self.exact.length),
            ));
        }
        let values: Vec<f64> = places.zip(t.as_slice()?).map(|(&x, &t)| field(&self.exact, x, t)).collect();
        Ok(PyArray1::from_vec(py, values))
    }
}

fn true_error(run: &Arc<Run<1, 2>>, exact: &BarImpact, watch: door::Watch) -> Result<TrueError, String> {
    let mut recorder = Recorder::new(&run.problem, run.times());
    let source = Stoppable { source: run.source(), watch };
    source.replay(&mut recorder).map_err(|error| error.to_string())?;
    bar_impact_error(&run.problem, &recorder.finish(), exact).map_err(|error: ReferenceError| error.to_string())
}
