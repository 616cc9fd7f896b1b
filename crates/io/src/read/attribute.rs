//! Attributes that are texts of variable length. The library takes memory for the length that an attribute states
//! before it looks for the text, and does not tell where the length is in the file. The records of attributes are
//! therefore looked for by their names: version (1 byte), flags (1), sizes of name, type and shape (2 each), from
//! version 3 on the encoding of the name (1); name, type, shape and value.

use super::heap::{is_too_long, places};
use percute_system::read_exact_at;
use std::fs::File;
use std::io;

/// A version of the record, and where the name begins in it.
struct Layout {
    version: u8,
    name: u64,
}

const LAYOUTS: [Layout; 3] =
    [Layout { version: 1, name: 8 }, Layout { version: 2, name: 8 }, Layout { version: 3, name: 9 }];
/// The flag of a type that is stored elsewhere.
const SHARED_TYPE: u8 = 1;
/// Types of variable length, in the lower half of the first byte of a type.
const VARIABLE: u8 = 9;
/// Bytes of the value: length, place of the heap, number of the object.
const VALUE: u64 = 16;

/// Compares the length in all attributes of a name that may be texts of variable length with the size of the file.
///
/// # Errors
/// What is wrong with the attribute; a file that cannot be read.
pub(super) fn check(file: &File, name: &str, bytes: u64) -> io::Result<Result<(), &'static str>> {
    let (mut ended, mut found) = (name.as_bytes().to_vec(), false);
    ended.push(0);
    for name in places(file, bytes, &ended)? {
        for layout in LAYOUTS.iter().filter(|layout| layout.name <= name) {
            let value = layout.value(file, name, ended.len() as u64)?;
            if let Some(value) = value.filter(|value| value + VALUE <= bytes) {
                found = true;
                if is_too_long(file, value, bytes)? {
                    return Ok(Err("is longer than the file"));
                }
            }
        }
    }
    Ok(if found { Ok(()) } else { Err("is stored in a way that percute does not read") })
}

impl Layout {
    /// Where the value of the record would be whose name of so many bytes is at a place.
    fn value(&self, file: &File, name: u64, bytes: u64) -> io::Result<Option<u64>> {
        let mut start = [0; 9];
        let start = &mut start[..self.name as usize];
        read_exact_at(file, start, name - self.name)?;
        let sizes = [2, 4, 6].map(|at| u64::from(u16::from_le_bytes([start[at], start[at + 1]])));
        if start[0] != self.version || sizes[0] != bytes {
            return Ok(None);
        }
        let [size, kind_size, shape_size] = sizes.map(|s| if self.version == 1 { s.next_multiple_of(8) } else { s });
        let mut kind = [0];
        let kind = match read_exact_at(file, &mut kind, name + size) {
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return Ok(None),
            read => read.map(|()| kind[0] & 0x0f)?,
        };
        let elsewhere = self.version > 1 && start[1] & SHARED_TYPE != 0;
        Ok((elsewhere || kind == VARIABLE).then_some(name + size + kind_size + shape_size))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hdf5::types::VarLenUnicode;
    use percute_system::write_all_at;
    use std::path::Path;

    /// A file with so many text attributes, in the oldest or newest layout of the library, which stores more than eight
    /// of them in a heap.
    fn written(path: &Path, count: usize, newest: bool) -> File {
        let mut options = hdf5::File::with_options();
        let file = options.with_fapl(|p| if newest { p.libver_latest() } else { p.libver_earliest() }).create(path);
        let file = file.unwrap();
        let group = file.create_group("percute").unwrap();
        for number in 0..count {
            let name = format!("kind{number}");
            let attribute = group.new_attr::<VarLenUnicode>().create(name.as_str()).unwrap();
            attribute.write_scalar(&"history".parse::<VarLenUnicode>().unwrap()).unwrap();
        }
        file.close().unwrap();
        File::options().read(true).write(true).open(path).unwrap()
    }

    #[test]
    fn lengths_are_found_in_all_layouts() {
        let folder = tempfile::tempdir().unwrap();
        let _alone = crate::library::alone();
        for (count, newest) in [(1, false), (12, false), (1, true), (12, true)] {
            let file = written(&folder.path().join("a.h5"), count, newest);
            let bytes = file.metadata().unwrap().len();
            for number in 0..count {
                let name = format!("kind{number}");
                assert_eq!(check(&file, &name, bytes).unwrap(), Ok(()), "{name} of {count}, {newest}");
                // The length 7, before the place of the heap and the number of the object.
                let place = places(&file, bytes, format!("{name}\0").as_bytes()).unwrap()[0];
                let length =
                    places(&file, bytes, &7_u32.to_le_bytes()).unwrap().into_iter().find(|&at| at > place).unwrap();
                write_all_at(&file, &0xf000_0000_u32.to_le_bytes(), length).unwrap();
                assert_eq!(check(&file, &name, bytes).unwrap(), Err("is longer than the file"), "{name} of {count}");
                write_all_at(&file, &7_u32.to_le_bytes(), length).unwrap();
            }
            assert!(check(&file, "king", bytes).unwrap().is_err());
        }
    }

    /// The same bytes as texts of fixed length are no reference, and the end of a file no record.
    #[test]
    fn other_attributes_are_no_references() {
        let mut record = vec![3, 0, 5, 0, 8, 0, 4, 0, 0];
        record.extend(b"kind\0");
        record.extend([0x19, 1, 0, 0, 16, 0, 0, 0]);
        record.extend([2, 0, 0, 0]);
        record.extend(*b"a text of 16 b..");
        let told = |record: &[u8]| {
            let file = tempfile::tempfile().unwrap();
            write_all_at(&file, record, 0).unwrap();
            check(&file, "kind", record.len() as u64).unwrap()
        };
        assert_eq!(told(&record), Err("is longer than the file"));
        for end in 0..record.len() {
            assert_eq!(told(&record[..end]), Err("is stored in a way that percute does not read"), "{end} bytes");
        }
        record[14] = 0x13;
        assert_eq!(told(&record), Err("is stored in a way that percute does not read"));
        record[1] = SHARED_TYPE;
        assert_eq!(told(&record), Err("is longer than the file"));
    }
}
