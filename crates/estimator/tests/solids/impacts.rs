//! Boxes that strike a plane.

use super::random_box;
use crate::properties::estimating::{assert_admissible, estimate, history};
use percute_core::contact::Obstacle;
use percute_core::dynamics::{critical_time_step, simulate};
use percute_core::ids::{ElementId, NodeId};
use percute_core::load::Support;
use percute_core::material::Elastic;
use percute_core::mesh::{ElementGroups, FaceGroups, Mesh, Numbering};
use percute_core::observer::Unobserved;
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_estimator::reference::{Comparison, Motion};
use percute_estimator::{Estimate, Estimator, Options, Sampling};
use percute_testkit::Random;

const SIDE: f64 = 0.02;

fn aluminium(poisson: f64) -> Elastic {
    Elastic::solid(70e9, poisson, 2700.0).unwrap()
}

/// A body that flies along the plane z = −gap and towards it.
fn impact(mesh: Mesh, poisson: f64, velocity: [f64; 3], friction: f64, rollers: &[(&str, usize)]) -> Problem<3> {
    let mut builder = Problem::<3>::builder(mesh)
        .material(aluminium(poisson))
        .initial_velocity(Initial::Uniform(velocity))
        .obstacle(Obstacle::plane([0.0, 0.0, -1e-5], [0.0, 0.0, 1.0], friction, None).unwrap());
    for (group, axis) in rollers {
        let components = [0, 1, 2].map(|c| c == *axis);
        builder = builder.support(Support { group: (*group).into(), components, velocity: None });
    }
    builder.build().unwrap()
}

fn grid(problem: &Problem<3>, end: f64) -> TimeGrid {
    let step = 0.9 * critical_time_step(problem);
    TimeGrid::uniform((end / step).ceil() * step, (end / step).ceil() as usize).unwrap()
}

fn every_step() -> Options {
    Options { every: Sampling::Every(1), ..Options::default() }
}

/// Cubes that fall flat, against cubes with elements a quarter as long. The specification's prototype has 0.99 to 1.25
/// for such cubes; a finer reference would lower the indices by some per cent.
#[test]
#[ignore = "two minutes"]
fn flat_cubes() {
    for (cells, poisson, part) in [(4, 0.3, 0.0), (4, 0.3, 0.2), (6, 0.3, 0.2), (4, 0.45, 0.2)] {
        let mesh = random_box([SIDE; 3], [cells; 3], part, 3);
        let of = |mesh: Mesh| impact(mesh, poisson, [0.0, 0.0, -20.0], 0.0, &[]);
        let (fine, problem) = (of(mesh.refined().unwrap().refined().unwrap()), of(mesh));
        let times = grid(&problem, 1.5e-5);
        let mut sink = (Motion::default(), Estimator::new(&problem, &times, every_step()).unwrap());
        simulate(&problem, &times, &mut sink, &mut Unobserved).unwrap();
        let (motion, estimator) = sink;
        let found = estimator.finish().unwrap().error;
        let mut comparison = Comparison::new(&fine);
        comparison.add(&problem, &motion).unwrap();
        simulate(&fine, &grid(&fine, times.end()), &mut comparison, &mut Unobserved).unwrap();
        let exact = &comparison.finish().unwrap()[0];
        let index = [found.sup / exact.sup, found.mean / exact.mean];
        println!("{cells} {poisson} {part}: {index:?}");
        assert!(index.iter().all(|index| (0.9..1.45).contains(index)), "{cells} {poisson} {part}: {index:?}");
    }
}

fn estimated(problem: &Problem<3>, end: f64, options: Options) -> Estimate {
    estimate(problem, &history(problem, &grid(problem, end)), options)
}

/// A box that slides with friction, and lands flat: all fields are admissible.
#[test]
fn sliding_boxes_are_admissible() {
    for (friction, speed) in [(0.0, 0.0), (0.3, 3.0), (0.3, 60.0)] {
        let mesh = random_box([SIDE, 0.8 * SIDE, 1.1 * SIDE], [3, 3, 4], 0.2, 7);
        let problem = impact(mesh, 0.3, [speed, 0.3 * speed, -10.0], friction, &[]);
        let found = estimated(&problem, 1.2e-5, every_step());
        assert_admissible("box", &found);
        assert!(found.impulse_ratio.is_some() && found.error.sup > 0.0);
    }
}

fn apart(a: f64, b: f64) -> f64 {
    (a / b - 1.0).abs()
}

