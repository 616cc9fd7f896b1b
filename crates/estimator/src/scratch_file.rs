//! Numbers that wait in a temporary file.

use percute_system::{read_exact_at, write_all_at};
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Numbers that are written or read at once, by a copy of this length.
const PIECE: usize = 4096;

/// Why numbers could not wait in a file.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error(
    "a temporary file of {bytes} bytes in {} failed: {cause}. It holds the motion of contact nodes, and the elements \
     around them, until the next contact is known. Set TMPDIR to a folder that exists, can be written and has space, \
     or sample fewer steps with `every`",
    folder.display()
)]
pub struct ScratchError {
    /// Its folder.
    pub folder: PathBuf,
    /// Bytes that the file had or was to have.
    pub bytes: u64,
    /// What the system says.
    pub cause: String,
}

/// A file without a name, which exists from its first number on and vanishes with the process.
#[derive(Debug, Default)]
pub(crate) struct ScratchFile {
    file: Option<File>,
    bytes: Vec<u8>,
    /// Where it is made instead, for tests.
    folder: Option<PathBuf>,
}

/// The folder of temporary files: that of `TMPDIR`. Without one it is `/var/tmp`, which is on a disk, while `/tmp` may
/// be memory.
fn folder() -> PathBuf {
    let lasting = Path::new("/var/tmp");
    match std::env::var_os("TMPDIR").filter(|folder| !folder.is_empty()) {
        Some(folder) => folder.into(),
        None if lasting.is_dir() => lasting.to_path_buf(),
        None => std::env::temp_dir(),
    }
}

impl ScratchFile {
    /// Whether a file can be made.
    ///
    /// # Errors
    /// The folder does not exist or cannot be written.
    pub(crate) fn check() -> Result<(), ScratchError> {
        let file = Self::default();
        tempfile::tempfile_in(folder()).map(|_| ()).map_err(|cause| file.failure(0, &cause))
    }

    /// One that is made in this folder.
    #[cfg(test)]
    pub(crate) fn within(folder: PathBuf) -> Self {
        Self { folder: Some(folder), ..Self::default() }
    }

    /// Whether there has been a number.
    #[cfg(test)]
    pub(crate) fn is_used(&self) -> bool {
        self.file.is_some()
    }

    /// Writes numbers, the first in this place.
    ///
    /// # Errors
    /// No file can be made, or no space is left.
    pub(crate) fn write(&mut self, place: u64, numbers: &[f64]) -> Result<(), ScratchError> {
        let end = offset(place + numbers.len() as u64);
        self.try_write(place, numbers).map_err(|cause| self.failure(end, &cause))
    }

    fn try_write(&mut self, place: u64, numbers: &[f64]) -> io::Result<()> {
        let file = match &self.file {
            Some(file) => file,
            None => self.file.insert(tempfile::tempfile_in(self.folder.clone().unwrap_or_else(folder))?),
        };
        for (k, piece) in numbers.chunks(PIECE).enumerate() {
            self.bytes.clear();
            self.bytes.extend(piece.iter().flat_map(|number| number.to_ne_bytes()));
            write_all_at(file, &self.bytes, offset(place + (k * PIECE) as u64))?;
        }
        Ok(())
    }

    /// Reads numbers, the first in this place.
    ///
    /// # Errors
    /// The file cannot be read.
    pub(crate) fn read(&mut self, place: u64, numbers: &mut [f64]) -> Result<(), ScratchError> {
        let end = offset(place + numbers.len() as u64);
        self.try_read(place, numbers).map_err(|cause| self.failure(end, &cause))
    }

    fn try_read(&mut self, place: u64, numbers: &mut [f64]) -> io::Result<()> {
        let file = self.file.as_ref().ok_or(io::ErrorKind::NotFound)?;
        for (k, piece) in numbers.chunks_mut(PIECE).enumerate() {
            self.bytes.resize(size_of_val(piece), 0);
            read_exact_at(file, &mut self.bytes, offset(place + (k * PIECE) as u64))?;
            for (number, bytes) in piece.iter_mut().zip(self.bytes.as_chunks().0) {
                *number = f64::from_ne_bytes(*bytes);
            }
        }
        Ok(())
    }

    fn failure(&self, bytes: u64, cause: &io::Error) -> ScratchError {
        let folder = self.folder.clone().unwrap_or_else(folder);
        ScratchError { folder, bytes, cause: cause.to_string() }
    }
}

/// The place of a number in bytes.
fn offset(place: u64) -> u64 {
    place * size_of::<f64>() as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back() {
        let mut file = ScratchFile::default();
        let numbers: Vec<f64> = (0..3 * PIECE + 5).map(|k| (k as f64).sqrt()).collect();
        assert!(!file.is_used());
        file.write(7, &numbers).unwrap();
        let mut found = vec![0.0; PIECE + 1];
        file.read(7 + 100, &mut found).unwrap();
        assert_eq!(found, numbers[100..][..PIECE + 1]);
        assert!(file.is_used() && file.read(7 + numbers.len() as u64, &mut found).is_err());
    }

    #[test]
    fn a_file_that_cannot_be_made_says_where_and_what_helps() {
        let error = ScratchFile::within("/no/such/folder".into()).write(1000, &[0.0; 24]).unwrap_err();
        assert_eq!((error.bytes, error.folder.as_path()), (8192, Path::new("/no/such/folder")));
        let message = error.to_string();
        for part in ["8192 bytes", "/no/such/folder", "TMPDIR", "`every`"] {
            assert!(message.contains(part), "{message}");
        }
    }
}
