//! The dynamically admissible fields of an element.

use crate::element::{Link, face_at};
use crate::stress::Loading;
use percute_core::simd::lanes::Value;

/// The fields of an element that tractions and Γ_DA are made of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NodalBalance<const D: usize, const N: usize, T = f64> {
    /// Outward moments of each face at its nodes (N).
    pub(crate) moments: [[[T; D]; D]; N],
    /// ã at the nodes; a_c with `split` (m/s²).
    pub(crate) acceleration: [[T; D]; N],
    /// o₂ at the nodes, which `split` has (m/s²).
    pub(crate) skew: Option<[[T; D]; N]>,
    /// f_d (N/m³).
    pub(crate) body_force: [T; D],
    /// The displacements that are equilibrated (m), of a body that turns.
    pub(crate) displacement: Option<[[T; D]; N]>,
}

/// The dynamically admissible fields of an element at one sample; with finite kinematics F⁻¹ of them, which
/// S_DA = F⁻¹P_DA balances.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Balanced<const D: usize, const N: usize, T = f64> {
    /// Tractions and Γ_DA − f_d.
    pub(crate) loading: Loading<D, N, T>,
    /// Largest component of f_d and of ρã at the nodes (N/m³). Γ_DA − f_d is made of them, and where
    /// they cancel, as in a fall, it does not show how large the terms of the balance are.
    pub(super) terms: T,
    /// Their work on the shape function of each node.
    pub(super) forces: [NodalForce<D, T>; N],
}

/// The forces on one node of an element (N per unit of section or thickness).
#[derive(Clone, Copy, Debug)]
pub(super) struct NodalForce<const D: usize, T> {
    /// Tractions.
    pub(super) outer: [T; D],
    /// Γ_DA − f_d.
    pub(super) inner: [T; D],
}

impl<const D: usize, const N: usize, T: Value> Balanced<D, N, T> {
    /// Half way between two instants, \[57\]–\[58\].
    #[inline(always)]
    pub(crate) fn middle(a: &Self, b: &Self) -> Self {
        Self::combine(
            a,
            b,
            #[inline(always)]
            |x, y| (x + y) * 0.5,
        )
    }

    /// The fields that `number` makes of those of two.
    #[inline(always)]
    pub(crate) fn combine<A: Value, B: Value>(
        a: &Balanced<D, N, A>,
        b: &Balanced<D, N, B>,
        number: impl Fn(A, B) -> T,
    ) -> Self {
        let terms = number(a.terms, b.terms);
        let mut forces = [NodalForce { outer: [terms; D], inner: [terms; D] }; N];
        let mut loading = Loading { traction: [[[terms; D]; D]; N], volume: [[terms; D]; N] };
        for k in 0..N {
            for c in 0..D {
                for p in 0..D {
                    loading.traction[k][p][c] = number(a.loading.traction[k][p][c], b.loading.traction[k][p][c]);
                }
                loading.volume[k][c] = number(a.loading.volume[k][c], b.loading.volume[k][c]);
                forces[k].outer[c] = number(a.forces[k].outer[c], b.forces[k].outer[c]);
                forces[k].inner[c] = number(a.forces[k].inner[c], b.forces[k].inner[c]);
            }
        }
        Self { loading, terms, forces }
    }
}

/// Outward moments of each face of an element at its nodes, from those on the links of each node: those that enter have
/// the other sign.
#[inline(always)]
pub(crate) fn outward<T: Value, const D: usize, const N: usize>(
    links: &[[Link; D]; N],
    around: impl Fn(usize) -> [[T; D]; D],
) -> [[[T; D]; D]; N] {
    let mut moments = [around(0); N];
    for i in 0..N {
        let own = around(i);
        for p in 0..D {
            let k = face_at::<N>(i, p);
            let enters = links[i][p].enters::<D>(k, p);
            for c in 0..D {
                moments[k][p][c] = if enters { -own[p][c] } else { own[p][c] };
            }
        }
    }
    moments
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::cell::{Cell, cell};

    fn check<const D: usize, const N: usize>(kind: &dyn Cell<D, N>) {
        for (i, faces) in kind.faces_around().iter().enumerate() {
            for (exit, face) in faces.iter().enumerate() {
                let Some(k) = *face else { continue };
                let p = (0..D).find(|&p| face_at::<N>(i, p) == k).unwrap();
                assert_eq!(Link::new(7, exit == 0).enters::<D>(k, p), exit == 0, "node {i}, face {k}");
            }
        }
    }

    #[test]
    fn stars_enter_elements_as_the_mesh_says() {
        check(cell::<1, 2>());
        check(cell::<2, 3>());
    }
}
