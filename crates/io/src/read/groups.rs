//! Groups in the oldest format of HDF5, whose names are in local heaps, checked before the library reads them: the free
//! blocks of a heap form a chain, and one without an end keeps the library in an endless loop that takes all memory.
//! Nor does it compare the sizes in the headers of objects with each other: it reads behind a part that is too short
//! for its messages, and takes memory for a part that is longer than the file. Other damage is left to the library.

use super::blocks::Blocks;
use std::collections::HashSet;
use std::fs::File;
use std::io;

/// Messages of an object header: where it goes on, and the names of a group.
const CONTINUATION: u16 = 0x10;
const SYMBOLS: u16 = 0x11;
/// Bytes of an entry for a name.
const ENTRY: u64 = 40;
/// The end of the chain of free blocks.
const LAST: u64 = 1;

/// A file, and the place from which addresses count.
struct Groups<'f> {
    blocks: Blocks<'f>,
    length: u64,
    base: u64,
    /// Places that were looked at: a damaged file may have circles.
    seen: HashSet<u64>,
    /// Object headers and nodes of the trees of names to be looked at.
    headers: Vec<u64>,
    nodes: Vec<u64>,
}

/// Follows all groups from the first one.
///
/// # Errors
/// What is wrong with them; a file that cannot be read.
pub(super) fn check(file: &File, length: u64) -> io::Result<Result<(), &'static str>> {
    let blocks = Blocks::new(file, length);
    let mut groups = Groups { blocks, length, base: 0, seen: HashSet::new(), headers: Vec::new(), nodes: Vec::new() };
    let Some(first) = groups.bytes::<16>(0)? else { return Ok(Ok(())) };
    // Where the lengths of addresses are, the address from which others count, and that of the first object. Files of
    // versions 2 and 3 may have old groups, too.
    let (lengths, base, object) = match first[8] {
        // Behind four addresses and a place in a heap.
        0 => (13, 24, 24 + 40),
        1 => (13, 28, 28 + 40),
        2 | 3 => (9, 12, 12 + 24),
        _ => return Ok(Ok(())),
    };
    if first[lengths..lengths + 2] != [8, 8] {
        return Ok(Err("its addresses have a length that percute does not read"));
    }
    let object = groups.number(object)?;
    groups.headers.extend(object);
    groups.base = groups.number(base)?.unwrap_or(0);
    groups.follow()
}

