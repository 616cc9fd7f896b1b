//! The terms of a star problem: the load of each element at the node, and moments of the finite-element stress.

use super::{Equilibration, MassTerm};
use percute_core::ids::{ElementId, NodeId};
use percute_core::simd::lanes::{Value, load};

/// How far a star is from compatible.
#[derive(Clone, Copy, Debug)]
pub(super) struct Compatibility<T> {
    /// Largest |Σ η b − r| (N).
    pub(super) miss: T,
    /// Largest term (N).
    pub(super) scale: T,
}

/// The star of one node.
pub(super) struct StarTerms<'a, 'p, const D: usize, const N: usize, T: Value> {
    pub(super) all: &'a Equilibration<'p, D, N>,
    pub(super) node: NodeId,
    pub(super) elements: &'a [ElementId],
    /// The place of each in the fields that follow.
    pub(super) local: &'a [u32],
    /// σ_h (Pa).
    pub(super) stress: &'a [[[T::Stored; D]; D]],
    /// f_d (N/m³), empty if there is none.
    pub(super) body_force: &'a [[T::Stored; D]],
    pub(super) mass_term: MassTerm<'a, D, N, T>,
    /// Any number.
    pub(super) like: T,
}

impl<const D: usize, const N: usize, T: Value> StarTerms<'_, '_, D, N, T> {
    /// σ_h in the element at a place.
    #[inline(always)]
    pub(super) fn stress_at(&self, place: u32) -> [[T; D]; D] {
        let mut stress = [[self.like; D]; D];
        for (to, from) in stress.iter_mut().zip(&self.stress[place as usize]) {
            *to = load(self.like, from);
        }
        stress
    }

    /// The local number of the node in an element.
    #[inline(always)]
    pub(super) fn position(&self, m: usize) -> usize {
        self.all.position(self.elements[m], self.node)
    }

    /// r_i^E = ∫σ_h∇φ_i + mass term − ∫f_dφ_i.
    #[inline(always)]
    pub(super) fn residual_of(&self, m: usize, i: usize, stress: &[[T; D]; D], scale: &mut T) -> [T; D] {
        let (data, place) = (&self.all.elements[self.elements[m].index()], self.local[m] as usize);
        let mut r = data.internal_force(i, stress);
        for c in 0..D {
            let [inertia, size] = self.mass_term.at(self.like, place, i, c);
            *scale = scale.max(r[c].abs()).max(size * data.nodal_mass);
            r[c] += inertia * data.nodal_mass;
            if let Some(force) = self.body_force.get(place) {
                r[c] -= self.like.load(&force[c]) * (data.volume / N as f64);
            }
        }
        r
    }

    /// ∫σφ_i n over face `k` of element `m` of the star, outward: |e|n/D = −V∇φ_k.
    #[inline(always)]
    pub(super) fn moment(&self, m: usize, k: usize, stress: &[[T; D]; D]) -> [T; D] {
        let mut moment = self.all.elements[self.elements[m].index()].internal_force(k, stress);
        for f in &mut moment {
            *f = -*f;
        }
        moment
    }
}

/// ½(σ_h⁺ + σ_h⁻).
#[inline(always)]
pub(super) fn mean<T: Value, const D: usize>(here: &[[T; D]; D], next: &[[T; D]; D]) -> [[T; D]; D] {
    let mut mean = *here;
    for a in 0..D {
        for b in 0..D {
            mean[a][b] = (here[a][b] + next[a][b]) * 0.5;
        }
    }
    mean
}
