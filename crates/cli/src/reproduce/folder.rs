//! The folder of the evidence.

use super::effort::Effort;
use super::error::ReproduceError;
use super::page::{html, markdown};
use super::raster::Raster;
use super::section::Section;
use serde_json::{Map, Value, json};
use std::path::Path;

/// The page, and its short form for a repository.
pub(super) const PAGE: &str = "index.html";
const SHORT_PAGE: &str = "verification.md";
const NUMBERS: &str = "numbers.json";
const FIGURES: &str = "figures";
const TABLES: &str = "tables";

/// Makes the folder, or makes sure that it may be used.
///
/// # Errors
/// [`ReproduceError::NotEmpty`] unless `overwrite`; [`ReproduceError::Unwritable`].
pub fn prepare(folder: &Path, overwrite: bool) -> Result<(), ReproduceError> {
    let unwritable = |file: &Path, cause: String| ReproduceError::Unwritable { file: file.to_path_buf(), cause };
    for place in [folder.to_path_buf(), folder.join(FIGURES), folder.join(TABLES)] {
        if place.exists() && !place.is_dir() {
            return Err(unwritable(&place, "it is no folder".to_string()));
        }
    }
    let parent = folder.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !parent.is_dir() {
        let cause = format!("there is no folder {}; create it first, or give another name", parent.display());
        return Err(unwritable(folder, cause));
    }
    let used = std::fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_some());
    if used && !overwrite {
        return Err(ReproduceError::NotEmpty { folder: folder.to_path_buf() });
    }
    std::fs::create_dir_all(folder).map_err(|cause| unwritable(folder, cause.to_string()))?;
    for name in [PAGE, SHORT_PAGE, NUMBERS] {
        let file = folder.join(name);
        percute_workflow::writable::check(&file).map_err(|cause| unwritable(&file, cause.to_string()))?;
    }
    Ok(())
}

/// Writes figures and tables of a section.
pub(super) fn write_section(folder: &Path, section: &Section, raster: &Raster) -> Result<(), ReproduceError> {
    for figure in section.figures() {
        let file = folder.join(FIGURES).join(&figure.name);
        write(&file.with_extension("svg"), figure.svg.as_bytes())?;
        write(&file.with_extension("png"), &raster.png(&figure.svg)?)?;
    }
    for table in section.tables() {
        write(&folder.join(TABLES).join(format!("{}.csv", table.name)), table.csv().as_bytes())?;
    }
    Ok(())
}

/// Writes the page, its short form and all numbers.
pub(super) fn write_pages(folder: &Path, sections: &[Section], effort: &Effort) -> Result<(), ReproduceError> {
    write(&folder.join(PAGE), html(sections, effort).as_bytes())?;
    write(&folder.join(SHORT_PAGE), markdown(sections, effort).as_bytes())?;
    write(&folder.join(NUMBERS), format!("{:#}\n", numbers(sections, effort)).as_bytes())
}

/// All numbers: `percute` (the version), `effort`, and `parts`, each with `title` and `tables` by their names.
#[must_use]
pub fn numbers(sections: &[Section], effort: &Effort) -> Value {
    let tables = |section: &Section| section.tables().map(|t| (t.name.clone(), t.json())).collect::<Map<_, _>>();
    let part =
        |section: &Section| (section.key.to_string(), json!({ "title": section.title, "tables": tables(section) }));
    json!({
        "percute": env!("CARGO_PKG_VERSION"),
        "effort": effort.name(),
        "parts": sections.iter().map(part).collect::<Map<_, _>>(),
    })
}

/// Writes a file, in a folder that is made with its first one: a run that is stopped before leaves none.
fn write(file: &Path, content: &[u8]) -> Result<(), ReproduceError> {
    let folder = file.parent().unwrap_or(Path::new("."));
    std::fs::create_dir_all(folder)
        .and_then(|()| std::fs::write(file, content))
        .map_err(|cause| ReproduceError::Unwritable { file: file.to_path_buf(), cause: cause.to_string() })
}
