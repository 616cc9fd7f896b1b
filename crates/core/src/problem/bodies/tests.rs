//! Surfaces that are found are those that a picture of the bodies shows.

mod halves;
mod shifted;
mod turned;

use crate::material::Elastic;
use crate::mesh::Mesh;
use crate::problem::{Between, Builder, Cause, Contact, Initial, Problem};

/// A rectangle of nx by ny cells with its lower left corner at a place, and a velocity.
struct Block {
    name: &'static str,
    size: [f64; 2],
    cells: [usize; 2],
    at: [f64; 2],
    velocity: [f64; 2],
}

fn block(name: &'static str, size: [f64; 2], cells: [usize; 2], at: [f64; 2], velocity: [f64; 2]) -> Block {
    Block { name, size, cells, at, velocity }
}

/// 4 cm wide, 4 by 2 cells.
fn wide(name: &'static str, at: [f64; 2], velocity: [f64; 2]) -> Block {
    block(name, [0.04, 0.02], [4, 2], at, velocity)
}

fn bodies(blocks: &[Block]) -> Builder<2> {
    let mesh = |block: &Block| {
        let ([width, height], [nx, ny]) = (block.size, block.cells);
        Mesh::rectangle(width, height, nx, ny).unwrap().placed(&block.at, 0.0).unwrap()
    };
    let meshes: Vec<_> = blocks.iter().map(|block| (block.name, mesh(block))).collect();
    let velocity = blocks.iter().zip(&meshes).flat_map(|(block, (_, mesh))| vec![block.velocity; mesh.node_count()]);
    let velocity = Initial::Nodal(velocity.collect());
    let joined = Mesh::joined(&meshes.iter().map(|(name, mesh)| (*name, mesh)).collect::<Vec<_>>()).unwrap();
    let law = Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap();
    Problem::<2>::builder(joined).material(law).initial_velocity(velocity).automatic_contact()
}

fn all(friction: f64) -> Contact {
    Contact::new(2, Between::All, friction, None).unwrap()
}

fn of(first: &str, second: &str) -> Contact {
    Contact::new(2, Between::Bodies([first.to_string(), second.to_string()]), 0.3, None).unwrap()
}

/// The groups of all interfaces, and whether they match.
fn found(builder: Builder<2>) -> Vec<(String, String, bool)> {
    let problem = builder.build().unwrap();
    let interfaces = problem.conditions().interfaces.iter().map(|interface| {
        let [first, second] = interface.groups().map(str::to_string);
        (first, second, interface.is_matching())
    });
    interfaces.collect()
}

fn one(first: &str, second: &str, matching: bool) -> Vec<(String, String, bool)> {
    vec![(first.to_string(), second.to_string(), matching)]
}

#[test]
fn two_blocks_touch_at_the_sides_that_meet() {
    let below = || wide("anvil", [0.0, 0.0], [0.0, 0.0]);
    let with = |hammer: Block| found(bodies(&[below(), hammer]).contact(all(0.2)));
    let top = |matching| one("anvil.top", "hammer.bottom", matching);
    assert_eq!(with(wide("hammer", [0.0, 0.021], [1.0, -10.0])), top(true));
    // Too fast aside for nodes to stay in pairs, and nodes that do not face each other.
    assert_eq!(with(wide("hammer", [0.0, 0.021], [100.0, -10.0])), top(false));
    assert_eq!(with(wide("hammer", [0.001, 0.021], [0.0, -10.0])), top(false));
    assert_eq!(with(block("hammer", [0.04, 0.02], [5, 2], [0.0, 0.021], [0.0, -10.0])), top(false));
    // From the right.
    assert_eq!(with(wide("hammer", [0.041, 0.0], [-10.0, 0.0])), one("anvil.right", "hammer.left", true));
    // From above the right side: it is there long before it is down, and touches with its left part.
    let part = one("anvil towards hammer", "hammer towards anvil", false);
    assert_eq!(with(wide("hammer", [0.041, 0.021], [-100.0, -10.0])), part);
    // Bodies at rest may be pushed together by others.
    assert_eq!(with(wide("hammer", [0.0, 0.021], [0.0, 0.0])), top(true));
}

