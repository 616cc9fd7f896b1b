//! Nodal vectors of the four motions as lanes.

use percute_core::simd::{Eight, Four};
use std::array::from_fn;

/// The motions: the auxiliary solution, the halved-elements solution, the halved-step solution and the contact
/// difference.
pub(super) const MOTIONS: usize = 4;

/// A vector of each motion: the first two motions are the first pair. In one dimension, second components are 0.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Nodal(pub(super) Eight);

/// A vector of each motion of the first pair, whose mass is corrected.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct FirstPair(pub(super) Four);

/// The derivatives of the vectors of the first pair along x, then those along y.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Gradient(pub(super) Eight);

impl Gradient {
    pub(super) const ZERO: Self = Self([0.0; 8]);
}

/// Place of a component of a motion.
#[inline(always)]
pub(super) fn place(motion: usize, component: usize) -> usize {
    4 * (motion / 2) + 2 * component + motion % 2
}

impl Nodal {
    pub(super) const ZERO: Self = Self([0.0; 8]);

    /// The vector of each motion.
    pub(super) fn new<const D: usize>(vectors: [[f64; D]; MOTIONS]) -> Self {
        let mut lanes = Self::ZERO;
        for (m, vector) in vectors.iter().enumerate() {
            vector.iter().enumerate().for_each(|(c, value)| lanes.0[place(m, c)] = *value);
        }
        lanes
    }

    /// The same vector for all motions but the contact difference, which has none.
    #[inline(always)]
    pub(super) fn all_but_contact<const D: usize>(vector: &[f64; D]) -> Self {
        Self::new([*vector, *vector, *vector, [0.0; D]])
    }

    /// That of a motion.
    #[inline(always)]
    pub(super) fn of<const D: usize>(&self, motion: usize) -> [f64; D] {
        from_fn(|c| self.0[place(motion, c)])
    }

    /// Sets a component of all motions.
    #[inline(always)]
    pub(super) fn set(&mut self, component: usize, value: f64) {
        (0..MOTIONS).for_each(|m| self.0[place(m, component)] = value);
    }
}

impl FirstPair {
    pub(super) const ZERO: Self = Self([0.0; 4]);

    /// That of the auxiliary solution.
    #[inline(always)]
    pub(super) fn auxiliary<const D: usize>(&self) -> [f64; D] {
        from_fn(|c| self.0[place(0, c)])
    }

    /// Sets a component of both motions.
    #[inline(always)]
    pub(super) fn set(&mut self, component: usize, value: f64) {
        (0..2).for_each(|m| self.0[place(m, component)] = value);
    }
}
