//! The first difference between two statements, in words: the key with both values.

use std::fmt::Display;
use toml::{Table, Value};

/// The order of the tables in a statement.
const TABLES: [&str; 7] = ["material", "obstacle", "contact", "support", "traction", "body_force", "estimate"];

/// What is compared with what.
#[derive(Clone, Copy)]
pub(crate) struct Sides {
    /// The names of both, in the order of the arguments.
    pub(crate) names: [&'static str; 2],
    /// Numbers are the same if they differ by less, over the largest of their list; 0: if they have the same bits.
    pub(crate) same: f64,
}

/// A case and the history that its run left.
pub(crate) const OF_RUN: Sides = Sides { names: ["this case", "the history"], same: 0.0 };

impl Sides {
    /// The first difference between two statements; without `estimated`, options of the estimate do not matter.
    pub(crate) fn of_statements(&self, one: &str, other: &str, estimated: bool) -> Option<String> {
        let [one, other] = [one, other].map(|text| text.parse::<Table>().unwrap_or_default());
        self.of_documents(&one, &other, estimated)
    }

    /// The same, of statements that are read.
    pub(crate) fn of_documents(&self, one: &Table, other: &Table, estimated: bool) -> Option<String> {
        let tables = TABLES.into_iter().filter(|name| estimated || *name != "estimate");
        tables.into_iter().find_map(|name| match (one.get(name), other.get(name)) {
            (Some(Value::Array(one)), Some(Value::Array(other))) if one.len() == other.len() => {
                let mut pairs = one.iter().zip(other).enumerate();
                let path = |at: usize| format!("[[{name}]] {}, ", at + 1);
                pairs.find_map(|(at, (one, other))| self.of_tables(&path(at), one.as_table()?, other.as_table()?))
            }
            (Some(Value::Table(one)), Some(Value::Table(other))) => self.of_tables(&format!("[{name}], "), one, other),
            (one, other) => self.between(&format!("[{name}]"), one, other),
        })
    }

    /// The same between tables; `path` ends with what joins it to a key.
    fn of_tables(&self, path: &str, one: &Table, other: &Table) -> Option<String> {
        let more = other.keys().filter(|key| !one.contains_key(*key));
        let mut keys = one.keys().chain(more);
        keys.find_map(|key| self.between(&format!("{path}{key}"), one.get(key), other.get(key)))
    }

    fn between(&self, path: &str, one: Option<&Value>, other: Option<&Value>) -> Option<String> {
        match (one, other) {
            (Some(Value::Table(one)), Some(Value::Table(other))) => self.of_tables(&format!("{path}."), one, other),
            (Some(Value::Array(one)), Some(Value::Array(other))) if self.close(one, other) => None,
            (Some(Value::Array(one)), Some(Value::Array(other))) if one.len() == other.len() => {
                let mut pairs = one.iter().zip(other).enumerate();
                pairs.find_map(|(at, (one, other))| self.between(&format!("{path}[{at}]"), Some(one), Some(other)))
            }
            (Some(Value::Float(a)), Some(Value::Float(b))) if self.same(*a, *b, a.abs().max(b.abs())) => None,
            (Some(Value::Float(_)), Some(Value::Float(_))) => Some(self.differ(path, &shown(one), &shown(other))),
            _ if one == other => None,
            _ => Some(self.differ(path, &shown(one), &shown(other))),
        }
    }

    /// Whether two lists have the same numbers, to the accuracy of the largest.
    fn close(&self, one: &[Value], other: &[Value]) -> bool {
        let numbers = |list: &[Value]| list.iter().map(Value::as_float).collect::<Option<Vec<f64>>>();
        let (Some(one), Some(other)) = (numbers(one), numbers(other)) else { return false };
        let largest = one.iter().chain(&other).fold(0.0_f64, |most, x| most.max(x.abs()));
        one.len() == other.len() && one.iter().zip(&other).all(|(a, b)| self.same(*a, *b, largest))
    }

    /// Whether two numbers are the same, to the accuracy of a largest one.
    pub(crate) fn same(&self, one: f64, other: f64, largest: f64) -> bool {
        // Zero has two signs.
        one.to_bits() == other.to_bits() || (self.same > 0.0 && (one - other).abs() <= self.same * largest)
    }

