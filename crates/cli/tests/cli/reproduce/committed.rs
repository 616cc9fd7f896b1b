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

/// Whether a cell holds what is left of zero: relative errors of 1e-12 or so, which any change of the order of sums moves.
fn is_rounding(cell: &str) -> bool {
    cell.replace('−', "-").parse::<f64>().is_ok_and(|x| x != 0.0 && x.abs() < 1e-9)
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
            let equal =
                |ours: &str, theirs: &str| ours == "–" || ours == theirs || (is_rounding(ours) && is_rounding(theirs));
            let same = |other: &&Vec<&str>| row.iter().zip(*other).all(|(ours, theirs)| equal(ours, theirs));
            assert!(
                there.iter().any(|other| other.len() == row.len() && same(&other)),
                "docs/verification.md does not have the row {row:?} of {heading}"
            );
            rows += 1;
        }
    }
    assert!(small.len() >= 5 && rows > 50, "{} tables, {rows} rows", small.len());
}

/// What every estimate says of the readings is what the page has: of the default the smallest and largest effectivity of bars up to
/// the end of contact and of plane bodies, with short steps too, and the largest where a corner touches first; of the others how
/// far off they may lie.
#[test]
fn every_estimate_says_what_the_page_has() {
    let page =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/verification.md")).unwrap();
    let tables = tables(&page);
    let (mut least, mut most, mut corner) = (f64::INFINITY, 0.0_f64, 0.0_f64);
    let (mut others, mut slow) = ([f64::INFINITY, 0.0_f64], 0.0_f64);
    for row in tables.values().flatten() {
        let number = |at: usize| row[at].parse::<f64>().unwrap();
        match row[..] {
            [body, "corrected", _, ..] if row.len() == 7 => {
                if body.contains("10°") {
                    corner = corner.max(number(4)).max(number(6));
                } else {
                    (least, most) = (least.min(number(3)).min(number(5)), most.max(number(4)).max(number(6)));
                }
            }
            // Slow impacts.
            [body, "corrected", _, over, ..] if row.len() == 6 => {
                if over.parse().is_ok_and(|over: f64| over >= 0.01) {
                    let highest = if body.contains("10°") { &mut corner } else { &mut most };
                    *highest = highest.max(number(4)).max(number(5));
                } else if body.contains("10°") {
                    slow = slow.max(number(5));
                }
            }
            ["consistent" | "published", "closest", ..] if row.len() == 11 => others[0] = others[0].min(number(5)),
            [_, "consistent" | "published", "sup" | "mean", ..] if row.len() == 8 => {
                others[1] = others[1].max(number(4))
            }
            ["corrected", "closest", _, "2.0", ..] if row.len() == 11 => {
                (least, most) = (least.min(number(5)), most.max(number(7)));
            }
            ["corner first", "corrected", "sup" | "mean", ..] => corner = corner.max(number(4)),
            [_, "corrected", "sup" | "mean", ..] if row.len() == 8 => {
                (least, most) = (least.min(number(3)), most.max(number(4)));
            }
            _ => {}
        }
    }
    let said = percute_workflow::report::meaning(Some(percute_estimator::Reconstruction::Corrected));
    // Rounded outward to what can be said.
    let down = |x: f64| (20.0 * x).floor() / 20.0;
    let up = |x: f64| (10.0 * x).ceil() / 10.0;
    let told = format!(
        "In tests with steps of 0.02 to 0.9 Δt_c: {} to {} times the true error, up to {} if",
        down(least),
        up(most),
        up(corner)
    );
    assert!(slow > up(corner) && said.contains("far more if a corner or a curve touches slower than c/100"), "{slow}");
    assert!(said.contains(&told), "the page has {least} to {most}, {corner} at corners; said is: {said}");
    for reading in [percute_estimator::Reconstruction::Consistent, percute_estimator::Reconstruction::Published] {
        let said = percute_workflow::report::meaning(Some(reading));
        let told = format!("in tests {:.2} to over 3 times the true error", others[0]);
        assert!(said.contains(&told) && others[1] > 3.0, "the page has {others:?}; said is: {said}");
    }
}
