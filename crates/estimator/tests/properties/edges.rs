//! Edge cases: defined, and admissible like all others.

use crate::common::beside::run;
use crate::properties::bodies::{gravity, plane_below, steps, swinging, thrown};
use crate::properties::estimating::{all_choices, assert_admissible, check, estimate, history};
use percute_core::contact::Obstacle;
use percute_core::history::History;
use percute_core::load::{Support, Table};
use percute_core::mesh::Mesh;
use percute_core::observer::Progress;
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_estimator::{Estimate, Options, Reconstruction, Request};
use percute_testkit::{random_rectangle, rotated};
use std::ops::ControlFlow;

fn block() -> Mesh {
    random_rectangle(0.05, 0.04, 5, 1).unwrap()
}

/// A block that strikes the plane after two to three steps.
fn impact() -> Problem<2> {
    let plane = plane_below(&block(), 0.0, 6e-4, 0.2, None);
    thrown(block(), [100.0, -300.0], plane).build().unwrap()
}

/// A block that falls on its corner: that node touches alone. `consistent` and `published` drop its force, for no edge
/// touches; `corrected` concentrates it at the node and pays for the edges beside it, which are off the plane.
#[test]
fn a_node_that_touches_alone() {
    let mesh = rotated(&Mesh::rectangle(0.04, 0.04, 5, 5).unwrap(), std::f64::consts::FRAC_PI_4).unwrap();
    let plane = plane_below(&mesh, 0.0, 6e-4, 0.2, None);
    let problem = thrown(mesh, [0.0, -300.0], plane).build().unwrap();
    let times = steps(&problem, 0.9, 12);
    assert!(check("corner", &problem, &times) > 3);
    let history = history(&problem, &times);
    let most = (0..history.len()).map(|n| history.step(n).unwrap().touching.iter().filter(|t| **t).count()).max();
    assert_eq!(most, Some(1));
    for options in all_choices() {
        let estimate = estimate(&problem, &history, options);
        if options.reconstruction == Reconstruction::Corrected {
            // The node alone has a force of its own, which falls behind that of the simulation while contact is open.
            let kept = estimate.impulse_ratio.unwrap();
            assert!(kept > 0.5 && kept <= 1.0 + 1e-13 && estimate.parts.contact > 0.0, "{kept}");
            continue;
        }
        assert_eq!((estimate.impulse_ratio, estimate.parts.contact), (Some(0.0), 0.0));
        // All of the impulse is missing: an error of the order of the energies.
        assert!(estimate.error.relative_mean > 0.1);
    }
}

/// A block at rest on the plane under its weight touches from t_0 on.
#[test]
fn touching_from_the_start() {
    for friction in [0.0, 0.3] {
        for slope in [0.0, 0.05] {
            let plane = plane_below(&rotated(&block(), slope).unwrap(), slope, 0.0, friction, Some("bottom"));
            let builder = thrown(rotated(&block(), slope).unwrap(), [0.0, 0.0], plane);
            let problem = builder.body_force(gravity([0.0, -1e5])).build().unwrap();
            let times = steps(&problem, 0.8, 60);
            assert!(check(&format!("slope {slope}"), &problem, &times) > 60);
            let history = history(&problem, &times);
            assert!(history.step(0).unwrap().touching.iter().all(|t| *t), "slope {slope}");
        }
    }
}

/// A single step, in which nothing, or the arrival, happens; and one from rest on the plane.
#[test]
fn a_single_step() {
    let problem = impact();
    let step = steps(&problem, 0.9, 1);
    check("one step of flight", &problem, &step);
    let plane = plane_below(&block(), 0.0, 0.8 * 300.0 * step.end(), 0.2, None);
    let arriving = thrown(block(), [100.0, -300.0], plane).build().unwrap();
    check("one step to the plane", &arriving, &step);
    assert!(history(&arriving, &step).step(1).unwrap().touching.contains(&true));
    for options in all_choices() {
        let estimate = estimate(&arriving, &history(&arriving, &step), options);
        let times: Vec<_> = estimate.over_time.iter().map(|s| s.time).collect();
        assert_eq!(times, [0.0, 0.5 * step.end(), step.end()]);
    }
}

