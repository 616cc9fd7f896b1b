//! Non-matching interfaces of two bodies.

use crate::properties::bodies::{aluminium, steps};
use crate::properties::estimating::{assert_admissible, estimate, estimate_with_maps, history};
use percute_core::border::vectors;
use percute_core::contact::{Interface, Side};
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_estimator::{EstimateError, Estimator, Options, Reconstruction, Request, Sampling, SurfaceEstimate};
use percute_testkit::{Random, mirrored, rotated, translated, upside_down};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

const GAP: f64 = 50e-6;
const HEIGHT: f64 = 0.025;

/// Two blocks, one above the other.
#[derive(Clone, Copy)]
struct Blocks {
    /// Cells of the upper and of the lower one.
    cells: [[usize; 2]; 2],
    widths: [f64; 2],
    /// How far the upper one is to the right (m), and by which angle it is turned (rad).
    aside: f64,
    tilt: f64,
    materials: [Elastic; 2],
    velocities: [[f64; 2]; 2],
    friction: f64,
    /// Both turned by an angle (rad).
    angle: f64,
}

impl Blocks {
    fn oblique() -> Self {
        Self {
            cells: [[14, 11], [20, 16]],
            widths: [0.04; 2],
            aside: 0.0,
            tilt: 0.0,
            materials: [aluminium(); 2],
            velocities: [[8.0, -20.0], [0.0, 20.0]],
            friction: 0.2,
            angle: 0.0,
        }
    }

    fn mesh(&self) -> Mesh {
        let block = |k: usize| Mesh::rectangle(self.widths[k], HEIGHT, self.cells[k][0], self.cells[k][1]).unwrap();
        let upper = rotated(&block(0), self.tilt).unwrap();
        let low = upper.points_in::<2>().iter().map(|p| p[1]).fold(f64::INFINITY, f64::min);
        let upper = translated(&upper, [self.aside, HEIGHT + GAP - low]).unwrap();
        let both = Mesh::joined(&[("upper", &upper), ("lower", &block(1))]).unwrap();
        rotated(&both, self.angle).unwrap()
    }

    fn between(&self, interface: Interface) -> Problem<2> {
        let (mesh, (sin, cos)) = (self.mesh(), self.angle.sin_cos());
        let turned = |v: [f64; 2]| [cos * v[0] - sin * v[1], sin * v[0] + cos * v[1]];
        let upper = (self.cells[0][0] + 1) * (self.cells[0][1] + 1);
        let velocity = |node: usize| turned(self.velocities[usize::from(node >= upper)]);
        let velocity = (0..mesh.node_count()).map(velocity).collect();
        Problem::<2>::builder(mesh)
            .material_of("upper", self.materials[0])
            .material_of("lower", self.materials[1])
            .initial_velocity(Initial::Nodal(velocity))
            .interface(interface)
            .build()
            .unwrap()
    }

    fn problem(&self) -> Problem<2> {
        self.between(Interface::non_matching(2, "upper.bottom", "lower.top", self.friction).unwrap())
    }
}

fn steel() -> Elastic {
    Elastic::plane_stress(210e9, 0.3, 7800.0, 1.0).unwrap()
}

/// On surfaces with the same nodes that do not slide, as those of mirror images, multipliers are pairs of nodes:
/// estimates agree part by part.
#[test]
fn on_matching_surfaces_multipliers_are_pairs() {
    let strain = Elastic::plane_strain(70e9, 0.3, 2700.0, 2.0).unwrap();
    for material in [aluminium(), strain] {
        let block = translated(&Mesh::rectangle(0.04, HEIGHT, 10, 8).unwrap(), [0.0, GAP]).unwrap();
        let mesh = Mesh::joined(&[("upper", &block), ("lower", &upside_down(&block).unwrap())]).unwrap();
        let half = block.node_count();
        let velocity: Vec<_> = (0..2 * half).map(|node| [0.0, if node < half { -20.0 } else { 20.0 }]).collect();
        let between = |interface: Interface| {
            Problem::<2>::builder(mesh.clone())
                .material(material)
                .initial_velocity(Initial::Nodal(velocity.clone()))
                .interface(interface)
                .build()
                .unwrap()
        };
        let groups = ["upper.bottom", "lower.bottom"];
        let pairs = between(Interface::matching(2, groups[0], groups[1], 0.2).unwrap());
        let non_matching = between(Interface::non_matching(2, groups[0], groups[1], 0.2).unwrap());
        let times = steps(&pairs, 0.9, 90);
        let options = Options { every: Sampling::Every(1), ..Options::default() };
        let [one, other] = [&pairs, &non_matching].map(|problem| estimate(problem, &history(problem, &times), options));
        assert_admissible("non-matching", &other);
        // Nothing slides, nothing gives way, and the density is linear on each edge.
        let SurfaceEstimate { slide, lift, rounds, stress } = other.surfaces[0];
        assert!(slide <= 1e-12 && lift == 0.0 && rounds == 1 && stress <= 1e-12, "{:?}", other.surfaces);
        assert!(one.surfaces.is_empty());
        let scale = one.error.sup.powi(2);
        for (a, b) in one.over_time.iter().zip(&other.over_time) {
            let (one, other) = (a.parts, b.parts);
            let parts = [(one.kinetic, other.kinetic), (one.elastic, other.elastic), (one.contact, other.contact)];
            // Auxiliary contact forces move the lumped masses of non-matching interfaces, and those of pairs by the
            // corrected scheme.
            assert!(parts.iter().all(|(a, b)| (a - b).abs() <= 1e-4 * scale), "{:e}: {parts:?} {scale}", a.time);
        }
    }
}

