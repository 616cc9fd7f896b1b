//! The fields of a probe.

use crate::message::{hint, list};
use percute_core::border::row;
use percute_core::element_state::ElementState;
use percute_core::history::{State, Step};
use percute_core::mesh::Around;
use percute_core::problem::AnyProblem;
use std::str::FromStr;

/// A field at a point, by the names of `history.plot` in Python.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Field {
    /// Von Mises stress.
    VonMises,
    /// Pressure −⅓ tr σ.
    Pressure,
    /// σ of a bar.
    Stress,
    /// σ₁₁ of a plane body or a solid.
    StressXx,
    /// σ₂₂ of a plane body or a solid.
    StressYy,
    /// σ₁₂ of a plane body or a solid.
    StressXy,
    /// σ₃₃ of a solid.
    StressZz,
    /// σ₂₃ of a solid.
    StressYz,
    /// σ₁₃ of a solid.
    StressXz,
    /// Magnitude of the displacement.
    Displacement,
    /// Magnitude of the velocity.
    Velocity,
    /// Equivalent plastic strain p.
    PlasticStrain,
}

impl Field {
    /// All of them.
    pub const ALL: [Self; 12] = [
        Self::VonMises,
        Self::Pressure,
        Self::Stress,
        Self::StressXx,
        Self::StressYy,
        Self::StressXy,
        Self::StressZz,
        Self::StressYz,
        Self::StressXz,
        Self::Displacement,
        Self::Velocity,
        Self::PlasticStrain,
    ];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::VonMises => "von_mises",
            Self::Pressure => "pressure",
            Self::Stress => "stress",
            Self::StressXx => "stress_xx",
            Self::StressYy => "stress_yy",
            Self::StressXy => "stress_xy",
            Self::StressZz => "stress_zz",
            Self::StressYz => "stress_yz",
            Self::StressXz => "stress_xz",
            Self::Displacement => "displacement",
            Self::Velocity => "velocity",
            Self::PlasticStrain => "equivalent_plastic_strain",
        }
    }

    /// Its name in a sentence.
    pub(super) fn told(self) -> &'static str {
        match self {
            Self::VonMises => "von Mises stress",
            Self::PlasticStrain => "equivalent plastic strain",
            other => other.name(),
        }
    }

    /// Its unit.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Displacement => "m",
            Self::Velocity => "m/s",
            Self::PlasticStrain => "1",
            _ => "Pa",
        }
    }

    /// Whether it has no limit at a corner where the stress has none.
    pub(super) fn grows_at_corners(self) -> bool {
        self.unit() == "Pa" || self == Self::PlasticStrain
    }

    /// Whether bodies of a dimension have it.
    pub(super) fn is_of(self, dimension: usize) -> bool {
        match self {
            Self::Stress => dimension == 1,
            Self::StressXx | Self::StressYy | Self::StressXy => dimension > 1,
            Self::StressZz | Self::StressYz | Self::StressXz => dimension == 3,
            _ => true,
        }
    }

    /// The fields of bodies of a dimension in a sentence, and the one that was meant.
    pub(super) fn choose(given: &str, dimensions: &[usize]) -> String {
        let known = Self::ALL.into_iter().filter(|field| dimensions.iter().any(|&dimension| field.is_of(dimension)));
        let known: Vec<&str> = known.map(Self::name).collect();
        format!("choose from {}{}", list(known.iter().copied()), hint(given, known))
    }

    /// Its value at a point, with its sign: the mean of the elements that contain the point, by their shares.
    pub(super) fn at(self, problem: &AnyProblem, around: &[Around], state: &State<'_>) -> f64 {
        let Step { displacement, internal, .. } = *state.step();
        let mean = |of: fn(&ElementState) -> f64| -> f64 {
            let value = |a: &Around| a.share * of(&ElementState::new(problem, a.element, displacement, internal));
            around.iter().map(value).sum()
        };
        match self {
            Self::VonMises => mean(ElementState::von_mises),
            Self::Pressure => mean(ElementState::pressure),
            Self::Stress | Self::StressXx => mean(|element| element.stress[0][0]),
            Self::StressYy => mean(|element| element.stress[1][1]),
            Self::StressXy => mean(|element| element.stress[0][1]),
            Self::StressZz => mean(|element| element.stress[2][2]),
            Self::StressYz => mean(|element| element.stress[1][2]),
            Self::StressXz => mean(|element| element.stress[0][2]),
            Self::Displacement => magnitude(problem, around, displacement),
            Self::Velocity => magnitude(problem, around, &state.velocity()),
            Self::PlasticStrain => mean(|element| element.equivalent_plastic_strain),
        }
    }
}

/// The magnitude of a nodal field at a point.
fn magnitude(problem: &AnyProblem, around: &[Around], field: &[f64]) -> f64 {
    let mut mean = [0.0; 3];
    for Around { element, shapes, share } in around {
        for (node, shape) in problem.mesh().cell(*element).iter().zip(shapes) {
            let value = row(field, node.index(), problem.dimension());
            (0..3).for_each(|c| mean[c] += share * shape * value[c]);
        }
    }
    mean.iter().map(|x| x * x).sum::<f64>().sqrt()
}

impl FromStr for Field {
    type Err = String;

    fn from_str(given: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|field| field.name() == given);
        found.ok_or_else(|| format!("there is no field {given:?}; {}", Self::choose(given, &[1, 2, 3])))
    }
}
