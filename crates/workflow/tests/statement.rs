//! Problems written down and read again: the same problems, bit by bit.

use percute_core::border::{Vector, padded, vectors};
use percute_core::contact::Obstacle;
use percute_core::dynamics::critical_time_step;
use percute_core::load::{BodyForce, Profile, Support, Table, Traction};
use percute_core::material::Elastic;
use percute_core::mesh::{ElementGroups, FaceRows, Mesh};
use percute_core::observer::Unobserved;
use percute_core::problem::{AnyProblem, Initial, Problem};
use percute_core::time::TimeGrid;
use percute_estimator::{Acceleration, Options, Reconstruction, Sampling};
use percute_testkit::{Random, strategy::rectangle};
use percute_workflow::case::{Case, NotRepresentable, Source, parse, problem_from, statement};
use percute_workflow::run::{Analysis, Storage, run};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn config() -> ProptestConfig {
    ProptestConfig { cases: 48, failure_persistence: None, rng_seed: RngSeed::Fixed(3), ..ProptestConfig::default() }
}

/// The problem that comes of writing `problem` down, with its options.
fn again(problem: &AnyProblem, options: &Options) -> (AnyProblem, Options) {
    let text = statement(problem, Some(options)).unwrap();
    let (u, v) = (problem.initial_displacement().to_vec(), problem.initial_velocity().to_vec());
    problem_from(&Source::new("statement", &text), problem.mesh(), u, v).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// `Debug` prints the shortest decimal of each number, zeros with their sign: equal texts are equal
/// bits, of what was stated and of all that follows from it.
fn same(problem: &AnyProblem, options: &Options) {
    let (problem_again, options_again) = again(problem, options);
    // A problem keeps its critical step from the first use on.
    assert_eq!(critical_time_step(problem).to_bits(), critical_time_step(&problem_again).to_bits());
    assert_eq!(format!("{problem:?}"), format!("{problem_again:?}"));
    assert_eq!(*options, options_again);
}

/// A mesh whose groups of faces have other names, and a first half and a second half of elements.
fn named(mesh: &Mesh, sides: &[&str], names: &[String]) -> Mesh {
    let nodes = |side: &str| {
        let faces = &mesh.face_groups()[side];
        faces.iter().flat_map(|&f| mesh.face(f).nodes).map(|node| node.index()).collect::<Vec<_>>()
    };
    let faces: FaceRows = sides.iter().zip(names).map(|(side, name)| (name.clone(), nodes(side))).collect();
    let (half, all) = (mesh.element_count() / 2, mesh.element_count());
    let elements =
        ElementGroups::from([(names[0].clone(), (0..half).collect()), (names[1].clone(), (half..all).collect())]);
    let cells: Vec<_> = mesh.cell_rows().iter().map(|node| node.index()).collect();
    Mesh::from_rows(mesh.dimension(), mesh.points(), &cells, (&faces, &elements)).unwrap()
}

fn flip(random: &mut Random) -> bool {
    random.bits().is_multiple_of(2)
}

/// A positive number of any size.
fn size(random: &mut Random) -> f64 {
    10.0_f64.powf(random.between(-6.0, 12.0))
}

fn vector<const D: usize>(random: &mut Random) -> [f64; D] {
    std::array::from_fn(|_| random.between(-1.0, 1.0) * size(random))
}

fn law<const D: usize>(random: &mut Random) -> Elastic {
    let (young, density, extent) = (size(random), size(random), size(random));
    let poisson = random.between(-0.99, 0.499);
    match (D, flip(random)) {
        (1, _) => Elastic::bar(young, density, extent),
        (_, true) => Elastic::plane_stress(young, poisson, density, extent),
        (_, false) => Elastic::plane_strain(young, poisson, density, extent),
    }
    .unwrap()
}

fn table<const D: usize>(random: &mut Random) -> Table {
    if flip(random) {
        return Table::constant(vector::<D>(random));
    }
    let count = 1 + random.bits() as usize % 4;
    let mut time = random.between(-1.0, 1.0);
    let mut later = || {
        time += random.between(1e-6, 1.0);
        time
    };
    let times = (0..count).map(|_| later()).collect();
    Table::new(times, (0..count).map(|_| vector::<D>(random)).collect()).unwrap()
}

/// A support; of components that are not held a statement keeps nothing.
fn support<const D: usize>(group: &str, random: &mut Random) -> Support {
    let mut components = [false; 3];
    components[..D].iter_mut().enumerate().for_each(|(c, held)| *held = c == 0 || flip(random));
    let velocity = flip(random).then(|| {
        let table = table::<D>(random);
        let keep = |v: &Vector| -> Vector { std::array::from_fn(|c| if components[c] { v[c] } else { 0.0 }) };
        Table::new(table.time().to_vec(), table.value().iter().map(keep).collect()).unwrap()
    });
    Support { group: group.to_string(), components, velocity }
}

/// Initial velocities that agree with a support.
fn start<const D: usize>(mesh: &Mesh, support: Option<&Support>, random: &mut Random) -> Vec<[f64; D]> {
    let mut velocity: Vec<[f64; D]> = mesh.points_in::<D>().iter().map(|_| vector(random)).collect();
    let Some(Support { group, components, velocity: motion }) = support else { return velocity };
    let at_start = motion.as_ref().map_or([0.0; 3], |table| table.at(0.0));
    for face in &mesh.face_groups()[group] {
        for node in mesh.face_nodes::<D>(*face) {
            (0..D).filter(|&c| components[c]).for_each(|c| velocity[node.index()][c] = at_start[c]);
        }
    }
    velocity
}

/// Anything that can be stated on a mesh whose groups are, in this order: may touch, supported or
/// loaded, loaded, loaded.
fn anything<const D: usize>(mesh: Mesh, names: &[String], down: [f64; D], random: &mut Random) -> Problem<D> {
    let support = flip(random).then(|| support::<D>(&names[1], random));
    let velocity = start(&mesh, support.as_ref(), random);
    let loaded = names.iter().skip(if support.is_some() { 2 } else { 1 });
    let (length, friction) = (size(random), if D == 1 { 0.0 } else { random.between(0.0, 2.0) });
    // So far away that no displacement of half a metre matters.
    let plane = Obstacle::plane(down.map(|x| 10.0 * x), down.map(|x| -length * x), friction, Some(names[0].clone()));
    let mut builder = Problem::<D>::builder(mesh.clone())
        .obstacle(plane.unwrap())
        .initial_velocity(Initial::Nodal(velocity))
        .initial_displacement(Initial::Nodal(mesh.points_in::<D>().iter().map(|p| p.map(|x| 0.1 * x)).collect()));
    builder = support.into_iter().fold(builder, |builder, support| builder.support(support));
    builder = if flip(random) {
        builder.material_of(&names[1], law::<D>(random)).material_of(&names[0], law::<D>(random))
    } else {
        builder.material(law::<D>(random))
    };
    for group in loaded.filter(|name| mesh.face_groups().contains_key(*name)) {
        let profile = Profile { value: random.between(-2.0, 2.0), gradient: padded(&vector::<D>(random)) };
        builder = builder.traction(Traction { group: group.clone(), value: table::<D>(random), profile });
    }
    for group in [None, Some(names[0].clone())] {
        builder = builder.body_force(BodyForce { group, value: table::<D>(random) });
    }
    builder.build().unwrap()
}

fn options(random: &mut Random) -> Options {
    let reconstruction = Reconstruction::ALL[random.bits() as usize % Reconstruction::ALL.len()];
    let accelerations = Acceleration::of(reconstruction);
    // The last one is the default.
    let acceleration = accelerations.get(random.bits() as usize % (accelerations.len() + 1)).copied();
    let every = match random.bits() as usize % 1000 {
        0..100 => Sampling::Auto,
        steps => Sampling::Every(steps),
    };
    Options { reconstruction, acceleration, every, ..Options::default() }
}

/// Four different names of any letters, empty ones and control characters among them.
fn names() -> impl Strategy<Value = Vec<String>> {
    prop::collection::btree_set(any::<String>(), 4).prop_map(|names| names.into_iter().collect())
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn plane_bodies_come_back_bit_by_bit(mesh in rectangle(4), names in names(), seed in any::<u64>()) {
        let random = &mut Random::new(seed);
        let mesh = named(&mesh, &["bottom", "left", "right", "top"], &names);
        let angle = random.between(-0.7, 0.7);
        let problem = anything::<2>(mesh, &names, [angle.sin(), -angle.cos()], random).into();
        same(&problem, &options(random));
    }

    #[test]
    fn bars_come_back_bit_by_bit(
        length in 0.1..3.0_f64, elements in 2..9_usize, names in names(), seed in any::<u64>(),
    ) {
        let random = &mut Random::new(seed);
        let mesh = named(&Mesh::uniform_bar(length, elements).unwrap(), &["start", "end"], &names);
        let problem = anything::<1>(mesh, &names, [-1.0], random).into();
        same(&problem, &options(random));
    }
}

fn read(text: &str) -> Case {
    parse(Source::new("case.toml", text)).unwrap()
}

/// Problem, options and the estimate of a few steps.
fn as_good_as_the_case(problem: &AnyProblem, times: &TimeGrid, options: Options) {
    same(problem, &options);
    let (problem_again, options_again) = again(problem, &options);
    let estimate = |problem, options| {
        let (analysis, storage) =
            (Analysis { options, ..Analysis::default() }, Storage { file: None, memory: None, open: None });
        let results = run(problem, times, &analysis, storage, &mut Unobserved).unwrap().results;
        (results.simulation, results.estimate)
    };
    assert_eq!(estimate(problem, options), estimate(&problem_again, options_again));
}

#[test]
fn examples_come_back_with_their_estimates() {
    for text in [
        include_str!("../../../examples/block.toml"),
        include_str!("../../../examples/bar.toml"),
        include_str!("../../../examples/stack.toml"),
    ] {
        let case = read(text);
        as_good_as_the_case(&case.problem, &case.times, case.options);
    }
}

#[test]
fn zeros_keep_their_sign() {
    let velocity = Table::new(vec![-0.0, 1.0], vec![[-0.0, 0.0], [2.0, -0.0]]).unwrap();
    let support = Support { group: "left".into(), components: [true, true, false], velocity: Some(velocity) };
    let problem = Problem::<2>::builder(Mesh::rectangle(1.0, 1.0, 2, 1).unwrap())
        .material(Elastic::plane_stress(1.0, -0.0, 1.0, 1.0).unwrap())
        .support(support)
        .obstacle(Obstacle::plane([-0.0, -1.0], [-0.0, 3.0], -0.0, None).unwrap());
    same(&problem.build().unwrap().into(), &Options::default());
}

#[test]
fn without_options_there_is_no_estimate() {
    let case = read(include_str!("../../../tests/bases/bar.toml"));
    let text = statement(&case.problem, None).unwrap();
    assert!(text.starts_with("[[material]]\nyoung = 70000000000.0\n") && !text.contains("[estimate]"), "{text}");
}

#[test]
fn a_law_of_another_dimension_is_refused() {
    let plane = Elastic::plane_strain(1.0, 0.3, 1.0, 1.0).unwrap();
    let bar = Problem::<1>::builder(Mesh::uniform_bar(1.0, 2).unwrap()).material(plane).build().unwrap().into();
    let error = statement(&bar, None).unwrap_err();
    assert!(matches!(error, NotRepresentable::Law { index: 1, dimension: 1, .. }), "{error}");
    let law = Elastic::bar(1.0, 1.0, 1.0).unwrap();
    let plane = Problem::<2>::builder(Mesh::rectangle(1.0, 1.0, 1, 1).unwrap()).material(law).build().unwrap().into();
    assert!(statement(&plane, None).unwrap_err().to_string().contains("material 1 is a law for a bar"));
}

#[test]
fn what_is_beside_a_statement_is_refused_with_its_line() {
    let material = "[material]\nyoung = 1.0\ndensity = 1.0\nsection = 1.0\n";
    for (more, line, phrase) in [
        ("[mesh]\nbar = { length = 1.0, elements = 2 }\n", 5, "mesh: is not part of a statement"),
        ("[time]\nend = 1.0\n", 5, "time: is not part"),
        ("[initial]\nvelocity = 1.0\n", 5, "initial: is not part"),
        ("[output]\nhistory = \"a\"\n", 5, "output: is not part"),
        ("[obstacles]\n", 5, "did you mean `obstacle`?"),
        ("[[support]]\ngroup = \"nowhere\"\ncomponents = [\"x\"]\n", 6, "there is no group of ends \"nowhere\""),
    ] {
        let mesh = Mesh::uniform_bar(1.0, 2).unwrap().into();
        let source = Source::new("a.vtkhdf", format!("{material}{more}"));
        let error = problem_from(&source, &mesh, vec![0.0; 3], vec![0.0; 3]).unwrap_err();
        assert_eq!(error.line, line, "{error}");
        assert!(error.to_string().contains(phrase), "{error}");
    }
    let mesh = Mesh::uniform_bar(1.0, 2).unwrap().into();
    let error = problem_from(&Source::new("a", material), &mesh, vec![0.0; 3], vec![0.0; 2]).unwrap_err();
    assert!(error.to_string().contains("has 2 values, but the mesh has 3 nodes"), "{error}");
}

#[test]
fn gravity_is_the_weight_of_each_material() {
    let text = include_str!("../../../tests/bases/arrays.toml");
    let weight = |group: &str, density: f64| {
        format!("[[body_force]]\ngroup = \"{group}\"\nvalue = [0.0, {:?}]\n", density * -9.81)
    };
    let stated = [text.to_string(), weight("left", 2700.0), weight("right", 7800.0)].join("\n");
    let [heavy, stated] = [format!("gravity = [0.0, -9.81]\n{text}"), stated].map(|t| read(&t));
    assert_eq!(format!("{:?}", heavy.problem), format!("{:?}", stated.problem));
    same(&heavy.problem, &heavy.options);
    // The force on all nodes is the weight.
    let force = heavy.problem.external_forces(0.0);
    let (mass, pull): (f64, f64) = (heavy.problem.mass().iter().sum(), vectors::<2>(&force).iter().map(|f| f[1]).sum());
    assert!((pull / (-9.81 * mass) - 1.0).abs() < 1e-14, "{pull} N on {mass} kg");
}
