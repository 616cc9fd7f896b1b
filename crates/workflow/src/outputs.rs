//! The files that a run will make, checked before any work is done for them.

use crate::failure::Failure;
use crate::writable;
use percute_io::is_vtkhdf_name;
use std::path::Path;

/// A file to come.
#[derive(Clone, Copy, Debug)]
pub struct OutputFile<'a> {
    /// The argument or key that names it.
    pub what: &'static str,
    /// The file.
    pub file: &'a Path,
}

/// A file from the command line, else from the case.
pub fn chosen<'a>(
    [flag, key]: [&'static str; 2],
    given: Option<&'a Path>,
    stated: Option<&'a Path>,
) -> Option<OutputFile<'a>> {
    let stated = stated.map(|file| OutputFile { what: key, file });
    given.map(|file| OutputFile { what: flag, file }).or(stated)
}

/// Makes sure that histories and estimate files have the ending by which ParaView recognises them.
///
/// # Errors
/// [`Failure::Argument`] for another ending.
pub fn check_endings(outputs: &[Option<OutputFile<'_>>]) -> Result<(), Failure> {
    match outputs.iter().flatten().find(|output| !is_vtkhdf_name(output.file)) {
        None => Ok(()),
        Some(OutputFile { what, file }) => Err(Failure::Argument(format!(
            "{what} {}: the name must end in .vtkhdf, from which ParaView recognises it; `percute export` writes .vtu",
            file.display()
        ))),
    }
}

/// Makes sure that all files can be made, that no two of them are one, and that none is an input; `inputs` say what
/// they are. No file is replaced unless `force` says so.
///
/// # Errors
/// [`Failure::Argument`] for two names of one file, [`Failure::Exists`] and [`Failure::Unwritable`].
pub fn check(inputs: &[(&str, &Path)], outputs: &[Option<OutputFile<'_>>], force: bool) -> Result<(), Failure> {
    let all: Vec<OutputFile<'_>> = outputs.iter().copied().flatten().collect();
    for (i, OutputFile { what, file }) in all.iter().enumerate() {
        let shown = file.display();
        if let Some((name, _)) = inputs.iter().find(|(_, input)| writable::same(file, input)) {
            return Err(Failure::Argument(format!("{what} {shown} is the {name} itself; give another name")));
        }
        if let Some(other) = all[..i].iter().find(|other| writable::same(file, other.file)) {
            let message = format!("{what} {shown} is the file of {} too; give it another", other.what);
            return Err(Failure::Argument(message));
        }
    }
    for OutputFile { what, file } in outputs.iter().flatten() {
        if !force && file.exists() {
            return Err(Failure::Exists { what, file: file.to_path_buf() });
        }
        writable::check(file).map_err(|cause| Failure::unwritable(what, file, &cause))?;
    }
    Ok(())
}
