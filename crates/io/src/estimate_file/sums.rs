//! Gives the data sets of an estimate file their checksums.

use crate::checksum::Checksum;
use crate::error::FileCause;
use crate::library::refused;
use crate::seal::{NAME, of_floats, of_integers, of_names};
use crate::write::attribute;
use hdf5::Group;
use hdf5::types::TypeDescriptor;

/// Gives each data set of numbers in a group, and in the groups in it, the checksum of what it holds now.
pub(super) fn seal_numbers(group: &Group) -> Result<(), FileCause> {
    let refused = |error: hdf5::Error| refused(&error);
    for set in group.datasets().map_err(refused)? {
        let sum = match set.dtype().and_then(|kind| kind.to_descriptor()).map_err(refused)? {
            TypeDescriptor::Float(_) => of_floats(&set.read_raw::<f64>().map_err(refused)?),
            TypeDescriptor::Integer(_) | TypeDescriptor::Unsigned(_) => {
                of_integers(&set.read_raw::<i64>().map_err(refused)?)
            }
            // Texts are written when the file is closed.
            _ => continue,
        };
        attribute(&set, NAME, sum.stored())?;
    }
    group.groups().map_err(refused)?.iter().try_for_each(seal_numbers)
}

/// Gives a group, and the groups in it, the checksum of the names of what they hold.
pub(super) fn seal_names(group: &Group) -> Result<(), FileCause> {
    let refused = |error: hdf5::Error| refused(&error);
    attribute(group, NAME, of_names(group.member_names().map_err(refused)?).stored())?;
    group.groups().map_err(refused)?.iter().try_for_each(seal_names)
}

/// Gives the data set of a text its checksum.
pub(super) fn seal_text(group: &Group, name: &str, text: &str) -> Result<(), FileCause> {
    let set = group.dataset(name).map_err(|error| refused(&error))?;
    attribute(&set, NAME, Checksum::new().text(text).stored())
}
