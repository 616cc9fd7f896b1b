//! Contact: force, zone and pressure over time.

use super::Contents;
use super::html::{
    Named, Table, figure, members, number, paragraph, quantity, remark, section, share, together, vector,
};
use crate::chart::{Line, OverTime, space_time};
use crate::document::Document;
use crate::scale::vector_quantity;

/// Chart names of the first contacts or planes; more are left out of the chart.
const CONTACTS: [&str; 5] = ["contact 0", "contact 1", "contact 2", "contact 3", "contact 4"];
const PLANES: [&str; 5] = ["plane 0", "plane 1", "plane 2", "plane 3", "plane 4"];

pub(super) fn section_of(contents: &Contents<'_>) -> String {
    let document = contents.document;
    if document.at("contact").is_null() {
        return String::new();
    }
    if document.number("contact.first_touch").is_none() {
        return section("Contact", &paragraph("No node touches a plane."));
    }
    let all = [facts(document), force(document), zone(document), pressure(contents), rebound(document)];
    section("Contact", &all.join(""))
}

fn facts(document: &Document) -> String {
    let mut table = Table::new(&["", "#value"]);
    let value = |path: &str| document.number(path);
    let mut row = |name: &str, value: String| table.row(&[name.to_string(), value]);
    row("first touch", quantity(value("contact.first_touch"), "s"));
    row("peak of the normal force", quantity(value("contact.peak_normal_force"), "N"));
    row("time of the peak", quantity(value("contact.time_of_peak"), "s"));
    row("largest pressure at a node", quantity(value("contact.peak_pressure"), "Pa"));
    row("at node", number(value("contact.node_of_peak_pressure")));
    if let Some(impulse) = document.list("contact.total.impulse").last() {
        row("impulse on the body", together(&vector_quantity(&crate::document::numbers(impulse), "N s", 5)));
    }
    let friction = document.column("contact.total.friction_energy").last().copied();
    row("energy dissipated by friction", quantity(friction, "J"));
    row("impulse kept by the admissible force", share(value("kept_impulse")));
    table.html()
}

fn force(document: &Document) -> String {
    let counted = document.list("contact.obstacles").iter().zip(document.counted_obstacles());
    let planes: Vec<_> = counted.filter(|(_, counted)| *counted).map(|(plane, _)| plane).collect();
    let bodies = document.list("problem.obstacles").iter().any(|obstacle| obstacle["point"].is_null());
    let (all, names) = if bodies { ("all contacts", CONTACTS) } else { ("all planes", PLANES) };
    let mut lines = vec![Line { name: all, values: document.column("contact.total.normal_force") }];
    if planes.len() > 1 {
        let normal = |plane: &serde_json::Value| crate::document::numbers(&plane["normal_force"]);
        lines.extend(planes.into_iter().zip(names).map(|(plane, name)| Line { name, values: normal(plane) }));
    }
    let mark = document.number("contact.time_of_peak").map(|time| (time, "peak"));
    let time = document.column("contact.time");
    let chart = OverTime { time, quantity: "normal force", unit: "N", prefixes: true, lines, mark };
    chart
        .draw()
        .map_or_else(String::new, |svg| figure(&svg, "contact force over time", "Sum of the normal contact forces."))
}

fn zone(document: &Document) -> String {
    let mut lines = vec![Line { name: "nodes in contact", values: document.column("contact.total.in_contact") }];
    let mut caption = "Contact zone: nodes in contact".to_string();
    // The node of a bar has no direction to slip in.
    if document.number("problem.dimension") != Some(1.0) {
        lines.push(Line { name: "of which slipping", values: document.column("contact.total.slipping") });
        caption += ", and how many of them slip";
    }
    let time = document.column("contact.time");
    let chart = OverTime { time, quantity: "nodes", unit: "", prefixes: false, lines, mark: None };
    let Some(svg) = chart.draw() else { return String::new() };
    figure(&svg, "contact zone over time", &(caption + "."))
}

fn pressure(contents: &Contents<'_>) -> String {
    let Some(surface) = contents.surface else {
        // A bar has a single node at each end.
        let plane = contents.body.dimension == 2;
        let text = "The pressure along the surface is not drawn: the report has no contact results of all nodes at all \
            instants.";
        return if plane { remark(text) } else { String::new() };
    };
    let Ok(svg) = space_time(surface) else { return String::new() };
    let [from, to] = surface.ends.each_ref().map(|end| vector(end));
    let caption = format!(
        "Pressure over time along the part of the surface that comes into contact, from {from} m (below) to {to} m \
         (above), undeformed. No colour: no pressure."
    );
    figure(&svg, "pressure along the surface over time", &caption)
}

/// The rebound; without a coefficient of restitution, the motion of the body and the reason.
fn rebound(document: &Document) -> String {
    let mut rebound = document.at("rebound").clone();
    let reason = rebound.as_object_mut().and_then(|members| members.remove("no_restitution"));
    let Some(reason) = reason.as_ref().and_then(serde_json::Value::as_str) else {
        return members("rebound", &rebound, &REBOUND);
    };
    let reason = remark(&format!("There is no coefficient of restitution: {reason}."));
    members("centre of mass", &rebound, &REBOUND) + &reason
}

/// The rebound; V is the velocity of the centre of mass, n the normal of the plane.
const REBOUND: [Named; 9] = [
    ("velocity_before", "velocity V of the centre of mass before contact", "m/s"),
    ("velocity_after", "velocity V′ after contact", "m/s"),
    ("normal_before", "normal component V·n", "m/s"),
    ("normal_after", "normal component V′·n", "m/s"),
    ("restitution", "coefficient of restitution −V′·n / V·n", ""),
    ("first_touch", "first touch", "s"),
    ("release", "release", "s"),
    ("time_in_contact", "time in contact", "s"),
    ("ended", "contact has ended", ""),
];