/// Residuals of all conditions, whatever the blocks are and however they move.
#[test]
fn everything_is_admissible() {
    let blocks = Blocks::oblique();
    let cases = [
        blocks,
        Blocks { materials: [aluminium(), steel()], angle: 0.5, ..blocks },
        Blocks { velocities: [[150.0, -20.0], [0.0, 20.0]], ..blocks },
        Blocks { widths: [0.02, 0.04], cells: [[5, 6], [14, 11]], aside: 0.0113, ..blocks },
        Blocks { tilt: 0.05, velocities: [[0.0, -200.0], [0.0, 200.0]], ..blocks },
    ];
    for (k, blocks) in cases.iter().enumerate() {
        let problem = blocks.problem();
        let times = steps(&problem, 0.9, 90);
        let made = estimate(&problem, &history(&problem, &times), Options::default());
        assert_admissible(&format!("case {k}"), &made);
    }
}

/// The summary of an interface: bodies that move past each other without friction slide by as much as they move, but
/// for waves (measured: 0.9 % less). Lifts are those of the prototype of flat blocks, 4e-8 to 2e-6 m in two rounds, and
/// the share of stresses beside linear tractions is up to 5 % where flat bodies slide.
#[test]
fn the_summary_of_an_interface_is_of_its_motion() {
    let past = Blocks { friction: 0.0, velocities: [[150.0, -20.0], [0.0, 20.0]], ..Blocks::oblique() };
    let problem = past.problem();
    let times = steps(&problem, 0.9, 90);
    let made = estimate(&problem, &history(&problem, &times), Options::default());
    let SurfaceEstimate { slide, lift, rounds, stress } = made.surfaces[0];
    assert!((slide / (150.0 * made.end) - 1.0).abs() < 0.02, "{slide:e}");
    assert!((4e-8..2e-6).contains(&lift) && rounds == 2, "{lift:e} {rounds}");
    assert!(stress > 0.0 && stress < 0.05, "{stress:e}");
}

/// Only one reconstruction has an estimate of such surfaces.
#[test]
fn other_reconstructions_refuse() {
    let problem = Blocks::oblique().problem();
    let times = steps(&problem, 0.9, 10);
    for reconstruction in [Reconstruction::Published, Reconstruction::Consistent] {
        let refused = Estimator::new(&problem, &times, Options { reconstruction, ..Options::default() }).err();
        let groups = ["upper.bottom", "lower.top"].map(str::to_string);
        assert_eq!(refused, Some(EstimateError::NotMatching { groups }));
    }
}

