//! The keys of all tables. The schema is the one list of them: editors complete and check cases with it, and the
//! readers accept the keys that it has.

use serde_json::Value;
use std::sync::LazyLock;

/// The JSON schema (draft 2020-12) of the case files, with which editors complete and check them. What needs numbers of
/// the mesh, sums or several values at once is left to the reader.
pub const SCHEMA: &str = include_str!("schema.json");

static CASE: LazyLock<Value> = LazyLock::new(|| serde_json::from_str(SCHEMA).unwrap_or_default());

/// The part of the schema on a table or a value.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SchemaPart(&'static Value);

impl SchemaPart {
    /// That on the case as a whole.
    pub(crate) fn case() -> Self {
        Self(&CASE)
    }

    /// That on a key of the table.
    pub(crate) fn key(self, name: &str) -> Self {
        Self(&self.0["properties"][name]).table()
    }

    /// The keys of the table, in the order of the alphabet.
    pub(crate) fn keys(self) -> Vec<&'static str> {
        self.0["properties"].as_object().into_iter().flatten().map(|(name, _)| name.as_str()).collect()
    }

    /// Where the keys are: in the definition that is named, or in the first of several forms.
    fn table(self) -> Self {
        let named = self.0["$ref"].as_str().and_then(|path| CASE.pointer(path.strip_prefix('#')?));
        named.or_else(|| self.0["anyOf"].get(0)).map_or(self, |inner| Self(inner).table())
    }
}
