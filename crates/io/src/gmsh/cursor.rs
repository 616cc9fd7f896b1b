//! The bytes of a file, taken one number after the other: words of a text or fields of a binary file.

use super::error::{Fault, GmshCause};

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// As words.
    Text,
    /// As they are in memory.
    Binary {
        /// Whether the first byte is the most significant one.
        big: bool,
        /// Bytes of a tag or a count in version 4.1.
        size: usize,
    },
}

/// A place in a file, moving on.
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    pub(super) form: Form,
}

const DAMAGED: &str = "the file is damaged, or was not written by Gmsh";
const SHORT: &str = "the section is shorter than its counts say: the file was cut off or edited";

impl<'a> Cursor<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        // Some editors put a mark of UTF-8 before everything.
        let at = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Self { bytes, at, form: Form::Text }
    }

    /// The next byte to be taken.
    pub(super) fn at(&self) -> usize {
        self.at
    }

    pub(super) fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.at..).unwrap_or_default()
    }

    /// Takes so many bytes.
    pub(super) fn take(&mut self, count: usize, what: &'static str) -> Result<&'a [u8], Fault> {
        let taken = self.rest().get(..count).ok_or_else(|| GmshCause::Cut { what }.at(self.at))?;
        self.at += count;
        Ok(taken)
    }

    pub(super) fn skip_space(&mut self) {
        self.at += self.rest().iter().take_while(|b| b.is_ascii_whitespace()).count();
    }

    /// Goes to the next word of a text: there an error about it belongs.
    pub(super) fn skip_if_text(&mut self) {
        if self.form == Form::Text {
            self.skip_space();
        }
    }

    /// Takes the rest of the line and its end.
    pub(super) fn line(&mut self) -> &'a [u8] {
        let rest = self.rest();
        let length = rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
        self.at += (length + 1).min(rest.len());
        rest[..length].trim_ascii()
    }

    /// Takes the next word of a text.
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

    /// The fault of something here that is not what it should be.
    pub(super) fn unexpected(&self, found: &[u8], what: &'static str) -> Fault {
        Self::fault(found, what, self.at)
    }

    /// The fault of something at a byte that is not what it should be.
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

    /// A number of entries that the rest of the file can hold, each of at least so many numbers.
    pub(super) fn entries(&self, count: u64, numbers: usize, what: &'static str) -> Result<usize, Fault> {
        // A number takes at least a digit and a space, or four bytes.
        let least = numbers * if self.form == Form::Text { 2 } else { 4 };
        let most = self.rest().len() / least + 1;
        usize::try_from(count).ok().filter(|&n| n <= most).ok_or_else(|| GmshCause::Count { what, count }.at(self.at))
    }
}

/// The beginning of what is there, so that a person can read it.
pub(super) fn shown(found: &[u8]) -> String {
    let text: String = String::from_utf8_lossy(found).chars().take(30).collect();
    format!("`{}`", text.escape_debug())
}
