//! What the auxiliary solution of a solid keeps.

use super::super::comparison::{loaded, miss, random_field, uneven};
use super::comparison::{laws, uneven_box};
use super::dense::DenseSolid;
use super::*;
use crate::element::elements;
use crate::smoothing::{Smoothed, SmoothedStrains};
use nalgebra::DMatrix;
use percute_core::dynamics::critical_time_step;
use percute_core::ids::{ElementId, NodeId};
use percute_core::load::Support;
use percute_core::material::Elastic;
use percute_core::mesh::{ElementGroups, FaceGroups, Mesh};
use percute_core::problem::Initial;
use percute_testkit::Random;

fn auxiliary<'p>(problem: &'p Problem<3>, times: &'p TimeGrid) -> SolidAuxiliary<'p, 3, 4> {
    SolidAuxiliary::new(problem, times, Arc::new(Smoothing::new(problem)), Shares::ALL)
}

/// Displacements at all levels under contact forces (N).
fn displacements(motion: &mut SolidAuxiliary<'_, 3, 4>, pull: impl Fn(usize) -> Vec<[f64; 3]>) -> Vec<Vec<[f64; 3]>> {
    let (problem, times) = (motion.problem, motion.times);
    let (dynamics, count) = (Dynamics::new(problem, times), problem.mesh().node_count());
    let still = vec![[0.0; 3]; count];
    let level = |n: usize| {
        let [mut displacement, mut acceleration] = [0; 2].map(|_| vec![[0.0; 3]; count]);
        let pull = pull(n);
        motion.begin(n);
        let simulated = SimulatedLevel { velocity: &still, strain: 0.0, reaction: &pull };
        let level = AuxiliaryLevel { displacement: &mut displacement, acceleration: &mut acceleration, split: None };
        motion.advance(&dynamics, n, &simulated, &pull, level);
        displacement
    };
    (0..=times.step_count()).map(level).collect()
}

/// K_s by the operator, column by column.
fn smoothed_stiffness(problem: &Problem<3>) -> DMatrix<f64> {
    let mut operator = SolidOperator::<3, 4>::new(problem, Arc::new(Smoothing::new(problem)));
    operator.elements = elements(problem);
    let (count, mut strains) = (problem.mesh().node_count(), SmoothedStrains::default());
    let mut forces = vec![[[0.0; 3]; 4]; operator.elements.len()];
    let mut columns = DMatrix::zeros(3 * count, 3 * count);
    for dof in 0..3 * count {
        let mut unit = vec![[0.0; 3]; count];
        unit[dof / 3][dof % 3] = 1.0;
        operator.internal_forces(&unit, Some(&mut strains), &mut forces);
        (0..count).for_each(|i| (0..3).for_each(|c| columns[(3 * i + c, dof)] = operator.sum(i, &forces)[c]));
    }
    columns
}

/// K_s is symmetric, 0 ≤ K_s ≤ K, and 0 for the six rigid motions alone, with and without planes of symmetry.
#[test]
fn smoothed_stiffness_is_below_the_plain_one() {
    for held in [false, true] {
        let mesh = uneven_box([1.0, 0.8, 0.7], [2, 2, 2], 0.3);
        let problem = match held {
            true => loaded::<3, 4>(&mesh, laws(), ["left", "top", "right"]),
            false => Problem::builder(mesh).material(laws()[1]).build().unwrap(),
        };
        let found = smoothed_stiffness(&problem);
        let mirrors: &[_] = if held { &[(0, 0.0), (2, 0.7)] } else { &[] };
        let dense = DenseSolid::new(&problem, mirrors);
        let scale = dense.stiffness.amax();
        assert!((&found - &dense.smoothed).amax() < 1e-13 * scale);
        assert!((&found - found.transpose()).amax() < 1e-13 * scale);
        let least = |matrix: &DMatrix<f64>| matrix.clone().symmetric_eigenvalues().min();
        assert!(least(&found) > -1e-12 * scale && least(&(&dense.stiffness - &found)) > -1e-12 * scale);
        let points = problem.mesh().points_in::<3>();
        for (k, axis) in (0..6).map(|k| (k, k % 3)) {
            let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
            let rigid = nalgebra::DVector::from_fn(3 * points.len(), |i, _| match (k < 3, i % 3) {
                (true, c) => f64::from(u8::from(c == axis)),
                (false, c) if c == a => -points[i / 3][b],
                (false, c) if c == b => points[i / 3][a],
                _ => 0.0,
            });
            assert!((&found * rigid).amax() < 1e-13 * scale, "{held}, {k}");
        }
        let zero = found.symmetric_eigenvalues().iter().filter(|x| x.abs() < 1e-9 * scale).count();
        assert_eq!(zero, 6);
    }
}

