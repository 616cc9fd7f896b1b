//! Ctrl-C, and the signals of batch systems and closed terminals.

use crate::common::{BLOCK, Bench, stderr, stdout};
use crate::history::result;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// Starts a run that would take far longer than any test.
pub(crate) fn start(bench: &Bench, arguments: &[&str]) -> Child {
    let program = assert_cmd::cargo::cargo_bin!("percute");
    let mut command = Command::new(program);
    command.current_dir(bench.path("")).args(arguments);
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Processor time that a process has used, in ticks of the system.
fn ticks(child: &Child) -> u64 {
    let stat = std::fs::read_to_string(format!("/proc/{}/stat", child.id())).unwrap();
    let after_name = stat.rsplit(')').next().unwrap();
    let fields: Vec<&str> = after_name.split_whitespace().collect();
    assert_ne!(fields[0], "Z", "the process has ended");
    fields[11].parse::<u64>().unwrap() + fields[12].parse::<u64>().unwrap()
}

/// Lets it compute for a while: by its processor time, not by the clock, as on a busy machine it may not
/// have begun.
fn wait_until(child: &Child, used: u64) {
    while ticks(child) < used {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
}

/// Sends what Ctrl-C sends, after a while.
fn interrupt(child: Child) -> Output {
    wait_until(&child, 30);
    send_interrupt(child)
}

pub(crate) fn send_interrupt(child: Child) -> Output {
    send("INT", child)
}

fn send(signal: &str, child: Child) -> Output {
    let sent = Command::new("sh").args(["-c", &format!("kill -{signal} {}", child.id())]).status().unwrap();
    assert!(sent.success());
    child.wait_with_output().unwrap()
}

fn endless() -> Bench {
    Bench::new(&BLOCK.replace("end = 5e-6", "end = 2.0").replace("nx = 5, ny = 4", "nx = 20, ny = 16"))
}

#[test]
fn ctrl_c_prints_the_summary_of_the_steps_done() {
    let bench = endless();
    let output = interrupt(start(&bench, &["run", "case.toml", "--quiet"]));
    let summary = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(130), "{summary}");
    assert!(summary.contains("INTERRUPTED at step "), "{summary}");
    assert!(summary.lines().count() <= 32 && summary.lines().all(|line| line.chars().count() <= 80), "{summary}");
}

#[test]
fn ctrl_c_leaves_a_whole_json_document() {
    let bench = endless();
    let output = interrupt(start(&bench, &["run", "case.toml", "--json"]));
    assert_eq!(output.status.code(), Some(130));
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["interrupted"], true);
    assert!(document["steps"].as_u64().unwrap() < document["steps_planned"].as_u64().unwrap());
}

/// A simulation of some seconds, with a history of 0.8 GB, most of which is never filled.
fn long() -> Bench {
    let steps = BLOCK.replace("end = 5e-6\ncourant = 0.9", "end = 0.5\nstep = 5e-7");
    Bench::new(&steps)
}

/// What `info` tells of the history of a simulation, which may go on.
fn info(bench: &Bench) -> serde_json::Value {
    info_of(bench, "case.vtkhdf")
}

fn info_of(bench: &Bench, history: &str) -> serde_json::Value {
    let output = bench.percute(&["info", history, "--json"]);
    serde_json::from_slice(&output.stdout).unwrap_or_default()
}

