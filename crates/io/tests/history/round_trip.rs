//! What was written comes back with the same bits.

use crate::history::common::*;
use hdf5::OpenMode;
use percute_core::border::vectors;
use percute_core::dynamics::{Balancing, replay, simulate};
use percute_core::history::{Discard, History, Step, StepSource};
use percute_core::ids::FaceId;
use percute_core::mesh::{ElementGroups, FaceGroups, Mesh};
use percute_core::observer::Unobserved;
use percute_core::problem::{AnyProblem, Initial, Problem, Statement};
use percute_core::time::TimeGrid;
use percute_estimator::{Estimator, Options, Request, estimate};
use percute_io::history::{Plan, open, recover};
use percute_io::{FileCause, Kind, Overwrite, kind};
use percute_testkit::Random;
use percute_testkit::strategy::rectangle;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::os::unix::fs::MetadataExt;
use std::path::Path;

/// Nodes of the faces of each group, and elements of each group.
type Groups = (Vec<(String, Vec<Vec<usize>>)>, Vec<(String, Vec<usize>)>);

fn groups(mesh: &Mesh) -> Groups {
    let of = |&f: &FaceId| mesh.face(f).nodes.iter().map(|n| n.index()).collect();
    let faces = mesh.face_groups().iter().map(|(name, f)| (name.clone(), f.iter().map(of).collect()));
    let elements = mesh.element_groups().iter().map(|(n, e)| (n.clone(), e.iter().map(|e| e.index()).collect()));
    (faces.collect(), elements.collect())
}

fn assert_same_mesh(one: &Mesh, other: &Mesh) {
    assert_eq!(bits(one.points()), bits(other.points()));
    assert_eq!((one.cell_rows(), one.face_count()), (other.cell_rows(), other.face_count()));
    (0..one.face_count()).map(FaceId::new).for_each(|f| assert_eq!(one.face(f), other.face(f)));
    assert_eq!(groups(one), groups(other));
}

/// Steps of any bits, none of which a run would make: zeros of both signs, tiny and huge numbers.
fn any_steps(problem: &AnyProblem, count: usize, given: [bool; 2], seed: u64) -> History {
    let mut random = Random::new(seed);
    let mut any = |len: usize| -> Vec<f64> {
        let number = |bits: u64| match bits % 8 {
            0 => 0.0,
            1 => -0.0,
            2 => f64::MIN_POSITIVE / 8.0,
            3 => -f64::MAX,
            _ => Some(f64::from_bits(bits.rotate_left(17))).filter(|x| x.is_finite()).unwrap_or(1.0),
        };
        (0..2 * len).map(|_| number(random.bits())).collect()
    };
    let times = TimeGrid::uniform(1e-3, count.max(1)).unwrap();
    let (nodes, surface) = (problem.mesh().node_count(), problem.contact_nodes().len());
    let mut history = History::new(&times);
    for index in 0..=count {
        let displacement = if index == 0 { problem.initial_displacement().to_vec() } else { any(nodes) };
        let (reaction, velocity, acceleration) = (any(surface), any(nodes), any(nodes));
        let touching: Vec<bool> = vectors::<2>(&reaction).iter().map(|r| r[0] > 0.0).collect();
        let step = Step {
            index,
            time: times.instants()[index],
            displacement: &displacement,
            reaction: &reaction,
            touching: &touching,
            internal: &[],
            velocity: given[0].then_some(&velocity[..]),
            acceleration: given[1].then_some(&acceleration[..]),
        };
        history.push(&step).unwrap();
    }
    history
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 32, failure_persistence: None, rng_seed: RngSeed::Fixed(3), ..ProptestConfig::default()
    })]

    /// Any mesh, any numbers, with and without a motion of their own.
    #[test]
    fn all_bits_come_back(
        mesh in rectangle(6), seed in 0..1_000_000_u64, count in 1..9_usize, v in any::<bool>(), a in any::<bool>(),
        name in "[%/.A-Za-zé ]{0,6}",
    ) {
        let cells: Vec<_> = mesh.nodes_of::<3>().iter().map(|c| c.map(|n| n.index())).collect();
        let (faces, _) = groups(&mesh.clone());
        let faces: FaceGroups<2> =
            faces.into_iter().map(|(n, f)| (format!("{n}{name}"), f.iter().map(|f| [f[1], f[0]]).collect())).collect();
        let elements = ElementGroups::from([(name.clone(), vec![0, 2]), ("none".to_string(), vec![])]);
        let mesh = Mesh::new(mesh.points_in::<2>().to_vec(), &cells, &faces, &elements).unwrap();
        let mut random = Random::new(seed);
        let size = mesh.size();
        let mut anywhere = || 1e-6 * size * random.between(-1.0, 1.0);
        let start = mesh.points_in::<2>().iter().map(|_| [anywhere(), anywhere()]).collect();
        let problem = plane_problem(mesh, Some(start));
        let history = any_steps(&problem, count, [v, a], seed);
        let folder = folder();
        let path = folder.path().join("any name.vtkhdf");
        write(&path, &problem, &history);

        let file = plane_file(&path);
        assert_same_mesh(file.mesh(), problem.mesh());
        prop_assert_eq!(file.mesh().reoriented_elements(), 0);
        prop_assert_eq!(bits(file.initial_displacement()), bits(problem.initial_displacement()));
        prop_assert_eq!(bits(file.initial_velocity()), bits(problem.initial_velocity()));
        prop_assert_eq!((file.statement(), file.case()), (STATEMENT, Some(&case())));
        prop_assert_eq!((file.supplied(), file.count(), file.is_complete()), ([v, a], count + 1, true));
        prop_assert_eq!(file.times(), history.times());
        let again = replayed(&path, &problem).unwrap();
        assert_same(&again, &history, count + 1);
        for n in 0..=count {
            let step = history.step(n).unwrap();
            prop_assert_eq!(bits(&file.displacement(n..n + 1).unwrap()), bits(step.displacement));
            prop_assert_eq!(bits(&file.reaction(n..n + 1).unwrap()), bits(step.reaction));
            prop_assert_eq!(file.touching(n..n + 1).unwrap(), step.touching);
            prop_assert_eq!(file.velocity(n..n + 1).unwrap().map(|x| bits(&x)), step.velocity.map(bits));
            prop_assert_eq!(file.acceleration(n..n + 1).unwrap().map(|x| bits(&x)), step.acceleration.map(bits));
        }
    }
}

