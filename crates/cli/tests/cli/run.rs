//! Runs of good cases: what is printed where, and the exit codes.

use crate::common::{ARRAYS, BAR, BLOCK, Bench, stderr, stdout};
use serde_json::Value;

/// Runs a case with `--json` and reads the document; standard output holds nothing else.
fn json(case: &str, more: &[&str]) -> Value {
    let output = Bench::new(case).percute(&[&["run", "case.toml", "--json"], more].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The value at a path like `error.sup`.
fn at<'v>(document: &'v Value, path: &str) -> &'v Value {
    path.split('.').fold(document, |value, key| value.get(key).unwrap_or_else(|| panic!("no `{key}` of `{path}`")))
}

/// Names of the warnings of a document.
fn warnings(document: &Value) -> Vec<String> {
    let all = at(document, "warnings").as_array().unwrap();
    all.iter().map(|warning| warning["name"].as_str().unwrap().to_string()).collect()
}

/// All keys of a document, at any depth.
fn keys(value: &Value, found: &mut Vec<String>) {
    match value {
        Value::Object(map) => map.iter().for_each(|(key, value)| {
            found.push(key.clone());
            keys(value, found);
        }),
        Value::Array(list) => list.iter().take(3).for_each(|value| keys(value, found)),
        _ => {}
    }
}

/// Paths of all `null`s.
fn nulls(path: &str, value: &Value, found: &mut Vec<String>) {
    match value {
        Value::Null => found.push(path.to_string()),
        Value::Object(map) => map.iter().for_each(|(key, value)| nulls(&format!("{path}.{key}"), value, found)),
        Value::Array(list) => list.iter().for_each(|value| nulls(path, value, found)),
        _ => {}
    }
}

#[test]
fn the_json_document_has_its_keys() {
    let document = json(BLOCK, &[]);
    let numbers = "time_step critical_time_step steps end time_of_sup seconds impulse_ratio \
        error.sup error.mean error.mean_from_touch error.energy error.strain_energy error.kinetic_energy \
        error.relative_sup error.relative_mean error.relative_stress_sup error.relative_stress_mean \
        error.relative_velocity_sup error.relative_velocity_mean error.published_relative_sup \
        error.published_relative_mean error.reference_sup error.reference_mean \
        parts.kinetic parts.elastic parts.contact \
        balance.kinetic balance.strain balance.initial balance.work_of_loads balance.work_of_supports \
        balance.work_of_contact balance.friction balance.energy_drift balance.impulse_drift \
        residuals.star_compatibility residuals.divergence residuals.penetration_between_instants";
    for path in numbers.split_whitespace() {
        assert!(at(&document, path).is_number(), "{path}");
    }
    assert_eq!(at(&document, "by_element").as_array().unwrap().len(), 40);
    assert_eq!(at(&document, "problem.elements"), 40);
    assert_eq!(at(&document, "problem.nodes"), 30);
    assert_eq!(at(&document, "options.reconstruction"), "corrected");
    assert_eq!(at(&document, "interrupted"), false);
    assert_eq!(at(&document, "versions.percute"), env!("CARGO_PKG_VERSION"));
    let worst = at(&document, "worst_elements").as_array().unwrap();
    assert_eq!(worst.len(), 5);
    assert_eq!(worst[0]["centroid"].as_array().unwrap().len(), 2);
    let by_element = |i: &Value| document["by_element"][i.as_u64().unwrap() as usize].clone();
    assert!(worst.iter().all(|w| w["error"] == by_element(&w["element"])));
    let samples = ["time", "kinetic", "elastic", "contact", "total", "reference"]
        .map(|key| document["over_time"][key].as_array().unwrap().len());
    assert!(samples[0] > 1 && samples.iter().all(|&n| n == samples[0]), "{samples:?}");
}

#[test]
fn the_json_document_agrees_with_the_case() {
    let document = json(BAR, &["--threads", "1", "--window", "7"]);
    // h/c on a uniform bar, eq. [33].
    let critical = 0.1 / 20.0 / (70e9_f64 / 2700.0).sqrt();
    let given = at(&document, "critical_time_step").as_f64().unwrap();
    assert!((given / critical - 1.0).abs() < 1e-6, "{given} against {critical}");
    assert_eq!(at(&document, "steps"), 40);
    assert_eq!(at(&document, "options.window"), 7);
    assert_eq!(at(&document, "problem.mass").as_f64().map(|m| (m * 1e6).round()), Some(5.4e6));
    let document = json(ARRAYS, &[]);
    assert_eq!(at(&document, "problem.reoriented_elements"), 1);
    assert!(warnings(&document).contains(&"reoriented_elements".to_string()));
    assert_eq!(at(&document, "steps"), 3);
}

