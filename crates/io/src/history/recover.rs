//! Completes the file of a run that was killed.

use super::checkpoints::places;
use super::file::NativeArray;
use super::open::open;
use crate::driver::Driven;
use crate::error::{FileCause, FileError};
use crate::library::{alone, detail};
use crate::lock::LockedFile;
use crate::steps::{give_steps, note_steps};
use percute_system::give_back;
use std::fs::File;
use std::path::Path;

/// The state of a file before recovery.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Recovered {
    /// Complete instants in it.
    pub count: usize,
    /// Whether it was already complete.
    pub was_complete: bool,
}

/// Completes a history whose run was killed: VTK then reads all its complete steps. The room of steps that were never
/// written is given back.
///
/// # Errors
/// A file that is not a history, is truncated, has no step, is still being written, or cannot be written to.
pub fn recover(path: impl AsRef<Path>) -> Result<Recovered, FileError> {
    let path = path.as_ref();
    let found = open(path)?;
    let (count, was_complete) = (found.count(), found.is_complete());
    let planned = found.times().instants().len();
    let recovered = Recovered { count, was_complete };
    if recovered.was_complete {
        return Ok(recovered);
    }
    // Read before the lock, which keeps readers out.
    let arrays = found.arrays()?;
    let checkpoints = found.again(|opened| places(&opened.root().group("percute")?))?;
    let finish = || {
        let file = File::options().read(true).write(true).open(path);
        let file = file.map_err(|error| FileCause::Finish { detail: error.to_string(), steps: recovered.count })?;
        // A running writer holds a lock on the file.
        let lock = LockedFile::alone(file)?;
        if count == 0 {
            return Err(FileCause::NoStep);
        }
        let failed = |detail: String| FileCause::Finish { detail, steps: recovered.count };
        set_steps(lock.file(), recovered.count).map_err(failed)?;
        give_back_room(lock.file(), arrays.iter().filter_map(room), planned, count);
        if let Some(checkpoints) = checkpoints.filter(|_| count == planned) {
            checkpoints.give_back(lock.file());
        }
        set_complete(lock.file()).map_err(failed)?;
        lock.file().sync_all().map_err(|error| failed(error.to_string()))
    };
    finish().map_err(|cause| cause.at(path))?;
    Ok(recovered)
}

/// Makes a number of instants visible to VTK, which needs at least one. Two writes leave the first instant
/// visible if the process is killed between them.
pub(super) fn set_steps(file: &File, count: usize) -> Result<(), String> {
    change(file, |file| {
        let times = file.dataset("percute/times")?.read_raw::<f64>()?;
        give_steps(&file.group("VTKHDF")?, times.get(..count.max(1)).unwrap_or(&times))
    })?;
    change(file, |file| note_steps(&file.group("VTKHDF")?, count.max(1)))
}

/// Gives back the room of steps that were never written. `rooms` are the places of step 0 and the sizes of a step
/// (bytes); of the `planned` instants, `count` were written. The file keeps its length, and has holes there.
pub(super) fn give_back_room(file: &File, rooms: impl IntoIterator<Item = (u64, u64)>, planned: usize, count: usize) {
    let unwritten = planned.saturating_sub(count) as u64;
    for (place, row) in rooms.into_iter().filter(|(_, row)| row * unwritten > 0) {
        give_back(file, place + row * count as u64, row * unwritten);
    }
}

/// The room of an array, if it is as percute writes it.
fn room(NativeArray { name, shape, offset }: &NativeArray) -> Option<(u64, u64)> {
    let width = if *name == "touching" { 1 } else { 8 };
    Some(((*offset)?, width * shape[1..].iter().product::<usize>() as u64))
}

fn set_complete(file: &File) -> Result<(), String> {
    change(file, |file| file.dataset("percute/complete")?.write_scalar(&1_u8))
}

/// Changes a file. A concurrent reader may have it open, and only the part visible to VTK changes.
fn change(file: &File, make: impl FnOnce(&hdf5::File) -> hdf5::Result<()>) -> Result<(), String> {
    let _alone = alone();
    let driven = Driven::change(file).map_err(|fault| fault.text())?;
    let made = make(driven.file()).map_err(|error| detail(&error));
    driven.close(made, |fault| fault.text())
}
