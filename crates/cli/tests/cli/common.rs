//! A case to make mistakes in, and the command to run it.

use assert_cmd::cargo::cargo_bin_cmd;
use std::path::PathBuf;
use std::process::Output;
use tempfile::TempDir;

/// A good case, from which `tests/mistakes.toml` starts, as from the two below.
pub(crate) const BLOCK: &str = include_str!("../../../../tests/bases/block.toml");

/// A good case of a bar.
pub(crate) const BAR: &str = include_str!("../../../../tests/bases/bar.toml");

/// A good case with a mesh as arrays: two triangles, one of them clockwise, of two materials.
pub(crate) const ARRAYS: &str = include_str!("../../../../tests/bases/arrays.toml");

/// A good case of two blocks.
pub(crate) const BODIES: &str = include_str!("../../../../tests/bases/bodies.toml");

/// A folder with a case in it.
pub(crate) struct Bench {
    folder: TempDir,
}

impl Bench {
    /// Writes a case to `case.toml` in a new folder.
    pub(crate) fn new(case: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("case.toml"), case).unwrap();
        Self { folder }
    }

    /// A path in the folder.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Names of what is in the folder.
    pub(crate) fn files(&self) -> Vec<String> {
        let name = |entry: std::io::Result<std::fs::DirEntry>| entry.unwrap().file_name().into_string().unwrap();
        let mut names: Vec<String> = std::fs::read_dir(self.folder.path()).unwrap().map(name).collect();
        names.sort();
        names
    }

    /// Runs `percute` in the folder.
    pub(crate) fn percute(&self, arguments: &[&str]) -> Output {
        cargo_bin_cmd!("percute").current_dir(self.folder.path()).args(arguments).output().unwrap()
    }
}

/// Standard output as text.
pub(crate) fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// Standard error as text.
pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}
