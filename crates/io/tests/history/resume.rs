//! Runs that were killed or stopped go on: their files are, byte by byte, those of runs that were not.

use crate::history::common::*;
use percute_core::dynamics::{resume, simulate};
use percute_core::observer::Unobserved;
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;
use percute_io::history::{HistoryFile, Plan, StoredPart, Unended, recover};
use percute_io::{FileCause, Overwrite};
use percute_testkit::Random;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Number of the run for the child to do, and its file.
const RUN: &str = "PERCUTE_TEST_RESUMED_RUN";
const FILE: &str = "PERCUTE_TEST_RESUMED_FILE";

/// All steps, or each seventh and the last without reactions.
fn kept(run: usize, times: &TimeGrid) -> Option<StoredPart> {
    let last = times.step_count();
    let steps = (0..last).step_by(7).chain([last]).collect();
    (run % 3 == 2).then_some(StoredPart { steps, velocity: false, acceleration: false, reaction: false })
}

/// Larger meshes with every run.
fn problem(run: usize) -> (AnyProblem, TimeGrid) {
    let problem = block(5 + run % 60, 4 + run % 60);
    let times = steps(&problem, 600_000 / problem.mesh().node_count());
    (problem, times)
}

fn begin(path: &Path, problem: &AnyProblem, times: &TimeGrid, kept: Option<StoredPart>) {
    let plan = Plan::new(problem, times, STATEMENT, Some(&case())).keeping(kept);
    let mut writer = plan.create(path, Overwrite::Refuse).unwrap();
    simulate(problem, times, &mut writer, &mut Unobserved).unwrap();
    writer.finish().unwrap();
}

/// Goes on with a run; returns the step of its checkpoint.
fn go_on(file: &HistoryFile, problem: &AnyProblem) -> Option<usize> {
    let (Unended { checkpoint, mut writer }, times) = (file.resume(problem).unwrap(), file.run_times());
    match &checkpoint {
        Some(from) => resume(problem, times, None, from, &mut writer, &mut Unobserved).unwrap(),
        None => simulate(problem, times, &mut writer, &mut Unobserved).unwrap(),
    };
    writer.finish().unwrap();
    checkpoint.map(|checkpoint| checkpoint.step)
}

fn undisturbed(folder: &Path, problem: &AnyProblem, times: &TimeGrid, kept: Option<StoredPart>) -> Vec<u8> {
    let path = folder.join("undisturbed.vtkhdf");
    begin(&path, problem, times, kept);
    let bytes = std::fs::read(&path).unwrap();
    std::fs::remove_file(path).unwrap();
    bytes
}

/// The work of the killed process, which begins a run or goes on with it; without its environment it is no test.
#[test]
fn child() {
    let (Ok(run), Ok(path)) = (std::env::var(RUN), std::env::var(FILE).map(PathBuf::from)) else { return };
    let run = run.parse().unwrap();
    let (problem, times) = problem(run);
    if path.exists() {
        go_on(&plane_file(&path), &problem);
    } else {
        begin(&path, &problem, &times, kept(run, &times));
    }
}

/// Starts a process that begins a run or goes on with it, and kills it once its file is there.
fn kill(run: usize, path: &Path, random: &mut Random) {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["--exact", "history::resume::child"]).stdout(Stdio::null()).stderr(Stdio::null());
    command.envs([(RUN, run.to_string()), (FILE, path.to_str().unwrap().to_string())]);
    let mut child = command.spawn().unwrap();
    let start = Instant::now();
    while !path.exists() && start.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(1));
    }
    std::thread::sleep(Duration::from_micros(random.between(0.0, 60_000.0) as u64));
    child.kill().unwrap();
    child.wait().unwrap();
}

/// Kills each run twice, the second time as it goes on, and then lets it end. Returns the number of runs that went on
/// from a checkpoint.
fn check(runs: std::ops::Range<usize>) -> usize {
    let (folder, mut random) = (folder(), Random::new(7));
    let mut resumed = 0;
    for run in runs {
        let path = folder.path().join(format!("{run}.vtkhdf"));
        let (problem, times) = problem(run);
        for _ in 0..2 {
            kill(run, &path, &mut random);
        }
        let file = plane_file(&path);
        let from = if file.has_ended() { None } else { go_on(&file, &problem) };
        resumed += usize::from(from.is_some());
        let whole = undisturbed(folder.path(), &problem, &times, kept(run, &times));
        assert!(std::fs::read(&path).unwrap() == whole, "run {run}, from {from:?}");
        std::fs::remove_file(&path).unwrap();
    }
    resumed
}

/// The runs take some 100 ms or more, so that a killed one has a checkpoint in most cases.
#[test]
fn twenty_kills_and_ends() {
    let resumed = check(0..10);
    assert!(resumed >= 5, "{resumed} of 10 runs went on from a checkpoint");
}

#[test]
#[ignore = "some minutes; twenty of them run always"]
fn two_hundred_kills_and_ends() {
    let resumed = check(0..100);
    assert!(resumed >= 50, "{resumed} of 100 runs went on from a checkpoint");
}

