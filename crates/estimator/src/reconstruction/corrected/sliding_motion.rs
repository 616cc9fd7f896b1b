//! The motion of the nodes of a slave to their master over a step, under the forces of all of them.

use super::motions::{Approach, FreeMotion};
use super::sliding::mobility;
use percute_core::contact::{Coupling, Side, SlidingSurfaces};

/// The motion of the auxiliary solution on two surfaces that slide, over the next step.
#[derive(Debug)]
pub(super) struct SlidingMotion<'a, const D: usize> {
    sliding: &'a SlidingSurfaces<D>,
    coupling: &'a Coupling,
    /// That of the nodes of slave and master, at the next instant under `forces`.
    motions: [Vec<FreeMotion<D>>; 2],
    /// The forces R_k of the nodes of the slave (N).
    forces: Vec<[f64; D]>,
    /// The node of the slave that was asked for last: its force may have changed since.
    asked: usize,
}

impl<'a, const D: usize> SlidingMotion<'a, D> {
    /// From the motions of all contact nodes without a contact force, and the forces on them (N): R_k on slaves.
    pub(super) fn new(
        (sliding, coupling): (&'a SlidingSurfaces<D>, &'a Coupling),
        free: &[FreeMotion<D>],
        forces: &[[f64; D]],
    ) -> Self {
        let of = |side: &Side| (0..side.len()).map(|k| free[side.position(k)]).collect();
        let mut made = Self {
            sliding,
            coupling,
            motions: [of(sliding.slave()), of(sliding.master())],
            forces: vec![[0.0; D]; coupling.len()],
            asked: 0,
        };
        (0..coupling.len()).for_each(|k| made.take_in(k, forces[sliding.slave().position(k)]));
        made
    }

    /// The motion of a node of the slave, by its position in the contact surface, under these forces of the others.
    pub(super) fn approach(&mut self, at: usize, forces: &[[f64; D]]) -> Approach<D> {
        let (slave, master) = (self.sliding.slave(), self.sliding.master());
        self.take_in(self.asked, forces[slave.position(self.asked)]);
        let k = at - slave.position(0);
        self.asked = k;
        let Self { sliding, coupling, motions: [own, other], forces, .. } = &*self;
        let weight = coupling.weight(k);
        let mobility =
            mobility(coupling, k, |node| own[node].mobility, |node| other[node].mobility) / (weight * weight);
        let [now, mut next] = [0, 1].map(|instant| -> [f64; D] {
            std::array::from_fn(|c| {
                let value = |motion: &FreeMotion<D>| motion.displacements[instant][c];
                coupling.difference(k, |node| value(&own[node]), |node| value(&other[node])) / weight
            })
        });
        (0..D).for_each(|c| next[c] -= mobility * forces[k][c]);
        let undeformed = coupling.difference(k, |node| slave.eta()[node], |node| master.eta()[node]) / weight;
        let parts = [now, next].map(|place| sliding.frame().split(&place));
        let [gap_now, gap] = parts.map(|(normal, _)| undeformed + normal);
        Approach { gap_now, gap, along: parts.map(|(_, along)| along), mobility }
    }

    /// Puts a force (N) in the place of that of a node of the slave: D_ki R_k/w_k on the slave, −M_kj R_k/w_k on the
    /// master.
    fn take_in(&mut self, k: usize, force: [f64; D]) {
        let Self { coupling, motions: [own, other], forces, .. } = self;
        if !coupling.is_active(k) {
            return;
        }
        let multiplier: [f64; D] = std::array::from_fn(|c| (force[c] - forces[k][c]) / coupling.weight(k));
        forces[k] = force;
        let push = |motion: &mut FreeMotion<D>, value: f64| {
            (0..D).for_each(|c| motion.displacements[1][c] += motion.mobility * value * multiplier[c]);
        };
        for (at, value) in coupling.slave_row(k).into_iter().enumerate().filter(|(_, value)| *value != 0.0) {
            push(&mut own[k + at - 1], value);
        }
        let (first, row) = coupling.master_row(k);
        row.iter().zip(&mut other[first..]).for_each(|(value, motion)| push(motion, -value));
    }
}
