//! The page of the repository, compared with what is computed now.

use super::{evidence, read};
use std::collections::BTreeMap;
use std::path::Path;

/// Rows of the tables of a Markdown page, by the line of their headings.
fn tables(page: &str) -> BTreeMap<&str, Vec<Vec<&str>>> {
    let mut tables: BTreeMap<&str, Vec<Vec<&str>>> = BTreeMap::new();
    let mut heading = "";
    let mut before = "";
    for line in page.lines() {
        if line.starts_with("| ---") {
            heading = before;
        } else if line.starts_with('|') && !heading.is_empty() {
            let cells = line.trim_matches('|').split(" | ").map(str::trim).collect();
            tables.entry(heading).or_default().push(cells);
        } else {
            heading = "";
        }
        before = line;
    }
    tables
}

/// The small effort computes some rows of the full one, and leaves cells empty that need the others: each must stand in
/// `docs/verification.md` as it is. After a change that is meant to move them, write that page anew, as
/// `CONTRIBUTING.md` says.
#[test]
fn the_committed_page_says_what_is_computed() {
    let page =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/verification.md")).unwrap();
    let (committed, small) = (tables(&page), read(evidence(), "verification.md"));
    let small = tables(&small);
    let mut rows = 0;
    for (heading, computed) in &small {
        let there = committed.get(heading).unwrap_or_else(|| panic!("docs/verification.md has no table {heading}"));
        for row in computed {
            let same = |other: &&Vec<&str>| row.iter().zip(*other).all(|(ours, theirs)| *ours == "–" || ours == theirs);
            assert!(
                there.iter().any(|other| other.len() == row.len() && same(&other)),
                "docs/verification.md does not have the row {row:?} of {heading}"
            );
            rows += 1;
        }
    }
    assert!(small.len() >= 5 && rows > 50, "{} tables, {rows} rows", small.len());
}