impl Groups<'_> {
    fn follow(&mut self) -> io::Result<Result<(), &'static str>> {
        loop {
            if let Some(node) = self.nodes.pop() {
                if self.seen.insert(node) {
                    self.node(node)?;
                }
            } else if let Some(header) = self.headers.pop() {
                if self.seen.insert(header)
                    && let Err(wrong) = self.header(header)?
                {
                    return Ok(Err(wrong));
                }
            } else {
                return Ok(Ok(()));
            }
        }
    }

    /// Bytes at an address; none beyond the end.
    fn bytes<const N: usize>(&mut self, address: u64) -> io::Result<Option<[u8; N]>> {
        match self.base.checked_add(address).map(|place| self.blocks.bytes(place)) {
            None => Ok(None),
            Some(Err(error)) if error.kind() == io::ErrorKind::UnexpectedEof => Ok(None),
            Some(read) => read,
        }
    }

    fn number(&mut self, address: u64) -> io::Result<Option<u64>> {
        Ok(self.bytes(address)?.map(u64::from_le_bytes))
    }

    /// Looks at the messages of an object header, and at its heap, if it has one.
    fn header(&mut self, header: u64) -> io::Result<Result<(), &'static str>> {
        let Some(first) = self.bytes::<16>(header)? else { return Ok(Ok(())) };
        if first[0] != 1 {
            return Ok(Ok(()));
        }
        let length = u64::from(u32::from_le_bytes([first[8], first[9], first[10], first[11]]));
        // A damaged length does not make more messages than the header counts.
        let mut left = u16::from_le_bytes([first[2], first[3]]);
        let mut parts = vec![(header.saturating_add(16), length)];
        while let Some((mut at, length)) = parts.pop() {
            let end = at.saturating_add(length);
            while at.saturating_add(8) <= end && left > 0 {
                left -= 1;
                let Some(head) = self.bytes::<4>(at)? else { break };
                let [kind, size] = [[head[0], head[1]], [head[2], head[3]]].map(u16::from_le_bytes);
                if at + 8 + u64::from(size) > end {
                    return Ok(Err("an object header"));
                }
                if let (CONTINUATION | SYMBOLS, Some([place, other])) = (kind, self.pair(at + 8)?) {
                    match kind {
                        CONTINUATION if place.saturating_add(other) > self.length => {
                            return Ok(Err("an object header"));
                        }
                        CONTINUATION if self.seen.insert(place) => parts.push((place, other)),
                        SYMBOLS if !self.is_sound(other)? => return Ok(Err("the names of a group")),
                        SYMBOLS => self.nodes.push(place),
                        _ => (),
                    }
                }
                at += 8 + u64::from(size);
            }
        }
        Ok(Ok(()))
    }

    fn pair(&mut self, address: u64) -> io::Result<Option<[u64; 2]>> {
        let second = self.number(address.saturating_add(8))?;
        Ok(self.number(address)?.zip(second).map(|(first, second)| [first, second]))
    }

    /// Looks at a node of the tree of names, or at a list of names.
    fn node(&mut self, node: u64) -> io::Result<()> {
        let Some(head) = self.bytes::<8>(node)? else { return Ok(()) };
        let count = u64::from(u16::from_le_bytes([head[6], head[7]]));
        match &head[..4] {
            b"TREE" => {
                // Behind two neighbours, a key before each child.
                for child in 0..count {
                    let Some(child) = self.number(node + 32 + 16 * child)? else { break };
                    self.nodes.push(child);
                }
            }
            b"SNOD" => {
                for entry in 0..count {
                    let Some(header) = self.number(node + 16 + ENTRY * entry)? else { break };
                    self.headers.push(header);
                }
            }
            _ => (),
        }
        Ok(())
    }

    /// Whether the chain of free blocks of a heap has an end.
    fn is_sound(&mut self, heap: u64) -> io::Result<bool> {
        let Some(head) = self.bytes::<32>(heap)? else { return Ok(true) };
        let number = |at: usize| u64::from_le_bytes(std::array::from_fn(|k| head[at + k]));
        let (size, mut free, data) = (number(8), number(16), number(24));
        // The library refuses a heap that is not in the file.
        if self.base.saturating_add(data).saturating_add(size) > self.length {
            return Ok(true);
        }
        let mut passed = HashSet::new();
        while free != LAST && free < size {
            if !passed.insert(free) {
                return Ok(false);
            }
            match self.number(data.saturating_add(free))? {
                Some(next) => free = next,
                None => return Ok(true),
            }
        }
        Ok(true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_system::write_all_at;

    /// Each group, the first one and the deepest, is found, and its chain followed.
    #[test]
    fn chains_without_an_end_are_found_in_all_groups() {
        let folder = tempfile::tempdir().unwrap();
        let _alone = crate::library::alone();
        let path = folder.path().join("a.h5");
        let mut options = hdf5::File::with_options();
        let file = options.with_fapl(|p| p.libver_earliest()).create(&path).unwrap();
        let mut group = file.as_group().unwrap();
        for depth in 0..3 {
            // Many names, so that the trees have several nodes.
            for name in 0..20 {
                group.create_group(&format!("{depth}-{name:02}-{}", "x".repeat(20))).unwrap();
            }
            group = group.create_group("in").unwrap();
        }
        file.close().unwrap();
        drop(group);
        let mut bytes = std::fs::read(&path).unwrap();
        let file = File::options().read(true).write(true).open(&path).unwrap();
        assert_eq!(check(&file, bytes.len() as u64).unwrap(), Ok(()));
        let heaps: Vec<usize> = memchr::memmem::find_iter(&bytes, b"HEAP\0\0\0\0").collect();
        assert_eq!(heaps.len(), 1 + 3 * 21);
        for heap in heaps {
            let number = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap());
            let (free, data) = (number(heap + 16), number(heap + 24));
            if free == LAST {
                continue;
            }
            // The first free block is followed by itself.
            write_all_at(&file, &free.to_le_bytes(), data + free).unwrap();
            assert_eq!(check(&file, bytes.len() as u64).unwrap(), Err("the names of a group"), "the heap at {heap}");
            write_all_at(&file, &bytes[(data + free) as usize..][..8], data + free).unwrap();
        }
        // A header that is too short for its message, and one that goes on behind the end.
        let header =
            bytes.windows(16).position(|found| found[..4] == [1, 0, 1, 0] && found[8..] == [24, 0, 0, 0, 0, 0, 0, 0]);
        let header = header.unwrap();
        write_all_at(&file, &[23], header as u64 + 8).unwrap();
        assert_eq!(check(&file, bytes.len() as u64).unwrap(), Err("an object header"));
        write_all_at(&file, &[24], header as u64 + 8).unwrap();
        let [kind, place] = [header as u64 + 16, header as u64 + 24];
        write_all_at(&file, &[0x10], kind).unwrap();
        write_all_at(&file, &(bytes.len() as u64).to_le_bytes(), place).unwrap();
        assert_eq!(check(&file, bytes.len() as u64).unwrap(), Err("an object header"));
        write_all_at(&file, &bytes, 0).unwrap();
        // Circles of other kinds end, and so does each part of a file.
        for end in (0..bytes.len()).step_by(37).rev() {
            file.set_len(end as u64).unwrap();
            assert_eq!(check(&file, end as u64).unwrap(), Ok(()), "{end} bytes");
        }
        bytes[13] = 4;
        std::fs::write(&path, &bytes).unwrap();
        assert!(check(&file, bytes.len() as u64).unwrap().is_err());
    }

    const FOREIGN: &str = "its addresses have a length that percute does not read";

    /// A file of the oldest format with its first bytes in the format of one of the four versions. What follows them is
    /// where it was, or, with a base, so many bytes later: addresses count from there.
    fn as_version(old: &[u8], version: u8, base: u64) -> Vec<u8> {
        let (fixed, root) = (&old[..8], &old[64..72]);
        let numbers = |numbers: [u64; 3]| numbers.map(u64::to_le_bytes).concat();
        let all = [base, u64::MAX, old.len() as u64 + base];
        let mut first = match version {
            0 | 1 => {
                let mut first = [fixed, &[version, 0, 0, 0, 0, 8, 8, 0, 4, 0, 16, 0, 0, 0, 0, 0]].concat();
                first.extend_from_slice(if version == 1 { &[32, 0, 0, 0] } else { &[] });
                [first, numbers(all), u64::MAX.to_le_bytes().to_vec(), vec![0; 8]].concat()
            }
            _ => [fixed, &[version, 8, 8, 0], &numbers(all)].concat(),
        };
        first.extend_from_slice(root);
        let mut bytes = old.to_vec();
        bytes.splice(0..0, vec![0; base as usize]);
        bytes[..first.len()].copy_from_slice(&first);
        bytes
    }

    /// All versions of the first bytes lead to the groups, and to what is wrong with them.
    #[test]
    fn groups_are_found_behind_each_superblock() {
        let folder = tempfile::tempdir().unwrap();
        let _alone = crate::library::alone();
        let path = folder.path().join("a.h5");
        let mut options = hdf5::File::with_options();
        let file = options.with_fapl(|p| p.libver_earliest()).create(&path).unwrap();
        file.create_group("a").unwrap().create_group("b").unwrap();
        file.close().unwrap();
        let old = std::fs::read(&path).unwrap();
        assert_eq!((old[8], as_version(&old, 0, 0)[..72] == old[..72]), (0, true));
        let told = |bytes: &[u8]| {
            std::fs::write(&path, bytes).unwrap();
            check(&File::open(&path).unwrap(), bytes.len() as u64).unwrap()
        };
        for (version, base) in (0..4).flat_map(|version| [(version, 0), (version, 512)]) {
            let bytes = as_version(&old, version, base);
            assert_eq!(told(&bytes), Ok(()), "version {version}, base {base}");
            // The last heap is that of the deepest group.
            let heap = memchr::memmem::rfind(&bytes, b"HEAP\0\0\0\0").unwrap();
            let number = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap());
            let (size, free, data) = (number(heap + 8), number(heap + 16), number(heap + 24) + base);
            let changed = |at: u64, value: u64| {
                let mut bytes = bytes.clone();
                bytes[at as usize..at as usize + 8].copy_from_slice(&value.to_le_bytes());
                told(&bytes)
            };
            assert_eq!(changed(data + free, free), Err("the names of a group"), "version {version}, base {base}");
            // A chain ends with its mark, or behind the heap; a heap that is not in the file is left to the library.
            for end in [LAST, size, u64::MAX] {
                assert_eq!(changed(data + free, end), Ok(()), "{end}");
            }
            let mut beyond = bytes.clone();
            beyond[(data + free) as usize..][..8].copy_from_slice(&free.to_le_bytes());
            beyond[heap + 8..heap + 16].copy_from_slice(&(bytes.len() as u64 - data + 1).to_le_bytes());
            assert_eq!(told(&beyond), Ok(()));
            beyond[heap + 8..heap + 16].copy_from_slice(&(bytes.len() as u64 - data).to_le_bytes());
            assert_eq!(told(&beyond), Err("the names of a group"), "it ends with the file");
            // Lengths of addresses, where this version has them.
            for at in if version < 2 { [13, 14] } else { [9, 10] } {
                let mut bytes = bytes.clone();
                bytes[at] = 4;
                assert_eq!(told(&bytes), Err(FOREIGN), "version {version}");
            }
        }
        // Later versions are left to the library, and so are addresses beyond all files.
        assert_eq!(told(&as_version(&old, 4, 0)), Ok(()));
        let mut bytes = as_version(&old, 2, 0);
        for base in [u64::MAX, u64::MAX - 100, 1 << 62] {
            bytes[12..20].copy_from_slice(&base.to_le_bytes());
            assert_eq!(told(&bytes), Ok(()), "{base}");
        }
    }

    /// The parts of a header reach to the end of the file, and not one byte further; its messages to the end of their
    /// part.
    #[test]
    fn parts_of_headers_must_fit() {
        const HEADER: usize = 48;
        let told = |part: (u64, u64), message: u16| {
            let mut bytes = vec![0; 200];
            bytes[..HEADER].copy_from_slice(
                &[&b"\x89HDF\r\n\x1a\n\x02\x08\x08\0"[..], &[0; 24], &(HEADER as u64).to_le_bytes(), &[0; 4]].concat(),
            );
            // Two messages, the second behind the continuation.
            bytes[HEADER..HEADER + 12].copy_from_slice(&[1, 0, 2, 0, 1, 0, 0, 0, 24, 0, 0, 0]);
            bytes[HEADER + 16..HEADER + 20].copy_from_slice(&[0x10, 0, 16, 0]);
            bytes[HEADER + 24..HEADER + 32].copy_from_slice(&part.0.to_le_bytes());
            bytes[HEADER + 32..HEADER + 40].copy_from_slice(&part.1.to_le_bytes());
            bytes[162..164].copy_from_slice(&message.to_le_bytes());
            let file = tempfile::tempfile().unwrap();
            write_all_at(&file, &bytes, 0).unwrap();
            check(&file, bytes.len() as u64).unwrap()
        };
        for fits in [(160, 40), (160, 8), (199, 1), (200, 0)] {
            assert_eq!(told(fits, 0), Ok(()), "{fits:?}");
        }
        for beyond in [(160, 41), (160, u64::MAX), (u64::MAX, 40), (201, 0), (1 << 63, 1 << 63)] {
            assert_eq!(told(beyond, 0), Err("an object header"), "{beyond:?}");
        }
        assert_eq!((told((160, 40), 32), told((160, 40), 33)), (Ok(()), Err("an object header")));
    }
}
