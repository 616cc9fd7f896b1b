//! Whether a file can be written, asked before any work is done for it.

use percute_io::check_folder;
use std::fs::OpenOptions;
use std::io::{Error, ErrorKind, Result};
use std::path::{Path, PathBuf};

/// Makes sure that a file can be made or replaced. What is there is left as it is.
///
/// # Errors
/// A folder that is not there, something else than a file, whatever the system reports.
pub fn check(file: &Path) -> Result<()> {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.exists() {
        let folder = folder.display();
        let message = format!("there is no folder {folder}; create it first, or give another name");
        return Err(Error::new(ErrorKind::NotFound, message));
    }
    // Not the target of a link: a link to nothing must not be taken for a new file.
    match std::fs::symlink_metadata(file) {
        // Appending nothing changes nothing.
        Ok(found) if found.is_symlink() && file.is_file() || found.is_file() => {
            OpenOptions::new().append(true).open(file).map(drop)
        }
        Ok(_) => Err(Error::other("it is not a regular file")),
        Err(error) if error.kind() == ErrorKind::NotFound => check_folder(file),
        Err(error) => Err(error),
    }
}

/// Whether two paths name one file, be it there or not.
#[must_use]
pub fn same(a: &Path, b: &Path) -> bool {
    matches!((identity(a), identity(b)), (Some(a), Some(b)) if a == b)
}

fn identity(file: &Path) -> Option<PathBuf> {
    if let Ok(there) = file.canonicalize() {
        return Some(there);
    }
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    Some(folder.canonicalize().ok()?.join(file.file_name()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_file_by_several_names() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str| folder.path().join(name);
        assert!(same(&file("a"), &file("./a")) && !same(&file("a"), &file("b")));
        std::fs::write(file("a"), "").unwrap();
        std::os::unix::fs::symlink(file("a"), file("link")).unwrap();
        assert!(same(&file("a"), &file("link")));
        assert!(!same(&file("none/a"), &file("none/a")), "nothing can be said of a folder that is not there");
    }
}
