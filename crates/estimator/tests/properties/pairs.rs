//! Bodies that touch each other in pairs of nodes.

use crate::properties::bodies::{aluminium, steps, swinging};
use crate::properties::estimating::{all_choices, assert_admissible, check, estimate, estimate_with_maps, history};
use percute_core::border::vectors;
use percute_core::contact::{Interface, Obstacle};
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::{Builder, Initial, Problem};
use percute_core::time::TimeGrid;
use percute_estimator::{Options, Request, Sampling};
use percute_testkit::{random_rectangle, rotated, translated, upside_down};

const GAP: f64 = 50e-6;

/// The mesh with the height of each point changed.
fn raised(mesh: &Mesh, by: impl Fn(f64) -> f64) -> Mesh {
    mesh.mapped(|p| [p[0], p[1] + by(p[0])]).unwrap()
}

/// A block and its mirror image below it, with a velocity (m/s) and a material for each; `raise` changes the heights of
/// the upper one, from the lower edge on. Turned by an angle (rad).
struct Blocks {
    block: Mesh,
    raise: fn(f64) -> f64,
    velocities: [[f64; 2]; 2],
    friction: f64,
    materials: [Elastic; 2],
    angle: f64,
}

impl Blocks {
    fn head_on() -> Self {
        Self {
            block: Mesh::rectangle(0.04, 0.025, 6, 4).unwrap(),
            raise: |_| 0.0,
            velocities: [[0.0, -20.0], [0.0, 20.0]],
            friction: 0.0,
            materials: [aluminium(); 2],
            angle: 0.0,
        }
    }

    fn mesh(&self) -> Mesh {
        let upper = translated(&raised(&self.block, self.raise), [0.0, GAP]).unwrap();
        let lower = translated(&upside_down(&self.block).unwrap(), [0.0, -GAP]).unwrap();
        rotated(&Mesh::joined(&[("upper", &upper), ("lower", &lower)]).unwrap(), self.angle).unwrap()
    }

    fn builder(&self) -> Builder<2> {
        let (mesh, half, (sin, cos)) = (self.mesh(), self.block.node_count(), self.angle.sin_cos());
        let turned = |v: [f64; 2]| [cos * v[0] - sin * v[1], sin * v[0] + cos * v[1]];
        let velocity = |i: usize| turned(self.velocities[usize::from(i >= half)]);
        let velocity = (0..mesh.node_count()).map(velocity).collect();
        Problem::<2>::builder(mesh)
            .material_of("upper", self.materials[0])
            .material_of("lower", self.materials[1])
            .initial_velocity(Initial::Nodal(velocity))
    }

    fn problem(&self) -> Problem<2> {
        self.between(["upper.bottom", "lower.bottom"])
    }

    fn between(&self, groups: [&str; 2]) -> Problem<2> {
        let interface = Interface::matching(2, groups[0], groups[1], self.friction).unwrap();
        self.builder().interface(interface).build().unwrap()
    }
}

fn steel() -> Elastic {
    Elastic::plane_stress(210e9, 0.3, 7800.0, 1.0).unwrap()
}

