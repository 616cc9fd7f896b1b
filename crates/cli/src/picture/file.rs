//! The file that a picture goes to.

use super::Drawn;
use percute_workflow::Failure;
use percute_workflow::report::Report;
use percute_workflow::writable;
use std::path::Path;

/// Makes sure before the work that a picture can be written at its end. A file that is there is
/// left as it is until then.
///
/// # Errors
/// A name that does not end in `.svg`; a place that cannot be written.
pub fn check_path(file: &Path) -> Result<(), Failure> {
    let extension = file.extension().map(|e| e.to_string_lossy().to_lowercase());
    if extension.as_deref() != Some("svg") {
        let file = file.display();
        return Err(Failure::Argument(format!(
            "--picture {file}: only SVG can be written; give a name that ends in .svg"
        )));
    }
    let fail = |cause: std::io::Error| Failure::Unwritable {
        what: "--picture",
        file: file.to_path_buf(),
        cause: cause.to_string(),
    };
    writable::check(file).map_err(fail)
}

/// Draws a picture and writes it; a file that is there is replaced.
///
/// # Errors
/// A picture that cannot be drawn or written.
pub fn write(body: &impl Drawn, report: &Report, file: &Path) -> Result<(), Failure> {
    let fail = |cause: String| Failure::Unwritable { what: "--picture", file: file.to_path_buf(), cause };
    let svg = body.draw(report).map_err(|error| fail(error.to_string()))?;
    std::fs::write(file, svg).map_err(|cause| fail(cause.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checking_leaves_no_trace() {
        let folder = tempfile::tempdir().unwrap();
        let (new, old) = (folder.path().join("new.svg"), folder.path().join("old.SVG"));
        std::fs::write(&old, "before").unwrap();
        check_path(&new).unwrap();
        check_path(&old).unwrap();
        assert!(!new.exists());
        assert_eq!(std::fs::read_to_string(&old).unwrap(), "before");
    }

    #[test]
    fn other_formats_and_missing_folders_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        assert!(matches!(check_path(&folder.path().join("map.png")), Err(Failure::Argument(_))));
        assert!(matches!(check_path(&folder.path().join("none/map.svg")), Err(Failure::Unwritable { .. })));
    }
}
