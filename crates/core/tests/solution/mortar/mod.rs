//! Contact of two bodies that slide along each other, with any nodes.

mod beside;
mod half;
mod invariance;
mod law;
mod limits;
mod patch;
mod refusals;
mod roles;
pub(crate) mod setup;
mod several;
mod stack;
mod start;
mod tilted;
