//! Cases whose mesh is a file of Gmsh.

use crate::common::*;
use serde_json::Value;
use std::path::Path;

/// The mesh in `crates/io/tests/gmsh/files`, in mm: 50 × 40, of steel and aluminium.
const CASE: &str = r#"[mesh]
file = "meshes/block.msh"
scale = 1e-3

[[material]]
group = "steel"
young = 210e9
poisson = 0.3
density = 7800.0
plane = "stress"

[[material]]
group = "aluminium"
young = 70e9
poisson = 0.3
density = 2700.0
plane = "stress"

[initial]
velocity = [0.0, -100.0]

[[obstacle]]
point = [0.0, -1e-4]
normal = [0.0, 1.0]
friction = 0.2
group = "bottom"

[time]
end = 5e-6
courant = 0.9
"#;

/// A case beside a mesh file, in one of Gmsh's formats.
fn bench(case: &str, format: &str) -> Bench {
    let bench = Bench::new(case);
    std::fs::create_dir(bench.path("meshes")).unwrap();
    let files = Path::new(env!("CARGO_MANIFEST_DIR")).join("../io/tests/gmsh/files");
    std::fs::copy(files.join(format!("block-{format}.msh")), bench.path("meshes/block.msh")).unwrap();
    bench
}

fn report(bench: &Bench) -> Value {
    let output = bench.percute(&["run", "case.toml", "--json"]);
    assert!(output.status.success(), "{}", stderr(&output));
    serde_json::from_str(&stdout(&output)).unwrap()
}

fn refused(case: &str) -> String {
    let output = bench(case, "4.1").percute(&["run", "case.toml"]);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    stderr(&output)
}

#[test]
fn a_mesh_of_gmsh_is_run_from_every_format() {
    for format in ["4.1", "4.1-binary", "2.2", "2.2-binary"] {
        let report = report(&bench(CASE, format));
        assert_eq!(report["problem"]["nodes"], 38, "{format}");
        let upper: Vec<f64> = serde_json::from_value(report["problem"]["upper_corner"].clone()).unwrap();
        assert_eq!(upper, [0.05, 0.04], "{format}");
        // Area times density, for each metre of thickness; sums of 56 areas round to about 1e-14.
        let (mass, exact) = (report["problem"]["mass"].as_f64().unwrap(), 8e-4 * 7800.0 + 12e-4 * 2700.0);
        assert!((mass - exact).abs() < 1e-13 * exact, "{format}: {mass}");
        assert_eq!(report["largest_residual"]["admissible"], true, "{format}");
        let names: Vec<_> =
            report["warnings"].as_array().unwrap().iter().map(|w| w["name"].as_str().unwrap()).collect();
        for name in ["dropped_nodes", "points_left_out", "inner_edges"] {
            assert!(names.contains(&name), "{format}: {names:?}");
        }
    }
}

/// From wherever the command is run, the file is beside the case.
#[test]
fn the_file_is_relative_to_the_folder_of_the_case() {
    let bench = bench(CASE, "4.1");
    let elsewhere = tempfile::tempdir().unwrap();
    let case = bench.path("case.toml");
    let output = assert_cmd::cargo::cargo_bin_cmd!("percute")
        .current_dir(elsewhere.path())
        .args(["info", case.to_str().unwrap()])
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
}

#[test]
fn what_was_left_out_is_told_before_a_simulation() {
    let output = bench(CASE, "4.1").percute(&["simulate", "case.toml"]);
    let said = stderr(&output);
    assert!(output.status.success(), "{said}");
    assert!(said.contains("warning: 1 node of the mesh file (tag 234) was left out"), "{said}");
    assert!(said.contains("4 edges of the physical group \"interface\" lie inside the body"), "{said}");
}

