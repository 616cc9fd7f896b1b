//! Numbers, as words or as bytes.

use std::fmt::Write;

pub(super) struct Sink {
    bytes: Vec<u8>,
    word: String,
    binary: bool,
}

impl Sink {
    pub(super) fn new(binary: bool) -> Self {
        Self { bytes: Vec::new(), word: String::new(), binary }
    }

    pub(super) fn bytes(self) -> Vec<u8> {
        self.bytes
    }

    pub(super) fn is_binary(&self) -> bool {
        self.binary
    }

    /// A line of text, in binary files too.
    pub(super) fn line(&mut self, text: &str) {
        self.bytes.extend_from_slice(text.as_bytes());
        self.bytes.push(b'\n');
    }

    /// The end of a row of numbers, if this is a text.
    pub(super) fn row(&mut self) {
        if !self.binary {
            self.bytes.push(b'\n');
        }
    }

    fn put(&mut self, number: impl std::fmt::Debug, bytes: &[u8]) {
        if self.binary {
            self.bytes.extend_from_slice(bytes);
            return;
        }
        self.word.clear();
        // Writing to a text cannot fail; Debug writes the fewest digits that give the same bits.
        let _ = write!(self.word, "{number:?} ");
        self.bytes.extend_from_slice(self.word.as_bytes());
    }

    /// A whole number of 4 bytes.
    pub(super) fn int(&mut self, number: usize) {
        self.put(number, &(number as u32).to_le_bytes());
    }

    /// A tag or a count of 8 bytes.
    pub(super) fn size(&mut self, number: usize) {
        self.put(number, &(number as u64).to_le_bytes());
    }

    pub(super) fn real(&mut self, number: f64) {
        self.put(number, &number.to_le_bytes());
    }
}
