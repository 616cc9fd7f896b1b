//! Sweeps.

use crate::common::{BLOCK, Bench, stderr, stdout};
use crate::dependencies::root;
use crate::interrupt::{send_interrupt, start};
use serde_json::Value;
use std::path::Path;

/// Two meshes and two frictions.
const SWEEP: &str = "case = \"case.toml\"\n[grid]\n\"mesh.rectangle.nx\" = [5, 6]\nobstacle.0.friction = [0.1, 0.4]\n";

fn bench(sweep: &str) -> Bench {
    let bench = Bench::new(BLOCK);
    std::fs::write(bench.path("sweep.toml"), sweep).unwrap();
    bench
}

/// The rows of a table, each by the names of its columns.
fn rows(file: &Path) -> Vec<Vec<(String, String)>> {
    let text = std::fs::read_to_string(file).unwrap();
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().unwrap().clone();
    let row = |row: csv::StringRecord| header.iter().map(String::from).zip(row.iter().map(String::from)).collect();
    reader.records().map(|record| row(record.unwrap())).collect()
}

fn cell<'r>(row: &'r [(String, String)], name: &str) -> &'r str {
    &row.iter().find(|(column, _)| column == name).unwrap_or_else(|| panic!("no column {name}")).1
}

/// Without what may differ between two equal runs.
fn same(document: &str) -> Value {
    let mut document: Value = serde_json::from_str(document).unwrap();
    for (table, key) in [("", "seconds"), ("options", "threads")] {
        let table = if table.is_empty() { &mut document } else { &mut document[table] };
        table.as_object_mut().unwrap().remove(key).unwrap();
    }
    document
}

