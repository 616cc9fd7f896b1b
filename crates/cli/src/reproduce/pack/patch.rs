//! Case 8: patch tests, free and in contact.

use super::super::{ReproduceError, Tally};
use super::Outcome;
use super::row::Expected::Within;
use super::row::PackRow;
use super::text::CaseText;
use super::trial::plane;
use percute_estimator::{Acceleration, Options, Reconstruction, Request};

/// Every reading with every Γ_DA, and one run in contact with one estimate.
pub(super) const RUNS: usize = Reconstruction::ALL.len() * Acceleration::ALL.len() + 2;

/// Pressure and shear on the ground (Pa).
const PRESSURE: f64 = 5e7;
const SHEAR: f64 = 1e7;

const ROUNDING: &str =
    "linear displacements are in the finite-element space: rounding of u, 1e-16 of it, over the strains";
const COMPLEMENTARITY: &str = "as before; of the contact law rounding of velocities stays, and its root: 1e-8";

fn row(quantity: String, unit: &'static str, exact: f64, computed: f64, within: f64, reason: &'static str) -> PackRow {
    PackRow { quantity, unit, exact, computed: vec![computed], expected: Within(within), reason }
}

/// Case 8, a free body: no error for any choice of the method.
pub(super) fn free(tally: &mut Tally<'_>) -> Result<Outcome, ReproduceError> {
    let text = CaseText::new("patch", include_str!("../../../../../python/percute/verification/benchmarks/cases/patch.toml"));
    let case = text.read_plane()?;
    let mut rows = Vec::new();
    for &reconstruction in Reconstruction::ALL {
        for &acceleration in Acceleration::ALL {
            let options = Options { reconstruction, acceleration, ..Options::default() };
            let (_, estimate) = tally.estimate(1.0, &case.problem, &case.times, options, &Request::default())?;
            let quantity = format!("relative error, `{reconstruction}`, `{acceleration}`");
            rows.push(row(quantity, "", 0.0, estimate.error.relative_sup, 1e-10, ROUNDING));
        }
    }
    Ok(Outcome { rows, curve: None })
}

/// Case 8, pressed and sheared against the ground: the density of the reactions is uniform.
pub(super) fn contact(tally: &mut Tally<'_>) -> Result<Outcome, ReproduceError> {
    let text = CaseText::new("patch_contact", include_str!("../../../../../python/percute/verification/benchmarks/cases/patch_contact.toml"));
    let trial = plane(&text, tally)?;
    let Some(steps) = &trial.contact.steps else { return Err(text.unexpected("no steps were kept")) };
    let count = trial.contact.nodes.len();
    let furthest = |component: usize, exact: f64| {
        let density = |row: usize| steps.force[row][component] / trial.contact.nodes[row % count].area;
        (0..steps.force.len())
            .map(density)
            .fold(exact, |a, b| if (b - exact).abs() > (a - exact).abs() { b } else { a })
    };
    let case = &trial.case;
    let (_, estimate) = tally.estimate(1.0, &case.problem, &case.times, Options::default(), &Request::default())?;
    let reference = estimate.error.reference_sup.powi(2);
    let elastic = estimate.over_time.iter().fold(0.0_f64, |m, s| m.max(s.parts.elastic));
    let rows = vec![
        row(
            "pressure on the ground, that of any node and instant furthest off".into(),
            "Pa",
            PRESSURE,
            furthest(1, PRESSURE),
            1e-9 * PRESSURE,
            ROUNDING,
        ),
        row("shear on the ground, likewise".into(), "Pa", -SHEAR, furthest(0, -SHEAR), 1e-9 * PRESSURE, ROUNDING),
        row(
            format!("relative elastic error, `{}`", Reconstruction::default()),
            "",
            0.0,
            (elastic / reference).sqrt(),
            1e-10,
            ROUNDING,
        ),
        row(
            format!("relative error, `{}`", Reconstruction::default()),
            "",
            0.0,
            estimate.error.relative_sup,
            1e-7,
            COMPLEMENTARITY,
        ),
    ];
    Ok(Outcome { rows, curve: None })
}
