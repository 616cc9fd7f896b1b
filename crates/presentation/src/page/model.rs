//! Balances, residuals, and the model: mesh, materials, planes, supports and loads.

use super::Contents;
use super::html::{Named, Table, figure, heading, members, number, quantity, section, share, vector};
use crate::chart::{Line, OverTime};
use crate::document::{Document, numbers};
use crate::typeset::html;
use percute_workflow::message::short;

/// Energies over time, drifts, residuals.
pub(super) fn balance(document: &Document) -> String {
    let column = |name: &str| document.column(&format!("balance_over_time.{name}"));
    let names = [
        ("kinetic", "kinetic"),
        ("strain", "strain"),
        ("plastic", "plastic_work"),
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
    let chart = OverTime {
        time: column("time"),
        quantity: "energy",
        unit: document.unit("J"),
        prefixes: true,
        lines,
        mark: None,
    };
    let caption =
        "Kinetic and strain energy, the works of contact, loads and supports, and the energy dissipated by friction.";
    let chart = chart.draw().map_or_else(String::new, |svg| figure(&svg, "energies over time", caption));
    let mut table = Table::new(&["at the end", "#value"]);
    for (key, name) in [
        ("initial", "energy at the start"),
        ("kinetic", "kinetic energy"),
        ("strain", "strain energy"),
        ("plastic_work", "plastic work"),
        ("work_of_loads", "work of loads"),
        ("work_of_supports", "work of supports"),
        ("work_of_contact", "work of contact"),
        ("friction", "dissipated by friction"),
    ] {
        table.row(&[name.to_string(), quantity(document.number(&format!("balance.{key}")), document.unit("J"))]);
    }
    for (key, name) in [("energy_drift", "drift of the energy"), ("impulse_drift", "drift of the impulse")] {
        table.row(&[name.to_string(), share(document.number(&format!("balance.{key}")))]);
    }
    section(
        "Energy and residuals",
        &(chart
            + &table.html()
            + &members("consistency of the history", document.at("consistency"), &CONSISTENCY)
            + &residuals(document)),
    )
}

fn residuals(document: &Document) -> String {
    let Some(residuals) = document.at("residuals").as_object() else { return String::new() };
    let mut table = Table::new(&["condition of admissibility", "#largest residual"]);
    for (name, value) in residuals {
        let value = value.as_f64();
        let good = value.is_some_and(|value| value <= 1e-10);
        let shown = value.map_or("not finite".to_string(), |value| short(value, 2));
        table.marked(if good { "" } else { "bad" }, vec![html(&name.replace('_', " ")), html(&shown)]);
    }
    heading("Residuals, relative to the largest term; above 1e-10 a field is not admissible") + &table.html()
}

/// Figures of a history of another program.
const CONSISTENCY: [Named; 17] = [
    ("balance", "residual M a + K u − F − R over its largest term", "%"),
    ("node", "at node", "#"),
    ("time", "at t", "s"),
    ("long_step", "residual at the ends of longer steps, less ten times the rest", "%"),
    ("initial_displacement", "u_0 off that of the problem, over the size of the body", "%"),
    ("initial_velocity", "v_0 off that of the problem, over the largest", "%"),
    ("velocity", "velocities off those of the displacements", "%"),
    ("acceleration", "accelerations off those of the displacements", "%"),
    ("cone", "contact force in tension or beyond Coulomb’s limit", "%"),
    (
        "interface_balance",
        "contact force on one surface of a non-matching interface beyond that of its multipliers",
        "%",
    ),
    ("slip", "misfit of Coulomb’s law at nodes that slide", "%"),
    ("plane", "gap under contact forces, the same everywhere, over the element size", "%"),
    ("gap_under_force", "gap under a contact force, over the element size", "%"),
    ("penetration", "penetration over the element size", "%"),
    ("penalty", "correlation of contact forces with penetrations", ""),
    ("touching", "disagreements of touching status and forces over their changes", "%"),
    ("energy", "drift of the energy", "%"),
];

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
    row(&format!("mass ({})", document.unit("kg")), number(document.number("problem.mass")));
    row("largest wave speed (m/s)", number(document.number("problem.wave_speed")));
    row("contact nodes", number(document.number("problem.contact_nodes")));
    row("prescribed components of nodes", number(document.number("problem.prescribed_components")));
    row("loaded edges", number(document.number("problem.loaded_edges")));
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
        "young" | "yield_stress" | "tangent" | "hardening" => " (Pa)",
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
        let normal = vector(&numbers(&plane["normal"]));
        let point =
            if plane["point"].is_null() { "another body".to_string() } else { vector(&numbers(&plane["point"])) };
        let group = plane["group"].as_str().unwrap_or("all edges").to_string();
        table.row(&[i.to_string(), point, normal, number(plane["friction"].as_f64()), group]);
    }
    table.html()
}

fn time(document: &Document) -> String {
    let mut table = Table::new(&["time and estimate", "#value"]);
    let mut row = |name: &str, value: String| table.row(&[name.to_string(), value]);
    row("longest step Δt", quantity(document.number("time_step"), "s"));
    row("critical step Δt_c", quantity(document.number("critical_time_step"), "s"));
    row("steps", number(document.number("steps")));
    row("end of the estimate", quantity(document.number("end"), "s"));
    let sampled = "error sampled at every k-th step, k";
    for (key, name) in [("reconstruction", "reconstruction"), ("acceleration", "acceleration"), ("every", sampled)] {
        let value = document.at(&format!("options.{key}"));
        row(name, value.as_str().map_or_else(|| number(value.as_f64()), str::to_string));
    }
    for (key, name) in [("velocity", "velocities"), ("acceleration", "accelerations")] {
        if document.flag(&format!("supplied.{key}")) {
            row(name, "of the history itself".to_string());
        }
    }
    let derived: Vec<&str> = document.list("derived").iter().filter_map(serde_json::Value::as_str).collect();
    if !derived.is_empty() {
        row("derived, because the history lacks them", derived.join(", "));
    }
    table.html()
}
