//! The values of a sweep, from its file, from JSON, and from tables of comma-separated values.

use crate::key::Key;
use percute_workflow::Failure;
use std::path::Path;
use toml_edit::{Array, InlineTable, TableLike, Value};

/// More cases than these are refused.
const MOST: usize = 1_000_000;

/// The values of the keys of a sweep.
#[derive(Clone, Debug, Default)]
pub struct Values {
    keys: Vec<Key>,
    /// One list for each case, with a value for each key.
    cases: Vec<Vec<Value>>,
}

impl Values {
    /// No key, and so one case.
    #[must_use]
    pub fn none() -> Self {
        Self { keys: Vec::new(), cases: vec![Vec::new()] }
    }

    /// The keys.
    #[must_use]
    pub fn keys(&self) -> &[Key] {
        &self.keys
    }

    /// The values of each case.
    #[must_use]
    pub fn cases(&self) -> &[Vec<Value>] {
        &self.cases
    }

    /// All combinations with these values of a key, which change fastest.
    ///
    /// # Errors
    /// No value, a key that is there already, too many cases.
    pub fn times(self, key: Key, values: &[Value]) -> Result<Self, String> {
        self.and(vec![key], values.iter().map(|value| vec![value.clone()]).collect())
    }

    /// All combinations with rows of values of keys that go together.
    ///
    /// # Errors
    /// No row, rows of another length, a key that is there already, too many cases.
    pub fn and(self, keys: Vec<Key>, rows: Vec<Vec<Value>>) -> Result<Self, String> {
        for (i, key) in keys.iter().enumerate() {
            if self.keys.contains(key) || keys[..i].contains(key) {
                return Err(format!("`{key}` is given twice"));
            }
        }
        if rows.is_empty() {
            let shown = keys.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(", ");
            return Err(format!("{shown}: there is no value; give at least one"));
        }
        if let Some(row) = rows.iter().find(|row| row.len() != keys.len()) {
            return Err(format!("a case has {} values for {} keys; give one for each", row.len(), keys.len()));
        }
        let count = self.cases.len().checked_mul(rows.len()).filter(|&count| count <= MOST);
        if count.is_none() {
            return Err(format!("these are more than {MOST} cases; give fewer values, or several sweeps"));
        }
        let rows: Vec<Vec<Value>> = rows.iter().map(|row| row.iter().map(bare).collect()).collect();
        let join = |case: &Vec<Value>, row: &Vec<Value>| case.iter().chain(row).cloned().collect();
        let cases = self.cases.iter().flat_map(|case| rows.iter().map(move |row| join(case, row))).collect();
        Ok(Self { keys: [self.keys, keys].concat(), cases })
    }

    /// All combinations of the lists in a table, whose keys may be dotted or tables in tables.
    pub(crate) fn grid(self, table: &dyn TableLike) -> Result<Self, String> {
        lists(table)?.into_iter().try_fold(self, |values, (key, list)| values.times(key, &list))
    }

    /// All combinations with the lists in a table, which have equal lengths and go together.
    pub(crate) fn together(self, table: &dyn TableLike) -> Result<Self, String> {
        let (keys, lists): (Vec<_>, Vec<_>) = lists(table)?.into_iter().unzip();
        let count = lists.first().map_or(0, Vec::len);
        if let Some(at) = lists.iter().position(|list| list.len() != count) {
            let (first, other) = (&keys[0], &keys[at]);
            let found = lists[at].len();
            return Err(format!(
                "`{other}` has {found} values, and `{first}` has {count}; lists that go together have equal lengths"
            ));
        }
        self.and(keys, (0..count).map(|row| lists.iter().map(|list| list[row].clone()).collect()).collect())
    }

    /// All combinations with the rows of a table of comma-separated values, whose header has the keys.
    ///
    /// # Errors
    /// A table that cannot be read, or that has no row.
    pub fn with_rows_of(self, file: &Path) -> Result<Self, Failure> {
        let told = |message: String| Failure::Argument(format!("{}: {message}", file.display()));
        let mut reader =
            csv::ReaderBuilder::new().trim(csv::Trim::All).from_path(file).map_err(|e| told(e.to_string()))?;
        let header = reader.headers().map_err(|e| told(e.to_string()))?.clone();
        for (separator, name) in [(';', "semicolons"), ('\t', "tabs")] {
            if header.iter().any(|key| key.contains(separator)) {
                return Err(told(format!(
                    "its columns are separated by {name}; write commas between them, and decimal points in numbers"
                )));
            }
        }
        let keys = header.iter().map(Key::parse).collect::<Result<Vec<_>, _>>().map_err(told)?;
        let mut rows = Vec::new();
        for row in reader.records() {
            let row = row.map_err(|e| told(e.to_string()))?;
            rows.push(row.iter().map(cell).collect());
        }
        self.and(keys, rows).map_err(told)
    }
}

/// A value in one form, however it was written: equal values make equal texts of cases.
fn bare(value: &Value) -> Value {
    match value {
        Value::Integer(number) => Value::from(*number.value()),
        Value::Float(number) => Value::from(*number.value()),
        Value::String(text) => Value::from(text.value().as_str()),
        Value::Array(list) => Value::from(list.iter().map(bare).collect::<Array>()),
        Value::InlineTable(table) => {
            Value::from(table.iter().map(|(key, value)| (key, bare(value))).collect::<InlineTable>())
        }
        Value::Boolean(_) | Value::Datetime(_) => value.clone().decorated("", ""),
    }
}

