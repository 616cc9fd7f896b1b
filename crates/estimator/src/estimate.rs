//! The results of an estimate.

use crate::map::ElementMap;
use crate::residual::Residuals;
use crate::sources::Separation;
use percute_core::ids::ElementId;
use serde::{Deserialize, Serialize};

/// The three parts of η (J), eq. \[14\].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Parts {
    /// ½∫ρ(u̇_DA − u̇_CA)².
    pub kinetic: f64,
    /// ½∫(σ_DA − σ_CA) : K⁻¹ (σ_DA − σ_CA).
    pub elastic: f64,
    /// Of materials that yield, else 0: the distance of the hardening of both fields, ∫⅓C|Δε_p|² + ½H_i Δp², and the
    /// misfit of the dissipation, ∫₀ᵗ∫φ(Ė_CA) − Σ_DA·Ė_CA.
    #[serde(default)]
    pub dissipation: f64,
    /// 2∫₀ᵗ∫[b(−w_CA, F_DA) + w_CA·F_DA]; with `corrected` its tangential part, ∫F_n gap and ∫∫F_n|w_n| dt.
    pub contact: f64,
}

impl Parts {
    /// η (J).
    #[must_use]
    pub fn total(&self) -> f64 {
        self.kinetic + self.elastic + self.dissipation + self.contact
    }

    /// The mean of two.
    pub(crate) fn mean(a: &Self, b: &Self) -> Self {
        let mean = |a: f64, b: f64| 0.5 * (a + b);
        Self {
            kinetic: mean(a.kinetic, b.kinetic),
            elastic: mean(a.elastic, b.elastic),
            dissipation: mean(a.dissipation, b.dissipation),
            contact: mean(a.contact, b.contact),
        }
    }

    /// Each part times a factor.
    pub(crate) fn scaled(&self, factor: f64) -> Self {
        let [kinetic, elastic, dissipation, contact] =
            [self.kinetic, self.elastic, self.dissipation, self.contact].map(|part| factor * part);
        Self { kinetic, elastic, dissipation, contact }
    }
}

/// η and d at one instant. With `consistent` and `published`, an instant at which the contact zone changes has two
/// samples, before and after.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// t (s).
    pub time: f64,
    /// η(t) (J), eq. \[14\].
    pub parts: Parts,
    /// d(t) (J), eq. \[24\].
    pub reference: f64,
}

/// The error measures. Absolute values are in J^½, per metre of thickness where that is 1 m.
///
/// Relative ones are over √`energy`, the largest energy of deformation and vibration: strain energy plus the kinetic
/// energy relative to the rigid motion of each body. A common velocity and a spin change nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ErrorMeasures {
    /// √sup η, eq. \[15\].
    pub sup: f64,
    /// √((1/T)∫η dt), eq. \[16\].
    pub mean: f64,
    /// √((1/(T − t₁))∫η dt) from t₁ on, the last sampled level from which forces of contact act; from t_0 on without
    /// contact.
    pub mean_from_touch: f64,
    /// The largest energy of deformation and vibration at the sampled levels (J).
    pub energy: f64,
    /// The largest strain energy there (J).
    pub strain_energy: f64,
    /// The largest kinetic energy relative to the rigid motion of each body there (J).
    pub kinetic_energy: f64,
    /// `sup` over √`energy`.
    pub relative_sup: f64,
    /// `mean_from_touch` over √`energy`.
    pub relative_mean: f64,
    /// √sup of the elastic part of η over √`strain_energy`.
    pub relative_stress_sup: f64,
    /// The mean from the touch of the same.
    pub relative_stress_mean: f64,
    /// √sup of the kinetic part of η over √`kinetic_energy`.
    pub relative_velocity_sup: f64,
    /// The mean from the touch of the same.
    pub relative_velocity_mean: f64,
    /// `sup` over `reference_sup`, eq. \[22\].
    pub published_relative_sup: f64,
    /// `mean` over `reference_mean`.
    pub published_relative_mean: f64,
    /// D = √sup d, eq. \[23\].
    pub reference_sup: f64,
    /// √((1/T)∫d dt).
    pub reference_mean: f64,
}

