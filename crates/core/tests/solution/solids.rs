//! Solids of tetrahedra.

use crate::solution::run::{Run, difference, largest, mean_rate, run};
use percute_core::contact::{Obstacle, Status};
use percute_core::dynamics::{critical_time_step, element_time_step, simulate_threaded};
use percute_core::history::History;
use percute_core::ids::{ElementId, NodeId};
use percute_core::kernel::InternalForces;
use percute_core::load::Support;
use percute_core::material::{Elastic, LinearLaw};
use percute_core::mesh::{ElementGroups, FaceGroups, Mesh, Numbering, Strips};
use percute_core::observer::Unobserved;
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_testkit::Random;
use std::f64::consts::{PI, TAU};

fn aluminium() -> Elastic {
    Elastic::solid(70e9, 0.3, 2700.0).unwrap()
}

/// A box whose inner nodes are moved at random, by up to so much of a cell: irregular elements.
fn random_box(size: [f64; 3], cells: [usize; 3], part: f64, seed: u64) -> Mesh {
    let (mesh, mut random) = (Mesh::cuboid(size, cells).unwrap(), Random::new(seed));
    let points = mesh.points_in::<3>().iter().map(|point| {
        std::array::from_fn(|c| {
            let inside = point[c] > 1e-9 * size[c] && point[c] < (1.0 - 1e-9) * size[c];
            let by = random.between(-part, part) * size[c] / cells[c] as f64;
            if inside { point[c] + by } else { point[c] }
        })
    });
    let cells: Vec<_> = mesh.nodes_of::<4>().iter().map(|cell| cell.map(NodeId::index)).collect();
    let groups: FaceGroups<3> = mesh
        .face_groups()
        .iter()
        .map(|(name, faces)| {
            (name.clone(), faces.iter().map(|f| mesh.face_nodes::<3>(*f).map(NodeId::index)).collect())
        })
        .collect();
    Mesh::new(points.collect(), &cells, &groups, &ElementGroups::new()).unwrap()
}

fn random_field(count: usize, size: f64, random: &mut Random) -> Vec<[f64; 3]> {
    (0..count).map(|_| std::array::from_fn(|_| random.between(-size, size))).collect()
}

/// A uniform displacement gradient: no force inside the body, those of its stress at the boundary, ∫σ n φ, and the
/// energy of its strain. A rotation has none. Forces are divided by the modulus and the area of the box.
#[test]
fn uniform_strains_pass_the_patch_test() {
    let (law, mut random) = (aluminium(), Random::new(1));
    let mesh = random_box([0.3, 0.4, 0.5], [3, 4, 5], 0.3, 2);
    let problem = Problem::<3>::builder(mesh.clone()).material(law).build().unwrap();
    let (lambda, shear) = law.moduli();
    for _ in 0..5 {
        let gradient: [[f64; 3]; 3] = std::array::from_fn(|_| std::array::from_fn(|_| random.between(-1e-3, 1e-3)));
        let field = |p: &[f64; 3]| std::array::from_fn(|a| (0..3).map(|b| gradient[a][b] * p[b]).sum());
        let u: Vec<[f64; 3]> = mesh.points_in::<3>().iter().map(field).collect();
        let trace: f64 = (0..3).map(|a| gradient[a][a]).sum();
        let stress =
            |a: usize, b: usize| shear * (gradient[a][b] + gradient[b][a]) + if a == b { lambda * trace } else { 0.0 };
        let mut expected = vec![[0.0; 3]; u.len()];
        for face in mesh.boundary() {
            let (normal, area) = mesh.normal_in::<3>(face);
            for node in mesh.face_nodes::<3>(face) {
                for a in 0..3 {
                    expected[node.index()][a] -= (0..3).map(|b| stress(a, b) * normal[b]).sum::<f64>() * area / 3.0;
                }
            }
        }
        let mut force = vec![[0.0; 3]; u.len()];
        let energy = InternalForces::new(&problem).subtract_from_rows(u.as_flattened(), force.as_flattened_mut());
        // Rounding of sums over some 24 elements.
        assert!(difference(&force, &expected) < 1e-13 * largest(&expected));
        let density: f64 =
            (0..3).flat_map(|a| (0..3).map(move |b| (a, b))).map(|(a, b)| stress(a, b) * gradient[a][b]).sum();
        assert!((energy / (0.5 * density * 0.06) - 1.0).abs() < 1e-12);
    }
    let turned: Vec<[f64; 3]> =
        mesh.points_in::<3>().iter().map(|[x, y, z]| [2.0 * z - y, x - 3.0 * z, 3.0 * y - 2.0 * x]).collect();
    let mut force = vec![[0.0; 3]; turned.len()];
    InternalForces::new(&problem).subtract_from_rows(turned.as_flattened(), force.as_flattened_mut());
    assert!(largest(&force) < 1e-14 * 70e9);
}

