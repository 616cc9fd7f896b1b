//! The folder of a case. It appears complete: an attempt has a folder of its own, which takes the name of the case at
//! its end.

use crate::plan::Planned;
use percute_system::try_lock;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

/// Its files: the case, the document of its run, warnings of a run that is done, and the reason of one that failed.
pub(crate) const CASE: &str = "case.toml";
pub(crate) const RESULT: &str = "result.json";
const WARNINGS: &str = "warnings.txt";
pub(crate) const FAILURE: &str = "failure.txt";

/// Start of the names of attempts on this machine: the locks of others may not be seen here.
fn prefix() -> String {
    format!(".attempt-{}-", percute_system::machine())
}

/// Locked as long as its process lives.
const LOCK: &str = ".lock";

/// What is known of a case.
#[derive(Clone, Debug, PartialEq)]
pub enum State {
    /// It has not been run, or with another text or version.
    Open,
    /// Its run failed, for this reason.
    Failed(String),
    /// It is done, with this document.
    Done(Box<serde_json::Value>),
}

impl State {
    /// Its name in the table.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Open => "open",
            Self::Failed(_) => "failed",
            Self::Done(_) => "done",
        }
    }
}

/// The state of a case of the sweep in `folder`.
pub(crate) fn state(folder: &Path, case: &Planned) -> State {
    let folder = folder.join(&case.name);
    if fs::read_to_string(folder.join(CASE)).ok().as_deref() != Some(&case.text) {
        return State::Open;
    }
    if let Ok(reason) = fs::read_to_string(folder.join(FAILURE)) {
        return State::Failed(reason.trim().to_string());
    }
    let document = fs::read(folder.join(RESULT)).ok().and_then(|bytes| serde_json::from_slice(&bytes).ok());
    let document =
        document.filter(|found: &serde_json::Value| found["versions"]["percute"] == env!("CARGO_PKG_VERSION"));
    document.map_or(State::Open, |document| State::Done(Box::new(document)))
}

/// A case that is being run.
#[derive(Debug)]
pub(crate) struct Attempt {
    folder: PathBuf,
    place: PathBuf,
    /// Held open for its lock.
    lock: File,
}

impl Attempt {
    /// Makes the folder of an attempt, with the case in it.
    pub(crate) fn begin(all: &Path, case: &Planned) -> io::Result<Self> {
        fs::create_dir_all(all)?;
        let folder = all.join(format!("{}{}-{}", prefix(), std::process::id(), case.name));
        if folder.exists() {
            fs::remove_dir_all(&folder)?;
        }
        fs::create_dir(&folder)?;
        let lock = File::create(folder.join(LOCK))?;
        // File systems without locks go without: the folder of a killed run stays.
        let _ = try_lock(&lock);
        fs::write(folder.join(CASE), &case.text)?;
        Ok(Self { folder, place: all.join(&case.name), lock })
    }

    pub(crate) fn folder(&self) -> &Path {
        &self.folder
    }

    /// The files for standard output and standard error.
    pub(crate) fn streams(&self) -> io::Result<[File; 2]> {
        Ok([File::create(self.folder.join(RESULT))?, File::create(self.folder.join(WARNINGS))?])
    }

    /// Gives the folder the name of the case, in place of an older one; with the reason if the run failed.
    pub(crate) fn finish(self, failure: Option<&str>) -> io::Result<()> {
        let Self { folder, place, lock } = self;
        let warnings = folder.join(WARNINGS);
        if let Some(reason) = failure {
            fs::write(folder.join(FAILURE), format!("{}\n", reason.trim()))?;
            fs::remove_file(folder.join(RESULT))?;
            fs::remove_file(warnings)?;
        } else if warnings.metadata()?.len() == 0 {
            fs::remove_file(warnings)?;
        }
        fs::remove_file(folder.join(LOCK))?;
        // A folder with an open file cannot be renamed on every system.
        drop(lock);
        match fs::remove_dir_all(&place) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
            _ => fs::rename(folder, place),
        }
    }

    /// The text on standard error.
    pub(crate) fn said(&self) -> String {
        fs::read(self.folder.join(WARNINGS))
            .map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
            .unwrap_or_default()
    }

    /// Removes what was done.
    pub(crate) fn give_up(self) {
        // One that cannot be removed stays, under a name that no case has.
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// Removes attempts on this machine whose process has ended.
pub(crate) fn clean(folder: &Path) {
    let prefix = prefix();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if entry.file_name().to_string_lossy().starts_with(&prefix) {
            let ended = File::open(entry.path().join(LOCK)).is_ok_and(|lock| try_lock(&lock).is_ok());
            if ended {
                let _ = fs::remove_dir_all(entry.path());
            }
        }
    }
}
