//! Tables of a case file: which keys they may have, and which they must.

use super::Value;
use super::absent::absent;
use crate::case::SchemaPart;
use crate::case::source::{At, CaseError, Source};
use crate::message::{hint, list};
use toml::de::DeTable;

/// A table with its place.
#[derive(Clone, Debug)]
pub(crate) struct Table<'a> {
    pub(in crate::case) source: &'a Source,
    pub(in crate::case) table: &'a DeTable<'a>,
    pub(in crate::case) at: At,
    /// What joins the table's path to that of a key: `, ` after a header, `.` inside.
    pub(in crate::case) joint: &'static str,
    /// What the schema says of it.
    pub(in crate::case) part: SchemaPart,
}

impl<'a> Table<'a> {
    /// The document as a whole.
    pub(in crate::case) fn root(source: &'a Source, table: &'a DeTable<'a>) -> Self {
        Self { source, table, at: At { path: String::new(), span: 0..0 }, joint: "", part: SchemaPart::case() }
    }

    /// An error of the table as a whole.
    pub(crate) fn error(&self, message: impl Into<String>) -> CaseError {
        self.source.error(&self.at, message)
    }

    /// Refuses keys that the table does not have.
    pub(crate) fn only(&self) -> Result<(), CaseError> {
        self.only_but(&[])
    }

    /// Refuses keys that the table does not have, and some of those that it has.
    pub(crate) fn only_but(&self, excluded: &[&str]) -> Result<(), CaseError> {
        let known: Vec<&str> = self.part.keys().into_iter().filter(|key| !excluded.contains(key)).collect();
        let mut strangers: Vec<_> = self.table.keys().filter(|key| !known.contains(&key.get_ref().as_ref())).collect();
        // The first in the file, not in the alphabet.
        strangers.sort_by_key(|key| key.span().start);
        let Some(key) = strangers.first() else { return Ok(()) };
        let name = key.get_ref().as_ref();
        let at = At { path: self.path_of(name), span: key.span() };
        let what = if self.joint.is_empty() { "table" } else { "key" };
        let message = absent(name, &self.at.path).map_or_else(
            || {
                let hint = hint(name, known.iter().copied());
                format!("there is no {what} `{name}` here; allowed are {}{hint}", list(known.iter().copied()))
            },
            str::to_string,
        );
        Err(self.source.error(&at, message))
    }

    /// The value of a key, if it is there.
    pub(crate) fn get(&self, key: &str) -> Option<Value<'a>> {
        let (found, value) = self.table.get_key_value(key)?;
        let at = At { path: self.path_of(key), span: found.span() };
        Some(Value { source: self.source, value: value.get_ref(), at, part: self.part.key(key) })
    }

    /// The value of a key that must be there; `what` says what it is, with its unit.
    pub(crate) fn require(&self, key: &str, what: &str) -> Result<Value<'a>, CaseError> {
        self.get(key).ok_or_else(|| self.error(format!("`{key}` is missing: give {what}")))
    }

    /// All keys with their values, in the order of the file.
    pub(crate) fn entries(&self) -> Vec<(&'a str, Value<'a>)> {
        let value = |key: &'a str| Some((key, self.get(key)?));
        let mut entries: Vec<_> = self.table.keys().filter_map(|key| value(key.get_ref().as_ref())).collect();
        entries.sort_by_key(|(_, value)| value.at.span.start);
        entries
    }

    /// Refuses a key that belongs to another kind of body, and says why.
    pub(crate) fn refuse(&self, key: &str, why: &str) -> Result<(), CaseError> {
        self.get(key).map_or(Ok(()), |value| Err(value.error(why)))
    }

    /// The tables of this name: none, one `[name]`, or several `[[name]]`.
    pub(crate) fn tables(&self, name: &str) -> Result<Vec<Table<'a>>, CaseError> {
        let Some((key, value)) = self.table.get_key_value(name) else { return Ok(Vec::new()) };
        let part = self.part.key(name);
        let one =
            |path: String, span, table| Table { source: self.source, table, at: At { path, span }, joint: ", ", part };
        if let Some(table) = value.get_ref().as_table() {
            return Ok(vec![one(format!("[{name}]"), key.span(), table)]);
        }
        let wrong = || {
            let at = At { path: name.to_string(), span: key.span() };
            self.source
                .error(&at, format!("is not a table; write [{name}] on a line of its own, or several [[{name}]]"))
        };
        let entries = value.get_ref().as_array().ok_or_else(wrong)?;
        if entries.is_empty() {
            let at = At { path: name.to_string(), span: key.span() };
            let told = format!("is an empty list; write [{name}] on a line of its own, or leave it out");
            return Err(self.source.error(&at, told));
        }
        let numbered = entries.iter().enumerate();
        numbered
            .map(|(i, entry)| {
                let table = entry.get_ref().as_table().ok_or_else(wrong)?;
                Ok(one(format!("[[{name}]] {}", i + 1), entry.span(), table))
            })
            .collect()
    }

    /// The only table of this name, if there is one.
    pub(crate) fn single(&self, name: &str) -> Result<Option<Table<'a>>, CaseError> {
        let mut tables = self.tables(name)?;
        match tables.get(1) {
            None => Ok(tables.pop()),
            Some(second) => Err(second.error(format!("there can be one [{name}] only; leave one out"))),
        }
    }

    fn path_of(&self, key: &str) -> String {
        format!("{}{}{key}", self.at.path, self.joint)
    }
}
