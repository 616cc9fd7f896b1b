//! The page that hands an estimate over: one HTML file, which needs nothing else.

mod contact;
mod error;
mod html;
mod model;
mod numbers;
mod reproduce;
mod verdict;

pub use crate::chart::Surface;

use crate::body::Body;
use crate::document::Document;
use crate::svg;
use crate::typeset::escaped;

/// The looks of the page.
const STYLE: &str = include_str!("page.css");

/// What a page is made of.
#[derive(Clone, Copy, Debug)]
pub struct Contents<'a> {
    /// The JSON document.
    pub document: &'a Document,
    /// The mesh.
    pub body: &'a Body,
    /// The problem in the language of the case files.
    pub statement: &'a str,
    /// The case file as given.
    pub case: Option<&'a percute_io::Case>,
    /// Contact of all nodes at all instants.
    pub surface: Option<&'a Surface>,
}

/// The page, for a browser and for paper (A4).
#[must_use]
pub fn page(contents: &Contents<'_>) -> String {
    let document = contents.document;
    let (marks, light) = svg::style();
    let title = format!("Error of {}", document.name());
    let sections = [
        verdict::section(document),
        error::map(contents),
        error::over_time(document),
        error::sources(document),
        contact::section_of(contents),
        model::balance(document),
        model::section_of(contents),
        reproduce::section(contents),
        numbers::section(document),
    ];
    let style = STYLE.replace("/*light*/", &light);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n<title>{title}</title>\n<style>\n{style}{marks}</style>\n\
         </head>\n<body>\n<main>\n{}{}</main>\n</body>\n</html>\n",
        verdict::head(document),
        sections.join(""),
        title = escaped(&title),
    )
}