#[test]
fn surfaces_end_beyond_the_other_body() {
    // 3 cm on 16 cm with cells of 1 cm: 3 edges in front, and those on each side that begin within half of the 3 cm.
    let plate = block("plate", [0.16, 0.02], [16, 2], [0.0, 0.0], [0.0, 0.0]);
    let falls = |cells, x, velocity| block("block", [0.03, 0.02], cells, [x, 0.021], velocity);
    let problem = bodies(&[plate, falls([4, 3], 0.07, [0.0, -10.0])]).contact(all(0.2)).build().unwrap();
    let mesh = problem.mesh();
    let edges = |problem: &Problem<2>, group: &str| {
        let faces = problem.mesh().face_groups()[group].iter();
        let mut ends: Vec<f64> = faces
            .flat_map(|f| problem.mesh().face_nodes::<2>(*f))
            .map(|n| mesh.points_in::<2>()[n.index()][0])
            .collect();
        ends.sort_by(f64::total_cmp);
        (ends[0], ends[ends.len() - 1])
    };
    let (first, last) = edges(&problem, "plate towards block");
    assert!((first - 0.05).abs() < 1e-12 && (last - 0.12).abs() < 1e-12, "{first} {last}");
    assert_eq!(problem.conditions().interfaces[0].groups(), ["plate towards block", "block.bottom"]);
    // Where nodes face each other in pairs, only they are in it.
    let plate = block("plate", [0.16, 0.02], [16, 2], [0.0, 0.0], [0.0, 0.0]);
    let problem = bodies(&[plate, falls([3, 2], 0.07, [0.0, -10.0])]).contact(all(0.2)).build().unwrap();
    let (first, last) = edges(&problem, "plate facing block");
    assert!((first - 0.07).abs() < 1e-12 && (last - 0.10).abs() < 1e-12, "{first} {last}");
    assert!(!problem.mesh().face_groups().contains_key("plate towards block"));
}

#[test]
fn a_stack_has_no_contact_through_a_body() {
    let stack = |upper: [f64; 2]| {
        let at = |k: usize| [0.0, 0.021 * k as f64];
        bodies(&[wide("a", at(0), [0.0; 2]), wide("b", at(1), [0.0; 2]), wide("c", at(2), upper)]).contact(all(0.2))
    };
    let pairs =
        vec![("a.top".to_string(), "b.bottom".to_string(), true), ("b.top".to_string(), "c.bottom".to_string(), true)];
    assert_eq!(found(stack([0.0, -10.0])), pairs);
    assert_eq!(found(stack([0.0, 10.0])), pairs);
    // A small block between two wide ones: these see each other beside it.
    let small = block("b", [0.01, 0.02], [1, 2], [0.02, 0.021], [0.0; 2]);
    let around = found(
        bodies(&[wide("a", [0.0, 0.0], [0.0; 2]), small, wide("c", [0.0, 0.042], [0.0, -10.0])]).contact(all(0.2)),
    );
    let names: Vec<_> = around.iter().map(|(first, second, _)| (first.as_str(), second.as_str())).collect();
    assert_eq!(names, [("a facing b", "b.bottom"), ("a facing c", "c facing a"), ("b.top", "c facing b")]);
}

#[test]
fn a_named_contact_has_its_own_friction() {
    let at = |k: usize| [0.0, 0.021 * k as f64];
    let blocks = [wide("a", at(0), [0.0; 2]), wide("b", at(1), [0.0; 2]), wide("c", at(2), [0.0, -1.0])];
    let problem = bodies(&blocks).contact(all(0.1)).contact(of("c", "b")).build().unwrap();
    let stated: Vec<_> = problem.conditions().interfaces.iter().map(|i| (i.groups(), i.law().friction())).collect();
    assert_eq!(stated, [(["c.bottom", "b.top"], 0.3), (["a.top", "b.bottom"], 0.1)]);
    let places: Vec<_> = [0, 2].map(|obstacle| problem.place_of_obstacle(obstacle)).to_vec();
    assert_eq!((places[0].index, places[0].key, places[1].index, places[1].key), (Some(1), "bodies", Some(0), ""));
    // The same problem again from the surfaces that were found.
    let again = problem
        .conditions()
        .interfaces
        .iter()
        .fold(Problem::<2>::builder(problem.mesh().clone()), |b, i| b.interface(i.clone()));
    let again =
        again.material(problem.materials()[0]).initial_velocity(Initial::Nodal(problem.initial_velocity().to_vec()));
    assert_eq!(again.build().unwrap().surface().nodes(), problem.surface().nodes());
}

