//! Results outlive their files: what can still be given is given.

use crate::common::{BLOCK, Bench, stderr, stdout};
use crate::interrupt::start;
use std::process::Command;
use std::time::{Duration, Instant};

/// A run of about a second, with its history in a folder.
fn bench() -> Bench {
    let bench = Bench::new(&BLOCK.replace("end = 5e-6", "end = 3e-3").replace("1e-4]", "1e-2]"));
    std::fs::create_dir(bench.path("before")).unwrap();
    bench
}

fn wait_for(bench: &Bench, name: &str) {
    let begin = Instant::now();
    while !bench.path(name).exists() {
        assert!(begin.elapsed() < Duration::from_secs(60), "{name} did not appear");
        std::thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn a_folder_that_is_renamed_costs_no_result() {
    let bench = bench();
    let arguments =
        ["run", "case.toml", "--history", "before/a.vtkhdf", "--estimate", "e.vtkhdf", "--picture", "p.svg", "--quiet"];
    let child = start(&bench, &arguments);
    wait_for(&bench, "before/a.vtkhdf");
    std::fs::rename(bench.path("before"), bench.path("after")).unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stdout(&output).contains("\nresult    sup "), "{}", stdout(&output));
    let told = stderr(&output);
    assert!(told.contains("was moved, removed or replaced during the run; all steps done are in it, as "), "{told}");
    assert!(told.contains("after/a.vtkhdf"), "{told}");
    assert!(bench.path("p.svg").exists() && bench.path("e.vtkhdf").exists());
    let info = bench.percute(&["info", "after/a.vtkhdf"]);
    assert!(stdout(&info).contains("complete"), "{}", stdout(&info));
}

#[test]
fn a_simulation_whose_file_is_gone_tells_no_size_of_it() {
    let bench = bench();
    let child = start(&bench, &["simulate", "case.toml", "--history", "before/a.vtkhdf", "--quiet"]);
    wait_for(&bench, "before/a.vtkhdf");
    std::fs::rename(bench.path("before"), bench.path("after")).unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stdout(&output).contains("before/a.vtkhdf, which is no longer there"), "{}", stdout(&output));
    assert!(!stdout(&output).contains("bytes"), "{}", stdout(&output));
}

#[test]
fn of_two_runs_on_one_file_the_second_is_refused_at_its_start() {
    let bench = bench();
    let run = |picture: &str| {
        start(&bench, &["run", "case.toml", "--history", "a.vtkhdf", "--force", "--quiet", "--picture", picture])
    };
    for there in [false, true] {
        let outputs = [run("p.svg"), run("q.svg")].map(|child| child.wait_with_output().unwrap());
        let mut codes = outputs.iter().map(|output| output.status.code()).collect::<Vec<_>>();
        codes.sort_unstable();
        assert_eq!(codes, [Some(0), Some(1)], "with a file before: {there}");
        let loser = outputs.iter().find(|output| output.status.code() == Some(1)).unwrap();
        assert!(stderr(loser).contains("another program is using the file"), "{}", stderr(loser));
        assert_eq!(stdout(loser), "");
        let info = bench.percute(&["info", "a.vtkhdf"]);
        assert!(stdout(&info).contains("complete"), "{}", stdout(&info));
    }
}

/// Files that cannot be written to their end leave those that they would replace, and nothing else. The limit on the
/// size of files is in blocks of 512 bytes, and `trap` makes it an error of writing.
#[test]
fn a_file_that_is_not_written_whole_replaces_none() {
    let bench = Bench::new(BLOCK);
    let names = ["e.vtkhdf", "p.svg", "p.png", "r.html", "t.csv"];
    names.iter().for_each(|name| std::fs::write(bench.path(name), "old").unwrap());
    let before = bench.files();
    let program = assert_cmd::cargo::cargo_bin!("percute");
    for (picture, file) in [("p.svg", "r.html"), ("p.png", "e.vtkhdf")] {
        let outputs = format!("--estimate e.vtkhdf --picture {picture} --report r.html --csv t.csv --force --quiet");
        let line = format!("trap '' XFSZ; ulimit -f 2; exec {} run case.toml {outputs}", program.display());
        let output = Command::new("sh").current_dir(bench.path("")).args(["-c", &line]).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
        assert!(stdout(&output).contains("\nresult    sup "), "the result is printed all the same");
        for name in [picture, file, "t.csv"] {
            assert!(stderr(&output).contains(name), "{}", stderr(&output));
        }
    }
    assert_eq!(bench.files(), before);
    for name in names {
        assert_eq!(std::fs::read(bench.path(name)).unwrap(), b"old", "{name}");
    }
}

#[test]
fn identical_runs_make_identical_files() {
    let bench = Bench::new(BLOCK);
    let names = |run: usize| ["h.vtkhdf", "e.vtkhdf", "p.svg", "p.html"].map(|name| format!("{run}-{name}"));
    for run in 0..2 {
        // Times in files have whole seconds.
        std::thread::sleep(Duration::from_millis(1100 * run as u64));
        let [history, estimate, picture, page] = names(run);
        let made = bench.percute(&[
            "run",
            "case.toml",
            "--history",
            &history,
            "--estimate",
            &estimate,
            "--picture",
            &picture,
            "--report",
            &page,
        ]);
        assert_eq!(made.status.code(), Some(0), "{}", stderr(&made));
    }
    for (a, b) in names(0).iter().zip(names(1)) {
        let [a, b] = [bench.path(a), bench.path(&b)].map(|path| std::fs::read(path).unwrap());
        let differ = a.iter().zip(&b).position(|(a, b)| a != b);
        assert!(a == b, "{b:?} differs at {differ:?}", b = names(1));
    }
}
