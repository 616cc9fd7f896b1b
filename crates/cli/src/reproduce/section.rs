//! What a part gives: text, tables and figures, in the order in which they are read.

use super::table::Table;

/// A part of the evidence.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// Its name on the command line and in the names of its files.
    pub key: &'static str,
    /// Its heading.
    pub title: String,
    /// What it shows, in order.
    pub items: Vec<Item>,
}

/// One thing that a section shows.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// A heading within the section.
    Heading(String),
    /// A paragraph; what stands between `backticks` is set as code.
    Text(String),
    /// Numbers.
    Table(Table),
    /// A drawing.
    Figure(Figure),
}

/// A drawing with its caption.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Name of its files without folder and ending.
    pub name: String,
    /// The drawing.
    pub svg: String,
    /// What is seen: axes, units, what the colours mean, which equation it is.
    pub caption: String,
}

impl Section {
    /// An empty section.
    #[must_use]
    pub fn new(key: &'static str, title: impl Into<String>) -> Self {
        Self { key, title: title.into(), items: Vec::new() }
    }

    /// Adds a heading.
    pub fn heading(&mut self, title: impl Into<String>) {
        self.items.push(Item::Heading(title.into()));
    }

    /// Adds a paragraph.
    pub fn text(&mut self, text: impl Into<String>) {
        self.items.push(Item::Text(text.into()));
    }

    /// Adds a table.
    pub fn table(&mut self, table: Table) {
        self.items.push(Item::Table(table));
    }

    /// Adds a figure; its name is that of a file without folder and ending.
    pub fn figure(&mut self, name: impl Into<String>, svg: String, caption: impl Into<String>) {
        self.items.push(Item::Figure(Figure { name: name.into(), svg, caption: caption.into() }));
    }

    /// Its tables, in order.
    pub fn tables(&self) -> impl Iterator<Item = &Table> {
        self.items.iter().filter_map(|item| if let Item::Table(table) = item { Some(table) } else { None })
    }

    /// Its figures, in order.
    pub fn figures(&self) -> impl Iterator<Item = &Figure> {
        self.items.iter().filter_map(|item| if let Item::Figure(figure) = item { Some(figure) } else { None })
    }
}