impl ErrorMeasures {
    /// The names of all measures and their values.
    #[must_use]
    pub fn entries(&self) -> [(&'static str, f64); 16] {
        [
            ("sup", self.sup),
            ("mean", self.mean),
            ("mean_from_touch", self.mean_from_touch),
            ("energy", self.energy),
            ("strain_energy", self.strain_energy),
            ("kinetic_energy", self.kinetic_energy),
            ("relative_sup", self.relative_sup),
            ("relative_mean", self.relative_mean),
            ("relative_stress_sup", self.relative_stress_sup),
            ("relative_stress_mean", self.relative_stress_mean),
            ("relative_velocity_sup", self.relative_velocity_sup),
            ("relative_velocity_mean", self.relative_velocity_mean),
            ("published_relative_sup", self.published_relative_sup),
            ("published_relative_mean", self.published_relative_mean),
            ("reference_sup", self.reference_sup),
            ("reference_mean", self.reference_mean),
        ]
    }

    /// Whether the error is zero to rounding, as in the flight of a rigid body: below 1e-9 of the fields.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.sup <= 1e-9 * self.reference_sup
    }
}

/// Which fields of the motion the history brought of its own; the others follow by the scheme.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Supplied {
    /// v_n.
    pub velocity: bool,
    /// a_n.
    pub acceleration: bool,
}

/// The estimate at a non-matching interface (`docs/bodies.md`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SurfaceEstimate {
    /// How far they are along each other from their places at the start, at most (m).
    pub slide: f64,
    /// The largest height by which a node gives way in the admissible motion (m).
    pub lift: f64,
    /// How often the penetration of the admissible motion was looked for, until there was none.
    pub rounds: usize,
    /// The part of the squared mean error that comes from the stress of the contact density beside its linear part.
    pub stress: f64,
}

/// The constitutive relation error of a history.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The measures.
    pub error: ErrorMeasures,
    /// When η is largest (s).
    pub time_of_sup: f64,
    /// Parts of η at that time (J).
    pub parts: Parts,
    /// η and d at all samples, in order of time.
    pub over_time: Vec<Sample>,
    /// The sources of η; `None` without an auxiliary solution, as with `consistent` and `published`.
    pub sources: Option<Separation>,
    /// e_E of each element, √((1/T)∫η_E dt) (J^½), eq. \[20\].
    pub by_element: Vec<f64>,
    /// The maps requested at steps that the run reached, in their order.
    pub maps: Vec<ElementMap>,
    /// How far each field is from exactly admissible.
    pub residuals: Residuals,
    /// Normal impulse of the admissible contact force over that of the simulation; `None` without contact.
    pub impulse_ratio: Option<f64>,
    /// Nodes at which the auxiliary solution has had a contact of its own. With any, the kept impulse need not be near
    /// 1.
    pub isolated_contact_nodes: usize,
    /// The largest energy that contact has given to the auxiliary solution, over the largest kinetic and strain energy
    /// of the simulation: no contact gives any.
    pub auxiliary_contact_energy: f64,
    /// That at non-matching interfaces, in the order of [`ContactSurface::non_matching`].
    ///
    /// [`ContactSurface::non_matching`]: percute_core::contact::ContactSurface::non_matching
    pub surfaces: Vec<SurfaceEstimate>,
    /// Where velocities and accelerations came from.
    pub supplied: Supplied,
    /// Last step that is estimated.
    pub steps: usize,
    /// Its time T (s).
    pub end: f64,
}

impl Estimate {
    /// Whether every number of it is one.
    pub(crate) fn is_finite(&self) -> bool {
        let mut measures = self.error.entries().into_iter().map(|(_, x)| x);
        let samples = self.over_time.iter().all(|s| s.parts.total().is_finite() && s.reference.is_finite());
        samples && measures.all(|x| x.is_finite()) && self.by_element.iter().all(|x| x.is_finite())
    }

    /// The `count` elements that contribute most, with e_E (J^½), largest first.
    #[must_use]
    pub fn worst_elements(&self, count: usize) -> Vec<(ElementId, f64)> {
        let mut order: Vec<usize> = (0..self.by_element.len()).collect();
        let larger = |a: &usize, b: &usize| self.by_element[*b].total_cmp(&self.by_element[*a]).then(a.cmp(b));
        if count < order.len() {
            order.select_nth_unstable_by(count, larger);
            order.truncate(count);
        }
        order.sort_unstable_by(larger);
        order.into_iter().map(|e| (ElementId::new(e), self.by_element[e])).collect()
    }
}
