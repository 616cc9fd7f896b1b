//! The results of a sweep in one table.

use crate::attempt::{State, state};
use crate::name::text;
use crate::plan::Plan;
use percute_core::units::Units;
use percute_io::{Overwrite, write_bytes};
use percute_workflow::Failure;
use percute_workflow::report::units_of;
use serde_json::Value;
use std::path::PathBuf;

/// Name of the table in the folder of the sweep.
const FILE: &str = "results.csv";

/// A quantity: its name, its unit, and its place in the document of a run.
struct Quantity(&'static str, &'static str, &'static str);

/// In the order of the table.
const QUANTITIES: [Quantity; 45] = [
    Quantity("relative_sup", "", "/error/relative_sup"),
    Quantity("relative_mean", "", "/error/relative_mean"),
    Quantity("sup", "J^½", "/error/sup"),
    Quantity("mean", "J^½", "/error/mean"),
    Quantity("mean_from_touch", "J^½", "/error/mean_from_touch"),
    Quantity("energy", "J", "/error/energy"),
    Quantity("relative_stress_sup", "", "/error/relative_stress_sup"),
    Quantity("relative_stress_mean", "", "/error/relative_stress_mean"),
    Quantity("relative_velocity_sup", "", "/error/relative_velocity_sup"),
    Quantity("relative_velocity_mean", "", "/error/relative_velocity_mean"),
    Quantity("published_relative_sup", "", "/error/published_relative_sup"),
    Quantity("published_relative_mean", "", "/error/published_relative_mean"),
    Quantity("reference_sup", "J^½", "/error/reference_sup"),
    Quantity("reference_mean", "J^½", "/error/reference_mean"),
    Quantity("share_contact", "", "/verdict/shares/contact"),
    Quantity("share_kinetic", "", "/verdict/shares/kinetic"),
    Quantity("share_elastic", "", "/verdict/shares/elastic"),
    Quantity("trust", "", "/verdict/trust"),
    Quantity("effectivity_low", "", "/verdict/effectivity/0"),
    Quantity("effectivity_high", "", "/verdict/effectivity/1"),
    Quantity("touches", "", "/verdict/touches"),
    Quantity("speed_ratio", "", "/verdict/speed_ratio"),
    Quantity("courant", "", "/verdict/courant"),
    Quantity("averaged_peak_force", "N", "/contact/averaged_peak/force"),
    Quantity("time_of_averaged_peak", "s", "/contact/averaged_peak/time"),
    Quantity("averaged_peak_pressure", "Pa", "/contact/averaged_peak/pressure"),
    Quantity("first_touch", "s", "/contact/first_touch"),
    Quantity("time_in_contact", "s", "/rebound/time_in_contact"),
    Quantity("normal_before", "m/s", "/rebound/normal_before"),
    Quantity("normal_after", "m/s", "/rebound/normal_after"),
    Quantity("restitution", "", "/rebound/restitution"),
    Quantity("yielded_share", "", "/deformation/yielding/share"),
    Quantity("stress_ratio", "", "/deformation/yielding/stress_ratio"),
    Quantity("equivalent_plastic_strain", "", "/deformation/yielding/equivalent_strain"),
    Quantity("plastic_work", "J", "/balance/plastic_work"),
    Quantity("energy_drift", "", "/balance/energy_drift"),
    Quantity("largest_residual", "", "/largest_residual/value"),
    Quantity("nodes", "", "/problem/nodes"),
    Quantity("elements", "", "/problem/elements"),
    Quantity("steps", "", "/steps"),
    Quantity("time_step", "s", "/time_step"),
    Quantity("critical_time_step", "s", "/critical_time_step"),
    Quantity("end", "s", "/end"),
    Quantity("seconds", "s", "/seconds"),
    Quantity("verdict", "", "/verdict/text"),
];

/// A column: its name, its unit, and an entry for each case, null where there is none.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// The name: a key that was varied, or a quantity.
    pub name: String,
    /// The unit of a quantity; empty without one.
    pub unit: &'static str,
    /// Numbers and texts.
    pub entries: Vec<Value>,
}

