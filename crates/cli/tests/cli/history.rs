//! Histories: stored beside a run or by a simulation alone, and estimated later.

use crate::common::{ARRAYS, BAR, BLOCK, Bench, stderr, stdout};
use serde_json::Value;

const EXAMPLES: [&str; 3] = [
    include_str!("../../../../examples/block.toml"),
    include_str!("../../../../examples/bar.toml"),
    include_str!("../../../../examples/stack.toml"),
];

/// Runs `percute` and expects it to succeed.
fn done(bench: &Bench, arguments: &[&str]) -> String {
    let output = bench.percute(arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
    stdout(&output)
}

/// The text of a JSON document but for its name, its duration, and how many threads and steps at once
/// were asked for. Texts, not numbers: they tell every bit.
pub(crate) fn result(json: &str) -> String {
    let cut = |text: &str, from: &str, to: &str| {
        let (before, rest) = text.split_once(from).unwrap_or_else(|| panic!("no {from} in {text:.200}"));
        format!("{before}{}", rest.split_once(to).unwrap().1)
    };
    let json = cut(json.trim_end(), "\"case\":", ",\"problem\"");
    let json = cut(&json, "\"threads\":", "}");
    cut(&json, "\"seconds\":", "}")
}

#[test]
fn a_stored_history_gives_the_report_of_the_run_bit_by_bit() {
    for case in EXAMPLES {
        let bench = Bench::new(case);
        let beside = result(&done(&bench, &["run", "case.toml", "--json", "--history", "beside.vtkhdf"]));
        done(&bench, &["simulate", "case.toml"]);
        for (threads, window) in [("1", "1"), ("2", "7")] {
            for file in ["beside.vtkhdf", "case.vtkhdf"] {
                let arguments = ["estimate", file, "--json", "--threads", threads, "--window", window];
                let later = result(&done(&bench, &arguments));
                assert!(later == beside, "{}: {threads} threads, {window} steps at once", case.lines().next().unwrap());
            }
        }
        assert!(beside.len() > 1000 && beside.contains("\"over_time\""), "{beside:.300}");
    }
}

#[test]
fn without_a_file_the_result_is_the_same() {
    let bench = Bench::new(BLOCK);
    let with = done(&bench, &["run", "case.toml", "--json", "--history", "a.vtkhdf"]);
    assert_eq!(result(&done(&bench, &["run", "case.toml", "--json"])), result(&with));
}

#[test]
fn options_come_from_the_history_unless_the_command_line_has_them() {
    let estimate = "reconstruction = \"published\"\nacceleration = \"weak\"\nevery = 3\n";
    let case = BLOCK.replace("reconstruction = \"corrected\"\nevery = 1\n", estimate);
    assert_ne!(case, BLOCK);
    let (chosen, plain) = (Bench::new(&case), Bench::new(BLOCK));
    let beside = result(&done(&chosen, &["run", "case.toml", "--json"]));
    done(&chosen, &["simulate", "case.toml"]);
    assert_eq!(result(&done(&chosen, &["estimate", "case.vtkhdf", "--json"])), beside);
    done(&plain, &["simulate", "case.toml"]);
    let arguments = ["estimate", "case.vtkhdf", "--json"];
    let others = ["--reconstruction", "published", "--acceleration", "weak", "--every", "3"];
    assert_eq!(result(&done(&plain, &[&arguments[..], &others[..]].concat())), beside);
    assert_ne!(result(&done(&plain, &arguments)), beside);
    let output = plain.percute(&["estimate", "case.vtkhdf", "--reconstruction", "blunt"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("choose one of corrected, consistent, published"), "{}", stderr(&output));
}

#[test]
fn summaries_name_the_history() {
    let bench = Bench::new(BLOCK);
    let output = bench.percute(&["simulate", "case.toml"]);
    let (said, summary) = (stderr(&output), stdout(&output));
    assert!(said.starts_with("history case.vtkhdf: ") && said.contains(" kB"), "{said}");
    for word in ["case      case.toml", "40 triangles", "drift     energy", "history   case.vtkhdf, ", "steps;"] {
        assert!(summary.contains(word), "no `{word}` in {summary}");
    }
    let summary = done(&bench, &["estimate", "case.vtkhdf"]);
    assert!(summary.starts_with("history   case.vtkhdf (percute "), "{summary}");
    assert!((15..=32).contains(&summary.lines().count()), "{summary}");
    assert_eq!(stderr(&bench.percute(&["simulate", "case.toml", "--force", "--quiet"])), "");
}

#[test]
fn a_picture_of_a_history_is_that_of_its_run() {
    for case in [BAR, BLOCK] {
        let bench = Bench::new(case);
        done(&bench, &["run", "case.toml", "--history", "case.vtkhdf", "--picture", "run.svg"]);
        done(&bench, &["estimate", "case.vtkhdf", "--picture", "later.svg"]);
        let [run, later] = ["run.svg", "later.svg"].map(|name| std::fs::read_to_string(bench.path(name)).unwrap());
        assert_eq!(run.replace("case.toml", ""), later.replace("case.vtkhdf", ""));
    }
}

#[test]
fn files_are_named_by_the_flag_then_by_the_case_then_after_it() {
    let bench = Bench::new(BLOCK);
    let named = BLOCK.to_string() + "[output]\nhistory = \"named.vtkhdf\"\n";
    std::fs::create_dir(bench.path("sub")).unwrap();
    std::fs::write(bench.path("sub/named.toml"), named).unwrap();
    done(&bench, &["simulate", "sub/named.toml"]);
    assert!(bench.path("named.vtkhdf").exists(), "relative to the working directory");
    done(&bench, &["simulate", "sub/named.toml", "--history", "flag.vtkhdf"]);
    assert!(bench.path("flag.vtkhdf").exists());
    std::fs::rename(bench.path("sub/named.toml"), bench.path("sub/other.toml")).unwrap();
    std::fs::write(bench.path("sub/plain.toml"), BLOCK).unwrap();
    done(&bench, &["simulate", "sub/plain.toml"]);
    assert!(bench.path("plain.vtkhdf").exists());
    std::fs::remove_file(bench.path("named.vtkhdf")).unwrap();
    done(&bench, &["run", "sub/other.toml"]);
    assert!(bench.path("named.vtkhdf").exists(), "a run stores what the case asks for");
}

/// The files in the folder of a bench, with their contents.
fn files(bench: &Bench) -> Vec<(std::ffi::OsString, Vec<u8>)> {
    let entries = std::fs::read_dir(bench.path("")).unwrap().map(|entry| entry.unwrap());
    let mut files: Vec<_> = entries
        .filter(|entry| entry.path().is_file())
        .map(|entry| (entry.file_name(), std::fs::read(entry.path()).unwrap()))
        .collect();
    files.sort();
    files
}

#[test]
fn outputs_are_checked_before_any_work() {
    let bench = Bench::new(BLOCK);
    done(&bench, &["simulate", "case.toml", "--history", "there.vtkhdf"]);
    std::fs::write(bench.path("text.vtkhdf"), "mine").unwrap();
    std::fs::create_dir(bench.path("folder")).unwrap();
    let before = files(&bench);
    let wrong: [(&[&str], i32, &str); 17] = [
        (&["simulate", "case.toml", "--history", "there.vtkhdf"], 2, "--history there.vtkhdf: the file exists already"),
        (&["simulate", "case.toml", "--output", "there.vtkhdf"], 2, "--history there.vtkhdf: the file exists already"),
        (&["run", "case.toml", "--history", "text.vtkhdf"], 2, "--force to replace it"),
        (&["run", "case.toml", "--estimate", "text.vtkhdf"], 2, "--estimate text.vtkhdf: the file exists already"),
        (&["estimate", "there.vtkhdf", "--output", "text.vtkhdf"], 2, "--output text.vtkhdf: the file exists already"),
        (&["simulate", "case.toml", "--history", "case.toml", "--force"], 2, "is the case file itself"),
        (&["run", "case.toml", "--history", "./case.toml", "--force"], 2, "is the case file itself"),
        (&["estimate", "there.vtkhdf", "--output", "./there.vtkhdf", "--force"], 2, "is the history itself"),
        (&["estimate", "there.vtkhdf", "--picture", "there.vtkhdf"], 2, "is the history itself"),
        (
            &["run", "case.toml", "--history", "a", "--estimate", "./a"],
            2,
            "--estimate ./a is the file of --history too",
        ),
        (&["run", "case.toml", "--history", "a.svg", "--picture", "a.svg"], 2, "is the file of --history too"),
        (&["run", "case.toml", "--history", "none/a"], 2, "--history: cannot write none/a: there is no folder none"),
        (&["run", "case.toml", "--estimate", "none/a"], 2, "--estimate: cannot write none/a: there is no folder none"),
        (
            &["run", "case.toml", "--picture", "none/a.svg"],
            2,
            "--picture: cannot write none/a.svg: there is no folder none",
        ),
        (
            &["estimate", "there.vtkhdf", "--output", "none/a"],
            2,
            "--output: cannot write none/a: there is no folder none",
        ),
        (&["simulate", "case.toml", "--history", "folder", "--force"], 1, "not a regular file"),
        (&["run", "case.toml", "--history", "a.vtkhdf", "--picture", "a.jpg"], 2, "ends in .svg or .png"),
    ];
    for (arguments, code, phrase) in wrong {
        let output = bench.percute(arguments);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(phrase), "{arguments:?}: {}", stderr(&output));
        assert!(output.stdout.is_empty(), "{arguments:?}");
    }
    assert!(files(&bench) == before, "nothing is made or changed");
    done(&bench, &["simulate", "case.toml", "--history", "there.vtkhdf", "--force"]);
    done(&bench, &["run", "case.toml", "--history", "text.vtkhdf", "--force"]);
    assert_eq!(
        result(&done(&bench, &["estimate", "text.vtkhdf", "--json"])),
        result(&done(&bench, &["estimate", "there.vtkhdf", "--json"]))
    );
}

#[test]
fn a_refused_start_leaves_no_file() {
    let near = BLOCK.replace("point = [0.0, -0.0005]", "point = [0.0, -1e-6]");
    for command in ["run", "simulate"] {
        let bench = Bench::new(&near);
        let output = bench.percute(&[command, "case.toml", "--history", "a.vtkhdf"]);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert!(stderr(&output).contains("error: case.toml:14: ") && !bench.path("a.vtkhdf").exists());
    }
}

/// 5e6 steps of 20 769 nodes: 2.5 TB.
#[test]
fn a_history_that_no_disk_can_hold_is_refused_before_the_run() {
    let large = BLOCK.replace("nx = 5, ny = 4", "nx = 160, ny = 128").replace("courant = 0.9", "step = 1e-12");
    let bench = Bench::new(&large);
    let output = bench.percute(&["simulate", "case.toml", "--long"]);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("case.vtkhdf") && said.contains("free"), "{said}");
    assert!(said.contains("[time], end: is 5e-6 s, which takes 5000000 steps"), "{said}");
    assert!(!bench.path("case.vtkhdf").exists());
}