/// u_CA of the two bodies, from the maps, does not penetrate at any point of the partition, though it touches.
#[test]
fn admissible_motions_do_not_penetrate() {
    let blocks = Blocks::oblique();
    for blocks in [
        Blocks { materials: [aluminium(), steel()], ..blocks },
        Blocks { tilt: 0.05, velocities: [[0.0, -200.0], [0.0, 200.0]], ..blocks },
        Blocks { widths: [0.02, 0.04], cells: [[5, 6], [14, 11]], aside: 0.0113, ..blocks },
    ] {
        let problem = blocks.problem();
        let times = steps(&problem, 0.9, 80);
        let (history, surface) = (history(&problem, &times), problem.surface());
        let request = Request { fields: true, ..Request::evenly(&times, usize::MAX, 1) };
        let options = Options { every: Sampling::Every(1), ..Options::default() };
        let estimate = estimate_with_maps(&problem, &history, options, &request);
        let non_matching = &surface.non_matching()[0];
        let mut nearest = f64::INFINITY;
        for map in &estimate.maps {
            let displacement = vectors::<2>(&map.fields.as_ref().unwrap().displacement);
            let coupling = non_matching.coupling(surface, displacement);
            let eta = |side: &Side, node: usize| {
                let u = displacement[surface.nodes()[side.position(node)].node.index()];
                side.eta()[node] + u.iter().zip(non_matching.frame().normal()).map(|(u, n)| u * n).sum::<f64>()
            };
            let at = |side: &Side, places: &[f64], first: usize, xi: f64| {
                let part = (xi - places[first]) / (places[first + 1] - places[first]);
                eta(side, first) + part * (eta(side, first + 1) - eta(side, first))
            };
            for segment in coupling.segments() {
                for xi in segment.ends {
                    let slave = non_matching.slave().edges()[segment.slave];
                    let master = non_matching.master().edges()[segment.master];
                    let gap = at(non_matching.slave(), non_matching.slave().xi(), slave, xi)
                        - at(non_matching.master(), coupling.places(0), master, xi);
                    assert!(gap >= -1e-12 * problem.mesh().size(), "step {}: {gap}", map.step);
                    nearest = nearest.min(gap);
                }
            }
        }
        assert!(nearest <= 1e-9, "{nearest}");
    }
}

/// Neither a rotation nor the order of the bodies or of their nodes matters, and threads and windows not a bit.
#[test]
fn the_frame_and_the_order_do_not_matter() {
    let flat = Blocks { materials: [aluminium(), steel()], ..Blocks::oblique() };
    let place = Blocks { cells: [[7, 6], [10, 8]], widths: [0.02, 0.04], aside: 0.011, ..flat };
    let corner = Blocks { tilt: 0.1, velocities: [[1.0, -2.0], [0.0, 2.0]], ..place };
    for (blocks, count) in [(flat, 60), (corner, 90)] {
        let problem = blocks.problem();
        let times = steps(&problem, 0.9, count);
        let error = |problem: &Problem<2>, options| estimate(problem, &history(problem, &times), options).error;
        let expected = error(&problem, Options::default());
        let exchanged = Interface::non_matching(2, "lower.top", "upper.bottom", blocks.friction).unwrap();
        for other in [Blocks { angle: 0.7, ..blocks }.problem(), blocks.between(exchanged)] {
            let found = error(&other, Options::default());
            // Rounding, which contact that opens and closes amplifies.
            assert!((found.sup / expected.sup - 1.0).abs() < 1e-9, "{found:?} {expected:?}");
            assert!((found.mean / expected.mean - 1.0).abs() < 1e-9, "{found:?} {expected:?}");
        }
        for (threads, window) in [(1, 1), (2, 3), (3, 8)] {
            let options = Options { threads: Some(threads), window: Some(window), ..Options::default() };
            assert_eq!(error(&problem, options), expected, "{threads} {window}");
        }
    }
}

/// A regular polygon of ten sides around the origin in three rings, with one node at this angle (rad). The group `tip`
/// has both edges at that node.
fn decagon(radius: f64, angle: f64) -> Mesh {
    const SIDES: usize = 10;
    let node = |ring: usize, side: usize| 1 + (ring - 1) * SIDES + side % SIDES;
    let (mut points, mut cells) = (vec![[0.0; 2]], Vec::new());
    for ring in 1..=3 {
        for side in 0..SIDES {
            let (sin, cos) = (angle + TAU * side as f64 / SIDES as f64).sin_cos();
            points.push([cos, sin].map(|part| radius * ring as f64 / 3.0 * part));
            let [a, b] = [side, side + 1].map(|side| node(ring, side));
            if ring == 1 {
                cells.push([0, a, b]);
            } else {
                let [inner, next] = [side, side + 1].map(|side| node(ring - 1, side));
                cells.extend([[inner, a, b], [inner, b, next]]);
            }
        }
    }
    let tip = [[node(3, SIDES - 1), node(3, 0)], [node(3, 0), node(3, 1)]];
    Mesh::new(points, &cells, &[("tip".to_string(), tip.to_vec())].into(), &BTreeMap::new()).unwrap()
}

