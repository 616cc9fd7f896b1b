//! Two surfaces of different bodies that may touch.

use super::coulomb::Coulomb;
use super::obstacle::{ObstacleError, coulomb};

/// Two groups of faces, of different bodies, that may touch with Coulomb friction.
#[derive(Clone, Debug, PartialEq)]
pub struct Interface {
    groups: [String; 2],
    law: Coulomb,
    matching: bool,
}

impl Interface {
    /// Between two groups of faces, with a coefficient of friction μ ≥ 0. The nodes of the two face each other in
    /// pairs: they differ by a gap along one common normal only, and each pair stays one during the run. The normal is
    /// the mean one of the first group or, if the nodes do not face each other along it, of the second one.
    ///
    /// # Errors
    /// Negative friction, or one that is not finite; friction in 1D.
    pub fn matching(
        dimension: usize,
        first: impl Into<String>,
        second: impl Into<String>,
        friction: f64,
    ) -> Result<Self, ObstacleError> {
        Ok(Self { groups: [first.into(), second.into()], law: coulomb(dimension, friction)?, matching: true })
    }

    /// The same for two groups of edges of any nodes, which may slide along each other. The slave is the group that
    /// sticks out less beyond the other one along the interface, or that with more edges; of groups alike, that of the
    /// softer or of the lighter body. The normal is the mean one of the flatter group, or of the master if both are
    /// equally flat: a corner of the other group slides along its face. Ends of bars are always matching.
    ///
    /// # Errors
    /// As [`Interface::matching`].
    pub fn non_matching(
        dimension: usize,
        first: impl Into<String>,
        second: impl Into<String>,
        friction: f64,
    ) -> Result<Self, ObstacleError> {
        Ok(Self { matching: dimension == 1, ..Self::matching(dimension, first, second, friction)? })
    }

    /// Whether the nodes face each other in pairs.
    #[must_use]
    pub fn is_matching(&self) -> bool {
        self.matching
    }

    /// The names of the two groups.
    #[must_use]
    pub fn groups(&self) -> [&str; 2] {
        self.groups.each_ref().map(String::as_str)
    }

    /// The law of contact between them.
    #[must_use]
    pub fn law(&self) -> Coulomb {
        self.law
    }
}