#[test]
fn info_tells_what_each_file_holds() {
    let bench = Bench::new(&(BLOCK.to_string() + "[output]\nhistory = \"h.vtkhdf\"\n"));
    let of_case: Value = serde_json::from_str(&done(&bench, &["info", "case.toml", "--json"])).unwrap();
    assert!(files(&bench).len() == 1, "nothing is run");
    done(&bench, &["run", "case.toml"]);
    let of_history: Value = serde_json::from_str(&done(&bench, &["info", "h.vtkhdf", "--json"])).unwrap();
    assert_eq!((&of_case["kind"], &of_history["kind"]), (&"case".into(), &"history".into()));
    assert_eq!(of_case["problem"], of_history["problem"]);
    assert_eq!(of_case["time"], of_history["time"]);
    assert_eq!(of_history["steps"], of_case["time"]["steps_planned"]);
    assert_eq!(of_history["complete"], true);
    assert_eq!(of_history["case"], "case.toml");
    let size = std::fs::metadata(bench.path("h.vtkhdf")).unwrap().len();
    assert_eq!(of_history["bytes"].as_u64(), Some(size));
    // What HDF5 needs of its own is foreseen to some ten kilobytes.
    assert!(of_case["history_bytes"].as_u64().unwrap().abs_diff(size) < 20_000, "{of_case} for {size}");
    let manual = include_str!("../../../../docs/json.md");
    for key in [&of_case, &of_history].into_iter().flat_map(|info| info.as_object().unwrap().keys()) {
        assert!(manual.contains(&format!("`{key}`")), "not in docs/json.md: {key}");
    }
}

