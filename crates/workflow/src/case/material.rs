//! `[material]`: the law of all elements or of a group.

use super::source::CaseError;
use super::table::Table;
use percute_core::cell::CellKind;
use percute_core::material::{Elastic, Kinematics, MaterialError};

/// Keys of plane bodies alone, and of bars alone.
const OF_PLANE: [&str; 3] = ["poisson", "plane", "thickness"];
const OF_BAR: &str = "section";
/// Keys that a solid does not have.
const OF_SOLID_NOT: [&str; 3] = ["plane", "thickness", "section"];

/// What is said of properties that a bar does not have.
pub(super) const NOT_FOR_BARS: &str = "does not apply to a bar";

/// Reads all materials, each with its group of elements.
pub(super) fn read(root: &Table<'_>, shape: CellKind) -> Result<Vec<(Option<String>, Elastic)>, CaseError> {
    let tables = root.tables("material")?;
    if tables.is_empty() {
        return Err(root.error(
            "the table [material] is missing: give `young` (Pa), `density` (kg/m³), `poisson` and `plane` (a solid: no \
             `plane`; a bar: `section` in m² alone)",
        ));
    }
    let one = |table: &Table<'_>| {
        let law = law(table, shape)?;
        let group = table.get("group").map(|v| v.text("the name of a group of elements")).transpose()?;
        Ok((group.map(str::to_string), law))
    };
    tables.iter().map(one).collect()
}

/// Reads the law of a material.
pub(super) fn law(table: &Table<'_>, shape: CellKind) -> Result<Elastic, CaseError> {
    let law = match shape {
        CellKind::Bar => bar(table),
        CellKind::Triangle => plane(table),
        CellKind::Tetrahedron => solid(table),
    }?;
    let law = law.with_kinematics(kinematics(table)?).map_err(|error| out_of_range(table, &error))?;
    let number = |key: &str, unit: &str| table.get(key).map(|value| value.number(unit)).transpose();
    let yield_stress = number("yield_stress", "Pa")?;
    let stated = [number("tangent", "Pa")?, number("hardening", "Pa")?, number("kinematic", "")?];
    law.with_yielding(yield_stress, stated).map_err(|error| out_of_range(table, &error))
}

/// Small or finite kinematics, and the law of the latter.
fn kinematics(table: &Table<'_>) -> Result<Kinematics, CaseError> {
    let named = |key: &str, names: &str| table.get(key).map(|value| value.text(names)).transpose();
    let kinematics = named("kinematics", "\"small\" or \"finite\"")?;
    let law = named("law", "\"neo_hookean\", \"svk\" or \"hencky\"")?;
    Kinematics::from_names(kinematics, law).map_err(|(key, told)| {
        let hint = match (key, law.unwrap_or_default()) {
            ("law", law) if Kinematics::law_names().contains(&law) => String::new(),
            ("law", law) => crate::message::hint(law, Kinematics::law_names()),
            _ => crate::message::hint(kinematics.unwrap_or_default(), Kinematics::NAMES),
        };
        let told = format!("{told}{hint}");
        table.get(key).map_or_else(|| table.error(&told), |value| value.error(&told))
    })
}

fn bar(table: &Table<'_>) -> Result<Elastic, CaseError> {
    for key in OF_PLANE {
        let why = format!("{NOT_FOR_BARS}, which has a `section` (m²) and stretches along its axis only");
        table.refuse(key, &why)?;
    }
    table.only_but(&OF_PLANE)?;
    let young = number(table, "young", "Pa")?;
    let density = number(table, "density", "kg/m³")?;
    let section = number(table, "section", "m²")?;
    Elastic::bar(young, density, section).map_err(|error| out_of_range(table, &error))
}

fn plane(table: &Table<'_>) -> Result<Elastic, CaseError> {
    table.refuse(OF_BAR, "applies to bars only; a plane body has `plane` and `thickness` (m)")?;
    table.only_but(&[OF_BAR])?;
    let young = number(table, "young", "Pa")?;
    let poisson = number(table, "poisson", "")?;
    let density = number(table, "density", "kg/m³")?;
    let plane = table.require("plane", "\"stress\" (a thin plate) or \"strain\" (a long body)")?;
    // Energies are then those of a slice of unit thickness, as in the paper.
    let thickness = table.get("thickness").map_or(Ok(1.0), |value| value.number("m"))?;
    let law = match plane.text("\"stress\" or \"strain\"")? {
        "stress" => Elastic::plane_stress(young, poisson, density, thickness),
        "strain" => Elastic::plane_strain(young, poisson, density, thickness),
        other => {
            let hint = crate::message::hint(other, ["stress", "strain"]);
            return Err(plane.must_be(format!("\"stress\" or \"strain\"{hint}")));
        }
    };
    law.map_err(|error| out_of_range(table, &error))
}

fn solid(table: &Table<'_>) -> Result<Elastic, CaseError> {
    for key in OF_SOLID_NOT {
        table.refuse(key, "does not apply to a solid, which is whole in all three dimensions; leave it out")?;
    }
    table.only_but(&OF_SOLID_NOT)?;
    let young = number(table, "young", "Pa")?;
    let poisson = number(table, "poisson", "")?;
    let density = number(table, "density", "kg/m³")?;
    Elastic::solid(young, poisson, density).map_err(|error| out_of_range(table, &error))
}

fn number(table: &Table<'_>, key: &str, unit: &str) -> Result<f64, CaseError> {
    let what = if unit.is_empty() { "a number without unit".to_string() } else { format!("a number in {unit}") };
    table.require(key, &what)?.number(unit)
}

fn out_of_range(table: &Table<'_>, error: &MaterialError) -> CaseError {
    let message = format!("is {} {}; it must be {}", error.value, error.unit, error.allowed);
    table.get(error.name).map_or_else(|| table.error(&message), |value| value.error(&message))
}
