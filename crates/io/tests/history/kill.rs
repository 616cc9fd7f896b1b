//! Runs that are killed at any moment leave files that open, with all whole steps.

use crate::history::common::*;
use percute_core::dynamics::simulate;
use percute_core::history::Discard;
use percute_core::observer::Unobserved;
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;
use percute_estimator::{Options, Request, Sampling, estimate};
use percute_io::history::{Plan, recover};
use percute_io::{FileCause, Overwrite};
use percute_testkit::Random;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Number of the run for the child to do, and where.
const RUN: &str = "PERCUTE_TEST_RUN";
const FILE: &str = "PERCUTE_TEST_FILE";
/// Its number of steps.
const STEPS: &str = "PERCUTE_TEST_STEPS";

/// Larger meshes with every run; about as many numbers in each, 24 MB of displacements.
fn problem(run: usize, when: When) -> (AnyProblem, TimeGrid) {
    let nx = 5 + run % 100;
    let problem = block(nx, 4 + run % 100 * 4 / 5);
    let most = if when == When::Ending { 20 } else { 1_000_000 / problem.mesh().node_count() };
    let times = steps(&problem, most);
    (problem, times)
}

/// What the killed process does; without its environment it is no test.
#[test]
fn child() {
    let (Ok(run), Ok(path)) = (std::env::var(RUN), std::env::var(FILE)) else { return };
    let when = if std::env::var(STEPS).is_ok() { When::Ending } else { When::Writing };
    let (problem, times) = problem(run.parse().unwrap(), when);
    let plan = Plan::new(&problem, &times, STATEMENT, None);
    let mut writer = plan.create(path, Overwrite::Refuse).unwrap();
    simulate(&problem, &times, &mut writer, &mut Unobserved).unwrap();
    writer.finish().unwrap();
}

/// When a run is killed.
#[derive(Clone, Copy, PartialEq)]
enum When {
    /// At any moment, perhaps before its file has its name.
    Ever,
    /// At any moment once its file is there.
    Writing,
    /// About when it ends: a short one, that takes as long as it is waited for.
    Ending,
}

/// Starts a run and kills it.
fn kill(run: usize, path: &Path, when: When, random: &mut Random) {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["--exact", "history::kill::child"]).stdout(Stdio::null());
    command.envs([(RUN, run.to_string()), (FILE, path.to_str().unwrap().to_string())]);
    if when == When::Ending {
        command.env(STEPS, "few");
    }
    let mut child = command.spawn().unwrap();
    let start = Instant::now();
    while when != When::Ever && !path.exists() && start.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(1));
    }
    let longest = if when == When::Ending { 6_000.0 } else { 60_000.0 };
    std::thread::sleep(Duration::from_micros(random.between(0.0, longest) as u64));
    child.kill().unwrap();
    child.wait().unwrap();
}

/// Kills that many runs. Returns how many files there were, and how many of them were not complete.
fn check(runs: std::ops::Range<usize>, when: When) -> (usize, usize) {
    let folder = folder();
    let mut random = Random::new(42);
    let (mut files, mut unfinished) = (0, 0);
    for run in runs {
        let path = folder.path().join(format!("{run}.vtkhdf"));
        kill(run, &path, when, &mut random);
        if !path.exists() {
            continue;
        }
        files += 1;
        let (problem, times) = problem(run, when);
        let file = plane_file(&path);
        unfinished += usize::from(!file.is_complete());
        let undisturbed = crate::history::common::run(&problem, &times);
        let replayed = replayed(&path, &problem).unwrap();
        assert_eq!(replayed.len(), file.count());
        assert_same(&replayed, &undisturbed, file.count());
        if file.count() > 2 {
            let options = Options { every: Sampling::Every(50), ..Options::default() };
            let source = file.source(&problem).unwrap();
            let (_, estimate) =
                estimate(&problem, &source, options, &Request::default(), &mut Discard, &mut Unobserved).unwrap();
            assert_eq!(estimate.steps, file.count() - 1);
        }
        if file.count() == 0 {
            assert!(matches!(recover(&path).unwrap_err().cause, FileCause::NoStep));
        } else {
            assert_eq!(recover(&path).unwrap().count, file.count());
        }
        assert_eq!(plane_file(&path).is_complete(), file.count() > 0);
        std::fs::remove_file(&path).unwrap();
    }
    (files, unfinished)
}

/// Every run leaves its file. A run takes longer than the 60 ms within which it is killed, so that most
/// files are unfinished ones.
#[test]
fn twenty_kills() {
    let (files, unfinished) = check(0..20, When::Writing);
    assert!(files == 20 && unfinished >= 14, "{files} files, {unfinished} of them unfinished");
}

/// While the file is finished too. How many get that far depends on the machine: each is checked.
#[test]
fn kills_about_the_end() {
    assert_eq!(check(0..30, When::Ending).0, 30);
}

/// While the file is made too: it has no name then, or it is whole.
#[test]
fn kills_from_the_start() {
    check(40..46, When::Ever);
}

#[test]
#[ignore = "a minute; twenty of them run always"]
fn a_hundred_kills() {
    let (files, unfinished) = check(0..100, When::Writing);
    assert!(files == 100 && unfinished >= 70, "{files} files, {unfinished} of them unfinished");
}