#[test]
fn every_key_of_the_json_document_is_described() {
    let manual = include_str!("../../../../docs/json.md");
    let mut found = Vec::new();
    keys(&json(BLOCK, &[]), &mut found);
    assert!(found.len() > 60, "{found:?}");
    let missing: Vec<_> = found.iter().filter(|key| !manual.contains(&format!("`{key}`"))).collect();
    assert!(missing.is_empty(), "not in docs/json.md: {missing:?}");
}

#[test]
fn only_what_may_be_absent_is_null() {
    for case in [BLOCK, BAR] {
        let mut found = Vec::new();
        nulls("", &json(case, &[]), &mut found);
        // At instants without contact there is no centre of pressure.
        let may_be = [
            ".options.threads",
            ".options.window",
            ".problem.obstacles.group",
            ".contact.total.centre",
            ".contact.obstacles.centre",
            // Only where nothing was touched.
            ".contact.nearest",
            // A material of the whole mesh has no group, one without a yield stress no share above it.
            ".deformation.materials.group",
            ".deformation.materials.yielding",
            ".deformation.yielding",
            ".verdict.elastic_margin",
            // Nothing yields.
            ".deformation.bodies.permanent_strain",
            // The history is of percute.
            ".consistency",
            ".samples",
            ".simulated_by",
            // A bar has none.
            ".outline",
            // Of several bodies only.
            ".impacts",
            // Contact goes on at the end.
            ".rebound.angular_velocity_after",
            ".rebound.touches_again",
            ".rebound.velocity_after",
            ".rebound.normal_after",
            ".rebound.restitution",
            ".rebound.release",
        ];
        assert!(found.iter().all(|path| may_be.contains(&path.as_str())), "{found:?}");
        assert_eq!(found.contains(&".outline".to_string()), case == BAR);
    }
}

#[test]
fn the_summary_fits_one_screen() {
    let soft = ARRAYS.replace("70e9", "2e3").replace("210e9", "2e3").replace("0.01", "8.0").replace("e-7", "e-3");
    let idle = soft + "[[obstacle]]\npoint = [0.0, -1.0]\nnormal = [0.0, 1.0]\nfriction = 0.0\n";
    for case in [BLOCK, BAR, ARRAYS, &idle] {
        let output = Bench::new(case).percute(&["run", "case.toml"]);
        let summary = stdout(&output);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert!((15..=32).contains(&summary.lines().count()), "{summary}");
        assert!(summary.lines().all(|line| line.chars().count() <= 80), "{summary}");
        for word in [
            "error",
            "sup",
            "mean",
            "worst",
            "drift",
            "residual",
            "impulse",
            "critical",
            "verdict",
            "not a strict bound",
        ] {
            assert!(summary.contains(word), "no `{word}` in {summary}");
        }
    }
}

#[test]
fn warnings_go_to_standard_error_and_stay_in_the_summary() {
    let bench = Bench::new(ARRAYS);
    let loud = bench.percute(&["run", "case.toml"]);
    assert!(stderr(&loud).contains("warning: 1 element was given clockwise"), "{}", stderr(&loud));
    let quiet = bench.percute(&["run", "case.toml", "--quiet"]);
    assert_eq!(stderr(&quiet), "");
    assert!(stdout(&quiet).contains("WARNING   1 element reoriented"), "{}", stdout(&quiet));
}

#[test]
fn nothing_but_the_result_is_printed_off_a_terminal() {
    for arguments in [["run", "case.toml", "--json"], ["run", "case.toml", "--quiet"]] {
        let output = Bench::new(BAR).percute(&arguments);
        let said = stderr(&output);
        assert!(
            said.lines().all(|line| line.starts_with("warning: ")),
            "no progress where there is no terminal: {said}"
        );
        assert!(stdout(&output).ends_with('\n'));
    }
}

