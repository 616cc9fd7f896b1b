//! Contact tractions concentrated at a node: hats on its candidate edges, narrower than the edges, and the stress that
//! balances them in the star of the node.

mod cut_star;
mod edge_rest;
mod edge_traction;
mod hat_stress;
mod layer;
mod least_energy;
mod panel;
mod shape;
mod star_stress;

pub(crate) use edge_rest::{EdgeRest, RestStress, rest_stress};
pub(crate) use edge_traction::EdgeTraction;
pub(crate) use hat_stress::{HatStress, StarFrame};
pub(crate) use shape::{LoadedStar, ShapeCosts, TractionShape};
pub(crate) use star_stress::{StarElement, StarResiduals, StarStress};

/// Widths of narrow hats: a half of the edge, a quarter, …
pub(crate) const HATS: usize = 10;

/// The place of a component of a unit hat in the forms of a star; the width of the hat is that of the edge over two to
/// the power of `halvings`.
pub(crate) fn place(edge: usize, halvings: usize, component: usize) -> usize {
    2 * (HATS * edge + halvings - 1) + component
}
