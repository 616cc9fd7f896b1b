//! Bars that strike something. All tolerances follow from two lengths, for n elements of length h = L/n:
//!
//! - the front of a jump of velocity is smeared over L(h/L)^⅔ (Airy front), so that what waits for it is off by at most that share,
//!   (1/n)^⅔, of a passage, and the energy norm by at most its root, (1/n)^⅓. Orders are ⅔ and ⅓ in the limit and higher before it, where
//!   the front fills the bar; instants are whole steps, which scatters single runs: four halvings leave ⅓ ± 0.1 and ⅔ + 0.3 − 0.1;
//! - at each impact the energy of the node that is stopped is lost, that of half an element: 1/(2n) of the whole. A
//!   new impact on a body that still swings takes a little less or more: order 1 ± 0.2.

use crate::rows::{NONE, check};
use std::ops::RangeInclusive;

const FRONT: RangeInclusive<f64> = 0.23..=0.43;
const RETURN: RangeInclusive<f64> = 0.57..=0.97;
const LOSS: RangeInclusive<f64> = 0.8..=1.2;

/// On n elements: (1/n)^⅔.
fn front(elements: f64) -> f64 {
    elements.powf(-2.0 / 3.0)
}

/// Five places of the impact in a step, the worst of them. Contact lasts 39.28 µs; the force is ρScv₀ = 110 MN; the case's impact is at 0.5 µs and
/// its steps of 0.9·0.25 mm/5092 m/s = 44.2 ns, of which half are known at best.
#[test]
fn bar_impact() {
    let n = 400.0;
    check(
        "bar_impact",
        &[
            ("error", FRONT, front(n).sqrt()),
            ("velocity of the rebound", RETURN, 400.0 * front(n)),
            ("duration", RETURN, 39.28e-6 * front(n)),
            // What the tails leave between the fronts falls faster than any front: 1e-6 of the force.
            ("contact force", NONE, 1.1e8 * 1e-6),
            ("impact", NONE, 22.1e-9),
        ],
    );
}

/// Two periods: fronts pass 16 times, which smear as the cube root of the time, 16^⅓ = 2.5; energies are proportional to squares of errors.
/// The momentum of a bounce is that of the fall, 100 N s twice, the period 16/3 s and the height 5 m. Four impacts.
#[test]
fn bouncing_bar() {
    let n = 400.0;
    check(
        "bouncing_bar",
        &[
            ("error", FRONT, front(n).sqrt()),
            ("impulse", RETURN, 1066.7 * front(n)),
            ("second impact", RETURN, 2.0 / 3.0 * front(n)),
            ("height", RETURN, 5.0 * front(n)),
            ("energy", LOSS, 500.0 * 4.0 / (2.0 * n)),
        ],
    );
}

/// Six passages, two impacts, of all of the rod at the velocity that has all of the energy.
#[test]
fn clamped_rod() {
    let n = 320.0;
    check(
        "clamped_rod",
        &[
            ("error", FRONT, front(n).sqrt()),
            ("distance", RETURN, 0.5 * front(n)),
            ("energy", LOSS, 0.125 * 2.0 / (2.0 * n)),
            ("contact force", NONE, 0.5 * 1e-5),
            ("impulse", RETURN, 1.0 * front(n)),
        ],
    );
}

/// Steps of 0.9·2.5 mm/5189 m/s = 0.43 µs: the impact lies on a t_n within rounding, and that is in the step before it or after it.
#[test]
fn steel_bar() {
    let n = 400.0;
    check(
        "steel_bar",
        &[
            ("error", FRONT, front(n).sqrt()),
            ("velocity of the rebound", RETURN, 0.1 * front(n)),
            ("duration", RETURN, 3.8545e-4 * front(n)),
            ("contact force", NONE, 1270.8 * 1e-6),
            ("impact", NONE, 0.43e-6),
        ],
    );
}

/// The figures that the case is known by: 5e-4 s, 3.8545e-4 s and 1270.8 N, to the digits given.
#[test]
fn the_published_figures_of_the_steel_bar() {
    let rows = crate::rows::outcome("steel_bar").rows;
    let exact = |name: &str| rows.iter().find(|row| row.quantity.starts_with(name)).unwrap().exact;
    assert!((exact("impact") - 5e-4).abs() < 1e-12);
    assert!((exact("duration") - 3.8545e-4).abs() < 0.5e-8);
    assert!((exact("contact force") - 1270.8).abs() < 0.05);
}
