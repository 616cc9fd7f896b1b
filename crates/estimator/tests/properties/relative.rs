//! Motions that are no deformation change no relative error.

use crate::properties::bodies::{aluminium, plane_below, thrown};
use crate::properties::estimating::{all_choices, estimate, history};
use percute_core::contact::Obstacle;
use percute_core::dynamics::critical_time_step;
use percute_core::mesh::{ElementGroups, FaceGroups, Mesh};
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_estimator::{ErrorMeasures, Options, Sampling};
use percute_testkit::random_rectangle;

/// Some 20 m/s of a relative rounding of 1e-16 per operation, over hundreds of steps.
const ROUNDING: f64 = 1e-8;
/// The contact part of `corrected` itself depends on the time before the touch, like one over its steps: the mean falls
/// by 0.5 % from 5 steps of flight to 45, and by another 0.06 % to 100.
const OF_FLIGHT: f64 = 0.01;

fn block() -> Mesh {
    random_rectangle(0.05, 0.04, 6, 4).unwrap()
}

/// The measures of a problem that flies for some whole steps and 2.4 of them, and goes on for 60.
fn measures(build: impl Fn(f64) -> Problem<2>, speed: f64, flight: usize, options: Options) -> ErrorMeasures {
    let dt = 0.85 * critical_time_step(&build(1.0));
    let problem = build((flight as f64 + 2.4) * speed * dt);
    let steps = flight + 60;
    let times = TimeGrid::uniform(dt * steps as f64, steps).unwrap();
    estimate(&problem, &history(&problem, &times), options).error
}

fn relative(e: &ErrorMeasures) -> [f64; 6] {
    let [stress, velocity] =
        [[e.relative_stress_sup, e.relative_stress_mean], [e.relative_velocity_sup, e.relative_velocity_mean]];
    [e.relative_sup, e.relative_mean, stress[0], stress[1], velocity[0], velocity[1]]
}

fn assert_same(what: &str, tolerance: f64, one: &ErrorMeasures, other: &ErrorMeasures) {
    for (a, b) in relative(one).into_iter().zip(relative(other)) {
        assert!(a > 1e-3 && (a - b).abs() <= tolerance * a, "{what}: {one:?}, {other:?}");
    }
}

/// A smooth plane, a common velocity along it, and forty more steps of flight: the published relative errors fall, the
/// others stay.
#[test]
fn a_common_velocity_and_a_longer_flight_change_no_relative_error() {
    let at = |along: f64| {
        move |gap: f64| {
            let mesh = block();
            let plane = plane_below(&mesh, 0.0, gap, 0.0, None);
            thrown(mesh, [along, -20.0], plane).build().unwrap()
        }
    };
    for options in all_choices() {
        let what = format!("{options:?}");
        let plain = measures(at(0.0), 20.0, 5, options);
        let moving = measures(at(300.0), 20.0, 5, options);
        assert_same(&what, ROUNDING, &plain, &moving);
        assert!(moving.published_relative_mean < 0.5 * plain.published_relative_mean, "{what}: {moving:?}");
        let late = measures(at(0.0), 20.0, 45, options);
        assert_same(&what, OF_FLIGHT, &plain, &late);
        assert!(late.mean < 0.9 * plain.mean && late.mean_from_touch > 0.99 * plain.mean_from_touch, "{what}");
    }
}

/// A second body that flies by, with a thousand times the energy.
#[test]
fn a_body_that_flies_by_changes_no_relative_error() {
    let beside = |with: bool| {
        move |gap: f64| {
            let (mesh, far) = (block(), block());
            let plane = plane_below(&mesh, 0.0, gap, 0.0, Some("bottom"));
            if !with {
                return thrown(mesh, [0.0, -20.0], plane).build().unwrap();
            }
            let points = far.points_in::<2>().iter().map(|[x, y]| [x + 1.0, y + 1.0]).collect();
            let cells: Vec<_> = far.nodes_of::<3>().iter().map(|cell| cell.map(|node| node.index())).collect();
            let far = Mesh::new(points, &cells, &FaceGroups::new(), &ElementGroups::new()).unwrap();
            let joined = Mesh::joined(&[("near", &mesh), ("far", &far)]).unwrap();
            let velocity =
                joined.points_in::<2>().iter().map(|[x, _]| if *x > 0.5 { [600.0, 50.0] } else { [0.0, -20.0] });
            let plane =
                Obstacle::plane(*plane.as_plane().unwrap().point(), [0.0, 1.0], 0.0, Some("near.bottom".into()));
            Problem::<2>::builder(joined.clone())
                .material(aluminium())
                .initial_velocity(Initial::Nodal(velocity.collect()))
                .obstacle(plane.unwrap())
                .build()
                .unwrap()
        }
    };
    let options = Options { every: Sampling::Every(1), threads: Some(1), ..Options::default() };
    let [alone, both] = [false, true].map(|with| measures(beside(with), 20.0, 0, options));
    assert_same("beside another body", ROUNDING, &alone, &both);
    assert!((alone.energy - both.energy).abs() <= ROUNDING * alone.energy, "{alone:?}, {both:?}");
}
