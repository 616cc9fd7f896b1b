//! What must not depend on axes, mirrors or numbers, on meshes drawn at random.

use crate::solution::run::{Run, aluminium, fixed, run};
use percute_core::contact::Obstacle;
use percute_core::dynamics::critical_time_step;
use percute_core::load::{Profile, Table, Traction};
use percute_core::mesh::Mesh;
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_testkit::strategy::{angle, rectangle};
use percute_testkit::{mirrored, renumbered, rotated, translated};
use proptest::prelude::*;

/// Few steps of few elements each: the whole file stays below two seconds.
fn few() -> ProptestConfig {
    ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() }
}

/// A block, the plane 2.4 steps of the flight away, and the steps.
struct Throw {
    velocity: [f64; 2],
    friction: f64,
    gap: f64,
    times: TimeGrid,
}

impl Throw {
    fn new(mesh: &Mesh, along: f64, speed: f64, friction: f64) -> Self {
        let free = Problem::<2>::builder(mesh.clone()).material(aluminium()).build().unwrap();
        let step = 0.85 * critical_time_step(&free);
        let times = TimeGrid::uniform(60.0 * step, 60).unwrap();
        Self { velocity: [along, -speed], friction, gap: 2.4 * speed * step, times }
    }

    /// The block above the rough plane and pulled on top, after `map` has moved all vectors and
    /// the plane's point; the bottom may touch.
    fn problem(&self, mesh: Mesh, map: impl Fn([f64; 2]) -> [f64; 2]) -> Problem<2> {
        let end = self.times.end();
        let pull = Table::new(vec![0.0, end], vec![map([2e8, 3e8]), map([-2e8, 1e8])]).unwrap();
        let bottom = Some("bottom".to_string());
        Problem::<2>::builder(mesh)
            .material(aluminium())
            .initial_velocity(Initial::Uniform(map(self.velocity)))
            .obstacle(Obstacle::plane(map([0.0, -self.gap]), map([0.0, 1.0]), self.friction, bottom).unwrap())
            .traction(Traction { group: "top".to_string(), value: pull, profile: Profile::UNIFORM })
            .build()
            .unwrap()
    }
}

fn reactions(run: &Run<'_, 2>) -> usize {
    (0..=run.last()).map(|n| run.history.step(n).unwrap().reaction().iter().filter(|r| **r != [0.0; 2]).count()).sum()
}

/// Compares two runs at all steps: `map` of the first against the second, whose node of number i is
/// `number[i]`. 1e-9 of the largest displacement: rounding that 60 steps carry on, with some to spare.
fn same(
    first: &Run<'_, 2>,
    second: &Run<'_, 2>,
    map: impl Fn([f64; 2]) -> [f64; 2],
    number: impl Fn(usize) -> usize,
) -> Result<(), TestCaseError> {
    for n in 0..=first.last() {
        let scale = first.displacement(n).iter().flatten().fold(0.0_f64, |m, u| m.max(u.abs()));
        for (i, u) in first.displacement(n).iter().enumerate() {
            let (expected, found) = (map(*u), second.displacement(n)[number(i)]);
            let gap = (expected[0] - found[0]).hypot(expected[1] - found[1]);
            prop_assert!(gap <= 1e-9 * scale, "step {}, node {}: {:?} against {:?}", n, i, expected, found);
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(few())]

    #[test]
    fn turning_everything_turns_the_solution(
        mesh in rectangle(5), turn in angle(), speed in 50.0..300.0_f64, friction in 0.0..0.6_f64,
    ) {
        let (sin, cos) = turn.sin_cos();
        let map = |v: [f64; 2]| [cos * v[0] - sin * v[1], sin * v[0] + cos * v[1]];
        let throw = Throw::new(&mesh, 70.0, speed, friction);
        let image = throw.problem(rotated(&mesh, turn).unwrap(), map);
        let problem = throw.problem(mesh, |v| v);
        let (straight, turned) = (run(&problem, &throw.times), run(&image, &throw.times));
        prop_assert!(reactions(&straight) > 0);
        same(&straight, &turned, map, |i| i)?;
    }

    #[test]
    fn a_mirror_shows_the_mirror_image(
        mesh in rectangle(5), along in -200.0..200.0_f64, speed in 50.0..300.0_f64, friction in 0.0..0.6_f64,
    ) {
        let map = |v: [f64; 2]| [-v[0], v[1]];
        let throw = Throw::new(&mesh, along, speed, friction);
        let image = throw.problem(mirrored(&mesh).unwrap(), map);
        let problem = throw.problem(mesh, |v| v);
        let (straight, seen) = (run(&problem, &throw.times), run(&image, &throw.times));
        prop_assert!(reactions(&straight) > 0);
        same(&straight, &seen, map, |i| i)?;
    }

    #[test]
    fn numbers_do_not_matter(
        mesh in rectangle(5), seed in 0..1000_u64, speed in 50.0..300.0_f64, friction in 0.0..0.6_f64,
    ) {
        let (image, new) = renumbered(&mesh, seed).unwrap();
        let throw = Throw::new(&mesh, 70.0, speed, friction);
        let (problem, image) = (throw.problem(mesh, |v| v), throw.problem(image, |v| v));
        let (straight, shuffled) = (run(&problem, &throw.times), run(&image, &throw.times));
        prop_assert!(reactions(&straight) > 0);
        same(&straight, &shuffled, |v| v, |i| new.node[i])?;
    }

    /// Displacements, velocities and the plane's distance scaled by s scale the solution by s: the
    /// problem is positively homogeneous.
    #[test]
    fn the_law_is_homogeneous(mesh in rectangle(5), scale in 0.1..10.0, friction in 0.0..0.6_f64) {
        let throw = Throw::new(&mesh, 60.0, 90.0, friction);
        let thrown = |factor: f64| {
            let bottom = Some("bottom".to_string());
            Problem::<2>::builder(mesh.clone())
                .material(aluminium())
                .initial_velocity(Initial::Uniform(throw.velocity.map(|v| factor * v)))
                .obstacle(Obstacle::plane([0.0, -throw.gap * factor], [0.0, 1.0], friction, bottom).unwrap())
                .build()
                .unwrap()
        };
        let (one, other) = (thrown(1.0), thrown(scale));
        let (one, other) = (run(&one, &throw.times), run(&other, &throw.times));
        prop_assert!(reactions(&one) > 0);
        same(&one, &other, |v| [scale * v[0], scale * v[1]], |i| i)?;
    }

    /// Axes with supports: the place of the origin does not matter. Coordinates of 30 m cost two
    /// digits of the gradients, which 1e-9 leaves room for.
    #[test]
    fn the_origin_does_not_matter(mesh in rectangle(5), x in -30.0..30.0, y in -30.0..30.0) {
        let pulled = |mesh: Mesh| {
            let value = Table::new(vec![0.0, 1e-4], vec![[2e8, 3e8], [-2e8, 1e8]]).unwrap();
            Problem::<2>::builder(mesh)
                .material(aluminium())
                .support(fixed("left", [true, false]))
                .traction(Traction { group: "right".to_string(), value, profile: Profile::UNIFORM })
                .build()
                .unwrap()
        };
        let (here, there) = (pulled(mesh.clone()), pulled(translated(&mesh, [x, y]).unwrap()));
        let times = Throw::new(&mesh, 0.0, 1.0, 0.0).times;
        same(&run(&here, &times), &run(&there, &times), |v| v, |i| i)?;
    }
}
