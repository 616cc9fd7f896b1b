//! Contact results against exact solutions, the contact law and the balances.

use crate::solution::run::{Run, aluminium, fixed, run, swinging_steps};
use percute_core::border::vectors;
use percute_core::contact::Obstacle;
use percute_core::contact::Status;
use percute_core::contact_results::{ContactRecorder, ContactResults, ContactSteps};
use percute_core::dynamics::critical_time_step;
use percute_core::history::StepSource;
use percute_core::material::Elastic;
use percute_core::mesh::{ElementGroups, Mesh};
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_exact::BarImpact;
use percute_testkit::{disc, mirrored, random_rectangle, rotated};

/// Speeds below this (m/s) are rounding: u differences of 1e-16 · 1e-2 m over steps of 1e-7 s.
const STILL: f64 = 1e-9;
/// Distance from the plane at the start (m).
const GAP: f64 = 2.7e-4;

/// The contact results of a run, with all nodes at all instants.
fn results<const D: usize>(run: &Run<'_, D>) -> ContactResults {
    ContactRecorder::new(run.problem, run.history.times()).keeping_steps().unwrap().replay(&run.history).unwrap()
}

fn steps(results: &ContactResults) -> &ContactSteps {
    results.steps.as_ref().unwrap()
}

fn thrown(mesh: Mesh, velocity: [f64; 2], friction: f64) -> Problem<2> {
    let lowest = mesh.points_in::<2>().iter().fold(f64::INFINITY, |m, p| m.min(p[1]));
    Problem::<2>::builder(mesh)
        .material(aluminium())
        .initial_velocity(Initial::Uniform(velocity))
        .obstacle(Obstacle::plane([0.0, lowest - GAP], [0.0, 1.0], friction, None).unwrap())
        .build()
        .unwrap()
}

fn equal_steps(problem: &Problem<2>, count: usize) -> TimeGrid {
    TimeGrid::uniform(0.9 * critical_time_step(problem) * count as f64, count).unwrap()
}

/// At a Courant number of 1 the scheme gives d'Alembert's solution at the nodes (see `bar_impact`): after half of
/// it at first the force is ρScv₀, for 2L/c in all.
#[test]
fn the_exact_bar_is_pressed_by_rho_c_v_for_two_transits() {
    const ELEMENTS: usize = 20;
    let mut exact = BarImpact { length: 0.1, young: 70e9, density: 2700.0, section: 0.02, speed: 400.0, gap: 0.0 };
    let (speed_of_waves, dt) = (exact.wave_speed(), exact.length / ELEMENTS as f64 / exact.wave_speed());
    exact.gap = 3.0 * dt * exact.speed;
    let problem = Problem::<1>::builder(Mesh::uniform_bar(exact.length, ELEMENTS).unwrap())
        .material(Elastic::bar(exact.young, exact.density, exact.section).unwrap())
        .initial_velocity(Initial::Uniform([-exact.speed]))
        .obstacle(Obstacle::plane([-exact.gap], [1.0], 0.0, None).unwrap())
        .build()
        .unwrap();
    let (count, release) = (53, 3 + 2 * ELEMENTS);
    let run = run(&problem, &TimeGrid::uniform(53.0 * dt, count).unwrap());
    let results = results(&run);
    // Forces are stiffness times differences of displacements: their rounding is some 1e-16 v₀t/(v₀Δt).
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-11 * b.abs();

    let plateau = exact.density * speed_of_waves * exact.speed * exact.section;
    for (n, total) in results.total.iter().enumerate() {
        let pushed = (3..release).contains(&n);
        assert_eq!((total.in_contact, total.slipping), (usize::from(pushed), usize::from(pushed)), "step {n}");
        let expected = if n == 3 { 0.5 * plateau } else { f64::from(u8::from(pushed)) * plateau };
        assert!((total.normal_force - expected).abs() <= 1e-11 * plateau, "step {n}: {}", total.normal_force);
        assert_eq!(total.area, if pushed { exact.section } else { 0.0 });
        // The end of the bar, which is on the plane from step 4 on.
        if n > 3 && n < release {
            assert!(near(total.centre.unwrap()[0], -exact.gap), "step {n}: {:?}", total.centre);
            assert!(steps(&results).gap[n].abs() < problem.contact_tolerance() + 1e-15 * exact.length, "step {n}");
        }
    }
    let node = results.summary[0];
    assert!(near(node.first_touch.unwrap(), 4.0 * dt));
    assert!(near(node.time_in_contact, 2.0 * exact.length / speed_of_waves), "{}", node.time_in_contact);
    assert!(
        near(node.peak_normal_force, plateau) && near(results.total[results.peak().unwrap()].normal_force, plateau)
    );
    assert!(near(node.peak_pressure, exact.density * speed_of_waves * exact.speed));
    assert!(near(node.impulse[0], plateau * dt * (2.0 * ELEMENTS as f64 - 0.5)), "{}", node.impulse[0]);
    assert_eq!((node.friction_energy, node.impulse), (0.0, results.total[count].impulse));
}

