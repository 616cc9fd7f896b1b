//! One star problem, solved from facet to facet.

use super::{Equilibration, MassTerm};
use crate::residual::worse;
use crate::time_level::TimeLevel;
use percute_core::ids::{ElementId, NodeId};

/// The two ends of a star.
pub(super) struct Ends<const D: usize> {
    /// Whether its last facet is the first.
    pub(super) closed: bool,
    /// Known outward moments (N); zero where there is none.
    pub(super) moments: [[f64; D]; 2],
    /// Components that a support leaves unknown.
    pub(super) supported: [[bool; D]; 2],
}

impl<const D: usize> Ends<D> {
    /// Whether component `c` of the moment at an end is unknown.
    #[inline]
    fn open(&self, end: usize, c: usize) -> bool {
        self.closed || self.supported[end][c]
    }

    /// Adds the constant to the moments of a star, whose sum lacks so much, and returns by how much the
    /// chain misses where no constant is left (N).
    #[inline]
    pub(super) fn close(&self, lack: &[f64; D], moments: &mut [[f64; D]]) -> f64 {
        let last = moments.len() - 1;
        let mut miss: f64 = 0.0;
        for c in 0..D {
            let open = [self.open(0, c), self.open(1, c)];
            let shift = match open {
                // The mean over all facets without a known moment.
                [true, true] => lack[c] / (last + usize::from(!self.closed)) as f64,
                [true, false] => self.moments[1][c] - moments[last][c],
                _ => 0.0,
            };
            if self.closed {
                miss = worse(miss, (moments[last][c] - moments[0][c]).abs());
            } else if open == [false, false] {
                miss = worse(miss, (moments[last][c] - self.moments[1][c]).abs());
            }
            if shift != 0.0 {
                moments.iter_mut().for_each(|f| f[c] += shift);
            }
        }
        miss
    }
}

/// The star problem of one node.
pub(super) struct StarSolver<'a, 'p, const D: usize, const N: usize> {
    pub(super) all: &'a Equilibration<'p, D, N>,
    pub(super) level: &'a TimeLevel<D>,
    /// σ_h of each element (Pa).
    pub(super) stress: &'a [[[f64; D]; D]],
    pub(super) node: NodeId,
    pub(super) mass_term: MassTerm<'a, D>,
    pub(super) elements: &'a [ElementId],
    pub(super) ends: &'a Ends<D>,
}

impl<const D: usize, const N: usize> StarSolver<'_, '_, D, N> {
    /// Finds the moments on all links with one choice of the constant. Returns by how much those
    /// without a known one, all together, fall short of the averaged finite-element traction.
    #[inline]
    pub(super) fn along(&self, moments: &mut [[f64; D]], scale: &mut f64) -> [f64; D] {
        let (last, ends) = (self.elements.len(), self.ends);
        let (mut target_sum, mut sum) = ([0.0; D], [0.0; D]);
        moments[0] = ends.moments[0].map(|b| -b);
        for c in 0..D {
            // In a closed chain the first link is the last and counts once.
            if ends.supported[0][c] {
                moments[0][c] = 0.0;
                target_sum[c] += self.average_before_first()[c];
            }
        }
        for (m, &element) in self.elements.iter().enumerate() {
            let r = self.residual_of(element, scale);
            let target = self.average_after(m);
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

    /// r_i^E = ∫σ_h∇φ_i + mass term − ∫f_dφ_i.
    #[inline]
    fn residual_of(&self, element: ElementId, scale: &mut f64) -> [f64; D] {
        let e = element.index();
        let data = &self.all.elements[e];
        let i = data.nodes.iter().position(|&n| n == self.node).unwrap_or(0);
        let mut r = data.internal_force(i, &self.stress[e]);
        for c in 0..D {
            let [inertia, size] = self.mass_term.at(data, i, c).map(|a| data.nodal_mass * a);
            *scale = scale.max(r[c].abs()).max(size);
            r[c] += inertia;
            if let Some(force) = self.level.body_force.get(e) {
                r[c] -= data.volume / N as f64 * force[c];
            }
        }
        r
    }

    /// ∫σφ_i n over the facet by which the star leaves (1) or enters (0) element `e`, outward:
    /// |e|n/D = −V∇φ_k.
    #[inline]
    fn moment(&self, e: ElementId, exit: usize, stress: &[[f64; D]; D]) -> [f64; D] {
        let data = &self.all.elements[e.index()];
        let i = data.nodes.iter().position(|&n| n == self.node).unwrap_or(0);
        let facet = self.all.crossing[i][exit];
        facet.map_or([0.0; D], |k| data.internal_force(k, stress).map(|f| -f))
    }

    /// Moment of the finite-element traction σ_h·n that enters the first element, from the boundary.
    #[inline]
    fn average_before_first(&self) -> [f64; D] {
        let e = self.elements[0];
        self.moment(e, 0, &self.stress[e.index()]).map(|f| -f)
    }

    /// Moment of the averaged finite-element traction ½(σ_h⁺ + σ_h⁻)·n that leaves element `m` of the
    /// star; on the boundary of σ_h·n.
    #[inline]
    fn average_after(&self, m: usize) -> [f64; D] {
        let e = self.elements[m];
        let here = &self.stress[e.index()];
        let next = match self.elements.get(m + 1) {
            Some(next) => &self.stress[next.index()],
            None if self.ends.closed => &self.stress[self.elements[0].index()],
            None => here,
        };
        let mut mean = *here;
        for a in 0..D {
            for b in 0..D {
                mean[a][b] = 0.5 * (here[a][b] + next[a][b]);
            }
        }
        self.moment(e, 1, &mean)
    }
}
