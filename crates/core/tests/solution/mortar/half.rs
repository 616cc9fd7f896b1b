//! Half of a symmetric model.

use super::setup::steps;
use crate::solution::run::{aluminium, largest, run};
use percute_core::contact::{Interface, Status};
use percute_core::contact_results::ContactRecorder;
use percute_core::dynamics::{missed_contact, simulate};
use percute_core::ids::NodeId;
use percute_core::load::{Profile, Support, Table, Traction};
use percute_core::mesh::Mesh;
use percute_core::observer::Unobserved;
use percute_core::problem::{Between, Builder, Contact, Initial, Problem, plausibility_warnings};
use percute_testkit::{Roof, translated};
use std::collections::BTreeMap;

/// Drives far sides of the roof inwards, from the speed of all (m/s) up to another one within 5 µs.
fn driven(builder: Builder<2>, sides: &[(&str, f64)], [along, speed]: [f64; 2]) -> Builder<2> {
    sides.iter().filter(|_| speed != 0.0).fold(builder, |builder, (group, sign)| {
        let speeds = [0.0, 1.0, 1.0].map(|part| [along + sign * part * speed, 0.0]);
        let velocity = Some(Table::new(vec![0.0, 5e-6, 1.0], speeds.to_vec()).unwrap());
        builder.support(Support { group: group.to_string(), components: [true, false, false], velocity })
    })
}

/// Both bodies widen by Poisson's ratio, each in its own way. Half of the model, held at its middle, moves as the whole
/// one: with a ridge or a valley, driven or not, in any frame.
#[test]
fn half_of_a_symmetric_model_moves_as_the_whole() {
    let cases = [
        (0.0, 0.03, [5, 7], [0.0, 0.0]),
        (3.0, 0.03, [5, 7], [0.0, 0.0]),
        (10.0, 0.03, [6, 5], [0.0, 0.0]),
        (10.0, 0.03, [5, 7], [0.0, 20.0]),
        (10.0, 0.03, [5, 7], [10.0, 0.0]),
        (10.0, 0.03, [5, 7], [10.0, 20.0]),
        (-3.0, 0.02, [6, 9], [0.0, 0.0]),
        (3.0, 0.016, [6, 9], [0.0, 0.0]),
        (-3.0, 0.016, [6, 7], [0.0, 0.0]),
    ];
    for (angle, plate, cells, [along, speed]) in cases {
        let roof = Roof::new(angle, 20.0, plate, cells).unwrap().moving(along);
        let [right, left] = [("roof.right", -1.0), ("roof.left", 1.0)];
        let whole_problem = driven(roof.whole().unwrap(), &[right, left], [along, speed]).build().unwrap();
        let half_problem = driven(roof.half().unwrap(), &[right], [along, speed]).build().unwrap();
        let times = steps(&whole_problem, 20e-6);
        let [whole_run, half_run] = [run(&whole_problem, &times), run(&half_problem, &times)];
        for n in 0..=whole_run.last() {
            let [expected, found] = [whole_run.displacement(n), half_run.displacement(n)];
            let apart = found.iter().enumerate().map(|(node, u)| {
                let expected = expected[roof.in_whole(node)];
                (u[0] - expected[0]).abs().max((u[1] - expected[1]).abs())
            });
            // Rounding that slipping and sticking nodes let grow.
            let apart = apart.fold(0.0, f64::max);
            assert!(apart <= 1e-11 * largest(expected), "{angle}°, {along} m/s, step {n}: {apart}");
        }
        let contact = half_run.simulation.balance.work_of_contact;
        assert!(contact.abs() > 0.0, "{angle}°: {contact}");
    }
}

/// Both halves of a non-matching interface touch with twice the area of those of the half. Nodes with the rounding of
/// sums of both signs do not count.
#[test]
fn half_of_a_symmetric_model_has_half_of_the_area() {
    for (angle, speed, cells) in [(5.0, 20.0, [5, 7]), (40.0, 2.0, [6, 7]), (40.0, 20.0, [6, 7])] {
        let roof = Roof::new(angle, speed, 0.02, cells).unwrap();
        let [whole, half] = [roof.whole(), roof.half()].map(|builder| builder.unwrap().build().unwrap());
        let times = steps(&whole, 10e-6);
        let [whole, half] = [&whole, &half].map(|problem| {
            let run = run(problem, &times);
            ContactRecorder::new(problem, &times).replay(&run.history).unwrap()
        });
        for (side, (whole, half)) in whole.obstacles.iter().zip(&half.obstacles).enumerate() {
            assert!(whole.iter().any(|resultant| resultant.in_contact > 0));
            for (n, (whole, half)) in whole.iter().zip(half).enumerate() {
                // Rounding of lengths.
                let apart = (whole.area - 2.0 * half.area).abs();
                assert!(apart <= 1e-12, "{angle}° at {speed} m/s, side {side}, step {n}: {} {}", whole.area, half.area);
            }
        }
    }
}

