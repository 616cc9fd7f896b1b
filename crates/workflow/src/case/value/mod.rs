//! Values of a case file, read as what they should be.

mod absent;
pub(super) mod table;

use super::source::{At, CaseError, Source};
use table::Table;
use toml::de::DeValue;

/// A value with its place.
#[derive(Clone, Debug)]
pub(crate) struct Value<'a> {
    pub(super) source: &'a Source,
    pub(super) value: &'a DeValue<'a>,
    pub(super) at: At,
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
            Value { source: self.source, value: value.get_ref(), at }
        };
        Ok(list.iter().enumerate().map(entry).collect())
    }

    /// A table with these keys only.
    pub(crate) fn table(&self, known: &[&str], example: &str) -> Result<Table<'a>, CaseError> {
        let table = self.any_table(example)?;
        table.only(known)?;
        Ok(table)
    }

    /// A table with keys of the user's choice.
    pub(crate) fn any_table(&self, example: &str) -> Result<Table<'a>, CaseError> {
        let table = self.value.as_table().ok_or_else(|| self.must_be(format!("a table, such as {example}")))?;
        Ok(Table { source: self.source, table, at: self.at.clone(), joint: "." })
    }

    /// A vector with a component for each axis; in 1D a number will do.
    pub(crate) fn vector<const D: usize>(&self, unit: &str) -> Result<[f64; D], CaseError> {
        let mut vector = [0.0; D];
        if D == 1 && !self.is_list() {
            vector[0] = self.number(unit)?;
            return Ok(vector);
        }
        let wrong = || if D == 1 { self.must_be(number_of(unit)) } else { self.must_be(vector_of::<D>(unit)) };
        let entries = self.value.as_array().filter(|list| list.len() == D).ok_or_else(wrong)?;
        for (slot, entry) in vector.iter_mut().zip(entries.iter()) {
            *slot = Value { value: entry.get_ref(), ..self.clone() }.number(unit).map_err(|_| wrong())?;
        }
        Ok(vector)
    }

    /// A list of vectors, one for each instant or node.
    pub(crate) fn vectors<const D: usize>(&self, unit: &str) -> Result<Vec<[f64; D]>, CaseError> {
        let what = if D == 1 { number_of(unit) } else { vector_of::<D>(unit) };
        self.list(&format!("entries, each {what}"))?.iter().map(|entry| entry.vector(unit)).collect()
    }

    /// A list of numbers.
    pub(crate) fn numbers(&self, unit: &str) -> Result<Vec<f64>, CaseError> {
        self.list(&format!("numbers in {unit}"))?.iter().map(|entry| entry.number(unit)).collect()
    }

    /// A list of `N` node numbers.
    pub(crate) fn nodes<const N: usize>(&self) -> Result<[usize; N], CaseError> {
        let mut nodes = [0; N];
        if N == 1 && !self.is_list() {
            nodes[0] = self.count(0)?;
            return Ok(nodes);
        }
        let what = format!("{N} node numbers, counted from 0");
        let entries = self.list(&what)?;
        if entries.len() != N {
            return Err(self.must_be(what));
        }
        for (slot, entry) in nodes.iter_mut().zip(&entries) {
            *slot = entry.count(0)?;
        }
        Ok(nodes)
    }
}

fn number_of(unit: &str) -> String {
    if unit.is_empty() { "a finite number".to_string() } else { format!("a finite number in {unit}") }
}

fn vector_of<const D: usize>(unit: &str) -> String {
    let unit = if unit.is_empty() { String::new() } else { format!(" in {unit}") };
    format!("{D} finite numbers{unit}, for x and y, such as [1.0, 0.0]")
}