/// The stress of the impact is ρcv. The raw force is that only with steps of its element, and the larger, the shorter
/// they are: also where a short element far from the contact makes them short.
#[test]
fn the_averaged_force_of_a_bar_is_rho_c_v_for_any_step() {
    let law = Elastic::bar(70e9, 2700.0, 0.02).unwrap();
    let wave_speed = (70e9_f64 / 2700.0).sqrt();
    let plateau = 0.02 * 2700.0 * wave_speed * 50.0;
    let even: Vec<[f64; 1]> = (0..=40).map(|i| [0.1 * f64::from(i) / 40.0]).collect();
    let mut short = even.clone();
    short.push([0.1 + 1e-6]);
    for (points, courant, [least, most]) in [
        (&even, 1.0, [0.999, 1.001]),
        // Behind the front of short steps, the lumped mass oscillates.
        (&even, 0.5, [1.0, 1.3]),
        (&even, 0.1, [1.0, 1.3]),
        (&even, 0.02, [1.0, 1.3]),
        (&short, 0.9, [1.0, 1.3]),
    ] {
        let cells: Vec<_> = (1..points.len()).map(|i| [i - 1, i]).collect();
        let groups = [("start".to_string(), vec![[0]])].into();
        let mesh = Mesh::new(points.clone(), &cells, &groups, &ElementGroups::new()).unwrap();
        let free = Problem::<1>::builder(mesh.clone()).material(law).build().unwrap();
        let dt = courant * critical_time_step(&free);
        let problem = Problem::<1>::builder(mesh)
            .material(law)
            .initial_velocity(Initial::Uniform([-50.0]))
            .obstacle(Obstacle::plane([-2.3 * 50.0 * dt], [1.0], 0.0, None).unwrap())
            .build()
            .unwrap();
        let count = 3 + (8e-6 / dt).ceil() as usize;
        let run = run(&problem, &TimeGrid::uniform(dt * count as f64, count).unwrap());
        let found = results(&run);
        let (averaged, raw) = (found.averaged_peak.unwrap().force, found.total[found.peak().unwrap()].normal_force);
        let ratios = [averaged / plateau, raw / plateau];
        assert!((least..=most).contains(&ratios[0]), "{courant}: {ratios:?}");
        let is_short = courant < 0.2 || points.len() > 41;
        assert!(!is_short || ratios[1] > 1.3, "{courant}: {ratios:?}, the raw force would do");
        let peak = found.averaged_peak.unwrap();
        assert!((peak.pressure * 0.02 - averaged).abs() < 1e-9 * averaged);
    }
}

