//! Problem P_CA of a node of the slave.

use super::record::{Record, Target};
use crate::kinematic::contact_motion::{ContactMotion, NormalStep};
use crate::kinematic::normal_motions::{NormalMotions, Pair};
use crate::residual::Residuals;
use crate::scratch_file::{ScratchError, ScratchFile};

/// x_k over the run: ẋ_k (m/s) and x_k (m) at each instant, with the size of the bodies and the tolerance of distances
/// (m). The residual of its onsets is added.
pub(super) fn solve(
    record: &Record,
    node: usize,
    (target, start): &Target,
    [size, tolerance]: [f64; 2],
    residuals: &mut Residuals,
) -> Result<Vec<Pair>, ScratchError> {
    let (steps, changes) = ((record.count() - 1) / 2, record.changes(node));
    let touches = |n: usize| !changes.partition_point(|&step| step <= n).is_multiple_of(2);
    let mut store = NormalMotions::new(1, 2 * steps, ScratchFile::default());
    let mut track = ContactMotion::new(0, (0.0, size), true, (*start, target[0]), touches(0));
    store.extend()?;
    store.write(0, 0, &[[target[0], *start]])?;
    for n in 1..=steps {
        store.extend()?;
        store.extend()?;
        let step = NormalStep {
            half: record.halves()[2 * n],
            velocity: [target[2 * n - 1], target[2 * n]],
            touching: touches(n),
        };
        track.push(&mut store, &step, tolerance)?;
    }
    track.finish(&mut store, tolerance)?;
    track.report_onset(residuals);
    let mut path = Vec::with_capacity(record.count());
    store.read(0, 0..record.count(), &mut path)?;
    Ok(path)
}
