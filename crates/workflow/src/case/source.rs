//! The text of a case file, and errors that point into it.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Longer lines of the case file are cut in error messages.
const LONGEST_EXCERPT: usize = 90;

/// A case file with its name.
#[derive(Clone, Debug)]
pub struct Source {
    name: String,
    text: String,
    folder: PathBuf,
}

/// Where in a case file: the path of the key, and its bytes.
#[derive(Clone, Debug)]
pub(crate) struct At {
    pub(crate) path: String,
    pub(crate) span: Range<usize>,
}

/// Something wrong in a case file.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub struct CaseError {
    /// Name of the file.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// That line, perhaps cut; empty if the line says nothing.
    pub excerpt: String,
    /// The key at fault, such as `[[support]] 2, velocity`; empty for the file as a whole.
    pub path: String,
    /// What is wrong, and what is allowed.
    pub message: String,
}

impl fmt::Display for CaseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: ", self.file, self.line)?;
        if !self.path.is_empty() {
            write!(f, "{}: ", self.path)?;
        }
        f.write_str(&self.message)?;
        if !self.excerpt.is_empty() {
            write!(f, "\n{:>6} | {}", self.line, self.excerpt)?;
        }
        Ok(())
    }
}

impl Source {
    /// A case file of this name and text. Files that it names are relative to the working directory.
    #[must_use]
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self { name: name.into(), text: text.into(), folder: PathBuf::new() }
    }

    /// The same case; the files that it reads are relative to this folder.
    #[must_use]
    pub fn in_folder(self, folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into(), ..self }
    }

    /// Where a file is that the case reads.
    #[must_use]
    pub fn beside(&self, file: &Path) -> PathBuf {
        self.folder.join(file)
    }

    /// The name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The text.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// An error at a place.
    pub(crate) fn error(&self, at: &At, message: impl Into<String>) -> CaseError {
        let before = self.text.as_bytes().get(..at.span.start).unwrap_or_default();
        let line = 1 + before.iter().filter(|&&b| b == b'\n').count();
        let whole = self.text.lines().nth(line - 1).unwrap_or_default().trim();
        let mut excerpt: String = whole.chars().take(LONGEST_EXCERPT).collect();
        if excerpt.len() < whole.len() {
            excerpt.push('…');
        }
        CaseError { file: self.name.clone(), line, excerpt, path: at.path.clone(), message: message.into() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_counts_lines_and_quotes_them() {
        let source = Source::new("a.toml", "x = 1\n  y = 2\n");
        let error = source.error(&At { path: "y".into(), span: 8..9 }, "is wrong");
        assert_eq!(error.to_string(), "a.toml:2: y: is wrong\n     2 | y = 2");
    }

    #[test]
    fn places_beyond_the_text_are_no_panic() {
        let source = Source::new("a.toml", "");
        assert_eq!(source.error(&At { path: String::new(), span: 9..9 }, "gone").to_string(), "a.toml:1: gone");
    }
}
