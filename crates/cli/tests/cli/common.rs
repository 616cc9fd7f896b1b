//! A case to make mistakes in, and the command to run it.

use assert_cmd::cargo::cargo_bin_cmd;
use std::path::PathBuf;
use std::process::Output;
use tempfile::TempDir;

/// A good case; the tests of mistakes count its lines.
pub(crate) const BLOCK: &str = r#"[mesh]
rectangle = { width = 0.05, height = 0.04, nx = 5, ny = 4 }

[material]
young = 70e9
poisson = 0.3
density = 2700.0
plane = "stress"

[initial]
velocity = [400.0, -400.0]

[[obstacle]]
point = [0.0, -0.0005]
normal = [0.0, 1.0]
friction = 0.2
group = "bottom"

[[support]]
group = "top"
components = ["x"]
velocity = { time = [0.0, 1e-4], value = [400.0, 400.0] }

[[traction]]
group = "left"
value = [1e6, 0.0]

[time]
end = 5e-6
courant = 0.9

[estimate]
contact_force = "sharp"
every = 1
"#;

/// A good case of a bar.
pub(crate) const BAR: &str = r#"[mesh]
bar = { length = 0.1, elements = 20 }

[material]
young = 70e9
density = 2700.0
section = 0.02

[initial]
velocity = -400.0

[[obstacle]]
point = -0.0002
normal = 1.0

[time]
end = 20e-6
step = 5e-7
"#;

/// A good case with a mesh as arrays: two triangles, one of them clockwise, of two materials.
pub(crate) const ARRAYS: &str = r#"[mesh]
points = [
  [0.0, 0.0],
  [0.01, 0.0],
  [0.01, 0.01],
  [0.0, 0.01],
]
cells = [
  [0, 1, 2],
  [0, 3, 2],
]

[mesh.groups]
foot = [[0, 1]]

[mesh.elements]
right = [0]
left = [1]

[[material]]
group = "left"
young = 70e9
poisson = 0.3
density = 2700.0
plane = "strain"

[[material]]
group = "right"
young = 210e9
poisson = 0.3
density = 7800.0
plane = "strain"

[time]
steps = [1e-7, 2e-7, 3e-7]
"#;

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
