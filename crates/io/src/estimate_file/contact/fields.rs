//! Contact results as fields on the body.

use crate::error::FileCause;
use crate::mesh::in_space;
use crate::write::{numbers, unit};
use hdf5::Group;
use percute_core::contact::{ContactResults, ContactSteps};
use percute_core::units::Units;

/// Contact status of a node that is not on the contact surface.
const OFF: i8 = -1;

/// Writes the fields on all nodes at some steps; gives the names. Outside the contact surface all values are 0, and the
/// status is −1.
pub(in crate::estimate_file) fn write_fields<const D: usize>(
    data: &Group,
    (results, steps): (&ContactResults<D>, &ContactSteps<D>),
    (nodes, units): (usize, Units),
    at: &[usize],
) -> Result<Vec<&'static str>, FileCause> {
    let spread = Spread { results, nodes, at };
    let area = |row: usize| results.nodes[row % results.nodes.len()].area;
    let vectors: [(&str, &'static str, Vec<[f64; D]>); 3] = [
        ("contact_force", "N", spread.all([0.0; D], |row| steps.force[row])),
        ("contact_density", "Pa", spread.all([0.0; D], |row| steps.force[row].map(|f| f / area(row)))),
        ("sliding_velocity", "m/s", spread.all([0.0; D], |row| steps.sliding_velocity[row])),
    ];
    let scalars = [
        ("gap", "m", spread.all(0.0, |row| steps.gap[row])),
        ("friction_energy", "J", spread.all(0.0, |row| steps.friction_energy[row])),
    ];
    let rows = at.len() * nodes;
    for (name, of, values) in &vectors {
        unit(&numbers(data, name, &[rows, 3], &in_space(values))?, units.of(of))?;
    }
    for (name, of, values) in &scalars {
        unit(&numbers(data, name, &[rows], values)?, units.of(of))?;
    }
    numbers(data, "contact_status", &[rows], &spread.all(OFF, |row| steps.status[row] as i8))?;
    let names = vectors.iter().map(|v| v.0).chain(scalars.iter().map(|s| s.0));
    Ok(names.chain(["contact_status"]).collect())
}

/// Rows of contact nodes, spread over all nodes, at some steps.
struct Spread<'a, const D: usize> {
    results: &'a ContactResults<D>,
    nodes: usize,
    at: &'a [usize],
}

impl<const D: usize> Spread<'_, D> {
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
