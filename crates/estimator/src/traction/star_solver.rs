//! One star problem, solved from facet to facet, at some levels side by side.

use super::{Equilibration, MassTerm};
use crate::lanes::Value;
use percute_core::ids::{ElementId, NodeId};

/// The two ends of a star.
pub(super) struct Ends<const D: usize, T> {
    /// Whether its last facet is the first.
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
    pub(super) fn close(&self, lack: &[T; D], moments: &mut [[T; D]]) -> T {
        let last = moments.len() - 1;
        let mut miss = T::ZERO;
        for c in 0..D {
            let open = [self.open(0, c), self.open(1, c)];
            let shift = match open {
                // The mean over all facets without a known moment.
                [true, true] => Some(lack[c] * (1.0 / (last + usize::from(!self.closed)) as f64)),
                [true, false] => Some(self.moments[1][c] - moments[last][c]),
                _ => None,
            };
            if self.closed {
                miss = miss.worse((moments[last][c] - moments[0][c]).abs());
            } else if open == [false, false] {
                miss = miss.worse((moments[last][c] - self.moments[1][c]).abs());
            }
            if let Some(shift) = shift {
                for f in moments.iter_mut() {
                    f[c] += shift;
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
pub(super) struct StarSolver<'a, 'p, const D: usize, const N: usize, T> {
    pub(super) all: &'a Equilibration<'p, D, N>,
    pub(super) node: NodeId,
    pub(super) elements: &'a [ElementId],
    /// The place of each in the fields that follow.
    pub(super) local: &'a [u32],
    /// σ_h (Pa).
    pub(super) stress: &'a [[[T; D]; D]],
    /// f_d (N/m³), empty if there is none.
    pub(super) body_force: &'a [[T; D]],
    pub(super) mass_term: MassTerm<'a, D, N, T>,
    pub(super) ends: &'a Ends<D, T>,
}

impl<const D: usize, const N: usize, T: Value> StarSolver<'_, '_, D, N, T> {
    /// Finds the moments: `moments` receives, for each link, the moment that leaves the element before it (and enters, with
    /// the other sign, the one after it).
    #[inline(always)]
    pub(super) fn solve(&self, moments: &mut [[T; D]]) -> Compatibility<T> {
        let mut scale = T::ZERO;
        let lack = self.along(moments, &mut scale);
        let miss = self.ends.close(&lack, moments);
        for c in 0..D {
            scale = scale.max(moments[0][c].abs()).max(self.ends.moments[1][c].abs());
        }
        Compatibility { miss, scale }
    }

    /// Finds the moments on all links with one choice of the constant. Returns by how much those
    /// without a known one, all together, fall short of the averaged finite-element traction.
    #[inline(always)]
    fn along(&self, moments: &mut [[T; D]], scale: &mut T) -> [T; D] {
        let (last, ends) = (self.elements.len(), self.ends);
        let (mut target_sum, mut sum) = ([T::ZERO; D], [T::ZERO; D]);
        for c in 0..D {
            moments[0][c] = -ends.moments[0][c];
        }
        for c in 0..D {
            // In a closed chain the first link is the last and counts once.
            if ends.supported[0][c] {
                moments[0][c] = T::ZERO;
                target_sum[c] += self.average_before_first()[c];
            }
        }
        for m in 0..last {
            let i = self.position(m);
            let r = self.residual_of(m, i, scale);
            let target = self.average_after(m, i);
            for c in 0..D {
                moments[m + 1][c] = moments[m][c] + r[c];
                if m + 1 < last || ends.open(1, c) {
                    target_sum[c] += target[c];
                    sum[c] += moments[m + 1][c];
                }
            }
        }
        std::array::from_fn(|c| target_sum[c] - sum[c])
    }

    /// The local number of the node in an element.
    #[inline(always)]
    fn position(&self, m: usize) -> usize {
        self.all.position(self.elements[m], self.node)
    }

    /// r_i^E = ∫σ_h∇φ_i + mass term − ∫f_dφ_i.
    #[inline(always)]
    fn residual_of(&self, m: usize, i: usize, scale: &mut T) -> [T; D] {
        let (data, place) = (&self.all.elements[self.elements[m].index()], self.local[m] as usize);
        let mut r = data.internal_force(i, &self.stress[place]);
        for c in 0..D {
            let [inertia, size] = self.mass_term.at(place, i, c);
            *scale = scale.max(r[c].abs()).max(size * data.nodal_mass);
            r[c] += inertia * data.nodal_mass;
            if let Some(force) = self.body_force.get(place) {
                r[c] -= force[c] * (data.volume / N as f64);
            }
        }
        r
    }

    /// ∫σφ_i n over the facet by which the star leaves (1) or enters (0) element `m` of the star, outward:
    /// |e|n/D = −V∇φ_k.
    #[inline(always)]
    fn moment(&self, m: usize, i: usize, exit: usize, stress: &[[T; D]; D]) -> [T; D] {
        let data = &self.all.elements[self.elements[m].index()];
        let Some(k) = self.all.crossing[i][exit] else { return [T::ZERO; D] };
        let mut moment = data.internal_force(k, stress);
        for f in &mut moment {
            *f = -*f;
        }
        moment
    }

    /// Moment of the finite-element traction σ_h·n that enters the first element, from the boundary.
    #[inline(always)]
    fn average_before_first(&self) -> [T; D] {
        self.moment(0, self.position(0), 0, &self.stress[self.local[0] as usize]).map(|f| -f)
    }

    /// Moment of the averaged finite-element traction ½(σ_h⁺ + σ_h⁻)·n that leaves element `m` of the
    /// star; on the boundary of σ_h·n.
    #[inline(always)]
    fn average_after(&self, m: usize, i: usize) -> [T; D] {
        let here = &self.stress[self.local[m] as usize];
        let next = match self.local.get(m + 1) {
            Some(next) => &self.stress[*next as usize],
            None if self.ends.closed => &self.stress[self.local[0] as usize],
            None => here,
        };
        let mut mean = *here;
        for a in 0..D {
            for b in 0..D {
                mean[a][b] = (here[a][b] + next[a][b]) * 0.5;
            }
        }
        self.moment(m, i, 1, &mean)
    }
}
