//! Statements that are refused, and starts.

use super::setup::{Blocks, GAP, steps};
use crate::solution::run::{aluminium, fixed, run};
use percute_core::contact::{Inclination, Interface, Obstacle};
use percute_core::dynamics::{SimulationError, check_start};
use percute_core::load::Support;
use percute_core::material::Elastic;
use percute_core::mesh::{ElementGroups, FaceGroups, Mesh};
use percute_core::problem::{Builder, Cause, Initial, InputError, Problem};
use percute_core::time::TimeGrid;
use percute_testkit::translated;

fn cause(problem: Result<Problem<2>, InputError>) -> Option<Cause> {
    problem.err().map(|error| error.cause)
}

#[test]
fn wrong_groups_are_refused() {
    let blocks = Blocks::oblique();
    let refusal = |first: &str, second: &str| {
        let interface = Interface::non_matching(2, first, second, 0.2).unwrap();
        cause(blocks.bodies(blocks.mesh(), |v| v).interface(interface).build())
    };
    assert_eq!(refusal("upper.bottom", "lower.top"), None);
    assert!(matches!(refusal("upper.bottom", "upper.top"), Some(Cause::SameBody { .. })));
    assert!(matches!(refusal("upper.bottom", "lower.bottom"), Some(Cause::TurnedAway { .. })));
    assert!(matches!(refusal("upper.bottom", "lower.left"), Some(Cause::TurnedAway { .. })));
    assert!(matches!(refusal("upper.bottom", "anvil.top"), Some(Cause::UnknownGroup { .. })));
    assert!(Interface::non_matching(2, "a", "b", -0.1).is_err());
    assert!(Interface::non_matching(1, "a", "b", 0.1).is_err());
}

/// Two bodies of 20 mm that face each other along a surface of this height above its level, with supports across x;
/// `tilt` is the slope of their sides.
fn facing(height: impl Fn(f64) -> [f64; 2], tilt: f64, supports: &[&str]) -> Result<Problem<2>, InputError> {
    let place = |side: usize, [x, y]: [f64; 2]| [x + tilt * y, y + height(x)[side]];
    placed(place, supports)
}

/// The same with the places of the points of each body in the undeformed blocks, the upper one first.
fn placed(place: impl Fn(usize, [f64; 2]) -> [f64; 2], supports: &[&str]) -> Result<Problem<2>, InputError> {
    let builder = joined(place).interface(Interface::non_matching(2, "upper.bottom", "lower.top", 0.2).unwrap());
    let support = |group: &str| Support { group: group.into(), components: [true, false, false], velocity: None };
    supports.iter().fold(builder, |builder, group| builder.support(support(group))).build()
}

/// Both bodies without contact.
fn joined(place: impl Fn(usize, [f64; 2]) -> [f64; 2]) -> Builder<2> {
    let body = |side: usize, up: f64| {
        let block = translated(&Mesh::rectangle(0.02, 0.02, 4, 4).unwrap(), [0.0, up]).unwrap();
        block.mapped(|p| place(side, *p)).unwrap()
    };
    let mesh = Mesh::joined(&[("upper", &body(0, 0.02 + GAP)), ("lower", &body(1, 0.0))]).unwrap();
    Problem::<2>::builder(mesh).material(aluminium())
}

/// Two slopes at a line of symmetry have no normal there that is one of both, unless they are nearly level. A support
/// that is not a line of symmetry does not make one of an oblique surface, nor do lines that are not common to both.
#[test]
fn slopes_at_a_line_of_symmetry_are_refused() {
    let both = |slope: f64| move |x: f64| [slope * x; 2];
    let left = ["upper.left", "lower.left"];
    assert_eq!(cause(facing(both(0.1), 0.0, &left)), None);
    assert!(matches!(cause(facing(both(0.5), 0.0, &left)), Some(Cause::TwoSlopes { .. })));
    assert_eq!(cause(facing(both(0.0), 0.3, &left)), None);
    assert!(matches!(cause(facing(both(0.1), 0.3, &left)), Some(Cause::HeldAcross { .. })));
    assert!(matches!(cause(facing(both(0.1), 0.0, &["upper.left"])), Some(Cause::HeldAcross { .. })));
    let apart = ["upper.left", "lower.right"];
    assert!(matches!(cause(facing(both(0.1), 0.0, &apart)), Some(Cause::HeldAcross { .. })));
    assert_eq!(cause(facing(both(0.0), 0.0, &apart)), None);
}

