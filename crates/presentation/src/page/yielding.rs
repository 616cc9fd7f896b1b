//! Where and when materials yield, and how near the others are to it.

use super::html::{Table, heading, number, quantity, section as sectioned, share, vector};
use crate::document::{Document, numbers};
use serde_json::Value;

/// A table for each material with a yield stress, and the strain that flow leaves in each body.
pub(super) fn section(document: &Document) -> String {
    let materials = document.list("deformation.materials").iter().filter(|one| one["yielding"].is_object());
    let tables: String = materials.map(material).collect();
    sectioned("Yielding", &(tables + &kept(document)))
}

fn material(material: &Value) -> String {
    let yielding = &material["yielding"];
    let mut table = Table::new(&["", "#value", "element", "centroid (m)", "#time"]);
    let mut row = |name: &str, value: String, at: &Value, time: &Value| {
        let element = at["element"].as_u64().map_or_else(String::new, |element| element.to_string());
        let centroid = numbers(&at["centroid"]);
        let centroid = if centroid.is_empty() { String::new() } else { vector(&centroid) };
        let time = time.as_f64().map_or_else(String::new, |time| quantity(Some(time), "s"));
        table.row(&[name.to_string(), value, element, centroid, time]);
    };
    let (nothing, stress) = (&Value::Null, &material["von_mises"]);
    row("yield stress", quantity(yielding["yield_stress"].as_f64(), "Pa"), nothing, nothing);
    row("largest von Mises stress", quantity(stress["value"].as_f64(), "Pa"), stress, &stress["time"]);
    row("the same over the yield stress", share(yielding["stress_ratio"].as_f64()), nothing, nothing);
    let flows = yielding["plastic"].is_object();
    let beyond = if flows { "volume that yielded" } else { "volume with a larger stress" };
    row(beyond, share(yielding["share"].as_f64()), nothing, nothing);
    if !yielding["first"].is_null() {
        row("first", String::new(), &yielding["first_place"], &yielding["first"]);
    }
    if flows {
        let largest = &yielding["plastic"]["equivalent_strain"];
        row("largest equivalent plastic strain", share(largest["value"].as_f64()), largest, &largest["time"]);
        let mean = yielding["plastic"]["mean_equivalent_strain"].as_f64();
        row("its mean at the end", share(mean), nothing, nothing);
    }
    let title = material["group"].as_str().map_or_else(String::new, |group| heading(&format!("Material of “{group}”")));
    title + &table.html()
}

/// The mean strains that bodies keep.
fn kept(document: &Document) -> String {
    let mut table = Table::new(&["mean strain at rest and free", "#xx", "#yy", "#xy"]);
    for body in document.list("deformation.bodies") {
        let strain = numbers(&body["permanent_strain"]);
        let parts = (0..3).map(|k| strain.get(k).map_or_else(String::new, |part| number(Some(*part))));
        if !strain.is_empty() {
            table.row(&[vec![body["name"].as_str().unwrap_or_default().to_string()], parts.collect()].concat());
        }
    }
    table.html()
}