/// On cubes cut in six, smoothed strains of quadratic displacements are those at the centroid, away from the surface.
#[test]
fn strains_of_quadratic_displacements_are_exact() {
    let problem =
        Problem::<3>::builder(Mesh::cuboid([4.0, 6.0, 5.0], [4, 4, 4]).unwrap()).material(laws()[0]).build().unwrap();
    let (mesh, smoothing, elements) = (problem.mesh(), Smoothing::new(&problem), elements::<3, 4>(&problem));
    let mut random = Random::new(2);
    // u_a = Σ q_abc x_b x_c
    let q: [[[f64; 3]; 3]; 3] =
        std::array::from_fn(|_| std::array::from_fn(|_| std::array::from_fn(|_| random.between(-1.0, 1.0))));
    let quadratic = |p: &[f64; 3]| -> [f64; 3] {
        std::array::from_fn(|a| (0..9).map(|k| q[a][k / 3][k % 3] * p[k / 3] * p[k % 3]).sum())
    };
    let slope = |p: &[f64; 3], a: usize, b: usize| (0..3).map(|c| (q[a][b][c] + q[a][c][b]) * p[c]).sum::<f64>();
    let displacement: Vec<[f64; 3]> = mesh.points_in::<3>().iter().map(quadratic).collect();
    let (of, mut strains) =
        (Smoothed { problem: &problem, smoothing: &smoothing, elements: &elements }, SmoothedStrains::default());
    strains.fill_one(of, &displacement);
    let mut inner = 0;
    for e in 0..elements.len() {
        let corners = mesh.corners::<3, 4>(ElementId::new(e));
        let inside = |p: &[f64; 3]| (0..3).all(|c| p[c] > 0.0 && p[c] < [4.0, 6.0, 5.0][c]);
        if !corners.iter().all(inside) {
            continue;
        }
        inner += 1;
        let centroid = std::array::from_fn(|c| corners.iter().map(|p| p[c]).sum::<f64>() / 4.0);
        let found = strains.of(0.0, of, ElementId::new(e));
        for (a, b) in (0..3).flat_map(|a| (0..3).map(move |b| (a, b))) {
            let exact = 0.5 * (slope(&centroid, a, b) + slope(&centroid, b, a));
            assert!((found[a][b] - exact).abs() < 1e-12, "{e}: {} for {exact}", found[a][b]);
        }
    }
    assert_eq!(inner, 6 * 8);
}

/// A body that flies without strain keeps its velocity bit by bit.
#[test]
fn a_body_in_flight_keeps_its_velocity() {
    let velocity = [3.0, -7.0, 0.1];
    let problem = Problem::<3>::builder(uneven_box([1.0, 0.8, 0.7], [3, 2, 2], 0.3))
        .material(laws()[0])
        .initial_velocity(Initial::Uniform(velocity))
        .build()
        .unwrap();
    let times = uneven(&problem, 50);
    let mut motion = auxiliary(&problem, &times);
    motion.prepare(&elements(&problem));
    let last = displacements(&mut motion, |_| Vec::new()).pop().unwrap();
    assert!(motion.motion.half_step.iter().all(|v| *v == velocity));
    assert!(last.iter().all(|u| *u == last[0]));
}

/// A support of one component.
fn roller(group: &str, axis: usize) -> Support {
    Support { group: group.into(), components: std::array::from_fn(|c| c == axis), velocity: None }
}

