//! Linux and macOS.

use rustix::fs::fstatvfs;
use rustix::process::{Pid, Signal, kill_process};
use std::fs::{File, FileType, Permissions, TryLockError};
use std::io;
use std::os::unix::fs::{FileExt, FileTypeExt, MetadataExt, PermissionsExt};
use std::path::{Path, PathBuf};
use std::process::Child;

pub(super) fn read_exact_at(file: &File, bytes: &mut [u8], place: u64) -> io::Result<()> {
    file.read_exact_at(bytes, place)
}

pub(super) fn write_all_at(file: &File, bytes: &[u8], place: u64) -> io::Result<()> {
    file.write_all_at(bytes, place)
}

pub(super) fn try_lock(file: &File) -> Result<(), TryLockError> {
    file.try_lock()
}

pub(super) fn try_lock_shared(file: &File) -> Result<(), TryLockError> {
    file.try_lock_shared()
}

pub(super) fn unlock(file: &File) {
    let _ = file.unlock();
}

pub(super) fn is_at(file: &File, path: &Path) -> bool {
    let (Ok(mine), Ok(there)) = (file.metadata(), path.metadata()) else { return false };
    (mine.dev(), mine.ino()) == (there.dev(), there.ino())
}

#[cfg(target_os = "linux")]
pub(super) fn name_of(file: &File) -> Option<PathBuf> {
    use std::os::fd::AsRawFd;
    std::fs::read_link(format!("/proc/self/fd/{}", file.as_raw_fd())).ok()
}

#[cfg(target_os = "linux")]
pub(super) fn reserve(file: &File, bytes: u64) -> io::Result<()> {
    use rustix::fs::{FallocateFlags, fallocate};
    use rustix::io::Errno;
    match fallocate(file, FallocateFlags::empty(), 0, bytes) {
        Ok(()) | Err(Errno::OPNOTSUPP | Errno::NOSYS) => Ok(()),
        Err(error) => Err(error.into()),
    }
}

#[cfg(target_os = "linux")]
pub(super) fn give_back(file: &File, place: u64, bytes: u64) {
    use rustix::fs::{FallocateFlags, fallocate};
    let _ = fallocate(file, FallocateFlags::PUNCH_HOLE | FallocateFlags::KEEP_SIZE, place, bytes);
}

#[cfg(not(target_os = "linux"))]
pub(super) fn name_of(_: &File) -> Option<PathBuf> {
    None
}

#[cfg(not(target_os = "linux"))]
pub(super) fn reserve(_: &File, _: u64) -> io::Result<()> {
    Ok(())
}

#[cfg(not(target_os = "linux"))]
pub(super) fn give_back(_: &File, _: u64, _: u64) {}

pub(super) fn occupied(file: &File) -> u64 {
    /// The unit of `blocks`, whatever the blocks of the disk are.
    const UNIT: u64 = 512;
    file.metadata().map_or(0, |found| UNIT * found.blocks())
}

pub(super) fn free(folder: &Path) -> Option<u64> {
    let status = fstatvfs(File::open(folder).ok()?).ok()?;
    status.f_bavail.checked_mul(status.f_frsize)
}

#[expect(clippy::unnecessary_wraps, reason = "other systems have none")]
pub(super) fn permissions() -> Option<Permissions> {
    Some(Permissions::from_mode(0o666))
}

pub(super) fn is_pipe(kind: FileType) -> bool {
    kind.is_fifo()
}

pub(super) fn machine() -> String {
    rustix::system::uname().nodename().to_string_lossy().into_owned()
}

pub(super) fn ask_to_end(child: &mut Child) {
    let _ = kill_process(Pid::from_child(child), Signal::TERM);
}