#[test]
fn a_single_element() {
    let mesh = Mesh::uniform_bar(0.1, 1).unwrap();
    let problem = Problem::<1>::builder(mesh)
        .material(percute_core::material::Elastic::bar(70e9, 2700.0, 1.0).unwrap())
        .initial_velocity(Initial::Uniform([-10.0]))
        .obstacle(Obstacle::plane([-2e-4], [1.0], 0.0, None).unwrap())
        .build()
        .unwrap();
    assert!(check("bar of one element", &problem, &steps(&problem, 0.7, 30)) > 0);
}

/// The first `count` instants of a history over another grid.
fn beginning(history: &History, times: &TimeGrid, count: usize) -> History {
    let mut part = History::new(times);
    (0..count).for_each(|n| part.push(&history.step(n).unwrap()).unwrap());
    part
}

/// Steps that sum up alike whether there are many or few of them.
fn grids(long: &TimeGrid, count: usize) -> [TimeGrid; 2] {
    let lengths: Vec<_> = (0..long.step_count()).map(|n| long.step(n)).collect();
    [&lengths[..], &lengths[..count]].map(|steps| TimeGrid::from_steps(steps).unwrap())
}

/// An estimate that ends early, in flight, in contact and after it, is that of the shorter history, to
/// the last bit; what was to come does not show.
#[test]
fn an_early_end() {
    let problem = impact();
    for long in [steps(&problem, 0.9, 40), swinging(&problem, 40, 2.0)] {
        for count in [1, 2, 3, 5, 11, 30] {
            let [long, short] = grids(&long, count);
            let complete = history(&problem, &long);
            for options in all_choices() {
                let early = estimate(&problem, &beginning(&complete, &long, count + 1), options);
                let shorter = estimate(&problem, &beginning(&complete, &short, count + 1), options);
                assert_eq!(early, shorter, "{count} steps, {options:?}");
                assert_admissible(&format!("{count} steps"), &early);
            }
        }
    }
}

/// Where a support is driven, a_n of its nodes looks ahead to v_d(t_{n+1}), which the last instant of a
/// shorter grid does not have: the last step may differ, what was before may not.
#[test]
fn an_early_end_of_a_driven_body() {
    let velocity = Table::new(vec![0.0, 6e-6, 2e-5], vec![[0.0, 0.0], [0.0, -50.0], [0.0, 90.0]]).unwrap();
    let top = Support { group: "top".to_string(), components: [false, true, false], velocity: Some(velocity) };
    let plane = plane_below(&block(), 0.0, 1e-5, 0.2, None);
    let problem = thrown(block(), [0.0, 0.0], plane).support(top).build().unwrap();
    let long = steps(&problem, 0.9, 40);
    for count in [5, 11, 30] {
        let [long, short] = grids(&long, count);
        let complete = history(&problem, &long);
        for options in all_choices() {
            let early = estimate(&problem, &beginning(&complete, &long, count + 1), options);
            let shorter = estimate(&problem, &beginning(&complete, &short, count + 1), options);
            assert_admissible(&format!("{count} steps"), &early);
            let before = |e: &Estimate| {
                let start = long.instants()[count - 1];
                e.over_time.iter().filter(|s| s.time < start).copied().collect::<Vec<_>>()
            };
            assert!(before(&early).len() >= 2 * (count - 1));
            assert_eq!(before(&early), before(&shorter), "{count} steps, {options:?}");
        }
    }
}

/// The same with an observer that stops the run.
#[test]
fn a_run_that_is_stopped() {
    let problem = impact();
    let times = steps(&problem, 0.9, 40);
    let mut stop = |p: Progress| if p.done >= 17 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let (simulation, stopped) = run(&problem, &times, Options::default(), &Request::default(), &mut stop);
    assert!(simulation.interrupted);
    assert_eq!((stopped.steps, stopped.end), (17, times.instants()[17]));
    let complete = history(&problem, &times);
    assert_eq!(stopped, estimate(&problem, &beginning(&complete, &times, 18), Options::default()));
}
