//! The stress of the hats of one node in one element.

use super::star_stress::StarStress;
use crate::stress::LOADS;
use std::iter::zip;

/// The frame of the forms of a star: its first axis in global axes. Stars that are turned have the same forms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StarFrame(pub(crate) [f64; 2]);

impl StarFrame {
    /// The components of a vector in the frame.
    #[inline]
    pub(crate) fn own(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [cos, sin] = self.0;
        [cos * x + sin * y, cos * y - sin * x]
    }

    /// The global components of a vector.
    #[inline]
    pub(crate) fn global(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [cos, sin] = self.0;
        [cos * x - sin * y, cos * y + sin * x]
    }
}

/// Numbers for the loads of an element whose first corner is the node of the star, as those for the loads of the
/// element, which has this corner there; `frame` is that of the vectors.
pub(super) fn in_element(own: &[f64; LOADS], at: usize, frame: StarFrame) -> [f64; LOADS] {
    let mut all = [0.0; LOADS];
    // Vectors at both ends of three faces, then at three nodes.
    for (first, each) in [(0, 2), (6, 1)] {
        for k in 0..3 * each {
            let from = 2 * (first + k);
            let to = 2 * (first + (k + each * at) % (3 * each));
            all[to..to + 2].copy_from_slice(&frame.global([own[from], own[from + 1]]));
        }
    }
    all
}

/// The stress τ of hats, as a sum of those of unit hats.
#[derive(Clone, Debug)]
pub(crate) struct HatStress<'a> {
    /// Those of unit hats.
    pub(crate) star: &'a StarStress,
    pub(crate) frame: StarFrame,
    /// Position of the element in the star.
    pub(crate) element: usize,
    /// The corner of the element at the node.
    pub(crate) at: usize,
    /// Places of the hats in these forms, and their resultants over section or thickness (N/m), in the frame.
    pub(crate) resultants: Vec<(usize, f64)>,
}

impl HatStress<'_> {
    /// ∫σ:K⁻¹τ for the stress σ of unit loads (m²/N per unit of thickness): tractions, then Γ_DA − f_d.
    pub(crate) fn products(&self) -> [f64; LOADS] {
        let mut own = [0.0; LOADS];
        for &(place, p) in &self.resultants {
            let column = self.star.products[self.element].column(place);
            zip(&mut own, column.iter()).for_each(|(sum, entry)| *sum += entry * p);
        }
        in_element(&own, self.at, self.frame)
    }

    /// ½∫τ:K⁻¹τ (J per unit of thickness).
    pub(crate) fn energy(&self) -> f64 {
        let product = |i: usize, j: usize| self.star.energy_in(self.element, i, j);
        let row = |&(i, p): &(usize, f64)| self.resultants.iter().map(|&(j, q)| p * product(i, j) * q).sum::<f64>();
        0.5 * self.resultants.iter().map(row).sum::<f64>()
    }
}