/// The problem built again from the file gives the same estimate and balance, bit by bit.
#[test]
fn estimates_from_the_file_are_those_beside_the_run() {
    let folder = folder();
    let path = folder.path().join("block.vtkhdf");
    let problem = block(10, 8);
    let times = steps(&problem, 60);
    let plan = Plan::new(&problem, &times, STATEMENT, None);
    let mut writer = plan.create(&path, Overwrite::Refuse).unwrap();
    let mut estimator = Estimator::new(&problem, &times, Options::default()).unwrap();
    let simulation = simulate(&problem, &times, &mut (&mut writer, &mut estimator), &mut Unobserved).unwrap();
    let beside = (simulation, estimator.finish().unwrap());
    writer.finish().unwrap();

    let file = plane_file(&path);
    let stated = Statement {
        materials: vec![(None, problem.materials()[0])],
        displacement: file.initial_displacement().to_vec(),
        velocity: file.initial_velocity().to_vec(),
        obstacles: problem.obstacles().collect(),
        ..Statement::default()
    };
    let again = AnyProblem::new(file.mesh(), &stated).unwrap();
    let source = file.source(&again).unwrap();
    let from_file =
        estimate(&again, &source, Options::default(), &Request::default(), &mut Discard, &mut Unobserved).unwrap();
    assert!(beside.1.error.sup > 100.0 && beside.1.impulse_ratio.is_some(), "nothing happens: {:?}", beside.1.error);
    // Every number is compared with ==, and none is NaN or a zero of another sign.
    assert_eq!(beside, from_file);

    let mut balancing = Balancing::new(&again, source.times());
    replay(&again, &source, &mut balancing).unwrap();
    assert_eq!(balancing.finish(), beside.0.balance_over_time);
}

#[test]
fn bars() {
    let folder = folder();
    let path = folder.path().join("bar.vtkhdf");
    let problem = bar(20);
    let history = run(&problem, &steps(&problem, 80));
    assert!(history.reaction().iter().any(|r| *r > 0.0));
    write(&path, &problem, &history);
    let file = bar_file(&path);
    assert_same_mesh(file.mesh(), problem.mesh());
    let source = file.source(&problem).unwrap();
    let mut again = History::new(source.times());
    source.replay(&mut |step| again.push(step)).unwrap();
    assert_eq!(again, history);
}

