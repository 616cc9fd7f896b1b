//! The plastic flow at an instant of a history.

use super::Extreme;
use crate::message::{percent, trimmed, vector};
use percute_core::element_state::ElementState;
use percute_core::ids::ElementId;
use percute_core::problem::AnyProblem;
use serde::Serialize;

/// The plastic flow up to an instant of a history.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StoredFlow {
    /// The part of the volume of the materials with plasticity that has yielded.
    pub share: f64,
    /// The largest equivalent plastic strain, at this instant.
    pub equivalent_strain: Extreme,
}

impl StoredFlow {
    /// That of the internal variables of all elements at a time (s); none where no material yields.
    #[must_use]
    pub fn new(problem: &AnyProblem, time: f64, internal: &[f64]) -> Option<Self> {
        let at_rest = vec![0.0; problem.mesh().points().len()];
        let (mut volumes, mut largest) = ([0.0; 2], Extreme { time, ..Extreme::default() });
        let elements = (0..problem.mesh().element_count()).map(ElementId::new);
        for element in elements.filter(|&element| problem.material(element).hardening().is_some()) {
            let p = ElementState::new(problem, element, &at_rest, internal).equivalent_plastic_strain;
            let volume = problem.volume(element);
            volumes[0] += volume;
            volumes[1] += if p > 0.0 { volume } else { 0.0 };
            largest.take(p, element.index(), time);
        }
        let centroid = problem.mesh().centroid(ElementId::new(largest.element));
        largest.centroid = centroid[..problem.dimension()].to_vec();
        (volumes[0] > 0.0).then(|| Self { share: volumes[1] / volumes[0], equivalent_strain: largest })
    }

    /// In a line of a summary.
    pub(crate) fn line(&self) -> (&'static str, String) {
        let Extreme { value, element, centroid, time } = &self.equivalent_strain;
        let time = trimmed(*time, 5);
        let told = match self.share > 0.0 {
            true => format!(
                "{} of the volume by {time} s, plastic strain at most {} in element {element} at {} m",
                percent(self.share),
                percent(*value),
                vector(centroid, 3)
            ),
            false => format!("nothing by {time} s"),
        };
        ("yielded", told)
    }
}
