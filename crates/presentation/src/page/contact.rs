//! Contact: force, zone and pressure over time.

use super::Contents;
use super::html::{
    Named, Table, figure, members, number, paragraph, quantity, remark, section, share, together, vector,
};
use crate::chart::{Line, OverTime, space_time};
use crate::document::{Document, numbers};
use crate::scale::vector_quantity;
use percute_core::contact::{contact_name, side_names};
use serde_json::Value;

pub(super) fn section_of(contents: &Contents<'_>) -> String {
    let document = contents.document;
    if document.at("contact").is_null() {
        return String::new();
    }
    if document.number("contact.first_touch").is_none() {
        let what = if document.has_interfaces() { "another body" } else { "a plane" };
        return section("Contact", &paragraph(&format!("No node touches {what}.")));
    }
    let all =
        [facts(document), force(document), zone(document), pressure(contents), rebound(document), impacts(document)];
    section("Contact", &all.join(""))
}

fn facts(document: &Document) -> String {
    let mut table = Table::new(&["", "#value"]);
    let value = |path: &str| document.number(path);
    let mut row = |name: &str, value: String| table.row(&[name.to_string(), value]);
    row("first touch", quantity(value("contact.first_touch"), "s"));
    row("averaged peak of the normal force", quantity(value("contact.averaged_peak.force"), document.unit("N")));
    row("time of the averaged peak", quantity(value("contact.averaged_peak.time"), "s"));
    row("averaged peak of the pressure at a node", quantity(value("contact.averaged_peak.pressure"), "Pa"));
    row("at node", number(value("contact.averaged_peak.node")));
    let shown = |impulse: &Value| together(&vector_quantity(&numbers(impulse), document.unit("N s"), 5));
    if document.has_interfaces() {
        for (k, _) in document.names_of_obstacles() {
            let impulse =
                document.list("contact.obstacles").get(k).and_then(|over_time| over_time["impulse"].as_array());
            let [first, second] = side_names(document.groups(k));
            if let Some(impulse) = impulse.and_then(|impulse| impulse.last()) {
                row(&format!("impulse on {first}, from {second}"), shown(impulse));
            }
        }
    } else if let Some(impulse) = document.list("contact.total.impulse").last() {
        row("impulse on the body", shown(impulse));
    }
    let friction = document.column("contact.total.friction_energy").last().copied();
    row("energy dissipated by friction", quantity(friction, document.unit("J")));
    row("impulse of the admissible contact force over that of the simulation", share(value("impulse_ratio")));
    table.html()
}

fn force(document: &Document) -> String {
    let names = document.names_of_obstacles();
    let all = if document.has_interfaces() { "all contacts" } else { "all planes" };
    let mut lines = vec![Line { name: all, values: document.column("contact.total.normal_force") }];
    if names.len() > 1 {
        let over_time = document.list("contact.obstacles");
        let normal = |k: usize| over_time.get(k).map_or_else(Vec::new, |each| numbers(&each["normal_force"]));
        lines.extend(names.iter().map(|(k, name)| Line { name, values: normal(*k) }));
    }
    let mark = document.number("contact.averaged_peak.time").map(|time| (time, "averaged peak"));
    let time = document.column("contact.time");
    let chart = OverTime { time, quantity: "normal force", unit: document.unit("N"), prefixes: true, lines, mark };
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
    // A bar has a single node at each end.
    if contents.surfaces.is_empty() && contents.body.dimension == 2 {
        return remark(
            "The pressure along the surface is not drawn: the report has no contact results of all nodes at all \
             instants.",
        );
    }
    let several = contents.surfaces.len() > 1;
    let drawn = contents.surfaces.iter().filter_map(|surface| Some((surface, space_time(surface).ok()?)));
    drawn
        .map(|(surface, svg)| {
            let [from, to] = surface.ends.each_ref().map(|end| vector(end));
            let at = if several { format!(" at {}", surface.name) } else { String::new() };
            let caption = format!(
                "Pressure over time{at} along the part of the surface that comes into contact, from {from} m (below) \
                 to {to} m (above), undeformed. No colour: no pressure."
            );
            figure(&svg, &format!("pressure{at} along the surface over time"), &caption)
        })
        .collect()
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

/// What contact did to several bodies: the velocity of each centre of mass, and the rebound at each interface.
fn impacts(document: &Document) -> String {
    if document.list("impacts.bodies").is_empty() {
        return String::new();
    }
    let velocity = |v: &Value| match v.is_null() {
        true => "–".to_string(),
        false => together(&vector_quantity(&numbers(v), "m/s", 5)),
    };
    let mut bodies = Table::new(&["centre of mass", "#at the start", "#at the end"]);
    for body in document.list("impacts.bodies") {
        let name = body["name"].as_str().unwrap_or_default().to_string();
        bodies.row(&[name, velocity(&body["velocity_before"]), velocity(&body["velocity_after"])]);
    }
    let titles =
        ["interface", "#relative normal velocity before", "#after", "#restitution", "#first touch", "#time in contact"];
    let mut interfaces = Table::new(&titles);
    let mut reasons = Vec::new();
    for each in document.list("impacts.interfaces") {
        let name = contact_name([0, 1].map(|side| each["groups"][side].as_str().unwrap_or_default()));
        let of = |key: &str, unit: &str| quantity(each[key].as_f64(), unit);
        let restitution = number(each["restitution"].as_f64());
        let [before, after] = ["normal_before", "normal_after"].map(|key| of(key, "m/s"));
        let [touch, time] = ["first_touch", "time_in_contact"].map(|key| of(key, "s"));
        if let Some(reason) = each["no_restitution"].as_str() {
            reasons.push(format!("{name} has no coefficient of restitution: {reason}."));
        }
        interfaces.row(&[name, before, after, restitution, touch, time]);
    }
    let reasons = if reasons.is_empty() { String::new() } else { remark(&reasons.join(" ")) };
    bodies.html() + &interfaces.html() + &reasons
}

/// The rebound; V is the velocity of the centre of mass, n the normal of the plane.
const REBOUND: [Named; 10] = [
    ("velocity_before", "velocity V of the centre of mass before contact", "m/s"),
    ("velocity_after", "velocity V′ after contact", "m/s"),
    ("normal_before", "normal component V·n", "m/s"),
    ("normal_after", "normal component V′·n", "m/s"),
    ("restitution", "coefficient of restitution −V′·n / V·n", ""),
    ("first_touch", "first touch", "s"),
    ("release", "release", "s"),
    ("time_in_contact", "time in contact", "s"),
    ("span", "from first touch to release", "s"),
    ("ended", "contact has ended", ""),
];
