//! New files: written completely under another name, and then renamed. Their room can be reserved.

use crate::driver::{Driven, DriverFault};
use crate::error::{FileCause, FileError};
use crate::library::{alone, refused};
use crate::lock::LockedFile;
use crate::temporary::{probe, temporary};
use crate::unfinished::Unfinished;
use crate::write::Texts;
use hdf5::file::{FileAccess, FileCreate, LibraryVersion};
use percute_system::{REPLACES_OPEN_FILES, free};
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// The treatment of an existing file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Overwrite {
    /// An existing file is an error.
    #[default]
    Refuse,
    /// The new file replaces the old one once its space is reserved. Readers of the old file
    /// keep it. A file that is being written is not replaced.
    Replace,
}

impl Overwrite {
    /// Replaces the file if this is allowed.
    #[must_use]
    pub fn allowed(replace: bool) -> Self {
        if replace { Self::Replace } else { Self::Refuse }
    }
}

/// A file without its final name.
#[derive(Debug)]
pub(crate) struct Unnamed {
    temporary: NamedTempFile,
    /// Removed if the process ends early.
    unfinished: Unfinished,
    path: PathBuf,
    /// Lock on the file to be replaced.
    old: Option<LockedFile>,
    overwrite: Overwrite,
}

impl Unnamed {
    /// Creates an HDF5 file; `fill` creates its contents, and `bytes` is the room that it will take.
    pub(crate) fn new<T>(
        path: &Path,
        overwrite: Overwrite,
        bytes: u64,
        fill: impl FnOnce(&hdf5::File, &mut Texts) -> Result<T, FileCause>,
    ) -> Result<(Self, T), FileCause> {
        let (path, old) = destination(path, overwrite)?;
        let folder = folder_of(&path);
        let (temporary, unfinished) = temporary(folder).map_err(|error| no_room(error, folder, bytes))?;
        // A full disk is detected here in most cases, before the first write.
        if let Some(free) = free(folder).filter(|free| *free < bytes) {
            return Err(FileCause::NoSpace { needed: bytes, free });
        }
        let mut texts = Texts::default();
        let made = make(temporary.as_file(), |file| fill(file, &mut texts));
        let made = made.map_err(|cause| match (cause, free(folder)) {
            (_, Some(free)) if free < bytes => FileCause::NoSpace { needed: bytes, free },
            (FileCause::Create { source }, _) => no_room(source, folder, bytes),
            (cause, _) => cause,
        })?;
        texts.put(temporary.as_file()).map_err(|error| no_room(error, folder, bytes))?;
        Ok((Self { temporary, unfinished, path, old, overwrite }, made))
    }

    /// Reserves the room of the whole file, also where it has holes.
    pub(crate) fn reserve(&self) -> Result<(), FileCause> {
        let length = self.file().metadata().map_err(|source| FileCause::Create { source })?.len();
        reserve(self.file(), &self.path, length)
    }

    /// A write that failed.
    pub(crate) fn unwritten(&self, source: io::Error) -> FileCause {
        no_room(source, folder_of(&self.path), self.file().metadata().map_or(0, |found| found.len()))
    }

    /// Waits until the file is on its disk.
    pub(crate) fn sync(&self) -> Result<(), FileCause> {
        self.file().sync_all().map_err(|source| self.unwritten(source))
    }

    /// The file, for further writes.
    pub(crate) fn file(&self) -> &File {
        self.temporary.as_file()
    }

    /// Its final path.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Its path until then.
    pub(crate) fn temporary(&self) -> &Path {
        self.temporary.path()
    }

    /// Gives the file its name. It is locked against writers from then on.
    pub(crate) fn put(self) -> Result<LockedFile, FileCause> {
        let Self { mut temporary, unfinished: _unfinished, path, mut old, overwrite } = self;
        let own = temporary.as_file().try_clone().map_err(|source| FileCause::Create { source })?;
        let lock = LockedFile::shared(own)?;
        loop {
            // A file is replaced only by the one that holds the lock on it: of two runs that begin together, one is
            // refused.
            let replaced = old.as_ref().is_some_and(|old| old.is_at(&path));
            if !REPLACES_OPEN_FILES {
                drop(old.take());
            }
            let put = match replaced {
                true => temporary.persist(&path),
                false => temporary.persist_noclobber(&path),
            };
            match put {
                Ok(_) => return Ok(lock),
                Err(refused) if refused.error.kind() == io::ErrorKind::AlreadyExists => {
                    temporary = refused.file;
                    old = destination(&path, overwrite)?.1;
                }
                Err(refused) => return Err(FileCause::Create { source: refused.error }),
            }
        }
    }
}

