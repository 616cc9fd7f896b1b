//! Contact with obstacles, rigid or of other bodies: geometry, Coulomb's law, the constraints of a step, and results.
//!
//! An [`Obstacle`] gives the gap of a point and the [`Frame`] at it. All other code uses these two only. [`Coulomb`] is
//! the only implementation of the cone of friction.

mod any;
mod constraint;
mod corner;
mod coulomb;
mod frame;
mod inclination;
mod interface;
mod mortar;
mod obstacle;
mod plane;
mod prediction;
mod solve;
mod surface;

pub use any::{AnyContactConfiguration, AnyObstacle, PlaneAt};
pub(crate) use constraint::Constraints;
pub(crate) use coulomb::dissipation;
pub use coulomb::{Coulomb, Status};
pub use frame::Frame;
pub(crate) use frame::dot;
pub use inclination::Inclination;
pub(crate) use interface::RELATIONS;
pub use interface::{Interface, contact_name, side_names};
pub use mortar::{CORNER, ContactConfiguration, Coupling, DualShape, NonMatchingSurfaces, Part, Segment, Side};
pub(crate) use mortar::{LEAST_PART, NonMatchingContact, tangent};
pub use obstacle::{Obstacle, ObstacleError};
pub use plane::Plane;
pub(crate) use prediction::{Predicted, Prediction};
pub(crate) use solve::solve;
pub use surface::{ContactFace, ContactNode, ContactSurface};
