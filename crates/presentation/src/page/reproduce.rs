//! The case text and the commands that compute the numbers again.

use super::Contents;
use super::html::{heading, paragraph, remark, section as sectioned, verbatim};
use crate::document::Document;
use percute_workflow::message::bytes;

/// Longest text of a case on the page (bytes): longer ones hold their mesh as arrays.
const LONGEST: usize = 100_000;

pub(super) fn section(contents: &Contents<'_>) -> String {
    let document = contents.document;
    let version = document.text("versions.percute");
    let mut html = paragraph(&format!(
        "percute {version} computed the numbers on {} {}. The same version on the same architecture gives them again bit by bit.",
        document.text("versions.architecture"),
        document.text("versions.system")
    ));
    html += &verbatim(&commands(contents));
    html += &match contents.case {
        Some(case) => heading(&format!("Case file {}", file_of(&case.name))) + &text(&case.text),
        None => {
            let origin = "The problem was not stated in a case file. This is the problem in the language of the case files, without \
                          mesh, initial fields and instants.";
            heading("Statement of the problem") + &remark(origin) + &text(contents.statement)
        }
    };
    sectioned("How to reproduce", &html)
}

fn text(text: &str) -> String {
    if text.len() <= LONGEST {
        return verbatim(text);
    }
    let end = (0..=LONGEST).rev().find(|&end| text.is_char_boundary(end)).unwrap_or(0);
    let size = bytes(text.len() as u64);
    remark(&format!("The text has {size}; the page has its beginning, the file of the estimate has all of it."))
        + &verbatim(&text[..end])
}

fn file_of(name: &str) -> String {
    std::path::Path::new(name).file_name().map_or_else(|| name.to_string(), |name| name.to_string_lossy().into_owned())
}

fn commands(contents: &Contents<'_>) -> String {
    let document = contents.document;
    let name = document.name();
    let Some(case) = contents.case else {
        // A history of another program, or of Python.
        let file = if name.contains('.') { name } else { "history.vtkhdf".to_string() };
        return estimate(document, &file);
    };
    let case = quoted(&file_of(&case.name));
    if quoted(&name) == case {
        return format!("percute run {case} --report report.html");
    }
    format!("percute simulate {case} --history {}\n{}", quoted(&name), estimate(document, &name))
}

/// The command for a history, with all options.
fn estimate(document: &Document, file: &str) -> String {
    let option = |key: &str| {
        let value = document.at(&format!("options.{key}"));
        let value = value.as_str().map(str::to_string).or_else(|| value.as_u64().map(|value| value.to_string()));
        value.map_or_else(String::new, |value| format!(" --{key} {}", quoted(&value)))
    };
    let options: String = ["reconstruction", "acceleration", "every"].map(option).concat();
    format!("percute estimate {}{options} --report report.html", quoted(file))
}

/// A word for the shell.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "._-/+=:@".contains(c);
    if !word.is_empty() && word.chars().all(plain) && !word.starts_with('-') {
        return word.to_string();
    }
    let word = if word.starts_with('-') { format!("./{word}") } else { word.to_string() };
    format!("'{}'", word.replace('\'', "'\\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_survive_the_shell() {
        assert_eq!(["a.toml", "a b", "it's", "-x", ""].map(quoted), ["a.toml", "'a b'", "'it'\\''s'", "'./-x'", "''"]);
    }
}
