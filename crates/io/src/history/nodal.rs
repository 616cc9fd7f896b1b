//! Vectors of all nodes that do not change in time.

use crate::error::FileCause;
use crate::read::Part;

/// Reads them.
pub(super) fn nodal<const D: usize>(ours: &Part<'_>, name: &str, nodes: usize) -> Result<Vec<[f64; D]>, FileCause> {
    let data = ours.data(name)?;
    data.expect(&[nodes, D], "(nodes, dimension)")?;
    let values = data.floats()?.as_chunks::<D>().0.to_vec();
    finite(&data.name, &values).map(|()| values)
}

/// Refuses NaN and infinity.
pub(super) fn finite<const D: usize>(name: &str, values: &[[f64; D]]) -> Result<(), FileCause> {
    let wrong = values.iter().enumerate().find_map(|(node, v)| Some((node, *v.iter().find(|x| !x.is_finite())?)));
    match wrong {
        Some((node, value)) => Err(FileCause::NotFinite { name: name.to_string(), step: 0, node, value }),
        None => Ok(()),
    }
}
