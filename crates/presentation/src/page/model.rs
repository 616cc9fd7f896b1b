//! Balances, residuals, and the model: mesh, materials, planes, supports and loads.

use super::Contents;
use super::error::seconds;
use super::html::{Table, figure, heading, number, section, share, vector};
use crate::chart::{Line, OverTime};
use crate::document::{Document, numbers};
use crate::scale::hatted;
use crate::typeset::html;
use percute_workflow::message::short;

/// Energies over time, drifts, residuals.
pub(super) fn balance(document: &Document) -> String {
    let column = |name: &str| document.column(&format!("balance_over_time.{name}"));
    let names = [
        ("kinetic", "kinetic"),
        ("strain", "strain"),
        ("contact", "work_of_contact"),
        ("loads", "work_of_loads"),
        ("supports", "work_of_supports"),
        ("friction", "friction"),
    ];
    // Works of what the problem does not have are left out.
    let line = |(name, key): (&'static str, &str)| {
        let values = column(key);
        (values.iter().any(|value| *value != 0.0)).then_some(Line { name, values })
    };
    let lines = names.into_iter().filter_map(line).collect();
    let chart = OverTime { time: column("time"), quantity: "energy", unit: "J", prefixes: true, lines, mark: None };
    let caption =
        "Kinetic and strain energy, the works of contact, loads and supports, and the energy dissipated by friction.";
    let chart = chart.draw().map_or_else(String::new, |svg| figure(&svg, "energies over time", caption));
    let mut table = Table::new(&["at the end", "#value"]);
    for (key, name) in [
        ("initial", "energy at the start (J)"),
        ("kinetic", "kinetic energy (J)"),
        ("strain", "strain energy (J)"),
        ("work_of_loads", "work of loads (J)"),
        ("work_of_supports", "work of supports (J)"),
        ("work_of_contact", "work of contact (J)"),
        ("friction", "dissipated by friction (J)"),
    ] {
        table.row(&[name.to_string(), number(document.number(&format!("balance.{key}")))]);
    }
    for (key, name) in [("energy_drift", "drift of the energy"), ("impulse_drift", "drift of the impulse")] {
        let drift = document.number(&format!("balance.{key}")).map_or("–".to_string(), share);
        table.row(&[name.to_string(), drift]);
    }
    section("Energy and residuals", &(chart + &table.html() + &consistency(document) + &residuals(document)))
}

fn residuals(document: &Document) -> String {
    let Some(residuals) = document.at("residuals").as_object() else { return String::new() };
    let mut table = Table::new(&["condition of admissibility", "#largest residual"]);
    for (name, value) in residuals {
        let value = value.as_f64();
        let good = value.is_some_and(|value| value <= 1e-10);
        let shown = value.map_or("not finite".to_string(), |value| hatted(&short(value, 2)));
        table.marked(if good { "" } else { "bad" }, vec![html(&name.replace('_', " ")), html(&shown)]);
    }
    heading("Residuals, relative to the largest term; above 10^-10 a field is not admissible") + &table.html()
}

/// The consistency of a history of another program, where the document has it.
fn consistency(document: &Document) -> String {
    let Some(found) = document.at("consistency").as_object() else { return String::new() };
    let mut table = Table::new(&["consistency of the history", "~value"]);
    for (key, value) in found {
        let shown = match value {
            serde_json::Value::Number(_) => number(value.as_f64()),
            serde_json::Value::String(text) => text.clone(),
            serde_json::Value::Null => continue,
            other => other.to_string(),
        };
        table.row(&[key.replace('_', " "), shown]);
    }
    table.html()
}

pub(super) fn section_of(contents: &Contents<'_>) -> String {
    let all = [mesh(contents), stated(contents.statement), planes(contents.document), time(contents.document)];
    section("Model", &all.join(""))
}

fn mesh(contents: &Contents<'_>) -> String {
    let Contents { document, body, .. } = contents;
    let mut table = Table::new(&["mesh", "#value"]);
    let mut row = |name: &str, value: String| table.row(&[name.to_string(), value]);
    row("nodes", number(document.number("problem.nodes")));
    row(if body.dimension == 1 { "bar elements" } else { "triangles" }, body.elements().to_string());
    row("lower corner (m)", vector(&document.column("problem.lower_corner")));
    row("upper corner (m)", vector(&document.column("problem.upper_corner")));
    row("mean size of the elements (m)", number(Some(body.mean_size())));
    row("mass (kg)", number(document.number("problem.mass")));
    row("largest wave speed (m/s)", number(document.number("problem.wave_speed")));
    row("contact nodes", number(document.number("problem.contact_nodes")));
    row("prescribed components of nodes", number(document.number("problem.prescribed_components")));
    row("loaded edges", number(document.number("problem.loaded_facets")));
    for (kind, groups) in ["edges", "elements"].into_iter().zip(&body.groups) {
        groups.iter().for_each(|(name, members)| row(&format!("group of {kind} “{name}”"), members.to_string()));
    }
    table.html()
}

