//! The folder of a case. It appears complete: an attempt has a folder of its own, which takes the name of the case at
//! its end.

use crate::plan::Planned;
use percute_system::try_lock;
use percute_workflow::Failure;
use percute_workflow::report::FORMAT;
use std::collections::BTreeSet;
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

/// Start of the names of the files that are locked as long as the processes of attempts live.
fn lock_prefix() -> String {
    format!(".lock-{}-", percute_system::machine())
}

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

/// Refuses to lose results: those of another text or version, and folders of the name of a case that hold none. What
/// is done stays, and a failure is tried again.
///
/// # Errors
/// [`Failure::Results`].
pub fn keep_results<'c>(folder: &Path, cases: impl IntoIterator<Item = &'c Planned>) -> Result<(), Failure> {
    let is_lost = |case: &&Planned| {
        let place = folder.join(&case.name);
        let others =
            || !place.join(CASE).exists() && fs::read_dir(&place).is_ok_and(|mut files| files.next().is_some());
        state(folder, case) == State::Open && (place.join(RESULT).exists() || others())
    };
    let cases: Vec<String> = cases.into_iter().filter(is_lost).map(|case| case.name.clone()).collect();
    if cases.is_empty() { Ok(()) } else { Err(Failure::Results { folder: folder.to_path_buf(), cases }) }
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
    let document = document.filter(|found: &serde_json::Value| {
        found["versions"]["percute"] == env!("CARGO_PKG_VERSION") && found["format"] == FORMAT
    });
    document.map_or(State::Open, |document| State::Done(Box::new(document)))
}

/// A case that is being run.
#[derive(Debug)]
pub(crate) struct Attempt {
    folder: PathBuf,
    place: PathBuf,
    lock: Lock,
}

/// A lock file, held open for its lock. It is there before the folder and after it: a folder without one is of a
/// process that has ended.
#[derive(Debug)]
struct Lock {
    path: PathBuf,
    file: File,
}

impl Lock {
    /// Locks a file. File systems without locks go without: the folder of a killed run stays.
    fn at(path: PathBuf) -> io::Result<Self> {
        loop {
            let file = File::create(&path)?;
            let _ = try_lock(&file);
            // Another sweep may have taken it for one that was left, before it was locked.
            if path.exists() {
                return Ok(Self { path, file });
            }
        }
    }

    fn remove(self) {
        let Self { path, file } = self;
        // Not every system removes an open file. One that cannot be removed is removed by the next sweep.
        drop(file);
        let _ = fs::remove_file(path);
    }
}

impl Attempt {
    /// Makes the folder of an attempt, with the case in it.
    pub(crate) fn begin(all: &Path, case: &Planned) -> io::Result<Self> {
        fs::create_dir_all(all)?;
        let name = format!("{}-{}", std::process::id(), case.name);
        let folder = all.join(prefix() + &name);
        let lock = Lock::at(all.join(lock_prefix() + &name))?;
        if folder.exists() {
            fs::remove_dir_all(&folder)?;
        }
        fs::create_dir(&folder)?;
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
        match fs::remove_dir_all(&place) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            _ => fs::rename(folder, place)?,
        }
        lock.remove();
        Ok(())
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
        self.lock.remove();
    }
}

/// Removes attempts on this machine whose process has ended.
pub(crate) fn clean(folder: &Path) {
    let [attempt, locked] = [prefix(), lock_prefix()];
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let name = |entry: fs::DirEntry| {
        let name = entry.file_name().to_string_lossy().into_owned();
        name.strip_prefix(&attempt).or(name.strip_prefix(&locked)).map(str::to_string)
    };
    for name in entries.filter_map(name).collect::<BTreeSet<_>>() {
        let (attempt, path) = (folder.join(attempt.clone() + &name), folder.join(locked.clone() + &name));
        match File::open(&path) {
            Ok(file) if try_lock(&file).is_ok() => {
                let _ = fs::remove_dir_all(attempt);
                Lock { path, file }.remove();
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                let _ = fs::remove_dir_all(attempt);
            }
            // Its process runs.
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A process may end between any two of its steps: lock, folder, name of the case, end of the lock.
    #[test]
    fn attempts_of_ended_processes_are_removed_and_running_ones_stay() {
        let all = tempfile::tempdir().unwrap();
        let case = |name: &str| Planned { name: name.to_string(), text: String::new() };
        let running = Attempt::begin(all.path(), &case("runs")).unwrap();
        let ended = [prefix() + "1-no lock", prefix() + "1-both"].map(|name| all.path().join(name));
        ended.iter().for_each(|folder| fs::create_dir(folder).unwrap());
        for name in ["1-both", "1-no folder"] {
            fs::write(all.path().join(lock_prefix() + name), "").unwrap();
        }
        clean(all.path());
        let left = || fs::read_dir(all.path()).unwrap().count();
        assert!(running.folder().join(CASE).exists());
        assert_eq!(left(), 2, "its folder and its lock");
        running.give_up();
        assert_eq!(left(), 0);
    }
}
