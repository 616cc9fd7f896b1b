//! Parts of a new file: contiguous data sets with reserved space, and attributes.

use crate::error::FileCause;
use crate::kind::Kind;
use crate::library::refused;
use crate::read::LAYOUT;
use hdf5::dataset::{AllocTime, FillTime, Layout};
use hdf5::plist::link_create::CharEncoding;
use hdf5::types::{FixedUnicode, TypeDescriptor};
use hdf5::{Dataset, Group, H5Type, Location};
use percute_system::write_all_at;
use serde::Serialize;
use std::fs::File;
use std::io;

/// A case file as given, for provenance only.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Case {
    /// Its name.
    pub name: String,
    /// Its text.
    pub text: String,
}

/// Writer of a file, and its machine; empty if unknown.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Provenance {
    /// Program and version.
    pub program: String,
    /// Instruction set, as in `x86_64`.
    pub architecture: String,
    /// Operating system.
    pub system: String,
}

impl Provenance {
    /// Whether any version of percute is the writer.
    #[must_use]
    pub fn is_percute(&self) -> bool {
        self.program.starts_with("percute ")
    }

    /// This program on this machine.
    pub(crate) fn here() -> Self {
        Self {
            program: concat!("percute ", env!("CARGO_PKG_VERSION")).to_string(),
            architecture: std::env::consts::ARCH.to_string(),
            system: std::env::consts::OS.to_string(),
        }
    }
}

type Made<T> = Result<T, FileCause>;

/// A group inside another. It has no times, so that identical runs make identical files.
pub(crate) fn group(parent: &Group, name: &str) -> Made<Group> {
    parent.create_group_builder().obj_track_times(false).create(name).map_err(|error| refused(&error))
}

/// Space for later numbers.
pub(crate) fn room<T: H5Type>(parent: &Group, name: &str, shape: &[usize]) -> Made<Dataset> {
    let set = parent
        .new_dataset::<T>()
        .shape(shape)
        .alloc_time(Some(AllocTime::Early))
        .fill_time(FillTime::Never)
        .no_chunk()
        .layout(Layout::Contiguous)
        .char_encoding(CharEncoding::Utf8)
        .create(name);
    set.map_err(|error| refused(&error))
}

/// Numbers, in the order of memory.
pub(crate) fn numbers<T: H5Type>(parent: &Group, name: &str, shape: &[usize], values: &[T]) -> Made<Dataset> {
    let set = room::<T>(parent, name, shape)?;
    if !values.is_empty() {
        set.write_raw(values).map_err(|error| refused(&error))?;
    }
    Ok(set)
}

/// Texts of a new file with their places. They have a fixed length: texts of variable length lie in a heap
/// without checksums, where one damaged byte can cause an endless loop in the library. The bindings cannot
/// write texts whose length is known at run time only, so they are written after the file is closed.
#[derive(Default)]
pub(crate) struct Texts(Vec<(u64, String)>);

impl Texts {
    /// Reserves space for a text.
    pub(crate) fn add(&mut self, parent: &Group, name: &str, value: &str) -> Made<Dataset> {
        if value.contains('\0') {
            return Err(FileCause::Value { name: name.to_string(), detail: "a text must not hold NUL".to_string() });
        }
        // HDF5 has no texts of length 0.
        let value = if value.is_empty() { "\0" } else { value };
        let set = parent
            .new_dataset_builder()
            .empty_as(TypeDescriptor::FixedUnicode(value.len()))
            .alloc_time(Some(AllocTime::Early))
            .fill_time(FillTime::Never)
            .layout(Layout::Contiguous)
            .create(name)
            .map_err(|error| refused(&error))?;
        self.0.push((offset(&set)?, value.to_string()));
        Ok(set)
    }

    /// Writes the texts.
    pub(crate) fn put(&self, file: &File) -> io::Result<()> {
        self.0.iter().try_for_each(|(place, text)| write_all_at(file, text.as_bytes(), *place))
    }
}

/// The place of a data set in the file.
pub(crate) fn offset(set: &Dataset) -> Made<u64> {
    let missing = || FileCause::Create { source: io::Error::other("the HDF5 library took no room for a data set") };
    set.offset().ok_or_else(missing)
}

/// A short text attribute; a long text is cut to its end.
pub(crate) fn text_attribute(of: &Location, name: &str, value: &str) -> Made<()> {
    const MOST: usize = 64;
    let start = (value.len().saturating_sub(MOST)..=value.len()).find(|&at| value.is_char_boundary(at)).unwrap_or(0);
    let stored: FixedUnicode<MOST> = value[start..]
        .parse()
        .map_err(|_| FileCause::Value { name: name.to_string(), detail: "a text must not hold NUL".to_string() })?;
    attribute(of, name, stored)
}

/// An attribute of one number.
pub(crate) fn attribute<T: H5Type>(of: &Location, name: &str, value: T) -> Made<()> {
    let made = of.new_attr::<T>().create(name).and_then(|attribute| attribute.write_scalar(&value));
    made.map_err(|error| refused(&error))
}

/// The unit of a data set.
pub(crate) fn unit(set: &Dataset, unit: &str) -> Made<()> {
    text_attribute(set, "unit", unit)
}

/// The group `percute` with its attributes.
pub(crate) fn ours(file: &Group, kind: Kind, dimension: usize) -> Made<Group> {
    let ours = group(file, "percute")?;
    text_attribute(&ours, "kind", if kind == Kind::History { "history" } else { "estimate" })?;
    attribute(&ours, "layout", LAYOUT)?;
    attribute(&ours, "dimension", dimension as i64)?;
    let Provenance { program, architecture, system } = Provenance::here();
    for (name, value) in [("program", program), ("architecture", architecture), ("system", system)] {
        text_attribute(&ours, name, &value)?;
    }
    Ok(ours)
}

/// The statement of the problem and the case file.
pub(crate) fn statement(ours: &Group, texts: &mut Texts, statement: &str, case: Option<&Case>) -> Made<()> {
    texts.add(ours, "problem", statement)?;
    if let Some(case) = case {
        texts.add(ours, "case", &case.text)?;
        texts.add(ours, "case_name", &case.name)?;
    }
    Ok(())
}
