//! Pieces of HTML. Texts are escaped and symbols typeset here, and nowhere else.

use crate::document::numbers;
use crate::scale;
use crate::svg::Svg;
use crate::typeset::{escaped, html};
use percute_workflow::message::{self, percent, trimmed};
use serde_json::Value;

/// A section with its title; nothing without contents.
pub(super) fn section(title: &str, contents: &str) -> String {
    if contents.is_empty() {
        return String::new();
    }
    format!("<section>\n<h2>{}</h2>\n{contents}</section>\n", html(title))
}

pub(super) fn heading(title: &str) -> String {
    format!("<h3>{}</h3>\n", html(title))
}

pub(super) fn paragraph(text: &str) -> String {
    format!("<p>{}</p>\n", html(text))
}

pub(super) fn remark(text: &str) -> String {
    format!("<p class=\"faint\">{}</p>\n", html(text))
}

/// A text as it is, in a font of equal widths.
pub(super) fn verbatim(text: &str) -> String {
    format!("<pre>{}</pre>\n", escaped(text.trim_end()))
}

/// A picture with its caption, inside a frame that scrolls.
pub(super) fn figure(svg: &Svg, label: &str, caption: &str) -> String {
    let picture = svg.inside(label);
    format!("<figure><div class=\"scroll\">{picture}</div>\n<figcaption>{}</figcaption></figure>\n", html(caption))
}

/// A number with five digits.
pub(super) fn number(value: Option<f64>) -> String {
    value.map_or_else(|| "–".to_string(), |value| trimmed(value, 5))
}

/// A number with its unit, which gets a prefix, in one line.
pub(super) fn quantity(value: Option<f64>, unit: &str) -> String {
    value.map_or_else(|| "–".to_string(), |value| together(&scale::quantity(value, unit, 5)))
}

/// A text that is not broken.
pub(super) fn together(text: &str) -> String {
    text.replace(' ', "\u{a0}")
}

/// A fraction in per cent.
pub(super) fn share(value: Option<f64>) -> String {
    value.map_or_else(|| "–".to_string(), percent)
}

/// Numbers of a list.
pub(super) fn vector(values: &[f64]) -> String {
    message::vector(values, 5)
}

/// A key of an object of the document, its name on the page, and its unit: `%` for fractions, `#` for counts.
pub(super) type Named = (&'static str, &'static str, &'static str);

/// A table of the members of an object: those with a name in their order, then the others with the words of their keys.
pub(super) fn members(title: &'static str, object: &Value, names: &[Named]) -> String {
    /// Most rows of others.
    const MOST: usize = 12;
    let Some(object) = object.as_object() else { return String::new() };
    let mut table = Table::new(&[title, "#value"]);
    for (key, name, unit) in names {
        if let Some(value) = object.get(*key) {
            table.row(&[(*name).to_string(), member(value, unit)]);
        }
    }
    let others = object.iter().filter(|(key, _)| names.iter().all(|(name, ..)| name != key));
    for (key, value) in others.take(MOST) {
        table.row(&[key.replace('_', " "), member(value, "")]);
    }
    table.html()
}

/// A member of an object, with its unit.
fn member(value: &Value, unit: &str) -> String {
    match (value, unit) {
        (Value::Bool(flag), _) => if *flag { "yes" } else { "no" }.to_string(),
        (Value::String(text), _) => text.clone(),
        (Value::Number(count), "#") => count.to_string(),
        (Value::Number(value), "%") => share(value.as_f64()),
        (Value::Number(value), _) => quantity(value.as_f64(), unit),
        (Value::Array(all), _) if all.len() <= 3 => together(&scale::vector_quantity(&numbers(value), unit, 5)),
        _ => "–".to_string(),
    }
}

/// A table under construction.
#[derive(Clone, Debug)]
pub(super) struct Table {
    /// Titles of the columns; those that begin with `#` hold numbers, with `~` long texts.
    titles: Vec<String>,
    rows: Vec<String>,
    long: bool,
}

impl Table {
    pub(super) fn new(titles: &[&str]) -> Self {
        Self { titles: titles.iter().map(|title| title.to_string()).collect(), rows: Vec::new(), long: false }
    }

    /// One that paper may break between rows.
    pub(super) fn long(titles: &[&str]) -> Self {
        Self { long: true, ..Self::new(titles) }
    }

    fn class(title: &str) -> &'static str {
        match title.chars().next() {
            Some('#') => " class=\"n\"",
            Some('~') => " class=\"wide\"",
            _ => "",
        }
    }

    /// Adds a row of texts.
    pub(super) fn row(&mut self, cells: &[String]) {
        self.marked("", cells.iter().map(|cell| html(cell)).collect());
    }

    /// Adds a row of HTML with a class.
    pub(super) fn marked(&mut self, class: &str, cells: Vec<String>) {
        let cell = |(title, cell): (&String, String)| format!("<td{}>{cell}</td>", Self::class(title));
        let cells: String = self.titles.iter().zip(cells).map(cell).collect();
        let class = if class.is_empty() { String::new() } else { format!(" class=\"{class}\"") };
        self.rows.push(format!("<tr{class}>{cells}</tr>\n"));
    }

    /// The table inside a frame that scrolls; nothing without rows.
    pub(super) fn html(&self) -> String {
        if self.rows.is_empty() {
            return String::new();
        }
        let title =
            |title: &String| format!("<th{}>{}</th>", Self::class(title), html(title.trim_start_matches(['#', '~'])));
        let titles: String = self.titles.iter().map(title).collect();
        // Pairs of a name and a value need no titles.
        let head =
            if self.titles[0].is_empty() { String::new() } else { format!("<thead><tr>{titles}</tr></thead>\n") };
        let long = if self.long { " class=\"long\"" } else { "" };
        let rows = self.rows.join("");
        format!("<div class=\"scroll\"><table{long}>\n{head}<tbody>\n{rows}</tbody>\n</table></div>\n")
    }
}
