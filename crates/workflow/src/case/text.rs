//! Text in the language of the case files.

use std::fmt::Write;

/// Puts tables and keys one after the other.
#[derive(Debug, Default)]
pub(super) struct Writer {
    text: String,
}

impl Writer {
    /// Begins a table with its header, such as `[[material]]`.
    pub(super) fn table(&mut self, header: &str) {
        if !self.text.is_empty() {
            self.text.push('\n');
        }
        self.text += header;
        self.text.push('\n');
    }

    /// A key with its value as it is to be written.
    pub(super) fn key(&mut self, key: &str, value: impl AsRef<str>) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.text, "{key} = {}", value.as_ref());
    }

    /// A number, in the fewest digits from which the same bits come back.
    pub(super) fn number(&mut self, key: &str, value: f64) {
        self.key(key, format!("{value:?}"));
    }

    /// The key `group`, if there is one.
    pub(super) fn group(&mut self, name: Option<&str>) {
        if let Some(name) = name {
            self.key("group", quoted(name));
        }
    }

    /// The text.
    pub(super) fn finish(self) -> String {
        self.text
    }
}

/// A text in quotes, whatever it holds.
pub(super) fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => _ = write!(quoted, "\\u{:04X}", u32::from(c)),
            c => quoted.push(c),
        }
    }
    quoted + "\""
}

/// Entries in brackets.
pub(super) fn list(entries: impl IntoIterator<Item = String>) -> String {
    format!("[{}]", entries.into_iter().collect::<Vec<_>>().join(", "))
}

/// A vector; in 1D a number.
pub(super) fn vector(components: &[f64]) -> String {
    match components {
        [only] => format!("{only:?}"),
        all => list(all.iter().map(|x| format!("{x:?}"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_text_comes_back() {
        for text in ["", "left", "a \"b\" \\ c", "\0\t\n\r\u{7f}\u{85}\u{9f}", "é 漢 \u{2028}\u{1f600}"] {
            let document: toml::Table = format!("x = {}", quoted(text)).parse().unwrap();
            assert_eq!(document["x"].as_str(), Some(text));
        }
    }

    #[test]
    fn any_number_comes_back_bit_by_bit() {
        for x in [0.1, -0.0, 5e-324, f64::MAX, 1e16, 1e-7, 70e9, 1.0 / 3.0] {
            let document: toml::Table = format!("x = {x:?}").parse().unwrap();
            assert_eq!(document["x"].as_float().map(f64::to_bits), Some(x.to_bits()), "{x:?}");
        }
    }
}
