//! The choices that the method leaves open.

use crate::sampling::Sampling;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// The most threads that an estimate may use: more than any machine has cores for are a slip.
pub const MOST_THREADS: usize = 1024;

/// How the admissible contact force and the fields that balance it are built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Reconstruction {
    /// No reaction is dropped: the densities hold all reactions, those that brake a node before contact included. The
    /// normal contact law is measured where they act off contact. An auxiliary solution with less dispersion is
    /// balanced, with tractions of least energy.
    #[default]
    Corrected,
    /// On each interval, on the edges that touch throughout it, statically equivalent to the
    /// reactions: force starts with contact.
    Consistent,
    /// That of the paper: reaction over tributary length, from one step after impact to one step before
    /// release and away from the border of the contact zone (eq. \[45\]–\[50\]).
    Published,
}

/// Which field Γ_DA balances the equilibrated tractions of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Acceleration {
    /// The one nearest to ρ ã_h: ρ ã_h plus a rotation.
    Closest,
    /// A rigid motion: constant plus rotation.
    Rigid,
    /// The linear one that does the lumped work on each shape function.
    Weak,
    /// The one nearest to ρ a_c if the tractions balance M ã = M_c a_c + (M − M_c) w, of which the last term is a
    /// stress in each element. For `corrected` only.
    Split,
}

impl Acceleration {
    /// Those that a reconstruction can be combined with.
    #[must_use]
    pub fn of(reconstruction: Reconstruction) -> &'static [Self] {
        match reconstruction {
            Reconstruction::Corrected => Self::ALL,
            _ => &[Self::Closest, Self::Rigid, Self::Weak],
        }
    }

    /// The one that is taken where none is chosen. On a bar nothing turns, and `split` has no advantage.
    #[must_use]
    pub fn default_of(reconstruction: Reconstruction, dimension: usize) -> Self {
        match (reconstruction, dimension) {
            (Reconstruction::Corrected, 2..) => Self::Split,
            _ => Self::Closest,
        }
    }

    /// Refuses a reconstruction that this cannot be combined with.
    ///
    /// # Errors
    /// [`UnsuitableAcceleration`].
    pub fn check(self, reconstruction: Reconstruction) -> Result<(), UnsuitableAcceleration> {
        match Self::of(reconstruction).contains(&self) {
            true => Ok(()),
            false => Err(UnsuitableAcceleration { acceleration: self, reconstruction }),
        }
    }
}

/// A part that [`Reconstruction::Corrected`] leaves out, or changes, to show its effect: no choice for an estimate. The
/// other reconstructions have no such parts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ablation {
    /// All parts.
    #[default]
    None,
    /// The simulation's own displacements are balanced, with accelerations that take up the difference between the
    /// nodal forces of the density and the reactions.
    AuxiliarySolution,
    /// An auxiliary solution with the dispersion of the simulation.
    Correction,
    /// Contact tractions that are linear over whole edges, however far these leave the plane.
    Concentration,
    /// Reactions as they are, however short the step in which they stop a node.
    ImpulseSmoothing,
    /// Densities R_k/ℓ_k as they are, whose moment is not that of the reactions.
    Moment,
    /// The tractions of the star problems.
    LeastEnergy,
    /// No work of normal forces, only their energy off contact.
    NormalWork,
    /// Twice the work of normal forces, as \[14\] has twice that of friction.
    DoubledWork,
}

/// Options of an estimate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Options {
    /// Reconstruction of the contact force.
    pub reconstruction: Reconstruction,
    /// Choice of Γ_DA; by default [`Acceleration::default_of`].
    pub acceleration: Option<Acceleration>,
    /// For evidence only.
    #[serde(skip)]
    pub ablation: Ablation,
    /// At which steps the error is sampled.
    pub every: Sampling,
    /// How many threads, at most [`MOST_THREADS`]; by default one for each core. The result does not depend on it.
    pub threads: Option<usize>,
    /// How many sampled steps are worked on at once; by default, and at most, 8. The result does not depend on it.
    pub window: Option<usize>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            reconstruction: Reconstruction::default(),
            acceleration: None,
            ablation: Ablation::default(),
            every: Sampling::Auto,
            window: None,
            threads: None,
        }
    }
}

impl Options {
    /// Γ_DA on bodies of this dimension.
    #[must_use]
    pub fn acceleration(&self, dimension: usize) -> Acceleration {
        self.acceleration.unwrap_or(Acceleration::default_of(self.reconstruction, dimension))
    }

    /// Whether the fields balance in the present places of a body of this dimension that turns.
    #[must_use]
    pub fn balances_turning(&self, dimension: usize) -> bool {
        let balances = match self.acceleration(dimension) {
            Acceleration::Split | Acceleration::Weak => true,
            Acceleration::Closest | Acceleration::Rigid => dimension == 1,
        };
        balances && self.reconstruction == Reconstruction::Corrected
    }

    /// Steps from one sample to the next, where nothing asks for more.
    pub(crate) fn spacing<const D: usize>(&self, problem: &Problem<D>, times: &TimeGrid) -> usize {
        self.every.spacing(problem.mesh().element_count(), times.step_count())
    }

    /// With all that an estimate of bodies of this dimension takes by default.
    #[must_use]
    pub fn filled(self, dimension: usize) -> Self {
        Self { acceleration: Some(self.acceleration(dimension)), ..self }
    }
}

/// A name that is not among those known.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("\"{given}\" is not known; choose one of {}", .known.join(", "))]
pub struct UnknownName {
    /// The name given.
    pub given: String,
    /// The names that exist.
    pub known: Vec<&'static str>,
}

/// A choice of Γ_DA that the reconstruction cannot be combined with.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error(
    "is \"{acceleration}\"; with reconstruction = \"{reconstruction}\" it must be one of \"closest\", \"rigid\", \
     \"weak\" (\"{acceleration}\" needs reconstruction = \"corrected\")"
)]
pub struct UnsuitableAcceleration {
    /// The choice of Γ_DA.
    pub acceleration: Acceleration,
    /// The reconstruction.
    pub reconstruction: Reconstruction,
}

/// Gives the variants of an option their names, for reading and printing.
macro_rules! named {
    ($type:ident: $($variant:ident = $name:literal),+) => {
        impl $type {
            /// All of them, in the order in which they are named to users.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];
        }

        impl FromStr for $type {
            type Err = UnknownName;

            fn from_str(name: &str) -> Result<Self, UnknownName> {
                match name {
                    $($name => Ok(Self::$variant),)+
                    _ => Err(UnknownName { given: name.to_string(), known: vec![$($name),+] }),
                }
            }
        }

        impl fmt::Display for $type {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(match self {
                    $(Self::$variant => $name,)+
                })
            }
        }
    };
}

named!(Reconstruction: Corrected = "corrected", Consistent = "consistent", Published = "published");
named!(
    Ablation:
        None = "none",
        AuxiliarySolution = "auxiliary solution",
        Correction = "correction",
        Concentration = "concentration",
        ImpulseSmoothing = "impulse smoothing",
        Moment = "moment",
        LeastEnergy = "least energy",
        NormalWork = "normal work",
        DoubledWork = "doubled work"
);
named!(Acceleration: Closest = "closest", Rigid = "rigid", Weak = "weak", Split = "split");

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_round_trip() {
        for &choice in Acceleration::ALL {
            assert_eq!(choice.to_string().parse(), Ok(choice));
        }
        for &choice in Reconstruction::ALL {
            assert_eq!(choice.to_string().parse(), Ok(choice));
        }
        assert_eq!("blunt".parse::<Reconstruction>().unwrap_err().known, ["corrected", "consistent", "published"]);
    }
}
