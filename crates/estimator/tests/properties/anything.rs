//! Admissible fields for problems drawn at random.

use crate::properties::bodies::{aluminium, fixed, gravity, plane_below, steps, swinging};
use crate::properties::estimating::check;
use percute_core::load::{Profile, Table, Traction};
use percute_core::mesh::Mesh;
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_testkit::Random;
use percute_testkit::strategy::{angle, rectangle};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Few cases of at most 50 elements, the same ones in every run.
fn few() -> ProptestConfig {
    ProptestConfig { cases: 24, failure_persistence: None, rng_seed: RngSeed::Fixed(8), ..ProptestConfig::default() }
}

/// A body over a plane with whatever `seed` adds: gravity that brings it back, a side held or pulled,
/// velocities without rule, steps that change.
fn problem(mesh: Mesh, tilt: f64, friction: f64, seed: u64) -> (Problem<2>, TimeGrid) {
    let mut random = Random::new(seed);
    let free = Problem::<2>::builder(mesh.clone()).material(aluminium()).build().unwrap();
    let courant = random.between(0.05, 0.95);
    let step = steps(&free, courant, 1).end();
    let speed = 10.0_f64.powf(random.between(-3.0, 2.5));
    let mut one_in = |n: u64| random.bits().is_multiple_of(n);
    let (falls, is_held, is_pulled, is_wild, swings) = (one_in(2), one_in(4), one_in(3), one_in(3), one_in(3));
    // Two to four steps of the flight away.
    let gap = random.between(2.0, 4.0) * speed * step;
    let down = [tilt.sin(), -tilt.cos()];
    let wild = if is_wild { 0.3 } else { 0.0 };
    let velocity = mesh.points_in::<2>().iter().map(|_| {
        let mut any = || random.between(-speed, speed);
        if is_held { [0.0; 2] } else { [speed * down[0] + wild * any(), speed * down[1] + wild * any()] }
    });
    let velocity = Initial::Nodal(velocity.collect());
    let mut builder = Problem::<2>::builder(mesh.clone())
        .material(aluminium())
        .initial_velocity(velocity)
        .obstacle(plane_below(&mesh, tilt, gap, friction, None));
    if falls {
        // Back within some ten to a hundred steps.
        let g = speed / (random.between(5.0, 50.0) * step);
        builder = builder.body_force(gravity(down.map(|x| g * x)));
    }
    if is_held {
        let side = ["left", "right", "top", "bottom"].into_iter().nth(random.bits() as usize % 4).unwrap();
        builder = builder.support(fixed(side, [true, true]));
    }
    if is_pulled && !is_held {
        let stress = 1e7 * speed;
        let value = Table::new(vec![0.0, 20.0 * step], vec![[stress, -stress], [-stress, 0.0]]).unwrap();
        let profile = Profile { value: 0.3, gradient: [1.0, -0.5, 0.0] };
        builder = builder.traction(Traction { group: "right".to_string(), value, profile });
    }
    let problem = builder.build().unwrap();
    let times = if swings { swinging(&problem, 90, 4.0) } else { steps(&problem, courant, 90) };
    (problem, times)
}

proptest! {
    #![proptest_config(few())]

    #[test]
    fn fields_are_admissible(
        mesh in rectangle(5), tilt in angle(), friction in 0.0..1.0_f64, seed in 0..1_000_000_u64,
    ) {
        let (problem, times) = problem(mesh, tilt, friction, seed);
        check(&format!("seed {seed}"), &problem, &times);
    }
}
