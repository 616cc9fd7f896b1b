//! Reading with HDF5: every size is checked against the stored bytes before memory is allocated.

mod attribute;
mod blocks;
mod data;
mod groups;
mod heap;
mod superblock;

pub(crate) use data::Data;
pub use superblock::is_hdf5;

use crate::checksum::Checksum;
use crate::driver::{Driven, DriverFault};
use crate::error::{FileCause, FileError};
use crate::kind::Kind;
use crate::library::{alone, damaged};
use crate::lock::LockedFile;
use crate::seal;
use hdf5::dataset::Layout;
use hdf5::types::{TypeDescriptor, VarLenAscii, VarLenUnicode};
use hdf5::{Container, Group, H5Type};
use percute_system::read_exact_at;
use std::cell::OnceCell;
use std::fs::File;
use std::io;
use std::path::Path;
use std::sync::MutexGuard;

/// The layout of histories and estimates.
pub(crate) const LAYOUT: i64 = 2;

/// The attributes that are texts.
const TEXTS: [&str; 4] = ["kind", "program", "architecture", "system"];

/// Whether texts of variable length can be read.
struct TextSupport {
    /// Or why not.
    heaps: Result<(), String>,
    /// Of the attributes with these names.
    attributes: Vec<attribute::Found>,
}

impl TextSupport {
    fn check(file: &File, bytes: u64) -> io::Result<Self> {
        Ok(Self { heaps: heap::check(file, bytes)?, attributes: attribute::check(file, &TEXTS, bytes)? })
    }
}

/// A file open for reading, with exclusive use of the library.
pub(crate) struct Opened {
    driven: Driven,
    bytes: u64,
    /// Whether texts of variable length can be read; unknown until one is.
    texts: OnceCell<TextSupport>,
    lock: LockedFile,
    /// Dropped last, after the file is closed.
    _alone: MutexGuard<'static, ()>,
}

impl Opened {
    pub(crate) fn new(path: &Path) -> Result<Self, FileCause> {
        let alone = alone();
        let (lock, bytes) = look(path)?;
        let driven = Driven::read(lock.file()).map_err(DriverFault::of_reading)?;
        Ok(Self { driven, bytes, texts: OnceCell::new(), lock, _alone: alone })
    }

    /// Bytes of the file.
    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }

    pub(crate) fn root(&self) -> Part<'_> {
        let Self { driven, bytes, texts, lock, .. } = self;
        let group = (**driven.file()).clone();
        Part { group, name: String::new(), file_bytes: *bytes, file: lock.file(), texts }
    }

    /// History or estimate; any other file is an error with its contents.
    pub(crate) fn kind(&self) -> Result<Kind, FileCause> {
        let root = self.root();
        let Some(ours) = root.optional_group("percute")? else {
            return Err(FileCause::Foreign { holds: root.contents()? });
        };
        match ours.text_attribute("kind")?.as_str() {
            "history" => Ok(Kind::History),
            "estimate" => Ok(Kind::Estimate),
            other => {
                let detail = format!("\"{other}\" is not a known kind of file");
                Err(FileCause::Value { name: "percute.kind".to_string(), detail })
            }
        }
    }

    /// Refuses another kind or another layout.
    pub(crate) fn expect(&self, wanted: Kind) -> Result<(), FileCause> {
        let found = self.kind()?;
        if found != wanted {
            return Err(FileCause::WrongKind { found, wanted });
        }
        let layout = self.root().group("percute")?.integer_attribute("layout")?;
        match layout {
            LAYOUT => Ok(()),
            1.. if layout < LAYOUT => Err(FileCause::OlderLayout { found: layout, known: LAYOUT }),
            1.. => Err(FileCause::NewerLayout { found: layout, known: LAYOUT }),
            _ => {
                let detail = format!("there is no layout {layout}");
                Err(FileCause::Value { name: "percute.layout".to_string(), detail })
            }
        }
    }
}

/// Checks a file without HDF5, whose messages here are poor. Returns the locked file and its size.
fn look(path: &Path) -> Result<(LockedFile, u64), FileCause> {
    let refused = |source: io::Error| match source.kind() {
        io::ErrorKind::NotFound => FileCause::Missing,
        _ => FileCause::Read { source },
    };
    let found = path.metadata().map_err(refused)?;
    if !found.is_file() {
        return Err(FileCause::NotAFile);
    }
    let lock = LockedFile::shared(File::open(path).map_err(refused)?)?;
    if found.len() == 0 {
        return Err(FileCause::Empty);
    }
    if !superblock::begins_as_hdf5(lock.file()).map_err(refused)? {
        return Err(FileCause::NotHdf5);
    }
    if superblock::names_driver(lock.file(), found.len()).map_err(refused)? {
        return Err(FileCause::Damaged { detail: "its first bytes name a file in several parts".to_string() });
    }
    if let Err(detail) = groups::check(lock.file(), found.len()).map_err(refused)? {
        return Err(FileCause::Damaged { detail: detail.to_string() });
    }
    Ok((lock, found.len()))
}

