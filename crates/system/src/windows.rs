//! Windows.

use same_file::Handle;
use std::fs::{File, FileType, Permissions, TryLockError};
use std::io;
use std::os::windows::fs::FileExt;
use std::path::{Path, PathBuf};
use std::process::Child;

pub(super) fn read_exact_at(file: &File, mut bytes: &mut [u8], mut place: u64) -> io::Result<()> {
    while !bytes.is_empty() {
        match file.seek_read(bytes, place)? {
            0 => return Err(io::ErrorKind::UnexpectedEof.into()),
            done => (bytes, place) = (&mut bytes[done..], place + done as u64),
        }
    }
    Ok(())
}

pub(super) fn write_all_at(file: &File, mut bytes: &[u8], mut place: u64) -> io::Result<()> {
    while !bytes.is_empty() {
        match file.seek_write(bytes, place)? {
            0 => return Err(io::ErrorKind::WriteZero.into()),
            done => (bytes, place) = (&bytes[done..], place + done as u64),
        }
    }
    Ok(())
}

/// A lock of the standard library is one on all bytes here, which no handle may then write, its own included.
pub(super) fn try_lock(_: &File) -> Result<(), TryLockError> {
    Err(TryLockError::Error(io::ErrorKind::Unsupported.into()))
}

pub(super) fn try_lock_shared(file: &File) -> Result<(), TryLockError> {
    try_lock(file)
}

pub(super) fn unlock(_: &File) {}

pub(super) fn is_at(file: &File, path: &Path) -> bool {
    let mine = file.try_clone().and_then(Handle::from_file);
    mine.is_ok_and(|mine| Handle::from_path(path).is_ok_and(|there| mine == there))
}

pub(super) fn name_of(_: &File) -> Option<PathBuf> {
    None
}

pub(super) fn reserve(_: &File, _: u64) -> io::Result<()> {
    Ok(())
}

pub(super) fn give_back(_: &File, _: u64, _: u64) {}

pub(super) fn occupied(_: &File) -> u64 {
    0
}

pub(super) fn free(_: &Path) -> Option<u64> {
    None
}

pub(super) fn permissions() -> Option<Permissions> {
    None
}

pub(super) fn is_pipe(_: FileType) -> bool {
    false
}

pub(super) fn machine() -> String {
    std::env::var("COMPUTERNAME").unwrap_or_default()
}

pub(super) fn ask_to_end(child: &mut Child) {
    let _ = child.kill();
}
