//! Memory that cannot be had is an error with a figure, not the end of the process.

use crate::common::{BLOCK, Bench, stderr};
use std::process::{Command, Output};
use std::time::{Duration, Instant};

/// Runs the command with so much address space (kB).
fn limited(bench: &Bench, kilobytes: u64, arguments: &str) -> Output {
    let program = assert_cmd::cargo::cargo_bin!("percute");
    let line = format!("ulimit -v {kilobytes}; exec {} {arguments}", program.display());
    Command::new("sh").current_dir(bench.path("")).args(["-c", &line]).output().unwrap()
}

#[test]
fn too_little_memory_is_told_before_the_work() {
    let mesh = Bench::new(&BLOCK.replace("nx = 5, ny = 4", "nx = 2000, ny = 2000"));
    let steps =
        Bench::new(&BLOCK.replace("end = 5e-6\ncourant = 0.9", "end = 1.0\nstep = 1e-7").replace("1e-4]", "2.0]"));
    for (bench, command, words) in [
        (&mesh, "run case.toml", "a mesh of 8000000 elements needs about 1.4 GB, which cannot be had"),
        (&mesh, "info case.toml", "give a coarser mesh"),
        (
            &steps,
            "run case.toml --long",
            "10000000 steps: is it correct, and in seconds? As it is, the run needs about",
        ),
        (&steps, "simulate case.toml --long", "of memory, which cannot be had"),
    ] {
        let output = limited(bench, 700_000, command);
        assert_eq!(output.status.code(), Some(2), "{command}: {}", stderr(&output));
        assert!(stderr(&output).contains(words) && stderr(&output).contains("case.toml:"), "{}", stderr(&output));
    }
    // What fits is done.
    let small = limited(&Bench::new(BLOCK), 700_000, "run case.toml --quiet --threads 1");
    assert_eq!(small.status.code(), Some(0), "{}", stderr(&small));
}

#[test]
fn mistakes_are_found_before_a_large_mesh_is_made() {
    for (right, wrong) in [("friction = 0.2", "friction = -0.2"), ("group = \"left\"", "group = \"lft\"")] {
        let case = BLOCK.replace("ny = 4", "ny = 4000000").replace(right, wrong);
        let bench = Bench::new(&case);
        let start = Instant::now();
        // The mesh alone needs 6.8 GB, and would be refused.
        let output = limited(&bench, 700_000, "run case.toml");
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(wrong.split(" = ").next().unwrap()), "{}", stderr(&output));
        assert!(!stderr(&output).contains("GB"), "{}", stderr(&output));
        assert!(start.elapsed() < Duration::from_secs(5));
    }
}