/// Starts a simulation and waits until some steps are in its file.
fn simulating(bench: &Bench) -> Child {
    let child = start(bench, &["simulate", "case.toml", "--quiet"]);
    while info(bench)["steps"].as_u64() < Some(1) {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    child
}

#[test]
fn ctrl_c_finishes_the_history_of_a_simulation() {
    let bench = long();
    let output = send_interrupt(simulating(&bench));
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    assert!(stdout(&output).contains("INTERRUPTED at step "), "{}", stdout(&output));
    let info = info(&bench);
    let (steps, planned) = (info["steps"].as_u64().unwrap(), info["time"]["steps_planned"].as_u64().unwrap());
    assert!(info["complete"] == true && 0 < steps && steps < planned, "{info}");
    let output = bench.percute(&["estimate", "case.vtkhdf", "--every", "1000"]);
    assert_eq!(output.status.code(), Some(0), "the estimate itself was not interrupted: {}", stderr(&output));
    assert!(
        stdout(&output).contains(&format!("INCOMPLETE history of {steps} of {planned} steps")),
        "{}",
        stdout(&output)
    );
}

#[test]
fn ctrl_c_keeps_history_and_estimate_of_the_steps_done() {
    let bench = endless_with_file();
    let output = interrupt(start(&bench, &["run", "case.toml", "--history", "h.vtkhdf", "--json"]));
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    let later = bench.percute(&["estimate", "h.vtkhdf", "--json"]);
    assert_eq!(later.status.code(), Some(0), "{}", stderr(&later));
    assert!(result(&stdout(&later)) == result(&stdout(&output)));
}

/// A run of half a minute, whose files are small.
fn endless_with_file() -> Bench {
    Bench::new(&BLOCK.replace("end = 5e-6", "end = 5e-3").replace("nx = 5, ny = 4", "nx = 20, ny = 16"))
}

#[test]
fn other_signals_close_a_history_too() {
    for signal in ["TERM", "HUP"] {
        let bench = long();
        let output = send(signal, simulating(&bench));
        assert_eq!(output.status.code(), Some(130), "{signal}: {}", stderr(&output));
        let info = stdout(&bench.percute(&["info", "case.vtkhdf"]));
        let words = info.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains("; the run was stopped there; `--resume` continues it"), "{signal}: {info}");
    }
}

#[test]
fn a_killed_simulation_leaves_a_history_to_recover() {
    let bench = long();
    let mut child = simulating(&bench);
    let busy = bench.percute(&["recover", "case.vtkhdf"]);
    assert_eq!(busy.status.code(), Some(1), "its run goes on: {}", stderr(&busy));
    child.kill().unwrap();
    child.wait().unwrap();
    let info = stdout(&bench.percute(&["info", "case.vtkhdf"]));
    let words = info.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("INCOMPLETE: the run is active or was killed;"), "{info}");
    assert!(
        words.contains("; after a kill, `--resume` continues it, and `percute recover case.vtkhdf` closes the file"),
        "the cure is cut off: {info}"
    );
    let estimate = ["estimate", "case.vtkhdf", "--json", "--every", "1000"];
    let before = bench.percute(&estimate);
    assert_eq!(before.status.code(), Some(0), "{}", stderr(&before));
    let recovered = bench.percute(&["recover", "case.vtkhdf"]);
    assert_eq!(recovered.status.code(), Some(0), "{}", stderr(&recovered));
    assert!(stdout(&recovered).contains("is now closed, with "), "{}", stdout(&recovered));
    assert!(!stdout(&bench.percute(&["info", "case.vtkhdf"])).contains("complete"));
    assert!(result(&stdout(&before)) == result(&stdout(&bench.percute(&estimate))));
}

/// Sends the signal and gives the time that the process takes to end.
fn end(signal: &str, child: Child) -> (Output, Duration) {
    let start = Instant::now();
    let output = send(signal, child);
    (output, start.elapsed())
}

/// Half a second, and as much for a busy machine.
const SOON: Duration = Duration::from_secs(1);

