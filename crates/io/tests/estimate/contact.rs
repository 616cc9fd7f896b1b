//! Contact results in estimate files.

use crate::estimate::{block, estimated, stored, with_contact, written};
use percute_core::border::vectors;
use percute_core::contact::Obstacle;
use percute_core::contact::Status;
use percute_core::contact_results::{ContactRecorder, ContactResults};
use percute_core::dynamics::{critical_time_step, simulate};
use percute_core::history::{History, StepSource};
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::observer::Unobserved;
use percute_core::problem::{AnyProblem, Initial, Problem};
use percute_core::time::TimeGrid;
use percute_io::estimate_file::{contact, open};
use percute_io::{FileCause, Overwrite, history};

fn times(problem: &AnyProblem) -> TimeGrid {
    TimeGrid::uniform(0.9 * critical_time_step(problem) * 20.0, 20).unwrap()
}

fn steps(problem: &AnyProblem) -> History {
    let times = times(problem);
    let mut history = History::new(&times);
    simulate(problem, &times, &mut history, &mut Unobserved).unwrap();
    history
}

fn replayed(problem: &AnyProblem, source: &dyn StepSource) -> ContactResults {
    ContactRecorder::new(problem, source.times()).keeping_steps().unwrap().replay(source).unwrap()
}

fn bar() -> AnyProblem {
    Problem::<1>::builder(Mesh::uniform_bar(0.1, 20).unwrap())
        .material(Elastic::bar(70e9, 2700.0, 0.02).unwrap())
        .initial_velocity(Initial::Uniform([-20.0]))
        .obstacle(Obstacle::plane([-1e-5], [1.0], 0.0, None).unwrap())
        .build()
        .unwrap()
        .into()
}

/// Beside the run, from memory and from a history file the same, and back from an estimate file, bit by bit.
#[test]
fn contact_results_are_the_same_wherever_they_come_from() {
    let folder = tempfile::tempdir().unwrap();
    let (problem, times) = (block(), times(&block()));
    let mut beside = ContactRecorder::new(&problem, &times).keeping_steps().unwrap();
    let path = folder.path().join("block.vtkhdf");
    let plan = history::Plan::new(&problem, &times, crate::estimate::STATEMENT, None);
    let mut sinks = (plan.create(&path, Overwrite::Refuse).unwrap(), (History::new(&times), &mut beside));
    simulate(&problem, &times, &mut sinks, &mut Unobserved).unwrap();
    let (writer, (memory, _)) = sinks;
    writer.finish().unwrap();
    let beside = beside.finish();
    assert!(beside.total.iter().any(|r| r.in_contact == 6) && beside.total[20].friction_energy > 0.0);
    assert_eq!(replayed(&problem, &memory), beside);
    let file = history::open(&path).unwrap();
    assert_eq!(replayed(&problem, &file.source(&problem).unwrap()), beside);

    let error = folder.path().join("error.vtkhdf");
    let found = with_contact(&error, &problem, &estimated(&problem, 4, false), Some(&beside)).unwrap();
    assert!(!found.fields, "contact results are no admissible fields");
    let Some(back) = contact(&error).unwrap() else { panic!("no contact") };
    assert_eq!(back, beside);
    without_steps(&problem, &times, &memory, &beside);
    // Nodes of non-matching interfaces may face nothing, and have figures that one body does not have.
    let mut apart =
        ContactResults { slip: 0.1, penetration: 0.2, at_surface_end: true, inclination: 0.3, ..beside.clone() };
    apart.steps.as_mut().unwrap().gap[3] = f64::INFINITY;
    let apart_file = folder.path().join("apart.vtkhdf");
    with_contact(&apart_file, &problem, &estimated(&problem, 4, false), Some(&apart)).unwrap();
    let Some(back) = contact(&apart_file).unwrap() else { panic!("no contact") };
    assert_eq!(back, apart);

    let bar_file = folder.path().join("bar.vtkhdf");
    let results = replayed(&bar(), &steps(&bar()));
    with_contact(&bar_file, &bar(), &estimated(&bar(), 2, true), Some(&results)).unwrap();
    assert!(open(&bar_file).unwrap().fields);
    let Some(back) = contact(&bar_file).unwrap() else { panic!("no contact") };
    assert_eq!(back, results);
}

/// Resultants and summaries do not depend on whether all nodes at all steps are kept.
fn without_steps(problem: &AnyProblem, times: &TimeGrid, memory: &History, all: &ContactResults) {
    let results = ContactRecorder::new(problem, times).replay(memory).unwrap();
    assert_eq!(results, ContactResults { steps: None, ..all.clone() });
}

