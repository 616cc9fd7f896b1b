//! Renumbered problems, and the local order.

use crate::solution::run::{aluminium, difference, fixed, run};
use percute_core::border::vectors;
use percute_core::contact::Obstacle;
use percute_core::dynamics::critical_time_step;
use percute_core::ids::{ElementId, NodeId};
use percute_core::load::{BodyForce, Profile, Table, Traction};
use percute_core::material::Elastic;
use percute_core::mesh::{Mesh, Numbering};
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_testkit::{Random, random_rectangle, renumbered};

/// Nodes and elements in random order.
fn shuffle(mesh: &Mesh, seed: u64) -> Numbering {
    let mut random = Random::new(seed);
    let nodes = random.permutation(mesh.node_count()).into_iter().map(NodeId::new).collect();
    Numbering::new(nodes, random.permutation(mesh.element_count()).into_iter().map(ElementId::new).collect())
}

/// The mesh that its points, elements and groups make.
fn rebuilt(mesh: &Mesh) -> Mesh {
    let cells: Vec<_> = mesh.cell_rows().iter().map(|node| node.index()).collect();
    let face = |f: &percute_core::ids::FaceId| mesh.face(*f).nodes.iter().map(|node| node.index());
    let faces = mesh.face_groups().iter().map(|(name, f)| (name.clone(), f.iter().flat_map(face).collect())).collect();
    let elements = mesh.element_groups().iter();
    let elements = elements.map(|(name, e)| (name.clone(), e.iter().map(|e| e.index()).collect())).collect();
    Mesh::from_rows(mesh.dimension(), mesh.points(), &cells, (&faces, &elements)).unwrap()
}

fn assert_same(one: &Mesh, other: &Mesh) {
    assert_eq!((one.points(), one.cell_rows()), (other.points(), other.cell_rows()));
    assert!(one.faces().eq(other.faces()));
    assert!(one.elements().all(|e| one.cell_faces(e) == other.cell_faces(e)));
    assert_eq!((one.face_groups(), one.element_groups()), (other.face_groups(), other.element_groups()));
    assert_eq!((one.size(), one.parts()), (other.size(), other.parts()));
    for node in (0..one.node_count()).map(NodeId::new) {
        let (star, again) = (one.stars().star(node), other.stars().star(node));
        assert_eq!((star.elements, star.links), (again.elements, again.links), "node {node}");
    }
}

/// A rectangle of two materials above a rough plane, held at the left, loaded on top and inside.
fn loaded() -> Problem<2> {
    let mesh = random_rectangle(1.0, 0.7, 8, 5).unwrap();
    let cells: Vec<_> = mesh.nodes_of::<3>().iter().map(|cell| cell.map(NodeId::index)).collect();
    let face = |f: &percute_core::ids::FaceId| mesh.face_nodes::<2>(*f).map(NodeId::index);
    let faces = mesh.face_groups().iter().map(|(name, f)| (name.clone(), f.iter().map(face).collect())).collect();
    let (low, high) = (0..cells.len()).partition(|e| e % 3 == 0);
    let groups = [("low".to_string(), low), ("high".to_string(), high)].into();
    let mesh = Mesh::new(mesh.points_in::<2>().to_vec(), &cells, &faces, &groups).unwrap();
    let pull = Table::new(vec![0.0, 1e-3], vec![[2e6, 3e6], [-2e6, 1e6]]).unwrap();
    let profile = Profile { value: 0.3, gradient: [1.0, 0.0, 0.0] };
    let body = BodyForce { group: Some("low".to_string()), value: Table::constant([1e7, -3e7]) };
    let nodes: Vec<_> = mesh.points_in::<2>().iter().map(|p| [0.0, -50.0 * p[0]]).collect();
    Problem::<2>::builder(mesh)
        .material_of("low", aluminium())
        .material_of("high", Elastic::plane_strain(210e9, 0.25, 7800.0, 1.0).unwrap())
        .initial_velocity(Initial::Nodal(nodes))
        .support(fixed("left", [true, false]))
        .traction(Traction { group: "top".to_string(), value: pull, profile })
        .body_force(body)
        .obstacle(Obstacle::plane([0.0, -4e-4], [0.0, 1.0], 0.3, Some("bottom".to_string())).unwrap())
        .build()
        .unwrap()
}

