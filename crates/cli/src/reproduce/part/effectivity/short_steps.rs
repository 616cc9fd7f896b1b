//! Whether the estimate stays good as steps become short.

use super::super::bar_maps::study::Setting;
use super::super::parallel::{in_order, threads};
use super::cases::{FEW, cases};
use super::figure::GOOD;
use super::study::{Case, readings};
use super::tables::MEASURES;
use super::{Kind, PART};
use crate::reproduce::chart::{Axis, Band, Hue, Lines, Panel, Series};
use crate::reproduce::table::{Cell, Column, Table};
use crate::reproduce::{Effort, ReproduceError, Section};
use percute_core::observer::Observer;
use percute_estimator::{Ablation, Options};

/// Δt/Δt_c.
const RATIOS: [f64; 6] = [0.9, 0.5, 0.2, 0.1, 0.05, 0.02];
/// The bar, and the fractions of a step at which its impact falls.
const ELEMENTS: usize = 40;
const FRACTIONS: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];

/// A way to estimate: its name and its options.
type Attempt = (String, Options);

/// The readings, and the default with reactions that are not spread in time.
fn attempts() -> Vec<Attempt> {
    let unspread = Options { ablation: Ablation::ImpulseSmoothing, threads: Some(1), ..Options::default() };
    let readings = readings().into_iter().map(|options| (options.reconstruction.to_string(), options));
    readings.chain([("corrected, not spread".to_string(), unspread)]).collect()
}

/// A body.
#[derive(Clone, Copy, Debug)]
enum Subject {
    Bar,
    Plane(Case),
}

/// e/e_ref of each attempt: sup and mean, lowest and highest.
type Ranges = Vec<[[f64; 2]; 2]>;

impl Subject {
    fn name(&self) -> String {
        match self {
            Self::Bar => format!("bar, {ELEMENTS} elements"),
            Self::Plane(case) => case.name(),
        }
    }

    /// All it takes at one ratio.
    fn run(&self, ratio: f64, observer: &mut dyn Observer) -> Result<Ranges, ReproduceError> {
        let mut found: Vec<Vec<[f64; 2]>> = Vec::new();
        let options: Vec<Options> = attempts().into_iter().map(|(_, options)| options).collect();
        match self {
            Self::Bar => {
                for fraction in FRACTIONS {
                    let setting = Setting { elements: ELEMENTS, ratio, fraction, after_impact: 2.0 };
                    let outcome = setting.run_with(&options, observer)?;
                    found.push((0..options.len()).map(|r| outcome.effectivity(r)).collect());
                }
            }
            Self::Plane(case) => {
                let finest = Case { ratio, ..*case }.run_finest(&options, observer)?;
                found.push((0..options.len()).map(|r| finest.effectivity(r)).collect());
            }
        }
        let range = |r: usize, m: usize| {
            let values = || found.iter().map(|one| one[r][m]);
            [values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max)]
        };
        Ok((0..options.len()).map(|r| [range(r, 0), range(r, 1)]).collect())
    }
}

/// The bar, the flat impact with friction, and the one with a corner first.
fn subjects(effort: &Effort) -> Vec<Subject> {
    let all = cases(&Effort::FULL);
    let of_kind = |kind: Kind| {
        let found = all.iter().find(|case| case.kind() == kind && case.friction > 0.0);
        found.map(|case| Subject::Plane(case.few()))
    };
    let plane = [of_kind(Kind::Flat), of_kind(Kind::Corner)].into_iter().flatten();
    let subjects: Vec<Subject> = std::iter::once(Subject::Bar).chain(plane).collect();
    effort.first(1, &subjects).to_vec()
}

/// Computes the runs and adds text, figure and table.
pub(super) fn add(section: &mut Section, effort: &Effort, observer: &mut dyn Observer) -> Result<(), ReproduceError> {
    let subjects = subjects(effort);
    let runs: Vec<(Subject, f64)> =
        subjects.iter().flat_map(|&subject| RATIOS.map(move |ratio| (subject, ratio))).collect();
    let found = in_order(PART.key, threads(effort.threads), &runs, observer, |(subject, ratio), stop| {
        subject.run(*ratio, stop)
    })?;
    let table = table(&runs, &found);
    section.heading("Short steps");
    section.text(format!(
        "The simulation stops the mass of a node that arrives within a step: the shorter the step, the larger the force. The readings must not \
         follow it, which for `corrected` needs its impulses spread in time. The bar of figure 5, with impacts at {} fractions of a step and until t_c + 2L/c, against the exact solution; \
         plane bodies on mesh {FEW} against the first reference. Spread over the time of a wave through the depth of the node, a force begins with twice the \
         exact one: on the flat block the largest error of `corrected`, which is then that of the impact, rises with shorter steps to a limit, and the mean does not.",
        FRACTIONS.len(),
    ));
    section.figure(
        "effectivity-steps",
        draw(&table, &subjects)?,
        format!(
            "Effectivity over Δt/Δt_c (both axes logarithmic), a panel for each body: the largest error [15] as lines, the mean [16] dashed, the largest \
             over the fractions of a step. The band is from {} to {}.",
            GOOD[0], GOOD[1]
        ),
    );
    section.table(table);
    Ok(())
}

fn column(end: &str, measure: &str) -> String {
    format!("{end}, {measure}")
}

fn table(runs: &[(Subject, f64)], found: &[Ranges]) -> Table {
    let mut columns = vec![Column::new("body"), Column::new("contact force"), Column::new("Δt/Δt_c").digits(2)];
    columns
        .extend(MEASURES.iter().flat_map(|m| ["lowest", "highest"].map(|end| Column::new(column(end, m)).digits(3))));
    let caption = "Effectivity over Δt/Δt_c: of the bar the lowest and the highest over the fractions of a step, of a plane body one value.";
    let mut table = Table::new("effectivity-steps", caption, columns);
    for ((subject, ratio), ranges) in runs.iter().zip(found) {
        for ((name, _), range) in attempts().iter().zip(ranges) {
            let words = [subject.name().into(), Cell::from(name.clone()), Cell::from(*ratio)];
            table.push(words.into_iter().chain(range.iter().flatten().map(|&x| x.into())));
        }
    }
    table
}

fn draw(table: &Table, subjects: &[Subject]) -> Result<String, ReproduceError> {
    let curve = |subject: &Subject, (k, (name, _)): (usize, &Attempt), measure: &str| {
        let rows = [("body", subject.name().into()), ("contact force", Cell::from(name.clone()))];
        let points = table.numbers("Δt/Δt_c", &rows).into_iter().zip(table.numbers(&column("highest", measure), &rows));
        Series::new(format!("{name}, {measure}"), points.map(|(x, y)| [x, y]).collect(), Hue::Own(k)).marked()
    };
    let panel = |subject: &Subject| {
        let both = |one| [curve(subject, one, MEASURES[0]), curve(subject, one, MEASURES[1]).dashed()];
        // The default lies over the others.
        let series = attempts().iter().enumerate().rev().flat_map(both).collect();
        Panel { title: subject.name().split(',').next().unwrap_or_default().to_string(), series }
    };
    let lines = Lines {
        x: Axis::log("Δt/Δt_c").marks(&[0.02, 0.05, 0.1, 0.2, 0.5, 0.9]),
        y: Axis::log("e/e_ref").marks(&[0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0]),
        panels: subjects.iter().map(panel).collect(),
        columns: 3,
        bands: vec![Band { low: GOOD[0], high: GOOD[1] }],
    };
    Ok(lines.svg()?)
}
