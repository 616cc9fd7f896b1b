//! The rows of a step as bytes at their place in the file.

use super::PLASTIC;
use super::checkpoints::CheckpointPlaces;
use super::native::{bytes, write_vectors};
use crate::checksum::Checksum;
use percute_core::history::Step;
use percute_system::write_all_at;
use std::fs::File;
use std::io;

/// Fields over time, in the order of their checksums; the last one is there where a material yields.
pub(super) const FIELDS: [&str; 6] = ["displacement", "velocity", "acceleration", "reaction", "touching", PLASTIC];

/// Number of checksums of an instant.
pub(super) fn sums_at_an_instant(yields: bool) -> usize {
    FIELDS.len() - usize::from(!yields)
}

/// The place of the rows of step 0 in the file (bytes), and their number of nodes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Places {
    pub(super) displacement: u64,
    pub(super) velocity: Option<u64>,
    pub(super) acceleration: Option<u64>,
    pub(super) reaction: u64,
    pub(super) touching: u64,
    /// Of the internal variables of the elements, and their count.
    pub(super) plastic: Option<(u64, usize)>,
    pub(super) steps_written: u64,
    pub(super) complete: u64,
    /// Of a row of checksums for each step.
    pub(super) checksums: u64,
    pub(super) checkpoints: Option<CheckpointPlaces>,
    pub(super) dimension: usize,
    pub(super) nodes: usize,
    pub(super) contact_nodes: usize,
    /// Whether the file has reactions and touching status.
    pub(super) has_contact: bool,
    /// Number of instants in the file before the run went on: the count in the file never falls.
    pub(super) had: usize,
}

impl Places {
    /// The place of each array over time, and the size of a step in it (bytes).
    pub(super) fn rooms(&self) -> impl Iterator<Item = (u64, u64)> {
        let (nodes, contact) = (24 * self.nodes as u64, self.contact_nodes as u64);
        let nodal = [Some(self.displacement), self.velocity, self.acceleration].into_iter().flatten();
        let of_contact = [(self.reaction, 8 * self.dimension as u64 * contact), (self.touching, contact)];
        let of_elements = self.plastic.map(|(place, count)| (place, 8 * count as u64));
        let nodal = nodal.map(move |place| (place, nodes));
        nodal.chain(of_contact.into_iter().filter(|_| self.has_contact)).chain(of_elements)
    }
}

/// A copy of a step, passed between threads.
#[derive(Debug, Default)]
pub(super) struct Row {
    /// Its number in the run.
    pub(super) index: usize,
    /// Its place in the file.
    place: usize,
    displacement: Vec<f64>,
    reaction: Vec<f64>,
    touching: Vec<u8>,
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
    plastic: Vec<f64>,
}

impl Row {
    /// Copies a step into the memory of the previous one.
    pub(super) fn take(&mut self, step: &Step<'_>, place: usize) {
        (self.index, self.place) = (step.index, place);
        let fields = [
            (&mut self.displacement, Some(step.displacement)),
            (&mut self.reaction, Some(step.reaction)),
            (&mut self.velocity, step.velocity),
            (&mut self.acceleration, step.acceleration),
            (&mut self.plastic, Some(step.internal)),
        ];
        for (kept, given) in fields {
            kept.clear();
            kept.extend_from_slice(given.unwrap_or_default());
        }
        self.touching.clear();
        self.touching.extend(step.touching.iter().map(|&touches| u8::from(touches)));
    }

    /// Writes the rows of the step, and then their count.
    pub(super) fn write(&self, file: &File, places: &Places) -> io::Result<()> {
        let (n, nodes) = (self.place as u64, places.nodes as u64);
        let contact = places.contact_nodes as u64;
        let fields = [
            (Some(places.displacement), &self.displacement),
            (places.velocity, &self.velocity),
            (places.acceleration, &self.acceleration),
        ];
        for (place, values) in fields {
            if let Some(place) = place {
                write_vectors(file, place + n * nodes * 24, values, places.dimension)?;
            }
        }
        if places.has_contact {
            let reaction = bytes(&self.reaction);
            write_all_at(file, &reaction, places.reaction + n * contact * 8 * places.dimension as u64)?;
            write_all_at(file, &self.touching, places.touching + n * contact)?;
        }
        if let Some((place, count)) = places.plastic {
            write_all_at(file, &bytes(&self.plastic), place + n * 8 * count as u64)?;
        }
        let sums = self.checksums(places.has_contact);
        let sums = sums[..sums_at_an_instant(places.plastic.is_some())]
            .iter()
            .flat_map(|sum| sum.to_ne_bytes())
            .collect::<Vec<u8>>();
        write_all_at(file, &sums, places.checksums + n * sums.len() as u64)?;
        let count = (self.place + 1).max(places.had) as u64;
        write_all_at(file, &count.to_ne_bytes(), places.steps_written)
    }

    /// The checksums of the fields, in the order of [`FIELDS`]; 0 of those that are not stored.
    fn checksums(&self, has_contact: bool) -> [i64; FIELDS.len()] {
        let nodal = |values: &Vec<f64>| {
            if values.is_empty() { 0 } else { Checksum::new().numbers(values).stored() }
        };
        let [displacement, velocity, acceleration, plastic] =
            [&self.displacement, &self.velocity, &self.acceleration, &self.plastic].map(nodal);
        let mut all = [displacement, velocity, acceleration, 0, 0, plastic];
        if has_contact {
            all[3] = Checksum::new().numbers(&self.reaction).stored();
            all[4] = Checksum::new().indices(self.touching.iter().map(|&touches| touches.into())).stored();
        }
        all
    }
}
