//! What percute asks of the operating system beyond the standard library: numbers at a place of a file, room on a disk,
//! whether two names are one file, locks, processes. What a system cannot do is left out here, and nowhere else:
//! without reserved room, a full disk is noticed when it is full.

#[cfg(unix)]
mod unix;
#[cfg(windows)]
mod windows;

#[cfg(unix)]
use unix as system;
#[cfg(windows)]
use windows as system;

use std::fs::{File, FileType, Permissions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::process::Child;

/// Reads bytes from a place of a file.
///
/// # Errors
/// `UnexpectedEof` if the file ends before, and what the system reports.
pub fn read_exact_at(file: &File, bytes: &mut [u8], place: u64) -> io::Result<()> {
    system::read_exact_at(file, bytes, place)
}

/// Writes bytes to a place of a file.
///
/// # Errors
/// What the system reports.
pub fn write_all_at(file: &File, bytes: &[u8], place: u64) -> io::Result<()> {
    system::write_all_at(file, bytes, place)
}

/// Locks a file for this process alone, if no other has a lock on it. Where a lock would keep this process from its own
/// writes and HDF5 from its reads, as on Windows, there is none.
///
/// # Errors
/// A lock of another, or no locks here.
pub fn try_lock(file: &File) -> Result<(), TryLockError> {
    system::try_lock(file)
}

/// Locks a file together with others.
///
/// # Errors
/// As [`try_lock`].
pub fn try_lock_shared(file: &File) -> Result<(), TryLockError> {
    system::try_lock_shared(file)
}

/// Gives a lock back.
pub fn unlock(file: &File) {
    system::unlock(file);
}

/// Whether a file can take the name of one that is open.
pub const REPLACES_OPEN_FILES: bool = cfg!(not(windows));

/// Whether an open file is the one that has this name.
#[must_use]
pub fn is_at(file: &File, path: &Path) -> bool {
    system::is_at(file, path)
}

/// The name that an open file has now, where the system tells.
#[must_use]
pub fn name_of(file: &File) -> Option<PathBuf> {
    system::name_of(file)
}

/// Reserves room for the first bytes of a file, so that a full disk is noticed before they are written. Systems and
/// file systems that cannot reserve room do nothing.
///
/// # Errors
/// No room.
pub fn reserve(file: &File, bytes: u64) -> io::Result<()> {
    system::reserve(file, bytes)
}

/// Gives back the room of bytes in a file, which keeps its length and reads zero there. Systems and file systems
/// without holes keep the room and the bytes.
pub fn give_back(file: &File, place: u64, bytes: u64) {
    system::give_back(file, place, bytes);
}

/// Bytes that a file takes on its disk; a file with holes takes less than its length. Zero where the system does
/// not tell.
#[must_use]
pub fn occupied(file: &File) -> u64 {
    system::occupied(file)
}

/// Bytes available in a folder, where the system tells.
#[must_use]
pub fn free(folder: &Path) -> Option<u64> {
    system::free(folder)
}

/// Permissions of a new file before the mask of the user is taken off; none where they come from the folder.
#[must_use]
pub fn permissions() -> Option<Permissions> {
    system::permissions()
}

/// Whether a file is a pipe with a name.
#[must_use]
pub fn is_pipe(kind: FileType) -> bool {
    system::is_pipe(kind)
}

/// The name of this machine in its network; empty if it has none.
#[must_use]
pub fn machine() -> String {
    system::machine()
}

/// Asks a process to end, so that it can remove its files. A system without such a request ends it at once.
pub fn ask_to_end(child: &mut Child) {
    system::ask_to_end(child);
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{Read, Seek};

    #[test]
    fn bytes_come_back_from_their_place() {
        let mut file = tempfile::tempfile().unwrap();
        write_all_at(&file, b"later", 7).unwrap();
        write_all_at(&file, b"before ", 0).unwrap();
        let mut found = [0; 5];
        read_exact_at(&file, &mut found, 7).unwrap();
        assert_eq!(&found, b"later");
        let beyond = read_exact_at(&file, &mut found, 8).unwrap_err();
        assert_eq!(beyond.kind(), io::ErrorKind::UnexpectedEof);
        file.rewind().unwrap();
        let mut all = String::new();
        file.read_to_string(&mut all).unwrap();
        assert_eq!(all, "before later");
    }

    #[test]
    fn a_file_is_known_after_it_has_moved() {
        let folder = tempfile::tempdir().unwrap();
        let [first, second] = ["a", "b"].map(|name| folder.path().join(name));
        let file = File::create(&first).unwrap();
        assert!(is_at(&file, &first) && !is_at(&file, &second));
        std::fs::rename(&first, &second).unwrap();
        assert!(!is_at(&file, &first) && is_at(&file, &second));
        File::create(&first).unwrap();
        assert!(!is_at(&file, &first));
        if cfg!(target_os = "linux") {
            assert_eq!(name_of(&file), Some(second.canonicalize().unwrap()));
        }
    }

    /// Room that is given back reads zero where there are holes, and the length stays.
    #[test]
    fn room_is_reserved_and_given_back() {
        let file = tempfile::tempfile().unwrap();
        write_all_at(&file, &[7; 20_000], 0).unwrap();
        reserve(&file, 30_000).unwrap();
        let length = file.metadata().unwrap().len();
        assert!(length == 20_000 || length == 30_000);
        give_back(&file, 8192, 8192);
        assert_eq!(file.metadata().unwrap().len(), length);
        let mut found = [1; 20_000];
        read_exact_at(&file, &mut found, 0).unwrap();
        assert!(found[..8192].iter().chain(&found[16384..]).all(|&byte| byte == 7));
        assert!([0, 7].contains(&found[8192]) && found[8192..16384].iter().all(|&byte| byte == found[8192]));
    }

    #[test]
    fn the_system_tells_of_itself() {
        let folder = tempfile::tempdir().unwrap();
        if cfg!(unix) {
            assert!(free(folder.path()).is_some_and(|bytes| bytes > 0));
            assert!(permissions().is_some() && !machine().is_empty());
        }
        assert!(!is_pipe(folder.path().metadata().unwrap().file_type()));
    }
}
