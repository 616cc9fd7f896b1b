//! The sources of η: what a finer mesh or a shorter step would change.
//!
//! D = ½(u − u_A)·K(u − u_A) + ½(v − v_A)·M_c(v − v_A) is the energy of the difference of the simulation and the
//! auxiliary solution. Its contact part is its product with the difference that the contact forces alone make, the rest
//! is dispersion that has accumulated. An element is near if one of its nodes may touch.

use crate::difference::Difference;
use serde::{Deserialize, Serialize};

/// The sources of η (J). Their sum is η. A source may be slightly negative, because D is not orthogonal to the other
/// misfits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sources {
    /// At the contact surface: friction, ∫F_n gap, the contact part of D, and the misfit of the near elements beyond D.
    pub surface: f64,
    /// ∫∫R_n|w_n| dt, the energy that reactions take from arriving nodes.
    pub front: f64,
    /// The rest of D: dispersion that has accumulated.
    pub dispersion: f64,
    /// The misfit of the other elements beyond D: stress and acceleration that the mesh does not resolve.
    pub mesh: f64,
}

impl Sources {
    /// The sources of η at one sample, from its kinetic and elastic parts together and its contact part (J).
    pub(crate) fn new([misfit, contact_part]: [f64; 2], near: &NearParts, difference: &Difference) -> Self {
        let Difference { energy, near: near_part, contact, .. } = *difference;
        Self {
            surface: (contact_part - near.front) + contact + (near.misfit - near_part),
            front: near.front,
            dispersion: energy - contact,
            mesh: (misfit - near.misfit) - (energy - near_part),
        }
    }

    /// η (J).
    #[must_use]
    pub fn total(&self) -> f64 {
        self.surface + self.front + self.dispersion + self.mesh
    }

    /// Each source times a factor.
    pub(crate) fn scaled(&self, [surface, front, dispersion, mesh]: [f64; 4]) -> Self {
        Self {
            surface: surface * self.surface,
            front: front * self.front,
            dispersion: dispersion * self.dispersion,
            mesh: mesh * self.mesh,
        }
    }

    /// Adds so much of others.
    pub(crate) fn add(&mut self, weight: f64, other: &Self) {
        self.surface += weight * other.surface;
        self.front += weight * other.front;
        self.dispersion += weight * other.dispersion;
        self.mesh += weight * other.mesh;
    }
}

/// The near elements at one sample (J).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NearParts {
    /// Kinetic and elastic part of η.
    pub(crate) misfit: f64,
    /// ∫∫R_n|w_n| dt.
    pub(crate) front: f64,
}

impl NearParts {
    /// The mean of two.
    pub(crate) fn mean(a: &Self, b: &Self) -> Self {
        Self { misfit: 0.5 * (a.misfit + b.misfit), front: 0.5 * (a.front + b.front) }
    }

    /// Both times a factor.
    pub(crate) fn scaled(&self, factor: f64) -> Self {
        Self { misfit: factor * self.misfit, front: factor * self.front }
    }
}

/// The sources of η over time, and by how much a finer mesh or a shorter step would change them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Separation {
    /// At the time of the largest η (J).
    pub at_sup: Sources,
    /// Their means over time (J); the sum is the square of `mean`.
    pub mean: Sources,
    /// The means expected with elements and steps half as long (J).
    pub halved_elements: Sources,
    /// The expected change of the sum of the means with steps half as long (J).
    pub halved_step: f64,
    /// At all samples, in order of time (J).
    pub over_time: Vec<Sources>,
}

impl Separation {
    /// The mean error expected with elements and steps half as long (J^½); `None` where the sources do not separate:
    /// where the mean of one is below −20 % of η, as on bars near the critical step.
    #[must_use]
    pub fn mean_with_halved_elements(&self) -> Option<f64> {
        self.expected(self.halved_elements.total())
    }

    /// The mean error expected with steps half as long (J^½); `None` where the sources do not separate.
    #[must_use]
    pub fn mean_with_halved_step(&self) -> Option<f64> {
        self.expected(self.mean.total() + self.halved_step)
    }

    fn expected(&self, total: f64) -> Option<f64> {
        let Sources { surface, front, dispersion, mesh } = self.mean;
        let least = surface.min(front).min(dispersion).min(mesh);
        (total > 0.0 && least >= -NEGATIVE * self.mean.total()).then(|| total.sqrt())
    }
}

/// The means expected with elements and steps half as long (J), from those of the run.
pub(crate) fn halved_elements(mean: &Sources, difference: &Difference) -> Sources {
    let ratio = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
    let kept = ratio(difference.halved_elements, difference.dispersion);
    let fresh = ratio(mean.front, 2.0 * mean.mesh.abs()).min(1.0);
    let halvings = ratio(difference.halvings[0], difference.halvings[1]);
    mean.scaled([
        1.0 - SURFACE / (halvings + SURFACE / (1.0 - FLAT)),
        FRONT,
        kept + fresh * (jump(kept) - kept),
        SMOOTH * (1.0 + fresh),
    ])
}

/// The part of η by which a source may be negative: 0.9 of the critical step has 0.17 on bars, the critical step itself
/// 2.
const NEGATIVE: f64 = 0.2;
/// The mass of the surface layer, which arrives at full speed, falls like h.
const FRONT: f64 = 0.5;
/// The misfit of interpolation falls like h² in smooth fields. Waves that the finer mesh carries anew add as much at
/// most.
const SMOOTH: f64 = 0.25;
/// The error at the surface without concentrated forces: between the layer of a front (½) and smooth fields (¼).
/// Measured 0.26 to 0.39.
const FLAT: f64 = 0.325;
/// A force that acts on less than an edge has an energy linear in the halvings from the edge to its width. Its excess
/// in the simulation falls with them as well, and so does the misfit of the stress: about the third power of halvings +
/// 4. Measured on corners, discs and crowned blocks at 4 and 40 m/s.
const SURFACE: f64 = 2.7;

/// The factor of D behind a jump. Its spectrum is k⁻², its waves are late by a phase ∝ k³h²t. A solution with a quarter
/// of the dispersion has q D: q depends on t/h alone, and so does the factor. This is a fit of both integrals over
/// time, within 5 %.
fn jump(kept: f64) -> f64 {
    0.655 + 0.0125 / (kept - 0.054).max(0.0093)
}

#[cfg(test)]
mod tests;
