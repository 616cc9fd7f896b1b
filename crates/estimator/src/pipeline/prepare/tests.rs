//! Residuals of the sequential part rise when its fields are changed.

use super::*;
use crate::options::ContactForce;
use crate::pipeline::fixture::{SHOWS, driven, impact, prepared};
use percute_core::problem::Initial;

/// u_CA and u̇_CA that start elsewhere.
#[test]
fn wrong_initial_conditions_show() {
    let (problem, times) = driven();
    let mesh = problem.mesh().clone();
    let law = problem.materials()[0];
    let builder = || Problem::builder(mesh.clone()).material(law);
    let velocity = |v: f64| Initial::Nodal(problem.initial_velocity().iter().map(|x| [x[0], v * x[1]]).collect());
    let faster = builder().initial_velocity(velocity(1.01)).build().unwrap();
    let moved = builder().initial_velocity(velocity(1.0)).initial_displacement(Initial::Uniform([1e-5, 0.0]));
    let moved = moved.build().unwrap();
    let step = percute_core::history::Step {
        index: 0,
        time: 0.0,
        displacement: problem.initial_displacement(),
        reaction: &[],
        touching: &[],
        velocity: None,
        acceleration: None,
    };
    for (other, shows) in [(&problem, false), (&faster, true), (&moved, true)] {
        let mut preparation = Preparation::new(&problem, &times, &Options::default());
        preparation.motion = FreeMotion::new(other);
        preparation.push(&step);
        let found = preparation.residuals;
        assert_eq!(found.initial_conditions > SHOWS, shows, "{found:?}");
        assert_eq!(Residuals { initial_conditions: 0.0, ..found }, Residuals::default());
    }
}

/// A support whose exact displacement is 1 % longer than that of u_CA.
#[test]
fn a_missed_support_shows() {
    let (problem, times) = driven();
    let mut preparation = prepared(&problem, &times, ContactForce::Sharp);
    assert!(preparation.residuals.largest() < 1e-13);
    let last = times.step_count();
    let Some(level) = preparation.levels.back() else { panic!("no levels") };
    let mut knot = level.knot.clone();
    for p in problem.prescribed() {
        knot.displacement[p.node.index()][p.component] *= 1.01;
    }
    // The last step once more: its way is taken off first.
    for (k, p) in problem.prescribed().iter().enumerate() {
        let velocity = |m: usize| problem.prescribed_velocity(p, times.instants()[m]);
        preparation.supports.exact[k] -= 0.5 * times.step(last - 1) * (velocity(last - 1) + velocity(last));
    }
    let miss = preparation.supports.advance(&problem, &times, last, &knot);
    let found = Residuals { supports: worse(preparation.residuals.supports, miss), ..preparation.residuals };
    assert!(found.supports > SHOWS, "{found:?}");
    assert!(Residuals { supports: 0.0, ..found }.largest() < 1e-13, "{found:?}");
}

/// Densities that leave the cone between reading and check.
#[test]
fn both_readings_are_checked_at_every_step() {
    let (problem, times) = impact();
    for reading in [ContactForce::Sharp, ContactForce::Paper] {
        let preparation = prepared(&problem, &times, reading);
        assert!(preparation.residuals.largest() < 1e-13);
        assert!(preparation.impulse.kept > 0.0);
    }
}