/// Forces are minus the derivative of the energy, which is quadratic: a central difference is exact to rounding.
#[test]
fn forces_are_the_derivative_of_the_energy() {
    let mesh = random_box([0.3, 0.4, 0.5], [2, 3, 4], 0.3, 3);
    let problem = Problem::<3>::builder(mesh.clone()).material(aluminium()).build().unwrap();
    let (forces, mut random) = (InternalForces::new(&problem), Random::new(4));
    let energy = |u: &[[f64; 3]]| forces.subtract_from_rows(u.as_flattened(), &mut vec![0.0; 3 * u.len()]);
    let [u, way] = [(); 2].map(|()| random_field(mesh.node_count(), 1e-3, &mut random));
    let moved = |s: f64| -> Vec<[f64; 3]> {
        u.iter().zip(&way).map(|(u, way)| std::array::from_fn(|c| u[c] + s * way[c])).collect()
    };
    let mut force = vec![[0.0; 3]; u.len()];
    forces.subtract_from_rows(u.as_flattened(), force.as_flattened_mut());
    let work: f64 = force.iter().flatten().zip(way.iter().flatten()).map(|(f, w)| f * w).sum();
    let slope = energy(&moved(0.5)) - energy(&moved(-0.5));
    assert!((slope + work).abs() < 1e-13 * energy(&u), "{slope} {work}");
}

/// Δt_c is that of the largest eigenvalue, found by a power iteration, and the bound of the elements is below it.
#[test]
fn the_critical_step_is_that_of_the_largest_eigenvalue() {
    for poisson in [0.0, 0.3, 0.45] {
        let mesh = random_box([0.3, 0.4, 0.5], [2, 3, 4], 0.3, 5);
        let law = Elastic::solid(70e9, poisson, 2700.0).unwrap();
        let problem = Problem::<3>::builder(mesh.clone()).material(law).build().unwrap();
        let (forces, mut random) = (InternalForces::new(&problem), Random::new(6));
        let (mut x, mut eigenvalue) = (random_field(mesh.node_count(), 1.0, &mut random), 0.0);
        for _ in 0..3000 {
            let mut force = vec![[0.0; 3]; x.len()];
            let energy = forces.subtract_from_rows(x.as_flattened(), force.as_flattened_mut());
            let mass = |x: &[[f64; 3]]| -> f64 {
                x.iter().zip(problem.mass()).map(|(x, m)| m * x.iter().map(|x| x * x).sum::<f64>()).sum()
            };
            eigenvalue = 2.0 * energy / mass(&x);
            force.iter_mut().zip(problem.mass()).for_each(|(f, m)| *f = f.map(|f| f / m));
            let size = mass(&force).sqrt();
            x = force.iter().map(|f| f.map(|f| -f / size)).collect();
        }
        let critical = critical_time_step(&problem);
        // The iteration comes from below, the other from above to 1e-9.
        assert!((critical * eigenvalue.sqrt() / 2.0 - 1.0).abs() < 1e-5, "{critical} {}", 2.0 / eigenvalue.sqrt());
        let bound = element_time_step(&problem);
        assert!(bound <= critical * (1.0 + 1e-9) && bound > 0.2 * critical, "{bound} {critical}");
    }
}