/// Creates a file of these bytes, such as a picture, completely or not at all.
///
/// # Errors
/// A file that exists and may not be replaced, one that is being written, no room, whatever the system reports.
pub fn write_bytes(path: impl AsRef<Path>, overwrite: Overwrite, bytes: &[u8]) -> Result<(), FileError> {
    let path = path.as_ref();
    whole(path, overwrite, bytes).map_err(|cause| cause.at(path))
}

/// The same, inside this crate.
pub(crate) fn whole(path: &Path, overwrite: Overwrite, bytes: &[u8]) -> Result<(), FileCause> {
    let (path, old) = destination(path, overwrite)?;
    let (folder, length) = (folder_of(&path), bytes.len() as u64);
    let (mut temporary, unfinished) = temporary(folder).map_err(|error| no_room(error, folder, length))?;
    temporary.write_all(bytes).map_err(|error| no_room(error, folder, length))?;
    Unnamed { temporary, unfinished, path, old, overwrite }.put().map(|_| ())
}

/// Reserves the room of a file of this length, also where it has holes; `path` is its name.
pub(crate) fn reserve(file: &File, path: &Path, bytes: u64) -> Result<(), FileCause> {
    percute_system::reserve(file, bytes.max(1)).map_err(|error| no_room(error, folder_of(path), bytes))
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|f| !f.as_os_str().is_empty()).unwrap_or_else(|| Path::new("."))
}

/// Makes sure that files can be created in the folder of one that is not there. The name is left alone: another run may
/// be creating it.
///
/// # Errors
/// Whatever the system reports.
pub fn check_folder(path: &Path) -> io::Result<()> {
    probe(folder_of(path))
}

/// Creates the contents of an empty file and closes it.
fn make<T>(file: &File, fill: impl FnOnce(&hdf5::File) -> Result<T, FileCause>) -> Result<T, FileCause> {
    let _alone = alone();
    // VTK loses arrays of later formats. Arrays are aligned so that they can be mapped into memory.
    let access = FileAccess::build().libver_bounds(LibraryVersion::V18, LibraryVersion::V110).alignment(1, 8).finish();
    let creation = FileCreate::build().obj_track_times(false).finish();
    let (access, creation) = access.and_then(|access| Ok((access, creation?))).map_err(|error| refused(&error))?;
    let driven = Driven::create(file, &access, &creation).map_err(DriverFault::of_creation)?;
    let made = fill(driven.file());
    driven.close(made, DriverFault::of_creation)
}

/// The path of the file, and the lock on the file to be replaced.
fn destination(path: &Path, overwrite: Overwrite) -> Result<(PathBuf, Option<LockedFile>), FileCause> {
    let Ok(found) = path.symlink_metadata() else { return Ok((path.to_path_buf(), None)) };
    if overwrite == Overwrite::Refuse {
        return Err(FileCause::Exists);
    }
    // A link keeps its place; its target is replaced.
    let path = if found.is_symlink() { path.canonicalize() } else { Ok(path.to_path_buf()) };
    let path = path.map_err(|source| FileCause::Create { source })?;
    if !path.is_file() {
        return Err(FileCause::NotAFile);
    }
    let old = File::open(&path).map_err(|source| FileCause::Create { source })?;
    // Nobody writes it; others may read it until it is replaced.
    Ok((path, Some(LockedFile::alone(old)?.share()?)))
}

fn no_room(source: io::Error, folder: &Path, needed: u64) -> FileCause {
    match source.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => match free(folder) {
            // Of a quota, the system does not tell how much is left.
            Some(free) if free >= needed => FileCause::Create { source },
            free => FileCause::NoSpace { needed, free: free.unwrap_or(0) },
        },
        io::ErrorKind::FileTooLarge => FileCause::Limit { needed },
        _ => FileCause::Create { source },
    }
}
