//! All single numbers of the document.

use super::html::{Table, section as sectioned};
use crate::document::Document;
use crate::typeset::escaped;
use serde_json::Value;

/// Longest list that is written out.
const SHORT: usize = 8;

/// A table of all numbers, flags and texts with their keys and all their digits.
pub(super) fn section(document: &Document) -> String {
    let mut table = Table::long(&["key", "~value"]);
    walk("", document.all(), &mut table);
    let contents = format!(
        "<details><summary>All numbers of the document with all their digits, by the keys that docs/json.md explains. \
         Units are SI.</summary>\n{}</details>\n",
        table.html()
    );
    sectioned("All numbers", &contents)
}

fn walk(path: &str, value: &Value, table: &mut Table) {
    let mut row = |text: String| table.marked("", vec![format!("<code>{}</code>", escaped(path)), escaped(&text)]);
    let below = |key: &str| if path.is_empty() { key.to_string() } else { format!("{path}.{key}") };
    match value {
        Value::Object(members) => members.iter().for_each(|(key, member)| walk(&below(key), member, table)),
        Value::Array(all) if all.len() > SHORT => row(format!("list of {} values", all.len())),
        Value::Array(all) if all.iter().any(|one| one.is_object() || one.is_array()) => {
            all.iter().enumerate().for_each(|(k, one)| walk(&below(&k.to_string()), one, table));
        }
        Value::Array(all) if all.is_empty() => row("empty list".to_string()),
        Value::Array(all) => row(all.iter().map(plain).collect::<Vec<_>>().join(", ")),
        one => row(plain(one)),
    }
}

fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_string)
}