/// Steps of 0.85 of the critical one.
fn steps<const D: usize>(problem: &Problem<D>, count: usize) -> TimeGrid {
    TimeGrid::uniform(0.85 * critical_time_step(problem) * count as f64, count).unwrap()
}

#[test]
fn a_renumbered_mesh_is_that_of_its_parts() {
    let problem = loaded();
    let image = problem.renumbered(&shuffle(problem.mesh(), 3));
    assert_same(image.mesh(), &rebuilt(image.mesh()));
    let problem = Problem::<1>::builder(Mesh::uniform_bar(1.0, 9).unwrap())
        .material(Elastic::bar(70e9, 2700.0, 0.02).unwrap())
        .build()
        .unwrap();
    let image = problem.renumbered(&shuffle(problem.mesh(), 4));
    assert_same(image.mesh(), &rebuilt(image.mesh()));
}

#[test]
fn what_was_stated_follows_the_numbers() {
    let problem = loaded();
    let numbering = shuffle(problem.mesh(), 7);
    let image = problem.renumbered(&numbering);
    let contact = |p: &Problem<2>, old: &dyn Fn(NodeId) -> NodeId| -> Vec<_> {
        p.surface().nodes().iter().map(|c| (old(c.node), c.undeformed_gap)).collect()
    };
    let old = |node: NodeId| numbering.nodes()[node.index()];
    assert_eq!(contact(&image, &old), contact(&problem, &|node| node));
    for (face, same) in image.surface().faces().iter().zip(problem.surface().faces()) {
        let nodes = image.mesh().face_nodes::<2>(face.face);
        assert_eq!(nodes, face.nodes.map(|at| image.surface().nodes()[at].node));
        assert_eq!((face.area, face.obstacle), (same.area, same.obstacle));
    }
    assert!(image.prescribed().is_sorted_by_key(|p| (p.node, p.component)));
    let mut held: Vec<_> = image.prescribed().iter().map(|p| old(p.node)).collect();
    held.sort_unstable();
    assert_eq!(held, problem.prescribed().iter().map(|p| p.node).collect::<Vec<_>>());
    for (new, &element) in numbering.elements().iter().enumerate() {
        assert_eq!(image.material(ElementId::new(new)), problem.material(element));
        assert_eq!(image.body_force_at(0.0)[new], problem.body_force_at(0.0)[element.index()]);
    }
    let (mut force, mut restored) = (vec![[0.0; 2]; problem.mesh().node_count()], Vec::new());
    image.external_forces(4e-4, &mut force);
    numbering.restore_nodal(force.as_flattened(), &mut restored);
    problem.external_forces(4e-4, &mut force);
    // Sums of two to four forces of up to 1e6 N in another order.
    assert!(difference(&force, vectors(&restored)) < 1e-9);
}

/// Displacements, reactions and energies over 60 steps, to 1e-12 of the largest: rounding that is carried on.
#[test]
fn a_renumbered_problem_has_the_same_solution() {
    let problem = loaded();
    let numbering = shuffle(problem.mesh(), 11);
    let image = problem.renumbered(&numbering);
    let times = steps(&problem, 60);
    let (one, other) = (run(&problem, &times), run(&image, &times));
    let mut restored = Vec::new();
    let mut reactions = 0;
    for n in 0..=one.last() {
        let (step, again) = (one.history.step(n).unwrap(), other.history.step(n).unwrap());
        numbering.restore_nodal(again.displacement, &mut restored);
        assert!(
            difference(step.displacement::<2>(), vectors(&restored)) <= 1e-12 * largest(step.displacement()),
            "step {n}"
        );
        assert!(
            difference(step.reaction::<2>(), again.reaction::<2>()) <= 1e-12 * largest(vectors(one.history.reaction())),
            "step {n}"
        );
        assert_eq!(step.touching, again.touching, "step {n}");
        reactions += step.reaction().iter().filter(|r| **r != [0.0; 2]).count();
    }
    assert!(reactions > 50, "{reactions}");
    let (a, b) = (one.simulation.balance, other.simulation.balance);
    for (a, b) in [(a.kinetic, b.kinetic), (a.strain, b.strain), (a.friction, b.friction)] {
        assert!((a - b).abs() <= 1e-12 * (one.simulation.balance.kinetic + one.simulation.balance.strain), "{a} {b}");
    }
}