/// A block that comes down askew on a tilted plane under steps that change all the time: the impulse is what its
/// momentum changed by, at every t_n.
#[test]
fn the_impulse_is_the_change_of_momentum() {
    let problem = thrown(rotated(&random_rectangle(0.05, 0.04, 8, 3).unwrap(), 0.05).unwrap(), [200.0, -200.0], 0.3);
    let run = run(&problem, &swinging_steps(critical_time_step(&problem), 3e-5, 6.0));
    let results = results(&run);
    let mass: f64 = problem.mass().iter().sum();
    let mut before = [200.0 * mass, -200.0 * mass];
    for n in 0..run.last() {
        // v_n = v_{n−½} + ½Δt_{n−1} a_n, and a_n is what takes v_{n−½} to v_{n+½} within h_n.
        let after = run.momentum(n);
        let back = if n == 0 { 0.0 } else { 0.5 * run.step(n - 1) };
        let share = back / (back + 0.5 * run.step(n));
        for c in 0..2 {
            let momentum = before[c] + share * (after[c] - before[c]);
            let gained = momentum - [200.0, -200.0][c] * mass;
            // Momentum from differences of u: 1e-16 u/(vΔt) of it, over 80 nodes.
            assert!((gained - results.total[n].impulse[c]).abs() < 1e-10 * 200.0 * mass, "step {n}, component {c}");
        }
        before = after;
    }
    assert!(results.total[run.last()].impulse[1] > 100.0 * mass, "no blow: the test does not test");
    for c in 0..2 {
        let sum: f64 = results.summary.iter().map(|s| s.impulse[c]).sum();
        assert!((sum - results.total[run.last()].impulse[c]).abs() < 1e-12 * 200.0 * mass);
    }
}

/// A node is in contact (not free) at t_n if and only if it touches at t_{n+1}. If it sticks it does not move along the
/// plane until then; if it slips, R_n is on the cone and against the motion.
fn check_status(run: &Run<'_, 2>, what: &str) -> [usize; 3] {
    let (results, problem) = (results(run), run.problem);
    let (plane, steps, nodes) = (&problem.obstacles()[0], steps(&results), run.contact_nodes());
    let mut seen = [0; 3];
    for n in 0..run.last() {
        let (next, velocity) = (run.history.step(n + 1).unwrap(), run.half_velocity(n));
        for (at, &node) in nodes.iter().enumerate() {
            let (row, place) = (n * nodes.len() + at, format!("{what}, step {n}, node {node}"));
            let (normal, force) = plane.flat_frame().split(&vectors(&steps.force)[row]);
            let along = plane.flat_frame().split(&velocity[node]).1[0];
            assert_eq!(steps.status[row] != Status::Free, next.touching[at], "{place}");
            seen[steps.status[row] as usize] += 1;
            let sliding: [f64; 2] = vectors(&steps.sliding_velocity)[row];
            match steps.status[row] {
                Status::Free => assert!(normal == 0.0 && sliding == [0.0; 2], "{place}"),
                Status::Stick => assert!(along.abs() < STILL && sliding[0].abs() < STILL, "{place}: {along} m/s"),
                Status::Slip => {
                    let limit = plane.law().friction() * normal;
                    assert!((force[0].abs() - limit).abs() <= 1e-12 * normal, "{place}: {force:?} N of {limit}");
                    assert!(force[0] * along <= 0.0 && (sliding[0] - along).abs() < STILL, "{place}: {along} m/s");
                }
            }
        }
    }
    seen
}

#[test]
fn the_status_says_what_the_half_step_after_does() {
    for (friction, sticks, slips) in [(0.0, false, true), (0.3, true, true), (1e3, true, false)] {
        let block = |angle: f64| rotated(&random_rectangle(0.05, 0.04, 8, 3).unwrap(), angle).unwrap();
        let mut seen = [0; 3];
        for (what, mesh) in [("flat", block(0.0)), ("tilted", block(0.05)), ("disc", disc(0.02, 0.003).unwrap())] {
            let problem = thrown(mesh, [60.0, -200.0], friction);
            for times in [equal_steps(&problem, 300), swinging_steps(critical_time_step(&problem), 5e-5, 6.0)] {
                let of_run = check_status(&run(&problem, &times), &format!("{what}, friction {friction}"));
                (0..3).for_each(|k| seen[k] += of_run[k]);
            }
        }
        assert_eq!((seen[1] > 40, seen[2] > 40), (sticks, slips), "friction {friction}: {seen:?}");
    }
}

