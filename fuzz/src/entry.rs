//! The readers that are given any bytes. `crates/workflow/tests/seeds.rs` gives them those in `fuzz/seeds`.

use percute_io::gmsh;
use percute_workflow::case::{Source, parse};
use percute_workflow::history::open;
use std::path::Path;

/// Reads a case.
///
/// # Errors
/// The message of the reader.
pub fn case(bytes: &[u8]) -> Result<(), String> {
    let text = str::from_utf8(bytes).map_err(|error| error.to_string())?;
    parse(Source::new("case.toml", text)).map(drop).map_err(|error| error.to_string())
}

/// Reads a mesh of Gmsh.
///
/// # Errors
/// The message of the reader.
pub fn mesh(bytes: &[u8]) -> Result<(), String> {
    gmsh::parse(Path::new("body.msh"), bytes, 1.0).map(drop).map_err(|error| error.to_string())
}

/// Reads all of a history, of percute or another program. `file` takes the bytes.
///
/// # Errors
/// The message of the reader, or that the file cannot be written.
pub fn history(bytes: &[u8], file: &Path) -> Result<(), String> {
    std::fs::write(file, bytes).map_err(|error| error.to_string())?;
    let stored = open(file).map_err(|error| error.to_string())?;
    stored.results().map(drop).map_err(|error| error.to_string())
}