/// The table of a sweep as far as it is done: name and status of each case, the values of its keys, its results, the
/// names of its warnings, and the reason of a failure.
#[must_use]
pub fn columns(plan: &Plan) -> Vec<Column> {
    let states: Vec<State> = plan.cases.iter().map(|case| state(&plan.folder, case)).collect();
    let column = |name: &str, unit, entries| Column { name: name.to_string(), unit, entries };
    let mut table = vec![
        column("case", "", plan.cases.iter().map(|case| case.name.clone().into()).collect()),
        column("status", "", states.iter().map(|state| state.name().into()).collect()),
    ];
    for (k, key) in plan.values.keys().iter().enumerate() {
        table.push(column(&key.to_string(), "", plan.values.cases().iter().map(|row| entry(&row[k])).collect()));
    }
    let of = |take: &dyn Fn(&Value) -> Value| {
        states
            .iter()
            .map(|state| if let State::Done(document) = state { take(document) } else { Value::Null })
            .collect()
    };
    let done = || states.iter().filter_map(|state| if let State::Done(found) = state { Some(found) } else { None });
    // A thickness that varies is one that is given.
    let units = Units { per_metre: done().next().is_some() && done().all(|found| units_of(found).per_metre) };
    for Quantity(name, unit, place) in QUANTITIES {
        let unit = units.of(unit);
        table.push(column(name, unit, of(&|document| document.pointer(place).map(joined).unwrap_or_default())));
    }
    table.push(column("warnings", "", of(&|document| warnings(document).into())));
    let reason = |state: &State| if let State::Failed(reason) = state { reason.as_str().into() } else { Value::Null };
    table.push(column("failure", "", states.iter().map(reason).collect()));
    table
}

/// The name of each case, and `open`, `failed` or `done`.
pub fn states(plan: &Plan) -> impl Iterator<Item = (&str, &'static str)> {
    plan.cases.iter().map(|case| (case.name.as_str(), state(&plan.folder, case).name()))
}

/// A value of a case: a number as such, anything else as its text.
fn entry(value: &toml_edit::Value) -> Value {
    let number = value.as_integer().map(Value::from).or(value.as_float().map(Value::from));
    number.or(value.as_bool().map(Value::from)).unwrap_or_else(|| text(value).into())
}

/// A list of sentences as one text.
fn joined(value: &Value) -> Value {
    let Value::Array(sentences) = value else { return value.clone() };
    sentences.iter().filter_map(Value::as_str).collect::<Vec<_>>().join(" ").into()
}

/// The names of the warnings.
fn warnings(document: &Value) -> String {
    let names = document["warnings"].as_array().into_iter().flatten().filter_map(|warning| warning["name"].as_str());
    names.collect::<Vec<_>>().join(" ")
}

/// Writes the table as comma-separated values (RFC 4180) in the folder of the sweep, in place of an older one.
///
/// # Errors
/// A file that cannot be written.
pub fn write(plan: &Plan) -> Result<PathBuf, Failure> {
    let columns = columns(plan);
    let header = |column: &Column| match column.unit {
        "" => column.name.clone(),
        unit => format!("{} ({unit})", column.name),
    };
    let cell = |entry: &Value| match entry {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    let mut writer = csv::WriterBuilder::new().terminator(csv::Terminator::CRLF).from_writer(Vec::new());
    let lines = std::iter::once(columns.iter().map(header).collect::<Vec<_>>());
    let rows = (0..plan.cases.len()).map(|row| columns.iter().map(|column| cell(&column.entries[row])).collect());
    let file = plan.folder.join(FILE);
    let told = |error: csv::Error| Failure::Argument(format!("{}: {error}", file.display()));
    lines.chain(rows).try_for_each(|line: Vec<String>| writer.write_record(line)).map_err(told)?;
    let bytes = writer.into_inner().map_err(|error| told(error.into_error().into()))?;
    write_bytes(&file, Overwrite::Replace, &bytes)?;
    Ok(file)
}