/// Fast along the plane: all contact slips, |R_t| = μR_n at every node, friction takes energy at each step.
#[test]
fn a_sliding_block_slips_everywhere() {
    let problem = thrown(random_rectangle(0.05, 0.04, 8, 6).unwrap(), [500.0, -10.0], 0.3);
    let run = run(&problem, &equal_steps(&problem, 200));
    let results = results(&run);
    let mut before = 0.0;
    for (n, total) in results.total.iter().enumerate() {
        assert_eq!(total.in_contact, total.slipping, "step {n}");
        assert!((total.force[0] + 0.3 * total.force[1]).abs() <= 1e-13 * total.force[1], "step {n}: {:?}", total.force);
        assert_eq!(total.force[1], total.normal_force, "step {n}");
        assert!(total.friction_energy >= before, "step {n}");
        before = total.friction_energy;
    }
    assert!(before > 0.0 && results.total.iter().any(|t| t.in_contact == results.nodes.len()));
}

#[test]
fn a_block_that_cannot_slide_sticks() {
    let problem = thrown(random_rectangle(0.05, 0.04, 8, 7).unwrap(), [100.0, -200.0], 1e6);
    let results = results(&run(&problem, &equal_steps(&problem, 200)));
    assert!(results.total.iter().all(|t| t.slipping == 0));
    assert!(results.total.iter().map(|t| t.in_contact).sum::<usize>() > 100);
    assert!(vectors::<2>(&steps(&results).sliding_velocity).iter().all(|v| v[0].abs() < STILL));
}

/// The friction energies of the nodes add up to that of the balance; obstacles add up to the total; the areas to the
/// sides that may touch.
#[test]
fn the_parts_add_up() {
    let mesh = Mesh::rectangle(0.05, 0.04, 6, 5).unwrap();
    let plane = |point, normal, group: &str| Obstacle::plane(point, normal, 0.2, Some(group.to_string())).unwrap();
    let material = Elastic::plane_stress(70e9, 0.3, 2700.0, 0.5).unwrap();
    // Its lower half flies at the floor, its upper one at the ceiling.
    let velocity = mesh.points_in::<2>().iter().map(|p| [30.0, 100.0 * (p[1] - 0.02) / 0.02]).collect();
    let problem = Problem::<2>::builder(mesh)
        .material(material)
        .initial_velocity(Initial::Nodal(velocity))
        .obstacle(plane([0.0, -5e-5], [0.0, 1.0], "bottom"))
        .obstacle(plane([0.0, 0.04 + 8e-5], [0.0, -1.0], "top"))
        .build()
        .unwrap();
    let run = run(&problem, &equal_steps(&problem, 150));
    let results = results(&run);
    let scale = run.simulation.balance.initial;
    for (n, total) in results.total.iter().enumerate() {
        let parts: Vec<_> = results.obstacles.iter().map(|over_time| over_time[n]).collect();
        for c in 0..2 {
            let force = parts[0].force[c] + parts[1].force[c];
            assert!((force - total.force[c]).abs() <= 1e-12 * total.normal_force, "step {n}");
        }
        assert!(
            (parts[0].normal_force + parts[1].normal_force - total.normal_force).abs() <= 1e-12 * total.normal_force
        );
        assert_eq!(parts[0].in_contact + parts[1].in_contact, total.in_contact);
        assert_eq!(parts[0].slipping + parts[1].slipping, total.slipping);
        // Sums of some thousand terms in another order.
        let friction = run.simulation.balance_over_time[n].friction;
        assert!((total.friction_energy - friction).abs() <= 1e-13 * scale, "step {n}");
        assert!((parts[0].friction_energy + parts[1].friction_energy - friction).abs() <= 1e-13 * scale, "step {n}");
    }
    assert!(
        results.total[150].friction_energy > 1e-6 * scale && results.obstacles.iter().all(|o| o[150].impulse[1] != 0.0)
    );
    let area: f64 = results.nodes.iter().map(|place| place.area).sum();
    assert!((area - 2.0 * 0.05 * 0.5).abs() < 1e-15);
}

