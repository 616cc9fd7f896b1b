//! The range of the effectivity for each choice, and for each fraction of a step.

use super::PAPER;
use super::grid::{ENDS, FRACTIONS, Grid, MEASURES, Value, range};
use super::study::Setting;
use crate::reproduce::table::{Cell, Column, Table};
use percute_estimator::{Acceleration, Reconstruction};
use percute_workflow::message::short;

/// What the values of some settings come to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Summary {
    pub(super) low: Value,
    pub(super) high: Value,
    /// The share of values in the paper's range.
    pub(super) within: f64,
}

impl Summary {
    /// Of one choice and measure.
    pub(super) fn of(
        grid: &Grid,
        choice: usize,
        measure: usize,
        wanted: impl Fn(&Setting) -> bool + Copy,
    ) -> Option<Self> {
        let values = || grid.effectivities(choice, measure, wanted);
        let [low, high] = range(values())?;
        let within = values().filter(|v| (PAPER[0]..=PAPER[1]).contains(&v.value)).count();
        Some(Self { low, high, within: within as f64 / values().count() as f64 })
    }

    /// Largest over smallest.
    pub(super) fn ratio(&self) -> f64 {
        self.high.value / self.low.value
    }

    fn cells(&self) -> [Cell; 6] {
        let (low, high) = (self.low, self.high);
        let share = 100.0 * self.within;
        [
            low.value.into(),
            at(&low.setting).into(),
            high.value.into(),
            at(&high.setting).into(),
            share.into(),
            self.ratio().into(),
        ]
    }
}

/// Where a value is, in words.
fn at(setting: &Setting) -> String {
    format!("{} elements, {}, {}", setting.elements, setting.ratio, setting.fraction)
}

/// The last six columns of both tables.
fn columns() -> [Column; 6] {
    let place = "elements, Δt/Δt_c, fraction";
    [
        Column::new("lowest").digits(3),
        Column::new("lowest at").unit(place),
        Column::new("highest").digits(3),
        Column::new("highest at").unit(place),
        Column::new(format!("within {} to {}", PAPER[0], PAPER[1])).unit("%").digits(3),
        Column::new("highest/lowest").digits(3),
    ]
}

/// One row for each choice, end and measure.
pub(super) fn by_choice(grid: &Grid) -> Table {
    let first = ["contact force", "Γ_DA", "measure"].map(Column::new).into_iter();
    let first = first.chain([Column::new("T − t_c").unit("L/c").digits(2), Column::new("runs")]);
    let caption = format!(
        "Effectivity e/e_Ex over {} to {} elements, Δt/Δt_c from {} to {} and the fractions {} of a step: its range, where its ends are, and \
         how much of it lies in the range that the paper states.",
        grid.elements[0],
        grid.elements[grid.elements.len() - 1],
        grid.ratios[0],
        grid.ratios[grid.ratios.len() - 1],
        FRACTIONS.map(|fraction| short(fraction, 1)).join(", "),
    );
    let mut table = Table::new("bar-maps-summary", caption, first.chain(columns()).collect());
    for (c, (reading, option)) in grid.choices.iter().enumerate() {
        for (m, measure) in MEASURES.iter().enumerate() {
            for end in ENDS {
                let wanted = |setting: &Setting| setting.after_impact == end;
                let Some(summary) = Summary::of(grid, c, m, wanted) else { continue };
                let runs = grid.effectivities(c, m, wanted).count();
                let words = [reading.to_string().into(), option.to_string().into(), Cell::from(*measure)];
                table.push(words.into_iter().chain([end.into(), runs.into()]).chain(summary.cells()));
            }
        }
    }
    table
}

/// One row for each reading and fraction, with the default Γ_DA, of the largest error of the longest runs.
pub(super) fn by_fraction(grid: &Grid) -> Table {
    let caption = format!(
        "The same for the largest error, Γ_DA `{}` and runs until t_c + {} L/c, for each fraction of a step at which the impact falls.",
        Acceleration::default(),
        ENDS[1],
    );
    let first = [Column::new("contact force"), Column::new("fraction").unit("steps").digits(1)];
    let mut table = Table::new("bar-maps-fractions", caption, first.into_iter().chain(columns()).collect());
    for reading in Reconstruction::ALL {
        let choice = grid.choices.iter().position(|choice| *choice == (*reading, Acceleration::default()));
        for fraction in FRACTIONS {
            let wanted = |s: &Setting| s.fraction == fraction && s.after_impact == ENDS[1];
            let Some(summary) = choice.and_then(|choice| Summary::of(grid, choice, 0, wanted)) else { continue };
            table.push([reading.to_string().into(), Cell::from(fraction)].into_iter().chain(summary.cells()));
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::super::study::Outcome;
    use super::*;
    use percute_estimator::ErrorMeasures;

    /// Effectivities of 0.5, 1, 2 and 0.7: from 0.5 to 2, half of them within 0.7 to 1.8.
    #[test]
    fn a_summary_of_four_runs() {
        let setting = |elements| Setting { elements, ratio: 0.5, fraction: 0.1, after_impact: 2.0 };
        let outcome =
            |sup| Outcome { exact: [2.0, 1.0], estimates: vec![ErrorMeasures { sup, ..ErrorMeasures::default() }] };
        let grid = Grid {
            elements: &[1, 2, 3, 4],
            ratios: &[0.5],
            choices: vec![(Reconstruction::default(), Acceleration::default())],
            settings: [1, 2, 3, 4].map(setting).to_vec(),
            outcomes: [1.0, 2.0, 4.0, 1.4].map(outcome).to_vec(),
        };
        let summary = Summary::of(&grid, 0, 0, |_| true).unwrap();
        assert_eq!((summary.low.value, summary.low.setting.elements), (0.5, 1));
        assert_eq!((summary.high.value, summary.high.setting.elements), (2.0, 3));
        assert_eq!((summary.within, summary.ratio()), (0.5, 4.0));
        assert_eq!(Summary::of(&grid, 0, 0, |setting| setting.elements > 4), None);
    }
}
