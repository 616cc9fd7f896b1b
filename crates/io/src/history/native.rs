//! Numbers in a file as in memory, the layout of HDF5's native types.

use crate::mesh::in_space;
use percute_system::write_all_at;
use std::fs::File;
use std::io;

/// Writes nodal vectors of a dimension, in rows, with three components for ParaView.
pub(super) fn write_vectors(file: &File, place: u64, values: &[f64], dimension: usize) -> io::Result<()> {
    write_all_at(file, &bytes(&in_space(values, dimension)), place)
}

/// The bytes of numbers.
pub(super) fn bytes(values: &[f64]) -> Vec<u8> {
    values.iter().flat_map(|x| x.to_ne_bytes()).collect()
}
