//! The energy of tetrahedra as a form of the moments on their faces, for some tetrahedra side by side.
//!
//! The energies of the mean stress and of the fluctuation are separate. The first is a form of the forces on the nodes,
//! the second one of the differences of moments on each face, minimised over the free stresses. Both are known of
//! moments that do not balance too, so that the form is that of all 36 moments.

use super::forms::energy_weights;
use super::modes::{FACE_LOADS, FORCES, gram, mean_gram};
use super::reference::FREE;
use crate::stress::elimination::eliminate;
use crate::stress::face_node;
use crate::stress::shapes::ElementShape;
use nalgebra::Matrix3;
use percute_core::material::LinearLaw;
use percute_core::simd::dispatch;
use percute_core::simd::lanes::{LANES, Lanes};

/// Moments on the faces of a tetrahedron: component c at the p-th node of face k is number 9k + 3p + c.
const MOMENTS: usize = 36;

/// Free stresses, and differences of the tractions on the faces.
const COMBINED: usize = FREE + FACE_LOADS;

/// A form of the moments in the frame of the reference tetrahedron, on and below the diagonal.
pub(crate) type MomentForm = [[Lanes; MOMENTS]; MOMENTS];

/// The forms of the last tetrahedra that were asked for.
#[derive(Clone, Debug)]
pub(crate) struct MomentForms {
    lower: Box<[[Lanes; COMBINED]; COMBINED]>,
    mean: Box<[[Lanes; FORCES]; FORCES]>,
    form: Box<MomentForm>,
}

impl MomentForms {
    pub(crate) fn new() -> Self {
        Self {
            lower: Box::new([[Lanes::ZERO; COMBINED]; COMBINED]),
            mean: Box::new([[Lanes::ZERO; FORCES]; FORCES]),
            form: Box::new([[Lanes::ZERO; MOMENTS]; MOMENTS]),
        }
    }

    /// The second derivative of the energy (J) of each tetrahedron in the moments B⁻¹b, from B, whose columns are the
    /// edges (m) from node 0 to the others, and from the law of each.
    pub(crate) fn form<L: LinearLaw>(&mut self, maps: &[Matrix3<f64>; LANES], laws: &[&L; LANES]) -> &MomentForm {
        let shapes: [_; LANES] =
            std::array::from_fn(|lane| ElementShape { map: maps[lane], compliance: laws[lane].compliance::<3>() });
        dispatch(
            #[inline(always)]
            || self.make(&shapes),
        );
        &self.form
    }

    #[inline(always)]
    fn make(&mut self, shapes: &[ElementShape<3>; LANES]) {
        let (weights, fluctuation, mean) = (energy_weights(shapes, 1.0), gram(), mean_gram());
        // The modes of a fluctuation begin with the free stresses and the faces.
        eliminate::<COMBINED, FREE>(
            #[inline(always)]
            |i, j| fluctuation.entry(i, j, &weights),
            &mut self.lower,
        );
        for i in 0..FORCES {
            for j in 0..=i {
                self.mean[i][j] = mean.entry(i, j, &weights);
                self.mean[j][i] = self.mean[i][j];
            }
        }
        for i in 0..MOMENTS {
            for j in 0..=i {
                let [(k, p, a), (l, q, b)] = [i, j].map(|at| (at / 9, at / 3 % 3, at % 3));
                let mut sum = self.mean[3 * face_node::<4>(k, p) + a][3 * face_node::<4>(l, q) + b];
                for (r, sign) in differences(p) {
                    for (s, other) in differences(q) {
                        let (x, y) = (FREE + 6 * k + 3 * r + a, FREE + 6 * l + 3 * s + b);
                        // Differences of tractions are 12 times those of moments.
                        sum += self.lower[x.max(y)][x.min(y)] * (144.0 * sign * other);
                    }
                }
                self.form[i][j] = sum;
            }
        }
    }
}

/// The differences of moments on a face that the moment at its p-th node is part of, with its sign: at the second and
/// at the third node, each less that at the first.
#[inline(always)]
fn differences(p: usize) -> impl Iterator<Item = (usize, f64)> {
    let all = [(0, if p == 0 { -1.0 } else { 1.0 }), (1, if p == 0 { -1.0 } else { 1.0 })];
    all.into_iter().filter(move |(r, _)| p == 0 || p == r + 1)
}

#[cfg(test)]
mod tests;
