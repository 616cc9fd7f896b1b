//! The section $PhysicalNames, a text in binary files too.

use super::cursor::{Cursor, shown};
use super::error::{Fault, GmshCause};
use super::raw::Tagged;
use super::v2::text_count;
use std::collections::BTreeMap;

/// Reads the names of physical groups, each with its dimension and tag.
pub(super) fn read(cursor: &mut Cursor<'_>, names: &mut BTreeMap<Tagged, String>) -> Result<(), Fault> {
    for _ in 0..text_count(cursor, "the number of physical names", 2)? {
        cursor.skip_space();
        let at = cursor.at();
        let line = cursor.line();
        let text = std::str::from_utf8(line).map_err(|_| {
            let advice = "save names in UTF-8: the script (.geo) in that encoding, then mesh again";
            GmshCause::Unexpected { found: shown(line), what: "a name in UTF-8", advice }.at(at)
        })?;
        let what = "a dimension, a tag and a name in quotes";
        let (key, name) = name(text).ok_or_else(|| Cursor::fault(line, what, at))?;
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
