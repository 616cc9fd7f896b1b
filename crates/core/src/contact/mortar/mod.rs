//! Non-matching interfaces of two bodies: dual mortar multipliers on the nodes of one of them, the slave.
//!
//! Places on both surfaces have a coordinate ξ along one constant tangent t. It moves with the body as a whole, so that
//! lengths in ξ stay those of the undeformed mesh. The [`Coupling`] at an instant has the matrices D and M of the
//! multipliers λ (N/m): the forces on the slave are Dᵀλ, those on the master −Mᵀλ, and (D f − M f')_k / w_k is the
//! weighted value of a field f on the slave less a field f' on the master.
//!
//! The slave may belong to several bodies side by side, of which each moves along ξ in its own way: a block on two
//! blocks. Their multipliers act on the common master, so that one problem has them all.
//!
//! A step has the normal problem A λ + b ≥ 0, λ ≥ 0, λ·(A λ + b) = 0 with A = D m⁻¹ Dᵀ + M m'⁻¹ Mᵀ and the weighted
//! gaps b that the step would end with, over Δt h; then friction, A λ + b = 0 within |λ| ≤ μ λ_n. D and M are those of
//! the predicted displacements, so that the step is explicit. On matching surfaces D = M is diagonal, and nodes are
//! pairs.
//!
//! Where the end of the master slides along an edge of the slave, the second multiplier of this edge sets in: its
//! condition gives way, the less the more of the edge is covered.
//!
//! Wohlmuth, *A mortar finite element method using dual spaces for the Lagrange multiplier*; the part of an edge that
//! the other surface covers has a dual basis of its own.

mod band;
mod configuration;
mod coupling;
mod dual;
mod friction;
mod gram;
mod narrow;
mod normal;
mod onset;
mod partition;
mod relaxation;
mod rows;
mod sharing;
mod side;
mod step;
mod surfaces;
#[cfg(test)]
mod tests;

pub use configuration::ContactConfiguration;
pub use coupling::Coupling;
pub(crate) use coupling::LEAST_PART;
pub use dual::DualShape;
pub use partition::Segment;
pub use side::{CORNER, Part, Side};
pub(crate) use step::NonMatchingContact;
pub use surfaces::NonMatchingSurfaces;
pub(crate) use surfaces::tangent;
