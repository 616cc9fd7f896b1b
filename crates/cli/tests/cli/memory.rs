//! Memory that cannot be had is an error with a figure, not the end of the process.

use crate::common::{BAR, BLOCK, Bench, stderr};
use percute_core::mesh::Mesh;
use percute_io::Overwrite;
use percute_io::gmsh::{self, MeshFormat, Version};
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
        (
            &mesh,
            "run case.toml",
            "a mesh of 8000000 elements needs about 3.4 GB with its problem, which is not available",
        ),
        (&mesh, "info case.toml", "give a coarser mesh"),
        (
            &steps,
            "run case.toml --long",
            "10000000 steps: is it correct, and in seconds? As it is, the run needs about",
        ),
        (&steps, "simulate case.toml --long", "of memory, which is not available"),
    ] {
        let output = limited(bench, 700_000, command);
        assert_eq!(output.status.code(), Some(2), "{command}: {}", stderr(&output));
        assert!(stderr(&output).contains(words) && stderr(&output).contains("case.toml:"), "{}", stderr(&output));
    }
    // What fits is done.
    let small = limited(&Bench::new(BLOCK), 700_000, "run case.toml --quiet --threads 1");
    assert_eq!(small.status.code(), Some(0), "{}", stderr(&small));
}

/// Each command at limits from below to above its need: done, or an error with the figure; never an abort.
fn never_aborts(bench: &Bench, arguments: &str, limits: impl IntoIterator<Item = u64>, figure: &str) {
    let (mut refused, mut done) = (0, 0);
    for limit in limits {
        let output = limited(bench, limit, arguments);
        match output.status.code() {
            Some(0) => done += 1,
            Some(2) => {
                refused += 1;
                assert!(stderr(&output).contains(figure), "{arguments} with {limit} kB: {}", stderr(&output));
                assert!(stderr(&output).contains("coarser mesh"), "{}", stderr(&output));
            }
            code => panic!("{arguments} with {limit} kB: {code:?} {}", stderr(&output)),
        }
    }
    assert!(refused > 0 && done > 0, "{arguments}: the limits do not enclose the need ({refused}, {done})");
}

#[test]
fn no_command_is_aborted_for_want_of_memory() {
    let case = BLOCK.replace("nx = 5, ny = 4", "nx = 300, ny = 300");
    let bench = Bench::new(&case);
    never_aborts(&bench, "info case.toml", (60_000..=220_000).step_by(40_000), "180000 elements needs about 0.07");
    let mesh = Mesh::rectangle(1.0, 1.0, 250, 250).unwrap();
    let format = MeshFormat { version: Version::V41, binary: false };
    gmsh::write(&bench.path("block.msh"), Overwrite::Refuse, &mesh, format).unwrap();
    never_aborts(&bench, "info block.msh", (50_000..=200_000).step_by(30_000), "which is not available");
    let small = Bench::new(&BLOCK.replace("nx = 5, ny = 4", "nx = 40, ny = 40").replace("end = 5e-6", "end = 1e-7"));
    let verify = "verify case.toml --levels 2 --quiet --threads 1 --long";
    never_aborts(&small, verify, [80_000, 120_000, 2_000_000], "which is not available");
}

/// A mesh of arrays makes a case long, and its document takes many times the memory of the text.
#[test]
fn a_text_is_measured_before_it_is_read() {
    let bench = Bench::new(&format!("[mesh]\npoints = [{}]\n", "1,".repeat(5_000_000)));
    let output = limited(&bench, 700_000, "info case.toml");
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    let words =
        "case.toml:1: a case of 10.0 MB needs up to 800 MB of memory, which is not available: name a mesh of Gmsh";
    assert!(stderr(&output).contains(words), "{}", stderr(&output));
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

#[test]
fn a_plane_inside_a_large_body_is_found_before_its_mesh_is_made() {
    // Behind the plane lie the nodes on the right; and the right end of a bar.
    let block = BLOCK.replace("[0.0, -0.0005]", "[0.049, 0.0]").replace("[0.0, 1.0]", "[-1.0, 0.0]");
    let block = block.replace("group = \"bottom\"", "group = \"right\"");
    let bar = BAR.replace("point = -0.0002", "point = 0.09").replace("normal = 1.0", "normal = -1.0");
    let cases = [
        (&block, "nx = 5", "nx = 4000000", [5, 4_000_000]),
        (&bar, "elements = 20", "elements = 20000000", [20, 20_000_000]),
    ];
    for (case, coarse, fine, [few, many]) in cases {
        let told = stderr(&limited(&Bench::new(case), 700_000, "info case.toml"));
        assert!(told.contains(&format!("the plane cuts through the body: node {few} starts")), "{told}");
        let output = limited(&Bench::new(&case.replace(coarse, fine)), 700_000, "info case.toml");
        assert_eq!(output.status.code(), Some(2));
        assert_eq!(stderr(&output), told.replace(&format!("node {few} "), &format!("node {many} ")));
    }
}
