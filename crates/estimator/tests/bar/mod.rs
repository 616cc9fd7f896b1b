//! The impact of a bar: against a computation by hand, and against the exact solution.

mod hand;
mod strip;

use crate::common::beside;
use hand::Bar;
use percute_core::contact::Obstacle;
use percute_core::dynamics::simulate;
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::observer::Unobserved;
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_estimator::reference::{Motion, TrueError, bar_impact_error};
use percute_estimator::{Acceleration, Estimate, Estimator, Options, Reconstruction, Request, Sampling};
use percute_exact::BarImpact;

/// The bar of §7.1.4 of the paper; `fraction` is the gap in steps of flight. The run ends half a
/// transit L/c after the rebound, so that all three phases are in it.
fn bar(elements: usize, courant: f64, fraction: f64) -> Bar {
    let mut bar = Bar {
        elements,
        length: 0.1,
        young: 70e9,
        density: 2700.0,
        section: 0.02,
        speed: 400.0,
        gap: 0.0,
        courant,
        steps: 0,
    };
    bar.gap = fraction * bar.step() * bar.speed;
    bar.steps = (fraction + 2.5 * elements as f64 / courant).ceil() as usize;
    bar
}

fn problem(bar: &Bar) -> Problem<1> {
    Problem::<1>::builder(Mesh::uniform_bar(bar.length, bar.elements).unwrap())
        .material(Elastic::bar(bar.young, bar.density, bar.section).unwrap())
        .initial_velocity(Initial::Uniform([-bar.speed]))
        .obstacle(Obstacle::plane([-bar.gap], [1.0], 0.0, None).unwrap())
        .build()
        .unwrap()
}

fn grid(bar: &Bar) -> TimeGrid {
    TimeGrid::uniform(bar.steps as f64 * bar.step(), bar.steps).unwrap()
}

/// The estimate of the program.
fn estimate(bar: &Bar, options: Options) -> Estimate {
    beside::run(&problem(bar), &grid(bar), options, &Request::default(), &mut Unobserved).1
}

/// Estimates with the reconstructions in [`RECONSTRUCTIONS`], and the true error \[60\].
fn effectivity(bar: &Bar) -> ([Estimate; 3], TrueError) {
    let (problem, times) = (problem(bar), grid(bar));
    let estimator = |reconstruction| {
        let options = Options { reconstruction, ..Options::default() };
        Estimator::new(&problem, &times, options).unwrap()
    };
    let [corrected, consistent, published] = RECONSTRUCTIONS.map(estimator);
    let mut sink = (Motion::default(), (corrected, (consistent, published)));
    simulate(&problem, &times, &mut sink, &mut Unobserved).unwrap();
    let (motion, (corrected, (consistent, published))) = sink;
    let Bar { length, young, density, section, speed, gap, .. } = *bar;
    let exact = BarImpact { length, young, density, section, speed, gap };
    let error = bar_impact_error(&problem, &motion, &exact).unwrap();
    ([corrected, consistent, published].map(|e| e.finish().unwrap()), error)
}

const RECONSTRUCTIONS: [Reconstruction; 3] =
    [Reconstruction::Corrected, Reconstruction::Consistent, Reconstruction::Published];

#[test]
fn the_program_agrees_with_the_computation_by_hand() {
    // 1e-9: two programs, rounding of 1e-16 over some hundred steps.
    let close = |a: f64, b: f64, scale: f64| (a - b).abs() <= 1e-9 * scale;
    for (elements, courant, fraction) in [
        (7, 0.9, 0.3),
        (20, 0.5, 1.6),
        (20, 0.77, 4.4),
        (13, 1.0, 2.5),
        (40, 0.6, 0.8),
        (10, 0.95, 7.1),
        (9, 0.13, 1.4),
    ] {
        let bar = bar(elements, courant, fraction);
        for &reconstruction in Reconstruction::ALL {
            for &acceleration in Acceleration::of(reconstruction) {
                for every in [1, 3] {
                    let what = format!("{elements}, {courant}, {fraction}, {reconstruction}, {acceleration}, {every}");
                    let hand = bar.estimate(reconstruction, acceleration, every);
                    assert!(hand.admissible, "{what}: penetrates, by hand only the equality problem is solved");
                    let ours = estimate(
                        &bar,
                        Options {
                            reconstruction,
                            acceleration: Some(acceleration),
                            every: Sampling::Every(every),
                            ..Options::default()
                        },
                    );
                    let pairs = [
                        (ours.error.sup, hand.sup),
                        (ours.error.mean, hand.mean),
                        (ours.error.reference_sup, hand.reference_sup),
                        (ours.error.reference_mean, hand.reference_mean),
                    ];
                    assert!(pairs.iter().all(|(a, b)| close(*a, *b, *b)), "{what}: {pairs:?}");
                    for (e, (a, b)) in ours.by_element.iter().zip(&hand.by_element).enumerate() {
                        assert!(close(*a, *b, hand.mean), "{what}: element {e} has {a} instead of {b}");
                    }
                }
            }
        }
    }
}

