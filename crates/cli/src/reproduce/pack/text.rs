//! The case files of the pack, with other meshes and starts.

use super::super::ReproduceError;
use percute_workflow::case::{Case, CaseOf, Source, parse};

/// A case file that the program carries with it, and its settings.
#[derive(Clone, Debug)]
pub(super) struct CaseText {
    name: &'static str,
    text: String,
}

impl CaseText {
    /// The file of this name and text.
    pub(super) fn new(name: &'static str, text: &str) -> Self {
        Self { name, text: text.to_string() }
    }

    /// The same with another value for a key, on every line that sets it.
    ///
    /// # Errors
    /// No line sets it.
    pub(super) fn with(self, key: &str, value: &str) -> Result<Self, ReproduceError> {
        let sets = |line: &str| line.split_once(" = ").is_some_and(|(left, _)| left == key);
        if !self.text.lines().any(sets) {
            return Err(ReproduceError::Unexpected(format!("{}: no line sets `{key}`", self.name)));
        }
        let line = |line: &str| if sets(line) { format!("{key} = {value}\n") } else { format!("{line}\n") };
        Ok(Self { text: self.text.lines().map(line).collect(), ..self })
    }

    /// The same with another number for a key.
    pub(super) fn number(self, key: &str, value: f64) -> Result<Self, ReproduceError> {
        self.with(key, &format!("{value:e}"))
    }

    /// The same on a bar of so many equal elements.
    pub(super) fn bar(self, length: f64, elements: usize) -> Result<Self, ReproduceError> {
        self.with("bar", &format!("{{ length = {length:e}, elements = {elements} }}"))
    }

    /// The same on a rectangle of so many cells.
    pub(super) fn rectangle(self, sides: [f64; 2], cells: [usize; 2]) -> Result<Self, ReproduceError> {
        let ([width, height], [nx, ny]) = (sides, cells);
        self.with("rectangle", &format!("{{ width = {width:e}, height = {height:e}, nx = {nx}, ny = {ny} }}"))
    }

    /// The same that starts from displacements at the nodes of a bar.
    pub(super) fn bar_start(self, values: impl Iterator<Item = f64>) -> Result<Self, ReproduceError> {
        let list: Vec<String> = values.map(|u| format!("{u:e}")).collect();
        self.with("displacement", &format!("[{}]", list.join(", ")))
    }

    /// The same that starts from displacements at the nodes of a plane body.
    pub(super) fn plane_start(self, values: impl Iterator<Item = [f64; 2]>) -> Result<Self, ReproduceError> {
        let list: Vec<String> = values.map(|[x, y]| format!("[{x:e}, {y:e}]")).collect();
        self.with("displacement", &format!("[{}]", list.join(", ")))
    }

    /// The case, read and checked.
    fn read(&self) -> Result<Case, ReproduceError> {
        Ok(parse(Source::new(format!("{}.toml", self.name), &*self.text))?)
    }

    /// The same of a bar.
    pub(super) fn read_bar(&self) -> Result<CaseOf<1, 2>, ReproduceError> {
        self.read()?.bar().map(|case| *case).ok_or_else(|| self.unexpected("this is no bar"))
    }

    /// The same of a plane body.
    pub(super) fn read_plane(&self) -> Result<CaseOf<2, 3>, ReproduceError> {
        self.read()?.plane().map(|case| *case).ok_or_else(|| self.unexpected("this is a bar"))
    }

    /// What this case is not.
    pub(super) fn unexpected(&self, what: &str) -> ReproduceError {
        ReproduceError::Unexpected(format!("{}.toml: {what}", self.name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_replace_whole_lines() {
        let text = CaseText::new("bar", "[mesh]\nbar = { length = 1.0, elements = 2 }  # m\nyoung = 2.0\n");
        let text = text.bar(0.5, 8).unwrap().number("young", 3.0).unwrap();
        assert_eq!(text.text, "[mesh]\nbar = { length = 5e-1, elements = 8 }\nyoung = 3e0\n");
        assert!(text.number("youn", 3.0).unwrap_err().to_string().contains("`youn`"));
    }
}
