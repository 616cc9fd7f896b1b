//! Every example runs, with both readings of the contact force and all three choices of Γ_DA, and is
//! admissible to rounding.

use crate::common::{Bench, stderr};
use serde_json::Value;
use std::path::Path;

fn examples() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    files.filter(|f| f.extension().is_some_and(|e| e == "toml")).map(|f| std::fs::read_to_string(f).unwrap()).collect()
}

#[test]
fn examples_run_with_every_option() {
    let cases = examples();
    assert!(cases.len() >= 3);
    for case in cases {
        let body = case.split("[estimate]").next().unwrap();
        for force in ["sharp", "paper"] {
            for acceleration in ["closest", "rigid", "weak"] {
                let text =
                    format!("{body}\n[estimate]\ncontact_force = \"{force}\"\nacceleration = \"{acceleration}\"\n");
                let output = Bench::new(&text).percute(&["run", "case.toml", "--json"]);
                assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
                let document: Value = serde_json::from_slice(&output.stdout).unwrap();
                let title = case.lines().next().unwrap();
                assert!(document["error"]["sup"].as_f64().unwrap() > 0.0, "{title}");
                // Far above rounding, which leaves some 1e-14, and far below any real misfit.
                let largest = document["largest_residual"]["value"].as_f64().unwrap();
                assert!(largest <= 1e-10, "{title}, {force}, {acceleration}: {}", document["largest_residual"]);
            }
        }
    }
}
