//! A table as CSV, JSON, HTML and Markdown.

use super::{Cell, Column, Table};
use crate::reproduce::page::{escape, rich};
use percute_workflow::message::short;
use serde_json::{Value, json};
use std::fmt::Write;

/// Longer tables are not on the page at all: their files have them.
const MOST_ROWS: usize = 1000;
/// What stands for nothing.
const NOTHING: &str = "–";

impl Table {
    /// As CSV, with all digits; the first line has names and units.
    #[must_use]
    pub fn csv(&self) -> String {
        let line = |cells: Vec<String>| cells.iter().map(|cell| quoted(cell)).collect::<Vec<_>>().join(",") + "\n";
        let head = line(self.columns.iter().map(Column::heading).collect());
        self.rows.iter().map(|row| line(row.iter().map(exact).collect())).fold(head, |text, row| text + &row)
    }

    /// As a JSON object with `caption`, `columns` (name, unit, equation) and `rows`, with all digits.
    #[must_use]
    pub fn json(&self) -> Value {
        let column = |c: &Column| json!({ "name": c.name, "unit": c.unit, "equation": c.equation });
        let cell = |cell: &Cell| match cell {
            Cell::Text(text) => json!(text),
            Cell::Number(number) => json!(number),
            Cell::Count(count) => json!(count),
            Cell::None => Value::Null,
        };
        let rows: Vec<Vec<Value>> = self.rows.iter().map(|row| row.iter().map(cell).collect()).collect();
        json!({
            "caption": self.caption,
            "columns": self.columns.iter().map(column).collect::<Vec<_>>(),
            "rows": rows,
        })
    }

    /// As an HTML figure with its caption.
    #[must_use]
    pub fn html(&self, number: usize) -> String {
        let mut body = String::from("<table>\n<thead><tr>");
        for column in &self.columns {
            let small = [&column.unit, &column.equation].into_iter().filter(|text| !text.is_empty());
            let small: Vec<String> = small.map(|text| escape(text)).collect();
            let _ = write!(body, "<th>{}<small>{}</small></th>", escape(&column.name), small.join(" "));
        }
        body += "</tr></thead>\n<tbody>\n";
        for row in &self.rows {
            body += "<tr>";
            for (cell, column) in row.iter().zip(&self.columns) {
                let class = if matches!(cell, Cell::Text(_)) { "" } else { " class=\"n\"" };
                let _ = write!(body, "<td{class}>{}</td>", escape(&shown(cell, column)));
            }
            body += "</tr>\n";
        }
        body += "</tbody>\n</table>";
        let caption = format!(
            "<b>Table {number}.</b> {} <span class=\"file\">tables/{}.csv</span>",
            rich(&self.caption),
            self.name
        );
        let rows = self.rows.len();
        if self.long && rows > MOST_ROWS {
            return format!("<p class=\"table\">{caption} ({rows} rows)</p>\n");
        }
        if self.long {
            return format!(
                "<details class=\"table\"><summary>{caption} ({rows} rows)</summary>\n{body}\n</details>\n"
            );
        }
        format!(
            "<figure class=\"table\">\n<figcaption>{caption}</figcaption>\n<div class=\"wide\">{body}</div>\n</figure>\n"
        )
    }

    /// As Markdown, its caption first; a long table is left to its file.
    #[must_use]
    pub fn markdown(&self, number: usize) -> String {
        if self.long {
            return format!(
                "**Table {number}.** {} ({} rows in `{}.csv`)\n\n",
                self.caption,
                self.rows.len(),
                self.name
            );
        }
        let head = |column: &Column| {
            let parts = [column.heading(), column.equation.clone()];
            parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" ")
        };
        let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        let mut text = format!("**Table {number}.** {}\n\n", self.caption);
        text += &line(self.columns.iter().map(head).collect());
        text += &line(self.columns.iter().map(|_| "---".to_string()).collect());
        for row in &self.rows {
            let cells = row.iter().zip(&self.columns).map(|(cell, column)| shown(cell, column).replace('|', "\\|"));
            text += &line(cells.collect());
        }
        text + "\n"
    }
}

/// A cell with all its digits.
fn exact(cell: &Cell) -> String {
    match cell {
        Cell::Text(text) => text.clone(),
        Cell::Number(number) => number.to_string(),
        Cell::Count(count) => count.to_string(),
        Cell::None => String::new(),
    }
}

/// A cell for people.
pub(in crate::reproduce) fn shown(cell: &Cell, column: &Column) -> String {
    match cell {
        Cell::Number(number) => short(*number, column.digits).replace('-', "−"),
        Cell::None => NOTHING.to_string(),
        other => exact(other),
    }
}

fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_string() }
}
