//! `[estimate]`: the options of the estimate.

use super::source::CaseError;
use super::table::Table;
use super::value::Value;
use crate::message::hint;
use percute_estimator::{Options, Sampling, UnknownName};
use std::str::FromStr;

/// Reads the options; all have a default.
pub(super) fn read(root: &Table<'_>) -> Result<Options, CaseError> {
    let mut options = Options::default();
    let Some(table) = root.single("estimate")? else { return Ok(options) };
    table.only()?;
    options.reconstruction = choice(&table, "reconstruction")?.unwrap_or_default();
    options.acceleration = choice(&table, "acceleration")?;
    if let Some((acceleration, value)) = options.acceleration.zip(table.get("acceleration")) {
        acceleration.check(options.reconstruction).map_err(|error| value.error(error.to_string()))?;
    }
    if let Some(every) = table.get("every") {
        options.every = sampling(&every)?;
    }
    Ok(options)
}

/// The steps at which the error is sampled: `"auto"`, or so many steps apart.
fn sampling(value: &Value<'_>) -> Result<Sampling, CaseError> {
    if value.text("a name").ok().and_then(|name| name.parse().ok()) == Some(Sampling::Auto) {
        return Ok(Sampling::Auto);
    }
    value.count(1).map(Sampling::Every).map_err(|_| value.must_be("\"auto\" or a whole number, 1 or more"))
}

/// The value of an option of the estimator, by its name.
fn choice<T: FromStr<Err = UnknownName>>(table: &Table<'_>, key: &str) -> Result<Option<T>, CaseError> {
    let Some(value) = table.get(key) else { return Ok(None) };
    let name = value.text("a name")?;
    let unknown = |error: UnknownName| {
        let known: Vec<String> = error.known.iter().map(|name| format!("\"{name}\"")).collect();
        value.must_be(format!("one of {}{}", known.join(", "), hint(name, error.known.iter().copied())))
    };
    name.parse().map(Some).map_err(unknown)
}
