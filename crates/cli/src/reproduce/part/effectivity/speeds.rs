//! How the estimate depends on the speed of the impact.

use super::super::parallel::{in_order, threads};
use super::cases::cases;
use super::study::{Case, readings};
use super::tables::MEASURES;
use super::{Kind, PART};
use crate::reproduce::table::{Cell, Column, Table};
use crate::reproduce::{Effort, ReproduceError, Section};
use percute_core::observer::Observer;
use percute_estimator::Reconstruction;

/// Parts of the speed and the gap of the cases.
const PARTS: [f64; 4] = [1.0, 0.1, 0.01, 0.001];

/// A case, and the part of its speed.
type Run = (Case, f64);

/// The flat impact with friction, the disc, and the corner.
fn runs(effort: &Effort) -> Vec<Run> {
    let all = cases(&Effort::FULL);
    let kinds = [Kind::Flat, Kind::Curved, Kind::Corner];
    let last = |kind: Kind| all.iter().rfind(|case| case.kind() == kind && case.friction > 0.0);
    let first = |kind: Kind| all.iter().find(|case| case.kind() == kind && case.friction > 0.0);
    // The last curved body is the disc that falls straight.
    let of_kind = |kind: Kind| if kind == Kind::Curved { last(kind) } else { first(kind) };
    let chosen: Vec<Case> = kinds.into_iter().filter_map(of_kind).map(|case| case.few()).collect();
    let chosen = effort.first(1, &chosen);
    chosen.iter().flat_map(|&case| PARTS.map(|part| (case, part))).collect()
}

/// Computes the runs and adds text and table.
pub(super) fn add(section: &mut Section, effort: &Effort, observer: &mut dyn Observer) -> Result<(), ReproduceError> {
    let runs = runs(effort);
    let found = in_order(PART.key, threads(effort.threads), &runs, observer, |(case, part), stop| {
        let slower = Case { velocity: case.velocity.map(|v| part * v), gap: part * case.gap, ..*case };
        slower.run_finest(&readings(), stop)
    })?;
    let mut columns = vec![
        Column::new("body"),
        Column::new("contact force"),
        Column::new("speed across the plane").unit("m/s").digits(1),
        Column::new("over the wave speed").digits(2),
    ];
    columns.extend(MEASURES.map(|measure| Column::new(measure).digits(3)));
    let caption = "Effectivity over the speed of the impact, on mesh 2 against the first reference; the gap shrinks with the speed, so \
                   that all touch at the same instant.";
    let mut table = Table::new("effectivity-speeds", caption, columns);
    for ((case, part), found) in runs.iter().zip(&found) {
        let speed = part * case.velocity[1].abs();
        let over = speed / case.problem(0)?.materials()[0].wave_speed();
        for (r, reading) in Reconstruction::ALL.iter().enumerate() {
            let words = [case.name().into(), reading.to_string().into(), Cell::from(speed), over.into()];
            table.push(words.into_iter().chain(found.effectivity(r).map(Cell::from)));
        }
    }
    section.heading("Slow impacts");
    section.text(
        "Where all edges that touch lie in the plane, a slower impact is the same in another scale, and the effectivity does not change. \
         Where a corner or a curve touches, an edge beside the first node is off the plane by its slope, whatever the speed: a body that \
         is less deformed touches with a smaller part of it than the mesh has. The force on such an edge costs gap·F_n, which falls like the \
         force, while the square of the true error falls like the square of the force. So `corrected` grows like 1/√v at corners and points, \
         and a mesh that is to resolve a slow impact must be as fine as its zone of contact. `consistent` and `published`, which drop that force, come to \
         a limit, for they lack its impulse in any case.",
    );
    section.table(table);
    Ok(())
}
