//! From a place that the core names to its line in the file.

use super::source::At;
use super::table::Table;
use percute_core::problem::Place;

/// The key that a place names; where the file leaves it out, its table; where that is left out
/// too, what must have made it matter.
pub(super) fn find(root: &Table<'_>, place: Place) -> At {
    let path =
        if place.key.is_empty() { format!("[{}]", place.table) } else { format!("[{}], {}", place.table, place.key) };
    if let Some(at) = in_bodies(root, place) {
        return at;
    }
    let Ok(tables) = root.tables(place.table) else { return At { path, span: 0..0 } };
    match tables.get(place.index.unwrap_or(0)) {
        Some(table) => match table.get(place.key) {
            Some(value) => value.at,
            None => table.at.clone(),
        },
        None => At { path, span: moving_support(root).unwrap_or(0..0) },
    }
}

/// With `[[body]]`, what `[mesh]`, `[material]` and `[initial]` would have is in the bodies.
fn in_bodies(root: &Table<'_>, place: Place) -> Option<At> {
    let bodies = root.tables("body").ok()?;
    let first = bodies.first()?.at.clone();
    let of = |key: &str| bodies.iter().find_map(|body| Some(body.get(key)?.at));
    match place.table {
        "mesh" => Some(first),
        "contact" if place.index.is_none() => Some(first),
        "material" => Some(bodies.get(place.index.unwrap_or(0))?.get("material")?.at),
        "initial" => Some(of("velocity").unwrap_or(first)),
        _ => None,
    }
}

/// Without `[initial]`, a start that disagrees is a support's that moves.
fn moving_support(root: &Table<'_>) -> Option<std::ops::Range<usize>> {
    let supports = root.tables("support").ok()?;
    supports.iter().find_map(|support| Some(support.get("velocity")?.at.span))
}