/// A line far from the origin has places of both bodies that differ by its rounding.
#[test]
fn distant_lines_are_one() {
    let [own, other] = [(1000.2 + 0.1_f64), 1000.3];
    assert!(own != other && (own - other).abs() < 1e-12);
    let place = |side: usize, [x, y]: [f64; 2]| [[own, other][side] + x, y + 0.1 * x];
    assert_eq!(cause(placed(place, &["upper.left", "lower.left"])), None);
}

/// A cell between two lines of symmetry: at each of them another surface is level.
#[test]
fn slopes_of_a_cell_count_at_their_own_line() {
    let upper = |x: f64| 0.3 * (0.01 - x).max(0.0);
    let lower = |x: f64| 0.3 * (0.01 - x).min(0.0);
    let lines = ["upper.left", "lower.left", "upper.right", "lower.right"];
    assert_eq!(cause(facing(|x| [upper(x), lower(x)], 0.0, &lines)), None);
}

/// The inclination of two chevrons is the smaller angle, of non-matching interfaces and as pairs; a chevron on a level
/// surface does not, nor do two that open. Edges of which one node touches do not count, and corners do.
#[test]
fn chevrons_lean_together() {
    let slope = |problem: &Problem<2>, ends: bool| {
        let (surface, mesh) = (problem.surface(), problem.mesh());
        let apex = |at: usize| (mesh.points_in::<2>()[surface.nodes()[at].node.index()][0] - 0.01).abs() < 1e-9;
        let inclination = |inside: bool| Inclination::new(surface, mesh, vec![inside; surface.nodes().len()]);
        assert_eq!(inclination(true).largest(0.0, apex, |_| &[0.0]), 0.0);
        inclination(!ends).largest(0.0, |_| true, |_| &[0.0]).to_degrees()
    };
    let degrees = |height: fn(f64) -> [f64; 2]| {
        let angle = slope(&facing(height, 0.0, &[]).unwrap(), false);
        let pairs = |side: usize, [x, y]: [f64; 2]| [x, y + height(x)[side]];
        let paired = joined(pairs).interface(Interface::matching(2, "upper.bottom", "lower.top", 0.2).unwrap());
        assert!((slope(&paired.build().unwrap(), false) - angle).abs() < 1e-9);
        angle
    };
    // Ends of the level surface are on the slopes.
    let ends = facing(|x| [0.0, 0.3 * (x - 0.01).abs() - 0.01], 0.0, &[]).unwrap();
    assert!((slope(&ends, true) - 0.3_f64.atan().to_degrees()).abs() < 1e-10);
    // Rounding of an arctangent.
    assert!((degrees(|x| [0.3 * (x - 0.01).abs(); 2]) - 0.3_f64.atan().to_degrees()).abs() < 1e-10);
    assert_eq!(degrees(|x| [0.3 * (x - 0.01).abs(), 0.0]), 0.0);
    assert_eq!(degrees(|x| [0.3 * (x - 0.01).abs(), -0.3 * (x - 0.01).abs()]), 0.0);
    assert!(
        (degrees(|x| [0.3 * (x - 0.01).abs(), 0.1 * (x - 0.01).abs()]) - 0.1_f64.atan().to_degrees()).abs() < 1e-10
    );
}

