//! The first bytes of an HDF5 file.

use percute_system::read_exact_at;
use std::fs::File;
use std::io;
use std::path::Path;

const SIGNATURE: [u8; 8] = *b"\x89HDF\r\n\x1a\n";

/// Whether a file is HDF5, by its first bytes. Only regular files are read.
///
/// # Errors
/// A file that is missing or cannot be read.
pub fn is_hdf5(path: &Path) -> io::Result<bool> {
    if path.metadata()?.is_file() { begins_as_hdf5(&File::open(path)?) } else { Ok(false) }
}

/// HDF5 allows a user block before the signature; histories have none.
pub(super) fn begins_as_hdf5(file: &File) -> io::Result<bool> {
    let mut first = [0; 8];
    match read_exact_at(file, &mut first, 0) {
        Err(error) if error.kind() != io::ErrorKind::UnexpectedEof => Err(error),
        _ => Ok(first == SIGNATURE),
    }
}

/// Whether the file is a part of several that a driver of the library puts together. The library takes as much memory
/// as the record of the driver says.
pub(super) fn names_driver(file: &File, bytes: u64) -> io::Result<bool> {
    let mut first = [0; 24];
    if bytes < first.len() as u64 {
        return Ok(false);
    }
    read_exact_at(file, &mut first, 0)?;
    // The record is the last of four places, and its own place is all ones if there is none.
    let start = match first[8] {
        0 => 24,
        1 => 28,
        _ => return Ok(false),
    };
    let size = usize::from(first[13]);
    let mut place = vec![0; size];
    match read_exact_at(file, &mut place, start + 3 * size as u64) {
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => Ok(false),
        Err(error) => Err(error),
        Ok(()) => Ok(place.iter().any(|&byte| byte != u8::MAX)),
    }
}

/// The size of a length in the file.
pub(super) fn size_of_lengths(file: &File) -> io::Result<u8> {
    let mut superblock = [0; 16];
    read_exact_at(file, &mut superblock, 0)?;
    Ok(if superblock[8] < 2 { superblock[14] } else { superblock[10] })
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_system::write_all_at;

    #[test]
    fn a_driver_has_a_place_that_is_not_all_ones() {
        let folder = tempfile::tempdir().unwrap();
        let _alone = crate::library::alone();
        let path = folder.path().join("a.h5");
        let mut options = hdf5::File::with_options();
        options.with_fapl(|p| p.libver_earliest()).create(&path).unwrap().close().unwrap();
        let file = File::options().read(true).write(true).open(&path).unwrap();
        let bytes = file.metadata().unwrap().len();
        assert!(!names_driver(&file, bytes).unwrap());
        write_all_at(&file, &[0], 55).unwrap();
        assert!(names_driver(&file, bytes).unwrap());
        assert!(crate::is_hdf5(&path).unwrap());
        // Newer superblocks have none.
        write_all_at(&file, &[2], 8).unwrap();
        assert!(!names_driver(&file, bytes).unwrap());
        // A place behind the end is left to the library.
        write_all_at(&file, &[0], 8).unwrap();
        file.set_len(50).unwrap();
        assert!(!names_driver(&file, 50).unwrap());
    }
}
