//! The closed-form solution of bars in a row.

use crate::errors;
use numpy::{PyArray1, PyReadonlyArray1};
use percute_exact::{BarRow, RowBar};
use pyo3::prelude::*;

/// Bars in a row up to an instant. Python checks the arguments.
#[pyclass(frozen, module = "percute._percute")]
pub(crate) struct BarRowData(BarRow);

#[pymethods]
impl BarRowData {
    /// From start, L, E, ρ, S and velocity of each bar; None if bars overlap or are not in their order.
    #[staticmethod]
    fn new(bars: Vec<[f64; 6]>, end: f64) -> Option<Self> {
        let bar = |[start, length, young, density, section, velocity]: [f64; 6]| RowBar {
            start,
            length,
            young,
            density,
            section,
            velocity,
        };
        BarRow::new(&bars.into_iter().map(bar).collect::<Vec<_>>(), end).map(Self)
    }

    /// The field of this name at places of a bar, each at its instant.
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        bar: usize,
        x: PyReadonlyArray1<'py, f64>,
        t: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let field = match name {
            "displacement" => BarRow::displacement,
            "velocity" => BarRow::velocity,
            "normal_force" => BarRow::normal_force,
            _ => return Err(errors::input(py, format!("there is no field `{name}`"))),
        };
        let values = x.as_slice()?.iter().zip(t.as_slice()?).map(|(&x, &t)| field(&self.0, bar, x, t));
        Ok(PyArray1::from_iter(py, values))
    }

    /// The intervals in which a bar and the next one press on each other (s).
    fn contacts(&self, first: usize) -> Vec<[f64; 2]> {
        self.0.contacts(first).to_vec()
    }

    /// The places of the fronts in a bar at an instant (m).
    fn fronts<'py>(&self, py: Python<'py>, bar: usize, t: f64) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.0.fronts(bar, t))
    }
}