/// Two equal blocks head-on are twice one block on a rigid plane, part by part; a common velocity changes nothing.
#[test]
fn mirrored_blocks_have_twice_the_error_of_one() {
    let blocks = Blocks { velocities: [[3.0, -15.0], [3.0, 25.0]], ..Blocks::head_on() };
    for raise in [(|_| 0.0) as fn(f64) -> f64, |x| 10.0 * (x - 0.02).powi(2)] {
        let block = raised(&blocks.block, raise);
        let upper = translated(&block, [0.0, GAP]).unwrap();
        let lower = translated(&upside_down(&block).unwrap(), [0.0, -GAP]).unwrap();
        let mesh = Mesh::joined(&[("upper", &upper), ("lower", &lower)]).unwrap();
        let half = upper.node_count();
        let velocity = (0..mesh.node_count()).map(|i| blocks.velocities[usize::from(i >= half)]).collect();
        let both = Problem::<2>::builder(mesh)
            .material(aluminium())
            .initial_velocity(Initial::Nodal(velocity))
            .interface(Interface::matching(2, "upper.bottom", "lower.bottom", 0.0).unwrap())
            .build()
            .unwrap();
        let one = Problem::<2>::builder(upper)
            .material(aluminium())
            .initial_velocity(Initial::Uniform([0.0, -20.0]))
            .obstacle(Obstacle::plane([0.0, 0.0], [0.0, 1.0], 0.0, Some("bottom".into())).unwrap())
            .build()
            .unwrap();
        let times = steps(&both, 0.8, 60);
        let (pair, single) = (history(&both, &times), history(&one, &times));
        for options in all_choices() {
            let [pair, single] = [estimate(&both, &pair, options), estimate(&one, &single, options)];
            assert_admissible("pair", &pair);
            assert_eq!(pair.over_time.len(), single.over_time.len());
            let scale = single.error.sup.powi(2);
            for (both, one) in pair.over_time.iter().zip(&single.over_time) {
                let (both, one) = (both.parts, one.parts);
                let parts = [(both.kinetic, one.kinetic), (both.elastic, one.elastic), (both.contact, one.contact)];
                for (both, one) in parts {
                    assert!((both - 2.0 * one).abs() <= 1e-9 * scale, "{options:?}: {both} {one} {scale}");
                }
            }
            assert!((pair.error.sup / single.error.sup - 2.0_f64.sqrt()).abs() <= 1e-9, "{options:?}");
        }
    }
}

/// All reconstructions are admissible, whatever the blocks are and however they move.
#[test]
fn everything_is_admissible() {
    let unstructured = random_rectangle(0.04, 0.025, 6, 3).unwrap();
    let oblique = [[8.0, -20.0], [-2.0, 10.0]];
    let cases = [
        Blocks { velocities: oblique, friction: 0.2, ..Blocks::head_on() },
        Blocks { velocities: oblique, friction: 0.5, materials: [aluminium(), steel()], ..Blocks::head_on() },
        Blocks { block: unstructured, velocities: oblique, friction: 0.2, angle: 0.7, ..Blocks::head_on() },
        Blocks { raise: |x| 0.05 * x, velocities: oblique, friction: 0.2, ..Blocks::head_on() },
        Blocks { raise: |x| 3.0 * (x - 0.015).powi(2), friction: 0.3, velocities: oblique, ..Blocks::head_on() },
    ];
    for (k, blocks) in cases.iter().enumerate() {
        let problem = blocks.problem();
        let count = check(&format!("case {k}"), &problem, &swinging(&problem, 90, 3.0));
        assert!(count > 20, "case {k}: {count} reactions");
    }
}

/// u_CA of the two bodies, from the maps, does not penetrate, and pairs in contact move together across the interface.
#[test]
fn admissible_motions_do_not_penetrate() {
    let blocks = Blocks {
        velocities: [[8.0, -20.0], [-2.0, 10.0]],
        friction: 0.2,
        raise: |x| 2.0 * (x - 0.015).powi(2),
        materials: [aluminium(), steel()],
        ..Blocks::head_on()
    };
    let problem = blocks.problem();
    let times = steps(&problem, 0.9, 80);
    let (history, surface) = (history(&problem, &times), problem.surface());
    let request = Request { fields: true, ..Request::evenly(&times, usize::MAX, 1) };
    let options = Options { every: Sampling::Every(1), ..Options::default() };
    let estimate = estimate_with_maps(&problem, &history, options, &request);
    let mut closed = 0;
    for map in &estimate.maps {
        let fields = map.fields.as_ref().unwrap();
        let touching = history.step(map.step).unwrap().touching;
        for at in (0..surface.nodes().len()).filter(|&at| surface.leads(at)) {
            let gap = surface.gap(at, &surface.against_obstacle(at, vectors(&fields.displacement)));
            assert!(gap >= -1e-12 * problem.mesh().size(), "step {}: {gap}", map.step);
            if touching[at] {
                let velocity = surface.against_obstacle(at, vectors(&fields.velocity));
                let normal = surface.frame(at, &[0.0; 2]).split(&velocity).0;
                assert!(gap.abs() <= 1e-12 && normal.abs() <= 1e-11, "step {}: {gap} {normal}", map.step);
                closed += 1;
            }
        }
    }
    assert!(closed > 30, "{closed}");
}

