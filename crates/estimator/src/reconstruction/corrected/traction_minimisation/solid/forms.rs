//! The energies of the elements of a solid as forms of the moments on their faces.

use crate::stress::MomentForms;
use nalgebra::Matrix3;
use percute_core::ids::ElementId;
use percute_core::problem::Problem;
use percute_core::simd::lanes::{LANES, Lanes, Value};
use rayon::prelude::*;
use std::array::from_fn;

/// Moments of an element: three components at three nodes of four faces, outward, at 9k + 3p + c.
pub(super) const MOMENTS: usize = 36;

/// Numbers of a form: its lower triangle, row by row.
const ENTRIES: usize = MOMENTS * (MOMENTS + 1) / 2;

/// The forms of all elements: ½bᵀFb is the energy (J) of moments b (N) that balance.
#[derive(Clone, Debug)]
pub(super) struct Forms(Vec<[f64; ENTRIES]>);

impl Forms {
    pub(super) fn new<const D: usize>(problem: &Problem<D>) -> Self {
        let mut forms = vec![[0.0; ENTRIES]; problem.mesh().element_count()];
        let (mesh, last) = (problem.mesh(), problem.mesh().element_count() - 1);
        forms.par_chunks_mut(LANES).enumerate().for_each_init(MomentForms::new, |room, (group, forms)| {
            let id = |lane: usize| ElementId::new((group * LANES + lane).min(last));
            let corner = |lane: usize, k: usize| mesh.point(mesh.cell(id(lane))[k]);
            let maps: [Matrix3<f64>; LANES] =
                from_fn(|lane| Matrix3::from_fn(|c, k| corner(lane, k + 1)[c] - corner(lane, 0)[c]));
            let made = room.form(&maps, &from_fn(|lane| problem.material(id(lane))));
            for (lane, form) in forms.iter_mut().enumerate() {
                // Elements are not degenerate.
                let inverse = maps[lane].try_inverse().unwrap_or_else(Matrix3::zeros);
                *form = turned(&inverse, |i, j| made[i.max(j)][i.min(j)].0[lane]);
            }
        });
        Self(forms)
    }

    /// Bytes of the form of an element.
    pub(super) const BYTES: usize = ENTRIES * size_of::<f64>();

    /// An entry.
    pub(super) fn entry(&self, e: usize, i: usize, j: usize) -> f64 {
        let (low, high) = (i.min(j), i.max(j));
        self.0[e][high * (high + 1) / 2 + low]
    }

    /// The product with moments.
    #[inline(always)]
    pub(super) fn product<T: Value<Stored = Lanes>>(&self, like: T, e: usize, moments: &[T; MOMENTS]) -> [T; MOMENTS] {
        let (form, mut product, mut at) = (&self.0[e], [like.zero(); MOMENTS], 0);
        for i in 0..MOMENTS {
            let mut sum = moments[i] * form[at + i];
            for j in 0..i {
                let entry = form[at + j];
                sum += moments[j] * entry;
                product[j] += moments[i] * entry;
            }
            product[i] += sum;
            at += i + 1;
        }
        product
    }
}

/// The lower triangle of a form of moments b, from that of B⁻¹b.
fn turned(inverse: &Matrix3<f64>, entry: impl Fn(usize, usize) -> f64) -> [f64; ENTRIES] {
    let mut form = [0.0; ENTRIES];
    for m in 0..MOMENTS / 3 {
        for n in 0..=m {
            let block = inverse.transpose() * Matrix3::from_fn(|a, b| entry(3 * m + a, 3 * n + b)) * inverse;
            for a in 0..3 {
                let i = 3 * m + a;
                for b in (0..3).filter(|b| 3 * n + b <= i) {
                    form[i * (i + 1) / 2 + 3 * n + b] = block[(a, b)];
                }
            }
        }
    }
    form
}
