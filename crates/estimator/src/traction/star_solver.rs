//! One star problem, solved from face to face, at some levels side by side.

use super::{Equilibration, MassTerm};
use percute_core::ids::{ElementId, NodeId};
use percute_core::simd::lanes::{Value, load};

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

/// How far a star is from compatible.
#[derive(Clone, Copy, Debug)]
pub(super) struct Compatibility<T> {
    /// Largest |Σ η b − r| (N).
    pub(super) miss: T,
    /// Largest term (N).
    pub(super) scale: T,
}

/// The star problem of one node.
pub(super) struct StarSolver<'a, 'p, const D: usize, const N: usize, T: Value> {
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
    pub(super) ends: &'a Ends<D, T>,
}

impl<const D: usize, const N: usize, T: Value> StarSolver<'_, '_, D, N, T> {
    /// Finds the moments: `moments` receives, for each link, the moment that leaves the element before it (and enters,
    /// with the other sign, the one after it).
    #[inline(always)]
    pub(super) fn solve(&self, moments: &mut [[T::Stored; D]]) -> Compatibility<T> {
        let mut scale = self.like().zero();
        let lack = self.along(moments, &mut scale);
        let miss = self.ends.close(&lack, moments);
        for c in 0..D {
            scale = scale.max(scale.load(&moments[0][c]).abs()).max(self.ends.moments[1][c].abs());
        }
        Compatibility { miss, scale }
    }

    /// Any number.
    #[inline(always)]
    fn like(&self) -> T {
        self.ends.moments[0][0]
    }

    /// σ_h in the element at a place.
    #[inline(always)]
    fn stress_at(&self, place: u32) -> [[T; D]; D] {
        let mut stress = [[self.like(); D]; D];
        for (to, from) in stress.iter_mut().zip(&self.stress[place as usize]) {
            *to = load(self.like(), from);
        }
        stress
    }

    /// Finds the moments on all links with one choice of the constant. Returns by how much those
    /// without a known one, all together, fall short of the averaged finite-element traction.
    #[inline(always)]
    fn along(&self, moments: &mut [[T::Stored; D]], scale: &mut T) -> [T; D] {
        let (last, ends, zero) = (self.elements.len(), self.ends, self.like().zero());
        let (mut target_sum, mut sum, mut now) = ([zero; D], [zero; D], [zero; D]);
        let mut here = self.stress_at(self.local[0]);
        let supported = ends.supported[0].contains(&true);
        let entering = if supported { self.moment(0, self.position(0), 0, &here) } else { [zero; D] };
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
            let i = self.position(m);
            let r = self.residual_of(m, i, &here, scale);
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

    /// The local number of the node in an element.
    #[inline(always)]
    fn position(&self, m: usize) -> usize {
        self.all.position(self.elements[m], self.node)
    }

    /// r_i^E = ∫σ_h∇φ_i + mass term − ∫f_dφ_i.
    #[inline(always)]
    fn residual_of(&self, m: usize, i: usize, stress: &[[T; D]; D], scale: &mut T) -> [T; D] {
        let (data, place) = (&self.all.elements[self.elements[m].index()], self.local[m] as usize);
        let mut r = data.internal_force(i, stress);
        for c in 0..D {
            let [inertia, size] = self.mass_term.at(self.like(), place, i, c);
            *scale = scale.max(r[c].abs()).max(size * data.nodal_mass);
            r[c] += inertia * data.nodal_mass;
            if let Some(force) = self.body_force.get(place) {
                r[c] -= self.like().load(&force[c]) * (data.volume / N as f64);
            }
        }
        r
    }

    /// ∫σφ_i n over the face by which the star leaves (1) or enters (0) element `m` of the star, outward:
    /// |e|n/D = −V∇φ_k.
    #[inline(always)]
    fn moment(&self, m: usize, i: usize, exit: usize, stress: &[[T; D]; D]) -> [T; D] {
        let data = &self.all.elements[self.elements[m].index()];
        let Some(k) = self.all.crossing[i][exit] else { return [self.like().zero(); D] };
        let mut moment = data.internal_force(k, stress);
        for f in &mut moment {
            *f = -*f;
        }
        moment
    }

    /// σ_h beyond the face by which the star leaves element `m`; at the boundary that of the element, whose traction
    /// is the finite-element one there.
    #[inline(always)]
    fn next(&self, m: usize, here: &[[T; D]; D]) -> [[T; D]; D] {
        match self.local.get(m + 1) {
            Some(next) => self.stress_at(*next),
            None if self.ends.closed => self.stress_at(self.local[0]),
            None => *here,
        }
    }
}

/// ½(σ_h⁺ + σ_h⁻).
#[inline(always)]
fn mean<T: Value, const D: usize>(here: &[[T; D]; D], next: &[[T; D]; D]) -> [[T; D]; D] {
    let mut mean = *here;
    for a in 0..D {
        for b in 0..D {
            mean[a][b] = (here[a][b] + next[a][b]) * 0.5;
        }
    }
    mean
}
