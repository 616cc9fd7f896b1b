//! Numbers of one estimate that must agree with each other.

use crate::properties::bodies::{aluminium, gravity, plane_below, steps, swinging, thrown};
use crate::properties::estimating::{all_choices, estimate, history};
use percute_core::dynamics::critical_time_step;
use percute_core::mesh::Mesh;
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_estimator::{Estimate, Options, Reconstruction, Sampling};
use percute_testkit::random_rectangle;

/// Problems with friction, gravity and steps that change.
fn runs() -> Vec<(Problem<2>, TimeGrid)> {
    let block = |seed| random_rectangle(0.05, 0.04, 5, seed).unwrap();
    let plane = |mesh: &Mesh, tilt| plane_below(mesh, tilt, 6e-4, 0.3, None);
    let fast = thrown(block(1), [400.0, -400.0], plane(&block(1), 0.0)).build().unwrap();
    let tilted = thrown(block(2), [0.0, -300.0], plane(&block(2), 0.1)).build().unwrap();
    let falling = thrown(block(3), [10.0, -300.0], plane(&block(3), 0.01)).body_force(gravity([0.0, -1e7]));
    let falling = falling.build().unwrap();
    let times = [steps(&fast, 0.9, 40), swinging(&tilted, 61, 3.0), steps(&falling, 0.5, 121)];
    [fast, tilted, falling].into_iter().zip(times).collect()
}

fn estimates() -> Vec<(Options, Estimate)> {
    let mut all = Vec::new();
    for (problem, times) in runs() {
        let history = history(&problem, &times);
        for options in all_choices() {
            all.extend([1, 4].map(|every| {
                let options = Options { every: Sampling::Every(every), ..options };
                (options, estimate(&problem, &history, options))
            }));
        }
    }
    all
}

/// Both are the same trapezoidal sum in another order, [20], [21].
#[test]
fn elements_add_up_to_the_mean() {
    for (options, estimate) in estimates() {
        let sum: f64 = estimate.by_element.iter().map(|e| e * e).sum();
        let square = estimate.error.mean * estimate.error.mean;
        assert!((sum - square).abs() <= 1e-12 * square, "{options:?}: {sum} against {square}");
    }
}

#[test]
fn the_sup_is_the_largest_sample() {
    for (options, estimate) in estimates() {
        let square = estimate.error.sup * estimate.error.sup;
        // A square root and its square.
        assert!((estimate.parts.total() - square).abs() <= 1e-15 * square, "{options:?}");
        let mut at_sup = estimate.over_time.iter().filter(|s| s.time == estimate.time_of_sup);
        assert!(at_sup.any(|s| s.parts == estimate.parts), "{options:?}");
        assert!(estimate.over_time.iter().all(|s| s.parts.total() <= estimate.parts.total()), "{options:?}");
        assert!(estimate.error.mean <= estimate.error.sup, "{options:?}");
    }
}

/// η and its parts are energies. The contact part is an integral of what is nowhere negative: it grows, but for
/// `corrected`, where the energies of forces off contact come and go.
#[test]
fn parts_are_not_negative_and_times_increase() {
    for (options, estimate) in estimates() {
        for sample in &estimate.over_time {
            let parts = sample.parts;
            assert!(parts.kinetic >= 0.0 && parts.elastic >= 0.0 && sample.reference >= 0.0, "{options:?}: {sample:?}");
            // Rounding, as below.
            assert!(parts.contact >= -1e-14 * estimate.parts.total(), "{options:?}: {sample:?}");
        }
        let first = estimate.over_time[0];
        assert_eq!((first.time, first.parts.contact), (0.0, 0.0));
        for pair in estimate.over_time.windows(2) {
            assert!(pair[0].time <= pair[1].time, "{options:?}");
            // Rounding of power sums of which the largest is that of the whole run.
            let rounding = 1e-14 * estimate.parts.total();
            let grows = pair[0].parts.contact <= pair[1].parts.contact + rounding;
            assert!(grows || options.reconstruction == Reconstruction::Corrected, "{options:?}: {pair:?}");
        }
        assert_eq!(estimate.over_time[estimate.over_time.len() - 1].time, estimate.end);
    }
}

