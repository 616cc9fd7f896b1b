//! Values of a case file, read as what they should be.

mod absent;
pub(super) mod table;

use super::SchemaPart;
use super::source::{At, CaseError, Source};
use percute_core::border::Vector;
use table::Table;
use toml::de::DeValue;

/// A value with its place.
#[derive(Clone, Debug)]
pub(crate) struct Value<'a> {
    pub(super) source: &'a Source,
    pub(super) value: &'a DeValue<'a>,
    pub(super) at: At,
    pub(super) part: SchemaPart,
}

impl<'a> Value<'a> {
    /// An error at this value.
    pub(crate) fn error(&self, message: impl Into<String>) -> CaseError {
        self.source.error(&self.at, message)
    }

    /// An error that says what the value is and what it must be.
    pub(crate) fn must_be(&self, allowed: impl AsRef<str>) -> CaseError {
        self.error(format!("is {}; it must be {}", self.shown(), allowed.as_ref()))
    }

    /// The value as the user may recognise it.
    pub(crate) fn shown(&self) -> String {
        match self.value {
            DeValue::String(s) => format!("\"{s}\""),
            DeValue::Integer(i) => i.to_string(),
            DeValue::Float(x) => x.to_string(),
            DeValue::Boolean(b) => b.to_string(),
            DeValue::Datetime(d) => format!("the date {d}"),
            DeValue::Array(list) if list.iter().all(|v| v.get_ref().as_array().is_none()) && list.len() <= 4 => {
                let shown = list.iter().map(|v| Self { value: v.get_ref(), ..self.clone() }.shown());
                format!("[{}]", shown.collect::<Vec<_>>().join(", "))
            }
            DeValue::Array(list) => format!("a list of {}", list.len()),
            DeValue::Table(_) => "a table".to_string(),
        }
    }

    /// Whether this is a list.
    pub(crate) fn is_list(&self) -> bool {
        self.value.is_array()
    }

    /// A finite number; `unit` is empty for a number without.
    pub(crate) fn number(&self, unit: &str) -> Result<f64, CaseError> {
        let number = match self.value {
            DeValue::Integer(_) => self.integer().map(|i| i as f64),
            DeValue::Float(x) => x.as_str().parse::<f64>().ok(),
            _ => None,
        };
        number.filter(|x| x.is_finite()).ok_or_else(|| self.must_be(number_of(unit)))
    }

    /// A whole number of at least `least`.
    pub(crate) fn count(&self, least: usize) -> Result<usize, CaseError> {
        let count = self.integer().and_then(|i| usize::try_from(i).ok());
        count.filter(|&i| i >= least).ok_or_else(|| self.must_be(format!("a whole number, {least} or more")))
    }

    fn integer(&self) -> Option<i64> {
        let integer = self.value.as_integer()?;
        i64::from_str_radix(integer.as_str(), integer.radix()).ok()
    }

    /// A text.
    pub(crate) fn text(&self, what: &str) -> Result<&'a str, CaseError> {
        let several = if self.is_list() { "; for several, write a table for each" } else { "" };
        self.value.as_str().ok_or_else(|| self.must_be(format!("{what}, in quotes{several}")))
    }

    /// Yes or no.
    pub(crate) fn flag(&self) -> Result<bool, CaseError> {
        self.value.as_bool().ok_or_else(|| self.must_be("true or false"))
    }

    /// The entries of a list; `what` says what it should hold.
    pub(crate) fn list(&self, what: &str) -> Result<Vec<Value<'a>>, CaseError> {
        let list = self.value.as_array().ok_or_else(|| self.must_be(format!("a list of {what}")))?;
        let entry = |(i, value): (usize, &'a toml::Spanned<DeValue<'a>>)| {
            let at = At { path: format!("{}[{i}]", self.at.path), span: value.span() };
            Value { source: self.source, value: value.get_ref(), at, part: self.part }
        };
        Ok(list.iter().enumerate().map(entry).collect())
    }

    /// A table with no other keys than its own.
    pub(crate) fn table(&self, example: &str) -> Result<Table<'a>, CaseError> {
        let table = self.any_table(example)?;
        table.only()?;
        Ok(table)
    }

    /// A table with keys of the user's choice.
    pub(crate) fn any_table(&self, example: &str) -> Result<Table<'a>, CaseError> {
        let table = self.value.as_table().ok_or_else(|| self.must_be(format!("a table, such as {example}")))?;
        Ok(Table { source: self.source, table, at: self.at.clone(), joint: ".", part: self.part })
    }

    /// A vector with a component for each axis; in 1D a number will do.
    pub(crate) fn vector(&self, unit: &str, dimension: usize) -> Result<Vector, CaseError> {
        let mut vector = [0.0; 3];
        if dimension == 1 && !self.is_list() {
            vector[0] = self.number(unit)?;
            return Ok(vector);
        }
        let wrong = || self.must_be(if dimension == 1 { number_of(unit) } else { vector_of(unit, dimension) });
        let entries = self.value.as_array().filter(|list| list.len() == dimension).ok_or_else(wrong)?;
        for (slot, entry) in vector.iter_mut().zip(entries.iter()) {
            *slot = Value { value: entry.get_ref(), ..self.clone() }.number(unit).map_err(|_| wrong())?;
        }
        Ok(vector)
    }

    /// A list of vectors, one for each instant or node.
    pub(crate) fn vectors(&self, unit: &str, dimension: usize) -> Result<Vec<Vector>, CaseError> {
        let what = if dimension == 1 { number_of(unit) } else { vector_of(unit, dimension) };
        self.list(&format!("entries, each {what}"))?.iter().map(|entry| entry.vector(unit, dimension)).collect()
    }

    /// A list of numbers.
    pub(crate) fn numbers(&self, unit: &str) -> Result<Vec<f64>, CaseError> {
        self.list(&format!("numbers in {unit}"))?.iter().map(|entry| entry.number(unit)).collect()
    }

    /// A list of so many node numbers.
    pub(crate) fn nodes(&self, count: usize) -> Result<Vec<usize>, CaseError> {
        if count == 1 && !self.is_list() {
            return Ok(vec![self.count(0)?]);
        }
        let what = format!("{count} node numbers, counted from 0");
        let entries = self.list(&what)?;
        if entries.len() != count {
            return Err(self.must_be(what));
        }
        entries.iter().map(|entry| entry.count(0)).collect()
    }
}

/// Vectors as rows of a dimension.
pub(crate) fn rows(vectors: Vec<Vector>, dimension: usize) -> Vec<f64> {
    vectors.into_iter().flat_map(|vector| vector.into_iter().take(dimension)).collect()
}

fn number_of(unit: &str) -> String {
    if unit.is_empty() { "a finite number".to_string() } else { format!("a finite number in {unit}") }
}

fn vector_of(unit: &str, dimension: usize) -> String {
    let unit = if unit.is_empty() { String::new() } else { format!(" in {unit}") };
    let shown = if dimension == 3 { "x, y and z, such as [1.0, 0.0, 0.0]" } else { "x and y, such as [1.0, 0.0]" };
    format!("{dimension} finite numbers{unit}, for {shown}")
}
