//! Attributes that are texts of variable length. The library takes memory for the length that an attribute states
//! before it looks for the text, and does not tell where the length is in the file. It also takes memory for a value
//! of the size that the type states, but reads one of 16 bytes. The records of attributes are therefore looked for by
//! their names: version (1 byte), flags (1), sizes of name, type and shape (2 each), from version 3 on the encoding of
//! the name (1); name, type, shape and value. A type has class and version (1), flags (3) and its size (4).

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
/// The flag of a type that is stored elsewhere, where its size is not known.
const SHARED_TYPE: u8 = 1;
/// Types of variable length, in the lower half of the first byte of a type.
const VARIABLE: u8 = 9;
/// Bytes of the value: length, place of the heap, number of the object.
const VALUE: u64 = 16;

/// Whether texts of variable length of a name can be read, or what is wrong with them.
pub(super) type Found = Result<(), &'static str>;

/// Compares the length in all attributes of these names that may be texts of variable length with the size of the file,
/// and the size of their types with that of a value. The file is read once.
///
/// # Errors
/// A file that cannot be read.
pub(super) fn check(file: &File, names: &[&str], bytes: u64) -> io::Result<Vec<Found>> {
    let ended: Vec<Vec<u8>> = names.iter().map(|name| [name.as_bytes(), &[0]].concat()).collect();
    let all = places(file, bytes, ended.iter().map(Vec::as_slice))?;
    all.iter().zip(&ended).map(|(places, name)| of_name(file, places, name.len() as u64, bytes)).collect()
}

/// The same for one name, which is at these places and has so many bytes with the zero at its end.
fn of_name(file: &File, places: &[u64], length: u64, bytes: u64) -> io::Result<Found> {
    let mut found = false;
    for &name in places {
        for layout in LAYOUTS.iter().filter(|layout| layout.name <= name) {
            let value = layout.value(file, name, length)?;
            if let Some((value, size)) = value.filter(|(value, _)| value + VALUE <= bytes) {
                found = true;
                if size != VALUE {
                    return Ok(Err("has a type of another size"));
                }
                if is_too_long(file, value, bytes)? {
                    return Ok(Err("is longer than the file"));
                }
            }
        }
    }
    Ok(if found { Ok(()) } else { Err("is stored in a way that percute does not read") })
}

impl Layout {
    /// Where the value of the record would be whose name of so many bytes is at a place, and the size of its type.
    fn value(&self, file: &File, name: u64, bytes: u64) -> io::Result<Option<(u64, u64)>> {
        let mut start = [0; 9];
        let start = &mut start[..self.name as usize];
        read_exact_at(file, start, name - self.name)?;
        let sizes = [2, 4, 6].map(|at| u64::from(u16::from_le_bytes([start[at], start[at + 1]])));
        if start[0] != self.version || sizes[0] != bytes {
            return Ok(None);
        }
        let [size, kind_size, shape_size] = sizes.map(|s| if self.version == 1 { s.next_multiple_of(8) } else { s });
        let mut kind = [0; 8];
        match read_exact_at(file, &mut kind, name + size) {
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return Ok(None),
            read => read?,
        }
        let elsewhere = self.version > 1 && start[1] & SHARED_TYPE != 0;
        let value =
            (name + size + kind_size + shape_size, u64::from(u32::from_le_bytes([kind[4], kind[5], kind[6], kind[7]])));
        Ok((!elsewhere && kind[0] & 0x0f == VARIABLE).then_some(value))
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
            let names: Vec<String> = (0..count).map(|number| format!("kind{number}")).collect();
            let told = || check(&file, &names.iter().map(String::as_str).collect::<Vec<_>>(), bytes).unwrap();
            assert_eq!(told(), vec![Ok(()); count], "{count}, {newest}");
            let lengths = places(&file, bytes, [&7_u32.to_le_bytes()[..]]).unwrap().remove(0);
            for (number, name) in names.iter().enumerate() {
                // The length 7, before the place of the heap and the number of the object.
                let place = places(&file, bytes, [format!("{name}\0").as_bytes()]).unwrap()[0][0];
                let length = *lengths.iter().find(|&&at| at > place).unwrap();
                write_all_at(&file, &0xf000_0000_u32.to_le_bytes(), length).unwrap();
                let wrong = |k| if k == number { Err("is longer than the file") } else { Ok(()) };
                assert_eq!(told(), (0..count).map(wrong).collect::<Vec<_>>(), "{name} of {count}");
                write_all_at(&file, &7_u32.to_le_bytes(), length).unwrap();
            }
            assert!(check(&file, &["king"], bytes).unwrap()[0].is_err());
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
            check(&file, &["kind"], record.len() as u64).unwrap()[0]
        };
        assert_eq!(told(&record), Err("is longer than the file"));
        for end in 0..record.len() {
            assert_eq!(told(&record[..end]), Err("is stored in a way that percute does not read"), "{end} bytes");
        }
        let mut other = record.clone();
        other[14] = 0x13;
        assert_eq!(told(&other), Err("is stored in a way that percute does not read"));
        other = record.clone();
        other[1] = SHARED_TYPE;
        assert_eq!(told(&other), Err("is stored in a way that percute does not read"));
        // Memory for a value of 9 bytes, of which 16 are read.
        record[18] = 9;
        assert_eq!(told(&record), Err("has a type of another size"));
    }
}