fn largest(field: &[[f64; 2]]) -> f64 {
    field.iter().flatten().fold(0.0, |m, x| m.max(x.abs()))
}

/// The largest difference of node numbers in an element, and how far the lowest falls back behind those before.
fn front(mesh: &Mesh) -> (usize, usize) {
    let (mut span, mut back, mut reached) = (0, 0, 0);
    for cell in mesh.cells() {
        let low = cell.iter().map(|n| n.index()).min().unwrap();
        let high = cell.iter().map(|n| n.index()).max().unwrap();
        reached = reached.max(low);
        (span, back) = (span.max(high - low), back.max(reached - low));
    }
    (span, back)
}

/// Small meshes, and meshes in rows, keep their numbers, and with them their bits.
#[test]
fn a_local_order_is_kept() {
    for mesh in [
        Mesh::rectangle(1.0, 0.8, 50, 40).unwrap(),
        Mesh::rectangle(12.0, 1.0, 1200, 80).unwrap(),
        renumbered(&Mesh::rectangle(1.0, 1.0, 15, 15).unwrap(), 1).unwrap().0,
    ] {
        assert!(mesh.local_numbering().is_none());
    }
    assert!(Mesh::uniform_bar(1.0, 500).unwrap().local_numbering().is_none());
}

/// A shuffled square of 40×40 cells: levels are diagonals or rows of at most 41 nodes, and an element spans two of
/// them.
#[test]
fn a_shuffled_mesh_becomes_local() {
    let mesh = Mesh::rectangle(1.0, 1.0, 40, 40).unwrap();
    let (mesh, _) = renumbered(&mesh, 2).unwrap();
    let problem = Problem::<2>::builder(mesh).material(aluminium()).build().unwrap();
    let numbering = problem.mesh().local_numbering().unwrap();
    let mut nodes = numbering.nodes().to_vec();
    nodes.sort_unstable();
    assert!(nodes.iter().enumerate().all(|(i, node)| node.index() == i));
    let image = problem.renumbered(&numbering);
    let (span, back) = front(image.mesh());
    assert!(span <= 82 && back == 0, "{span}, {back}");
    assert!(image.mesh().local_numbering().is_none());
}

/// Parts follow each other, each in one piece.
#[test]
fn parts_are_numbered_one_after_the_other() {
    let left = Mesh::rectangle(1.0, 1.0, 25, 25).unwrap();
    let count = left.node_count();
    let mut points = left.points_in::<2>().to_vec();
    points.extend(left.points_in::<2>().iter().map(|p| [p[0] + 2.0, p[1]]));
    let cells = left.nodes_of::<3>().iter().map(|cell| cell.map(NodeId::index));
    let cells: Vec<_> = cells.clone().chain(cells.map(|cell| cell.map(|n| n + count))).collect();
    let both = Mesh::new(points, &cells, &Default::default(), &Default::default()).unwrap();
    let (both, new) = renumbered(&both, 9).unwrap();
    let numbering = both.local_numbering().unwrap();
    let is_left: Vec<_> = numbering.nodes().iter().map(|node| new.node[..count].contains(&node.index())).collect();
    assert_eq!(is_left.windows(2).filter(|pair| pair[0] != pair[1]).count(), 1);
}
