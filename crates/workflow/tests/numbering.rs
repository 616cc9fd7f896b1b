//! Runs of a shuffled mesh: the solver has an order of its own, and results and messages have the numbers of the mesh.

use percute_core::contact::Obstacle;
use percute_core::contact_results::ContactResults;
use percute_core::dynamics::critical_time_step;
use percute_core::history::{History, SinkError, Step, StepSource};
use percute_core::ids::{FaceId, NodeId};
use percute_core::load::{Profile, Support, Table, Traction};
use percute_core::material::Elastic;
use percute_core::mesh::{ElementGroups, Mesh};
use percute_core::observer::Unobserved;
use percute_core::problem::{AnyProblem, Initial, Problem};
use percute_core::time::TimeGrid;
use percute_estimator::reference::ReferenceError;
use percute_estimator::{Options, Request};
use percute_io::Overwrite;
use percute_testkit::{Renumbering, renumbered};
use percute_workflow::Failure;
use percute_workflow::case::Keep;
use percute_workflow::history::{open, plan};
use percute_workflow::run::{
    Analysis, Meshes, Results, Storage, balance, estimate, motion, run, simulate, true_errors,
};

/// 1353 nodes: with up to 256, a shuffled mesh is solved in its own order.
fn block() -> Mesh {
    Mesh::rectangle(0.05, 0.04, 40, 32).unwrap()
}

fn shuffled() -> (Mesh, Renumbering) {
    let (mesh, new) = renumbered(&block(), 6).unwrap();
    assert!(!mesh.is_local());
    (mesh, new)
}

/// A block that strikes a rough plane, held at the left and pulled at the right.
fn problem(mesh: Mesh, gap: f64) -> AnyProblem {
    let support = Support { group: "left".to_string(), components: [true, false, false], velocity: None };
    let value = Table::new(vec![0.0, 1e-5], vec![[1e6, 2e6], [3e6, -1e6]]).unwrap();
    let pull = Traction { group: "right".to_string(), value, profile: Profile::UNIFORM };
    let velocity = mesh.points_in::<2>().iter().map(|p| [200.0 * p[0], -100.0]).collect();
    Problem::<2>::builder(mesh)
        .material(Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap())
        .initial_velocity(Initial::Nodal(velocity))
        .support(support)
        .traction(pull)
        .obstacle(Obstacle::plane([0.0, -gap], [0.0, 1.0], 0.2, Some("bottom".to_string())).unwrap())
        .build()
        .unwrap()
        .into()
}

/// 40 steps; the plane is 2.4 of them away, so that no node lands on it at an instant.
fn times() -> TimeGrid {
    let step = 0.85 * critical_time_step(&problem(block(), 1.0));
    TimeGrid::uniform(40.0 * step, 40).unwrap()
}

fn gap() -> f64 {
    2.4 * 100.0 * times().step(0)
}

fn analysis() -> Analysis {
    let request = Request { steps: vec![10, 40], fields: true };
    Analysis { options: Options { threads: Some(1), ..Options::default() }, request, contact_steps: true }
}

/// The results of a run and its history in memory.
fn ran(problem: &AnyProblem) -> (Results, History) {
    let mut history = History::new(&times());
    let mut keep = |step: &Step<'_>| history.push(step);
    let storage = Storage { file: None, memory: Some(&mut keep), open: None };
    let results = run(problem, &times(), &analysis(), storage, &mut Unobserved).unwrap().results;
    (results, history)
}

/// Compares numbers with those of the same nodes or elements on the shuffled mesh, relative to the largest of them.
fn same(what: &str, one: &[f64], other: &[f64], new: &[usize], tolerance: f64) {
    let width = one.len() / new.len();
    assert_eq!((one.len(), other.len()), (width * new.len(), one.len()), "{what}");
    let largest = one.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    for (i, x) in one.iter().enumerate() {
        let y = other[new[i / width] * width + i % width];
        assert!((x - y).abs() <= tolerance * largest, "{what}, {i}: {x:e} against {y:e}, largest {largest:e}");
    }
}

/// The place of each contact node among those of the shuffled mesh.
fn contact_places(one: &ContactResults, other: &ContactResults, new: &Renumbering) -> Vec<usize> {
    let place = |node: NodeId| other.nodes.iter().position(|p| p.node.index() == new.node[node.index()]).unwrap();
    one.nodes.iter().map(|point| place(point.node)).collect()
}

/// Rounding of 40 steps.
const ROUNDING: f64 = 1e-12;

