//! Which of two surfaces is the slave does not depend on the order of the bodies.

use super::setup::steel;
use crate::solution::run::aluminium;
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::{Between, Contact, Initial, Problem};
use percute_testkit::rotated;

/// A block: its name, place, height and material.
#[derive(Clone, Copy)]
struct Block(&'static str, [f64; 2], f64, Elastic);

/// The body of the slave of two blocks of 20 mm in this order, turned by an angle (degrees).
fn slave(blocks: [Block; 2], degrees: f64) -> String {
    let mesh = |Block(_, at, height, _): &Block| Mesh::rectangle(0.02, *height, 6, 6).unwrap().placed(at, 0.0).unwrap();
    let meshes = blocks.each_ref().map(mesh);
    let joined = Mesh::joined(&[(blocks[0].0, &meshes[0]), (blocks[1].0, &meshes[1])]).unwrap();
    let (sin, cos) = degrees.to_radians().sin_cos();
    let falls = |block: &Block| if block.1[1] > 0.0 { [20.0 * sin, -20.0 * cos] } else { [0.0; 2] };
    let velocity = (0..2).flat_map(|k| vec![falls(&blocks[k]); meshes[k].node_count()]).collect();
    let problem = Problem::<2>::builder(rotated(&joined, degrees.to_radians()).unwrap())
        .material_of(blocks[0].0, blocks[0].3)
        .material_of(blocks[1].0, blocks[1].3)
        .initial_velocity(Initial::Nodal(velocity))
        .automatic_contact()
        .contact(Contact::new(2, Between::All, 0.2, None).unwrap())
        .build()
        .unwrap();
    let non_matching = &problem.surface().non_matching()[0];
    let node = problem.surface().nodes()[non_matching.slave().position(0)].node.index();
    blocks[usize::from(node >= meshes[0].node_count())].0.to_string()
}

#[test]
fn the_order_of_the_bodies_does_not_choose_the_slave() {
    let light = Elastic::plane_stress(70e9, 0.3, 1000.0, 1.0).unwrap();
    let below = |height: f64, material| Block("below", [0.0, -height], height, material);
    let above = |height: f64, material| Block("above", [0.001, 0.0001], height, material);
    let chosen = |one: Block, other: Block| {
        let slaves = [0.0, 30.0, 75.0].map(|degrees| [slave([one, other], degrees), slave([other, one], degrees)]);
        let first = slaves[0][0].clone();
        assert!(slaves.iter().flatten().all(|slave| *slave == first), "{slaves:?}");
        first
    };
    // The softer one, the lighter one, and of equal bodies one that the place shows.
    assert_eq!(chosen(below(0.02, aluminium()), above(0.02, steel())), "below");
    assert_eq!(chosen(below(0.02, steel()), above(0.02, aluminium())), "above");
    assert_eq!(chosen(below(0.02, aluminium()), above(0.02, light)), "above");
    assert_eq!(chosen(below(0.02, light), above(0.02, aluminium())), "below");
    assert_eq!(chosen(below(0.02, aluminium()), above(0.01, aluminium())), "above");
    chosen(below(0.02, aluminium()), above(0.02, aluminium()));
}
