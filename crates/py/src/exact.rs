//! Closed-form solutions, and the true error of a bar that strikes a plane.

use crate::history::HistoryData;
use crate::reference::{TrueErrorColumns, told};
use crate::run::Run;
use crate::{bridge, errors};
use numpy::{PyArray1, PyReadonlyArray2};
use percute_core::dynamics::replay;
use percute_estimator::reference::{Motion, ReferenceError, TrueError, bar_impact_error};
use percute_exact::{BarEnds, BarImpact, BarMode, BarRamp, BlockMode, BouncingBar, ClampedRod, RigidSlide, Wave};
use pyo3::prelude::*;
use std::collections::HashMap;

/// A function of place (m) and time (s), in this order.
type Function = Box<dyn Fn(&[f64]) -> f64 + Send + Sync>;

/// A closed-form solution: its functions and its constants, by name. Python checks the arguments.
#[pyclass(frozen, module = "percute._percute")]
pub(crate) struct ExactData {
    functions: HashMap<&'static str, Function>,
    #[pyo3(get)]
    constants: HashMap<&'static str, f64>,
}

/// The data of a bar: its fields, and the constants of these names.
macro_rules! bar {
    ($exact:ident: $kind:ident, $($constant:ident),+) => {
        Self::bar(
            $exact,
            [$kind::displacement, $kind::velocity, $kind::normal_force],
            &[$((stringify!($constant), $exact.$constant())),+],
        )
    };
}

#[pymethods]
impl ExactData {
    /// From L, E, ρ, S, v₀ and the gap.
    #[staticmethod]
    fn bar_impact(values: [f64; 6]) -> Self {
        let exact = impact(values);
        bar!(exact: BarImpact, wave_speed, impact_time, release_time)
    }

    /// From L, E, ρ, S, g and h; None if the bar does not land as it left.
    #[staticmethod]
    fn bouncing_bar(values: [f64; 6]) -> Option<Self> {
        let [length, young, density, section, gravity, height] = values;
        let exact = BouncingBar::new(length, young, density, section, gravity, height)?;
        Some(bar!(exact: BouncingBar, wave_speed, impact_time, contact_duration, period, energy))
    }

    /// From L, E, ρ, S and d.
    #[staticmethod]
    fn clamped_rod(values: [f64; 5]) -> Self {
        let [length, young, density, section, distance] = values;
        let exact = ClampedRod { length, young, density, section, distance };
        bar!(exact: ClampedRod, wave_speed, passage, period, energy)
    }

    /// From L, E, ρ, S, A and θ, the number of the mode and which ends are fixed.
    #[staticmethod]
    fn bar_mode(values: [f64; 6], number: u32, fixed: &str) -> Option<Self> {
        let [length, young, density, section, amplitude, phase] = values;
        let ends = match fixed {
            "start" => BarEnds::FixedFree,
            "both" => BarEnds::FixedFixed,
            "none" => BarEnds::FreeFree,
            _ => return None,
        };
        let exact = BarMode { ends, number, length, young, density, section, amplitude, phase };
        Some(bar!(exact: BarMode, wave_number, angular_frequency, energy))
    }

    /// From L, E, ρ, S and r.
    #[staticmethod]
    fn bar_ramp(values: [f64; 5]) -> Self {
        let [length, young, density, section, rate] = values;
        let exact = BarRamp { length, young, density, section, rate };
        bar!(exact: BarRamp, wave_speed)
    }

    /// From the sides, the thickness, λ, G, ρ, A and θ, the half waves and whether it is a shear wave.
    #[staticmethod]
    fn block_mode(values: [f64; 8], numbers: [u32; 2], across: bool) -> Self {
        let [width, height, thickness, lambda, shear, density, amplitude, phase] = values;
        let wave = if across { Wave::Shear } else { Wave::Pressure };
        let sides = [width, height];
        let exact = BlockMode { wave, numbers, sides, thickness, lambda, shear, density, amplitude, phase };
        let along = |axis: usize| -> Function { Box::new(move |at| exact.displacement([at[0], at[1]], at[2])[axis]) };
        let constants = [("angular_frequency", exact.angular_frequency()), ("energy", exact.energy())];
        Self { functions: [("x", along(0)), ("y", along(1))].into(), constants: constants.into() }
    }

    /// From the mass, the largest friction and the push; None if the instants of the push do not increase from 0.
    #[staticmethod]
    fn rigid_slide(mass: f64, limit: f64, push: Vec<(f64, f64)>) -> Option<Self> {
        let exact = RigidSlide::new(mass, limit, &push)?;
        let over_time = |function: fn(&RigidSlide, f64) -> f64| -> Function {
            let exact = exact.clone();
            Box::new(move |at| function(&exact, at[0]))
        };
        let functions = [
            ("position", over_time(RigidSlide::position)),
            ("velocity", over_time(RigidSlide::velocity)),
            ("friction", over_time(RigidSlide::friction)),
            ("dissipated", over_time(RigidSlide::dissipated)),
        ];
        Some(Self { functions: functions.into(), constants: HashMap::new() })
    }

    /// The function of this name at places and instants, one in a row.
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        rows: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let Some(function) = self.functions.get(name) else {
            return Err(errors::input(py, format!("there is no function `{name}`")));
        };
        let columns = rows.as_array().ncols().max(1);
        Ok(PyArray1::from_iter(py, rows.as_slice()?.chunks_exact(columns).map(function)))
    }
}

impl ExactData {
    /// That of a bar, with displacement, velocity and normal force.
    fn bar<T: Copy + Send + Sync + 'static>(
        exact: T,
        fields: [fn(&T, f64, f64) -> f64; 3],
        constants: &[(&'static str, f64)],
    ) -> Self {
        let function = |(name, field): (_, fn(&T, f64, f64) -> f64)| {
            (name, Box::new(move |at: &[f64]| field(&exact, at[0], at[1])) as Function)
        };
        let names = ["displacement", "velocity", "normal_force"];
        let functions = names.into_iter().zip(fields).map(function).collect();
        Self { functions, constants: constants.iter().copied().collect() }
    }
}

fn impact([length, young, density, section, speed, gap]: [f64; 6]) -> BarImpact {
    BarImpact { length, young, density, section, speed, gap }
}

/// The true error of a history of a bar that strikes a plane: sup, mean, and time, kinetic and elastic part at each
/// instant. The bar is that of [`ExactData::bar_impact`].
#[pyfunction]
pub(crate) fn true_error_of_bar_impact<'py>(
    py: Python<'py>,
    values: [f64; 6],
    history: &HistoryData,
) -> PyResult<TrueErrorColumns<'py>> {
    let run = history.run.clone();
    if run.problem.dimension() != 1 {
        return Err(errors::input(py, "`history` is that of a plane body; the exact solution is that of a bar"));
    }
    let outcome = bridge::blocking(py, None, move |watch| true_error(&run, &impact(values), watch))?;
    let error = outcome.map_err(|message| errors::input(py, format!("`history`: {message}")))?;
    told(py, &error)
}

fn true_error(run: &Run, exact: &BarImpact, watch: bridge::Watch) -> Result<TrueError, String> {
    let mut motion = Motion::default();
    replay(&run.problem, &run.stoppable(watch), &mut motion).map_err(|error| error.to_string())?;
    bar_impact_error(&run.problem, &motion, exact).map_err(|error: ReferenceError| error.to_string())
}
