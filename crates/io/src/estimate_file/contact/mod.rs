//! Contact results in an estimate file: all contact nodes at all instants with their resultants, in `percute/contact`,
//! and on the body for ParaView at the instants of the maps.

mod fields;
mod read;

pub(super) use fields::write_fields;
pub use read::contact;

use crate::error::FileCause;
use crate::write::{group, numbers, unit};
use hdf5::Group;
use percute_core::border::Vector;
use percute_core::contact_results::{AveragedPeak, ContactResults, ContactSteps, Resultant};
use percute_core::units::Units;

/// Size of the results in a file (bytes), at `instants` of maps over `nodes` nodes.
pub(super) fn bytes(results: &ContactResults, instants: usize, nodes: usize) -> usize {
    let (rows, steps, d) = (results.nodes.len(), results.instants.len(), results.dimension);
    let resultants = (1 + results.obstacles.len()) * (steps * (24 * d + 40) + 5_000);
    let all = rows * steps * ContactSteps::bytes(d);
    resultants + all + rows * (24 * d + 64) + 8 * steps + instants * (nodes * (3 * 24 + 17) + 48) + 16_000
}

/// Writes `percute/contact`.
pub(super) fn write(
    ours: &Group,
    results: &ContactResults,
    steps: &ContactSteps,
    units: Units,
) -> Result<(), FileCause> {
    let contact = group(ours, "contact")?;
    let (nodes, instants, d) = (results.nodes.len(), results.instants.len(), results.dimension);
    numbers(&contact, "node", &[nodes], &integers(&results.nodes, |p| p.node.index()))?;
    numbers(&contact, "obstacle", &[nodes], &integers(&results.nodes, |p| p.obstacle))?;
    let write = |name: &str, of: &'static str, shape: &[usize], values: &[f64]| -> Result<(), FileCause> {
        let set = numbers(&contact, name, shape, values)?;
        if of.is_empty() { Ok(()) } else { unit(&set, units.of(of)) }
    };
    write("point", "m", &[nodes, d], &vectors(&results.nodes, d, |p| p.point))?;
    write("normal", "", &[nodes, d], &vectors(&results.nodes, d, |p| p.normal))?;
    write("area", "m2", &[nodes], &column(&results.nodes, |p| p.area))?;
    let summary = &results.summary;
    write("first_touch", "s", &[nodes], &column(summary, |s| s.first_touch.unwrap_or(f64::NAN)))?;
    write("time_in_contact", "s", &[nodes], &column(summary, |s| s.time_in_contact))?;
    write("peak_normal_force", "N", &[nodes], &column(summary, |s| s.peak_normal_force))?;
    write("time_of_peak", "s", &[nodes], &column(summary, |s| s.time_of_peak.unwrap_or(f64::NAN)))?;
    write("peak_pressure", "Pa", &[nodes], &column(summary, |s| s.peak_pressure))?;
    write("impulse", "N s", &[nodes, d], &vectors(summary, d, |s| s.impulse))?;
    write("time", "s", &[instants], &results.instants)?;
    let at_surface_end = f64::from(u8::from(results.at_surface_end));
    let scalars = [
        ("slip", "", results.slip),
        ("penetration", "", results.penetration),
        ("inclination", "rad", results.inclination),
        ("at_surface_end", "", at_surface_end),
    ];
    for (name, of, value) in scalars.into_iter().filter(|(.., value)| *value > 0.0) {
        write(name, of, &[1], &[value])?;
    }
    if let Some(AveragedPeak { force, time, pressure, at }) = results.averaged_peak {
        write("averaged_peak_force", "N", &[1], &[force])?;
        write("time_of_averaged_peak", "s", &[1], &[time])?;
        write("averaged_peak_pressure", "Pa", &[1], &[pressure])?;
        write("place_of_averaged_peak_pressure", "", &[1], &[at as f64])?;
    }
    write("force", "N", &[instants, nodes, d], &steps.force)?;
    write("gap", "m", &[instants, nodes], &steps.gap)?;
    write("sliding_velocity", "m/s", &[instants, nodes, d], &steps.sliding_velocity)?;
    let status: Vec<u8> = steps.status.iter().map(|s| *s as u8).collect();
    numbers(&contact, "status", &[instants, nodes], &status)?;
    write("friction_energy", "J", &[instants, nodes], &steps.friction_energy)?;
    if !steps.area.is_empty() {
        write("area_over_time", "m^2", &[instants, nodes], &steps.area)?;
    }
    write_resultants(&group(&contact, "total")?, &results.total, (d, units))?;
    let obstacles = group(&contact, "obstacles")?;
    for (at, over_time) in results.obstacles.iter().enumerate() {
        write_resultants(&group(&obstacles, &at.to_string())?, over_time, (d, units))?;
    }
    Ok(())
}

/// Name, unit, and the value of a resultant.
type Named<T> = (&'static str, &'static str, fn(&Resultant) -> T);

fn write_resultants(part: &Group, over_time: &[Resultant], (d, units): (usize, Units)) -> Result<(), FileCause> {
    let count = over_time.len();
    let scalars: [Named<f64>; 3] = [
        ("normal_force", "N", |r| r.normal_force),
        ("area", "m2", |r| r.area),
        ("friction_energy", "J", |r| r.friction_energy),
    ];
    for (name, of, take) in scalars {
        unit(&numbers(part, name, &[count], &column(over_time, take))?, units.of(of))?;
    }
    let fields: [Named<Vector>; 3] = [
        ("force", "N", |r| r.force),
        ("impulse", "N s", |r| r.impulse),
        ("centre", "m", |r| r.centre.unwrap_or([f64::NAN; 3])),
    ];
    for (name, of, take) in fields {
        unit(&numbers(part, name, &[count, d], &vectors(over_time, d, take))?, units.of(of))?;
    }
    numbers(part, "in_contact", &[count], &integers(over_time, |r| r.in_contact))?;
    numbers(part, "slipping", &[count], &integers(over_time, |r| r.slipping)).map(drop)
}

fn column<T>(rows: &[T], of: impl Fn(&T) -> f64) -> Vec<f64> {
    rows.iter().map(of).collect()
}

fn integers<T>(rows: &[T], of: impl Fn(&T) -> usize) -> Vec<i64> {
    rows.iter().map(|row| of(row) as i64).collect()
}

/// Vectors of a dimension, in rows.
fn vectors<T>(rows: &[T], dimension: usize, of: impl Fn(&T) -> Vector) -> Vec<f64> {
    rows.iter().flat_map(|row| of(row).into_iter().take(dimension)).collect()
}
