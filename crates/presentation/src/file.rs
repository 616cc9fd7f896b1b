//! The files of pictures and pages: checked before the work, written completely or not at all.

use crate::page::Contents;
use crate::png::rendered;
use percute_io::{Overwrite, write_bytes};
use percute_workflow::Failure;
use percute_workflow::outputs::OutputFile;
use std::path::Path;

/// The kind of a picture, by the end of its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Lines and areas.
    Svg,
    /// Pixels.
    Png,
}

fn ends(output: &OutputFile<'_>, end: &str) -> bool {
    output.file.extension().is_some_and(|found| found.eq_ignore_ascii_case(end))
}

/// The format of a picture.
///
/// # Errors
/// A name that ends in neither `.svg` nor `.png`.
pub fn picture(output: &OutputFile<'_>) -> Result<Format, Failure> {
    match (ends(output, "svg"), ends(output, "png")) {
        (true, _) => Ok(Format::Svg),
        (_, true) => Ok(Format::Png),
        _ => {
            let (what, file) = (output.what, output.file.display());
            let message = format!("{what} {file}: a picture is SVG or PNG; give a name that ends in .svg or .png");
            Err(Failure::Argument(message))
        }
    }
}

/// Checks the name of a page.
///
/// # Errors
/// A name that ends in neither `.html` nor `.htm`.
pub fn page(output: &OutputFile<'_>) -> Result<(), Failure> {
    if ends(output, "html") || ends(output, "htm") {
        return Ok(());
    }
    let (what, file) = (output.what, output.file.display());
    Err(Failure::Argument(format!("{what} {file}: the report is an HTML page; give a name that ends in .html")))
}

/// Writes a picture that was drawn as an SVG document.
///
/// # Errors
/// A name of no known format; a file that exists and may not be replaced, or that cannot be written.
pub fn write_picture(output: &OutputFile<'_>, overwrite: Overwrite, svg: &str) -> Result<(), Failure> {
    let failed = |cause: String| Failure::Unwritable { what: output.what, file: output.file.to_path_buf(), cause };
    match picture(output)? {
        Format::Svg => write_bytes(output.file, overwrite, svg.as_bytes())?,
        Format::Png => {
            let pixels = rendered(svg).map_err(|error| failed(error.to_string()))?;
            write_bytes(output.file, overwrite, &pixels)?;
        }
    }
    Ok(())
}

/// Writes the page of an estimate and gives its size (bytes).
///
/// # Errors
/// A name that is not that of a page; a file that exists and may not be replaced, or that cannot be written.
pub fn write_page(output: &OutputFile<'_>, overwrite: Overwrite, contents: &Contents<'_>) -> Result<u64, Failure> {
    page(output)?;
    let folder = output.file.parent().unwrap_or(Path::new(""));
    let html = crate::page::page(contents, folder);
    write_bytes(output.file, overwrite, html.as_bytes())?;
    Ok(html.len() as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_say_the_format() {
        let of = |name: &str| picture(&OutputFile { what: "--picture", file: Path::new(name) });
        assert_eq!(of("a.svg").unwrap(), Format::Svg);
        assert_eq!(of("a.b.PNG").unwrap(), Format::Png);
        for wrong in ["a", "a.jpg", "svg", ".png", "a.svgz"] {
            assert!(matches!(of(wrong), Err(Failure::Argument(_))), "{wrong}");
        }
        let page = |name: &str| page(&OutputFile { what: "--report", file: Path::new(name) });
        assert!(page("a.html").is_ok() && page("a.HTM").is_ok() && page("a.pdf").is_err());
    }
}