/// A group of the file.
pub(crate) struct Part<'f> {
    group: Group,
    name: String,
    file_bytes: u64,
    file: &'f File,
    texts: &'f OnceCell<TextSupport>,
}

impl<'f> Part<'f> {
    fn path(&self, name: &str) -> String {
        if self.name.is_empty() { name.to_string() } else { format!("{}/{name}", self.name) }
    }

    pub(crate) fn optional_group(&self, name: &str) -> Result<Option<Part<'f>>, FileCause> {
        if !self.group.link_exists(name) {
            return Ok(None);
        }
        let group = self.group.group(name).map_err(damaged)?;
        let Self { file_bytes, file, texts, .. } = *self;
        let part = Part { group, name: self.path(name), file_bytes, file, texts };
        if part.has_attribute(seal::NAME) {
            let names = part.names()?;
            seal::check(&part.group, &part.name, || seal::of_names(names))?;
        }
        Ok(Some(part))
    }

    pub(crate) fn group(&self, name: &str) -> Result<Part<'f>, FileCause> {
        self.optional_group(name)?.ok_or_else(|| FileCause::MissingPart { name: self.path(name) })
    }

    pub(crate) fn optional(&self, name: &str) -> Result<Option<Data<'f>>, FileCause> {
        if !self.group.link_exists(name) {
            return Ok(None);
        }
        if self.group.group(name).is_ok() {
            let given = "a group".to_string();
            return Err(FileCause::Type { name: self.path(name), given, needed: "a data set" });
        }
        let set = self.group.dataset(name).map_err(damaged)?;
        Data::new(set, self.path(name), self.file_bytes, self.file).map(Some)
    }

    pub(crate) fn data(&self, name: &str) -> Result<Data<'f>, FileCause> {
        self.optional(name)?.ok_or_else(|| FileCause::MissingPart { name: self.path(name) })
    }

    /// Names of the members of the group.
    pub(crate) fn names(&self) -> Result<Vec<String>, FileCause> {
        let names = self.group.member_names().map_err(damaged)?;
        // The library assumes UTF-8 names without a check.
        if names.iter().any(|name| std::str::from_utf8(name.as_bytes()).is_err()) {
            return Err(FileCause::Damaged { detail: format!("`{}` holds a name that is not UTF-8", self.name) });
        }
        Ok(names)
    }

    /// The contents of a file of another program.
    fn contents(&self) -> Result<String, FileCause> {
        let mut names = self.names()?;
        names.sort();
        Ok(match names.as_slice() {
            [] => "it is empty".to_string(),
            names if names.iter().any(|n| n == "VTKHDF") => "it is VTKHDF, but has no group `percute`".to_string(),
            [first] => format!("it holds `{first}`"),
            [first, second] => format!("it holds `{first}` and `{second}`"),
            [first, second, ..] => format!("it holds `{first}`, `{second}` and more"),
        })
    }

    fn attribute(&self, name: &str) -> Result<(hdf5::Attribute, String, TypeDescriptor), FileCause> {
        let path = format!("{}.{name}", self.name);
        let attribute = self.group.attr(name).map_err(|_| FileCause::MissingPart { name: path.clone() })?;
        if attribute.size() != 1 {
            return Err(FileCause::Shape { name: path, given: attribute.shape(), needed: "one value".to_string() });
        }
        let kind = attribute.dtype().and_then(|t| t.to_descriptor()).map_err(damaged)?;
        Ok((attribute, path, kind))
    }

    pub(crate) fn has_attribute(&self, name: &str) -> bool {
        self.group.attr(name).is_ok()
    }

    pub(crate) fn integer_attribute(&self, name: &str) -> Result<i64, FileCause> {
        let (attribute, path, kind) = self.attribute(name)?;
        if !matches!(kind, TypeDescriptor::Integer(_) | TypeDescriptor::Unsigned(_)) {
            return Err(FileCause::Type { name: path, given: kind.to_string(), needed: "an integer" });
        }
        Ok(attribute.read_raw::<i64>().map_err(damaged)?[0])
    }

    pub(crate) fn text_attribute(&self, name: &str) -> Result<String, FileCause> {
        let (attribute, path, kind) = self.attribute(name)?;
        if is_variable(&kind) {
            let texts = self.checked_texts()?;
            let found = TEXTS.iter().zip(&texts.attributes).find(|(text, _)| **text == name);
            let fault = |fault| FileCause::Damaged { detail: format!("the text attribute `{path}` {fault}") };
            found.map_or(Ok(()), |(_, found)| *found).map_err(fault)?;
        }
        text(&attribute, &kind, path)
    }

    /// Makes sure that texts of variable length can be read.
    fn checked_texts(&self) -> Result<&'f TextSupport, FileCause> {
        let texts = match self.texts.get() {
            Some(texts) => texts,
            None => {
                let found =
                    TextSupport::check(self.file, self.file_bytes).map_err(|source| FileCause::Read { source })?;
                self.texts.get_or_init(|| found)
            }
        };
        texts.heaps.clone().map_err(|detail| FileCause::Damaged { detail }).map(|()| texts)
    }

    /// A text attribute, empty if missing.
    pub(crate) fn any_text_attribute(&self, name: &str) -> Result<String, FileCause> {
        if self.has_attribute(name) { self.text_attribute(name) } else { Ok(String::new()) }
    }

    /// A text of fixed length, read directly from the file because the bindings limit the length.
    fn fixed(&self, data: &Data<'_>, length: usize) -> Result<String, FileCause> {
        let place = data.set.offset().filter(|place| place.saturating_add(length as u64) <= self.file_bytes);
        let Some(place) = place.filter(|_| data.set.layout() == Layout::Contiguous) else {
            let given = "a text of fixed length in pieces".to_string();
            return Err(FileCause::Type { name: data.name.clone(), given, needed: "a text in one piece" });
        };
        let mut bytes = vec![0; length];
        read_exact_at(self.file, &mut bytes, place).map_err(|source| FileCause::Read { source })?;
        bytes.truncate(bytes.iter().position(|b| *b == 0).unwrap_or(length));
        utf8(bytes, data.name.clone())
    }

    /// A text, if present.
    pub(crate) fn optional_text(&self, name: &str) -> Result<Option<String>, FileCause> {
        let Some(data) = self.optional(name)? else { return Ok(None) };
        if data.shape.iter().product::<usize>() != 1 {
            return Err(FileCause::Shape { name: data.name, given: data.shape, needed: "one text".to_string() });
        }
        if let TypeDescriptor::FixedUnicode(length) | TypeDescriptor::FixedAscii(length) = data.kind {
            let text = self.fixed(&data, length)?;
            seal::check(&data.set, &data.name, || Checksum::new().text(&text))?;
            return Ok(Some(text));
        }
        if is_variable(&data.kind) {
            self.checked_texts()?;
            self.check_length(&data)?;
        }
        text(&data.set, &data.kind, data.name).map(Some)
    }

    /// Makes sure that the library takes no more memory for a text than the file has: it believes any length.
    fn check_length(&self, data: &Data<'_>) -> Result<(), FileCause> {
        if data.set.layout() != Layout::Contiguous {
            let given = "a text of variable length in pieces".to_string();
            return Err(FileCause::Type { name: data.name.clone(), given, needed: "a text in one piece" });
        }
        let Some(place) = data.set.offset() else { return Ok(()) };
        let long = heap::is_too_long(self.file, place, self.file_bytes);
        match long.map_err(|source| FileCause::Read { source })? {
            true => Err(FileCause::Damaged { detail: format!("the length of the text `{}`", data.name) }),
            false => Ok(()),
        }
    }
}