/// The inclination is that of surfaces where they are: of two zigzags of four edges, the third one of the upper surface
/// is on the first one of the lower surface after a way to the left.
#[test]
fn surfaces_lean_together_where_they_are() {
    let problem = facing(|x| [0.3 * ((x + 0.005) % 0.01 - 0.005).abs(); 2], 0.0, &[]).unwrap();
    let (surface, non_matching) = (problem.surface(), &problem.surface().non_matching()[0]);
    let is_upper = |at: usize| surface.nodes()[at].node.index() < 25;
    let left =
        if is_upper(non_matching.slave().position(0)) { -non_matching.tangent()[0] } else { non_matching.tangent()[0] };
    let inclination = Inclination::new(surface, problem.mesh(), vec![true; surface.nodes().len()]);
    let acts = |at: usize| {
        let from = if is_upper(at) { 0.0099 } else { -0.0001 };
        (from..from + 0.0052).contains(&surface.point(at)[0])
    };
    let largest = |least: f64, way: f64| {
        let shifts = [way * left];
        inclination.largest(least, acts, |_| &shifts)
    };
    let angle = 0.3_f64.atan();
    assert_eq!([largest(0.0, 0.0), largest(0.0, -0.01), largest(0.0, 0.005)], [0.0; 3]);
    // Rounding of an arctangent.
    assert!((largest(0.0, 0.01) - angle).abs() < 1e-14 && (largest(0.1, 0.01) - angle).abs() < 1e-14);
    assert_eq!([largest(0.4, 0.01), inclination.largest(0.2, |_| false, |_| &[0.0])], [0.4, 0.2]);
}

#[test]
fn a_node_touches_one_thing_only() {
    let blocks = Blocks::oblique();
    let twice = blocks.bodies(blocks.mesh(), |v| v).interface(blocks.interface()).interface(blocks.interface());
    let Some(Cause::SameSurfaces { groups }) = cause(twice.build()) else { panic!("not refused") };
    assert_eq!(groups.each_ref().map(String::as_str), blocks.interface().groups());
    let floor = Obstacle::plane([0.0, -GAP], [0.0, 1.0], 0.0, None).unwrap();
    let plane = blocks.bodies(blocks.mesh(), |v| v).interface(blocks.interface()).obstacle(floor);
    // Without a group, the plane may touch all that faces it: the bottom of the upper block, too.
    assert!(matches!(cause(plane.build()), Some(Cause::TwoContacts { .. })));
}

#[test]
fn plane_stress_meets_plane_stress_only() {
    let strain = Elastic::plane_strain(70e9, 0.3, 2700.0, 1.0).unwrap();
    let blocks = Blocks { materials: [aluminium(), strain], ..Blocks::oblique() };
    let problem = blocks.bodies(blocks.mesh(), |v| v).interface(blocks.interface()).build();
    assert_eq!(cause(problem), Some(Cause::PlanesDiffer));
}

/// Supports may guide nodes along the interface, but not hold them across.
#[test]
fn supports_act_along_the_interface_alone() {
    let blocks = Blocks { velocities: [[0.0, -20.0], [0.0, 20.0]], ..Blocks::oblique() };
    let held = |components| {
        let support = Support { group: "upper.left".into(), components, velocity: None };
        blocks.bodies(blocks.mesh(), |v| v).support(support)
    };
    let still = Blocks { velocities: [[0.0; 2], [0.0, 20.0]], ..blocks };
    let across = still.bodies(blocks.mesh(), |v| v).support(fixed("upper.left", [true, true]));
    assert!(matches!(cause(across.interface(blocks.interface()).build()), Some(Cause::HeldAcross { .. })));
    let problem = held([true, false, false]).support(fixed("lower.left", [true, false])).interface(blocks.interface());
    let problem = problem.build().unwrap();
    let run = run(&problem, &steps(&problem, 14e-6));
    let surface = problem.surface();
    let guided: Vec<usize> = (0..surface.nodes().len()).filter(|&at| surface.nodes()[at].guided).collect();
    assert_eq!(guided.len(), 2);
    let mut forces = 0;
    for n in 0..=run.last() {
        let step = run.history.step(n).unwrap();
        for &at in &guided {
            assert_eq!(step.displacement::<2>()[surface.nodes()[at].node.index()][0], 0.0);
            assert_eq!(step.reaction::<2>()[at][0], 0.0);
            forces += usize::from(step.reaction::<2>()[at][1] != 0.0);
        }
    }
    assert!(forces > 20, "{forces}");
}

