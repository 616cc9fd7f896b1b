//! What is found does not depend on the place of the origin.

use super::{Block, all, block, bodies};
use crate::problem::Problem;

/// The decimal number that users write.
fn decimal(x: f64) -> f64 {
    format!("{x:.7}").parse().unwrap()
}

/// The groups of all interfaces with their faces, for blocks that are all moved so far (m).
fn found(blocks: &[Block], by: [f64; 2]) -> Vec<(String, Vec<usize>)> {
    let moved = |one: &Block| Block { at: [one.at[0] + by[0], one.at[1] + by[1]], ..*one };
    let problem: Problem<2> = bodies(&blocks.iter().map(moved).collect::<Vec<_>>()).contact(all(0.2)).build().unwrap();
    let groups = problem.conditions().interfaces.iter().flat_map(|interface| interface.groups().map(str::to_string));
    let faces = |name: &String| problem.mesh().face_groups()[name].iter().map(|face| face.index()).collect();
    groups.map(|name| (name.clone(), faces(&name))).collect()
}

/// A small block strikes a wide one from below, from above, from the left or from the right.
#[test]
fn rectangles_find_the_same_contact_anywhere() {
    for (side, gap) in [0.01, 0.012, 0.02, 0.03].into_iter().flat_map(|side| [1e-5, 2e-5, 1e-4].map(|gap| (side, gap)))
    {
        for along in [-0.005, 0.0, 0.005, 0.013] {
            let strikes = |at: [f64; 2], velocity| {
                let a = block("a", [0.04, 0.02], [16, 8], [0.0; 2], [0.0; 2]);
                let blocks = [a, block("b", [side; 2], [8, 8], at.map(decimal), velocity)];
                let at_origin = found(&blocks, [0.0; 2]);
                assert_eq!(at_origin.len(), 2, "{at:?}, {side}");
                for by in [[1.0, 0.0], [0.0, 1.0], [-1.0, 1.0]] {
                    assert_eq!(found(&blocks, by), at_origin, "{at:?}, {side} moved by {by:?}");
                }
            };
            strikes([along, -side - gap], [0.0, 20.0]);
            strikes([along, 0.02 + gap], [0.0, -20.0]);
            strikes([-side - gap, along], [20.0, 0.0]);
            strikes([0.04 + gap, along], [-20.0, 0.0]);
        }
    }
}
