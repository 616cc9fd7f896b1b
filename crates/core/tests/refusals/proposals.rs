//! Edges that are found for contact are those that can meet.

use crate::found::{Body, problem};
use percute_core::mesh::Mesh;

fn block(size: [f64; 2], cells: [usize; 2], at: [f64; 2]) -> Mesh {
    Mesh::rectangle(size[0], size[1], cells[0], cells[1]).unwrap().placed(&at, 0.0).unwrap()
}

fn disc(radius: f64, at: [f64; 2]) -> Mesh {
    Mesh::disc(radius, 4).unwrap().placed(&at, 0.0).unwrap()
}

/// The groups of all interfaces.
fn groups(bodies: &[Body<'_>]) -> Vec<[String; 2]> {
    let problem = problem(bodies).build().unwrap();
    problem.conditions().interfaces.iter().map(|interface| interface.groups().map(str::to_string)).collect()
}

/// A disc meets the corner of a slab. The long side has more weight in the mean normal than the short one, whichever
/// of them faces the disc.
#[test]
fn edges_that_meet_are_not_left_out_because_others_are_longer() {
    let slab = || block([0.04, 0.01], [4, 2], [0.0; 2]);
    for degrees in [40.0_f64, 50.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let at = [0.04 + 0.0105 * cos, 0.01 + 0.0105 * sin];
        let bodies = [("slab", slab(), [0.0; 2]), ("disc", disc(0.01, at), [-10.0 * cos, -10.0 * sin])];
        let problem = problem(&bodies).build().unwrap();
        let nodes =
            problem.surface().nodes().iter().map(|contact| problem.mesh().points_in::<2>()[contact.node.index()]);
        // The right side or the upper one, which faces the disc better.
        let of_slab: Vec<[f64; 2]> = nodes.filter(|[x, y]| *x <= 0.04 && *y <= 0.01).collect();
        let (c, place) = if degrees < 45.0 { (0, 0.04) } else { (1, 0.01) };
        assert!(of_slab.len() > 1 && of_slab.iter().all(|point| point[c] == place), "{degrees}°: {of_slab:?}");
    }
}

/// A disc strikes a block on another one. What is left of disc and lower block, its underside and a side, cannot meet.
#[test]
fn edges_that_other_contacts_leave_may_have_none() {
    let bodies = [
        ("upper", block([0.02, 0.05], [4, 8], [0.0; 2]), [0.0; 2]),
        ("lower", block([0.01, 0.04], [2, 8], [0.008, -0.041]), [0.0, 1.0]),
        ("disc", disc(0.012, [0.033, 0.018]), [-10.0, 0.0]),
    ];
    let found = groups(&bodies);
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found.iter().all(|sides| sides.iter().any(|group| group.starts_with("upper"))), "{found:?}");
}

/// A disc strikes two blocks at once where they meet. Seen from each of them, it is inclined to the other side.
#[test]
fn a_curve_strikes_two_bodies_at_once() {
    let bodies = [
        ("lower", block([0.02, 0.02], [4, 4], [0.0, -0.02]), [0.0; 2]),
        ("upper", block([0.02, 0.02], [4, 4], [0.0, 0.0005]), [0.0; 2]),
        ("disc", disc(0.01, [0.031, 0.0]), [-10.0, 0.0]),
    ];
    let found = groups(&bodies);
    assert_eq!(found[1], ["lower and upper towards disc", "disc towards lower and upper"], "{found:?}");
}