#[test]
fn tables_that_bend_between_steps_are_a_warning() {
    let bent =
        BAR.to_string() + "[[traction]]\ngroup = \"end\"\ntime = [0.0, 1.25e-6, 2.5e-6]\nvalue = [0.0, 1e6, 0.0]\n";
    let document = json(&bent, &[]);
    assert!(at(&document, "problem.resampling_error").as_f64().unwrap() > 0.1);
    assert!(warnings(&document).contains(&"resampled".to_string()), "{:?}", warnings(&document));
}

#[test]
fn wrong_arguments_are_bad_input() {
    let bench = Bench::new(BAR);
    let wrong: [(&[&str], &str); 8] = [
        (&["run", "case.toml", "--threads", "0"], "from 1 to 1024"),
        (&["run", "case.toml", "--threads", "many"], "from 1 to 1024"),
        (&["run", "case.toml", "--window", "0"], "1 or more"),
        (&["run", "case.toml", "--jsno"], "--json"),
        (&["run"], "<CASE>"),
        (&["rum", "case.toml"], "run"),
        (&["run", "none.toml"], "none.toml: there is no file of this name"),
        (&["run", "case.toml", "--picture", "map.jpg"], "ends in .svg or .png"),
    ];
    for (arguments, phrase) in wrong {
        let output = bench.percute(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(phrase), "{arguments:?}: {}", stderr(&output));
        assert!(output.stdout.is_empty(), "{arguments:?}");
    }
    for arguments in [["--help"], ["--version"]] {
        let output = bench.percute(&arguments);
        assert_eq!(output.status.code(), Some(0));
        assert!(stdout(&output).contains("percute"));
    }
}

#[test]
fn the_examples_run() {
    for case in [
        include_str!("../../../../examples/block.toml"),
        include_str!("../../../../examples/bar.toml"),
        include_str!("../../../../examples/stack.toml"),
    ] {
        let document = json(case, &["--picture", "map.svg"]);
        assert_ne!(at(&document, "balance.work_of_contact"), 0.0, "no contact");
        assert!(at(&document, "balance.energy_drift").as_f64().unwrap() < 0.1);
    }
}

/// What `percute new` prints is the example of that name, and a case that runs.
#[test]
fn new_cases_are_the_examples() {
    for name in ["bar", "block", "drop"] {
        let bench = Bench::new("");
        let printed = bench.percute(&["new", name]);
        assert_eq!(printed.status.code(), Some(0), "{}", stderr(&printed));
        let example = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../examples/{name}.toml"));
        assert_eq!(stdout(&printed), std::fs::read_to_string(example).unwrap());
        std::fs::write(bench.path("case.toml"), &printed.stdout).unwrap();
        let checked = bench.percute(&["info", "case.toml"]);
        assert_eq!(checked.status.code(), Some(0), "{}", stderr(&checked));
    }
}

/// Such files have no end.
#[cfg(target_os = "linux")]
#[test]
fn a_device_is_no_case() {
    for command in ["run", "simulate", "info"] {
        let output = Bench::new(BLOCK).percute(&[command, "/dev/full"]);
        assert_eq!(output.status.code(), Some(2), "{command}");
        assert!(stderr(&output).contains("/dev/full: ") && stderr(&output).contains("not a regular file"), "{command}");
    }
}

#[test]
fn the_help_of_commands_in_python_names_their_place() {
    let bench = Bench::new(BLOCK);
    let plot = (["plot", "case.toml", "--kind"], "`percute plot` needs the Python package", 1);
    let reproduce = (["reproduce", "table1", "--small"], "the studies of the evidence are not installed", 2);
    for (arguments, why, code) in [plot, reproduce] {
        let command = arguments[0];
        for flag in ["--help", "-h"] {
            let help = bench.percute(&[command, flag]);
            assert!(help.status.success() && help.stderr.is_empty(), "{command} {flag}: {}", stderr(&help));
            assert!(stdout(&help).contains(why), "{command} {flag}: {}", stdout(&help));
        }
        let refused = bench.percute(&arguments);
        assert_eq!(refused.status.code(), Some(code));
        assert!(stderr(&refused).starts_with(&format!("error: {why}")), "{}", stderr(&refused));
    }
}

