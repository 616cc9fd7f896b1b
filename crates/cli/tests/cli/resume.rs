//! `--resume`: a killed or stopped run ends as one that was not.

use crate::common::{BLOCK, Bench, stderr, stdout};
use crate::interrupt::{send_interrupt, start};
use percute_io::history::open;
use serde_json::Value;
use std::process::{Child, Output};

/// A run of 1 500 steps on a mesh that is large enough for it to be killed in the middle.
pub(crate) fn case() -> String {
    BLOCK
        .replace("end = 5e-6\ncourant = 0.9", "end = 1.5e-4\nstep = 1e-7")
        .replace("nx = 5, ny = 4", "nx = 50, ny = 40")
}

/// Starts a command and waits until `count` steps are in its file.
pub(crate) fn running(bench: &Bench, arguments: &[&str], file: &str, count: usize) -> Child {
    let written = || Some(open(bench.path(file)).ok()?.count());
    started(bench, arguments, || written() >= Some(count))
}

/// Starts a command and waits until it has got somewhere.
fn started(bench: &Bench, arguments: &[&str], there: impl Fn() -> bool) -> Child {
    let mut child = start(bench, arguments);
    let began = std::time::Instant::now();
    while !there() {
        assert!(began.elapsed().as_secs() < 120 && child.try_wait().unwrap().is_none(), "it has not got there");
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    child
}

fn kill(mut child: Child) {
    child.kill().unwrap();
    child.wait().unwrap();
}

/// The document of a run without its duration.
fn timeless(document: &str) -> Value {
    let mut document: Value = serde_json::from_str(document).unwrap();
    document.as_object_mut().unwrap().remove("seconds").unwrap();
    document
}

/// A file of the run of a case that was not interrupted, and its document.
fn undisturbed(case: &str) -> (Vec<u8>, Value) {
    let bench = Bench::new(case);
    let output = bench.percute(&["run", "case.toml", "--history", "case.vtkhdf", "--json", "--quiet"]);
    (std::fs::read(bench.path("case.vtkhdf")).unwrap(), timeless(&stdout(&output)))
}

/// Exit code and message of a command that refuses.
fn refused(output: &Output) -> (Option<i32>, String) {
    (output.status.code(), stderr(output))
}

const FILE: &str = "case.vtkhdf";
const RUN: [&str; 6] = ["run", "case.toml", "--history", FILE, "--json", "--resume"];

#[test]
fn a_killed_run_ends_as_one_that_was_not() {
    let (file, document) = undisturbed(&case());
    let bench = Bench::new(&case());
    // Where there is no history, the run begins.
    kill(running(&bench, &RUN, FILE, 200));
    let output = bench.percute(&RUN);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains(" of 1501 instants are there"), "{}", stderr(&output));
    assert!(std::fs::read(bench.path("case.vtkhdf")).unwrap() == file, "the history");
    assert_eq!(timeless(&stdout(&output)), document);
    // Once it has ended, its history is estimated.
    let output = bench.percute(&RUN);
    assert_eq!((timeless(&stdout(&output)), output.status.code()), (document, Some(0)));
    assert!(std::fs::read(bench.path("case.vtkhdf")).unwrap() == file, "the history is left alone");
}

/// Ctrl-C in a run that goes on gives no estimate: it would be one of all steps from the first one on.
#[test]
fn a_run_that_goes_on_and_is_stopped_tells_how_to_estimate_it() {
    // Four times as long: a busy machine may look at the file late.
    let bench = Bench::new(&case().replace("end = 1.5e-4", "end = 6e-4"));
    kill(running(&bench, &RUN, FILE, 200));
    // Not opened: a reader would keep the run from its file.
    let changed = || std::fs::metadata(bench.path(FILE)).unwrap().modified().unwrap();
    let before = changed();
    let output = send_interrupt(started(&bench, &RUN, || changed() != before));
    let told = stderr(&output);
    assert!(output.status.code() == Some(130) && stdout(&output).is_empty(), "{told}");
    assert!(told.contains("no estimate was made: `percute estimate case.vtkhdf` estimates the steps done"), "{told}");
    let estimated = bench.percute(&["estimate", FILE, "--json", "--every", "100"]);
    assert_eq!(estimated.status.code(), Some(0), "{}", stderr(&estimated));
}

#[test]
fn a_stopped_simulation_goes_on() {
    let (file, _) = undisturbed(&case());
    let bench = Bench::new(&case());
    let stopped = send_interrupt(running(&bench, &["simulate", "case.toml", "--quiet"], FILE, 300));
    assert_eq!(stopped.status.code(), Some(130));
    let resume = ["simulate", "case.toml", "--resume"];
    let output = bench.percute(&resume);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).contains("in 1500 steps"), "{}", stdout(&output));
    assert!(std::fs::read(bench.path("case.vtkhdf")).unwrap() == file);
    let output = bench.percute(&resume);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(stdout(&output).trim(), "case.vtkhdf holds all 1500 steps already; nothing was changed");
}

