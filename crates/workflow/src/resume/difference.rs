//! The first difference between two statements, in words: the key with both values.

use std::fmt::Display;
use toml::{Table, Value};

/// The order of the tables in a statement.
const TABLES: [&str; 7] = ["material", "obstacle", "contact", "support", "traction", "body_force", "estimate"];

/// The first difference between the statement of a case and that of a history; without `estimated`, options of the
/// estimate do not matter.
pub(super) fn of_statements(case: &str, history: &str, estimated: bool) -> Option<String> {
    let [case, history] = [case, history].map(|text| text.parse::<Table>().unwrap_or_default());
    let tables = TABLES.into_iter().filter(|name| estimated || *name != "estimate");
    tables.into_iter().find_map(|name| match (case.get(name), history.get(name)) {
        (Some(Value::Array(case)), Some(Value::Array(history))) if case.len() == history.len() => {
            let mut pairs = case.iter().zip(history).enumerate();
            let path = |at: usize| format!("[[{name}]] {}, ", at + 1);
            pairs.find_map(|(at, (case, history))| between_tables(&path(at), case.as_table()?, history.as_table()?))
        }
        (Some(Value::Table(case)), Some(Value::Table(history))) => {
            between_tables(&format!("[{name}], "), case, history)
        }
        (case, history) => between(&format!("[{name}]"), case, history),
    })
}

/// The first difference between some keys of a table of two case texts; none if both have the same, or neither.
pub(super) fn of_cases(case: &str, history: Option<&str>, table: &str, keys: &[&str]) -> Option<String> {
    let part = |text: &str| {
        let mut table = text.parse::<Table>().ok()?.remove(table)?.as_table()?.clone();
        table.retain(|key, _| keys.contains(&key));
        Some(table)
    };
    let [case, history] = [part(case), part(history?)].map(Option::unwrap_or_default);
    between_tables(&format!("[{table}], "), &case, &history)
}

/// The same between tables; `path` ends with what joins it to a key.
fn between_tables(path: &str, case: &Table, history: &Table) -> Option<String> {
    let more = history.keys().filter(|key| !case.contains_key(*key));
    let mut keys = case.keys().chain(more);
    keys.find_map(|key| between(&format!("{path}{key}"), case.get(key), history.get(key)))
}

fn between(path: &str, case: Option<&Value>, history: Option<&Value>) -> Option<String> {
    match (case, history) {
        (Some(Value::Table(case)), Some(Value::Table(history))) => between_tables(&format!("{path}."), case, history),
        (Some(Value::Array(case)), Some(Value::Array(history))) if case.len() == history.len() => {
            let mut pairs = case.iter().zip(history).enumerate();
            pairs.find_map(|(at, (case, history))| between(&format!("{path}[{at}]"), Some(case), Some(history)))
        }
        // Zero has two signs.
        (Some(Value::Float(case)), Some(Value::Float(history))) if case.to_bits() == history.to_bits() => None,
        (Some(Value::Float(_)), Some(Value::Float(_))) => Some(differ(path, &shown(case), &shown(history))),
        _ if case == history => None,
        _ => Some(differ(path, &shown(case), &shown(history))),
    }
}

/// A difference in words.
pub(super) fn differ(path: &str, case: &dyn Display, history: &dyn Display) -> String {
    format!("{path} is {case} in this case and {history} in the history")
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
            of_statements(&one.replace(from, to), one, true)
        };
        assert_eq!(of_statements(one, one, true), None);
        for (from, to, words) in [
            ("70e9", "71e9", "[[material]] 1, young is 71000000000.0 in this case and 70000000000.0 in the history"),
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
            of_statements(one, "", true).unwrap().starts_with("[material] is given 1 times in this case and missing")
        );
        assert_eq!(of_statements(&one.replace("every = 1", "every = 2"), one, false), None);
    }
}