/// Number, list, truth value, or else a text.
fn cell(text: &str) -> Value {
    text.parse().unwrap_or_else(|_| Value::from(text))
}

/// The keys of a table and its subtables, each with its list of values.
fn lists(table: &dyn TableLike) -> Result<Vec<(Key, Vec<Value>)>, String> {
    let mut found = Vec::new();
    collect(table, &Key::root(), &mut found)?;
    Ok(found)
}

fn collect(table: &dyn TableLike, at: &Key, found: &mut Vec<(Key, Vec<Value>)>) -> Result<(), String> {
    for (name, item) in table.iter() {
        let key = name.split('.').fold(at.clone(), |key, part| key.with(part));
        if let Some(inner) = item.as_table_like() {
            collect(inner, &key, found)?;
        } else if let Some(list) = item.as_array() {
            found.push((key, list.iter().cloned().collect()));
        } else {
            return Err(format!("`{key}` must be a list of values, as in `{key}` = [10, 20]"));
        }
    }
    Ok(())
}

/// The value of a case file that JSON writes so.
///
/// # Errors
/// Nothing (`null`), which a case file cannot hold.
pub fn from_json(json: &serde_json::Value) -> Result<Value, String> {
    use serde_json::Value as Json;
    Ok(match json {
        Json::Null => return Err("None is not a value of a case".into()),
        Json::Bool(flag) => Value::from(*flag),
        Json::Number(number) => match (number.as_i64(), number.as_f64()) {
            (Some(whole), _) => Value::from(whole),
            (None, Some(real)) => Value::from(real),
            (None, None) => return Err(format!("{number} is out of range")),
        },
        Json::String(text) => Value::from(text.as_str()),
        Json::Array(list) => Value::from(list.iter().map(from_json).collect::<Result<Array, _>>()?),
        Json::Object(table) => {
            let entries = table.iter().map(|(key, value)| Ok((key.as_str(), from_json(value)?)));
            Value::from(entries.collect::<Result<InlineTable, String>>()?)
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use toml_edit::DocumentMut;

    fn shown(values: &Values) -> Vec<String> {
        let texts = |case: &Vec<Value>| case.iter().map(crate::name::text).collect::<Vec<_>>().join(" ");
        values.cases().iter().map(texts).collect()
    }

    fn document(text: &str) -> DocumentMut {
        text.parse().unwrap()
    }

    #[test]
    fn grids_are_all_combinations_the_last_key_fastest() {
        let quoted = document("\"mesh.rectangle.nx\" = [10, 20]\nobstacle.0.friction = [0.0, 0.3, 1e-1]");
        let values = Values::none().grid(quoted.as_table()).unwrap();
        let keys: Vec<String> = values.keys().iter().map(ToString::to_string).collect();
        assert_eq!(keys, ["mesh.rectangle.nx", "obstacle.0.friction"]);
        assert_eq!(shown(&values), ["10 0", "10 0.3", "10 0.1", "20 0", "20 0.3", "20 0.1"]);
    }

    #[test]
    fn lists_go_together() {
        let table = document("material.young = [70e9, 210e9]\nmaterial.density = [2700, 7850]");
        let values = Values::none().together(table.as_table()).unwrap();
        assert_eq!(shown(&values), ["7e10 2700", "2.1e11 7850"]);
        let uneven = document("a = [1, 2]\nb = [1]");
        let told = Values::none().together(uneven.as_table()).unwrap_err();
        assert!(told.contains("`b` has 1 values, and `a` has 2"));
    }

    #[test]
    fn tables_have_keys_numbers_lists_and_texts() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("rows.csv");
        std::fs::write(&file, "initial.velocity, mesh.file\r\n\"[0, -5.0]\",a b.msh\r\n\"[0, -50.0]\",\"c,d.msh\"\r\n")
            .unwrap();
        let values = Values::none().with_rows_of(&file).unwrap();
        assert_eq!(shown(&values), ["[0,-5] a b.msh", "[0,-50] c,d.msh"]);
        for (text, told) in [
            ("a,a\n1,2\n", "`a` is given twice"),
            ("a,b\n1\n", "record 1"),
            ("a\n", "there is no value"),
            ("a;b\n1,5;2\n", "separated by semicolons; write commas"),
            ("a\tb\n1\t2\n", "separated by tabs"),
        ] {
            std::fs::write(&file, text).unwrap();
            let error = Values::none().with_rows_of(&file).unwrap_err().to_string();
            assert!(error.contains(told), "{error}");
        }
    }

    #[test]
    fn json_gives_the_same_values() {
        let json: serde_json::Value = serde_json::from_str("[1, 0.1, 7e10, \"a\", true, [1.0, -2.5]]").unwrap();
        let found: Vec<String> =
            json.as_array().unwrap().iter().map(|v| from_json(v).unwrap().to_string().trim().to_string()).collect();
        assert_eq!(found, ["1", "0.1", "70000000000.0", "\"a\"", "true", "[1.0, -2.5]"]);
        assert!(from_json(&serde_json::Value::Null).is_err());
    }

    #[test]
    fn senseless_values_are_refused() {
        let told = |text: &str| Values::none().grid(document(text).as_table()).unwrap_err();
        assert!(told("a = 1").contains("must be a list"));
        assert!(told("a = []").contains("there is no value"));
        let many = (0..2000).map(Value::from).collect::<Vec<_>>();
        let twice = Values::none().times(Key::parse("a").unwrap(), &many).unwrap();
        assert!(twice.times(Key::parse("b").unwrap(), &many).unwrap_err().contains("more than 1000000 cases"));
    }
}