#[test]
fn what_cannot_be_found_is_an_error() {
    let at = |k: usize| [0.0, 0.021 * k as f64];
    let stack = || bodies(&[wide("a", at(0), [0.0; 2]), wide("b", at(1), [0.0; 2]), wide("c", at(2), [0.0, -1.0])]);
    let cause = |builder: Builder<2>| builder.build().unwrap_err().cause;
    let pair = |a: &str, b: &str| [a.to_string(), b.to_string()];
    assert_eq!(cause(stack()), Cause::NoFriction { bodies: pair("a", "b") });
    assert_eq!(cause(stack().contact(all(0.2)).contact(all(0.1))), Cause::TwoDefaults);
    assert_eq!(cause(stack().contact(of("a", "c"))), Cause::NothingSees { bodies: pair("a", "c") });
    assert_eq!(cause(stack().contact(of("a", "a"))), Cause::OneBody { name: "a".into() });
    assert_eq!(cause(stack().contact(of("a", "b")).contact(of("b", "a"))), Cause::SamePair { bodies: pair("b", "a") });
    let unknown = cause(stack().contact(of("a", "d")));
    assert!(matches!(unknown, Cause::UnknownBody { name, known } if name == "d" && known == ["a", "b", "c"]));
    // A block that strikes another one and one beside that: a corner would touch both.
    let corner = [
        wide("a", [0.0, 0.0], [0.0; 2]),
        wide("b", [0.041, 0.0], [-1.0, 0.0]),
        wide("c", [0.0205, 0.021], [0.0, -1.0]),
    ];
    assert!(matches!(cause(bodies(&corner).contact(all(0.2))), Cause::Contested { .. }));
}

/// The bottom of a block faces the tops of two others: one interface.
#[test]
fn a_block_on_two_blocks_has_one_interface() {
    let blocks = |gap: f64| {
        [
            wide("a", [0.0, 0.0], [0.0; 2]),
            wide("b", [0.041, 0.0], [0.0; 2]),
            wide("c", [0.0205, 0.02 + gap], [0.0, -1.0]),
        ]
    };
    let expected = |problem: &Problem<2>| {
        let interfaces: Vec<_> = problem.conditions().interfaces.iter().map(|interface| interface.groups()).collect();
        assert_eq!(interfaces, [["a facing b", "b facing a"], ["a and b towards c", "c.bottom"]]);
        let non_matching = &problem.surface().non_matching()[0];
        assert_eq!((non_matching.slave().parts().len(), non_matching.master().len()), (2, 5));
    };
    // Far away, too; the sides of the lower ones see each other, but for the edges at their corners.
    for gap in [1e-4, 0.01] {
        let problem = bodies(&blocks(gap)).contact(all(0.2)).build().unwrap();
        expected(&problem);
    }
    let problem = bodies(&blocks(1e-4)).contact(of("c", "a")).contact(of("c", "b")).contact(all(0.2));
    let problem = problem.build().unwrap();
    let interface = &problem.conditions().interfaces[0];
    assert_eq!(interface.groups(), ["c.bottom", "a and b towards c"]);
    let groups = |second: &str, friction: f64| {
        let groups = Between::Groups(["c.bottom".to_string(), second.to_string()]);
        Contact::new(2, groups, friction, None).unwrap()
    };
    let stated = bodies(&blocks(1e-4)).contact(groups("a.top", 0.2)).contact(groups("b.top", 0.2)).contact(all(0.2));
    let stated = stated.build().unwrap();
    assert_eq!(stated.conditions().interfaces[0].groups(), ["c.bottom", "a.top and b.top"]);
    let differ = bodies(&blocks(1e-4)).contact(groups("a.top", 0.2)).contact(groups("b.top", 0.1)).contact(all(0.2));
    let error = differ.build().unwrap_err();
    assert_eq!((error.place.index, matches!(error.cause, Cause::FrictionsDiffer { .. })), (Some(1), true));
}
