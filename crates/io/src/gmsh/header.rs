//! The section $MeshFormat.

use super::cursor::{Cursor, Form};
use super::error::{Fault, GmshCause};

/// A version of the format.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Version {
    /// MSH 2.2: simple, and read by nearly everything.
    V22,
    /// MSH 4.1: the default of Gmsh.
    #[default]
    V41,
}

/// Reads version, form and sizes, and sets the form of the cursor.
pub(super) fn read(cursor: &mut Cursor<'_>) -> Result<Version, Fault> {
    let at = cursor.at();
    let word = cursor.word("the version of the format")?;
    let version = match word {
        "2.2" => Version::V22,
        "4.1" => Version::V41,
        other => return Err(GmshCause::Version { found: other.chars().take(20).collect() }.at(at)),
    };
    let binary = cursor.int("0 for a text or 1 for a binary file")?;
    let size = cursor.int("the size of numbers")?;
    let after = cursor.at();
    cursor.line();
    let sizes: &[i64] = if version == Version::V22 { &[8] } else { &[4, 8] };
    if !sizes.contains(&size) {
        let what = if version == Version::V22 { "the size of numbers, 8," } else { "the size of numbers, 4 or 8," };
        return Err(GmshCause::Unexpected { found: format!("`{size}`"), what, advice: "the file is damaged" }.at(after));
    }
    match binary {
        0 => {}
        1 => {
            let start = cursor.at();
            let big = match cursor.take(4, "the number 1 for the byte order")? {
                [1, 0, 0, 0] => false,
                [0, 0, 0, 1] => true,
                _ => {
                    let (found, what) = ("something else".to_string(), "the number 1 for the byte order");
                    let advice = "the file is damaged, or was sent as a text";
                    return Err(GmshCause::Unexpected { found, what, advice }.at(start));
                }
            };
            cursor.form = Form::Binary { big, size: size as usize };
        }
        other => {
            let (found, what) = (format!("`{other}`"), "0 for a text or 1 for a binary file");
            return Err(GmshCause::Unexpected { found, what, advice: "the file is damaged" }.at(after));
        }
    }
    Ok(version)
}