/// Whether it is the type of a text of variable length.
fn is_variable(kind: &TypeDescriptor) -> bool {
    matches!(kind, TypeDescriptor::VarLenUnicode | TypeDescriptor::VarLenAscii)
}

/// A single text of either length.
fn text(stored: &Container, kind: &TypeDescriptor, name: String) -> Result<String, FileCause> {
    /// Longest accepted text of fixed length: names, not documents.
    const MOST: usize = 256;
    type Ascii = hdf5::types::FixedAscii<MOST>;
    type Unicode = hdf5::types::FixedUnicode<MOST>;
    let bytes = match kind {
        TypeDescriptor::VarLenUnicode => one::<VarLenUnicode>(stored)?.as_bytes().to_vec(),
        TypeDescriptor::VarLenAscii => one::<VarLenAscii>(stored)?.as_bytes().to_vec(),
        TypeDescriptor::FixedUnicode(..=MOST) => one::<Unicode>(stored)?.as_bytes().to_vec(),
        TypeDescriptor::FixedAscii(..=MOST) => one::<Ascii>(stored)?.as_bytes().to_vec(),
        _ => return Err(FileCause::Type { name, given: kind.to_string(), needed: "a text" }),
    };
    utf8(bytes, name)
}

fn utf8(bytes: Vec<u8>, name: String) -> Result<String, FileCause> {
    String::from_utf8(bytes).map_err(|_| FileCause::Value { name, detail: "the text is not UTF-8".to_string() })
}

fn one<T: H5Type>(stored: &Container) -> Result<T, FileCause> {
    let mut values = stored.read_raw::<T>().map_err(damaged)?;
    values.pop().ok_or_else(|| FileCause::Damaged { detail: "an empty text".to_string() })
}

/// Runs a read of a file, and adds the path to its errors.
pub(crate) fn reading<T>(path: &Path, read: impl FnOnce(&Opened) -> Result<T, FileCause>) -> Result<T, FileError> {
    Opened::new(path).and_then(|opened| read(&opened)).map_err(|cause| cause.at(path))
}

/// Determines the kind of a file by its first bytes and its attribute `kind`.
///
/// # Errors
/// A file that is missing, locked, damaged or cannot be read.
pub fn kind(path: impl AsRef<Path>) -> Result<Kind, FileError> {
    let path = path.as_ref();
    let found = Opened::new(path).and_then(|opened| opened.kind());
    match found {
        Err(FileCause::NotHdf5 | FileCause::Empty) => Ok(Kind::Other),
        Err(FileCause::Foreign { .. }) => Ok(Kind::OtherHdf5),
        found => found.map_err(|cause| cause.at(path)),
    }
}
