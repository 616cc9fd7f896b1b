//! What was tried: the default without each of its parts, and the other readings, on some of the cases.

mod slide;

use super::bar_maps::PAPER;
use super::bar_maps::study::{Outcome, Setting};
use super::effectivity::body::Body;
use super::effectivity::cases::{Kind, cases};
use super::effectivity::study::{Case, Found};
use super::parallel::{in_order, threads};
use crate::reproduce::chart::{Axis, Band, Hue, Lines, Panel, Series};
use crate::reproduce::table::{Cell, Column, Table};
use crate::reproduce::{Effort, Part, ReproduceError, Section};
use percute_core::observer::Observer;
use percute_estimator::{Ablation, Options, Reconstruction};
use percute_workflow::message::short;

pub(super) const PART: Part =
    Part { key: "tried", title: "What each part of the default is for, and what failed", make };

/// A way to estimate, and what is to be said of it.
struct Attempt {
    name: &'static str,
    what: &'static str,
    reconstruction: Reconstruction,
    ablation: Ablation,
}

const fn of_whole(name: &'static str, what: &'static str, ablation: Ablation) -> Attempt {
    Attempt { name, what, reconstruction: Reconstruction::Corrected, ablation }
}

const ATTEMPTS: [Attempt; 9] = [
    of_whole("corrected", "the default with all its parts", Ablation::None),
    of_whole(
        "no auxiliary solution",
        "the balance of the simulation's own displacements: what the nodal forces of the density and the reactions differ by \
         becomes acceleration [55], and drifts; and the dispersion that has built up is not seen",
        Ablation::AuxiliarySolution,
    ),
    of_whole(
        "auxiliary solution as dispersive",
        "an auxiliary without its two corrections: nothing drifts, but waves of the simulation and of the balance are late \
         together, and the estimate loses them on fine meshes with small steps",
        Ablation::Correction,
    ),
    of_whole(
        "tractions of the stars",
        "no descent to tractions of least energy: where the contact begins, and around corners, the elastic part is several times too \
         large",
        Ablation::LeastEnergy,
    ),
    of_whole(
        "no moment",
        "the densities R_k/ℓ_k as they are, without the moment of the reactions: of little weight while an impact lasts, but a body \
         that slides turns ever faster (below)",
        Ablation::Moment,
    ),
    of_whole(
        "no normal work",
        "the normal law at displacement level alone: what the simulation loses when a node is stopped within a step is felt at \
         that instant only, while its waves are missing from then on",
        Ablation::NormalWork,
    ),
    of_whole(
        "twice the normal work",
        "the weight that [14] gives to the work of friction: an estimate from above everywhere on the bar, but farther from the true \
         error elsewhere",
        Ablation::DoubledWork,
    ),
    Attempt {
        name: "consistent",
        what: "forces on touching edges only",
        reconstruction: Reconstruction::Consistent,
        ablation: Ablation::None,
    },
    Attempt {
        name: "published",
        what: "the paper's forces",
        reconstruction: Reconstruction::Published,
        ablation: Ablation::None,
    },
];

impl Attempt {
    /// On the thread that calls.
    fn options(&self) -> Options {
        let Self { reconstruction, ablation, .. } = *self;
        Options { reconstruction, ablation, threads: Some(1), ..Options::default() }
    }
}

/// Part of the grid of the bar maps: N_s, α, fraction; up to the end of contact.
const ELEMENTS: [usize; 3] = [10, 40, 160];
const RATIOS: [f64; 3] = [0.5, 0.8, 1.0];
const FRACTIONS: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];
/// Meshes of the plane bodies, and the reference.
const MESHES: usize = 3;
const REFERENCE: &[usize] = &[5];

fn make(effort: &Effort, observer: &mut dyn Observer) -> Result<Section, ReproduceError> {
    let options: Vec<Options> = ATTEMPTS.iter().map(Attempt::options).collect();
    let bars = bars(effort);
    let on_bars: Vec<Outcome> =
        in_order(PART.key, threads(effort.threads), &bars, observer, |bar, stop| bar.run_with(&options, stop))?;
    let bodies = bodies(effort);
    let on_bodies =
        in_order(PART.key, threads(effort.threads), &bodies, observer, |case, stop| case.run(&options, stop))?;
    let mut section = Section::new(PART.key, PART.title);
    section.text(
        "The default `corrected` is made of several parts (see the page on readings). Here each is left out in turn, and the other \
         readings stand beside it: e/e_Ex on a part of the grid of bars, and e/e_ref on plane bodies.",
    );
    ATTEMPTS.iter().for_each(|attempt| section.text(format!("`{}`: {}.", attempt.name, attempt.what)));
    let plane = plane(&bodies, &on_bodies);
    section.figure(
        "tried",
        draw(&plane, &bodies)?,
        "Effectivity of the largest error [15] over refinement (both axes logarithmic), a panel for each body, a curve for each attempt. \
         What rises loses track as the mesh becomes finer.",
    );
    if !effort.small {
        section.table(bar(&on_bars));
    }
    section.table(plane);
    slide::add(&mut section, effort, observer)?;
    Ok(section)
}