/// A quarter with rollers on its planes of symmetry has half the error of the whole. The mesh of the whole is that of
/// the quarter and its images.
#[test]
fn a_quarter_is_a_quarter_of_the_whole() {
    let quarter = Mesh::cuboid([SIDE, SIDE, SIDE], [2, 2, 3]).unwrap();
    let mut whole = quarter.clone();
    for axis in 0..2 {
        let image = whole
            .mapped(|p: &[f64; 3]| std::array::from_fn::<_, 3, _>(|c| if c == axis { -p[c] } else { p[c] }))
            .unwrap();
        whole = joined(&whole, &image);
    }
    let of = |mesh: Mesh, rollers: &[(&str, usize)]| impact(mesh, 0.3, [0.0, 0.0, -15.0], 0.3, rollers);
    let (part, whole) = (of(quarter, &[("left", 0), ("front", 1)]), of(whole, &[]));
    let times = grid(&whole, 1e-5);
    let [part, whole] = [&part, &whole].map(|problem| estimate(problem, &history(problem, &times), every_step()));
    assert_admissible("quarter", &part);
    for (part, whole) in [(part.error.sup, whole.error.sup), (part.error.mean, whole.error.mean)] {
        assert!(apart(2.0 * part, whole) < 1e-9, "{} of {whole}", 2.0 * part);
    }
}

/// Two meshes with the nodes at one place joined.
fn joined(a: &Mesh, b: &Mesh) -> Mesh {
    let mut points: Vec<[f64; 3]> = a.points_in::<3>().to_vec();
    let near = |p: &[f64; 3], q: &[f64; 3]| (0..3).all(|c| (p[c] - q[c]).abs() < 1e-12);
    let numbers: Vec<usize> = b
        .points_in::<3>()
        .iter()
        .map(|p| {
            let found = points.iter().position(|q| near(p, q));
            found.unwrap_or_else(|| {
                points.push(*p);
                points.len() - 1
            })
        })
        .collect();
    let mut cells: Vec<[usize; 4]> = a.nodes_of::<4>().iter().map(|cell| cell.map(NodeId::index)).collect();
    cells.extend(b.nodes_of::<4>().iter().map(|cell| cell.map(|node| numbers[node.index()])));
    Mesh::new(points, &cells, &FaceGroups::new(), &ElementGroups::new()).unwrap()
}

/// The same body under other numbers and on other threads: to rounding, and in bits.
#[test]
fn numbers_and_threads_do_not_matter() {
    let mesh = random_box([SIDE; 3], [3, 4, 3], 0.2, 11);
    let problem = impact(mesh, 0.3, [5.0, 0.0, -20.0], 0.2, &[]);
    let options = |threads| Options { threads: Some(threads), ..every_step() };
    let [one, two] = [1, 2].map(|threads| estimated(&problem, 8e-6, options(threads)));
    assert_eq!(one.error.sup.to_bits(), two.error.sup.to_bits());
    assert_eq!(one.error.mean.to_bits(), two.error.mean.to_bits());
    assert!(one.by_element.iter().zip(&two.by_element).all(|(a, b)| a.to_bits() == b.to_bits()));
    let small = Options { window: Some(3), ..options(1) };
    assert_eq!(one.error.mean.to_bits(), estimated(&problem, 8e-6, small).error.mean.to_bits());
    let mut random = Random::new(5);
    let mut shuffled = |count: usize| {
        let mut keys: Vec<(u64, usize)> = (0..count).map(|k| (random.between(0.0, 1.0).to_bits(), k)).collect();
        keys.sort_unstable();
        keys.into_iter().map(|(_, k)| k)
    };
    let nodes = shuffled(problem.mesh().node_count()).map(NodeId::new).collect();
    let elements = shuffled(problem.mesh().element_count()).map(ElementId::new).collect();
    let numbering = Numbering::new(nodes, elements);
    let other = estimated(&problem.renumbered(&numbering), 8e-6, options(1));
    // Rounding of some thousands of terms, over some tens of steps.
    assert!(apart(one.error.sup, other.error.sup) < 1e-9 && apart(one.error.mean, other.error.mean) < 1e-9);
}

/// A body and its plane, turned: the same estimate to rounding.
#[test]
fn turned_bodies_have_one_estimate() {
    let turn = |[x, y, z]: [f64; 3]| {
        let ((s, c), (t, d)) = (0.7_f64.sin_cos(), 0.4_f64.sin_cos());
        let [x, y] = [c * x - s * y, s * x + c * y];
        [x, d * y - t * z, t * y + d * z]
    };
    let mesh = random_box([SIDE; 3], [3, 3, 3], 0.2, 13);
    let plain = impact(mesh.clone(), 0.3, [5.0, 0.0, -20.0], 0.2, &[]);
    let turned = Problem::<3>::builder(mesh.mapped(|p: &[f64; 3]| turn(*p)).unwrap())
        .material(aluminium(0.3))
        .initial_velocity(Initial::Uniform(turn([5.0, 0.0, -20.0])))
        .obstacle(Obstacle::plane(turn([0.0, 0.0, -1e-5]), turn([0.0, 0.0, 1.0]), 0.2, None).unwrap())
        .build()
        .unwrap();
    let times = grid(&plain, 8e-6);
    let [plain, turned] = [&plain, &turned].map(|problem| estimate(problem, &history(problem, &times), every_step()));
    assert!(apart(plain.error.sup, turned.error.sup) < 1e-9, "{} {}", plain.error.sup, turned.error.sup);
    assert!(apart(plain.error.mean, turned.error.mean) < 1e-9);
}
