//! The paper's figures 5 and 6: the error of an impacting bar and the effectivity, over mesh and step.

mod grid;
mod maps;
pub(super) mod study;
mod summary;
mod sweep;

use crate::reproduce::{Effort, Part, ReproduceError, Section};
use grid::{ENDS, FRACTIONS, Grid, MEASURES};
use percute_core::observer::Observer;
use percute_estimator::{Acceleration, Reconstruction};
use percute_workflow::message::{percent, short};
use study::{BAR, Setting, WHOLE};
use summary::Summary;

pub(super) const PART: Part =
    Part { key: "bar-maps", title: "The paper's figures 5 and 6: the bar over mesh and step", make };

/// The range of the effectivity that the paper states (§7.1.6).
pub(super) const PAPER: [f64; 2] = [0.7, 1.8];

fn make(effort: &Effort, observer: &mut dyn Observer) -> Result<Section, ReproduceError> {
    let grid = Grid::run(PART.key, effort, observer)?;
    let sweep = sweep::table(PART.key, effort, observer)?;
    let mut section = Section::new(PART.key, PART.title);
    introduce(&mut section);
    relative(&mut section, &grid)?;
    effectivity(&mut section, &grid)?;
    section.table(maps::table(&grid));
    // What sums up needs all runs.
    if !effort.small {
        section.table(summary::by_choice(&grid));
    }
    section.heading("The instant of impact inside a step");
    instants(&mut section, &grid)?;
    let readings = "one curve for each reading of the contact force";
    section.figure(
        "figure-6-instants",
        sweep::figure(&sweep)?,
        format!(
            "Effectivity e/e_Ex of the largest error (`sup`, [15]) and of the mean ([16]) on {} elements over the fraction of a step at which \
             the impact falls, at two lengths of the step, with Γ_DA `{}`: {readings}. At a fraction of 1 the bar arrives at an instant of the \
             scheme. The band is the range that the paper states.",
            sweep::ELEMENTS,
            Acceleration::default(),
        ),
    );
    if !effort.small {
        section.table(summary::by_fraction(&grid));
    }
    section.table(sweep);
    section.table(grid.table());
    Ok(section)
}

fn introduce(section: &mut Section) {
    section.text(format!(
        "An aluminium bar (E = {} GPa, L = {} m, S = {} m², ρ = {} kg/m³) flies at {} m/s against a rigid plane. The exact solution is known: \
         contact lasts 2L/c, and then the bar flies back. The true error e_Ex [60] is measured in it, at the instants t_n, and the effectivity \
         is the estimate over it, of the largest values over time (`sup`) or of the means (`mean`). Lengths of the step are \
         fractions of the critical one, Δt_c = h/c [33].",
        short(1e-9 * BAR.young, 3),
        BAR.length,
        BAR.section,
        BAR.density,
        BAR.speed,
    ));
    section.text(format!(
        "The paper tells neither the gap nor when its runs end. Here the impact falls {} + f steps after the start, for several fractions f, and runs \
         end {} L/c after the impact t_c, when contact does, or {} L/c after it, well into the flight back; up to a step is added so that steps are whole.",
        WHOLE, ENDS[0], ENDS[1],
    ));
}

/// Figure 5.
fn relative(section: &mut Section, grid: &Grid) -> Result<(), ReproduceError> {
    section.figure(
        "figure-5",
        maps::relative(grid)?,
        format!(
            "The paper's figure 5: relative error ε of the largest values [22] (%, colours logarithmic) over the number of elements and \
             Δt/Δt_c, for each reading of the contact force (rows) and each Γ_DA (columns); impact at {} of a step, T = t_c + {} L/c. \
             As the paper says, smaller steps do not make the solution much better: the mesh does.",
            middle(),
            ENDS[1],
        ),
    );
    Ok(())
}

/// Figure 6, for both measures.
fn effectivity(section: &mut Section, grid: &Grid) -> Result<(), ReproduceError> {
    section.text(ranges(grid));
    for (m, measure) in MEASURES.iter().enumerate() {
        let (what, equation) = [("largest error", "[15]"), ("mean error", "[16]")][m];
        section.figure(
            format!("figure-6-{measure}"),
            maps::effectivity(grid, m)?,
            format!(
                "The paper's figure 6: effectivity e/e_Ex of the {what} {equation} [60] over the number of elements and Δt/Δt_c, for each reading of \
                 the contact force (rows) and each Γ_DA (columns); impact at {} of a step, T = t_c + {} L/c. Pale is 1, blue too small, red \
                 too large; colours are in equal ratios from 1/4 to 4.",
                middle(),
                ENDS[1],
            ),
        );
    }
    Ok(())
}

/// The fraction of the maps.
fn middle() -> f64 {
    FRACTIONS[FRACTIONS.len() / 2]
}

