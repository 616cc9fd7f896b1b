//! Bodies that are beside or behind each other are told from those that overlap.

use percute_core::contact::Interface;
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::{Cause, Initial, Problem};

/// Two blocks of 40 × 20 mm, the second one at a place and displaced, with contact of two groups.
fn stated(at: [f64; 2], displaced: [f64; 2], groups: [&str; 2]) -> Option<Cause> {
    let block = |at: &[f64; 2]| Mesh::rectangle(0.04, 0.02, 4, 2).unwrap().placed(at, 0.0).unwrap();
    let meshes = [block(&[0.0; 2]), block(&at)];
    let joined = Mesh::joined(&[("a", &meshes[0]), ("b", &meshes[1])]).unwrap();
    let displacement = [[0.0; 2], displaced].into_iter().zip(&meshes).flat_map(|(u, mesh)| vec![u; mesh.node_count()]);
    let displacement = Initial::Nodal(displacement.collect());
    let law = Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap();
    let interface = Interface::non_matching(2, groups[0], groups[1], 0.2).unwrap();
    let builder = Problem::<2>::builder(joined).material(law).initial_displacement(displacement).interface(interface);
    builder.build().err().map(|error| error.cause)
}

#[test]
fn bodies_beside_each_other_do_not_overlap() {
    // The underside of the second one is 5 mm lower than the upper side of the first one, beside it.
    let cause = stated([0.05, 0.015], [0.0; 2], ["a.top", "b.bottom"]).unwrap();
    let text = cause.to_string();
    let Cause::BehindSurface { node, depth, groups, normal } = cause else { panic!("{text}") };
    let of_second = 5 * 3;
    let (own, other) = if node < of_second { ("a.top", "b.bottom") } else { ("b.bottom", "a.top") };
    assert_eq!(*groups, [own, other]);
    assert!((depth - 0.005).abs() < 1e-12 && normal[0] == 0.0 && normal[1].abs() == 1.0, "{text}");
    assert!(text.contains("0.005 m") && text.contains("groups") && !text.contains("overlap"), "{text}");
    // Higher than it, or with the sides that meet.
    assert_eq!(stated([0.05, 0.0205], [0.0; 2], ["a.top", "b.bottom"]), None);
    assert_eq!(stated([0.05, 0.015], [0.0; 2], ["a.right", "b.left"]), None);
    // Displaced into the first one, from beside and from above, 1 mm deep.
    let cause = stated([0.05, 0.015], [-0.011, 0.0], ["a.right", "b.left"]);
    assert!(matches!(cause, Some(Cause::Overlaps { depth, .. }) if (depth - 0.001).abs() < 1e-12), "{cause:?}");
    let cause = stated([0.05, 0.015], [-0.011, 0.0], ["a.top", "b.bottom"]);
    assert!(matches!(cause, Some(Cause::Overlaps { depth, .. }) if (depth - 0.005).abs() < 1e-12), "{cause:?}");
}

/// Groups on the sides that look away from each other.
#[test]
fn surfaces_on_the_far_sides_do_not_overlap() {
    let cause = stated([0.001, 0.021], [0.0; 2], ["a.bottom", "b.top"]);
    let Some(Cause::BehindSurface { depth, .. }) = cause else { panic!("{cause:?}") };
    assert!((depth - 0.041).abs() < 1e-12, "{depth}");
}

/// Neither of the surfaces that are named is where the bodies overlap.
#[test]
fn elements_overlap_beside_the_contact() {
    let cause = stated([0.05, 0.015], [-0.011, 0.0], ["a.bottom", "b.top"]);
    let Some(Cause::ElementsOverlap { elements: [first, second] }) = cause else { panic!("{cause:?}") };
    assert!(first < 16 && second >= 16, "{first} {second}");
}