/// Neither the order of the bodies nor a rotation matters.
#[test]
fn the_roles_of_the_bodies_do_not_matter() {
    let blocks = Blocks {
        velocities: [[8.0, -20.0], [-2.0, 10.0]],
        friction: 0.2,
        materials: [aluminium(), steel()],
        ..Blocks::head_on()
    };
    let problem = blocks.problem();
    let times = steps(&problem, 0.9, 60);
    let error = |problem: &Problem<2>| estimate(problem, &history(problem, &times), Options::default()).error;
    let expected = error(&problem);
    let turned = Blocks { angle: 0.4, ..Blocks { ..blocks } };
    let [exchanged, turned] = [turned.between(["lower.bottom", "upper.bottom"]), turned.problem()].map(|p| error(&p));
    for found in [exchanged, turned] {
        // Rounding, which contact that opens and closes amplifies.
        assert!((found.sup / expected.sup - 1.0).abs() < 1e-9, "{found:?} {expected:?}");
        assert!((found.mean / expected.mean - 1.0).abs() < 1e-9, "{found:?} {expected:?}");
    }
}

/// A body s times stiffer and denser tends to a rigid plane, and the difference falls like 1/s.
#[test]
fn a_heavy_body_is_a_rigid_plane() {
    let single = Problem::<2>::builder(translated(&Blocks::head_on().block, [0.0, 2.0 * GAP]).unwrap())
        .material(aluminium())
        .initial_velocity(Initial::Uniform([5.0, -20.0]))
        .obstacle(Obstacle::plane([0.0, 0.0], [0.0, 1.0], 0.2, Some("bottom".into())).unwrap())
        .build()
        .unwrap();
    let times = steps(&single, 0.9, 60);
    let error = |problem: &Problem<2>| estimate(problem, &history(problem, &times), Options::default()).error.sup;
    let rigid = error(&single);
    let differences = [1e3, 1e5].map(|s| {
        let heavy = Elastic::plane_stress(s * 70e9, 0.3, s * 2700.0, 1.0).unwrap();
        let velocities = [[5.0, -20.0], [0.0, 0.0]];
        let blocks = Blocks { velocities, friction: 0.2, materials: [aluminium(), heavy], ..Blocks::head_on() };
        (error(&blocks.problem()) / rigid - 1.0).abs()
    });
    assert!(differences[1] < 1e-4 && differences[1] < 0.02 * differences[0], "{differences:?}");
}

/// Equal bars: e against the exact error is in the range that the one-dimensional table states.
#[test]
fn bars_are_admissible() {
    for (lengths, sections) in [([0.3, 0.3], [1e-4, 1e-4]), ([0.3, 0.6], [1e-4, 0.25e-4])] {
        let bar = |start: f64, length: f64| {
            Mesh::uniform_bar(length, (length / 0.015).round() as usize).unwrap().mapped(|p| [p[0] + start]).unwrap()
        };
        let (left, right) = (bar(-lengths[0], lengths[0]), bar(1e-4, lengths[1]));
        let mesh = Mesh::joined(&[("left", &left), ("right", &right)]).unwrap();
        let first = left.node_count();
        let velocity = (0..mesh.node_count()).map(|i| [if i < first { 10.0 } else { 0.0 }]).collect();
        let law = |section: f64| Elastic::bar(70e9, 2700.0, section).unwrap();
        let problem = Problem::<1>::builder(mesh)
            .material_of("left", law(sections[0]))
            .material_of("right", law(sections[1]))
            .initial_velocity(Initial::Nodal(velocity))
            .interface(Interface::matching(1, "left.end", "right.start", 0.0).unwrap())
            .build()
            .unwrap();
        let times: TimeGrid = steps(&problem, 0.9, 70);
        assert!(check("bars", &problem, &times) > 20);
    }
}
