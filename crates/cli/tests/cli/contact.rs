//! Contact results in the shell: report, summary, estimate files.

use crate::common::{BAR, BLOCK, Bench, stderr, stdout};
use percute_core::contact::Status;
use percute_core::contact_results::ContactResults;
use percute_io::estimate_file::contact;
use serde_json::Value;

fn json(bench: &Bench, arguments: &[&str]) -> Value {
    let output = bench.percute(arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn stored(bench: &Bench, file: &str) -> ContactResults {
    contact(bench.path(file)).unwrap().unwrap()
}

/// Counts all numbers in a document.
fn numbers(value: &Value) -> usize {
    match value {
        Value::Object(map) => map.values().map(numbers).sum(),
        Value::Array(list) => list.iter().map(numbers).sum(),
        _ => 1,
    }
}

/// The whole record is the same beside the run, from its history, and for 1 to 8 threads; the report says the same.
#[test]
fn an_estimate_file_holds_the_same_contact_wherever_it_was_made() {
    let bench = Bench::new(BLOCK);
    let run = ["run", "case.toml", "--json", "--history", "case.vtkhdf", "--estimate", "beside.vtkhdf"];
    let document = json(&bench, &run);
    let beside = stored(&bench, "beside.vtkhdf");
    for threads in ["1", "2", "8"] {
        let file = format!("{threads}.vtkhdf");
        json(&bench, &["estimate", "case.vtkhdf", "--json", "--output", &file, "--threads", threads, "--window", "5"]);
        assert_eq!(stored(&bench, &file), beside, "{threads} threads");
    }

    let steps = beside.steps.as_ref().unwrap();
    assert!(steps.status.contains(&Status::Slip), "no contact: the test does not test");
    let told = &document["contact"];
    assert_eq!(told["time"].as_array().unwrap().len(), beside.instants.len());
    for (n, resultant) in beside.total.iter().enumerate() {
        assert_eq!(told["total"]["normal_force"][n].as_f64(), Some(resultant.normal_force));
        assert_eq!(told["total"]["in_contact"][n].as_u64(), Some(resultant.in_contact as u64));
        assert_eq!(told["obstacles"][0]["centre"][n][1].as_f64(), resultant.centre.map(|x| x[1]));
    }
    let peak = beside.averaged_peak.unwrap();
    assert_eq!(told["averaged_peak"]["time"].as_f64(), Some(peak.time));
    assert_eq!(told["averaged_peak"]["force"].as_f64(), Some(peak.force));
    // An average is not above the largest force.
    assert!(peak.force <= beside.total[beside.peak().unwrap()].normal_force);
    for (at, place) in beside.nodes.iter().enumerate() {
        assert_eq!(told["nodes"]["node"][at].as_u64(), Some(place.node.index() as u64));
        assert_eq!(told["nodes"]["first_touch"][at].as_f64(), beside.summary[at].first_touch);
        assert_eq!(told["nodes"]["impulse"][at][1].as_f64(), Some(beside.summary[at].impulse[1]));
    }
}

/// Nodes and steps add up, they do not multiply.
#[test]
fn the_report_does_not_hold_all_nodes_at_all_steps() {
    for (nx, end) in [("5", "5e-6"), ("20", "5e-6"), ("20", "20e-6")] {
        let case = BLOCK.replace("nx = 5", &format!("nx = {nx}")).replace("end = 5e-6", &format!("end = {end}"));
        let told = json(&Bench::new(&case), &["run", "case.toml", "--json"])["contact"].take();
        let (nodes, instants) =
            (told["nodes"]["node"].as_array().unwrap().len(), told["time"].as_array().unwrap().len());
        // Of each instant its time and twice the 11 numbers of a resultant; of each node 13.
        assert!(numbers(&told) <= 5 + 23 * instants + 13 * nodes, "{nodes} nodes, {instants} instants");
    }
}

#[test]
fn the_summary_has_a_line_on_contact() {
    for case in [BLOCK, BAR] {
        let bench = Bench::new(case);
        let told = json(&bench, &["run", "case.toml", "--json"])["contact"].take();
        let summary = stdout(&bench.percute(&["run", "case.toml"]));
        let line = summary.lines().find(|line| line.starts_with("contact ")).unwrap_or_else(|| panic!("{summary}"));
        let said: Vec<f64> = line.split([' ', ',']).filter_map(|word| word.parse().ok()).collect();
        let keys = ["/first_touch", "/averaged_peak/force", "/averaged_peak/time", "/averaged_peak/pressure"];
        for (said, key) in said.iter().zip(keys) {
            let exact = told.pointer(key).unwrap().as_f64().unwrap();
            // Four digits are printed.
            assert!((said - exact).abs() <= 1e-3 * exact, "{key}: {line}, {exact}");
        }
        assert_eq!(said.len(), keys.len(), "{line}");
    }
}

#[test]
fn without_planes_or_contact_there_is_no_line() {
    let flying = BLOCK.replace("-400.0]", "0.0]");
    let free = BLOCK.split("[[obstacle]]").next().unwrap().to_string()
        + "[[support]]"
        + BLOCK.split_once("[[support]]").unwrap().1;
    for (case, planes) in [(flying, true), (free, false)] {
        let bench = Bench::new(&case);
        let told = json(&bench, &["run", "case.toml", "--json", "--estimate", "e.vtkhdf"])["contact"].take();
        assert_eq!(told.is_object(), planes, "{told}");
        assert!(told["first_touch"].is_null() && told["averaged_peak"].is_null());
        let summary = stdout(&bench.percute(&["run", "case.toml"]));
        assert!(!summary.contains("\ncontact ") && summary.contains("no contact"), "{summary}");
        assert_eq!(contact(bench.path("e.vtkhdf")).unwrap().is_some(), planes);
    }
}

/// The 6 nodes of the bottom at all instants, 49 bytes each: two vectors, gap, friction energy, status.
#[test]
fn info_tells_the_memory() {
    let bench = Bench::new(&(BLOCK.to_string() + "[output]\nestimate = \"e.vtkhdf\"\n"));
    let info = json(&bench, &["info", "case.toml", "--json"]);
    let instants = info["time"]["steps_planned"].as_u64().unwrap() + 1;
    assert_eq!(info["contact_memory"].as_u64(), Some(6 * instants * 49));
    assert!(stdout(&bench.percute(&["info", "case.toml"])).contains("for the contact results"));
}