fn bars(effort: &Effort) -> Vec<Setting> {
    let elements = effort.first(2, &ELEMENTS);
    let of = |&elements: &usize| {
        RATIOS
            .into_iter()
            .flat_map(move |ratio| FRACTIONS.map(|fraction| Setting { elements, ratio, fraction, after_impact: 2.0 }))
    };
    elements.iter().flat_map(of).collect()
}

/// One body of each kind, and the flat impact that sticks in plane strain.
fn bodies(effort: &Effort) -> Vec<Case> {
    let meshes = effort.either(2, MESHES);
    let all = cases(&Effort::FULL);
    let mut chosen: Vec<Case> = Vec::new();
    for kind in Kind::ALL {
        let wanted = |case: &&Case| case.kind() == kind && !matches!(case.body, Body::Unstructured | Body::Rounded);
        let mut of_kind = all.iter().filter(wanted).copied();
        // In the order of the table the first flat case is without friction, the last one sticks most.
        chosen.extend(of_kind.next());
        if kind == Kind::Flat {
            chosen.extend(of_kind.next_back());
        }
    }
    let few = |case: Case| Case { meshes, references: REFERENCE, ..case };
    chosen.truncate(effort.either(2, chosen.len()));
    chosen.into_iter().map(few).collect()
}

/// The range of each attempt on the bars.
fn bar(outcomes: &[Outcome]) -> Table {
    let columns = vec![
        Column::new("attempt"),
        Column::new("measure"),
        Column::new("lowest").digits(3),
        Column::new("highest").digits(3),
        Column::new("highest/lowest").digits(3),
        Column::new(format!("within {} to {}", PAPER[0], PAPER[1])).unit("%").digits(3),
    ];
    let list = |values: &[f64]| values.iter().map(|v| short(*v, 2)).collect::<Vec<_>>().join(", ");
    let caption = format!(
        "Effectivity e/e_Ex of the bar on {} elements, Δt/Δt_c of {}, and the fractions {} of a step, until t_c + 2L/c.",
        list(&ELEMENTS.map(|n| n as f64)),
        list(&RATIOS),
        list(&FRACTIONS),
    );
    let mut table = Table::new("tried-bar", caption, columns);
    for (k, attempt) in ATTEMPTS.iter().enumerate() {
        for (m, measure) in ["sup", "mean"].into_iter().enumerate() {
            let values: Vec<f64> = outcomes.iter().map(|outcome| outcome.effectivity(k)[m]).collect();
            let low = values.iter().copied().fold(f64::INFINITY, f64::min);
            let high = values.iter().copied().fold(0.0, f64::max);
            let within = values.iter().filter(|v| (PAPER[0]..=PAPER[1]).contains(*v)).count();
            let numbers = [low, high, high / low, 100.0 * within as f64 / values.len() as f64];
            table.push([attempt.name.into(), Cell::from(measure)].into_iter().chain(numbers.map(Cell::from)));
        }
    }
    table
}

fn on_mesh(measure: &str, mesh: usize) -> String {
    format!("{measure}, mesh {}", mesh + 1)
}

/// Each attempt on each body.
fn plane(bodies: &[Case], found: &[Vec<Option<Found>>]) -> Table {
    let columns = ["case", "attempt"].map(Column::new).into_iter();
    let measured =
        ["sup", "mean"].into_iter().flat_map(|m| (0..MESHES).map(move |k| Column::new(on_mesh(m, k)).digits(3)));
    let caption = "Effectivity e/e_ref of each attempt on the three coarser meshes, against 32 times as many elements along a side as the \
                   coarsest.";
    let mut table = Table::new("tried-plane", caption, columns.chain(measured).collect());
    for (case, found) in bodies.iter().zip(found) {
        for (k, attempt) in ATTEMPTS.iter().enumerate() {
            let value = |m: usize, mesh: usize| {
                let found = found.get(mesh).and_then(Option::as_ref);
                Cell::from(found.map(|found| found.effectivity(k)[m]))
            };
            let values = (0..2).flat_map(|m| (0..MESHES).map(move |mesh| (m, mesh))).map(|(m, mesh)| value(m, mesh));
            table.push([case.name().into(), Cell::from(attempt.name)].into_iter().chain(values));
        }
    }
    table
}

fn draw(table: &Table, bodies: &[Case]) -> Result<String, ReproduceError> {
    let curve = |case: &Case, (k, attempt): (usize, &Attempt)| {
        let rows = [("case", Cell::from(case.name())), ("attempt", attempt.name.into())];
        let value = |mesh| table.numbers(&on_mesh("sup", mesh), &rows).first().copied().unwrap_or(f64::NAN);
        let points = (0..MESHES).map(|mesh| [f64::from(1 << mesh), value(mesh)]).collect();
        Series::new(attempt.name, points, Hue::Own(k)).marked()
    };
    let panel = |case: &Case| Panel {
        title: case.name(),
        // The default lies over the others.
        series: ATTEMPTS.iter().enumerate().rev().map(|attempt| curve(case, attempt)).collect(),
    };
    let lines = Lines {
        x: Axis::log("times finer than mesh 1").marks(&[1.0, 2.0, 4.0]),
        y: Axis::log("e/e_ref").marks(&[0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0]),
        panels: bodies.iter().map(panel).collect(),
        columns: 2,
        bands: vec![Band { low: 0.9, high: 1.5 }],
    };
    Ok(lines.svg()?)
}