/// Materials, supports and loads as the statement of the problem has them.
fn stated(statement: &str) -> String {
    let Ok(tables) = statement.parse::<toml::Table>() else { return String::new() };
    let kinds =
        [("material", "material"), ("support", "support"), ("traction", "traction"), ("body_force", "body force")];
    let mut all = String::new();
    for (key, title) in kinds {
        let entries: Vec<&toml::Table> = match tables.get(key) {
            Some(toml::Value::Table(one)) => vec![one],
            Some(toml::Value::Array(many)) => many.iter().filter_map(toml::Value::as_table).collect(),
            _ => continue,
        };
        let mut table = Table::new(&["of", "key", "~value"]);
        for (i, entry) in entries.iter().enumerate() {
            for (k, (name, value)) in entry.iter().enumerate() {
                let first = if k > 0 {
                    String::new()
                } else if entries.len() > 1 {
                    format!("{title} {i}")
                } else {
                    title.to_string()
                };
                table.row(&[first, key_with_unit(name), of_toml(value)]);
            }
        }
        all += &table.html();
    }
    all
}

fn key_with_unit(name: &str) -> String {
    let unit = match name {
        "young" => " (Pa)",
        "density" => " (kg/m³)",
        "thickness" => " (m)",
        "section" => " (m²)",
        _ => "",
    };
    format!("{name}{unit}")
}

/// A value; of long lists, the beginning.
fn of_toml(value: &toml::Value) -> String {
    const MOST: usize = 120;
    let text = written(value);
    if text.chars().count() <= MOST { text } else { text.chars().take(MOST).collect::<String>() + " …" }
}

fn written(value: &toml::Value) -> String {
    let joined = |all: Vec<String>| all.join(", ");
    match value {
        toml::Value::String(text) => text.clone(),
        toml::Value::Float(value) => number(Some(*value)),
        toml::Value::Integer(value) => value.to_string(),
        toml::Value::Boolean(value) => value.to_string(),
        toml::Value::Datetime(_) => String::new(),
        toml::Value::Array(all) => format!("[{}]", joined(all.iter().map(written).collect())),
        toml::Value::Table(all) => {
            joined(all.iter().map(|(key, value)| format!("{key} = {}", written(value))).collect())
        }
    }
}

fn planes(document: &Document) -> String {
    let mut table = Table::new(&["#plane", "point (m)", "normal", "#friction", "group"]);
    for (i, plane) in document.list("problem.obstacles").iter().enumerate() {
        let [point, normal] = ["point", "normal"].map(|key| vector(&numbers(&plane[key])));
        let group = plane["group"].as_str().unwrap_or("all edges").to_string();
        table.row(&[i.to_string(), point, normal, number(plane["friction"].as_f64()), group]);
    }
    table.html()
}

fn time(document: &Document) -> String {
    let mut table = Table::new(&["time and estimate", "#value"]);
    let mut row = |name: &str, value: String| table.row(&[name.to_string(), value]);
    row("longest step Δt", seconds(document.number("time_step")));
    row("critical step Δt_c", seconds(document.number("critical_time_step")));
    row("steps", number(document.number("steps")));
    row("end of the estimate", seconds(document.number("end")));
    for key in ["reconstruction", "acceleration", "every"] {
        let value = document.at(&format!("options.{key}"));
        row(key, value.as_str().map_or_else(|| number(value.as_f64()), str::to_string));
    }
    for (key, name) in [("velocity", "velocities"), ("acceleration", "accelerations")] {
        if document.flag(&format!("given.{key}")) {
            row(name, "of the history itself".to_string());
        }
    }
    let derived: Vec<&str> = document.list("derived").iter().filter_map(serde_json::Value::as_str).collect();
    if !derived.is_empty() {
        row("derived, because the history lacks them", derived.join(", "));
    }
    row("duration of the work (s)", number(document.number("seconds")));
    table.html()
}
