//! Data sets: shapes checked against what is stored, numbers converted by HDF5.

use crate::error::FileCause;
use crate::library::damaged;
use crate::seal;
use hdf5::dataset::Layout;
use hdf5::types::TypeDescriptor;
use hdf5::{Dataset, H5Type, Hyperslab, Selection, SliceOrIndex};
use std::fs::File;
use std::ops::Range;

/// Deflate makes at most 1032 bytes from one; other filters of HDF5 make less.
const MOST_EXPANSION: u64 = 1032;

/// A data set whose stored bytes are known to fill its shape.
pub(crate) struct Data<'f> {
    pub(super) set: Dataset,
    pub(crate) name: String,
    pub(crate) shape: Vec<usize>,
    pub(super) kind: TypeDescriptor,
    /// It must be closed first.
    _file: &'f File,
}

impl<'f> Data<'f> {
    pub(super) fn new(set: Dataset, name: String, file_bytes: u64, file: &'f File) -> Result<Self, FileCause> {
        let shape = set.get_shape().map_err(damaged)?;
        let datatype = set.dtype().map_err(damaged)?;
        let kind = datatype.to_descriptor().map_err(|_| FileCause::Type {
            name: name.clone(),
            given: format!("values of {} bytes of a type that cannot be read, such as float16", datatype.size()),
            needed: "floating-point numbers of 32 or 64 bits, or whole numbers (with h5py, `astype(\"f8\")`)",
        })?;
        let chunk = set.chunk().unwrap_or_default();
        let stored = set.storage_size();
        let most = match set.layout() {
            Layout::Chunked => stored.saturating_mul(MOST_EXPANSION),
            _ => stored,
        };
        let size = |shape: &[usize]| {
            let each = shape.iter().try_fold(1_u64, |n, &d| n.checked_mul(d as u64))?;
            each.checked_mul(datatype.size() as u64)
        };
        let fits = |shape: &[usize]| size(shape).is_some_and(|bytes| bytes <= most);
        // The product of an empty shape must not overflow either, because HDF5 computes it.
        let sane = shape.iter().try_fold(1_usize, |n, &d| n.checked_mul(d.max(1))).is_some();
        if stored > file_bytes || !fits(&shape) || !sane || (!chunk.is_empty() && stored > 0 && !fits(&chunk)) {
            return Err(FileCause::Hollow { name, given: shape, stored: stored.min(file_bytes) });
        }
        Ok(Self { set, name, shape, kind, _file: file })
    }

    fn refuse_type<T>(&self, needed: &'static str) -> Result<T, FileCause> {
        Err(FileCause::Type { name: self.name.clone(), given: self.kind.to_string(), needed })
    }

    /// Refuses another shape; `needed` describes the right one.
    pub(crate) fn expect(&self, shape: &[usize], needed: &str) -> Result<(), FileCause> {
        if self.shape == shape {
            return Ok(());
        }
        let needed = format!("{shape:?}, {needed}");
        Err(FileCause::Shape { name: self.name.clone(), given: self.shape.clone(), needed })
    }

    /// Refuses another number of dimensions.
    pub(crate) fn expect_dimensions(&self, count: usize, needed: &str) -> Result<(), FileCause> {
        if self.shape.len() == count {
            return Ok(());
        }
        Err(FileCause::Shape { name: self.name.clone(), given: self.shape.clone(), needed: needed.to_string() })
    }

    pub(crate) fn floats(&self) -> Result<Vec<f64>, FileCause> {
        self.check_floats()?;
        let values = self.all()?;
        // The numbers are sealed as they are stored.
        match self.kind {
            TypeDescriptor::Float(_) => seal::check(&self.set, &self.name, || seal::of_floats(&values))?,
            _ => self.integers().map(drop)?,
        }
        Ok(values)
    }

    /// Complete rows: one row for each index of the first dimension.
    pub(crate) fn float_rows(&self, rows: Range<usize>) -> Result<Vec<f64>, FileCause> {
        self.check_floats()?;
        self.rows(rows)
    }

    pub(crate) fn check_floats(&self) -> Result<(), FileCause> {
        match self.kind {
            TypeDescriptor::Float(_) | TypeDescriptor::Integer(_) | TypeDescriptor::Unsigned(_) => Ok(()),
            _ => self.refuse_type("floating-point numbers"),
        }
    }