#[test]
fn info_is_a_few_lines() {
    let bench = Bench::new(&(BLOCK.to_string() + "[output]\nhistory = \"h.vtkhdf\"\n"));
    done(&bench, &["run", "case.toml"]);
    for (file, words) in [
        (
            "case.toml",
            [
                "case      case.toml",
                "material  E 7e10 Pa, density 2700 kg/m³",
                // 0.5 mm at 400 m/s.
                "plane     gap 5e-4 m at 400 m/s: 1.25e-6 s, 6 nodes may touch",
                "on disk",
                "for the estimate",
                "output    history to h.vtkhdf",
            ],
        ),
        (
            "h.vtkhdf",
            [
                "history   h.vtkhdf, ",
                "written   percute",
                "case      case.toml",
                "critical",
                "; complete",
                "for the estimate",
            ],
        ),
    ] {
        let summary = done(&bench, &["info", file]);
        assert!(summary.lines().all(|line| line.chars().count() <= 80), "{summary}");
        words.iter().for_each(|word| assert!(summary.contains(word), "no `{word}` in {summary}"));
    }
    let arrays = Bench::new(ARRAYS);
    assert!(done(&arrays, &["info", "case.toml"]).contains("2 triangles"));
}

#[test]
fn what_is_no_history_is_refused() {
    let bench = Bench::new(BLOCK);
    done(&bench, &["simulate", "case.toml"]);
    let whole = std::fs::read(bench.path("case.vtkhdf")).unwrap();
    std::fs::write(bench.path("half.vtkhdf"), &whole[..whole.len() / 2]).unwrap();
    std::fs::write(bench.path("binary"), b"\xff\xfe\x00").unwrap();
    std::fs::create_dir(bench.path("folder")).unwrap();
    for command in ["estimate", "info", "recover"] {
        for file in ["half.vtkhdf", "binary", "folder", "none", "case.toml"] {
            if (command, file) == ("info", "case.toml") {
                continue;
            }
            let output = bench.percute(&[command, file]);
            let said = stderr(&output);
            assert!(matches!(output.status.code(), Some(1 | 2)), "{command} {file}: {said}");
            assert!(said.starts_with("error: ") && said.contains(file), "{command} {file}: {said}");
            assert!(output.stdout.is_empty(), "{command} {file}");
        }
    }
    let output = bench.percute(&["run", "case.vtkhdf"]);
    assert_eq!(output.status.code(), Some(2), "a history is not a case: {}", stderr(&output));
}