/// The block of the paper's Table 1, with the gap and steps of the method's §8.
fn table_block(nx: usize, ny: usize, count: usize) -> (Problem<2>, TimeGrid) {
    let mesh = Mesh::rectangle(0.05, 0.04, nx, ny).unwrap();
    let free = Problem::<2>::builder(mesh.clone()).material(aluminium()).build().unwrap();
    let step = 0.9 * critical_time_step(&free);
    let plane = plane_below(&mesh, 0.0, 1.3 * step * 400.0, 0.2, Some("bottom"));
    let problem = thrown(mesh, [400.0, -400.0], plane).build().unwrap();
    (problem, TimeGrid::uniform(count as f64 * step, count).unwrap())
}

/// What `consistent` is for: it keeps more of the contact impulse, and its error is smaller.
#[test]
fn consistent_is_sharper_on_the_flat_block() {
    for (nx, ny, count) in [(5, 4, 11), (10, 8, 21), (20, 16, 42)] {
        let (problem, times) = table_block(nx, ny, count);
        let history = history(&problem, &times);
        let made = |reconstruction| estimate(&problem, &history, Options { reconstruction, ..Options::default() });
        let (consistent, published) = (made(Reconstruction::Consistent), made(Reconstruction::Published));
        assert!(
            consistent.error.sup <= published.error.sup && consistent.error.mean <= published.error.mean,
            "{nx} × {ny}"
        );
        let kept = [&consistent, &published].map(|e| e.impulse_ratio.unwrap());
        assert!(kept[1] <= kept[0], "{nx} × {ny}: {kept:?}");
        // Above 1 by what the cone cuts off: the pulling densities of B⁻¹R, some 10 % of the largest.
        assert!(kept.iter().all(|k| *k > 0.0 && *k <= 1.1), "{nx} × {ny}: {kept:?}");
    }
}

/// Nothing happens to a body in flight: no strain, no acceleration, not even rounding, for all nodes
/// have the same displacement to the last bit.
#[test]
fn a_translation_has_no_error() {
    let mesh = random_rectangle(0.05, 0.04, 6, 4).unwrap();
    let problem = Problem::<2>::builder(mesh).material(aluminium()).initial_velocity(Initial::Uniform([123.4, -56.7]));
    let problem = problem.build().unwrap();
    let history = history(&problem, &steps(&problem, 0.9, 50));
    for options in all_choices() {
        let estimate = estimate(&problem, &history, options);
        assert_eq!((estimate.error.sup, estimate.error.mean), (0.0, 0.0), "{options:?}");
        assert!(estimate.error.reference_sup > 0.0 && estimate.impulse_ratio.is_none());
    }
}

/// In a fall the nodes' accelerations differ in their last bit, so that displacements of size u do:
/// strains of ε u/h stay, with h the size of the elements and ε = 2⁻⁵², and cost √(E V) ε u/h; 1.4 times
/// that was measured.
#[test]
fn a_fall_has_no_error_but_rounding() {
    for (seed, tall) in [(4, 1.0), (5, 1e3)] {
        let mesh = random_rectangle(0.05 * tall, 0.04 * tall, 6, seed).unwrap();
        let problem = Problem::<2>::builder(mesh)
            .material(aluminium())
            .initial_velocity(Initial::Uniform([30.0, -50.0]))
            .body_force(gravity([0.0, -1e6]))
            .build()
            .unwrap();
        let times = steps(&problem, 0.9, 50);
        let history = history(&problem, &times);
        let way = history.step(50).unwrap().displacement.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
        let rounding = (70e9 * 0.05 * 0.04 * tall * tall).sqrt() * f64::EPSILON * way / (0.04 * tall / 6.0);
        for options in all_choices() {
            let estimate = estimate(&problem, &history, options);
            assert!(estimate.error.sup <= 10.0 * rounding, "{options:?}: {:e}, {rounding:e}", estimate.error.sup);
            assert!(estimate.error.relative_sup < 1e-11, "{options:?}");
        }
    }
}