/// In the mirror all is the same but for the sign of what points along the plane.
#[test]
fn the_mirror_image_has_mirrored_results() {
    let mesh = random_rectangle(0.05, 0.04, 8, 5).unwrap();
    let [ours, theirs] = [(mesh.clone(), 120.0), (mirrored(&mesh).unwrap(), -120.0)].map(|(mesh, along)| {
        let problem = thrown(mesh, [along, -200.0], 0.3);
        results(&run(
            &problem,
            &equal_steps(&thrown(random_rectangle(0.05, 0.04, 8, 5).unwrap(), [0.0, -1.0], 0.0), 120),
        ))
    });
    let most = ours.total[ours.peak().unwrap()].normal_force;
    let middle = mesh.points_in::<2>().iter().fold(0.0_f64, |m, p| m.max(p[0]));
    for (n, (a, b)) in ours.total.iter().zip(&theirs.total).enumerate() {
        assert_eq!((a.in_contact, a.slipping), (b.in_contact, b.slipping), "step {n}");
        // Rounding in another order, carried on by 120 steps.
        let near = |x: f64, y: f64, scale: f64| (x - y).abs() <= 1e-9 * scale;
        assert!(near(a.force[0], -b.force[0], most) && near(a.force[1], b.force[1], most), "step {n}");
        assert!(near(a.friction_energy, b.friction_energy, most * 1e-3), "step {n}");
        if let (Some(x), Some(y)) = (a.centre, b.centre) {
            assert!(near(x[0], -y[0], middle) && near(x[1], y[1], middle), "step {n}: {x:?} and {y:?}");
        }
    }
}

/// Half a body on its plane of symmetry: the whole has twice its forces, areas and energies. The node on that plane
/// sticks in both.
#[test]
fn half_a_body_has_half_the_results() {
    let block = |width: f64, nx: usize| Mesh::rectangle(width, 0.03, nx, 6).unwrap();
    let builder = |mesh| {
        Problem::<2>::builder(mesh)
            .material(aluminium())
            .initial_velocity(Initial::Uniform([0.0, -100.0]))
            .obstacle(Obstacle::plane([0.0, -3e-4], [0.0, 1.0], 0.3, Some("bottom".to_string())).unwrap())
    };
    let half = builder(block(0.02, 4)).support(fixed("left", [true, false])).build().unwrap();
    // The same cells cut along the same diagonals, mirrored.
    let whole = builder(doubled(&block(0.02, 4))).build().unwrap();
    let times = equal_steps(&whole, 80);
    let (whole, half) = (results(&run(&whole, &times)), results(&run(&half, &times)));
    let most = whole.total[whole.peak().unwrap()].normal_force;
    let mut touched = 0;
    for (n, (a, b)) in whole.total.iter().zip(&half.total).enumerate() {
        assert!((a.normal_force - 2.0 * b.normal_force).abs() < 1e-9 * most, "step {n}");
        assert!((a.friction_energy - 2.0 * b.friction_energy).abs() < 1e-12 * most, "step {n}");
        assert!((a.area - 2.0 * b.area).abs() < 1e-15 && a.force[0].abs() < 1e-9 * most, "step {n}");
        if b.in_contact == half.nodes.len() {
            touched += 1;
            assert_eq!((a.in_contact, a.slipping), (2 * b.in_contact - 1, 2 * b.slipping), "step {n}");
            assert!(a.centre.unwrap()[0].abs() < 1e-9 * 0.02, "step {n}: {:?}", a.centre);
        }
    }
    assert!(touched > 3, "only {touched} instants with all nodes in contact");
}

/// The mesh and its mirror image in x = 0, on which its left side lies.
fn doubled(half: &Mesh) -> Mesh {
    let mut points = half.points_in::<2>().to_vec();
    let mut image = Vec::new();
    for p in half.points_in::<2>() {
        let on_axis = p[0] == 0.0;
        image.push(if on_axis { image.len() } else { points.len() });
        if !on_axis {
            points.push([-p[0], p[1]]);
        }
    }
    let cells = half.nodes_of::<3>().iter().map(|c| c.map(|n| n.index()));
    let cells: Vec<_> = cells.clone().chain(cells.map(|c| c.map(|n| image[n]))).collect();
    let bottom = half.face_groups()["bottom"].iter().map(|f| half.face_nodes::<2>(*f).map(|n| n.index()));
    let bottom = bottom.clone().chain(bottom.map(|f| f.map(|n| image[n]))).collect();
    Mesh::new(points, &cells, &[("bottom".to_string(), bottom)].into(), &Default::default()).unwrap()
}