/// Nobody waits for the writer of a pipe with a name; one that the shell has opened is read.
#[test]
fn a_pipe_is_refused_by_its_name() {
    let bench = Bench::new(BLOCK);
    assert!(Command::new("mkfifo").arg(bench.path("pipe")).status().unwrap().success());
    for command in ["run", "simulate", "verify", "info", "estimate", "recover", "sweep", "export --output a.vtu"] {
        let arguments: Vec<&str> = command.split(' ').chain(["pipe"]).collect();
        let output = bench.percute(&arguments);
        assert_eq!(output.status.code(), Some(2), "{command}: {}", stderr(&output));
        assert!(stderr(&output).contains("pipe: ") && stderr(&output).contains("a pipe"), "{}", stderr(&output));
    }
    let program = assert_cmd::cargo::cargo_bin!("percute");
    let line = format!("{} run <(cat case.toml) --quiet", program.display());
    let output = Command::new("bash").current_dir(bench.path("")).args(["-c", &line]).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn the_set_up_of_a_large_mesh_is_left_at_once() {
    // Several seconds: two million triangles, and their critical step.
    let bench = Bench::new(&BLOCK.replace("nx = 5, ny = 4", "nx = 1000, ny = 1000"));
    for arguments in [&["info", "case.toml"][..], &["run", "case.toml", "--history", "h.vtkhdf", "--long"]] {
        let child = start(&bench, arguments);
        wait_until(&child, 20);
        let (output, took) = end("INT", child);
        assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
        assert!(took < SOON, "{took:?}");
        assert_eq!(bench.files(), ["case.toml"], "nothing of no use is left");
    }
}

/// Interrupts a run of 240 000 triangles, of which a window takes seconds here, so long after so many steps, with
/// samples at these. Its history is closed.
fn interrupted_after(steps: u64, wait: Duration, every: &str) -> (Bench, Output) {
    let block = BLOCK.replace("nx = 5, ny = 4", "nx = 400, ny = 300");
    let bench = Bench::new(&block.replace("every = 1", &format!("every = {every}")));
    let arguments = ["run", "case.toml", "--history", "h.vtkhdf", "--threads", "1", "--long", "--quiet"];
    let mut child = start(&bench, &arguments);
    while info_of(&bench, "h.vtkhdf")["steps"].as_u64() < Some(steps) {
        assert!(child.try_wait().unwrap().is_none(), "it ended before step {steps}");
        std::thread::sleep(Duration::from_millis(5));
    }
    std::thread::sleep(wait);
    let output = send_interrupt(child);
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    assert_eq!(info_of(&bench, "h.vtkhdf")["complete"], true);
    (bench, output)
}

#[test]
fn a_long_window_is_left_in_its_middle() {
    // A window has eight levels: one with the steps n to n + 7 begins when step n + 9 is stored, and the last estimated
    // step is n - 1 until it ends.
    let left = |wait| {
        let summary = stdout(&interrupted_after(17, Duration::from_millis(wait), "1").1);
        assert!(summary.lines().all(|line| line.chars().count() <= 80), "{summary}");
        let number = |words: &str| -> f64 {
            let rest = summary.split(words).nth(1).expect(&summary);
            rest.split_whitespace().next().unwrap().parse().unwrap()
        };
        let estimated = (number("error until t = ") / number("\n          step ")).round();
        assert!((estimated + 1.0) % 8.0 == 0.0, "windows are kept whole: {summary}");
        number("INTERRUPTED at step ") == estimated + 10.0
    };
    // The signal may also come between two windows.
    assert!([300, 0, 600, 900, 1200, 300].into_iter().any(left), "the window is left out");
}

#[test]
fn a_stop_before_the_first_window_tells_how_to_estimate() {
    // A window of `auto` has some hundred steps on this mesh.
    let (bench, output) = interrupted_after(2, Duration::ZERO, "\"auto\"");
    assert_eq!(stdout(&output), "", "no step is estimated");
    assert!(stderr(&output).contains("`percute estimate h.vtkhdf`"), "{}", stderr(&output));
    assert!(info_of(&bench, "h.vtkhdf")["steps"].as_u64() >= Some(2));
}

#[test]
fn a_lost_folder_costs_no_message() {
    let bench = endless_with_file();
    std::fs::create_dir(bench.path("d")).unwrap();
    let child = start(&bench, &["run", "case.toml", "--picture", "d/a.svg", "--report", "d/b.html", "--quiet"]);
    wait_until(&child, 30);
    std::fs::rename(bench.path("d"), bench.path("e")).unwrap();
    let output = send_interrupt(child);
    let told = stderr(&output);
    assert_eq!(told.matches("error: ").count(), 2, "{told}");
    assert!(told.contains("d/a.svg") && told.contains("d/b.html"), "{told}");
    assert!(stdout(&output).contains("INTERRUPTED at step "), "{}", stdout(&output));
}