/// e_sup/e_Ex and e_mean/e_Ex on the paper's grid, up to the first step past the rebound at
/// t_c + 2L/c. The ranges of `consistent` and `published` are those of an independent computation over 10 to 400
/// elements, Δt/Δt_c from 0.5 to 1 and gaps of all fractions of a step: 0.24 to 2.1 and 0.24 to 3.2 (the
/// paper, with a gap that it does not give, has 0.7 to 1.8). That of `corrected` is what comes out here, 0.844 to
/// 1.585, with which the computation by hand agrees; docs/verification.md has it on the whole grid.
#[test]
fn effectivities_against_the_exact_solution() {
    for elements in [10, 40, 120] {
        for courant in [0.5, 0.75, 1.0] {
            for fraction in [2.1, 2.3, 2.5, 2.7, 2.9] {
                let mut bar = bar(elements, courant, fraction);
                bar.steps = (fraction + 2.0 * elements as f64 / courant).ceil() as usize;
                let (estimates, exact) = effectivity(&bar);
                let ranges = [(0.844, 1.585), (0.24, 2.1), (0.24, 3.2)];
                for (estimate, (reconstruction, (least, most))) in
                    estimates.iter().zip(RECONSTRUCTIONS.iter().zip(ranges))
                {
                    for ratio in [estimate.error.sup / exact.sup, estimate.error.mean / exact.mean] {
                        let told = format!("{elements}, {courant}, {fraction}, {reconstruction}: {ratio}");
                        // Ranges of two digits are rounded, and 0.75 is not on the grid of the others.
                        assert!(ratio > 0.98 * least && ratio < most + 0.05, "{told}");
                    }
                }
            }
        }
    }
}

/// The default stays with the true error as the step becomes short: the force that brings the end of the bar to rest is
/// bounded, and its work is not lost. The range is that of runs with 0.05, 0.1, 0.2 and 0.4 of the critical step on 10
/// to 80 elements at five fractions of a step; an independent computation agrees.
#[test]
fn short_steps() {
    for (elements, courant, fraction) in [(10, 0.05, 2.3), (10, 0.2, 2.9), (40, 0.1, 2.5), (20, 0.4, 2.1)] {
        let mut bar = bar(elements, courant, fraction);
        bar.steps = (fraction + 2.0 * elements as f64 / courant).ceil() as usize;
        let ([corrected, ..], exact) = effectivity(&bar);
        let (sup, mean) = (corrected.error.sup / exact.sup, corrected.error.mean / exact.mean);
        // The ends of the ranges have three digits.
        assert!((0.858..1.149).contains(&sup) && (0.883..1.034).contains(&mean), "{elements}, {courant}: {sup} {mean}");
    }
}

/// The true error of the bar falls under refinement with the width of the front: (h²ct)^⅓ with
/// dispersion, so that e² falls like h^⅔; one element at the critical step, where e² falls like h.
/// Both up to the middle of the way back: at the critical step exactly, the shortest mode of the mesh
/// grows linearly once the release has excited it.
#[test]
fn the_true_error_converges_with_the_front() {
    for (courant, order) in [(0.7, 1.0 / 3.0), (1.0, 0.5)] {
        let errors = [50, 100, 200, 400].map(|elements| {
            let mut bar = bar(elements, courant, 0.4);
            bar.steps = (0.4 + 1.5 * elements as f64 / courant).ceil() as usize;
            effectivity(&bar).1.mean
        });
        for pair in errors.windows(2) {
            let measured = (pair[0] / pair[1]).log2();
            // A front a few elements wide has not its asymptotic shape yet: 0.30 measured for ⅓.
            assert!((measured - order).abs() < 0.05, "order {measured} at {courant}: {errors:?}");
        }
    }
}

/// At the critical step and a gap of a whole number of steps the end of the bar lands exactly on the
/// plane, and the wave arrives everywhere exactly at an instant: everything hangs on rounding.
#[test]
fn a_gap_of_whole_steps_at_the_critical_step() {
    for fraction in [1.0, 2.0, 5.0] {
        let bar = bar(20, 1.0, fraction);
        for &reconstruction in Reconstruction::ALL {
            for &acceleration in Acceleration::of(reconstruction) {
                let what = format!("{fraction}, {reconstruction}, {acceleration}");
                let all =
                    estimate(&bar, Options { reconstruction, acceleration: Some(acceleration), ..Options::default() });
                let e = &all.error;
                let measures = e.entries().map(|(_, x)| x);
                assert!(measures.iter().chain(&all.by_element).all(|x| x.is_finite()), "{what}: {e:?}");
                assert!(e.sup > 0.0 && e.relative_sup < 1.0, "{what}: {e:?}");
                assert!(all.impulse_ratio.is_some_and(f64::is_finite), "{what}");
            }
        }
        let (_, exact) = effectivity(&bar);
        assert!(exact.sup.is_finite() && exact.mean > 0.0, "{exact:?}");
    }
}

/// The residuals are finite and of the size of rounding, also in a flight without any force.
#[test]
fn residuals_before_contact() {
    for fraction in [2.3, 5.0] {
        let residuals = estimate(&bar(20, 0.9, fraction), Options::default()).residuals;
        // Far above the rounding of admissible fields, some 1e-13.
        assert!(residuals.largest() <= 1e-10, "{fraction}: {residuals:?}");
    }
}
