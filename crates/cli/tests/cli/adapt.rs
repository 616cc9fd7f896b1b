//! `percute adapt` and `percute plan`.

use crate::common::{Bench, stderr, stdout};
use crate::interrupt::{send_interrupt, start};

/// A corner that strikes slowly.
const CORNER: &str = "[mesh]\nrectangle = { width = 0.05, height = 0.04, nx = 10, ny = 8 }\n[material]\nyoung = 70e9\n\
    poisson = 0.3\ndensity = 2700.0\nplane = \"stress\"\n[initial]\nvelocity = [-0.7, -3.94]\n[[obstacle]]\n\
    point = [0.0, -1e-6]\nnormal = [0.1736, 0.9848]\nfriction = 0.2\n[time]\nend = 40e-6\ncourant = 0.9\n";

/// The table ends with the target, and the saved mesh has its error.
#[test]
fn the_saved_mesh_has_the_error_of_the_table() {
    let bench = Bench::new(CORNER);
    let done =
        bench.percute(&["adapt", "case.toml", "--target", "45%", "--save", "best.msh", "--picture", "adapt.svg"]);
    let told = stdout(&done);
    assert_eq!(done.status.code(), Some(0), "{told}{}", stderr(&done));
    assert!(stderr(&done).contains("run 0 (as given): 160 elements"), "{}", stderr(&done));
    let last = told.lines().last().unwrap();
    assert!(last.starts_with("Target 45.0 % (mean) reached: run "), "{told}");
    let is_row = |line: &&str| line.trim_start().starts_with(|c: char| c.is_ascii_digit());
    assert!(told.lines().filter(is_row).all(|line| line.chars().count() <= 80), "{told}");
    let error = last.split_once(" has ").unwrap().1.split_once(" on ").unwrap().0;
    let mesh = "rectangle = { width = 0.05, height = 0.04, nx = 10, ny = 8 }";
    std::fs::write(bench.path("best.toml"), CORNER.replace(mesh, "file = \"best.msh\"")).unwrap();
    let run = stdout(&bench.percute(&["run", "best.toml", "--quiet"]));
    assert!(run.contains(&format!("mean {error}")), "{error}: {run}");
    assert!(std::fs::read_to_string(bench.path("adapt.svg")).unwrap().contains("elements times steps"));
}

#[test]
fn a_target_that_is_not_reached_fails() {
    let bench = Bench::new(CORNER);
    let done = bench.percute(&["adapt", "case.toml", "--target", "5%", "--limit", "2e5", "--json", "--quiet"]);
    assert_eq!((done.status.code(), stderr(&done).as_str()), (Some(1), ""));
    let document: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
    assert_eq!(
        (&document["reached"], &document["reason"], &document["best"]),
        (&false.into(), &"limit".into(), &1.into())
    );
    assert_eq!(document["iterations"][1]["branch"], "graded");
}

/// Ctrl-C in a long run: the runs that are done are told, and the best mesh is saved.
#[test]
fn ctrl_c_keeps_the_best_mesh() {
    let bench = Bench::new(CORNER);
    let arguments = ["adapt", "case.toml", "--target", "1%", "--limit", "1e12", "--save", "best.msh"];
    let mut child = start(&bench, &arguments);
    // The announcement of the third run comes after two that are done.
    let mut told = std::io::BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    while !line.starts_with("run 2 ") {
        line.clear();
        assert!(std::io::BufRead::read_line(&mut told, &mut line).unwrap() > 0);
    }
    let output = send_interrupt(child);
    let table = stdout(&output);
    assert_eq!(output.status.code(), Some(130), "{table}");
    assert!(table.contains("Interrupted") || table.contains("not reached"), "{table}");
    assert!(bench.path("best.msh").exists(), "{table}");
}

/// A plan names branch and sizes, and writes a field that Gmsh reads: triangles with edges in millimetres.
#[test]
fn a_plan_has_a_size_field() {
    let bench = Bench::new(CORNER);
    let plan = ["plan", "case.toml", "--target", "10%", "--size-field", "h.pos", "--scale", "1e-3", "--quiet"];
    let done = bench.percute(&plan);
    assert!(stdout(&done).contains("branch   graded"), "{}{}", stdout(&done), stderr(&done));
    let text = std::fs::read_to_string(bench.path("h.pos")).unwrap();
    assert!(text.starts_with("View \"size\" {\nST("), "{text}");
    let sizes = text.lines().filter_map(|line| line.split_once("){")?.1.strip_suffix("};"));
    let sizes: Vec<f64> = sizes.flat_map(|three| three.split(',').map(|size| size.parse().unwrap())).collect();
    let [low, high] = [f64::min, f64::max].map(|pick| sizes.iter().copied().reduce(pick).unwrap());
    // Elements of √(12.5) mm with edges of 1.52 times that; a quarter of it in the corner.
    let edge = 1.519_671_371 * 12.5_f64.sqrt();
    assert!((low / (0.25 * edge) - 1.0).abs() < 1e-6 && high <= edge * (1.0 + 1e-6), "{low} {high}");
    // A history has the same plan, and a target that is reached has none.
    assert!(bench.percute(&["simulate", "case.toml", "-o", "h.vtkhdf", "--quiet"]).status.success());
    let of_history = bench.percute(&["plan", "h.vtkhdf", "--target", "10%", "--quiet"]);
    assert_eq!(stdout(&of_history), stdout(&done));
    let reached = bench.percute(&["plan", "h.vtkhdf", "--target", "49%", "--json", "--quiet"]);
    let document: serde_json::Value = serde_json::from_slice(&reached.stdout).unwrap();
    assert_eq!(document["branch"], "graded");
}

/// A reconstruction without sources is refused before any work.
#[test]
fn a_reconstruction_without_sources_is_refused() {
    let bench = Bench::new(&format!("{CORNER}[estimate]\nreconstruction = \"consistent\"\n"));
    let done = bench.percute(&["adapt", "case.toml", "--target", "10%", "--quiet"]);
    let told = stderr(&done);
    assert_eq!(done.status.code(), Some(2), "{told}");
    assert!(told.contains("\"consistent\" has no sources") && !told.contains("run 0"), "{told}");
}