/// On the body at the instants of the maps; off the contact surface zeros, and the status -1.
#[test]
fn the_body_shows_contact_at_the_instants() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("error.vtkhdf");
    let problem = block();
    let estimate = estimated(&problem, 5, true);
    let results = replayed(&problem, &steps(&problem));
    with_contact(&path, &problem, &estimate, Some(&results)).unwrap();
    let all = results.steps.as_ref().unwrap();
    let (nodes, c) = (problem.mesh().node_count(), results.nodes.len());
    let status = hdf5::File::open(&path).unwrap().dataset("VTKHDF/PointData/contact_status").unwrap();
    let status = status.read_raw::<i8>().unwrap();
    let column = |name: &str| stored(&path, &format!("VTKHDF/PointData/{name}"));
    let (force, density, gap) = (column("contact_force"), column("contact_density"), column("gap"));
    let (sliding, friction) = (column("sliding_velocity"), column("friction_energy"));
    assert_eq!((force.0, gap.0), (vec![5 * nodes, 3], vec![5 * nodes]));
    let mut seen = 0;
    for (k, map) in estimate.maps.iter().enumerate() {
        for node in 0..nodes {
            let at = results.nodes.iter().position(|place| place.node.index() == node);
            let row = at.map(|at| map.step * c + at);
            let vector = |field: &[f64], by: f64| row.map_or([0.0; 2], |row| vectors::<2>(field)[row].map(|x| x / by));
            let area = at.map_or(1.0, |at| results.nodes[at].area);
            let place = k * nodes + node;
            let here = |values: &[u64], axis: usize| f64::from_bits(values[3 * place + axis]);
            for axis in 0..2 {
                assert_eq!(here(&force.1, axis), vector(&all.force, 1.0)[axis]);
                assert_eq!(here(&density.1, axis), vector(&all.force, area)[axis]);
                assert_eq!(here(&sliding.1, axis), vector(&all.sliding_velocity, 1.0)[axis]);
            }
            assert_eq!(f64::from_bits(gap.1[place]), row.map_or(0.0, |row| all.gap[row]));
            assert_eq!(f64::from_bits(friction.1[place]), row.map_or(0.0, |row| all.friction_energy[row]));
            assert_eq!(status[place], row.map_or(-1, |row| all.status[row] as i8));
            seen += usize::from(row.is_some_and(|row| all.status[row] != Status::Free));
        }
    }
    assert!(seen > 6, "only {seen} nodes in contact: the test does not test");
}

#[test]
fn a_file_without_contact() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let (problem, results) = (block(), replayed(&block(), &steps(&block())));
    let estimate = estimated(&problem, 2, false);
    written(&path("none"), &problem, &estimate).unwrap();
    assert!(contact(path("none")).unwrap().is_none());
    // Without all steps there is nothing to store.
    let short = ContactResults { steps: None, ..results.clone() };
    with_contact(&path("short"), &problem, &estimate, Some(&short)).unwrap();
    assert!(contact(path("short")).unwrap().is_none());
    let mut early = results.clone();
    early.instants.pop();
    let error = with_contact(&path("early"), &problem, &estimate, Some(&early)).unwrap_err();
    assert!(matches!(error.cause, FileCause::Problem { what: "instants", given: 20, needed: 21 }), "{error}");
}

#[test]
fn damaged_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let (problem, results) = (block(), replayed(&block(), &steps(&block())));
    let estimate = estimated(&problem, 2, false);
    let damage = |name: &str, damage: &dyn Fn(&hdf5::Group)| {
        with_contact(&path(name), &problem, &estimate, Some(&results)).unwrap();
        let file = hdf5::File::open_rw(path(name)).unwrap();
        damage(&file.group("percute/contact").unwrap());
        drop(file);
        contact(path(name)).unwrap_err().to_string()
    };
    let said = damage("lost", &|contact| contact.unlink("gap").unwrap());
    assert!(said.contains("`percute/contact` does not have its checksum"), "{said}");
    let said = damage("missing", &|contact| {
        contact.unlink("gap").unwrap();
        // Changed on purpose.
        contact.delete_attr("checksum").unwrap();
    });
    assert!(said.contains("`percute/contact/gap` is missing"), "{said}");
    let said = damage("changed", &|contact| {
        contact.dataset("force").unwrap().write_slice(&[1.0], (3, 2, 1..2)).unwrap();
    });
    assert!(said.contains("`percute/contact/force` does not have its checksum"), "{said}");
    // Changed on purpose.
    let said = damage("nan", &|contact| {
        let force = contact.dataset("force").unwrap();
        force.write_slice(&[f64::NAN], (3, 2, 1..2)).unwrap();
        force.delete_attr("checksum").unwrap();
    });
    // Step 3, node 2 of 6, y.
    assert!(said.contains("`percute/contact/force`: entry 41 is NaN"), "{said}");
    let said = damage("gap", &|contact| {
        let gap = contact.dataset("gap").unwrap();
        gap.write_slice(&[f64::NEG_INFINITY], (1, 1..2)).unwrap();
        gap.delete_attr("checksum").unwrap();
    });
    assert!(said.contains("`percute/contact/gap`: entry 7 is -inf"), "{said}");
    let said = damage("status", &|contact| {
        let status = contact.dataset("status").unwrap();
        status.write_slice(&[3_u8], (1, 1..2)).unwrap();
        status.delete_attr("checksum").unwrap();
    });
    assert!(said.contains("`percute/contact/status`: entry 7 is 3"), "{said}");
    let said = damage("shape", &|contact| {
        contact.unlink("total/area").unwrap();
        contact.new_dataset_builder().with_data(&[1.0]).create("total/area").unwrap();
    });
    assert!(said.contains("`percute/contact/total/area` has the shape [1]"), "{said}");
}