    pub(crate) fn integers(&self) -> Result<Vec<i64>, FileCause> {
        match self.kind {
            TypeDescriptor::Integer(_) | TypeDescriptor::Unsigned(_) => {
                let values = self.all()?;
                seal::check(&self.set, &self.name, || seal::of_integers(&values))?;
                Ok(values)
            }
            _ => self.refuse_type("integers"),
        }
    }

    /// Complete rows of whole numbers.
    pub(crate) fn integer_rows(&self, rows: Range<usize>) -> Result<Vec<i64>, FileCause> {
        match self.kind {
            TypeDescriptor::Integer(_) | TypeDescriptor::Unsigned(_) => self.rows(rows),
            _ => self.refuse_type("integers"),
        }
    }

    /// Indices below `count`.
    pub(crate) fn indices(&self, count: usize, of: &str) -> Result<Vec<usize>, FileCause> {
        let values = self.integers()?;
        let good = |&v: &i64| usize::try_from(v).ok().filter(|&v| v < count);
        if let Some(at) = values.iter().position(|v| good(v).is_none()) {
            let detail = format!("entry {at} is {}, but there are {count} {of}, counted from 0", values[at]);
            return Err(FileCause::Value { name: self.name.clone(), detail });
        }
        Ok(values.iter().filter_map(good).collect())
    }

    /// Rows of 0 and 1, or of booleans of h5py.
    pub(crate) fn flag_rows(&self, rows: Range<usize>) -> Result<Vec<bool>, FileCause> {
        match self.kind {
            // Never as `bool`, because other bytes than 0 and 1 are invalid there.
            TypeDescriptor::Boolean | TypeDescriptor::Integer(_) | TypeDescriptor::Unsigned(_) => {
                let values: Vec<i64> = self.rows(rows)?;
                if let Some(wrong) = values.iter().find(|v| !(0..=1).contains(*v)) {
                    let detail = format!("{wrong} is neither 0 nor 1");
                    return Err(FileCause::Value { name: self.name.clone(), detail });
                }
                Ok(values.into_iter().map(|v| v == 1).collect())
            }
            _ => self.refuse_type("integers 0 and 1, or booleans"),
        }
    }

    fn refuse_scalar<T>(&self) -> Result<T, FileCause> {
        let needed = "rows, one for each instant or node".to_string();
        Err(FileCause::Shape { name: self.name.clone(), given: Vec::new(), needed })
    }

    fn all<T: H5Type>(&self) -> Result<Vec<T>, FileCause> {
        self.room::<T>(self.shape.iter().product())?;
        self.set.read_raw().map_err(damaged)
    }

    fn rows<T: H5Type>(&self, rows: Range<usize>) -> Result<Vec<T>, FileCause> {
        let Some(of_row) = self.shape.get(1..) else { return self.refuse_scalar() };
        let row: usize = of_row.iter().product();
        self.room::<T>(rows.len().saturating_mul(row))?;
        let mut slab = vec![SliceOrIndex::from(rows)];
        slab.extend(of_row.iter().map(|_| SliceOrIndex::from(..)));
        let selection = Selection::from(Hyperslab::from(slab));
        let values = self.set.read_slice::<T, _, ndarray::IxDyn>(selection).map_err(damaged)?;
        Ok(values.into_raw_vec_and_offset().0)
    }

    /// Reserves the memory of the library in advance, so that a lack of memory is an error.
    fn room<T>(&self, count: usize) -> Result<(), FileCause> {
        let bytes = (count as u64).saturating_mul(size_of::<T>() as u64);
        let large = |_| FileCause::TooLarge { name: self.name.clone(), bytes };
        Vec::<T>::new().try_reserve_exact(count).map_err(large)
    }

    /// Offset in the file, if the data are contiguous numbers of type `T` as in memory.
    pub(crate) fn native_offset<T: H5Type>(&self) -> Result<Option<u64>, FileCause> {
        let native = hdf5::Datatype::from_type::<T>().map_err(damaged)?;
        let same = self.set.dtype().map_err(damaged)? == native;
        Ok(self.set.offset().filter(|_| same && self.set.layout() == Layout::Contiguous))
    }
}
