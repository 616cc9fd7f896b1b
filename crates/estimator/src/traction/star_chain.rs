//! The star problem of a bar or a plane body, solved from face to face, at some levels side by side.

use super::star_terms::{Compatibility, StarTerms, mean};
use percute_core::simd::lanes::Value;

/// The two ends of a star.
pub(super) struct Ends<const D: usize, T> {
    /// Whether its last face is the first.
    pub(super) closed: bool,
    /// Known outward moments (N); zero where there is none.
    pub(super) moments: [[T; D]; 2],
    /// Components that a support leaves unknown.
    pub(super) supported: [[bool; D]; 2],
}

impl<const D: usize, T: Value> Ends<D, T> {
    /// Whether component `c` of the moment at an end is unknown.
    #[inline(always)]
    fn open(&self, end: usize, c: usize) -> bool {
        self.closed || self.supported[end][c]
    }

    /// Adds the constant to the moments of a star, whose sum lacks so much, and returns by how much the
    /// chain misses where no constant is left (N).
    #[inline(always)]
    pub(super) fn close(&self, lack: &[T; D], moments: &mut [[T::Stored; D]]) -> T {
        let (last, like) = (moments.len() - 1, lack[0]);
        let mut miss = like.zero();
        for c in 0..D {
            let open = [self.open(0, c), self.open(1, c)];
            let [first_moment, last_moment] = [like.load(&moments[0][c]), like.load(&moments[last][c])];
            let shift = match open {
                // The mean over all faces without a known moment.
                [true, true] => Some(lack[c] * (1.0 / (last + usize::from(!self.closed)) as f64)),
                [true, false] => Some(self.moments[1][c] - last_moment),
                _ => None,
            };
            if self.closed {
                miss = miss.worse((last_moment - first_moment).abs());
            } else if open == [false, false] {
                miss = miss.worse((last_moment - self.moments[1][c]).abs());
            }
            if let Some(shift) = shift {
                for f in moments.iter_mut() {
                    f[c] = (like.load(&f[c]) + shift).store();
                }
            }
        }
        miss
    }
}

/// The star problem of a node around which elements form a chain.
pub(super) struct ChainStar<'a, 'p, const D: usize, const N: usize, T: Value> {
    pub(super) terms: StarTerms<'a, 'p, D, N, T>,
    pub(super) ends: &'a Ends<D, T>,
}

impl<const D: usize, const N: usize, T: Value> ChainStar<'_, '_, D, N, T> {
    /// Finds the moments: `moments` receives, for each link, the moment that leaves the element before it (and enters,
    /// with the other sign, the one after it).
    #[inline(always)]
    pub(super) fn solve(&self, moments: &mut [[T::Stored; D]]) -> Compatibility<T> {
        let mut scale = self.terms.like.zero();
        let lack = self.along(moments, &mut scale);
        let miss = self.ends.close(&lack, moments);
        for c in 0..D {
            scale = scale.max(scale.load(&moments[0][c]).abs()).max(self.ends.moments[1][c].abs());
        }
        Compatibility { miss, scale }
    }

    /// Finds the moments on all links with one choice of the constant. Returns by how much those
    /// without a known one, all together, fall short of the averaged finite-element traction.
    #[inline(always)]
    fn along(&self, moments: &mut [[T::Stored; D]], scale: &mut T) -> [T; D] {
        let (last, ends, zero) = (self.terms.elements.len(), self.ends, self.terms.like.zero());
        let (mut target_sum, mut sum, mut now) = ([zero; D], [zero; D], [zero; D]);
        let mut here = self.terms.stress_at(self.terms.local[0]);
        let supported = ends.supported[0].contains(&true);
        let entering = if supported { self.moment(0, self.terms.position(0), 0, &here) } else { [zero; D] };
        for c in 0..D {
            // In a closed chain the first link is the last and counts once.
            if ends.supported[0][c] {
                target_sum[c] -= entering[c];
            } else {
                now[c] = -ends.moments[0][c];
            }
            moments[0][c] = now[c].store();
        }
        for m in 0..last {
            let i = self.terms.position(m);
            let r = self.terms.residual_of(m, i, &here, scale);
            let next = self.next(m, &here);
            let target = self.moment(m, i, 1, &mean(&here, &next));
            for c in 0..D {
                now[c] += r[c];
                moments[m + 1][c] = now[c].store();
                if m + 1 < last || ends.open(1, c) {
                    target_sum[c] += target[c];
                    sum[c] += now[c];
                }
            }
            here = next;
        }
        for c in 0..D {
            target_sum[c] -= sum[c];
        }
        target_sum
    }

    /// ∫σφ_i n over the face by which the star leaves (1) or enters (0) element `m` of the star, outward.
    #[inline(always)]
    fn moment(&self, m: usize, i: usize, exit: usize, stress: &[[T; D]; D]) -> [T; D] {
        match self.terms.all.crossing[i][exit] {
            Some(k) => self.terms.moment(m, k, stress),
            None => [self.terms.like.zero(); D],
        }
    }

    /// σ_h beyond the face by which the star leaves element `m`; at the boundary that of the element, whose traction
    /// is the finite-element one there.
    #[inline(always)]
    fn next(&self, m: usize, here: &[[T; D]; D]) -> [[T; D]; D] {
        match self.terms.local.get(m + 1) {
            Some(next) => self.terms.stress_at(*next),
            None if self.ends.closed => self.terms.stress_at(self.terms.local[0]),
            None => *here,
        }
    }
}
