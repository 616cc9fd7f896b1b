//! The heaps of texts of variable length, checked before the library reads them: they have no checksums, and an object
//! of a wrong size can keep the library in an endless loop. A text is stored as a reference: its length (4 bytes), the
//! place of its heap (8) and the number of its object (4). The library takes memory for the length before it looks for
//! the object.

use super::superblock::size_of_lengths;
use memchr::memmem;
use percute_system::read_exact_at;
use std::fs::File;
use std::io;

/// First bytes of a heap: its signature and its version. Three reserved bytes follow, which the library ignores.
const SIGNATURE: [u8; 5] = *b"GCOL\x01";
/// The reserved bytes as the library writes them.
const RESERVED: [u8; 3] = [0; 3];
/// Bytes of its header, and of that of an object.
const HEADER: u64 = 16;
/// Most objects of a heap.
const OBJECTS: u32 = u16::MAX as u32;
/// Bytes that are searched at once.
const BLOCK: usize = 1 << 20;

/// Looks for all heaps of a file of so many bytes and follows their objects.
///
/// # Errors
/// What is wrong with a heap; a file that cannot be read.
pub(super) fn check(file: &File, bytes: u64) -> io::Result<Result<(), String>> {
    if size_of_lengths(file)? != 8 {
        return Ok(Err("its texts have a layout that percute does not read".to_string()));
    }
    let mut heaps = Vec::new();
    for place in places(file, bytes, [&SIGNATURE[..]])?.remove(0) {
        if is_heap(file, place, bytes)? {
            if !is_sound(file, place, bytes)? {
                return Ok(Err(format!("the texts of variable length at byte {place}")));
            }
            heaps.push(place);
        }
    }
    let addresses: Vec<[u8; 8]> = heaps.into_iter().map(u64::to_le_bytes).collect();
    for place in places(file, bytes, addresses.iter().map(<[u8; 8]>::as_slice))?.concat() {
        // What has no number of an object behind it is no reference.
        let reference = place >= 4 && place + 12 <= bytes && (1..=OBJECTS).contains(&number(file, place + 8)?);
        if reference && is_too_long(file, place - 4, bytes)? {
            return Ok(Err(format!("the length of a text at byte {}", place - 4)));
        }
    }
    Ok(Ok(()))
}

/// Where each of these bytes are in a file, which is read once.
pub(super) fn places<'w>(
    file: &File,
    bytes: u64,
    wanted: impl IntoIterator<Item = &'w [u8]>,
) -> io::Result<Vec<Vec<u64>>> {
    let finders: Vec<_> = wanted.into_iter().map(memmem::Finder::new).collect();
    let mut found = vec![Vec::new(); finders.len()];
    let Some(longest) = finders.iter().map(|finder| finder.needle().len()).max() else { return Ok(found) };
    let (mut block, mut start) = (vec![0; BLOCK.min(bytes as usize)], 0);
    while start < bytes {
        let length = block.len().min((bytes - start) as usize);
        read_exact_at(file, &mut block[..length], start)?;
        for (finder, found) in finders.iter().zip(&mut found) {
            // The end of a block is the start of the next one: they may begin there.
            let seen = found.last().copied();
            let here = finder.find_iter(&block[..length]).map(|at| start + at as u64);
            found.extend(here.filter(|&at| seen.is_none_or(|seen| at > seen)));
        }
        start += if length < BLOCK { length } else { length - (longest - 1) } as u64;
    }
    Ok(found)
}

/// Whether the number of four bytes at a place, such as the length in a reference, is beyond the end of the file.
pub(super) fn is_too_long(file: &File, place: u64, bytes: u64) -> io::Result<bool> {
    Ok(u64::from(number(file, place)?) > bytes)
}

/// The number of four bytes at a place.
fn number(file: &File, place: u64) -> io::Result<u32> {
    let mut stored = [0; 4];
    read_exact_at(file, &mut stored, place)?;
    Ok(u32::from_le_bytes(stored))
}

/// Whether a signature begins a heap: one whose reserved bytes are damaged has a size that fits into the file, which
/// numbers with these bytes hardly ever have.
fn is_heap(file: &File, place: u64, bytes: u64) -> io::Result<bool> {
    let mut reserved = RESERVED;
    if place + HEADER > bytes {
        return Ok(false);
    }
    read_exact_at(file, &mut reserved, place + SIGNATURE.len() as u64)?;
    Ok(reserved == RESERVED || length(file, place + 8, bytes)? <= bytes - place)
}

