//! Halves of symmetric models.

use super::all;
use crate::load::Support;
use crate::material::Elastic;
use crate::mesh::Mesh;
use crate::problem::{Builder, Cause, Initial, Problem};

/// A half of two bodies of 20 mm, 4 cells wide, beside the line of symmetry x = 0: a height above the level of each
/// surface (m), their gap at the line (m), and a place of the line on the level of the lower one (m).
fn halves(heights: impl Fn(f64) -> [f64; 2], gap: f64, place: [f64; 2]) -> Builder<2> {
    let held = |group: &str| Support { group: group.into(), components: [true, false, false], velocity: None };
    flush(heights, gap, place).support(held("lower.left")).support(held("upper.left"))
}

/// The same without supports.
fn flush(heights: impl Fn(f64) -> [f64; 2], gap: f64, [x, y]: [f64; 2]) -> Builder<2> {
    let block = |side: usize, up: f64| {
        let mesh = Mesh::rectangle(0.02, 0.01, 4, 2).unwrap();
        mesh.mapped(|p| [x + p[0], y + up + p[1] + heights(p[0])[side]]).unwrap()
    };
    let (lower, upper) = (block(0, -0.01), block(1, gap));
    let velocity = [vec![[0.0; 2]; lower.node_count()], vec![[0.0, -20.0]; upper.node_count()]].concat();
    // Those that touch have no speed, which would be an impact at the start.
    let velocity = velocity.into_iter().map(|v| if gap > 0.0 { v } else { [0.0; 2] }).collect();
    Problem::<2>::builder(Mesh::joined(&[("lower", &lower), ("upper", &upper)]).unwrap())
        .material(Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap())
        .initial_velocity(Initial::Nodal(velocity))
        .automatic_contact()
        .contact(all(0.2))
}

/// The normal is along the line of symmetry, and no edge is left out, with slopes of one or both, in contact or not,
/// beside rounding and far from the origin.
#[test]
fn halves_meet_along_the_line_of_symmetry() {
    // The lower surface falls by the first slope, the upper one rises by the second one.
    for [fall, rise] in [[0.06, 0.04], [0.04, 0.06], [0.1, 0.03], [0.0, 0.1], [0.0, 0.0], [0.1, 0.1]] {
        for gap in [0.0, 1e-4] {
            for place in [[0.0, 0.0], [0.3, 150.0], [-1000.3, 1000.3]] {
                let far = |x: f64| if x > 0.019 { -5e-14 } else { 0.0 };
                let builder = halves(|x| [far(x) - fall * x, rise * x], gap, place);
                let problem =
                    builder.build().unwrap_or_else(|error| panic!("{fall}, {rise}, {gap}, {place:?}: {error}"));
                let edges = problem.surface().faces().len();
                let normal = problem.obstacles()[0].flat_frame().normal()[0];
                assert_eq!((edges, normal), (8, 0.0), "{fall}, {rise}, {gap}, {place:?}");
            }
        }
    }
    // A ridge in a valley, as the whole bodies would be.
    let cause = halves(|x| [0.05 * x, 0.06 * x], 1e-4, [0.0, 0.0]).build().unwrap_err().cause;
    assert!(matches!(cause, Cause::Interlocked { halves: true, .. }), "{cause}");
}

/// Ends of bodies that lie above each other meet along the normal of one surface, not between both: no edge leaves the
/// contact, whichever body a support guides.
#[test]
fn flush_ends_meet_along_a_surface() {
    for group in ["lower.left", "upper.left"] {
        for [fall, rise] in [[0.0, 0.02], [0.0, 0.09], [0.02, 0.0], [0.0, 0.0]] {
            let held = Support { group: group.into(), components: [true, false, false], velocity: None };
            let builder = flush(|x| [-fall * x, rise * x], 1e-5, [0.0, 0.0]).support(held);
            let problem = builder.build().unwrap_or_else(|error| panic!("{group}, {fall}, {rise}: {error}"));
            let normal = problem.obstacles()[0].flat_frame().normal()[0];
            assert_eq!((problem.surface().faces().len(), normal), (8, 0.0), "{group}, {fall}, {rise}");
        }
    }
}

/// Bodies that a support clamps on one line are not halves: two posts that lean to one side have the normal of their
/// sides.
#[test]
fn clamped_bodies_are_whole() {
    let post = |at: f64| {
        let mesh = Mesh::rectangle(0.01, 0.04, 2, 8).unwrap();
        mesh.mapped(|p| [at + p[0] + 0.3 * p[1], p[1]]).unwrap()
    };
    let (left, right) = (post(0.0), post(0.01001));
    let velocity = [vec![[1.0, 0.0]; left.node_count()], vec![[0.0; 2]; right.node_count()]].concat();
    let posts = |components: [bool; 2]| {
        let held = |group: &str| Support {
            group: group.into(),
            components: [components[0], components[1], false],
            velocity: None,
        };
        // Nodes of the support have its velocity.
        let velocity =
            velocity.iter().enumerate().map(|(node, v)| if node < 3 && components[0] { [0.0; 2] } else { *v });
        Problem::<2>::builder(Mesh::joined(&[("left", &left), ("right", &right)]).unwrap())
            .material(Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap())
            .initial_velocity(Initial::Nodal(velocity.collect()))
            .support(held("left.bottom"))
            .support(held("right.bottom"))
            .automatic_contact()
            .contact(all(0.2))
            .build()
    };
    let clamped = posts([true, true]).unwrap();
    let normal = *clamped.obstacles()[0].flat_frame().normal();
    assert!((normal[1] / normal[0] + 0.3).abs() < 1e-12, "{normal:?}");
    let cause = posts([false, true]).unwrap_err().cause;
    assert!(matches!(cause, Cause::Interlocked { halves: true, .. }), "{cause}");
}
