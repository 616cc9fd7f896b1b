//! Edges that are found pass all checks of an interface.

use super::all;
use crate::material::Elastic;
use crate::mesh::Mesh;
use crate::problem::{Cause, Initial, Problem};

/// Bodies with their names and velocities, of which the contact is found.
fn problem(of: &[(&str, &Mesh, [f64; 2])]) -> Result<Problem<2>, Cause> {
    let meshes: Vec<_> = of.iter().map(|&(name, mesh, _)| (name, mesh)).collect();
    let velocity = of.iter().flat_map(|(_, mesh, velocity)| vec![*velocity; mesh.node_count()]).collect();
    let builder = Problem::<2>::builder(Mesh::joined(&meshes).unwrap())
        .material(Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap())
        .initial_velocity(Initial::Nodal(velocity));
    builder.automatic_contact().contact(all(0.2)).build().map_err(|error| error.cause)
}

/// There is one interface, and the same edges are one on the refined mesh.
fn has_one_interface(of: &[(&str, &Mesh, [f64; 2])], what: &str) {
    let problem = problem(of).unwrap_or_else(|cause| panic!("{what}: {cause}"));
    let interfaces = &problem.conditions().interfaces;
    assert_eq!(interfaces.len(), 1, "{what}");
    let refined = Problem::<2>::builder(problem.mesh().refined().unwrap()).material(problem.materials()[0]);
    let refined = refined.interface(interfaces[0].clone()).build();
    assert!(!matches!(&refined, Err(error) if matches!(error.cause, Cause::TurnedAway { .. })), "{what}, refined");
}

#[test]
fn two_discs_may_have_any_place() {
    for rings in [2, 3, 4] {
        let disc = Mesh::disc(0.006, rings).unwrap();
        for degrees in (0..360).step_by(15).map(f64::from) {
            for turned in [0.0, 4.0, 10.0] {
                // Far enough for mean gaps that are positive.
                let (sin, cos) = f64::to_radians(degrees).sin_cos();
                let other = disc.placed(&[0.0125 * cos, 0.0125 * sin], turned).unwrap();
                let of = [("a", &disc, [0.0; 2]), ("b", &other, [-20.0 * cos, -20.0 * sin])];
                has_one_interface(&of, &format!("{rings} rings, {degrees}°, turned by {turned}°"));
            }
        }
    }
}

#[test]
fn a_block_may_have_any_angle() {
    let plate = Mesh::rectangle(0.04, 0.02, 10, 5).unwrap();
    let block = Mesh::rectangle(0.02, 0.02, 6, 6).unwrap();
    for degrees in (0..=90).step_by(5).map(f64::from) {
        let turned = block.placed(&[0.0, 0.0], degrees).unwrap();
        let low = turned.points_in::<2>().iter().map(|point| point[1]).fold(f64::INFINITY, f64::min);
        let block = turned.placed(&[0.016, 0.0201 - low], 0.0).unwrap();
        let of = [("plate", &plate, [0.0; 2]), ("block", &block, [0.0, -20.0])];
        has_one_interface(&of, &format!("{degrees}°"));
    }
}

/// A corner that slides either way stays on the other surface, also below its own side, which leans over that surface
/// and is too steep to touch it.
#[test]
fn surfaces_go_on_below_a_side_that_leans_over() {
    let plate = Mesh::rectangle(0.06, 0.02, 30, 4).unwrap();
    let block = Mesh::rectangle(0.02, 0.02, 4, 4).unwrap();
    for degrees in [10.0, 20.0, -10.0, -20.0] {
        // The corner is above the inside of an edge of 2 mm.
        let turned = block.placed(&[0.0, 0.0], degrees).unwrap();
        let least = |points: &[[f64; 2]], c: usize| points.iter().map(|point| point[c]).fold(f64::INFINITY, f64::min);
        let low = least(turned.points_in::<2>(), 1);
        let corner = turned.points_in::<2>().iter().find(|point| point[1] == low).unwrap();
        let block = turned.placed(&[0.0301 - corner[0], 0.0201 - low], 0.0).unwrap();
        let problem = problem(&[("plate", &plate, [0.0; 2]), ("block", &block, [0.0, -20.0])]).unwrap();
        let surface = problem.surface();
        let on_plate: Vec<_> =
            surface.nodes().iter().map(|node| problem.mesh().points_in::<2>()[node.node.index()]).collect();
        let on_plate: Vec<f64> = on_plate.iter().filter(|point| point[1] < 0.02001).map(|point| point[0]).collect();
        let [left, right] = [
            on_plate.iter().copied().fold(f64::INFINITY, f64::min),
            on_plate.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        ];
        // Half of the face of the block, which is nearly 20 mm wide, beyond the corner.
        assert!(left < 0.0301 - 0.008 && right > 0.0301 + 0.008, "{degrees}°: {left} {right}");
        assert_eq!(on_plate.len(), ((right - left) / 0.002).round() as usize + 1, "{degrees}°: {on_plate:?}");
    }
}

/// Discs that are nearer to each other than the sagitta of their edges.
#[test]
fn discs_apart_do_not_overlap() {
    let disc = |radius, rings, at: [f64; 2]| Mesh::disc(radius, rings).unwrap().placed(&at, 30.0).unwrap();
    let (a, b) = (disc(0.006, 5, [0.0; 2]), disc(0.006, 4, [0.010_393_170_876, 0.006_000_5]));
    has_one_interface(&[("a", &a, [1.732, 1.0]), ("b", &b, [0.0; 2])], "5 and 4 rings");
    // A node faces a node, and others are far away: the mean gap is negative, but nothing is inside.
    let coarse = |at: f64| {
        let (a, b) = (disc(0.006, 2, [0.0; 2]), disc(0.007, 6, [at, 0.0]));
        problem(&[("a", &a, [0.0; 2]), ("b", &b, [-1.0, 0.0])]).map(|_| ())
    };
    let cause = coarse(0.013_000_5).unwrap_err();
    let Cause::TooNear { depth, .. } = cause else { panic!("{cause}") };
    assert!(depth > 1e-6 && depth < 1e-3, "{depth}");
    coarse(0.013_000_6 + depth).unwrap();
}