/// Whether the objects of a heap follow each other to its end.
fn is_sound(file: &File, place: u64, bytes: u64) -> io::Result<bool> {
    let size = length(file, place + 8, bytes)?;
    if size < HEADER || size > bytes - place {
        return Ok(false);
    }
    let mut at = HEADER;
    while at + HEADER <= size {
        let object = place + at;
        let mut index = [0; 2];
        read_exact_at(file, &mut index, object)?;
        let stored = length(file, object + 8, bytes)?;
        // The free space counts its own header.
        let needed = if index == [0; 2] { Some(stored) } else { padded(stored) };
        match needed.filter(|needed| (HEADER..=size - at).contains(needed)) {
            Some(needed) => at += needed,
            None => return Ok(false),
        }
    }
    Ok(true)
}

/// Bytes of an object with its header.
fn padded(stored: u64) -> Option<u64> {
    stored.checked_next_multiple_of(8)?.checked_add(HEADER)
}

/// A length in the file; one beyond its end is larger than any that fits.
fn length(file: &File, place: u64, bytes: u64) -> io::Result<u64> {
    if place + 8 > bytes {
        return Ok(u64::MAX);
    }
    let mut stored = [0; 8];
    read_exact_at(file, &mut stored, place)?;
    Ok(u64::from_le_bytes(stored))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    /// Bytes of several kinds are found in one pass, those across the ends of blocks once.
    #[test]
    fn places_are_found_once_each() {
        let mut bytes = vec![b'.'; 3 * BLOCK];
        let (short, long) = (b"ab", b"abcdefgh");
        let at = [0, BLOCK - 9, BLOCK - 1, 2 * BLOCK - 20, 3 * BLOCK - 8];
        at.iter().for_each(|&at| bytes[at..at + 8].copy_from_slice(long));
        let mut file = tempfile::tempfile().unwrap();
        file.write_all(&bytes).unwrap();
        let found = places(&file, bytes.len() as u64, [&short[..], long]).unwrap();
        assert_eq!(found, [at.map(|at| at as u64); 2]);
        assert_eq!(places(&file, bytes.len() as u64, []).unwrap(), Vec::<Vec<u64>>::new());
    }

    /// A file with a heap of one text and free space.
    fn heap(change: impl FnOnce(&mut Vec<u8>)) -> Result<(), String> {
        let mut bytes = vec![0; 48];
        bytes[8] = 2;
        bytes[10] = 8;
        let start = bytes.len();
        bytes.extend(SIGNATURE);
        bytes.extend(RESERVED);
        bytes.extend(128_u64.to_le_bytes());
        bytes.extend([1, 0, 0, 0, 0, 0, 0, 0]);
        bytes.extend(11_u64.to_le_bytes());
        bytes.extend([b'a'; 16]);
        bytes.extend([0; 8]);
        bytes.extend(80_u64.to_le_bytes());
        bytes.resize(start + 128, 0);
        change(&mut bytes);
        let mut file = tempfile::tempfile().unwrap();
        file.write_all(&bytes).unwrap();
        check(&file, bytes.len() as u64).unwrap()
    }

    #[test]
    fn references_must_be_shorter_than_the_file() {
        let reference = |length: u32, heap: u64, number: u32| {
            self::heap(|bytes| {
                bytes.extend(length.to_le_bytes());
                bytes.extend(heap.to_le_bytes());
                bytes.extend(number.to_le_bytes());
            })
        };
        assert_eq!(reference(11, 48, 1), Ok(()));
        assert!(reference(0xf000_0000, 48, 1).is_err());
        // Numbers that are none.
        assert_eq!(reference(0xf000_0000, 49, 1), Ok(()));
        assert_eq!(reference(0xf000_0000, 48, 0), Ok(()));
    }

    #[test]
    fn objects_must_follow_each_other_to_the_end() {
        assert_eq!(heap(|_| ()), Ok(()));
        let length = |at: usize, value: u64| heap(|bytes| bytes[at..at + 8].copy_from_slice(&value.to_le_bytes()));
        // The size of the heap; of the text; of the free space, of which 0 is the endless loop.
        for (at, wrong) in [(56, 4096), (56, 8), (72, 200), (72, u64::MAX), (104, 0), (104, 8), (104, 81)] {
            assert!(length(at, wrong).is_err(), "{wrong} at {at}");
        }
        assert!(heap(|bytes| bytes[10] = 4).is_err());
        // The library looks for objects behind damaged reserved bytes, too.
        let damaged = heap(|bytes| {
            bytes[53] = 7;
            bytes[104..112].fill(0);
        });
        assert!(damaged.is_err());
        // Other bytes are no heap.
        assert_eq!(heap(|bytes| bytes[53..64].fill(7)), Ok(()));
        assert_eq!(heap(|bytes| bytes[48] = b'X'), Ok(()));
    }
}
