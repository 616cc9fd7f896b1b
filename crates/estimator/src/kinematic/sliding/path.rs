//! Problem P_CA of a node of the slave.

use super::record::Record;
use crate::kinematic::contact_track::{ContactTrack, NormalStep};
use crate::kinematic::normal_motions::{NormalMotions, Pair};
use crate::residual::Residuals;
use crate::scratch_file::{ScratchError, ScratchFile};

/// A node that touches from the beginning on, and is lifted, rises within so many steps, or within its first phase.
const RISE: usize = 8;

/// The weighted normal motion of a node that its simulation aims at: velocities (m/s) and the gap at t_0 (m).
pub(super) type Target = (Vec<f64>, f64);

/// x_k over the run: ẋ_k (m/s) and x_k (m) at each instant, at rest at the height `lift` (m) in its phases and nowhere
/// below, with the size of the bodies and the tolerance of distances (m). The residual of its onsets is added.
pub(super) fn solve(
    record: &Record,
    node: usize,
    (target, start): &Target,
    lift: f64,
    [size, tolerance]: [f64; 2],
    residuals: &mut Residuals,
) -> Result<Vec<Pair>, ScratchError> {
    let steps = (record.count() - 1) / 2;
    let changes = record.changes(node);
    let risen = match changes {
        [0, rest @ ..] if lift > 0.0 => RISE.min(rest.first().copied().unwrap_or(steps)),
        _ => 0,
    };
    let touches = |n: usize| n >= risen && !changes.partition_point(|&step| step <= n).is_multiple_of(2);
    let gap = start - lift;
    let mut store = NormalMotions::new(1, 2 * steps, ScratchFile::default());
    let mut track = ContactTrack::new(0, (0.0, size), true, (gap, target[0]), touches(0)).descending_to(gap.min(0.0));
    store.extend()?;
    store.write(0, 0, &[[target[0], gap]])?;
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
    path.iter_mut().for_each(|[_, gap]| *gap += lift);
    Ok(path)
}