/// Of a block of 20 mm on a wider plate, which nodes of the plate are in contact by their forces agrees with which of
/// them touch at the next instant: the block widens and passes some by the rounding of their places.
#[test]
fn nodes_in_contact_touch() {
    let plate = Mesh::rectangle(0.04, 0.01, 40, 2).unwrap();
    let block = translated(&Mesh::rectangle(0.02, 0.01, 17, 2).unwrap(), [0.01, 0.01001]).unwrap();
    let mesh = Mesh::joined(&[("plate", &plate), ("block", &block)]).unwrap();
    let velocity = |node: usize| [0.0, if node < plate.node_count() { 0.0 } else { -20.0 }];
    let velocity = Initial::Nodal((0..mesh.node_count()).map(velocity).collect());
    let problem = Problem::<2>::builder(mesh)
        .material(aluminium())
        .initial_velocity(velocity)
        .interface(Interface::non_matching(2, "block.bottom", "plate.top", 0.2).unwrap())
        .build()
        .unwrap();
    let times = steps(&problem, 8e-6);
    let run = run(&problem, &times);
    let recorder = ContactRecorder::new(&problem, &times).keeping_steps().unwrap();
    let results = recorder.replay(&run.history).unwrap();
    let (status, count) = (results.steps.unwrap().status, results.nodes.len());
    let mut touches = 0;
    for n in 0..run.last() {
        let touching = run.history.step(n + 1).unwrap().touching;
        for at in (0..count).filter(|&at| status[n * count + at] != Status::Free) {
            assert!(touching[at], "{:?}, step {n}", results.nodes[at].point);
            touches += 1;
        }
    }
    assert!(touches > 200);
}

/// Of a model turned by right angles, the line of symmetry is through the origin with the rounding of a cosine.
#[test]
fn lines_of_symmetry_are_found_beside_rounding() {
    let roof = Roof::new(5.0, 20.0, 0.03, [5, 7]).unwrap();
    for quarters in 0..4 {
        let problem = roof.clone().turned(quarters).half().unwrap().build().unwrap();
        let on_line = problem.on_lines_of_symmetry().iter().filter(|on_line| **on_line).count();
        assert_eq!(on_line, 2, "{quarters} right angles");
    }
}

/// A block of 5 by 2 cells, 20 mm wide, with its lowest side at a height; its lower side rises to the right.
fn block(height: f64, rise: f64) -> Mesh {
    let mesh = Mesh::rectangle(0.02, 0.01, 5, 2).unwrap();
    mesh.mapped(|p| [p[0], p[1] + height + rise * p[0]]).unwrap()
}

/// Two bodies of which the second one comes down at 20 m/s, with supports.
fn falling(lower: &Mesh, upper: &Mesh, supports: &[(&str, [bool; 2])]) -> Builder<2> {
    let mesh = Mesh::joined(&[("lower", lower), ("upper", upper)]).unwrap();
    let velocity = [vec![[0.0; 2]; lower.node_count()], vec![[0.0, -20.0]; upper.node_count()]].concat();
    let builder = Problem::<2>::builder(mesh).material(aluminium()).initial_velocity(Initial::Nodal(velocity));
    supports.iter().fold(builder, |builder, (group, components)| {
        builder.support(Support {
            group: group.to_string(),
            components: [components[0], components[1], false],
            velocity: None,
        })
    })
}

/// A tip on a line of symmetry, on either side of it and on either of two, enters a body without contact with it: the
/// run ends when it is deeper than a tenth of an element. The line may move with a velocity that changes.
#[test]
fn a_tip_on_a_line_of_symmetry_is_missed() {
    let lines: [(&[&str], f64); 3] = [(&["left"], 0.0), (&["left", "right"], 0.0), (&["left"], 1.0)];
    for ((lines, speed), mirrored) in lines.into_iter().flat_map(|lines| [(lines, false), (lines, true)]) {
        let [lower, upper] = [block(-0.01, 0.0), block(1e-5, 0.8)]
            .map(|mesh| if mirrored { percute_testkit::mirrored(&mesh).unwrap() } else { mesh });
        let velocity = (speed > 0.0).then(|| Table::new(vec![0.0, 1e-4], vec![[0.0; 2], [speed, 0.0]]).unwrap());
        // Groups keep their names in the image.
        let groups = lines.iter().flat_map(|line| ["lower", "upper"].map(|body| format!("{body}.{line}")));
        let held = groups.fold(falling(&lower, &upper, &[]), |builder, group| {
            builder.support(Support { group, components: [true, false, false], velocity: velocity.clone() })
        });
        let problem = held.build().unwrap();
        let times = steps(&problem, 60e-6);
        let mut missed = missed_contact(&problem, times.step_count());
        let run = simulate(&problem, &times, &mut missed, &mut Unobserved);
        let error = run.err().map(|error| error.to_string()).unwrap_or_default();
        // The other nodes of the upper body are 3 mm higher, and the bodies move by 1.2 mm.
        assert!(error.contains(" m inside "), "{lines:?}, {speed} m/s, {mirrored}: {error}");
    }
}

