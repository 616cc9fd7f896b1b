//! Problem P_CA of a node of the slave.

use super::record::{Record, Target};
use crate::kinematic::contact_track::{ContactTrack, NormalStep};
use crate::kinematic::normal_motions::{NormalMotions, Pair};
use crate::residual::Residuals;
use crate::scratch_file::{ScratchError, ScratchFile};

/// How high a node is lifted (m), and by which instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lift {
    pub(super) height: f64,
    pub(super) by: usize,
}

impl Lift {
    pub(super) const NONE: Self = Self { height: 0.0, by: usize::MAX };

    /// Its speed (m/s) and height (m) at each instant at the ends of these half steps (s): it rises evenly.
    fn rise(&self, halves: &[f64]) -> Vec<Pair> {
        let by = self.by.clamp(2, (halves.len() - 1).max(2));
        let time: f64 = (1..by.min(halves.len() - 1)).map(|j| 0.5 * (halves[j] + halves[j + 1])).sum();
        let speed = if self.height > 0.0 { self.height / time } else { 0.0 };
        let (mut height, mut last) = (0.0, 0.0);
        let advance = |(j, half): (usize, &f64)| {
            let now = if j > 0 && j < by { speed } else { 0.0 };
            height += 0.5 * half * (last + now);
            last = now;
            [now, height]
        };
        halves.iter().enumerate().map(advance).collect()
    }
}

/// x_k over the run: ẋ_k (m/s) and x_k (m) at each instant, at rest on the height of its lift in its phases and nowhere
/// below, with the size of the bodies and the tolerance of distances (m). The residual of its onsets is added.
pub(super) fn solve(
    record: &Record,
    node: usize,
    (target, start): &Target,
    lift: Lift,
    [size, tolerance]: [f64; 2],
    residuals: &mut Residuals,
) -> Result<Vec<Pair>, ScratchError> {
    let (steps, changes, rise) = ((record.count() - 1) / 2, record.changes(node), lift.rise(record.halves()));
    let touches = |n: usize| !changes.partition_point(|&step| step <= n).is_multiple_of(2);
    let mut store = NormalMotions::new(1, 2 * steps, ScratchFile::default());
    let mut track = ContactTrack::new(0, (0.0, size), true, (*start, target[0]), touches(0));
    store.extend()?;
    store.write(0, 0, &[[target[0], *start]])?;
    for n in 1..=steps {
        store.extend()?;
        store.extend()?;
        let step = NormalStep {
            half: record.halves()[2 * n],
            velocity: [2 * n - 1, 2 * n].map(|j| target[j] - rise[j][0]),
            touching: touches(n),
        };
        track.push(&mut store, &step, tolerance)?;
    }
    track.finish(&mut store, tolerance)?;
    track.report_onset(residuals);
    let mut path = Vec::with_capacity(record.count());
    store.read(0, 0..record.count(), &mut path)?;
    for (path, rise) in path.iter_mut().zip(rise) {
        (0..2).for_each(|c| path[c] += rise[c]);
    }
    Ok(path)
}
