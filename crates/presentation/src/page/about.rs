//! What the head of a page says beside the document.

use crate::document::Document;

/// Title and author of a page, and the program that simulated.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct About {
    /// Its title; by default made of the name of the case or history.
    pub title: Option<String>,
    /// Who hands it over.
    pub author: Option<String>,
    /// The program that simulated, of a history of another program; by default as its history states.
    pub program: Option<String>,
}

impl About {
    /// Checks it, for the page of a history that percute simulated, or that another program did.
    ///
    /// # Errors
    /// A text without a word; a program although percute is it.
    pub fn check(&self, foreign: bool) -> Result<(), String> {
        let Self { title, author, program } = self;
        for (name, text) in [("title", title), ("author", author), ("program", program)] {
            if text.as_ref().is_some_and(|text| text.trim().is_empty()) {
                return Err(format!("`{name}` has no word; give a text, or leave it out"));
            }
        }
        match program {
            Some(program) if !foreign => Err(format!(
                "`program` is {program:?}, but percute simulated this; `program` names the simulator of a history of \
                 another program"
            )),
            _ => Ok(()),
        }
    }

    /// Checks it for the page of a document.
    ///
    /// # Errors
    /// As [`About::check`].
    pub fn fits(&self, document: &Document) -> Result<(), String> {
        self.check(document.is_foreign())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_another_program_is_named() {
        let text = |text: &str| Some(text.to_string());
        let program = About { program: text("Akantu"), ..About::default() };
        assert_eq!(program.check(true), Ok(()));
        assert!(program.check(false).unwrap_err().contains("percute simulated this"));
        let blank = About { title: text(" \n"), ..About::default() };
        assert!(blank.check(true).unwrap_err().starts_with("`title` has no word"));
        assert_eq!(About { author: text("A. B."), ..About::default() }.check(false), Ok(()));
    }
}