/// The bound of one element alone is its largest eigenvalue, at most 0.2 % above it.
#[test]
fn the_bound_of_an_element_is_tight() {
    let mut random = Random::new(7);
    for poisson in [-0.3, 0.0, 0.3, 0.49] {
        let points: Vec<[f64; 3]> = random_field(4, 1.0, &mut random);
        let mesh = Mesh::new(points, &[[0, 1, 2, 3]], &FaceGroups::new(), &ElementGroups::new()).unwrap();
        let law = Elastic::solid(70e9, poisson, 2700.0).unwrap();
        let problem = Problem::<3>::builder(mesh).material(law).build().unwrap();
        // Lanczos finds all twelve: the smaller of both is the critical step.
        let (critical, bound) = (critical_time_step(&problem), element_time_step(&problem));
        assert!((0.999..=1.0 + 1e-12).contains(&(bound / critical)), "{bound} {critical}");
    }
}

/// The Lamé mode of a cube, which has no stress on any of its faces: u_x = cos kx sin ky, u_y = −sin kx cos ky with
/// k = π/a; ω = √2 k c_s.
fn lame_error(cells: usize, part: f64) -> f64 {
    let (side, law, amplitude) = (0.1, aluminium(), 1e-6);
    let (wave, shear) = (PI / side, law.moduli().1);
    let omega = 2.0_f64.sqrt() * wave * (shear / 2700.0).sqrt();
    let mesh = random_box([side; 3], [cells; 3], part, 8);
    let mode = |p: &[f64; 3]| {
        [
            amplitude * (wave * p[0]).cos() * (wave * p[1]).sin(),
            -amplitude * (wave * p[0]).sin() * (wave * p[1]).cos(),
            0.0,
        ]
    };
    let start = mesh.points_in::<3>().iter().map(mode).collect();
    let built = Problem::<3>::builder(mesh).material(law).initial_displacement(Initial::Nodal(start)).build();
    let (problem, end) = (built.unwrap(), 0.75 * TAU / omega);
    let run = run(&problem, &TimeGrid::with_step(end, 0.7 * critical_time_step(&problem)).unwrap());
    let (exact, last) = ((omega * end).cos(), run.displacement(run.last()));
    let off = |(p, u): (&[f64; 3], &[f64; 3])| (0..3).map(|c| (u[c] - exact * mode(p)[c]).powi(2)).sum::<f64>();
    let squares = problem.mesh().points_in::<3>().iter().zip(last).zip(problem.mass()).map(|(at, m)| m * off(at));
    (squares.sum::<f64>() / problem.mass().iter().sum::<f64>()).sqrt() / amplitude
}

#[test]
fn a_lame_mode_converges_at_order_two() {
    let errors = [6, 12, 24].map(|cells| lame_error(cells, 0.0));
    assert!((1.8..2.1).contains(&mean_rate(&errors[1..])), "{errors:?}");
    let errors = [6, 12, 24].map(|cells| lame_error(cells, 0.2));
    assert!((1.8..2.1).contains(&mean_rate(&errors[1..])), "{errors:?}");
}

/// A box that strikes a plane obliquely.
fn oblique(mesh: Mesh, way: [f64; 2], normal: [f64; 3], friction: f64) -> Problem<3> {
    Problem::<3>::builder(mesh)
        .material(aluminium())
        .initial_velocity(Initial::Uniform([way[0], way[1], -10.0]))
        .obstacle(Obstacle::plane([0.0, 0.0, -1e-6], normal, friction, None).unwrap())
        .build()
        .unwrap()
}

fn grid(problem: &Problem<3>, steps: usize) -> TimeGrid {
    let step = 0.9 * critical_time_step(problem);
    TimeGrid::uniform(step * steps as f64, steps).unwrap()
}

fn cube() -> Mesh {
    random_box([0.02; 3], [5; 3], 0.25, 9)
}

