//! The evidence, computed with the small effort.

mod committed;
mod folder;
mod tables;

use crate::common::{Bench, stderr};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::OnceLock;

/// A folder with all parts, made once for all tests.
fn evidence() -> &'static Bench {
    static MADE: OnceLock<Bench> = OnceLock::new();
    MADE.get_or_init(|| made(&["--threads", "1"]))
}

/// All parts with the small effort, and with what is given.
fn made(more: &[&str]) -> Bench {
    let bench = Bench::new("");
    let output = bench.percute(&[&["reproduce", "--small", "--output", "ev"], more].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    bench
}

/// A text in the folder.
fn read(bench: &Bench, name: &str) -> String {
    std::fs::read_to_string(bench.path("ev").join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn numbers(bench: &Bench) -> Value {
    serde_json::from_str(&read(bench, "numbers.json")).unwrap()
}

/// All files below a folder, with what they hold.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_string();
        if path.is_dir() {
            found.extend(files(&path).into_iter().map(|(below, content)| (format!("{name}/{below}"), content)));
        } else {
            found.insert(name, std::fs::read(&path).unwrap());
        }
    }
    found
}