/// Writes the first steps of a run of 200, and leaves the file as a killed process does, or as a stopped one.
fn leave(path: &Path, problem: &AnyProblem, times: &TimeGrid, count: usize, stopped: bool) {
    let plan = Plan::new(problem, times, STATEMENT, Some(&case()));
    let mut writer = plan.create(path, Overwrite::Refuse).unwrap();
    let mut seen = 0;
    let mut stop = |_: percute_core::observer::Progress| {
        seen += 1;
        if seen == count { std::ops::ControlFlow::Break(()) } else { std::ops::ControlFlow::Continue(()) }
    };
    simulate(problem, times, &mut writer, &mut stop).unwrap();
    if stopped {
        writer.finish().unwrap();
    }
}

#[test]
fn a_run_goes_on_wherever_it_ended() {
    let (folder, problem) = (folder(), block(6, 5));
    let times = steps(&problem, 200);
    let whole = undisturbed(folder.path(), &problem, &times, None);
    for (count, from) in [(1, None), (64, None), (65, Some(64)), (130, Some(128)), (193, Some(192)), (200, Some(192))] {
        for (stopped, recovered) in [(true, false), (false, true), (false, false)] {
            let path = folder.path().join("left.vtkhdf");
            leave(&path, &problem, &times, count, stopped);
            if recovered {
                recover(&path).unwrap();
            }
            let file = plane_file(&path);
            assert!(!file.has_ended());
            assert_eq!((file.is_complete(), file.count()), (stopped || recovered, count));
            assert_eq!(go_on(&file, &problem), from, "of {count} instants");
            assert!(plane_file(&path).has_ended());
            assert!(
                std::fs::read(&path).unwrap() == whole,
                "{count} instants, stopped {stopped}, recovered {recovered}"
            );
            std::fs::remove_file(&path).unwrap();
        }
    }
}

/// A run that was killed as it was completing its file.
#[test]
fn a_recovered_file_with_all_steps_is_that_of_its_run() {
    let (folder, problem) = (folder(), block(6, 5));
    let times = steps(&problem, 200);
    let whole = undisturbed(folder.path(), &problem, &times, None);
    let path = folder.path().join("left.vtkhdf");
    leave(&path, &problem, &times, 201, false);
    assert_eq!((plane_file(&path).is_complete(), recover(&path).unwrap().count), (false, 201));
    assert!(plane_file(&path).has_ended() && std::fs::read(&path).unwrap() == whole);
}

/// Of two checkpoints, the newer one is not whole if the run was killed as it was written.
#[test]
fn a_torn_checkpoint_is_not_used() {
    let (folder, problem) = (folder(), block(6, 5));
    let times = steps(&problem, 200);
    let whole = undisturbed(folder.path(), &problem, &times, None);
    let path = folder.path().join("torn.vtkhdf");
    leave(&path, &problem, &times, 180, false);
    let mut bytes = std::fs::read(&path).unwrap();
    // u_128 stands in its step and in its checkpoint, which has no third component.
    let file = plane_file(&path);
    let field: Vec<u8> = file.displacement(128..129).unwrap().iter().flat_map(|x| x.to_ne_bytes()).collect();
    let places: Vec<usize> = (0..bytes.len() - field.len()).filter(|&at| bytes[at..].starts_with(&field)).collect();
    let [place] = places[..] else { panic!("{places:?}") };
    bytes[place + 17] ^= 4;
    std::fs::write(&path, bytes).unwrap();
    assert_eq!(go_on(&plane_file(&path), &problem), Some(64));
    assert!(std::fs::read(&path).unwrap() == whole);
}

#[test]
fn a_bar_goes_on_too() {
    let (folder, problem) = (folder(), bar(12));
    let times = steps(&problem, 300);
    let whole = undisturbed(folder.path(), &problem, &times, None);
    let path = folder.path().join("bar.vtkhdf");
    write_some(&path, &problem, &run(&problem, &times), 250);
    // Its steps came from a history, which gives no checkpoints.
    assert_eq!(go_on(&bar_file(&path), &problem), None);
    assert!(std::fs::read(&path).unwrap() == whole);
}

/// A step that was damaged before the checkpoint would stay so.
#[test]
fn a_damaged_step_is_refused_before_the_work() {
    let (folder, problem) = (folder(), block(6, 5));
    let times = steps(&problem, 200);
    let path = folder.path().join("damaged.vtkhdf");
    leave(&path, &problem, &times, 180, false);
    let file = plane_file(&path);
    let array = file.arrays().unwrap().into_iter().find(|array| array.name == "displacement").unwrap();
    let mut bytes = std::fs::read(&path).unwrap();
    bytes[array.offset.unwrap() as usize + 24 * problem.mesh().node_count() * 100 + 9] ^= 1;
    std::fs::write(&path, &bytes).unwrap();
    let error = plane_file(&path).resume(&problem).unwrap_err();
    assert!(matches!(&error.cause, FileCause::Checksum { step: Some(100), .. }), "{error}");
    assert!(std::fs::read(&path).unwrap() == bytes, "left alone");
}

/// The file of a run belongs to one writer.
#[test]
fn a_file_in_use_is_refused() {
    let (folder, problem) = (folder(), block(6, 5));
    let times = steps(&problem, 200);
    let path = folder.path().join("used.vtkhdf");
    leave(&path, &problem, &times, 100, true);
    let file = plane_file(&path);
    let first = file.resume(&problem).unwrap();
    assert!(matches!(file.resume(&problem).unwrap_err().cause, FileCause::InUse));
    assert!(matches!(recover(&path).unwrap_err().cause, FileCause::InUse));
    drop(first);
    assert!(file.resume(&problem).is_ok());
}