/// Signorini and Coulomb at each step and node: no penetration, pressure only, the cone, and sliding against friction.
/// Momentum changes by the impulse of the reactions. The energy of impacts of nodes falls with the mesh.
#[test]
fn contact_obeys_signorini_and_coulomb() {
    let problem = oblique(cube(), [4.0, -7.0], [0.0, 0.0, 1.0], 0.3);
    let times = grid(&problem, 60);
    let run = run(&problem, &times);
    let (law, frame) = (problem.obstacles()[0].law(), problem.obstacles()[0].flat_frame());
    let (mut slips, mut impulse, start) = (0, [0.0; 3], run.momentum(0));
    for n in 0..run.last() {
        let (next, velocity) = (run.displacement(n + 1), run.half_velocity(n));
        let step = run.history.step(n).unwrap();
        let reaction: &[[f64; 3]] = step.reaction();
        for (at, node) in run.contact_nodes().into_iter().enumerate() {
            let gap = problem.mesh().points_in::<3>()[node][2] + next[node][2] + 1e-6;
            let force = reaction[at];
            assert!(gap > -1e-14 && law.excess(&frame, &force).iter().all(|excess| *excess <= 1e-9 * force[2].abs()));
            assert!(force[2] == 0.0 || gap.abs() < 1e-14, "{gap}");
            if law.status(&frame, &force) == Status::Slip {
                slips += 1;
                // Against the sliding velocity, in whatever direction of the plane.
                let cross = force[0] * velocity[node][1] - force[1] * velocity[node][0];
                let along = force[0] * velocity[node][0] + force[1] * velocity[node][1];
                assert!(along <= 0.0 && cross.abs() < 1e-9 * force[2] * 10.0);
            }
            if n > 0 {
                (0..3).for_each(|c| impulse[c] += times.step(n) * force[c]);
            }
        }
    }
    assert!(slips > 100, "{slips}");
    let now = run.momentum(run.last() - 1);
    for c in 0..3 {
        assert!((now[c] - start[c] - impulse[c]).abs() < 1e-12 * start[2].abs(), "{c}");
    }
    assert!(run.simulation.balance.energy_drift.abs() < 0.04, "{:?}", run.simulation.balance);
}

/// Turning the body, its velocity and the plane turns the solution: a plane in any direction has the same contact.
#[test]
fn solutions_turn_with_the_body() {
    let turn = |p: &[f64; 3]| -> [f64; 3] {
        let (s, c) = 0.7_f64.sin_cos();
        let [x, y, z] = [c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]];
        let (s, c) = 0.4_f64.sin_cos();
        [x, c * y - s * z, s * y + c * z]
    };
    let straight = oblique(cube(), [4.0, -7.0], [0.0, 0.0, 1.0], 0.3);
    let times = grid(&straight, 40);
    let mesh = straight.mesh();
    let cells: Vec<_> = mesh.nodes_of::<4>().iter().map(|cell| cell.map(NodeId::index)).collect();
    let points = mesh.points_in::<3>().iter().map(turn).collect();
    let turned = Problem::<3>::builder(Mesh::new(points, &cells, &FaceGroups::new(), &ElementGroups::new()).unwrap())
        .material(aluminium())
        .initial_velocity(Initial::Uniform(turn(&[4.0, -7.0, -10.0])))
        .obstacle(Obstacle::plane(turn(&[0.0, 0.0, -1e-6]), turn(&[0.0, 0.0, 1.0]), 0.3, None).unwrap())
        .build()
        .unwrap();
    let (one, other) = (run(&straight, &times), run(&turned, &times));
    let expected: Vec<_> = one.displacement(one.last()).iter().map(turn).collect();
    // Rounding of gaps over a speed, amplified by some tens of steps of contact.
    assert!(difference(other.displacement(other.last()), &expected) < 1e-10 * largest(&expected));
}

