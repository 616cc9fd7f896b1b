//! Tables: the numbers of the evidence, from which its figures are drawn.

mod formats;

/// Significant digits of a column that does not say how many.
const DIGITS: usize = 4;

/// A table. Its files hold all digits, its pages as many as can be read.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Its name: that of its file without folder and ending.
    pub name: String,
    /// What it shows, as a caption.
    pub caption: String,
    /// Its columns.
    pub columns: Vec<Column>,
    /// Its rows, with a cell for each column.
    pub rows: Vec<Vec<Cell>>,
    /// Whether it is too long to be read: folded away in the page, and left to its file elsewhere.
    pub long: bool,
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// What it holds.
    pub name: String,
    /// Its unit, if it has one.
    pub unit: String,
    /// Its equation in the paper, such as `[15]`, if it has one.
    pub equation: String,
    /// Significant digits for people.
    pub digits: usize,
}

/// One entry of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A word.
    Text(String),
    /// A measured number.
    Number(f64),
    /// A whole number.
    Count(u64),
    /// Nothing to be said here.
    None,
}

impl Column {
    /// A column without unit and equation.
    #[must_use]
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), unit: String::new(), equation: String::new(), digits: DIGITS }
    }

    /// With a unit.
    #[must_use]
    pub fn unit(self, unit: impl Into<String>) -> Self {
        Self { unit: unit.into(), ..self }
    }

    /// With the number of an equation, such as `[15]`.
    #[must_use]
    pub fn equation(self, equation: impl Into<String>) -> Self {
        Self { equation: equation.into(), ..self }
    }

    /// With another number of significant digits.
    #[must_use]
    pub fn digits(self, digits: usize) -> Self {
        Self { digits, ..self }
    }

    /// Name and unit.
    #[must_use]
    pub fn heading(&self) -> String {
        if self.unit.is_empty() { self.name.clone() } else { format!("{} ({})", self.name, self.unit) }
    }
}

impl Table {
    /// An empty table; its name is that of a file without folder and ending.
    #[must_use]
    pub fn new(name: impl Into<String>, caption: impl Into<String>, columns: Vec<Column>) -> Self {
        Self { name: name.into(), caption: caption.into(), columns, rows: Vec::new(), long: false }
    }

    /// The same, too long to be read.
    #[must_use]
    pub fn long(self) -> Self {
        Self { long: true, ..self }
    }

    /// Adds a row: a cell for each column; what is missing at its end stays empty.
    pub fn push(&mut self, row: impl IntoIterator<Item = Cell>) {
        let mut row: Vec<Cell> = row.into_iter().collect();
        row.resize(self.columns.len(), Cell::None);
        self.rows.push(row);
    }

    /// The numbers of the column of this name in the rows in which the columns named are equal to the cells given; NaN
    /// where there is none.
    #[must_use]
    pub fn numbers(&self, column: &str, equal: &[(&str, Cell)]) -> Vec<f64> {
        self.picked(column, equal).map(Cell::number).collect()
    }

    /// The cells of the column of this name in the rows in which the columns named are equal to the cells given.
    pub fn picked<'a>(&'a self, column: &'a str, equal: &'a [(&'a str, Cell)]) -> impl Iterator<Item = &'a Cell> {
        let at = |name: &str| self.columns.iter().position(|column| column.name == name);
        let holds = move |row: &&Vec<Cell>| equal.iter().all(|(name, cell)| at(name).is_some_and(|i| row[i] == *cell));
        self.rows.iter().filter(holds).filter_map(move |row| at(column).map(|i| &row[i]))
    }
}

impl Cell {
    /// Its number; NaN if it is none.
    #[must_use]
    pub fn number(&self) -> f64 {
        match self {
            Self::Number(number) => *number,
            Self::Count(count) => *count as f64,
            Self::Text(_) | Self::None => f64::NAN,
        }
    }
}

impl From<f64> for Cell {
    /// What is no number is nothing.
    fn from(number: f64) -> Self {
        if number.is_finite() { Self::Number(number) } else { Self::None }
    }
}

impl From<usize> for Cell {
    fn from(count: usize) -> Self {
        Self::Count(count as u64)
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.to_string())
    }
}

impl<T: Into<Cell>> From<Option<T>> for Cell {
    fn from(cell: Option<T>) -> Self {
        cell.map_or(Self::None, Into::into)
    }
}