#[test]
fn a_shuffled_mesh_has_the_same_results() {
    let (mesh, new) = shuffled();
    let (one, history) = ran(&problem(block(), gap()));
    let (other, shuffled) = ran(&problem(mesh, gap()));
    for n in 0..=40 {
        let (a, b) = (history.step(n).unwrap(), shuffled.step(n).unwrap());
        same("displacement", a.displacement, b.displacement, &new.node, ROUNDING);
    }
    same("by_element", &one.estimate.by_element, &other.estimate.by_element, &new.element, ROUNDING);
    assert_eq!(one.estimate.maps.len(), 2);
    for (a, b) in one.estimate.maps.iter().zip(&other.estimate.maps) {
        for (x, y) in [(&a.kinetic, &b.kinetic), (&a.elastic, &b.elastic), (&a.accumulated, &b.accumulated)] {
            same("map", x, y, &new.element, ROUNDING);
        }
        same("map, contact", &a.contact, &b.contact, &new.element, 1e-9);
        let (a, b) = (a.fields.as_ref().unwrap(), b.fields.as_ref().unwrap());
        for (x, y) in [(&a.displacement, &b.displacement), (&a.velocity, &b.velocity)] {
            same("nodal field", x, y, &new.node, ROUNDING);
        }
        same("acceleration", &a.acceleration, &b.acceleration, &new.element, ROUNDING);
        for (x, y) in [(&a.stress, &b.stress), (&a.compatible_stress, &b.compatible_stress)] {
            same("stress", x, y, &new.element, ROUNDING);
        }
    }
    let places = contact_places(&one.contact, &other.contact, &new);
    let (a, b) = (one.contact.steps.as_ref().unwrap(), other.contact.steps.as_ref().unwrap());
    for n in 0..=40 {
        let rows = 2 * n * places.len()..2 * (n + 1) * places.len();
        same("force", &a.force[rows.clone()], &b.force[rows], &places, 1e-10);
    }
    assert!(one.contact.total.iter().any(|total| total.normal_force > 0.0));
    let measures = |r: &Results| [r.estimate.error.sup, r.estimate.error.mean, r.simulation.balance.kinetic];
    for (a, b) in measures(&one).into_iter().zip(measures(&other)) {
        assert!((a - b).abs() <= ROUNDING * a, "{a:e} against {b:e}");
    }
}

/// From memory and from its file, the history of a run has its estimate, balance and motion, bit by bit.
#[test]
fn a_stored_history_has_the_results_of_its_run() {
    let (problem, times) = (problem(shuffled().0, gap()), times());
    let (results, history) = ran(&problem);
    let again = estimate(&problem, &history, &analysis(), &mut Unobserved).unwrap();
    assert_eq!((&again.estimate, &again.contact), (&results.estimate, &results.contact));
    assert_eq!(balance(&problem, &history).unwrap(), results.simulation.balance_over_time);

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("shuffled.vtkhdf");
    let writer = plan(&problem, &times, &Options::default(), None, &Keep::default())
        .unwrap()
        .create(&path, Overwrite::allowed(false))
        .unwrap();
    simulate(&problem, &times, Storage { file: Some(writer), memory: None, open: None }, &mut Unobserved).unwrap();
    let stored = open(&path).unwrap();
    let read = stored.estimate(&analysis(), false, &mut Unobserved).unwrap().results;
    assert_eq!((&read.estimate, &read.contact), (&results.estimate, &results.contact));
    assert_eq!(stored.file.displacement(0..41).unwrap(), history.displacement());
    assert_eq!(stored.file.reaction(0..41).unwrap(), history.reaction());
}

/// Velocities and accelerations of a history.
#[test]
fn motions_have_the_numbers_of_the_mesh() {
    let (mesh, new) = shuffled();
    let (one, other) = (problem(block(), gap()), problem(mesh, gap()));
    let ((_, straight), (_, shuffled)) = (ran(&one), ran(&other));
    let all = |problem: &AnyProblem, history: &History| {
        let mut found = Vec::new();
        motion(problem, history, |velocity, acceleration| found.push([velocity, acceleration])).unwrap();
        found
    };
    let (one, other) = (all(&one, &straight), all(&other, &shuffled));
    assert_eq!(one.len(), 41);
    for (a, b) in one.iter().zip(&other).flat_map(|(a, b)| a.iter().zip(b)) {
        // Accelerations are small differences of large stresses: they lose two digits.
        same("motion", a, b, &new.node, 1e-10);
    }
}

/// A history that is changed at one node.
struct Changed<'h> {
    history: &'h History,
    step: usize,
    node: usize,
    value: f64,
}