#[test]
fn mistakes_around_a_file_are_named() {
    for (from, to, phrases) in [
        ("block.msh", "blok.msh", &["case.toml:2", "blok.msh: there is no such file", "folder of the case"][..]),
        ("scale = 1e-3", "scale = 0", &["case.toml:3", "the scale is 0"]),
        ("scale = 1e-3", "scale = \"mm\"", &["case.toml:3", "metres per unit of length"]),
        ("scale = 1e-3", "bar = { length = 1.0, elements = 3 }", &["exactly one of", "`file`"]),
        ("scale = 1e-3", "cells = []", &["case.toml:3", "goes with `points`"]),
        ("file = \"meshes/block.msh\"", "bar = { length = 1.0, elements = 3 }", &["scale", "goes with `file`"]),
        ("file = \"meshes/block.msh\"", "file = 3", &["case.toml:2", "the name of a Gmsh file"]),
        ("file = \"meshes/block.msh\"", "file = \"case.toml\"", &["not a Gmsh mesh", "save as .msh"]),
        ("\"bottom\"", "\"Bottom\"", &["did you mean `bottom`?"]),
        ("\"bottom\"", "\"left\"", &["no group of edges \"left\"", "Physical Curve(\"left\")"]),
        ("\"steel\"", "\"stone\"", &["no group of elements \"stone\"", "Physical Surface(\"stone\")"]),
        ("\"bottom\"", "\"interface\"", &["\"interface\" is empty", "lie inside the body"]),
        ("\"bottom\"", "\"probe\"", &["no group of edges \"probe\"", "points cannot"]),
    ] {
        assert!(CASE.contains(from));
        let said = refused(&CASE.replace(from, to));
        for phrase in phrases {
            assert!(said.contains(phrase), "{from} -> {to}: {said}");
        }
    }
    // In metres, the plane cuts through the body: the unit comes first.
    let metres = CASE.replace("scale = 1e-3\n", "").replace("point = [0.0, -1e-4]", "point = [0.0, 0.02]");
    let said = refused(&metres);
    assert!(said.starts_with("error: case.toml:2: [mesh], file: the mesh in the file is 64.031 m large"), "{said}");
    assert!(said.contains("`scale` = 1e-3. As it is, the plane cuts through the body"), "{said}");
}

/// An error of the mesh itself has both places: the key in the case, the line in the file.
#[test]
fn a_damaged_mesh_is_named_with_its_line() {
    let bench = bench(CASE, "4.1");
    let whole = std::fs::read_to_string(bench.path("meshes/block.msh")).unwrap();
    std::fs::write(bench.path("meshes/block.msh"), &whole[..whole.len() / 2]).unwrap();
    let said = stderr(&bench.percute(&["run", "case.toml"]));
    let lines = whole[..whole.len() / 2].lines().count();
    assert!(said.contains("case.toml:2: [mesh], file: meshes/block.msh, line"), "{said}");
    assert!(said.contains(&format!("line {lines}")) && said.contains("it was cut off"), "{said}");
}

/// Version 2.2 does not say that there are surfaces: curves along x alone look like a bar.
#[test]
fn a_plane_body_of_which_only_a_curve_was_saved_is_told_so() {
    let case = CASE.replace("group = \"steel\"", "").replace("scale = 1e-3", "");
    let bench = Bench::new(&case.replace("meshes/block.msh", "line.msh"));
    let line = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 1 \"bottom\"\n$EndPhysicalNames\n$Nodes\n2\n\
                1 0 0 0\n2 1 0 0\n$EndNodes\n$Elements\n1\n1 1 2 1 1 1 2\n$EndElements\n";
    std::fs::write(bench.path("line.msh"), line).unwrap();
    let said = stderr(&bench.percute(&["run", "case.toml"]));
    assert!(said.contains("does not apply to a bar") && said.contains("Physical Surface(\"body\")"), "{said}");
}

#[test]
fn no_output_takes_the_place_of_the_mesh() {
    let bench = bench(CASE, "4.1");
    let before = std::fs::read(bench.path("meshes/block.msh")).unwrap();
    for flag in ["--history", "--estimate"] {
        let output = bench.percute(&["run", "case.toml", "--force", flag, "meshes/../meshes/block.msh"]);
        assert!(stderr(&output).contains("block.msh is the mesh file itself"), "{}", stderr(&output));
    }
    assert_eq!(std::fs::read(bench.path("meshes/block.msh")).unwrap(), before);
}

#[test]
fn a_mesh_is_no_case() {
    let said = stderr(&bench(CASE, "4.1").percute(&["run", "meshes/block.msh"]));
    assert!(said.contains("this is a Gmsh mesh, not a case"), "{said}");
}

/// What Gmsh called by which name, in the unit of the file.
#[test]
fn info_names_the_groups_of_a_mesh() {
    let output = bench(CASE, "4.1").percute(&["info", "meshes/block.msh", "--json"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let document: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!((&document["kind"], &document["dimension"]), (&Value::from("mesh"), &Value::from(2)));
    assert_eq!(document["upper_corner"], serde_json::json!([50.0, 40.0]));
    let case = report(&bench(CASE, "4.1"));
    for key in ["nodes", "elements"] {
        assert_eq!(document[key], case["problem"][key], "{key}");
    }
    let names = |key: &str| document[key].as_array().unwrap().iter().map(|g| g["name"].clone()).collect::<Vec<_>>();
    assert_eq!(names("element_groups"), ["30", "aluminium", "steel"]);
    assert!(names("edge_groups").contains(&Value::from("bottom")));
    let said = stdout(&bench(CASE, "4.1").percute(&["info", "meshes/block.msh"]));
    assert!(said.contains("group \"steel\" of") && said.contains("(0, 0) to (50.00, 40.00)"), "{said}");
}
