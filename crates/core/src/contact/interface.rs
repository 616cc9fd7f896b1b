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

/// In the name of a group of edges that is found: one body "facing" or "towards" another one.
pub(crate) const RELATIONS: [&str; 2] = ["facing", "towards"];

/// The names of the two sides of an interface: their groups, or their bodies where the groups were found.
#[must_use]
pub fn side_names(groups: [&str; 2]) -> [String; 2] {
    [0, 1].map(|side| {
        let [own, other] = [groups[side], groups[1 - side]];
        let found = RELATIONS.iter().find_map(|relation| own.split_once(&format!(" {relation} ")));
        // The other group begins with the name of the other body: "plate", "plate.top" or "plate towards disc".
        let named = found.filter(|(_, body)| {
            other.strip_prefix(body).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', ' ']))
        });
        named.map_or(own, |(body, _)| body).to_string()
    })
}

/// The name of an interface: "disc and plate".
#[must_use]
pub fn contact_name(groups: [&str; 2]) -> String {
    let sides = side_names(groups);
    let joint = if sides.iter().any(|side| side.contains(" and ")) { " with " } else { " and " };
    sides.join(joint)
}

#[cfg(test)]
mod tests {
    use super::contact_name;

    #[test]
    fn contacts_have_the_names_of_bodies_or_groups() {
        for (groups, name) in [
            (["disc towards plate", "plate towards disc"], "disc and plate"),
            (["a facing b", "b.bottom"], "a and b.bottom"),
            (["a and b towards c", "c towards a and b"], "a and b with c"),
            (["upper.bottom", "lower.top"], "upper.bottom and lower.top"),
            (["edges facing up", "plate"], "edges facing up and plate"),
        ] {
            assert_eq!(contact_name(groups), name);
        }
    }
}
