//! Contact results as fields on the body.

use crate::error::FileCause;
use crate::write::{numbers, unit};
use hdf5::Group;
use percute_core::border::row;
use percute_core::contact_results::{ContactResults, ContactSteps};
use percute_core::units::Units;

/// Contact status of a node that is not on the contact surface.
const OFF: i8 = -1;

/// Writes the fields on all nodes at some steps; gives the names. Outside the contact surface all values are 0, and the
/// status is −1.
pub(in crate::estimate_file) fn write_fields(
    data: &Group,
    (results, steps): (&ContactResults, &ContactSteps),
    (nodes, units): (usize, Units),
    at: &[usize],
) -> Result<Vec<&'static str>, FileCause> {
    let (spread, d) = (Spread { results, nodes, at }, results.dimension);
    let area = |row: usize| results.nodes[row % results.nodes.len()].area;
    let force = |at: usize| row(&steps.force, at, d);
    let vectors = [
        ("contact_force", "N", spread.all([0.0; 3], force)),
        ("contact_density", "Pa", spread.all([0.0; 3], |at| force(at).map(|f| f / area(at)))),
        ("sliding_velocity", "m/s", spread.all([0.0; 3], |at| row(&steps.sliding_velocity, at, d))),
    ];
    let scalars = [
        ("gap", "m", spread.all(0.0, |row| steps.gap[row])),
        ("friction_energy", "J", spread.all(0.0, |row| steps.friction_energy[row])),
    ];
    let rows = at.len() * nodes;
    for (name, of, values) in &vectors {
        unit(&numbers(data, name, &[rows, 3], values.as_flattened())?, units.of(of))?;
    }
    for (name, of, values) in &scalars {
        unit(&numbers(data, name, &[rows], values)?, units.of(of))?;
    }
    numbers(data, "contact_status", &[rows], &spread.all(OFF, |row| steps.status[row] as i8))?;
    let names = vectors.iter().map(|v| v.0).chain(scalars.iter().map(|s| s.0));
    Ok(names.chain(["contact_status"]).collect())
}

/// Rows of contact nodes, spread over all nodes, at some steps.
struct Spread<'a> {
    results: &'a ContactResults,
    nodes: usize,
    at: &'a [usize],
}

impl Spread<'_> {
    fn all<T: Copy>(&self, elsewhere: T, value: impl Fn(usize) -> T) -> Vec<T> {
        let mut spread = vec![elsewhere; self.at.len() * self.nodes];
        for (k, step) in self.at.iter().enumerate() {
            for (at, place) in self.results.nodes.iter().enumerate() {
                spread[k * self.nodes + place.node.index()] = value(step * self.results.nodes.len() + at);
            }
        }
        spread
    }
}
