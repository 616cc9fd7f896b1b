//! Problems, runs and files that the tests share.

use percute_core::contact::Obstacle;
use percute_core::dynamics::{critical_time_step, simulate};
use percute_core::history::{History, StepSource};
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::observer::Unobserved;
use percute_core::problem::{AnyProblem, Initial, Problem};
use percute_core::time::TimeGrid;
use percute_io::history::{HistoryFile, Plan, open};
use percute_io::{Case, FileError, Overwrite};
use std::path::Path;
use tempfile::TempDir;

/// Stands for the problem: this crate does not read it.
pub(crate) const STATEMENT: &str = "[material]\nyoung = 7e10 # é\n";

pub(crate) fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

pub(crate) fn case() -> Case {
    Case { name: "block.toml".to_string(), text: "# a case\n".to_string() }
}

/// A body on its way to a plane two steps below its lowest point.
pub(crate) fn plane_problem(mesh: Mesh, initial: Option<Vec<[f64; 2]>>) -> AnyProblem {
    let lowest = mesh.points_in::<2>().iter().map(|p| p[1]).fold(f64::INFINITY, f64::min);
    let gap = 0.02 * mesh.size();
    let nodes = mesh.node_count();
    Problem::<2>::builder(mesh)
        .material(Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap())
        .initial_displacement(Initial::Nodal(initial.unwrap_or(vec![[0.0; 2]; nodes])))
        .initial_velocity(Initial::Uniform([400.0, -400.0]))
        .obstacle(Obstacle::plane([0.0, lowest - gap], [0.0, 1.0], 0.2, None).unwrap())
        .build()
        .unwrap()
        .into()
}

pub(crate) fn block(nx: usize, ny: usize) -> AnyProblem {
    plane_problem(Mesh::rectangle(0.05, 0.04, nx, ny).unwrap(), None)
}

pub(crate) fn bar(elements: usize) -> AnyProblem {
    Problem::<1>::builder(Mesh::uniform_bar(0.1, elements).unwrap())
        .material(Elastic::bar(70e9, 2700.0, 0.02).unwrap())
        .initial_velocity(Initial::Uniform([-20.0]))
        .obstacle(Obstacle::plane([-1e-5], [1.0], 0.0, None).unwrap())
        .build()
        .unwrap()
        .into()
}

/// Steps at 0.9 of the critical one.
pub(crate) fn steps(problem: &AnyProblem, count: usize) -> TimeGrid {
    TimeGrid::uniform(0.9 * critical_time_step(problem) * count as f64, count).unwrap()
}

/// The steps of a run, in memory.
pub(crate) fn run(problem: &AnyProblem, times: &TimeGrid) -> History {
    let mut history = History::new(times);
    simulate(problem, times, &mut history, &mut Unobserved).unwrap();
    history
}

/// Writes the first `count` steps of a history, without finishing.
pub(crate) fn write_some(
    path: &Path,
    problem: &AnyProblem,
    history: &History,
    count: usize,
) -> percute_io::history::Writer {
    let given = history.step(0).map_or([false; 2], |s| [s.velocity.is_some(), s.acceleration.is_some()]);
    let plan = Plan::new(problem, history.times(), STATEMENT, Some(&case())).with_supplied(given[0], given[1]);
    let mut writer = plan.create(path, Overwrite::Refuse).unwrap();
    (0..count).for_each(|n| writer.push(&history.step(n).unwrap()).unwrap());
    writer
}

/// Writes a history into a finished file.
pub(crate) fn write(path: &Path, problem: &AnyProblem, history: &History) {
    write_some(path, problem, history, history.len()).finish().unwrap();
}

/// A finished file of a small block, and its history.
pub(crate) fn small(path: &Path) -> (AnyProblem, History) {
    let problem = block(4, 3);
    let history = run(&problem, &steps(&problem, 12));
    write(path, &problem, &history);
    (problem, history)
}

pub(crate) fn plane_file(path: &Path) -> HistoryFile {
    open(path).unwrap()
}

pub(crate) fn bar_file(path: &Path) -> HistoryFile {
    open(path).unwrap()
}

/// What comes of opening a file and replaying all its steps for a problem.
pub(crate) fn replayed(path: &Path, problem: &AnyProblem) -> Result<History, FileError> {
    let file = open(path)?;
    let source = file.source(problem)?;
    let mut history = History::new(source.times());
    match source.replay(&mut |step| history.push(step)) {
        Ok(()) => Ok(history),
        Err(error) => Err(*error.downcast::<FileError>().unwrap()),
    }
}

/// Bits of nodal vectors.
pub(crate) fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|x| x.to_bits()).collect()
}

/// Asserts that two histories hold the same bits in their first `count` steps.
pub(crate) fn assert_same(one: &History, other: &History, count: usize) {
    for n in 0..count {
        let (a, b) = (one.step(n).unwrap(), other.step(n).unwrap());
        assert_eq!((a.index, a.time.to_bits(), a.touching), (b.index, b.time.to_bits(), b.touching));
        assert_eq!((bits(a.displacement), bits(a.reaction)), (bits(b.displacement), bits(b.reaction)), "step {n}");
        assert_eq!((a.velocity.map(bits), a.acceleration.map(bits)), (b.velocity.map(bits), b.acceleration.map(bits)));
    }
}

/// Opens a file with the library itself, without its locks: they outlive the file in children that
/// other tests fork.
pub(crate) fn raw(path: &Path, mode: hdf5::OpenMode) -> hdf5::File {
    hdf5::File::with_options().with_fapl(|p| p.file_locking(false)).open_as(path, mode).unwrap()
}
