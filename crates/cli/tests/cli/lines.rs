//! Lines of the sources: those that rustfmt leaves as they are, comments and texts, have 120 characters at most, too.

use super::dependencies::root;
use std::path::Path;

const MOST: usize = 120;

/// The lines of the Rust files in a folder that are too long, each with its place.
fn too_long(folder: &Path, found: &mut Vec<String>) {
    for entry in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        if entry.is_dir() {
            too_long(&entry, found);
        } else if entry.extension().is_some_and(|end| end == "rs") {
            let text = std::fs::read_to_string(&entry).unwrap();
            let long = text.lines().enumerate().filter(|(_, line)| line.chars().count() > MOST);
            found.extend(long.map(|(at, line)| format!("{}:{}: {line}", entry.display(), at + 1)));
        }
    }
}

#[test]
fn no_line_is_too_long() {
    let mut found = Vec::new();
    ["crates", "benches"].iter().for_each(|folder| too_long(&root().join(folder), &mut found));
    assert!(found.is_empty(), "{}", found.join("\n"));
}
