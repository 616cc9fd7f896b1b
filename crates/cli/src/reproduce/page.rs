//! The page: one HTML file that needs nothing else, and its short form in Markdown.

mod text;

pub(super) use text::{escape, rich};

use super::effort::Effort;
use super::part::PARTS;
use super::section::{Figure, Item, Section};
use std::fmt::Write;

const STYLE: &str = include_str!("page/style.css");
const TITLE: &str = "How good percute is";
const INTRODUCTION: &str = "percute estimates the error of simulations of impact by the constitutive relation error of \
    Louf, Gallimard and Pelle. This page is the evidence that the estimate is right, and shows where it is not. Every \
    number and every figure on it was computed by the program that wrote it; what others have published stands beside \
    it and says so. Numbers in brackets, like [15], are equations of the paper. Units are SI; for plane bodies, \
    energies and errors are per metre of thickness, so that errors are in J^½.";

/// How the page came about.
fn origin(effort: &Effort) -> String {
    let command = if effort.small { "percute reproduce --small" } else { "percute reproduce" };
    format!("Written by `{command}` of percute {}.", env!("CARGO_PKG_VERSION"))
}

/// Which parts are not on the page, if any.
fn missing(sections: &[Section]) -> Option<String> {
    let there = |key: &str| sections.iter().any(|section| section.key == key);
    let missing: Vec<&str> = PARTS.iter().map(|part| part.key).filter(|key| !there(key)).collect();
    (!missing.is_empty()).then(|| format!("Not on this page: {}.", missing.join(", ")))
}

/// The page as HTML: figures within, light and dark, no scripts.
#[must_use]
pub fn html(sections: &[Section], effort: &Effort) -> String {
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n<title>{TITLE}</title>\n<style>\n{STYLE}</style>\n\
         </head>\n<body>\n<header>\n<h1>{TITLE}</h1>\n<p>{}</p>\n<p class=\"origin\">{}</p>\n</header>\n",
        rich(INTRODUCTION),
        rich(&[Some(origin(effort)), missing(sections)].into_iter().flatten().collect::<Vec<_>>().join(" ")),
    );
    page += "<nav>\n<h2>Contents</h2>\n<ol>\n";
    for section in sections {
        let _ = writeln!(page, "<li><a href=\"#{}\">{}</a></li>", section.key, escape(&section.title));
    }
    page += "</ol>\n</nav>\n<main>\n";
    let (mut figures, mut tables) = (0, 0);
    for section in sections {
        let _ = writeln!(page, "<section id=\"{}\">\n<h2>{}</h2>", section.key, escape(&section.title));
        for item in &section.items {
            match item {
                Item::Heading(title) => _ = writeln!(page, "<h3>{}</h3>", escape(title)),
                Item::Text(text) => _ = writeln!(page, "<p>{}</p>", rich(text)),
                Item::Table(table) => {
                    tables += 1;
                    page += &table.html(tables);
                }
                Item::Figure(figure) => {
                    figures += 1;
                    page += &drawing(figure, figures);
                }
            }
        }
        page += "</section>\n";
    }
    page + "</main>\n</body>\n</html>\n"
}

/// A figure within the page: the drawing itself, whose style is that of the page.
fn drawing(figure: &Figure, number: usize) -> String {
    let (start, rest) = figure.svg.split_once("<style>").unwrap_or((&figure.svg, ""));
    let rest = rest.split_once("</style>").map_or(rest, |(_, rest)| rest.trim_start());
    let label = format!("<svg role=\"img\" aria-label=\"{}\"", escape(&figure.caption.replace('`', "")));
    let svg = format!("{}{rest}", start.replacen("<svg", &label, 1));
    let name = &figure.name;
    format!(
        "<figure id=\"{name}\">\n<div class=\"wide\">{}</div>\n<figcaption><b>Figure {number}.</b> {} \
         <span class=\"file\">figures/{name}.svg, .png</span></figcaption>\n</figure>\n",
        svg.trim_end(),
        rich(&figure.caption),
    )
}

/// The page as Markdown, for `docs/verification.md`: long tables are left to their files.
#[must_use]
pub fn markdown(sections: &[Section], effort: &Effort) -> String {
    let mut page = format!("# {TITLE}\n\n{INTRODUCTION}\n\n{}", origin(effort));
    if let Some(missing) = missing(sections) {
        let _ = write!(page, " {missing}");
    }
    page += "\n\n";
    let (mut figures, mut tables) = (0, 0);
    for section in sections {
        let _ = write!(page, "## {}\n\n", section.title);
        for item in &section.items {
            match item {
                Item::Heading(title) => _ = write!(page, "### {title}\n\n"),
                Item::Text(text) => _ = write!(page, "{text}\n\n"),
                Item::Table(table) => {
                    tables += 1;
                    page += &table.markdown(tables);
                }
                Item::Figure(figure) => {
                    figures += 1;
                    let Figure { name, caption, .. } = figure;
                    let _ =
                        write!(page, "![Figure {figures}](figures/{name}.png)\n\n**Figure {figures}.** {caption}\n\n");
                }
            }
        }
    }
    page.trim_end().to_string() + "\n"
}