/// The half of a body on rollers moves like the whole body.
#[test]
fn half_a_body_is_half_of_the_whole() {
    let half = uneven_box([0.5, 0.8, 0.7], [2, 2, 2], 0.3);
    let (mut points, mut images) = (half.points_in::<3>().to_vec(), Vec::new());
    for p in half.points_in::<3>() {
        images.push(if p[0] == 0.0 { images.len() } else { points.len() });
        if p[0] != 0.0 {
            points.push([-p[0], p[1], p[2]]);
        }
    }
    let own: Vec<[usize; 4]> = half.nodes_of::<4>().iter().map(|cell| cell.map(NodeId::index)).collect();
    let mirrored = own.iter().map(|[a, b, c, d]| [a, b, d, c].map(|node| images[*node]));
    let cells: Vec<[usize; 4]> = own.iter().copied().chain(mirrored).collect();
    let whole = Mesh::new(points, &cells, &FaceGroups::<3>::new(), &ElementGroups::new()).unwrap();
    let mut start = random_field::<3>(half.node_count(), 0.01, &mut Random::new(3));
    start.iter_mut().zip(half.points_in::<3>()).filter(|(_, p)| p[0] == 0.0).for_each(|(u, _)| u[0] = 0.0);
    let mut both = start.clone();
    both.resize(whole.node_count(), [0.0; 3]);
    images.iter().zip(&start).for_each(|(image, u)| both[*image] = [-u[0], u[1], u[2]]);
    start.iter().enumerate().for_each(|(i, u)| both[i] = *u);
    let law = laws()[0];
    let halved = Problem::<3>::builder(half).material(law).support(roller("left", 0));
    let halved = halved.initial_displacement(Initial::Nodal(start)).build().unwrap();
    let whole = Problem::<3>::builder(whole).material(law).initial_displacement(Initial::Nodal(both)).build().unwrap();
    let times = uneven(&whole, 60);
    let mut motions = [&halved, &whole].map(|problem| auxiliary(problem, &times));
    motions[0].prepare(&elements(&halved));
    motions[1].prepare(&elements(&whole));
    // The critical step of the half is that of the waves that it has.
    motions[0].damping = motions[1].damping;
    let [of_half, of_whole] = motions.each_mut().map(|motion| displacements(motion, |_| Vec::new()));
    for (a, b) in of_half.iter().zip(&of_whole) {
        assert!(miss(a, &b[..a.len()]) < 1e-12, "{}", miss(a, &b[..a.len()]));
    }
}

/// Cubes of eight nodes that are almost incompressible are unstable at 0.9 Δt_c, and stable with weaker corrections;
/// those of a larger body keep them.
#[test]
fn corrections_are_weakened_until_the_scheme_is_stable() {
    for (cells, poisson, part) in
        [([1, 1, 1], 0.49, 0.9), ([1, 1, 1], 0.3, 1.0), ([2, 2, 2], 0.3, 0.9), ([2, 2, 1], 0.49, 1.0)]
    {
        let mesh = Mesh::cuboid([1.0; 3], cells).unwrap();
        let problem = Problem::<3>::builder(mesh).material(Elastic::solid(1.0, poisson, 1.0).unwrap()).build().unwrap();
        let step = part * critical_time_step(&problem);
        let times = TimeGrid::uniform(10.0 * step, 10).unwrap();
        let mut motion = auxiliary(&problem, &times);
        let (dense, whole) = (DenseSolid::new(&problem, &[]), (motion.weights.mass(0), motion.damping));
        motion.prepare(&elements(&problem));
        let [before, after] = [whole, (motion.weights.mass(0), motion.damping)].map(|(c, d)| dense.radius(c, step, d));
        // Double eigenvalues of rigid motions are 1 to the root of rounding.
        assert!(after < 1.0 + 1e-5, "{cells:?}, {poisson}: {after}");
        assert_eq!(before < 1.0 + 1e-5, motion.damping == whole.1, "{cells:?}, {poisson}: {before}");
    }
}

/// The fields do not depend on threads.
#[test]
fn threads_do_not_change_bits() {
    let mesh = Mesh::cuboid([1.0, 0.8, 0.7], [18, 16, 14]).unwrap();
    let problem = loaded::<3, 4>(&mesh, laws(), ["left", "top", "right"]);
    let times = uneven(&problem, 4);
    let with_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut motion = auxiliary(&problem, &times);
            motion.prepare(&elements(&problem));
            let contacts = problem.surface().nodes().len();
            displacements(&mut motion, |n| random_field::<3>(contacts, 0.1, &mut Random::new(n as u64)))
        })
    };
    let one = with_threads(1);
    for threads in [2, 3, 8] {
        assert!(one == with_threads(threads), "{threads}");
    }
}
