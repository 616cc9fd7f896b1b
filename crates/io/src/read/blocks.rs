//! Small parts of a file, one after the other and hardly ever far from the last ones: the file is read in blocks, which
//! are kept for the next part.

use percute_system::read_exact_at;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::fs::File;
use std::io;

/// Bytes of a block: a page of memory.
const BLOCK: u64 = 4096;
/// Blocks that are kept.
const KEPT: usize = 64;

pub(super) struct Blocks<'f> {
    file: &'f File,
    length: u64,
    kept: HashMap<u64, Vec<u8>>,
}

impl<'f> Blocks<'f> {
    /// Of a file of so many bytes.
    pub(super) fn new(file: &'f File, length: u64) -> Self {
        Self { file, length, kept: HashMap::new() }
    }

    /// Bytes at a place; none if they do not end in the file.
    ///
    /// # Errors
    /// A file that cannot be read, or has become shorter.
    pub(super) fn bytes<const N: usize>(&mut self, place: u64) -> io::Result<Option<[u8; N]>> {
        let mut bytes = [0; N];
        let Some(end) = place.checked_add(N as u64).filter(|&end| end <= self.length) else { return Ok(None) };
        let mut at = place;
        while at < end {
            let part = &self.block(at / BLOCK)?[(at % BLOCK) as usize..];
            let part = &part[..part.len().min((end - at) as usize)];
            bytes[(at - place) as usize..][..part.len()].copy_from_slice(part);
            at += part.len() as u64;
        }
        Ok(Some(bytes))
    }

    /// A block that begins in the file; the last one ends with it.
    fn block(&mut self, number: u64) -> io::Result<&[u8]> {
        if self.kept.len() == KEPT && !self.kept.contains_key(&number) {
            self.kept.clear();
        }
        Ok(match self.kept.entry(number) {
            Entry::Occupied(kept) => kept.into_mut(),
            Entry::Vacant(place) => {
                let start = number * BLOCK;
                let mut block = vec![0; BLOCK.min(self.length - start) as usize];
                read_exact_at(self.file, &mut block, start)?;
                place.insert(block)
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_system::write_all_at;

    /// More blocks than are kept, asked for within, across their ends and at the end of the file; twice, and backwards.
    #[test]
    fn parts_are_those_of_the_file() {
        let length = (KEPT as u64 + 3) * BLOCK + 5;
        let stored: Vec<u8> = (0..length).map(|at| (at % 251) as u8).collect();
        let file = tempfile::tempfile().unwrap();
        write_all_at(&file, &stored, 0).unwrap();
        let mut blocks = Blocks::new(&file, length);
        let ends =
            (0..=length.div_ceil(BLOCK)).flat_map(|block| (0..12).map(move |k| (block * BLOCK + k).saturating_sub(10)));
        let mut places: Vec<u64> = ends.chain([u64::MAX - 3]).collect();
        places.extend(places.clone().into_iter().rev());
        for place in places {
            let wanted = stored.get(usize::try_from(place).unwrap()..).and_then(|rest| rest.first_chunk::<8>());
            assert_eq!(blocks.bytes::<8>(place).unwrap().as_ref(), wanted, "{place}");
            assert!(blocks.kept.len() <= KEPT);
        }
        // What was read is not read again.
        write_all_at(&file, &[255; 8], 0).unwrap();
        assert_eq!(blocks.bytes::<8>(0).unwrap().as_ref(), stored.first_chunk());
        file.set_len(length - 1).unwrap();
        let shorter = Blocks::new(&file, length).bytes::<8>(length - 8).unwrap_err();
        assert_eq!(shorter.kind(), io::ErrorKind::UnexpectedEof);
    }
}
