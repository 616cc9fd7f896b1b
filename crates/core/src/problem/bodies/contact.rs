//! Contact between bodies as users state it.

use crate::contact::{Interface, ObstacleError};

/// What may touch each other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Between {
    /// Two groups of faces, of different bodies.
    Groups([String; 2]),
    /// Two bodies, by their names: the faces that see each other.
    Bodies([String; 2]),
    /// All bodies of which nothing else is stated.
    All,
}

/// Contact between bodies, with Coulomb friction.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    pub(in crate::problem) between: Between,
    friction: f64,
    pub(in crate::problem) matching: Option<bool>,
}

impl Contact {
    /// That of bodies without friction, as bars are.
    pub(in crate::problem) const FRICTIONLESS: Self = Self { between: Between::All, friction: 0.0, matching: None };

    /// With a coefficient of friction μ ≥ 0. With `matching` the nodes must face each other in pairs, which stay pairs
    /// during the run; with `matching` false they need not, and surfaces may slide along each other. Without it they
    /// are pairs where nodes face each other; of bodies that are not given by groups if they slide by less than a
    /// tenth of an edge, too, as far as their velocities tell.
    ///
    /// # Errors
    /// Negative friction, or one that is not finite; friction in 1D.
    pub fn new(
        dimension: usize,
        between: Between,
        friction: f64,
        matching: Option<bool>,
    ) -> Result<Self, ObstacleError> {
        let contact = Self { between, friction, matching };
        contact.interface(dimension, ["", ""], true).map(|_| contact)
    }

    /// The same between two groups of faces.
    pub(in crate::problem) fn interface(
        &self,
        dimension: usize,
        [first, second]: [&str; 2],
        matching: bool,
    ) -> Result<Interface, ObstacleError> {
        let make = if matching { Interface::matching } else { Interface::non_matching };
        make(dimension, first, second, self.friction)
    }

    /// The coefficient of friction.
    pub(in crate::problem) fn friction(&self) -> f64 {
        self.friction
    }

    /// The key of a case file that says between what.
    pub(in crate::problem) fn key(&self) -> &'static str {
        match self.between {
            Between::Groups(_) => "groups",
            Between::Bodies(_) => "bodies",
            Between::All => "",
        }
    }
}

impl From<Interface> for Contact {
    fn from(interface: Interface) -> Self {
        let between = Between::Groups(interface.groups().map(str::to_string));
        Self { between, friction: interface.law().friction(), matching: Some(interface.is_matching()) }
    }
}
