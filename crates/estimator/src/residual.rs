//! How far the fields are from exactly admissible.

use percute_core::simd::lanes::Value;
use serde::{Deserialize, Serialize};

/// The largest residual of every admissibility condition.
///
/// Each is relative to the largest term of its own equation at that node or element, floored at
/// 1e-12 of that term's largest value in the mesh at that instant. Terms count before they cancel: f_d
/// and the nodes' inertia apart, the tractions of each edge apart, displacement gradients that turn a
/// body rather than strain it. Rounding leaves some 1e-13; anything above 1e-10 means that a field is
/// not admissible. All are taken at every sampled instant, but for those of stresses that are
/// a constant linear map of tractions and Γ_DA (`divergence`, `edge_tractions`, `inner_tractions`): each
/// element is checked in its turn, in one interval of 16 at contact and at one instant of 64 or more elsewhere.
/// `hat_resultants` and `hat_stress` are those of unit hats, taken once for each star in use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Residuals {
    /// u_CA = u₀ and u̇_CA = v₀ at t = 0, eq. \[6\], \[7\].
    pub initial_conditions: f64,
    /// u_CA = u_d on supports, eq. \[4\].
    pub supports: f64,
    /// u_CA on the plane when a contact phase begins (problem P_CA).
    pub onset: f64,
    /// Normal velocity during contact, eq. \[42\].
    pub normal_velocity: f64,
    /// Penetration at the instants, eq. \[3\].
    pub penetration_at_instants: f64,
    /// Penetration between the instants.
    pub penetration_between_instants: f64,
    /// F_DA in Coulomb's cone, eq. \[18\].
    pub cone: f64,
    /// F_DA where or when a node does not touch.
    pub force_off_contact: f64,
    /// Σ η b = r for every element of every star.
    pub star_compatibility: f64,
    /// Resultant and moment of tractions, Γ_DA and f_d on every element.
    pub element_resultants: f64,
    /// div σ_DA + f_d = Γ_DA at points.
    pub divergence: f64,
    /// σ_DA n = F̂ on the edges.
    pub edge_tractions: f64,
    /// Continuity of σ_DA n inside the macro-elements.
    pub inner_tractions: f64,
    /// Shares of hats in the force of their node: each at least 0, their sum 1.
    pub hat_shares: f64,
    /// Each hat in Coulomb's cone.
    pub hat_cone: f64,
    /// Resultant and moment of the tractions on every sub-triangle of a cut star.
    pub hat_resultants: f64,
    /// Divergence of the stress of hats, its tractions on the sides of sub-triangles, and their continuity inside.
    pub hat_stress: f64,
    /// Force and couple of the densities on both sides of a non-matching interface: opposite.
    #[serde(default)]
    pub opposite_forces: f64,
}

impl Residuals {
    /// Name and value of every residual, in the order of the method.
    #[must_use]
    pub fn entries(&self) -> [(&'static str, f64); 18] {
        [
            ("initial_conditions", self.initial_conditions),
            ("supports", self.supports),
            ("onset", self.onset),
            ("normal_velocity", self.normal_velocity),
            ("penetration_at_instants", self.penetration_at_instants),
            ("penetration_between_instants", self.penetration_between_instants),
            ("cone", self.cone),
            ("force_off_contact", self.force_off_contact),
            ("star_compatibility", self.star_compatibility),
            ("element_resultants", self.element_resultants),
            ("divergence", self.divergence),
            ("edge_tractions", self.edge_tractions),
            ("inner_tractions", self.inner_tractions),
            ("hat_shares", self.hat_shares),
            ("hat_cone", self.hat_cone),
            ("hat_resultants", self.hat_resultants),
            ("hat_stress", self.hat_stress),
            ("opposite_forces", self.opposite_forces),
        ]
    }

    /// Takes the larger of each.
    pub(crate) fn merge(&mut self, other: &Self) {
        let fields = [
            (&mut self.initial_conditions, other.initial_conditions),
            (&mut self.supports, other.supports),
            (&mut self.onset, other.onset),
            (&mut self.normal_velocity, other.normal_velocity),
            (&mut self.penetration_at_instants, other.penetration_at_instants),
            (&mut self.penetration_between_instants, other.penetration_between_instants),
            (&mut self.cone, other.cone),
            (&mut self.force_off_contact, other.force_off_contact),
            (&mut self.star_compatibility, other.star_compatibility),
            (&mut self.element_resultants, other.element_resultants),
            (&mut self.divergence, other.divergence),
            (&mut self.edge_tractions, other.edge_tractions),
            (&mut self.inner_tractions, other.inner_tractions),
            (&mut self.hat_shares, other.hat_shares),
            (&mut self.hat_cone, other.hat_cone),
            (&mut self.hat_resultants, other.hat_resultants),
            (&mut self.hat_stress, other.hat_stress),
            (&mut self.opposite_forces, other.opposite_forces),
        ];
        for (mine, theirs) in fields {
            *mine = worse(*mine, theirs);
        }
    }

    /// The largest of them.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.entries().iter().fold(0.0, |largest, &(_, value)| worse(largest, value))
    }
}

/// The larger of two residuals; NaN counts as largest, so that it cannot hide.
#[inline]
#[must_use]
pub(crate) fn worse(a: f64, b: f64) -> f64 {
    Value::worse(a, b)
}
