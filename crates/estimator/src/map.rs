//! Maps: the part of each element in the error at one instant, and the fields behind it.

use serde::{Deserialize, Serialize};

/// The contributions of all elements to the error at one instant t_n. Where the contact zone
/// changes at that instant, they are those after it, like the later of its two samples.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ElementMap {
    /// n.
    pub step: usize,
    /// t_n (s).
    pub time: f64,
    /// Kinetic part of η_E(t_n) of each element (J), eq. \[21\].
    pub kinetic: Vec<f64>,
    /// Its elastic part (J).
    pub elastic: Vec<f64>,
    /// Its plastic part (J), of materials that yield: 0 for others.
    #[serde(default)]
    pub dissipation: Vec<f64>,
    /// Its contact part (J), an integral from 0 to t_n, in the element that owns the face.
    pub contact: Vec<f64>,
    /// ∫η_E dt of each element from 0 to t_n (J s). The quantity of the paper's figure 9 follows from it, see
    /// [`ElementMap::error`].
    pub accumulated: Vec<f64>,
    /// The fields, if they were requested.
    pub fields: Option<AdmissibleFields>,
}

/// Admissible fields at one instant; where they jump in time, their values after it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AdmissibleFields {
    /// u_CA at the nodes (m).
    pub displacement: Vec<f64>,
    /// u̇_CA at the nodes (m/s).
    pub velocity: Vec<f64>,
    /// Mean of σ_DA over each element (Pa).
    pub stress: Vec<f64>,
    /// σ_CA = Kε(u_CA) of each element (Pa).
    pub compatible_stress: Vec<f64>,
    /// Mean of Γ_DA/ρ over each element (m/s²).
    pub acceleration: Vec<f64>,
}

impl ElementMap {
    /// η_E(t_n) of each element (J), eq. \[21\].
    #[must_use]
    pub fn total(&self) -> Vec<f64> {
        let parts = self.kinetic.iter().zip(&self.elastic).zip(&self.dissipation).zip(&self.contact);
        parts.map(|(((kinetic, elastic), dissipation), contact)| kinetic + elastic + dissipation + contact).collect()
    }

    /// The error accumulated so far, e_E(t_n) = √((1/T)∫η_E dt) from 0 to t_n, of each element (J^½), where
    /// `end` is T: eq. \[20\] up to t_n, the paper's figure 9. With the estimate's own
    /// [`end`](crate::Estimate::end) it grows to [`by_element`](crate::Estimate::by_element), to the last bit.
    #[must_use]
    pub fn error(&self, end: f64) -> Vec<f64> {
        self.accumulated.iter().map(|integral| (integral / end).sqrt()).collect()
    }
}
