//! All runs of the maps, and the table that holds them.

use super::study::{Choice, Outcome, Setting, choices};
use crate::reproduce::part::parallel::{in_order, threads};
use crate::reproduce::table::{Cell, Column, Table};
use crate::reproduce::{Effort, ReproduceError};
use percute_core::observer::Observer;
use percute_estimator::{Acceleration, Reconstruction};

/// N_s and α of the paper's figures 5 and 6: from 10 to 400 and from 0.5 to 1.
const ELEMENTS: [usize; 7] = [10, 20, 40, 80, 160, 240, 400];
const RATIOS: [f64; 6] = [0.5, 0.6, 0.7, 0.8, 0.9, 1.0];
/// Fractions of a step at which the impact falls.
pub(super) const FRACTIONS: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];
/// (T − t_c)/(L/c): at the end of contact, and half of the time of contact later.
pub(super) const ENDS: [f64; 2] = [2.0, 3.0];
/// Meshes of the small effort.
const FEW: usize = 3;

/// Largest over time, and mean.
pub(super) const MEASURES: [&str; 2] = ["sup", "mean"];

/// Runs over number of elements, step, fraction and end, in this order, with their results.
pub(super) struct Grid {
    pub(super) elements: &'static [usize],
    pub(super) ratios: &'static [f64],
    pub(super) choices: Vec<Choice>,
    pub(super) settings: Vec<Setting>,
    pub(super) outcomes: Vec<Outcome>,
}

/// A value of a map, and where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Value {
    pub(super) setting: Setting,
    pub(super) value: f64,
}

impl Grid {
    /// Runs all of it.
    pub(super) fn run(
        stage: &'static str,
        effort: &Effort,
        observer: &mut dyn Observer,
    ) -> Result<Self, ReproduceError> {
        let elements: &'static [usize] = effort.first(FEW, &ELEMENTS);
        let mut settings = Vec::new();
        for &elements in elements {
            for ratio in RATIOS {
                for fraction in FRACTIONS {
                    settings.extend(ENDS.map(|after_impact| Setting { elements, ratio, fraction, after_impact }));
                }
            }
        }
        let choices = choices();
        let outcomes =
            in_order(stage, threads(effort.threads), &settings, observer, |setting, stop| setting.run(&choices, stop))?;
        Ok(Self { elements, ratios: &RATIOS, choices, settings, outcomes })
    }

    /// The effectivities of a choice in one measure, for the settings that are wanted.
    pub(super) fn effectivities(
        &self,
        choice: usize,
        measure: usize,
        wanted: impl Fn(&Setting) -> bool,
    ) -> impl Iterator<Item = Value> {
        self.values(wanted, move |outcome| outcome.effectivity(choice)[measure])
    }

    /// The relative errors ε of a choice in one measure, likewise.
    pub(super) fn relative(
        &self,
        choice: usize,
        measure: usize,
        wanted: impl Fn(&Setting) -> bool,
    ) -> impl Iterator<Item = Value> {
        self.values(wanted, move |outcome| {
            let error = &outcome.estimates[choice];
            [error.relative_sup, error.relative_mean][measure]
        })
    }

    /// The place of a reading with the default Γ_DA among the choices.
    pub(super) fn choice(&self, reading: Reconstruction) -> usize {
        self.choices.iter().position(|choice| *choice == (reading, Acceleration::default())).unwrap_or(0)
    }

    fn values(
        &self,
        wanted: impl Fn(&Setting) -> bool,
        value: impl Fn(&Outcome) -> f64,
    ) -> impl Iterator<Item = Value> {
        let pairs = self.settings.iter().zip(&self.outcomes).filter(move |(setting, _)| wanted(setting));
        pairs.map(move |(&setting, outcome)| Value { setting, value: value(outcome) })
    }

    /// All numbers.
    pub(super) fn table(&self) -> Table {
        let joule = |name: &str, equation: &str| Column::new(name).unit("J^½").equation(equation);
        let columns = vec![
            Column::new("contact force"),
            Column::new("Γ_DA"),
            Column::new("elements"),
            Column::new("Δt/Δt_c").digits(2),
            Column::new("fraction").unit("steps").digits(2),
            Column::new("T − t_c").unit("L/c").digits(2),
            joule("e sup", "[15]"),
            joule("e mean", "[16]"),
            Column::new("ε sup").equation("[22]"),
            Column::new("ε mean").equation("[22]"),
            joule("true error sup", "[60]"),
            joule("true error mean", "[60]"),
        ];
        let caption =
            "Estimated, relative and true error of all runs of the maps. An effectivity is e over the true error.";
        let mut table = Table::new("bar-maps", caption, columns).long();
        for (c, (reading, option)) in self.choices.iter().enumerate() {
            for (setting, outcome) in self.settings.iter().zip(&self.outcomes) {
                let e = &outcome.estimates[c];
                let words = [Cell::from(reading.to_string()), option.to_string().into(), setting.elements.into()];
                let place = [setting.ratio, setting.fraction, setting.after_impact];
                let errors = [e.sup, e.mean, e.relative_sup, e.relative_mean, outcome.exact[0], outcome.exact[1]];
                table.push(words.into_iter().chain(place.into_iter().chain(errors).map(Cell::from)));
            }
        }
        table
    }
}

/// Lowest and highest of some values, if there are any.
pub(super) fn range(values: impl Iterator<Item = Value>) -> Option<[Value; 2]> {
    values.fold(None, |range: Option<[Value; 2]>, value| {
        let [low, high] = range.unwrap_or([value; 2]);
        Some([if value.value < low.value { value } else { low }, if value.value > high.value { value } else { high }])
    })
}
