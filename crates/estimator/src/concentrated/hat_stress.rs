//! The stress of the hats of one node in one element.

use super::star_stress::ElementForms;
use crate::stress::LOADS;
use std::iter::zip;

/// The stress τ of hats, as a sum of those of unit hats.
#[derive(Clone, Debug)]
pub(crate) struct HatStress<'a> {
    /// Those of unit hats.
    pub(crate) forms: &'a ElementForms,
    /// Places of the hats in these forms, and their resultants over section or thickness (N/m).
    pub(crate) resultants: Vec<(usize, f64)>,
}

impl HatStress<'_> {
    /// ∫σ:K⁻¹τ for the stress σ of unit loads (m²/N per unit of thickness): tractions, then Γ_DA − f_d.
    pub(crate) fn products(&self) -> [f64; LOADS] {
        let mut products = [0.0; LOADS];
        for &(place, p) in &self.resultants {
            zip(&mut products, self.forms.product.column(place).iter()).for_each(|(sum, entry)| *sum += entry * p);
        }
        products
    }

    /// ½∫τ:K⁻¹τ (J per unit of thickness).
    pub(crate) fn energy(&self) -> f64 {
        let row = |&(i, p): &(usize, f64)| {
            self.resultants.iter().map(|&(j, q)| p * self.forms.energy.at(i, j) * q).sum::<f64>()
        };
        0.5 * self.resultants.iter().map(row).sum::<f64>()
    }

    /// ∫τ (N per unit of thickness), 11, 22, 12.
    pub(crate) fn integral(&self) -> [f64; 3] {
        let mut integral = [0.0; 3];
        for &(place, p) in &self.resultants {
            zip(&mut integral, self.forms.integral.column(place).iter()).for_each(|(sum, entry)| *sum += entry * p);
        }
        integral
    }
}