    /// A difference in words.
    pub(crate) fn differ(&self, path: &str, one: &dyn Display, other: &dyn Display) -> String {
        let [first, second] = self.names;
        // Statements have H alone, and a case may have E_t.
        let of_tangent = if path.ends_with("hardening") { " (H = E E_t/(E − E_t) of a `tangent` E_t)" } else { "" };
        format!("{path}{of_tangent} is {one} in {first} and {other} in {second}")
    }
}

/// The first difference between some keys of a table of two case texts; none if both have the same, or neither.
pub(crate) fn of_cases(case: &str, history: Option<&str>, table: &str, keys: &[&str]) -> Option<String> {
    let part = |text: &str| {
        let mut table = text.parse::<Table>().ok()?.remove(table)?.as_table()?.clone();
        table.retain(|key, _| keys.contains(&key));
        Some(table)
    };
    let [case, history] = [part(case), part(history?)].map(Option::unwrap_or_default);
    OF_RUN.of_tables(&format!("[{table}], "), &case, &history)
}

fn shown(value: Option<&Value>) -> String {
    match value {
        None => "missing".to_string(),
        Some(Value::Array(list)) if list.iter().all(Value::is_table) => format!("given {} times", list.len()),
        Some(Value::Array(list)) if list.len() > 4 || list.iter().any(Value::is_array) => {
            format!("a list of {}", list.len())
        }
        Some(Value::Array(list)) => {
            format!("[{}]", list.iter().map(|value| shown(Some(value))).collect::<Vec<_>>().join(", "))
        }
        Some(Value::Table(_)) => "given".to_string(),
        Some(Value::String(text)) => format!("\"{text}\""),
        Some(Value::Float(number)) => format!("{number:?}"),
        Some(Value::Integer(number)) => number.to_string(),
        Some(Value::Boolean(flag)) => flag.to_string(),
        Some(Value::Datetime(date)) => date.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_difference_has_its_key_and_both_values() {
        let one = "[[material]]\nyoung = 70e9\nplane = \"stress\"\n\
                   [[contact]]\ngroups = [\"a.b\", \"c.d\"]\nfriction = 0.2\n\
                   [[traction]]\ngroup = \"top\"\nvalue = [[0.0, 1.0]]\n\
                   profile = { value = 1.0, gradient = [0.0, 0.0] }\n[estimate]\nevery = 1\n";
        let told = |from: &str, to: &str| {
            assert!(one.contains(from), "{from}");
            OF_RUN.of_statements(&one.replace(from, to), one, true)
        };
        assert_eq!(OF_RUN.of_statements(one, one, true), None);
        for (from, to, words) in [
            ("70e9", "71e9", "[[material]] 1, young is 71000000000.0 in this case and 70000000000.0 in the history"),
            (
                "70e9",
                "70e9\nhardening = 7e9",
                "[[material]] 1, hardening (H = E E_t/(E − E_t) of a `tangent` E_t) is 7000000000.0 in this case \
                 and missing in the history",
            ),
            (
                "\"stress\"",
                "\"strain\"",
                "[[material]] 1, plane is \"strain\" in this case and \"stress\" in the history",
            ),
            ("plane = \"stress\"\n", "", "[[material]] 1, plane is missing in this case and \"stress\" in the history"),
            (
                "[[material]]",
                "[[material]]\n[[material]]",
                "[material] is given 2 times in this case and given 1 times",
            ),
            ("[[0.0, 1.0]]", "[[0.0, 2.0]]", "[[traction]] 1, value[0][1] is 2.0 in this case and 1.0 in the history"),
            (
                "[[0.0, 1.0]]",
                "[[0.0, 1.0], [1.0, 1.0]]",
                "[[traction]] 1, value is a list of 2 in this case and a list of 1",
            ),
            ("gradient = [0.0", "gradient = [-0.0", "[[traction]] 1, profile.gradient[0] is -0.0 in this case and 0.0"),
            ("friction = 0.2", "friction = 0.3", "[[contact]] 1, friction is 0.3 in this case and 0.2 in the history"),
            ("every = 1", "every = 2", "[estimate], every is 2 in this case and 1 in the history"),
        ] {
            assert!(told(from, to).is_some_and(|told| told.starts_with(words)), "{:?}", told(from, to));
        }
        assert!(
            OF_RUN
                .of_statements(one, "", true)
                .unwrap()
                .starts_with("[material] is given 1 times in this case and missing")
        );
        assert_eq!(OF_RUN.of_statements(&one.replace("every = 1", "every = 2"), one, false), None);
    }
}