#[test]
fn each_case_is_its_single_run() {
    let bench = bench(SWEEP);
    let output = bench.percute(&["sweep", "sweep.toml", "--jobs", "3"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(stdout(&output).lines().next(), Some("4 cases: 4 done"));
    let table = rows(&bench.path("sweep/results.csv"));
    let names: Vec<&str> = table.iter().map(|row| cell(row, "case")).collect();
    assert_eq!(names, ["nx=5,friction=0.1", "nx=5,friction=0.4", "nx=6,friction=0.1", "nx=6,friction=0.4"]);
    for row in &table {
        let (nx, friction) = (cell(row, "mesh.rectangle.nx"), cell(row, "obstacle.0.friction"));
        let case =
            BLOCK.replace("nx = 5", &format!("nx = {nx}")).replace("friction = 0.2", &format!("friction = {friction}"));
        let alone = Bench::new(&case);
        let single = alone.percute(&["run", "case.toml", "--json"]);
        let found = std::fs::read_to_string(bench.path(&format!("sweep/{}/result.json", cell(row, "case")))).unwrap();
        assert_eq!(same(&found), same(&stdout(&single)));
        let mean = same(&found)["error"]["relative_mean"].to_string();
        assert_eq!((cell(row, "status"), cell(row, "relative_mean")), ("done", mean.as_str()));
    }
    // Once more: nothing to do, and the same table.
    let before = std::fs::read(bench.path("sweep/results.csv")).unwrap();
    let again = bench.percute(&["sweep", "sweep.toml"]);
    assert_eq!(stdout(&again).lines().next(), Some("4 cases: 0 done, 4 done before"));
    assert_eq!(std::fs::read(bench.path("sweep/results.csv")).unwrap(), before);
    // Only the new cases are run.
    std::fs::write(bench.path("sweep.toml"), SWEEP.replace("[5, 6]", "[5, 6, 7]")).unwrap();
    let wider = bench.percute(&["sweep", "sweep.toml"]);
    assert_eq!(stdout(&wider).lines().next(), Some("6 cases: 2 done, 4 done before"));
    assert_eq!(stdout(&bench.percute(&["sweep", "sweep.toml", "--force"])).lines().next(), Some("6 cases: 6 done"));
}

#[test]
fn failures_are_recorded_and_the_rest_goes_on() {
    let bench = bench(&SWEEP.replace("[5, 6]", "[5, -6]"));
    let output = bench.percute(&["sweep", "sweep.toml"]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(
        stdout(&output).lines().next(),
        Some("4 cases: 2 done, 2 failed (failure.txt in their folders has the reason)")
    );
    assert!(stderr(&output).contains("nx=-6,friction=0.1: error: case.toml:"), "{}", stderr(&output));
    let table = rows(&bench.path("sweep/results.csv"));
    assert_eq!(table.iter().map(|row| cell(row, "status")).collect::<Vec<_>>(), ["done", "done", "failed", "failed"]);
    assert!(cell(&table[2], "failure").contains("whole number") && cell(&table[2], "sup ((J/m)^½)").is_empty());
    // A failure is tried again.
    let again = bench.percute(&["sweep", "sweep.toml"]);
    assert!(stdout(&again).starts_with("4 cases: 0 done, 2 done before, 2 failed"));
}

/// Results of another case file, of another version, or of no sweep stay until `--force` says otherwise.
#[test]
fn results_are_replaced_by_force_only() {
    let bench = bench(SWEEP);
    let sweep = |force: &[&str]| bench.percute(&[&["sweep", "sweep.toml", "--quiet"], force].concat());
    assert_eq!(sweep(&[]).status.code(), Some(0));
    let document = bench.path("sweep/nx=5,friction=0.1/result.json");
    let kept = std::fs::read_to_string(&document).unwrap();
    let refused = |named: &str| {
        let output = sweep(&[]);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        let told = stderr(&output);
        assert!(told.contains(named) && told.contains("another case file") && told.contains("--force"), "{told}");
    };
    std::fs::write(bench.path("case.toml"), BLOCK.replace("young = 70e9", "young = 71e9")).unwrap();
    refused("nx=5,friction=0.1 and 3 more");
    assert_eq!(std::fs::read_to_string(&document).unwrap(), kept);
    let forced = sweep(&["--force"]);
    assert_eq!(stdout(&forced).lines().next(), Some("4 cases: 4 done"), "{}", stderr(&forced));
    let replaced = std::fs::read_to_string(&document).unwrap();
    assert_ne!(replaced, kept);
    let version = format!("\"percute\":\"{}\"", env!("CARGO_PKG_VERSION"));
    assert!(replaced.contains(&version), "{replaced}");
    std::fs::write(&document, replaced.replace(&version, "\"percute\":\"0.0.1\"")).unwrap();
    refused("nx=5,friction=0.1:");
    std::fs::write(&document, replaced).unwrap();
    // A case whose document was removed is run again; a folder of something else is not replaced.
    std::fs::remove_file(bench.path("sweep/nx=5,friction=0.4/result.json")).unwrap();
    assert_eq!(stdout(&sweep(&[])).lines().next(), Some("4 cases: 1 done, 3 done before"));
    std::fs::write(bench.path("sweep.toml"), SWEEP.replace("[5, 6]", "[5, 6, 7]")).unwrap();
    std::fs::create_dir(bench.path("sweep/nx=7,friction=0.1")).unwrap();
    std::fs::write(bench.path("sweep/nx=7,friction=0.1/notes.txt"), "of mine").unwrap();
    refused("nx=7,friction=0.1:");
    assert!(!bench.path("sweep/nx=7,friction=0.4").exists(), "nothing is run");
}

#[test]
fn parts_make_the_whole() {
    let (parts, whole) = (bench(SWEEP), bench(SWEEP));
    for index in ["0", "1", "2"] {
        let output = parts.percute(&["sweep", "sweep.toml", "--index", index, "--of", "3", "--quiet"]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert!(!parts.path("sweep/results.csv").exists());
    }
    assert!(stdout(&parts.percute(&["sweep", "sweep.toml", "--list"])).starts_with("done   nx=5,friction=0.1\ndone "));
    assert!(stdout(&parts.percute(&["sweep", "sweep.toml", "--collect"])).starts_with("4 of 4 cases"));
    assert_eq!(whole.percute(&["sweep", "sweep.toml"]).status.code(), Some(0));
    let without_time = |bench: &Bench| {
        let mut rows = rows(&bench.path("sweep/results.csv"));
        rows.iter_mut().for_each(|row| row.retain(|(name, _)| name != "seconds (s)"));
        rows
    };
    assert_eq!(without_time(&parts), without_time(&whole));
    let wrong = parts.percute(&["sweep", "sweep.toml", "--index", "3", "--of", "3"]);
    assert_eq!(wrong.status.code(), Some(2));
    assert!(stderr(&wrong).contains("--index is 3; with --of 3 it is at most 2"));
}

#[test]
fn mistakes_are_told_before_any_work() {
    for (sweep, told) in [
        ("[grid]\na = [1]\n".to_string(), "`case` is missing"),
        ("case = \"case.toml\"\n".into(), "no key is varied"),
        ("case = \"cose.toml\"\n[grid]\na = [1]\n".into(), "cose.toml: cannot read the case file"),
        ("case = \"case.toml\"\n[gird]\na = [1]\n".into(), "`gird` is not a key of a sweep; did you mean `grid`?"),
        (SWEEP.replace("nx", "nz"), "`nz`"),
        (SWEEP.replace("mesh.rectangle", "mesh.rectangel"), "did you mean `rectangle`?"),
        (SWEEP.replace("[0.1, 0.4]", "[-0.1, 0.4]"), "friction"),
        (SWEEP.replace("[5, 6]", "[5, 5]"), "two cases of the sweep are the same"),
        (SWEEP.replace("[5, 6]", "5"), "must be a list of values"),
        ("case = \n".into(), "sweep.toml"),
    ] {
        let bench = bench(&sweep);
        let output = bench.percute(&["sweep", "sweep.toml"]);
        assert_eq!(output.status.code(), Some(2), "{sweep}");
        assert!(stderr(&output).contains(told), "{sweep}: {}", stderr(&output));
        assert!(!bench.path("sweep").exists(), "{sweep}");
    }
}

#[test]
fn a_mesh_is_found_from_the_folder_of_its_case() {
    let bench = bench("case = \"beam/beam.toml\"\n[grid]\ntime.end = [5e-6]\n");
    std::fs::create_dir(bench.path("beam")).unwrap();
    for file in ["beam.toml", "beam.msh"] {
        std::fs::copy(root().join("examples").join(file), bench.path("beam").join(file)).unwrap();
    }
    let output = bench.percute(&["sweep", "sweep.toml", "-o", "a/b"]);
    assert_eq!(stdout(&output).lines().next(), Some("1 case: 1 done"), "{}", stderr(&output));
    let case = std::fs::read_to_string(bench.path("a/b/end=5e-6/case.toml")).unwrap();
    assert!(case.contains("file = \"../../../beam/beam.msh\"             # made by Gmsh"), "{case}");
}

#[test]
fn an_interrupted_sweep_leaves_nothing_half_and_goes_on() {
    let bench = Bench::new(&BLOCK.replace("end = 5e-6", "end = 2e-3").replace("nx = 5, ny = 4", "nx = 20, ny = 16"));
    std::fs::write(bench.path("sweep.toml"), "case = \"case.toml\"\n[grid]\n\"time.end\" = [1e-6, 2.0, 1e-6]\n")
        .unwrap();
    let twice = bench.percute(&["sweep", "sweep.toml"]);
    assert!(stderr(&twice).contains("the same"), "{}", stderr(&twice));
    std::fs::write(bench.path("sweep.toml"), "case = \"case.toml\"\n[grid]\n\"time.end\" = [1e-6, 2.0]\n").unwrap();
    let sweep = start(&bench, &["sweep", "sweep.toml", "--jobs", "1", "--long"]);
    let attempts = || {
        let entries = std::fs::read_dir(bench.path("sweep")).into_iter().flatten().flatten();
        entries.filter(|entry| entry.file_name().to_string_lossy().contains("end=2")).count()
    };
    while attempts() == 0 {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let output = send_interrupt(sweep);
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    assert_eq!(stdout(&output).lines().next(), Some("2 cases: 1 done, 1 left; the same command continues with them"));
    assert_eq!(attempts(), 0);
}

#[test]
fn what_a_killed_sweep_left_is_removed() {
    let bench = bench(SWEEP);
    let mut sweep = start(&bench, &["sweep", "sweep.toml", "--jobs", "1"]);
    while !bench.path("sweep").exists() {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    std::thread::sleep(std::time::Duration::from_millis(20));
    sweep.kill().unwrap();
    sweep.wait().unwrap();
    assert_eq!(bench.percute(&["sweep", "sweep.toml"]).status.code(), Some(0));
    let left = std::fs::read_dir(bench.path("sweep")).unwrap().flatten();
    let left: Vec<_> =
        left.map(|entry| entry.file_name()).filter(|name| name.to_string_lossy().starts_with('.')).collect();
    assert!(left.is_empty(), "{left:?}");
    assert_eq!(rows(&bench.path("sweep/results.csv")).len(), 4);
}

/// However a sweep ends, its processes end with it: a kill leaves no time to tell them.
#[test]
#[cfg(target_os = "linux")]
fn processes_end_with_a_killed_sweep() {
    let bench = bench("case = \"case.toml\"\n[grid]\nobstacle.0.friction = [0.1, 0.4]\n");
    let long = BLOCK.replace("nx = 5, ny = 4", "nx = 50, ny = 40").replace("end = 5e-6", "end = 5e-2");
    std::fs::write(bench.path("case.toml"), long).unwrap();
    for signal in ["KILL", "HUP"] {
        let mut sweep = start(&bench, &["sweep", "sweep.toml", "--jobs", "2", "--long", "--quiet"]);
        let children = format!("/proc/{0}/task/{0}/children", sweep.id());
        let running = || std::fs::read_to_string(&children).unwrap().split_whitespace().map(String::from).collect();
        let mut found: Vec<String> = running();
        while found.len() < 2 {
            assert!(sweep.try_wait().unwrap().is_none(), "it has ended");
            std::thread::sleep(std::time::Duration::from_millis(5));
            found = running();
        }
        let id = sweep.id().to_string();
        assert!(std::process::Command::new("kill").args(["-s", signal, &id]).status().unwrap().success());
        sweep.wait().unwrap();
        let lives = |id: &String| {
            std::fs::read(format!("/proc/{id}/cmdline")).is_ok_and(|line| line.windows(3).any(|word| word == b"run"))
        };
        let begun = std::time::Instant::now();
        while found.iter().any(lives) {
            assert!(begun.elapsed().as_secs() < 60, "{signal}: the processes {found:?} go on");
            std::thread::sleep(std::time::Duration::from_millis(10));
        }
    }
}
