//! Nodes at two planes.

use crate::common::corner::{Corner, open_corner};
use crate::properties::bodies::{steps, swinging};
use crate::properties::estimating::{all_choices, check, estimate, estimate_with_maps, history};
use percute_core::contact::Obstacle;
use percute_core::material::Elastic;
use percute_core::problem::{Initial, Problem};
use percute_estimator::{Options, Request, Sampling};

const CELLS: [usize; 2] = [6, 5];

/// Residuals of all equations, with parts that slide and stick, at equal and swinging steps.
#[test]
fn the_fields_are_admissible() {
    for (opening, velocity, friction) in [
        (90.0, [-150.0, -60.0], [0.2, 0.2]),
        (60.0, [-100.0, -100.0], [0.1, 0.4]),
        (120.0, [-100.0, -40.0], [0.2, 0.2]),
        (150.0, [-40.0, -120.0], [0.1, 0.3]),
        (30.0, [-150.0, -30.0], [0.15, 0.15]),
    ] {
        let problem = Corner::of(opening, velocity, friction, CELLS).problem();
        assert!(check(&format!("{opening}°"), &problem, &steps(&problem, 0.9, 90)) > 20);
        assert!(check(&format!("{opening}°, swinging"), &problem, &swinging(&problem, 90, 3.0)) > 20);
    }
}

/// A rectangle in an obtuse corner, turned, at low speed: its corner node alone touches, and has forces of its own at
/// both planes.
#[test]
fn a_corner_alone_is_admissible() {
    for (tilt, speed) in [(0.0_f64, 40.0), (0.26, 40.0), (0.26, 4.0)] {
        let problem = open_corner(tilt, speed, CELLS);
        assert!(check(&format!("tilt {tilt}, {speed} m/s"), &problem, &steps(&problem, 0.9, 90)) > 20);
    }
}

/// A node that reaches both planes at once and sticks to one of them has a velocity of rounding alone, in any
/// direction.
#[test]
fn a_node_at_rest_is_admissible() {
    for (opening, velocity, friction) in [(120.0, [-140.0, -50.0], [0.0, 0.4]), (105.0, [-160.0, -50.0], [0.1, 0.4])] {
        let problem = Corner::of(opening, velocity, friction, [10, 8]).at_distance(2e-4);
        assert!(check(&format!("{opening}°, at rest"), &problem, &steps(&problem, 0.9, 90)) > 20);
    }
}

/// A second plane that is never reached changes rounding only: the friction beside its corner is summed apart.
#[test]
fn a_far_wall_changes_nothing() {
    // Flat on the floor, and tilted by little.
    for turn in [0.0, 0.02] {
        let corner = Corner::of(90.0, [-30.0, -200.0], [0.2, 0.3], CELLS);
        let far = corner.at_distance(1.0);
        let normal = [f64::sin(turn), f64::cos(turn)];
        let floor = || Obstacle::plane([0.0, -2e-4], normal, 0.2, Some("bottom".to_string())).unwrap();
        let builder = || {
            Problem::<2>::builder(far.mesh().clone())
                .material(Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap())
                .initial_velocity(Initial::Uniform([-30.0, -200.0]))
                .obstacle(floor())
        };
        let wall = Obstacle::plane([-1.0, 0.0], [normal[1], -normal[0]], 0.2, Some("left".to_string())).unwrap();
        let (with, without) = (builder().obstacle(wall).build().unwrap(), builder().build().unwrap());
        let times = steps(&with, 0.9, 60);
        let histories = [history(&with, &times), history(&without, &times)];
        for options in all_choices() {
            let [a, b] = [estimate(&with, &histories[0], options), estimate(&without, &histories[1], options)];
            for (a, b) in [(a.error.sup, b.error.sup), (a.error.mean, b.error.mean)] {
                assert!((a - b).abs() <= 1e-14 * b, "{options:?}: {a} {b}");
            }
        }
    }
}

/// The order of the planes and a turn of all change rounding only. Widths of hats jump, so that rounding may show.
#[test]
fn order_and_turning_change_nothing() {
    for (opening, friction) in [(60.0, [0.2, 0.2]), (90.0, [0.4, 0.1]), (120.0, [0.1, 0.4])] {
        let corner = Corner::of(opening, [-150.0, -60.0], friction, CELLS);
        let problems = [corner, Corner { wall_first: true, ..corner }, Corner { turn: 0.57, ..corner }];
        let problems = problems.map(|corner| corner.problem());
        let times = steps(&problems[0], 0.9, 80);
        for options in all_choices() {
            let errors = problems.each_ref().map(|problem| estimate(problem, &history(problem, &times), options).error);
            for (k, error) in errors.iter().enumerate() {
                for (a, b) in [(error.sup, errors[0].sup), (error.mean, errors[0].mean)] {
                    assert!((a - b).abs() <= 1e-8 * b, "{opening}°, {k}, {options:?}: {a} {b}");
                }
            }
        }
    }
}

/// The same bits on one and on two threads, and sums of the map that agree with the error.
#[test]
fn threads_and_maps_agree() {
    let problem = open_corner(0.26, 40.0, CELLS);
    let times = steps(&problem, 0.9, 90);
    let history = history(&problem, &times);
    for every in [1, 3] {
        let of = |threads: usize| {
            let options = Options { threads: Some(threads), every: Sampling::Every(every), ..Options::default() };
            estimate_with_maps(&problem, &history, options, &Request { steps: vec![90], ..Request::default() })
        };
        let (one, two) = (of(1), of(2));
        assert_eq!(one.error.sup.to_bits(), two.error.sup.to_bits());
        assert_eq!(one.over_time, two.over_time);
    }
}
