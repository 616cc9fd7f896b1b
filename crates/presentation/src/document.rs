//! The JSON document of an estimate, read by its keys. Documents of earlier versions lack some of them.

use percute_core::contact::contact_name;
use percute_workflow::report::units_of;
use serde_json::Value;
use thiserror::Error;

/// A text that is no document of an estimate.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("the report is no JSON document of an estimate: {0}")]
pub struct NoDocument(String);

/// The document that `percute run --json` prints.
#[derive(Clone, Debug, PartialEq)]
pub struct Document(Value);

impl Document {
    /// Reads a document.
    ///
    /// # Errors
    /// A text that is no JSON object, or one without the error.
    pub fn parse(text: &str) -> Result<Self, NoDocument> {
        let value: Value = serde_json::from_str(text).map_err(|error| NoDocument(error.to_string()))?;
        if !value["error"]["sup"].is_number() {
            return Err(NoDocument("it has no `error.sup`".to_string()));
        }
        Ok(Self(of_this_version(value)))
    }

    /// The value at a path of keys, such as `error.sup`; null if it is missing.
    pub(crate) fn at(&self, path: &str) -> &Value {
        path.split('.').fold(&self.0, |value, key| &value[key])
    }

    /// The whole document.
    pub(crate) fn all(&self) -> &Value {
        &self.0
    }

    /// A unit of a quantity of the body, which may be per metre of thickness.
    pub(crate) fn unit(&self, unit: &'static str) -> &'static str {
        units_of(&self.0).of(unit)
    }

    /// A finite number.
    pub(crate) fn number(&self, path: &str) -> Option<f64> {
        self.at(path).as_f64()
    }

    /// A text; empty if it is missing.
    pub(crate) fn text(&self, path: &str) -> &str {
        self.at(path).as_str().unwrap_or_default()
    }

    /// Whether a flag is set.
    pub(crate) fn flag(&self, path: &str) -> bool {
        self.at(path).as_bool().unwrap_or_default()
    }

    /// A list; empty if it is missing.
    pub(crate) fn list(&self, path: &str) -> &[Value] {
        self.at(path).as_array().map_or(&[], Vec::as_slice)
    }

    /// Whether each obstacle counts in the sums: of two bodies that touch, each is an obstacle of the other, and the
    /// first counts.
    fn counted_obstacles(&self) -> Vec<bool> {
        let mut first = false;
        let counts = |obstacle: &Value| {
            first = obstacle["point"].is_null() && !first;
            !obstacle["point"].is_null() || first
        };
        self.list("problem.obstacles").iter().map(counts).collect()
    }

    /// The names of the obstacles that count, with their places among all: "plane 0", or "disc and
    /// plate".
    pub(crate) fn names_of_obstacles(&self) -> Vec<(usize, String)> {
        let obstacles = self.list("problem.obstacles");
        let name = |k: usize| match obstacles[k]["point"].is_null() {
            true => contact_name(self.groups(k)),
            false => format!("plane {k}"),
        };
        let counted = self.counted_obstacles();
        (0..obstacles.len()).filter(|&k| counted[k]).map(|k| (k, name(k))).collect()
    }

    /// The groups of an interface whose first side is this obstacle.
    pub(crate) fn groups(&self, obstacle: usize) -> [&str; 2] {
        let obstacles = self.list("problem.obstacles");
        [obstacle, obstacle + 1]
            .map(|k| obstacles.get(k).and_then(|obstacle| obstacle["group"].as_str()).unwrap_or_default())
    }

    /// Whether bodies may touch each other.
    pub(crate) fn has_interfaces(&self) -> bool {
        self.list("problem.obstacles").iter().any(|obstacle| obstacle["point"].is_null())
    }

    /// A list of numbers; null, which stands for a number that is not finite, is NaN.
    pub(crate) fn column(&self, path: &str) -> Vec<f64> {
        numbers(self.at(path))
    }

    /// Whether another program than percute simulated.
    pub(crate) fn is_foreign(&self) -> bool {
        !self.at("consistency").is_null()
    }

    /// The name of the case or history without its folder.
    pub(crate) fn name(&self) -> String {
        let name = std::path::Path::new(self.text("case")).file_name();
        name.map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
    }
}

/// Up to format 2 the relative error was that of \[22\] alone.
fn of_this_version(mut document: Value) -> Value {
    if document["format"].as_u64().is_some_and(|format| format < 3)
        && let Some(error) = document["error"].as_object_mut()
    {
        for key in ["relative_sup", "relative_mean"] {
            let value = error.remove(key).unwrap_or_default();
            error.insert(format!("published_{key}"), value);
        }
    }
    document
}

/// The numbers of a list.
pub(crate) fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().into_iter().flatten().map(|number| number.as_f64().unwrap_or(f64::NAN)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_relative_error_of_earlier_versions_is_the_published_one() {
        let of = |format: u32| {
            let text = format!(r#"{{"format": {format}, "error": {{"sup": 1.0, "relative_sup": 0.1}}}}"#);
            let document = Document::parse(&text).unwrap();
            ["error.relative_sup", "error.published_relative_sup"].map(|path| document.number(path))
        };
        assert_eq!((of(2), of(3)), ([None, Some(0.1)], [Some(0.1), None]));
    }

    #[test]
    fn keys_that_are_missing_are_nothing() {
        let document = Document::parse(r#"{"error": {"sup": 2.5}, "list": [1, null], "case": "a/b.toml"}"#).unwrap();
        assert_eq!(document.number("error.sup"), Some(2.5));
        assert_eq!((document.number("contact.peak"), document.text("meaning")), (None, ""));
        assert!(document.column("list")[1].is_nan() && document.list("nothing.at.all").is_empty());
        assert_eq!(document.name(), "b.toml");
        for wrong in ["", "[]", "{}", "{\"error\": 1}"] {
            assert!(Document::parse(wrong).is_err(), "{wrong}");
        }
    }
}