/// Where effectivities lie with each reading, default Γ_DA, over all ends and measures.
fn ranges(grid: &Grid) -> String {
    let one = |reading: &Reconstruction| {
        let choice = grid.choice(*reading);
        let parts = MEASURES.iter().enumerate().flat_map(|(m, measure)| {
            ENDS.iter().filter_map(move |&end| {
                let summary = Summary::of(grid, choice, m, |s: &Setting| s.after_impact == end)?;
                let range = format!("{} to {}", short(summary.low.value, 2), short(summary.high.value, 3));
                let share = percent(summary.within);
                Some(format!(
                    "{range} (`{measure}`, T = t_c + {end} L/c; {share} of the values within the paper's range)"
                ))
            })
        });
        format!("with `{reading}` {}", parts.collect::<Vec<_>>().join(", "))
    };
    format!(
        "The paper finds effectivities from {} to {} and does not say of which measure. Over all runs and with Γ_DA `{}` they are: {}. {} The highest \
         means are of runs that stop with the contact, at Δt = Δt_c: there the solution is exact but for the step of the impact. \
         The low ends of `consistent` and `published` come from fine meshes and small steps, where dispersion adds up behind the front: a measure \
         whose balance is that of the simulation's own displacements does not see what has accumulated. `corrected` balances an auxiliary solution \
         with less dispersion instead, and its values come near 1 just there. Its own low end is at Δt = Δt_c in the runs that go \
         on beyond the contact: there the simulation is at its limit of stability, and its shortest wave, once the release has \
         excited it, grows with time. The auxiliary's does not grow, but the release excites it as well, and about half of that is not seen. \
         {}",
        PAPER[0],
        PAPER[1],
        Acceleration::default(),
        Reconstruction::ALL.iter().map(one).collect::<Vec<_>>().join("; "),
        spread(grid),
        below_the_critical_step(grid),
    )
}

/// Whether the values of the default are less spread than those of the others.
fn spread(grid: &Grid) -> String {
    let ratio = |reading: Reconstruction, m: usize, end: f64| {
        let summary = Summary::of(grid, grid.choice(reading), m, |s: &Setting| s.after_impact == end);
        summary.map_or(f64::NAN, |summary| summary.high.value / summary.low.value)
    };
    let default = Reconstruction::default();
    let wider = MEASURES.iter().enumerate().flat_map(|(m, measure)| {
        ENDS.iter().filter_map(move |&end| {
            let own = ratio(default, m, end);
            let others = Reconstruction::ALL.iter().filter(|reading| **reading != default);
            let least = others.map(|&reading| ratio(reading, m, end)).fold(f64::INFINITY, f64::min);
            (own > 0.5 * least).then(|| {
                format!(
                    "`{measure}`, T = t_c + {end} L/c: {} against {} of the nearest",
                    short(own, 3),
                    short(least, 3)
                )
            })
        })
    });
    let wider: Vec<String> = wider.collect();
    let but = if wider.is_empty() {
        String::new()
    } else {
        format!(", but for {} (Δt = Δt_c makes the difference, see below)", wider.join("; "))
    };
    format!(
        "The highest over the lowest value is with `{default}` at most half of that with either other reading{but}."
    )
}

/// The default in the long runs, but for those at the critical step.
fn below_the_critical_step(grid: &Grid) -> String {
    let default = Reconstruction::default();
    let choice = grid.choice(default);
    let end = ENDS.into_iter().fold(0.0, f64::max);
    let ranges = MEASURES.iter().enumerate().filter_map(|(m, measure)| {
        let summary = Summary::of(grid, choice, m, |s: &Setting| s.after_impact == end && s.ratio < 1.0)?;
        Some(format!("{} to {} (`{measure}`)", short(summary.low.value, 3), short(summary.high.value, 3)))
    });
    let ranges: Vec<String> = ranges.collect();
    format!("With all shorter steps, `{default}` is {} until t_c + {end} L/c.", ranges.join(" and "))
}

/// The worst of the fractions.
fn instants(section: &mut Section, grid: &Grid) -> Result<(), ReproduceError> {
    section.text(
        "The scheme stops the node that touches at the end of a step, wherever inside the step the bar arrives. How much that costs, and \
         how much of it the estimate sees, depends on the fraction of the step that is left.",
    );
    section.figure(
        "figure-6-worst",
        maps::worst(grid)?,
        format!(
            "The same maps as figure 6 for the largest error [15], T = t_c + {} L/c, but each value is the one farthest from 1 (as a ratio) over \
             the fractions {} of a step at which the impact falls.",
            ENDS[1],
            FRACTIONS.map(|fraction| short(fraction, 1)).join(", "),
        ),
    );
    Ok(())
}