#[test]
fn a_finished_history_needs_no_recovery() {
    let bench = Bench::new(BLOCK);
    done(&bench, &["simulate", "case.toml"]);
    let before = std::fs::read(bench.path("case.vtkhdf")).unwrap();
    let said = done(&bench, &["recover", "case.vtkhdf"]);
    assert!(said.contains("is closed already") && said.contains("nothing was changed"), "{said}");
    assert!(std::fs::read(bench.path("case.vtkhdf")).unwrap() == before);
}

/// `info` of an estimate file.
fn info(bench: &Bench, file: &str) -> Value {
    serde_json::from_str(&done(bench, &["info", file, "--json"])).unwrap()
}

#[test]
fn estimate_files_hold_the_instants_asked_for_and_the_report() {
    let bench = Bench::new(&(BLOCK.to_string() + "[output]\nestimate = \"case-error.vtkhdf\"\ninstants = 3\n"));
    let mut report: Value =
        serde_json::from_str(&done(&bench, &["run", "case.toml", "--json", "--history", "h.vtkhdf"])).unwrap();
    // Identical runs make identical files.
    report["seconds"] = Value::Null;
    let found = info(&bench, "case-error.vtkhdf");
    assert_eq!(
        (&found["kind"], &found["fields"], &found["case"]),
        (&"estimate".into(), &false.into(), &"case.toml".into())
    );
    assert_eq!(found["report"], report);
    let held = |file: &str| {
        info(&bench, file)["instants"].as_array().unwrap().iter().map(|t| t.as_f64().unwrap()).collect::<Vec<_>>()
    };
    let (all, three) = (report["balance_over_time"]["time"].as_array().unwrap(), held("case-error.vtkhdf"));
    let end = all.last().unwrap().as_f64().unwrap();
    assert!(three.len() == 3 && three[0] == 0.0 && three[2] == end, "{three:?}");
    done(&bench, &["estimate", "h.vtkhdf", "--output", "times.vtkhdf", "--instants", "1e-6,5e-6", "--fields"]);
    let times = held("times.vtkhdf");
    assert!(times.len() == 2 && times[1] == end && info(&bench, "times.vtkhdf")["fields"] == true, "{times:?}");
    // No other step is nearer.
    let distance = |t: f64| (t - 1e-6).abs();
    assert!(all.iter().all(|t| distance(t.as_f64().unwrap()) >= distance(times[0])), "{times:?}");
    done(&bench, &["estimate", "h.vtkhdf", "--output", "many.vtkhdf"]);
    assert!(held("many.vtkhdf").len() == all.len().min(50));
    let summary = done(&bench, &["info", "times.vtkhdf"]);
    for word in
        ["estimate  times.vtkhdf, ", "written   percute", "2 instants", "with the admissible fields", "error     sup"]
    {
        assert!(summary.contains(word), "no `{word}` in {summary}");
    }
    let manual = include_str!("../../../../docs/json.md");
    let missing: Vec<_> =
        found.as_object().unwrap().keys().filter(|key| !manual.contains(&format!("`{key}`"))).collect();
    assert!(missing.is_empty(), "not in docs/json.md: {missing:?}");
}

