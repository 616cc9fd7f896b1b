//! The rows of a step as bytes at their place in the file.

use crate::mesh::in_space;
use percute_core::history::Step;
use std::fs::File;
use std::io;
use std::os::unix::fs::FileExt;

/// The place of the rows of step 0 in the file (bytes), and their number of nodes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Places {
    pub(super) displacement: u64,
    pub(super) velocity: Option<u64>,
    pub(super) acceleration: Option<u64>,
    pub(super) reaction: u64,
    pub(super) touching: u64,
    pub(super) steps_written: u64,
    pub(super) complete: u64,
    pub(super) nodes: usize,
    pub(super) contact_nodes: usize,
    /// Whether the file has reactions and touching status.
    pub(super) has_contact: bool,
}

/// A copy of a step, passed between threads.
#[derive(Debug, Default)]
pub(super) struct Row<const D: usize> {
    /// Its number in the run.
    pub(super) index: usize,
    /// Its place in the file.
    place: usize,
    displacement: Vec<[f64; D]>,
    reaction: Vec<[f64; D]>,
    touching: Vec<u8>,
    velocity: Vec<[f64; D]>,
    acceleration: Vec<[f64; D]>,
}

impl<const D: usize> Row<D> {
    /// Copies a step into the memory of the previous one.
    pub(super) fn take(&mut self, step: &Step<'_, D>, place: usize) {
        (self.index, self.place) = (step.index, place);
        let fields = [
            (&mut self.displacement, Some(step.displacement)),
            (&mut self.reaction, Some(step.reaction)),
            (&mut self.velocity, step.velocity),
            (&mut self.acceleration, step.acceleration),
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
                write_vectors(file, place + n * nodes * 24, values)?;
            }
        }
        if places.has_contact {
            let reaction = bytes(self.reaction.as_flattened());
            file.write_all_at(&reaction, places.reaction + n * contact * 8 * D as u64)?;
            file.write_all_at(&self.touching, places.touching + n * contact)?;
        }
        file.write_all_at(&(n + 1).to_ne_bytes(), places.steps_written)
    }
}

/// Writes nodal vectors with three components for ParaView.
pub(super) fn write_vectors<const D: usize>(file: &File, place: u64, values: &[[f64; D]]) -> io::Result<()> {
    file.write_all_at(&bytes(&in_space(values)), place)
}

/// Numbers as in memory, the layout of HDF5's native types.
fn bytes(values: &[f64]) -> Vec<u8> {
    values.iter().flat_map(|x| x.to_ne_bytes()).collect()
}