/// The simulation goes on from its checkpoint; an estimate needs all steps, and so the whole run.
#[test]
fn a_thinned_history_goes_on_too() {
    let case = format!("{}\n[output]\nhistory = \"case.vtkhdf\"\nevery = 100\nfields = [\"velocity\"]\n", case());
    let (file, document) = undisturbed(&case);
    let bench = Bench::new(&case);
    kill(running(&bench, &["simulate", "case.toml", "--quiet"], FILE, 5));
    assert_eq!(bench.percute(&["simulate", "case.toml", "--resume"]).status.code(), Some(0));
    assert!(std::fs::read(bench.path("case.vtkhdf")).unwrap() == file, "the thinned history");
    let output = bench.percute(&["run", "case.toml", "--json", "--resume"]);
    assert!(
        output.status.code() == Some(2) && stderr(&output).contains("keeps a part of the run"),
        "{}",
        stderr(&output)
    );
    assert!(stderr(&output).contains("with --force, the run begins again and replaces it"), "{}", stderr(&output));
    assert!(std::fs::read(bench.path("case.vtkhdf")).unwrap() == file, "left alone");
    let output = bench.percute(&["run", "case.toml", "--json", "--resume", "--force"]);
    assert_eq!(timeless(&stdout(&output)), document);
    assert!(std::fs::read(bench.path("case.vtkhdf")).unwrap() == file, "made again");
}

/// Each difference between the case and the history has its name.
#[test]
fn another_case_is_refused() {
    let bench = Bench::new(BLOCK);
    assert_eq!(bench.percute(&["simulate", "case.toml"]).status.code(), Some(0));
    let before = std::fs::read(bench.path("case.vtkhdf")).unwrap();
    for (from, to, told) in [
        ("nx = 5", "nx = 6", "[mesh], the number of nodes is 35 in this case and 30 in the history"),
        (
            "width = 0.05",
            "width = 0.06",
            "[mesh], node 1 is [0.012, 0.0] m in this case and [0.01, 0.0] m in the history",
        ),
        ("poisson = 0.3", "poisson = 0.31", "[[material]] 1, poisson is 0.31 in this case and 0.3 in the history"),
        (
            "[time]",
            "[[body_force]]\nvalue = [0.0, 1.0]\n\n[time]",
            "[body_force] is given 1 times in this case and missing",
        ),
        (
            "velocity = [",
            "displacement = [1e-9, 0.0]\nvelocity = [",
            "the initial `displacement` of node 0 is [1e-9, 0.0] m in this case and [0.0, 0.0] m in the history",
        ),
        (
            "-400.0]",
            "-401.0]",
            "the initial `velocity` of node 0 is [400.0, -401.0] m/s in this case and [400.0, -400.0]",
        ),
        ("end = 5e-6", "end = 6e-6", "[time], end is 6e-6 in this case and 5e-6 in the history"),
        ("courant = 0.9", "courant = 0.4", "[time], courant is 0.4 in this case and 0.9 in the history"),
        ("[time]", "[output]\nevery = 3\n\n[time]", "[output], every is 3 in this case and missing in the history"),
        // The end of such a run follows from its simulation.
        (
            "end = 5e-6",
            "end = \"rebound\"\nlongest = 5e-6",
            "[time], end is \"rebound\" in this case and 5e-6 in the history",
        ),
    ] {
        assert!(BLOCK.contains(from), "{from}");
        std::fs::write(bench.path("case.toml"), BLOCK.replacen(from, to, 1)).unwrap();
        let (code, told_here) = refused(&bench.percute(&["simulate", "case.toml", "--resume"]));
        assert!(code == Some(2) && told_here.contains(told), "{to}: {told_here}");
    }
    // A simulation has no estimate, and goes on with other options of it; the estimate of a run does not.
    std::fs::write(bench.path("case.toml"), BLOCK.replacen("every = 1", "every = 3", 1)).unwrap();
    let output = bench.percute(&["simulate", "case.toml", "--resume"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let (code, told) = refused(&bench.percute(&["run", "case.toml", "--history", FILE, "--resume"]));
    assert!(code == Some(2) && told.contains("[estimate], every is 3 in this case and"), "{told}");
    assert!(std::fs::read(bench.path("case.vtkhdf")).unwrap() == before, "left alone");
}

#[test]
fn arguments_that_do_not_fit_are_refused() {
    let bench = Bench::new(BLOCK);
    let (code, told) = refused(&bench.percute(&["run", "case.toml", "--resume"]));
    assert!(
        code == Some(2) && told.contains("--resume needs the history of the run: name it with --history"),
        "{told}"
    );
    let (code, told) = refused(&bench.percute(&["simulate", "case.toml", "--resume", "--force"]));
    assert!(code == Some(2) && told.contains("cannot be used with"), "{told}");
}