/// The resultants of the floor and the wall of a corner, by names that count from 0, add up to the total.
#[test]
fn planes_are_counted_from_0_in_tables() {
    let bench = Bench::new(include_str!("../../../../examples/corner.toml"));
    let output = bench.percute(&["run", "case.toml", "--csv", "tables", "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let column = |file: &str, name: &str| -> Vec<f64> {
        let mut table = csv::Reader::from_path(bench.path("tables").join(file)).unwrap();
        let at = table.headers().unwrap().iter().position(|header| header == name);
        let at = at.unwrap_or_else(|| panic!("no column {name}"));
        table.records().map(|row| row.unwrap()[at].parse().unwrap_or(f64::NAN)).filter(|x| x.is_finite()).collect()
    };
    let names = ["force_x (N/m)", "plane_0_force_x (N/m)", "plane_1_force_x (N/m)"];
    let [total, floor, wall] = names.map(|name| column("over_time.csv", name));
    // Rounding of one sum.
    let adds_up = |k: usize| (total[k] - floor[k] - wall[k]).abs() <= 1e-12 * (floor[k].abs() + wall[k].abs());
    assert!(total.len() > 10 && (0..total.len()).all(adds_up), "{total:?} {floor:?} {wall:?}");
    assert!(wall.iter().any(|force| *force > 0.0) && wall.iter().all(|force| *force >= 0.0), "the wall pushes right");
    let mut planes = column("contact_nodes.csv", "plane");
    planes.dedup();
    assert!(planes.iter().all(|plane| [0.0, 1.0].contains(plane)) && planes.len() > 1, "{planes:?}");
}

/// Each shell has all commands and options, and bash takes its script.
#[test]
fn shells_complete_the_command() {
    let bench = Bench::new(BLOCK);
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let output = bench.percute(&["completion", shell]);
        let script = stdout(&output);
        assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""), "{shell}");
        for word in ["completion", "simulate", "reconstruction", "accept-inconsistent"] {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
    let unknown = bench.percute(&["completion", "csh"]);
    assert_eq!(unknown.status.code(), Some(2));
    assert!(stderr(&unknown).contains("bash, elvish, fish, powershell, zsh"), "{}", stderr(&unknown));
    let script = format!(
        "{}\nCOMP_WORDS=(percute run --est); COMP_CWORD=2; _percute percute --est run; echo \"${{COMPREPLY[@]}}\"",
        stdout(&bench.percute(&["completion", "bash"]))
    );
    if let Ok(told) = std::process::Command::new("bash").args(["-c", &script]).output() {
        assert_eq!(stdout(&told).trim(), "--estimate", "{}", stderr(&told));
    }
}

/// A plane that is struck at once is moved back: summary, JSON and standard error say so, the history has the moved
/// plane, and its estimate is that of the run. The same case runs on each mesh of a sweep.
#[test]
fn a_plane_with_the_least_gap() {
    let case = BLOCK.replace("point = [0.0, -0.0005]", "gap = \"auto\"");
    assert_ne!(case, BLOCK);
    let bench = Bench::new(&case);
    let output = bench.percute(&["run", "case.toml", "--history", "h.vtkhdf"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("warning: case.toml:13: [[obstacle]] 1: plane 0 was moved back along its normal"));
    assert!(stdout(&output).contains("plane 0 moved back by "), "{}", stdout(&output));
    let document = json(&case, &[]);
    assert!(warnings(&document).contains(&"moved_plane".to_string()));
    let step = at(&document, "time_step").as_f64().unwrap();
    let least = 0.25 * 400.0 * step;
    let gap = -document["problem"]["obstacles"][0]["point"][1].as_f64().unwrap();
    // Rounded up by 1e-5; the step is that before it is fitted to the end.
    assert!(gap >= least && gap < 1.2 * least, "{gap} against {least}");
    let later = bench.percute(&["estimate", "h.vtkhdf", "--json"]);
    assert_eq!(later.status.code(), Some(0), "{}", stderr(&later));
    let later: Value = serde_json::from_slice(&later.stdout).unwrap();
    assert_eq!((&later["error"], &later["problem"]), (&document["error"], &document["problem"]));
    std::fs::write(bench.path("s.toml"), "case = \"case.toml\"\n[grid]\nmesh.rectangle.nx = [4, 5, 9]\n").unwrap();
    let swept = bench.percute(&["sweep", "s.toml", "--quiet"]);
    assert_eq!(stdout(&swept).lines().next(), Some("3 cases: 3 done"), "{}", stderr(&swept));
}