impl StepSource for Changed<'_> {
    fn times(&self) -> &TimeGrid {
        self.history.times()
    }

    fn count(&self) -> usize {
        self.history.count()
    }

    fn replay(&self, take: &mut dyn FnMut(&Step<'_>) -> Result<(), SinkError>) -> Result<(), SinkError> {
        self.history.replay(&mut |step| {
            let mut displacement = step.displacement.to_vec();
            if step.index == self.step {
                displacement[2 * self.node + 1] = self.value;
            }
            take(&Step { displacement: &displacement, ..*step })
        })
    }
}

/// Messages name the nodes and elements of the mesh.
#[test]
fn failures_name_the_numbers_of_the_mesh() {
    let problem = problem(shuffled().0, gap());
    let (_, history) = ran(&problem);
    let node = 17;
    let told = |step, value| {
        let source = Changed { history: &history, step, node, value };
        let refused = balance(&problem, &source).err().map(|error| error.to_string());
        (estimate(&problem, &source, &analysis(), &mut Unobserved).unwrap_err().to_string(), refused)
    };
    let (start, _) = told(0, 1.0);
    assert!(start.contains("displacement of node 17 at step 0"), "{start}");
    let (hole, refused) = told(3, f64::NAN);
    assert!(hole.contains("step 3: displacement holds a value that is not finite at position 17"), "{hole}");
    assert_eq!(refused.as_ref(), Some(&hole));
}

/// The node that starts too near is one of the 41 at the bottom.
#[test]
fn a_refused_start_names_the_node_of_the_mesh() {
    let (mesh, new) = shuffled();
    let near = problem(mesh, 0.2 * 100.0 * times().step(0));
    let storage = Storage { file: None, memory: None, open: None };
    let failure = simulate(&near, &times(), storage, &mut Unobserved).unwrap_err();
    let bottom: Vec<usize> = (0..41).map(|i| new.node[i]).collect();
    let said = failure.to_string();
    let node: usize = said.strip_prefix("node ").unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!(failure.is_refused_start() && bottom.contains(&node), "{said}");
}

/// Both the histories and the reference may be shuffled.
#[test]
fn true_errors_do_not_depend_on_numbers() {
    let fine = Mesh::rectangle(0.05, 0.04, 80, 64).unwrap();
    let step = 0.85 * critical_time_step(&problem(fine.clone(), 1.0));
    let reference = TimeGrid::uniform(times().end(), (times().end() / step).ceil() as usize).unwrap();
    let error = |coarse: Mesh, fine: Mesh, meshes: Meshes| {
        let (coarse, fine) = (problem(coarse, gap()), problem(fine, gap()));
        let (_, history) = ran(&coarse);
        true_errors(&[(&coarse, &history)], (&fine, &reference), None, meshes, &mut Unobserved)
            .map(|(errors, _)| errors[0].mean)
    };
    let of_nested = error(block(), fine.clone(), Meshes::Nested).unwrap();
    for meshes in [Meshes::Nested, Meshes::Any] {
        // By location, nodes on edges of the coarse mesh may be in either element, where the fields are the same.
        let other = error(shuffled().0, renumbered(&fine, 8).unwrap().0, meshes).unwrap();
        assert!(of_nested > 0.0 && (of_nested - other).abs() <= 1e-10 * of_nested, "{of_nested:e} against {other:e}");
    }

    // A node in the middle of a coarse edge is moved off it: of the elements around it some are not nested.
    let moved = 81 * 20 + 31;
    let cells: Vec<_> = fine.nodes_of::<3>().iter().map(|cell| cell.map(NodeId::index)).collect();
    let face = |f: &FaceId| fine.face_nodes::<2>(*f).map(NodeId::index);
    let groups = fine.face_groups().iter().map(|(name, f)| (name.clone(), f.iter().map(face).collect())).collect();
    let mut points = fine.points_in::<2>().to_vec();
    points[moved][1] += 1e-4;
    let (strange, new) = renumbered(&Mesh::new(points, &cells, &groups, &ElementGroups::new()).unwrap(), 3).unwrap();
    let Err(Failure::Reference(ReferenceError::NotNested { fine })) = error(block(), strange.clone(), Meshes::Nested)
    else {
        panic!("nested")
    };
    assert!(strange.nodes_of::<3>()[fine].contains(&NodeId::new(new.node[moved])), "{fine}");
    // One of 5184 nodes by a sixth of an element.
    let located = error(block(), strange, Meshes::Any).unwrap();
    assert!((located - of_nested).abs() <= 1e-3 * of_nested, "{located:e} against {of_nested:e}");
}
