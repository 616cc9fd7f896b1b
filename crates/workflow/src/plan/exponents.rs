//! Exponents of the error over the size of the elements.

use super::{Basis, MOST};
use percute_estimator::Separation;
use serde::Serialize;

/// The least and the largest exponent: e falls like h^½ behind fronts and like h in smooth fields.
const RANGE: [f64; 2] = [0.15, 1.0];
/// The exponent where the sources do not tell.
const USUAL: f64 = 0.5;

/// q of e_E ~ h^q, and the part of η that steps half as long would add on the same mesh.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Exponents {
    /// Of elements that touch.
    pub near: f64,
    /// Of the others.
    pub far: f64,
    /// With steps half as long on the same mesh, η grows by this part: elements that stay as large lose the
    /// cancellation of the errors of mass and step.
    pub step: f64,
}

impl Exponents {
    /// From the sources, and those that are expected with elements and steps half as long.
    pub(super) fn of(sources: &Separation) -> Self {
        let (mean, half) = (&sources.mean, &sources.halved_elements);
        let expected = sources.mean_with_halved_elements().unwrap_or(0.0);
        let all = exponent(mean.total(), expected * expected);
        let step = (sources.halved_step / mean.total()).clamp(0.0, 0.5);
        if mean.surface <= MOST * mean.total() {
            return Self { near: all, far: all, step };
        }
        let others = exponent(mean.total() - mean.surface, half.total() - half.surface);
        Self { near: exponent(mean.surface, half.surface), far: others.max(all), step }
    }

    /// The exponent of each element.
    pub(super) fn each(&self, basis: &Basis) -> Vec<f64> {
        basis.touches.iter().map(|touches| if *touches { self.near } else { self.far }).collect()
    }
}

/// From an energy and that with elements half as large.
fn exponent(energy: f64, half: f64) -> f64 {
    let found = 0.5 * (energy / half).log2();
    if energy > 0.0 && half > 0.0 { found.clamp(RANGE[0], RANGE[1]) } else { USUAL }
}
