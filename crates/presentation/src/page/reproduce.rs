//! The case text and the commands that compute the numbers again.

use super::Contents;
use super::about::About;
use super::html::{heading, paragraph, remark, section as sectioned, verbatim};
use super::place::seen_from;
use crate::body::Body;
use crate::document::Document;
use percute_io::{Case, is_vtkhdf_name};
use percute_workflow::message::{bytes, counted};
use std::path::Path;

/// Longest text of a case on the page (bytes): longer ones hold their mesh as arrays.
const LONGEST: usize = 100_000;
/// The name of a history that is not in a file yet.
const UNSAVED: &str = "history.vtkhdf";

pub(super) fn section(contents: &Contents<'_>, folder: &Path) -> String {
    let document = contents.document;
    let version = document.text("versions.percute");
    let mut html = paragraph(&format!(
        "percute {version} computed the numbers on {} {}. The same version on the same architecture gives them again \
         bit by bit. Commands are for the folder of this page.",
        document.text("versions.architecture"),
        document.text("versions.system")
    ));
    html += &match contents.case {
        Some(case) => {
            verbatim(&commands(contents, case, folder))
                + &mesh_file(contents.body, &case.text)
                + &heading(&format!("Case file {}", file_of(&case.name)))
                + &text(&case.text)
        }
        None => {
            let origin = "The problem was not stated in a case file. This is the problem in the language of the case \
                          files, without mesh, initial fields and instants.";
            without_case(contents, folder)
                + &heading("Statement of the problem")
                + &remark(origin)
                + &text(contents.statement)
        }
    };
    sectioned("How to reproduce", &html)
}

/// The mesh file that a case names, which the page does not hold.
fn mesh_file(body: &Body, case: &str) -> String {
    let tables = case.parse::<toml::Table>().unwrap_or_default();
    let Some(file) = tables.get("mesh").and_then(|mesh| mesh.get("file")).and_then(toml::Value::as_str) else {
        return String::new();
    };
    let kind = if body.dimension == 1 { "bar element" } else { "triangle" };
    let (elements, nodes) = (counted(body.elements(), kind), counted(body.points.len(), "node"));
    let told = format!(
        "The case reads the mesh file `{file}`, which gives {elements} and {nodes} and is not on this page: it must \
         lie beside the case. A history of the run has its mesh, too, in metres, for a case without `scale`: \
         `percute.open(\"history.vtkhdf\").problem.mesh.write(\"mesh.msh\")` in Python writes it."
    );
    paragraph(&told)
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

/// The name of a case without its folder; one that was given as a text in Python gets an ending.
fn file_of(name: &str) -> String {
    let file = std::path::Path::new(name).file_name();
    let file = file.map_or_else(|| name.to_string(), |name| name.to_string_lossy().into_owned());
    if file.contains('.') { file } else { file + ".toml" }
}

fn commands(contents: &Contents<'_>, case: &Case, folder: &Path) -> String {
    let (document, name) = (contents.document, contents.document.name());
    let file = file_of(&case.name);
    let case = quoted(&seen_from(folder, &case.name).unwrap_or_else(|| file.clone()));
    if file_of(&name) == file {
        return paged(contents.about, &format!("percute run {case}"), "--estimate");
    }
    let name = history(document, folder);
    format!("percute simulate {case} --history {}\n{}", quoted(&name), estimate(contents, &name))
}

/// The history, from the folder of the page on if it is there; else its name.
fn history(document: &Document, folder: &Path) -> String {
    seen_from(folder, document.text("case")).unwrap_or_else(|| document.name())
}

/// The way to a page whose history was not made from a case: from its file, or else from one to be made.
fn without_case(contents: &Contents<'_>, folder: &Path) -> String {
    let document = contents.document;
    let stated = document.at("simulated_by").as_str();
    let program =
        stated.filter(|_| document.is_foreign()).map_or("another program".to_string(), |name| format!("`{name}`"));
    let name = history(document, folder);
    if is_vtkhdf_name(name.as_ref()) {
        let origin = if document.is_foreign() {
            format!("{program} simulated it")
        } else {
            "it was simulated in Python".to_string()
        };
        let told = format!("The estimate is that of the history `{name}`: {origin}, and no case file belongs to it.");
        return paragraph(&told) + &forced(document) + &verbatim(&estimate(contents, &name));
    }
    let origin =
        if document.is_foreign() { format!("was made from arrays of {program}") } else { "was simulated".to_string() };
    let told = format!(
        "The history {origin} in Python and is in no file: the numbers cannot be computed again without it. Where the \
         estimate was made, this stores it, and a page that is written afterwards names the file:"
    );
    let save = format!("estimate.history.save(\"{UNSAVED}\")");
    let then = paragraph("With this file, the command is");
    paragraph(&told) + &verbatim(&save) + &forced(document) + &then + &verbatim(&estimate(contents, UNSAVED))
}

/// Whether a history was estimated although it is not consistent.
fn is_accepted(document: &Document) -> bool {
    document.at("accepted_inconsistent").as_bool() == Some(true)
}

/// That such a history needs an option.
fn forced(document: &Document) -> String {
    let told = "The history is not consistent, and was accepted as it is: with `--accept-inconsistent`, in Python \
                `force=True`.";
    if is_accepted(document) { paragraph(told) } else { String::new() }
}

/// The options of the estimate: name and value.
fn options(document: &Document) -> impl Iterator<Item = (&'static str, String)> {
    ["reconstruction", "acceleration", "every"].into_iter().filter_map(|key| {
        let value = document.at(&format!("options.{key}"));
        let text = value.as_str().map(str::to_string);
        Some((key, text.or_else(|| value.as_u64().map(|value| value.to_string()))?))
    })
}

/// The command for a history, with all options.
fn estimate(contents: &Contents<'_>, file: &str) -> String {
    let document = contents.document;
    let options: String = options(document).map(|(key, value)| format!(" --{key} {}", quoted(&value))).collect();
    let accepted = if is_accepted(document) { " --accept-inconsistent" } else { "" };
    paged(contents.about, &format!("percute estimate {}{options}{accepted}", quoted(file)), "--output")
}

/// A command that estimates, with the page; one with a head of its own is made of the estimate, which this option
/// stores.
fn paged(about: &About, command: &str, option: &str) -> String {
    let given = [("title", &about.title), ("author", &about.author), ("program", &about.program)];
    let head = |(name, text): (&str, &Option<String>)| Some(format!(" --{name} {}", quoted(text.as_deref()?)));
    let head: String = given.into_iter().filter_map(head).collect();
    if head.is_empty() {
        return format!("{command} --report report.html");
    }
    format!("{command} {option} estimate.vtkhdf\npercute report estimate.vtkhdf report.html{head}")
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
