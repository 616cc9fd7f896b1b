//! Vectors of all nodes that do not change in time.

use crate::error::FileCause;
use crate::read::Part;

/// Reads them, in rows; `shape` is the number of nodes and the dimension.
pub(super) fn nodal(ours: &Part<'_>, name: &str, shape: [usize; 2]) -> Result<Vec<f64>, FileCause> {
    let data = ours.data(name)?;
    data.expect(&shape, "(nodes, dimension)")?;
    let values = data.floats()?;
    finite(&data.name, &values, shape[1]).map(|()| values)
}

/// Refuses NaN and infinity.
pub(super) fn finite(name: &str, values: &[f64], dimension: usize) -> Result<(), FileCause> {
    match values.iter().position(|x| !x.is_finite()) {
        Some(at) => {
            let (node, value) = (at / dimension, values[at]);
            Err(FileCause::NotFinite { name: name.to_string(), step: 0, node, value })
        }
        None => Ok(()),
    }
}
