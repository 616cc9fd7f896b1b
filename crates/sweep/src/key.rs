//! Keys of a case, and their values.

use percute_workflow::message::{hint, list};
use std::fmt;
use toml_edit::{DocumentMut, Item, Value};

/// A key of a case, as in `obstacle.0.friction`: names of tables and keys, and numbers in lists.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Key(Vec<String>);

impl Key {
    /// Reads a key in its dotted form.
    ///
    /// # Errors
    /// An empty part.
    pub fn parse(text: &str) -> Result<Self, String> {
        let parts: Vec<String> = text.split('.').map(|part| part.trim().to_string()).collect();
        if parts.iter().any(String::is_empty) {
            return Err(format!("`{text}` is not a key of a case; write its path, as in `obstacle.0.friction`"));
        }
        Ok(Self(parts))
    }

    /// A key inside this one.
    pub(crate) fn with(&self, part: &str) -> Self {
        Self(self.0.iter().cloned().chain([part.to_string()]).collect())
    }

    /// The key of no part, which contains all others.
    pub(crate) fn root() -> Self {
        Self(Vec::new())
    }

    /// Its last parts from each name on, the shortest first: `friction`, `obstacle.0.friction`.
    pub(crate) fn tails(&self) -> impl Iterator<Item = String> + '_ {
        let starts = (0..self.0.len()).rev().filter(|&from| self.0[from].parse::<usize>().is_err() || from == 0);
        starts.map(|from| self.0[from..].join("."))
    }

    /// Gives this key of a case a value. Comments and order of the text stay.
    ///
    /// # Errors
    /// A table or an entry of a list that the case does not have.
    pub(crate) fn set(&self, case: &mut DocumentMut, value: &Value) -> Result<(), String> {
        let (mut item, mut at) = (case.as_item_mut(), String::new());
        let Some((last, path)) = self.0.split_last() else { return Err("a key is missing".into()) };
        for part in path {
            let known = Known::of(item);
            item = entry(item, part).ok_or_else(|| known.lacks(self, &at, part))?;
            at = if at.is_empty() { part.clone() } else { format!("{at}.{part}") };
        }
        let known = Known::of(item);
        if let Some(place) = entry(item, last) {
            replace(place, value.clone());
        } else if let Some(table) = item.as_table_like_mut() {
            table.insert(last, Item::Value(value.clone()));
        } else {
            return Err(known.lacks(self, &at, last));
        }
        Ok(())
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.join("."))
    }
}

/// Puts a value in place of another, whose comments stay.
pub(crate) fn replace(place: &mut Item, mut value: Value) {
    if let Some(old) = place.as_value() {
        *value.decor_mut() = old.decor().clone();
    }
    *place = Item::Value(value);
}

/// An entry that is there.
fn entry<'i>(item: &'i mut Item, part: &str) -> Option<&'i mut Item> {
    if let Ok(index) = part.parse::<usize>() {
        return item.get_mut(index);
    }
    // Asking for a key that is not there would make it.
    item.get(part).is_some().then(|| item.get_mut(part)).flatten()
}

/// What a place in a case holds, for messages.
enum Known {
    Keys(Vec<String>),
    Entries(usize),
    Value,
}

impl Known {
    fn of(item: &Item) -> Self {
        if let Some(table) = item.as_table_like() {
            return Self::Keys(table.iter().map(|(key, _)| key.to_string()).collect());
        }
        let entries = item.as_array().map(toml_edit::Array::len);
        entries.or(item.as_array_of_tables().map(toml_edit::ArrayOfTables::len)).map_or(Self::Value, Self::Entries)
    }

    /// Why `part` is not at `at`.
    fn lacks(&self, key: &Key, at: &str, part: &str) -> String {
        let place = if at.is_empty() { "the case".to_string() } else { format!("`{at}`") };
        let why = match self {
            Self::Keys(keys) => {
                let keys = || keys.iter().map(String::as_str);
                format!("{place} has no `{part}`{}; it has {}", hint(part, keys()), list(keys()))
            }
            Self::Entries(count) => {
                let last = count.saturating_sub(1);
                format!(
                    "{place} is a list, with entries 0 to {last}, and has no `{part}`; write `{at}.0`, for instance"
                )
            }
            Self::Value => format!("{place} is a single value, without `{part}`"),
        };
        format!("`{key}`: {why}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASE: &str = "# A case.\n[mesh] # body\nrectangle = { width = 0.05, nx = 20 }\n\
                        [initial]\nvelocity = [400.0, -400.0]\n\
                        [[obstacle]]\nfriction = 0.2 # dry\n[[obstacle]]\nfriction = 0.3\n";

    fn set(key: &str, value: impl Into<Value>) -> Result<String, String> {
        let mut case: DocumentMut = CASE.parse().expect("valid TOML");
        Key::parse(key)?.set(&mut case, &value.into()).map(|()| case.to_string())
    }

    #[test]
    fn values_are_set_and_the_rest_stays() {
        let nx = set("mesh.rectangle.nx", 10).unwrap();
        assert_eq!(nx, CASE.replace("nx = 20", "nx = 10"));
        assert_eq!(set("obstacle.0.friction", 0.5).unwrap(), CASE.replace("0.2 # dry", "0.5 # dry"));
        assert_eq!(set("initial.velocity.1", -3.0).unwrap(), CASE.replace("-400.0", "-3.0"));
        assert_eq!(set("mesh.file", "a.msh").unwrap(), CASE.replace("nx = 20 }\n", "nx = 20 }\nfile = \"a.msh\"\n"));
    }

    #[test]
    fn what_is_not_there_is_named() {
        let told = |key: &str| set(key, 1).unwrap_err();
        assert!(told("mesh.rectangel.nx").contains("`mesh` has no `rectangel`; did you mean `rectangle`?"));
        assert!(told("obstacle.2.friction").contains("`obstacle` is a list, with entries 0 to 1"));
        assert!(told("obstacle.friction").contains("`obstacle` is a list"));
        assert!(told("initial.velocity.2").contains("entries 0 to 1"));
        assert!(told("mesh.rectangle.nx.a").contains("`mesh.rectangle.nx` is a single value"));
        assert!(told("time.end").contains("the case has no `time`"));
        assert!(told("mesh..nx").contains("is not a key of a case"));
    }
}