/// Estimates of a body that falls on another one agree with those of its mirror image and of a turned one. The groups
/// `tip` and `top` may touch.
fn check_images(name: &str, [upper, lower]: [&Mesh; 2], [tip, top]: [&str; 2], count: usize) {
    let mesh = Mesh::joined(&[("upper", upper), ("lower", lower)]).unwrap();
    let problem = |mesh: Mesh, down: [f64; 2]| {
        let velocity = |node: usize| if node < upper.node_count() { down.map(|part| 20.0 * part) } else { [0.0; 2] };
        Problem::<2>::builder(mesh.clone())
            .material(aluminium())
            .initial_velocity(Initial::Nodal((0..mesh.node_count()).map(velocity).collect()))
            .interface(Interface::non_matching(2, tip, top, 0.2).unwrap())
            .build()
            .unwrap()
    };
    let one = problem(mesh.clone(), [0.0, -1.0]);
    let times = steps(&one, 0.9, count);
    let error = |problem: &Problem<2>| estimate(problem, &history(problem, &times), Options::default()).error;
    let (expected, (sin, cos)) = (error(&one), 0.6_f64.sin_cos());
    assert!(expected.sup > 0.0);
    let turned = problem(rotated(&mesh, 0.6).unwrap(), [sin, -cos]);
    for other in [problem(mirrored(&mesh).unwrap(), [0.0, -1.0]), turned] {
        let found = error(&other);
        // Rings a hundredth wide lose eight digits of an energy.
        assert!((found.sup / expected.sup - 1.0).abs() < 1e-7, "{name}: {found:?} {expected:?}");
        assert!((found.mean / expected.mean - 1.0).abs() < 1e-7, "{name}: {found:?} {expected:?}");
    }
}

/// Coaxial polygons that touch node on node, whose rings have turned diagonals. Their loads are close to a node, where
/// slender parts of an element would lose all digits: the estimate differed by 6 % between images.
#[test]
fn coaxial_polygons_have_images() {
    let [lower, upper] = [decagon(0.01, 0.25 * TAU), decagon(0.008, -0.25 * TAU)];
    let [lower, upper] = [translated(&lower, [0.0, -0.01]).unwrap(), translated(&upper, [0.0, 0.00801]).unwrap()];
    check_images("decagons", [&upper, &lower], ["upper.tip", "lower.tip"], 80);
}

/// A tip and a flat corner on an edge of 5 mm, at places where ways along the edge are almost equal: the estimate
/// differed by up to 2 % between images.
#[test]
fn any_place_on_an_edge_has_images() {
    let plate = Mesh::rectangle(0.04, 0.02, 8, 4).unwrap();
    for part in [0.5, 0.5001, 0.4999, 0.25, 1.0 / 64.0, 1.0 / 128.0] {
        let block = |width: f64, cells: usize| Mesh::rectangle(width, 0.01, cells, 4).unwrap();
        let at = |mesh: &Mesh, x: f64| translated(mesh, [x + 0.005 * part, 0.02001]).unwrap();
        let roof = block(0.02, 4).mapped(|p| [p[0], p[1] + 0.1 * (p[0] - 0.01).abs() * (1.0 - p[1] / 0.01)]).unwrap();
        for (name, upper) in [("roof", at(&roof, 0.005)), ("corner", at(&block(0.015, 6), 0.01))] {
            check_images(&format!("{name} at {part}"), [&upper, &plate], ["upper.bottom", "lower.top"], 20);
        }
    }
}

/// Blocks drawn at random.
#[test]
fn any_blocks_are_admissible() {
    for seed in 0..60 {
        let mut random = Random::new(seed);
        let cells = [(); 2].map(|()| [1 + random.bits() as usize % 7, 1 + random.bits() as usize % 4]);
        let widths = [(); 2].map(|()| random.between(0.01, 0.04));
        let speed = 10.0_f64.powf(random.between(-1.0, 2.5));
        let materials = [(); 2].map(|()| if random.bits().is_multiple_of(2) { aluminium() } else { steel() });
        let blocks = Blocks {
            cells,
            widths,
            aside: random.between(-widths[0], widths[1]),
            tilt: if random.bits().is_multiple_of(2) { 0.0 } else { random.between(-0.2, 0.2) },
            materials,
            velocities: [[random.between(-speed, speed), -speed], [0.0, random.between(0.0, speed)]],
            friction: random.between(0.0, 0.8),
            angle: random.between(0.0, 6.0),
        };
        let problem = blocks.problem();
        // The bodies meet after a third of the steps or so.
        let critical = steps(&problem, 1.0, 1).end();
        let count = 60;
        let way = 3.0 * GAP / (speed - blocks.velocities[1][1] + 2.0 * blocks.velocities[1][1]);
        let step = (way / f64::from(count)).min(random.between(0.3, 0.95) * critical);
        let times = TimeGrid::uniform(step * f64::from(count), count as usize).unwrap();
        let history = history(&problem, &times);
        let made = estimate(&problem, &history, Options::default());
        assert_admissible(&format!("seed {seed}"), &made);
    }
}