/// Where no obstacle is, no contact data are.
#[test]
fn without_contact() {
    let folder = folder();
    let path = folder.path().join("free.vtkhdf");
    let mesh = Mesh::rectangle(1.0, 1.0, 2, 2).unwrap();
    let material = percute_core::material::Elastic::plane_strain(1.0, 0.3, 1.0, 1.0).unwrap();
    let problem = Problem::<2>::builder(mesh).material(material).initial_velocity(Initial::Uniform([1.0, 0.0]));
    let problem = problem.build().unwrap().into();
    let history = run(&problem, &steps(&problem, 5));
    write(&path, &problem, &history);
    assert_eq!(replayed(&path, &problem).unwrap(), history);
    assert!(plane_file(&path).contact_nodes().is_empty() && plane_file(&path).reaction(2..3).unwrap().is_empty());
}

/// Arrays that another program may map into memory lie where it is said.
#[test]
fn arrays_lie_where_they_are_said_to() {
    let folder = folder();
    let path = folder.path().join("block.vtkhdf");
    let (problem, history) = small(&path);
    let stored = std::fs::read(&path).unwrap();
    let arrays = plane_file(&path).arrays().unwrap();
    assert!(arrays.iter().all(|a| a.offset.unwrap().is_multiple_of(8)));
    let names: Vec<_> = arrays.iter().map(|a| a.name).collect();
    assert_eq!(names, ["checksums", "displacement", "reaction", "touching"]);
    let [checksums, displacement, reaction, touching] = &arrays[..] else { panic!("four") };
    assert_eq!(checksums.shape, [13, 5]);
    let numbers = |at: usize, count: usize| -> Vec<u64> {
        let bytes = stored[at..at + 8 * count].as_chunks::<8>().0;
        bytes.iter().map(|b| u64::from_le_bytes(*b)).collect()
    };
    let contact = problem.contact_nodes().len();
    assert_eq!(displacement.shape, [13, problem.mesh().node_count(), 3]);
    let expected: Vec<u64> =
        vectors::<2>(history.displacement()).iter().flat_map(|u| [u[0], u[1], 0.0]).map(f64::to_bits).collect();
    assert_eq!(numbers(displacement.offset.unwrap() as usize, expected.len()), expected);
    assert_eq!(reaction.shape, [13, contact, 2]);
    assert_eq!(numbers(reaction.offset.unwrap() as usize, 26 * contact), bits(history.reaction()));
    assert_eq!(touching.shape, [13, contact]);
    let at = touching.offset.unwrap() as usize;
    let touching: Vec<bool> = stored[at..at + 13 * contact].iter().map(|&b| b == 1).collect();
    assert_eq!(touching, history.touching());
}

/// The size that is foretold is that of the file, up to 3 kB that the library needs more or less and 30 bytes
/// for each group, which has a longer or shorter name.
#[test]
fn size_is_foretold() {
    let folder = folder();
    let check = |name: &str, foretold: u64, groups: u64| {
        let found = folder.path().join(name).metadata().unwrap().len();
        let spare = 3_000 + 30 * groups;
        assert!(found <= foretold && found + spare >= foretold, "{name}: {found} bytes, {foretold} were foretold");
    };
    for (at, problem) in [block(1, 1), block(20, 16), block(7, 3)].into_iter().enumerate() {
        let times = steps(&problem, 10 * at + 2);
        let plan = Plan::new(&problem, &times, STATEMENT, Some(&case())).with_supplied(at == 2, at > 0);
        let name = format!("{at}.vtkhdf");
        drop(plan.create(folder.path().join(&name), Overwrite::Refuse).unwrap());
        check(&name, plan.bytes(), 4);
    }
    let mut mesh = Mesh::rectangle(0.05, 0.04, 20, 16).unwrap();
    let many: ElementGroups = (0..200).map(|g| (format!("a name of some length {g}"), vec![g])).collect();
    let cells: Vec<_> = mesh.nodes_of::<3>().iter().map(|c| c.map(|n| n.index())).collect();
    mesh = Mesh::new(mesh.points_in::<2>().to_vec(), &cells, &FaceGroups::new(), &many).unwrap();
    let problem = plane_problem(mesh, None);
    let times = steps(&problem, 5);
    let plan = Plan::new(&problem, &times, &"x".repeat(100_000), None);
    drop(plan.create(folder.path().join("groups.vtkhdf"), Overwrite::Refuse).unwrap());
    check("groups.vtkhdf", plan.bytes(), 200);
}