#[test]
fn overlaps_and_strikes_at_the_start_are_refused() {
    let blocks = Blocks::oblique();
    let nodes = blocks.mesh().node_count();
    let upper = 15 * 12;
    let down = |by: f64, velocities: [[f64; 2]; 2]| {
        let blocks = Blocks { velocities, ..blocks };
        let displacement = (0..nodes).map(|node| [0.0, if node < upper { -by } else { 0.0 }]).collect();
        let bodies = blocks.bodies(blocks.mesh(), |v| v).initial_displacement(Initial::Nodal(displacement));
        bodies.interface(blocks.interface()).build()
    };
    let Some(Cause::Overlaps { depth, .. }) = cause(down(3.0 * GAP, blocks.velocities)) else { panic!("not refused") };
    assert!((depth - 2.0 * GAP).abs() < 1e-12 * GAP.sqrt(), "{depth}");
    assert!(matches!(cause(down(GAP, blocks.velocities)), Some(Cause::StrikesAtStart { .. })));
    // At rest on each other, and 1 µm apart.
    down(GAP, [[5.0, 0.0], [0.0; 2]]).unwrap();
    let near = down(GAP - 1e-6, [[0.0, -20.0], [0.0, 20.0]]).unwrap();
    let step = |length: f64| TimeGrid::uniform(10.0 * length, 10).unwrap();
    // 1 µm at 40 m/s: 25 ns. A node that stops needs a quarter of its way at least.
    let error = check_start(&near, &step(1.1e-7)).unwrap_err();
    let SimulationError::StartsTooNear { gap, speed, largest_step, .. } = error else { panic!("{error}") };
    assert!((gap - 1e-6).abs() < 1e-15 && (speed - 40.0).abs() < 1e-12 && (largest_step - 1e-7).abs() < 1e-15);
    check_start(&near, &step(0.9e-7)).unwrap();
}

/// Two steps of a stair, one above the other along the interface.
#[test]
fn edges_above_each_other_are_refused() {
    // A C of three strips, open to the right; both inner sides that face up are named.
    let strip = |y: f64| [[0.0, y], [2.0, y], [2.0, y + 1.0], [0.0, y + 1.0]];
    let mut points: Vec<[f64; 2]> = [strip(0.0), strip(3.0)].concat();
    points.extend([[0.0, 7.0], [2.0, 7.0], [2.0, 8.0], [0.0, 8.0]]);
    points.extend([[-1.0, 0.0], [-1.0, 4.0]]);
    let cells = [
        [0, 1, 2],
        [0, 2, 3],
        [4, 5, 6],
        [4, 6, 7],
        [8, 9, 10],
        [8, 10, 11],
        [12, 0, 3],
        [12, 3, 13],
        [3, 4, 13],
        [4, 7, 13],
    ];
    let groups = FaceGroups::from([("up".to_string(), vec![[2, 3], [6, 7]]), ("down".to_string(), vec![[8, 9]])]);
    let mesh = Mesh::new(points, &cells, &groups, &ElementGroups::new()).unwrap();
    assert_eq!(mesh.parts(), 2);
    let interface = Interface::non_matching(2, "up", "down", 0.0).unwrap();
    let problem = Problem::<2>::builder(mesh).material(aluminium()).interface(interface).build();
    assert!(matches!(cause(problem), Some(Cause::Covered { .. })));
}