/// Renumbered nodes and elements.
#[test]
fn numbering_changes_rounding_only() {
    let problem = oblique(cube(), [4.0, -7.0], [0.0, 0.0, 1.0], 0.3);
    let (mut random, mesh) = (Random::new(10), problem.mesh());
    let nodes: Vec<_> = random.permutation(mesh.node_count()).into_iter().map(NodeId::new).collect();
    let elements = random.permutation(mesh.element_count()).into_iter().map(ElementId::new).collect();
    let shuffled = problem.renumbered(&Numbering::new(nodes.clone(), elements));
    let times = grid(&problem, 40);
    let (one, other): (Run<3>, Run<3>) = (run(&problem, &times), run(&shuffled, &times));
    let expected: Vec<_> = nodes.iter().map(|node| one.displacement(one.last())[node.index()]).collect();
    assert!(difference(other.displacement(other.last()), &expected) < 1e-10 * largest(&expected));
    let volume = |p: &Problem<3>| p.mesh().volumes().iter().sum::<f64>();
    assert!((volume(&shuffled) / volume(&problem) - 1.0).abs() < 1e-13);
}

/// Any number of threads gives the same bits, on a mesh of several strips.
#[test]
fn threads_change_no_bit() {
    let mesh = Mesh::cuboid([0.02, 0.02, 0.1], [10, 10, 50]).unwrap();
    let problem = oblique(mesh, [4.0, -7.0], [0.0, 0.0, 1.0], 0.3);
    let problem = problem.mesh().local_numbering().map_or(problem.clone(), |numbering| problem.renumbered(&numbering));
    assert!(Strips::new(problem.mesh()).count() > 4, "{}", Strips::new(problem.mesh()).count());
    let times = grid(&problem, 12);
    let on = |threads| {
        let mut history = History::new(&times);
        let done = simulate_threaded(&problem, &times, Some(threads), &mut history, &mut Unobserved).unwrap();
        (history, done)
    };
    let one = on(1);
    assert!(one.0.reaction().iter().any(|r| *r != 0.0));
    assert!([2, 3, 8].into_iter().all(|threads| on(threads) == one));
}

/// Half of a box with rollers at its plane of symmetry moves as the half of the whole: friction acts along the plane of
/// symmetry. The mesh is mirrored, so that both have the same elements.
#[test]
fn a_half_with_rollers_is_half_of_the_whole() {
    let half = random_box([0.02, 0.01, 0.02], [5, 3, 5], 0.25, 11);
    let (count, points) = (half.node_count(), half.points_in::<3>());
    let cells: Vec<_> = half.nodes_of::<4>().iter().map(|cell| cell.map(NodeId::index)).collect();
    // The nodes of the half, and mirror images of those that are not on y = 0.
    let mut image: Vec<usize> = (0..count).collect();
    let mut all = points.to_vec();
    for (node, [x, y, z]) in points.iter().enumerate().filter(|(_, point)| point[1] > 0.0) {
        image[node] = all.len();
        all.push([*x, -y, *z]);
    }
    let mirrored = cells.iter().map(|cell| cell.map(|node| image[node]));
    let both: Vec<_> = cells.iter().copied().chain(mirrored).collect();
    let whole = Mesh::new(all, &both, &FaceGroups::new(), &ElementGroups::new()).unwrap();
    let builder = |mesh: Mesh| {
        Problem::<3>::builder(mesh)
            .material(aluminium())
            .initial_velocity(Initial::Uniform([4.0, 0.0, -10.0]))
            .obstacle(Obstacle::plane([0.0, 0.0, -2e-6], [0.0, 0.0, 1.0], 0.3, None).unwrap())
    };
    let rollers = Support { group: "front".to_string(), components: [false, true, false], velocity: None };
    let (half, whole) = (builder(half).support(rollers).build().unwrap(), builder(whole).build().unwrap());
    let times = grid(&whole, 50);
    let (one, other) = (run(&half, &times), run(&whole, &times));
    let expected = &other.displacement(other.last())[..count];
    assert!(difference(one.displacement(one.last()), expected) < 1e-10 * largest(expected));
    let slides = one.history.reaction().chunks_exact(3).any(|r| r[0].abs() > 0.1 * r[2] && r[2] > 0.0);
    assert!(slides, "friction acts");
}