/// Writes the first steps only; the file opens, has their number, and can be finished.
#[test]
fn unfinished_files_give_their_whole_steps() {
    let folder = folder();
    let problem = block(4, 3);
    let history = run(&problem, &steps(&problem, 12));
    for count in [0, 1, 7, 13] {
        let path = folder.path().join(format!("{count}.vtkhdf"));
        drop(write_some(&path, &problem, &history, count));
        let file = plane_file(&path);
        assert_eq!((file.count(), file.is_complete()), (count, false));
        assert_eq!(bits(file.initial_displacement()), bits(problem.initial_displacement()));
        assert_same(&replayed(&path, &problem).unwrap(), &history, count);
        assert_eq!(vtk_steps(&path), 1);

        if count == 0 {
            for _ in 0..2 {
                assert!(matches!(recover(&path).unwrap_err().cause, FileCause::NoStep));
            }
            assert!(!plane_file(&path).is_complete(), "what holds nothing is not made complete");
            continue;
        }
        let recovered = recover(&path).unwrap();
        assert_eq!((recovered.count, recovered.was_complete), (count, false));
        let file = plane_file(&path);
        assert_eq!((file.count(), file.is_complete(), vtk_steps(&path)), (count, true, count as i64));
        assert_same(&replayed(&path, &problem).unwrap(), &history, count);
        assert!(recover(&path).unwrap().was_complete);
    }
}

/// The room of steps that were never written is given back, after a kill and after a stop, and the steps keep their
/// bits.
#[test]
fn unwritten_steps_give_their_room_back() {
    let folder = folder();
    let problem = block(20, 16);
    let history = run(&problem, &steps(&problem, 200));
    for stopped in [false, true] {
        let path = folder.path().join(format!("{stopped}.vtkhdf"));
        let writer = write_some(&path, &problem, &history, 10);
        let room = || std::fs::metadata(&path).unwrap().blocks() * 512;
        // 201 steps of 357 nodes with three numbers each.
        assert!(room() > 201 * 357 * 24);
        if stopped {
            writer.finish().unwrap();
        } else {
            drop(writer);
            recover(&path).unwrap();
        }
        // File systems without holes keep it all; those of the tests have them. The blocks at the ends of each array
        // remain.
        assert!(room() < 10 * 357 * 24 + 150_000, "{} bytes", room());
        assert_same(&replayed(&path, &problem).unwrap(), &history, 10);
    }
}

/// A run that was stopped cleanly is complete.
#[test]
fn stopped_runs_are_complete() {
    let folder = folder();
    let path = folder.path().join("stopped.vtkhdf");
    let problem = block(4, 3);
    let history = run(&problem, &steps(&problem, 12));
    write_some(&path, &problem, &history, 5).finish().unwrap();
    let file = plane_file(&path);
    assert_eq!((file.count(), file.is_complete(), vtk_steps(&path)), (5, true, 5));
    assert_eq!(file.times(), history.times());
}

/// While it is written, others may read what is there, in this process too; it then ends as if nobody had.
#[test]
fn files_can_be_read_while_they_are_written() {
    let folder = folder();
    let path = folder.path().join("growing.vtkhdf");
    let problem = block(4, 3);
    let history = run(&problem, &steps(&problem, 12));
    let mut writer = write_some(&path, &problem, &history, 4);
    let early = plane_file(&path);
    assert!(early.count() <= 4);
    (4..13).for_each(|n| writer.push(&history.step(n).unwrap()).unwrap());
    let source = early.source(&problem).unwrap();
    let reading = std::thread::spawn(move || {
        let mut again = History::new(source.times());
        (0..50).for_each(|_| {
            again = History::new(source.times());
            source.replay(&mut |step| again.push(step)).unwrap();
        });
        again
    });
    writer.finish().unwrap();
    assert_same(&reading.join().unwrap(), &history, early.count());
    assert_eq!(plane_file(&path).count(), 13);
}

#[test]
fn kinds() {
    let folder = folder();
    let path = folder.path().join("a.vtkhdf");
    small(&path);
    assert_eq!(kind(&path).unwrap(), Kind::History);
    std::fs::write(folder.path().join("b.toml"), "[mesh]\n").unwrap();
    assert_eq!(kind(folder.path().join("b.toml")).unwrap(), Kind::Other);
    std::fs::write(folder.path().join("empty"), "").unwrap();
    assert_eq!(kind(folder.path().join("empty")).unwrap(), Kind::Other);
    drop(raw(&folder.path().join("c.h5"), OpenMode::Create));
    assert_eq!(kind(folder.path().join("c.h5")).unwrap(), Kind::OtherHdf5);
    assert!(open(folder.path().join("c.h5")).is_err());
}

fn vtk_steps(path: &Path) -> i64 {
    let file = raw(path, OpenMode::Read);
    file.group("VTKHDF/Steps").unwrap().attr("NSteps").unwrap().read_scalar().unwrap()
}
