//! Contact tractions concentrated at a node: hats on its candidate edges, narrower than the edges, and the stress that
//! balances them in the star of the node.

mod cut_star;
mod shape;
mod star_stress;

pub(crate) use shape::{Hat, Pressed, resultants};
pub(crate) use star_stress::{HATS, StarElement, StarStress};
