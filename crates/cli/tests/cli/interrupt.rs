//! Ctrl-C.

use crate::common::{BLOCK, Bench};
use std::process::{Child, Command, Output, Stdio};

/// Starts a run that would take far longer than any test.
fn start(bench: &Bench, arguments: &[&str]) -> Child {
    let program = assert_cmd::cargo::cargo_bin!("percute");
    let mut command = Command::new(program);
    command.current_dir(bench.path("")).args(["run", "case.toml"]).args(arguments);
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Processor time that a process has used, in ticks of the system.
fn ticks(child: &Child) -> u64 {
    let stat = std::fs::read_to_string(format!("/proc/{}/stat", child.id())).unwrap();
    let after_name = stat.rsplit(')').next().unwrap();
    let fields: Vec<&str> = after_name.split_whitespace().collect();
    fields[11].parse::<u64>().unwrap() + fields[12].parse::<u64>().unwrap()
}

/// Lets it compute for a while, then sends what Ctrl-C sends.
fn interrupt(child: Child) -> Output {
    // By its processor time, not by the clock: on a busy machine it may not have begun.
    while ticks(&child) < 30 {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let sent = Command::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status().unwrap();
    assert!(sent.success());
    child.wait_with_output().unwrap()
}

fn endless() -> Bench {
    Bench::new(&BLOCK.replace("end = 5e-6", "end = 2.0").replace("nx = 5, ny = 4", "nx = 20, ny = 16"))
}

#[test]
fn ctrl_c_prints_the_summary_of_the_steps_done() {
    let bench = endless();
    let output = interrupt(start(&bench, &["--quiet"]));
    let summary = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(130), "{summary}");
    assert!(summary.contains("INTERRUPTED at step "), "{summary}");
    assert!(summary.lines().count() <= 24 && summary.lines().all(|line| line.chars().count() <= 80), "{summary}");
}

#[test]
fn ctrl_c_leaves_a_whole_json_document() {
    let bench = endless();
    let output = interrupt(start(&bench, &["--json"]));
    assert_eq!(output.status.code(), Some(130));
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["interrupted"], true);
    assert!(document["steps"].as_u64().unwrap() < document["steps_planned"].as_u64().unwrap());
}