/// The normal of automatic contact of a problem, and the names of its warnings.
fn found(builder: Builder<2>) -> ([f64; 2], Vec<&'static str>) {
    let contact = Contact::new(2, Between::All, 0.2, None).unwrap();
    let problem = builder.automatic_contact().contact(contact).build().unwrap();
    let warnings = plausibility_warnings(&problem, &steps(&problem, 20e-6));
    (*problem.obstacles()[0].flat_frame().normal(), warnings.iter().map(|warning| warning.name).collect())
}

/// A support that moves along the line of symmetry with a changing velocity leaves it one: of a plate that is one cell
/// high, it holds a node of the only edge on the line.
#[test]
fn halves_may_be_driven_along_their_line() {
    for rows in [1, 2] {
        let lower = block(-0.01, 0.0).mapped(|p| [p[0], p[1] - 10.0 * (p[1] + 0.01) * p[0]]).unwrap();
        let plate = Mesh::rectangle(0.02, 0.004, 8, rows).unwrap();
        let upper = plate.mapped(|p| [p[0], p[1] + 1e-5 + 0.1 * p[0] * (1.0 - p[1] / 0.004)]).unwrap();
        let velocity = Table::new(vec![0.0, 1e-5, 1.0], vec![[0.0, -20.0], [0.0, -25.0], [0.0, -25.0]]).unwrap();
        let press =
            Support { group: "upper.top".to_string(), components: [false, true, false], velocity: Some(velocity) };
        let held = ["lower.left", "upper.left"].map(|group| (group, [true, false]));
        let (normal, warnings) = found(falling(&lower, &upper, &held).support(press));
        assert!(normal[0] == 0.0 && !warnings.contains(&"edge_excluded"), "{rows}: {normal:?} {warnings:?}");
    }
}

/// A side that a support clamps is the end of a body: what has entered there by less than a tenth of an element is not
/// missed.
#[test]
fn a_clamped_side_is_the_end_of_a_body() {
    let problem = falling(&block(-0.01, 0.0), &block(1e-5, 0.0), &[("lower.top", [true, true])]).build().unwrap();
    let ends = |end: f64| {
        let times = steps(&problem, end);
        let mut missed = missed_contact(&problem, times.step_count());
        simulate(&problem, &times, &mut missed, &mut Unobserved).is_err()
    };
    // By 0.2 and by 0.8 mm into cells of 5 mm.
    assert!(!ends(10e-6) && ends(40e-6));
}

/// An edge next to a support across the contact has none, and percute warns where the other body faces it, unless the
/// user took it out: by a traction on it, or by names of other edges.
#[test]
fn an_edge_beside_a_support_is_left_out() {
    let lower = Mesh::rectangle(0.045, 0.01, 9, 2).unwrap();
    let cells: Vec<_> = lower.nodes_of::<3>().iter().map(|nodes| nodes.map(NodeId::index)).collect();
    let top: Vec<_> = (20..29).map(|first| [first, first + 1]).collect();
    let groups = [("left", vec![[0, 10], [10, 20]]), ("first", top[..1].to_vec()), ("others", top[1..].to_vec())];
    let groups = groups.map(|(name, edges)| (name.to_string(), edges)).into();
    let lower = Mesh::new(lower.points_in::<2>().to_vec(), &cells, &groups, &BTreeMap::new()).unwrap();
    let bodies = |wide: f64, components: [bool; 2]| {
        let upper = block(0.01001, 0.0).mapped(|p| [p[0] + wide, p[1]]).unwrap();
        falling(&lower, &upper, &[("lower.left", components)])
    };
    let warns = |builder| found(builder).1.contains(&"edge_excluded");
    assert!(warns(bodies(0.0, [true, true])) && warns(bodies(0.002, [false, true])));
    // Beside the edge, which is 5 mm long, and with a support along the surface alone.
    assert!(!warns(bodies(0.005, [true, true])) && !warns(bodies(0.0, [true, false])));
    let value = Table::constant([0.0, -1e5]);
    let traction = Traction { group: "lower.first".to_string(), value, profile: Profile::UNIFORM };
    assert!(!warns(bodies(0.0, [true, true]).traction(traction)));
    let groups = Between::Groups(["lower.others", "upper.bottom"].map(str::to_string));
    let named = bodies(0.0, [true, true]).contact(Contact::new(2, groups, 0.2, None).unwrap()).build().unwrap();
    assert!(plausibility_warnings(&named, &steps(&named, 20e-6)).iter().all(|warning| warning.name != "edge_excluded"));
}