#[test]
fn the_estimate_file_of_a_history_is_that_of_its_run() {
    for case in EXAMPLES {
        let bench = Bench::new(case);
        done(&bench, &["run", "case.toml", "--history", "h.vtkhdf", "--estimate", "beside.vtkhdf", "--fields"]);
        done(
            &bench,
            &["estimate", "h.vtkhdf", "--output", "later.vtkhdf", "--fields", "--threads", "2", "--window", "7"],
        );
        let [beside, later] = ["beside.vtkhdf", "later.vtkhdf"].map(|file| info(&bench, file));
        for key in ["case", "dimension", "nodes", "elements", "instants", "fields"] {
            assert_eq!(beside[key], later[key]);
        }
        assert_eq!(beside["report"]["by_element"], later["report"]["by_element"]);
    }
}

#[test]
fn an_estimate_is_no_history() {
    let bench = Bench::new(BLOCK);
    done(&bench, &["run", "case.toml", "--estimate", "e.vtkhdf"]);
    for command in ["estimate", "recover"] {
        let output = bench.percute(&[command, "e.vtkhdf"]);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert!(stderr(&output).contains("this is an estimate, but a history is needed"), "{}", stderr(&output));
    }
}

#[test]
fn what_an_estimate_file_holds_needs_one() {
    let bench = Bench::new(BLOCK);
    bench.percute(&["simulate", "case.toml", "--quiet"]);
    for (arguments, flag) in [
        (["run", "case.toml", "--fields", "--quiet"], "--estimate FILE"),
        (["run", "case.toml", "--instants", "3"], "--estimate FILE"),
        (["estimate", "case.vtkhdf", "--instants", "3"], "--output FILE"),
    ] {
        let said = bench.percute(&arguments);
        assert_eq!(said.status.code(), Some(2));
        assert!(stderr(&said).contains(flag), "{}", stderr(&said));
    }
    let said = bench.percute(&["run", "case.vtkhdf"]);
    assert_eq!(said.status.code(), Some(2));
    assert!(stderr(&said).contains("this is a history, not a case; `percute estimate` estimates"), "{}", stderr(&said));
}
