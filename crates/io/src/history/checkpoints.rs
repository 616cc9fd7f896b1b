//! The checkpoints of a history: the two newest states from which its run can go on.
//!
//! They are rows of numbers: step, sums of the balance, u_n, v_{n−½} and internal variables. A row that was being
//! written when the run was killed does not have its checksum; the other one does.

use super::native::bytes;
use crate::checksum::Checksum;
use crate::error::FileCause;
use crate::read::Part;
use crate::write::{offset, room};
use hdf5::Group;
use percute_core::history::{Checkpoint, SUMS};
use percute_system::write_all_at;
use std::fs::File;
use std::io;

/// Steps from one to the next. A checkpoint has less than three times the numbers of a step.
const EVERY: usize = 64;
/// Number of rows; they are written in turn.
const ROWS: usize = 2;
/// Numbers of a row before its fields.
const HEAD: usize = 1 + SUMS;

const NUMBERS: &str = "checkpoints";
const CHECKSUMS: &str = "checkpoint_checksums";

/// The place of the rows and of their checksums in the file.
#[derive(Clone, Copy, Debug)]
pub(super) struct CheckpointPlaces {
    numbers: u64,
    checksums: u64,
    /// Numbers of a row.
    row: u64,
}

/// Whether a step is one from which the run can go on.
pub(super) fn is_due(step: usize) -> bool {
    step > 0 && step.is_multiple_of(EVERY)
}

/// Bytes of all of them in a run of so many steps.
pub(super) fn size(steps: usize, fields: [usize; 3]) -> u64 {
    if steps < EVERY { 0 } else { (8 * ROWS * (row(fields) + 1)) as u64 }
}

/// Numbers of a row of a body with so many nodes, its dimension, and so many internal variables.
fn row([nodes, dimension, internal]: [usize; 3]) -> usize {
    HEAD + 2 * nodes * dimension + internal
}

/// Makes room for them. A run that ends before the first one needs none.
pub(super) fn make_room(ours: &Group, steps: usize, fields: [usize; 3]) -> Result<Option<CheckpointPlaces>, FileCause> {
    if steps < EVERY {
        return Ok(None);
    }
    let row = row(fields);
    let numbers = offset(&room::<f64>(ours, NUMBERS, &[ROWS, row])?)?;
    let checksums = offset(&room::<i64>(ours, CHECKSUMS, &[ROWS])?)?;
    Ok(Some(CheckpointPlaces { numbers, checksums, row: row as u64 }))
}

/// Finds the places in a file.
pub(super) fn places(ours: &Part<'_>) -> Result<Option<CheckpointPlaces>, FileCause> {
    let Some(stored) = ours.optional(NUMBERS)? else { return Ok(None) };
    let row = stored.shape.last().copied().unwrap_or_default() as u64;
    let (numbers, checksums) = (stored.native_offset::<f64>()?, ours.data(CHECKSUMS)?.native_offset::<i64>()?);
    Ok(numbers.zip(checksums).map(|(numbers, checksums)| CheckpointPlaces { numbers, checksums, row }))
}

impl CheckpointPlaces {
    /// Writes a checkpoint over the older one.
    pub(super) fn write(&self, file: &File, checkpoint: &Checkpoint) -> io::Result<()> {
        let Checkpoint { step, displacement, half_step, internal, sums } = checkpoint;
        let head = std::iter::once(*step as f64).chain(*sums);
        let fields = displacement.iter().chain(half_step).chain(internal).copied();
        let numbers: Vec<f64> = head.chain(fields).collect();
        let at = (step / EVERY % ROWS) as u64;
        write_all_at(file, &bytes(&numbers), self.numbers + 8 * self.row * at)?;
        write_all_at(file, &sum(&numbers).to_ne_bytes(), self.checksums + 8 * at)
    }

    /// Gives back the room of a run that has ended: the rows become holes. Checksums of 0 are those of no row.
    pub(super) fn give_back(&self, file: &File) {
        percute_system::give_back(file, self.numbers, 8 * self.row * ROWS as u64);
        let _ = write_all_at(file, &[0; 8 * ROWS], self.checksums);
    }
}

fn sum(numbers: &[f64]) -> i64 {
    Checksum::new().numbers(numbers).stored()
}

/// The newest whole checkpoint that `fits`; none if the run was killed before the first one.
pub(super) fn newest(
    ours: &Part<'_>,
    fields @ [nodes, dimension, _]: [usize; 3],
    fits: impl Fn(usize) -> bool,
) -> Result<Option<Checkpoint>, FileCause> {
    let Some(stored) = ours.optional(NUMBERS)? else { return Ok(None) };
    let row = row(fields);
    stored.expect(&[ROWS, row], "step, sums, displacement, half-step velocity and internal variables in each row")?;
    let checksums = ours.data(CHECKSUMS)?;
    checksums.expect(&[ROWS], "one for each row")?;
    let (numbers, checksums) = (stored.floats()?, checksums.integers()?);
    let whole = numbers.chunks_exact(row).zip(checksums).filter(|(numbers, stored)| sum(numbers) == *stored);
    let newest = whole.map(|(numbers, _)| numbers).filter(|numbers| fits(numbers[0] as usize));
    Ok(newest.max_by(|a, b| a[0].total_cmp(&b[0])).map(|numbers| {
        let (displacement, rest) = numbers[HEAD..].split_at(nodes * dimension);
        let (half_step, internal) = rest.split_at(nodes * dimension);
        let mut sums = [0.0; SUMS];
        sums.copy_from_slice(&numbers[1..HEAD]);
        Checkpoint {
            step: numbers[0] as usize,
            displacement: displacement.to_vec(),
            half_step: half_step.to_vec(),
            internal: internal.to_vec(),
            sums,
        }
    }))
}
