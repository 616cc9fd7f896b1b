//! Checksums of whole data sets, as attributes of them: those of an estimate file.

use crate::checksum::Checksum;
use crate::error::FileCause;
use hdf5::Dataset;

/// Name of the attribute.
pub(crate) const NAME: &str = "checksum";

/// The checksum of floating-point numbers.
pub(crate) fn of_floats(values: &[f64]) -> Checksum {
    Checksum::new().numbers(values)
}

/// The checksum of whole numbers.
pub(crate) fn of_integers(values: &[i64]) -> Checksum {
    Checksum::new().indices(values.iter().map(|&value| value as usize))
}

/// Compares what was read with the checksum of its data set, if it has one.
pub(crate) fn check(set: &Dataset, name: &str, sum: impl FnOnce() -> Checksum) -> Result<(), FileCause> {
    let Ok(stored) = set.attr(NAME) else { return Ok(()) };
    match stored.read_scalar::<i64>() {
        Ok(stored) if stored == sum().stored() => Ok(()),
        _ => Err(FileCause::Seal { name: name.to_string() }),
    }
}
