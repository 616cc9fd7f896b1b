//! Checksums of whole data sets and of the names in groups, as attributes of them: those of an estimate file.

use crate::checksum::Checksum;
use crate::error::FileCause;
use hdf5::Location;

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

/// The checksum of the names in a group, in any order.
pub(crate) fn of_names(mut names: Vec<String>) -> Checksum {
    names.sort();
    names.iter().fold(Checksum::new(), |sum, name| sum.text(name))
}

/// Compares what was read with the checksum of its data set or group, if it has one.
pub(crate) fn check(set: &Location, name: &str, sum: impl FnOnce() -> Checksum) -> Result<(), FileCause> {
    let Ok(stored) = set.attr(NAME) else { return Ok(()) };
    match stored.read_scalar::<i64>() {
        Ok(stored) if stored == sum().stored() => Ok(()),
        _ => Err(FileCause::Seal { name: name.to_string() }),
    }
}
