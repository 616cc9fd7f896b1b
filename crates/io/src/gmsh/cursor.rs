//! The bytes of a file, read number by number: words of a text or fields of a binary file.

use super::error::{Fault, GmshCause};

/// The representation of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// As words.
    Text,
    /// Binary, as in memory.
    Binary {
        /// Whether the first byte is the most significant one.
        big: bool,
        /// Bytes of a tag or a count in version 4.1.
        size: usize,
    },
}

/// A reading position in a file.
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    pub(super) form: Form,
}

const DAMAGED: &str = "the file is damaged, or was not written by Gmsh";
const SHORT: &str = "the section is shorter than its counts say: the file was cut off or edited";

impl<'a> Cursor<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        // Some editors write a UTF-8 byte order mark at the start.
        let at = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Self { bytes, at, form: Form::Text }
    }

    /// The position of the next byte.
    pub(super) fn at(&self) -> usize {
        self.at
    }

    pub(super) fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.at..).unwrap_or_default()
    }

    /// Reads a number of bytes.
    pub(super) fn take(&mut self, count: usize, what: &'static str) -> Result<&'a [u8], Fault> {
        let taken = self.rest().get(..count).ok_or_else(|| GmshCause::Cut { what }.at(self.at))?;
        self.at += count;
        Ok(taken)
    }

    pub(super) fn skip_space(&mut self) {
        self.at += self.rest().iter().take_while(|b| b.is_ascii_whitespace()).count();
    }

    /// Moves to the next word of a text, the place of an error about it.
    pub(super) fn skip_if_text(&mut self) {
        if self.form == Form::Text {
            self.skip_space();
        }
    }

    /// Reads the rest of the line and its end.
    pub(super) fn line(&mut self) -> &'a [u8] {
        let rest = self.rest();
        let length = rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
        self.at += (length + 1).min(rest.len());
        rest[..length].trim_ascii()
    }

    /// Reads the next word of a text.
    pub(super) fn word(&mut self, what: &'static str) -> Result<&'a str, Fault> {
        self.skip_space();
        let rest = self.rest();
        let length = rest.iter().take_while(|b| !b.is_ascii_whitespace()).count();
        if length == 0 {
            return Err(GmshCause::Cut { what }.at(self.at));
        }
        let word = std::str::from_utf8(&rest[..length]).map_err(|_| self.unexpected(&rest[..length], what))?;
        if word.starts_with('$') {
            return Err(self.unexpected(word.as_bytes(), what));
        }
        self.at += length;
        Ok(word)
    }

    /// The error of an unexpected entry here.
    pub(super) fn unexpected(&self, found: &[u8], what: &'static str) -> Fault {
        Self::fault(found, what, self.at)
    }

    /// The error of an unexpected entry at a byte.
    pub(super) fn fault(found: &[u8], what: &'static str, at: usize) -> Fault {
        let advice = if found.starts_with(b"$") { SHORT } else { DAMAGED };
        GmshCause::Unexpected { found: shown(found), what, advice }.at(at)
    }

    fn parsed<T: std::str::FromStr>(&mut self, what: &'static str) -> Result<T, Fault> {
        let word = self.word(what)?;
        word.parse().map_err(|_| {
            let there = Self { at: self.at - word.len(), ..*self };
            there.unexpected(word.as_bytes(), what)
        })
    }

    /// The bytes of a number, the least significant one first.
    fn field<const B: usize>(&mut self, big: bool, what: &'static str) -> Result<[u8; B], Fault> {
        let taken = self.take(B, what)?;
        let mut field = [0; B];
        field.copy_from_slice(taken);
        if big {
            field.reverse();
        }
        Ok(field)
    }

    /// A whole number: of 4 bytes.
    pub(super) fn int(&mut self, what: &'static str) -> Result<i64, Fault> {
        match self.form {
            Form::Text => self.parsed(what),
            Form::Binary { big, .. } => Ok(i64::from(i32::from_le_bytes(self.field(big, what)?))),
        }
    }

    /// A tag or a count of version 4.1: of 4 or 8 bytes.
    pub(super) fn size(&mut self, what: &'static str) -> Result<u64, Fault> {
        match self.form {
            Form::Text => self.parsed(what),
            Form::Binary { big, size: 4 } => Ok(u64::from(u32::from_le_bytes(self.field(big, what)?))),
            Form::Binary { big, .. } => Ok(u64::from_le_bytes(self.field(big, what)?)),
        }
    }

    /// Any number, finite or not.
    pub(super) fn any_real(&mut self, what: &'static str) -> Result<f64, Fault> {
        match self.form {
            Form::Text => self.parsed(what),
            Form::Binary { big, .. } => Ok(f64::from_le_bytes(self.field(big, what)?)),
        }
    }

    /// A finite number.
    pub(super) fn real(&mut self, what: &'static str) -> Result<f64, Fault> {
        let start = self.at;
        let number = self.any_real(what)?;
        if number.is_finite() {
            return Ok(number);
        }
        let there = Self { at: start, ..*self };
        Err(there.unexpected(number.to_string().as_bytes(), what))
    }

    /// A number of entries, each of at least some numbers, checked against the rest of the file.
    pub(super) fn entries(&self, count: u64, numbers: usize, what: &'static str) -> Result<usize, Fault> {
        // A number takes at least a digit and a space, or four bytes.
        let least = numbers * if self.form == Form::Text { 2 } else { 4 };
        let most = self.rest().len() / least + 1;
        usize::try_from(count).ok().filter(|&n| n <= most).ok_or_else(|| GmshCause::Count { what, count }.at(self.at))
    }
}

/// The beginning of the bytes, in readable form.
pub(super) fn shown(found: &[u8]) -> String {
    let text: String = String::from_utf8_lossy(found).chars().take(30).collect();
    format!("`{}`", text.escape_debug())
}
