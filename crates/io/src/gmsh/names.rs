//! The section $PhysicalNames, a text in binary files too.

use super::cursor::Cursor;
use super::error::Fault;
use super::raw::Tagged;
use super::v2::text_count;
use std::collections::BTreeMap;

/// Reads the names of physical groups, each with its dimension and tag.
pub(super) fn read(cursor: &mut Cursor<'_>, names: &mut BTreeMap<Tagged, String>) -> Result<(), Fault> {
    for _ in 0..text_count(cursor, "the number of physical names", 2)? {
        cursor.skip_space();
        let at = cursor.at();
        let line = cursor.line();
        let named = std::str::from_utf8(line).ok().and_then(name);
        let what = "a dimension, a tag and a name in quotes (in UTF-8)";
        let (key, name) = named.ok_or_else(|| Cursor::fault(line, what, at))?;
        names.insert(key, name.to_string());
    }
    Ok(())
}

fn name(line: &str) -> Option<(Tagged, &str)> {
    let (numbers, rest) = line.split_once('"')?;
    let mut numbers = numbers.split_ascii_whitespace();
    let key = (numbers.next()?.parse().ok()?, numbers.next()?.parse().ok()?);
    rest.strip_suffix('"').map(|name| (key, name))
}
