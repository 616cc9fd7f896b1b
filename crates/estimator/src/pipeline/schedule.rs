//! The steps that are sampled.
//!
//! With `auto` these are steps at equal distances, those around changes of contact, and peaks of the contact force. η
//! jumps when contact begins or ends, and changes slowly between. A step is judged by the simulation alone, by the
//! steps so far and one that follows: the schedule is that of any window, any number of threads and any later end of
//! the run.

use crate::options::{Options, Reconstruction};
use crate::sampling::Sampling;

/// With `corrected` a change of touching status counts once it affects one in so many of the nodes that touch, or when
/// the body arrives or leaves: F_DA does not depend on this status. That of the other reconstructions begins with it,
/// and each change counts.
const SHARE: usize = 4;
/// A peak of the contact force rises from the valley before it by this part of the largest force so far: fluctuations
/// do not count.
const PROMINENCE: f64 = 0.05;

/// Which levels a step makes samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Decision {
    /// The level before it, which was not one so far.
    pub(super) before: bool,
    /// Its own.
    pub(super) now: bool,
}

/// The steps that are sampled, as they are decided on.
#[derive(Clone, Debug)]
pub(super) struct Schedule {
    spacing: usize,
    /// The last step planned.
    last: usize,
    requested: Vec<usize>,
    /// None if only the number of a step counts.
    contact: Option<ContactChanges>,
    sampled: Vec<usize>,
}

impl Schedule {
    /// That of a run of so many elements and steps.
    pub(super) fn new(options: &Options, elements: usize, last: usize) -> Self {
        Self {
            spacing: options.every.spacing(elements, last),
            last,
            requested: Vec::new(),
            contact: (options.every == Sampling::Auto).then(|| ContactChanges::new(options.reconstruction)),
            sampled: Vec::new(),
        }
    }

    /// Samples these steps as well; they are in increasing order.
    pub(super) fn request(&mut self, steps: &[usize]) {
        self.requested = steps.to_vec();
    }

    /// Takes in step n, with the touching status of the contact nodes and the normal force on them (N). Steps come in
    /// order.
    pub(super) fn advance(&mut self, n: usize, touching: &[bool], force: f64) -> Decision {
        let around = self.contact.as_mut().map(|contact| contact.advance(touching, force)).unwrap_or_default();
        let before = around.before && n > 0 && !self.is_sampled(n - 1);
        if before {
            self.sampled.push(n - 1);
        }
        let regular = n.is_multiple_of(self.spacing) || n == self.last || self.requested.binary_search(&n).is_ok();
        let now = regular || around.now;
        if now {
            self.sampled.push(n);
        }
        Decision { before, now }
    }

    /// Takes in that step n is the last; tells whether it was none of the samples.
    pub(super) fn finish(&mut self, n: usize) -> bool {
        let missed = !self.is_sampled(n);
        if missed {
            self.sampled.push(n);
        }
        missed
    }

    /// Whether a step is a sample, which is certain once the step after it has been taken in.
    pub(super) fn is_sampled(&self, n: usize) -> bool {
        self.sampled.binary_search(&n).is_ok()
    }

    /// Whether contact counts as well.
    pub(super) fn is_automatic(&self) -> bool {
        self.contact.is_some()
    }

    /// All samples so far.
    #[cfg(test)]
    pub(super) fn steps(&self) -> &[usize] {
        &self.sampled
    }
}

/// Whether the steps around a change are samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct ChangeWindow {
    before: bool,
    now: bool,
}

/// The changes of contact so far.
#[derive(Clone, Debug, Default)]
struct ContactChanges {
    /// Whether each change of touching status counts.
    each: bool,
    /// Touching status at the last step.
    touching: Vec<bool>,
    /// Touching status after the last change that counted.
    counted: Vec<bool>,
    /// Whether the last step had such a change.
    changed: bool,
    /// The last two normal forces (N), the later one last.
    force: [f64; 2],
    /// The least force since the last peak that counted, and the largest of all (N).
    range: [f64; 2],
}

impl ContactChanges {
    /// Those that count with a reconstruction.
    fn new(reconstruction: Reconstruction) -> Self {
        Self { each: reconstruction != Reconstruction::Corrected, ..Self::default() }
    }

    /// Takes in a step: the steps before, at and after a change are samples, and the step of a peak.
    fn advance(&mut self, touching: &[bool], force: f64) -> ChangeWindow {
        let changed = self.changes(touching);
        let peak = self.peaks(force);
        let around = ChangeWindow { before: changed || peak, now: changed || self.changed };
        self.changed = changed;
        around
    }

    /// Whether enough nodes have begun or ceased to touch.
    fn changes(&mut self, touching: &[bool]) -> bool {
        if self.touching.is_empty() {
            self.touching = touching.to_vec();
            self.counted = touching.to_vec();
            return false;
        }
        let is_new = self.touching != touching;
        let begins_or_ends = self.touching.contains(&true) != touching.contains(&true);
        self.touching.copy_from_slice(touching);
        let both = || self.counted.iter().zip(touching);
        let different = both().filter(|(counted, now)| counted != now).count();
        let any = both().filter(|&(&counted, &now)| counted || now).count();
        let counts = is_new && (self.each || begins_or_ends || SHARE * different >= any);
        if counts {
            self.counted.copy_from_slice(touching);
        }
        counts
    }

    /// Whether the force had a peak at the step before.
    fn peaks(&mut self, force: f64) -> bool {
        let ([earlier, before], [least, largest]) = (self.force, self.range);
        let peak = before > earlier && before >= force && before - least >= PROMINENCE * largest;
        self.range = [if peak { force } else { least.min(force) }, largest.max(force)];
        self.force = [before, force];
        peak
    }
}

#[cfg(test)]
mod tests;
