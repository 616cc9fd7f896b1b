//! The impact of an elastic body on rigid obstacles with Coulomb friction, and its explicit finite-element solution.
//!
//! A [`problem::Problem`] is stated with a builder, which checks it; [`dynamics::simulate`] runs
//! it over a [`time::TimeGrid`] and hands each [`history::Step`] to a sink. No files, no
//! printing: that is for the crates further down the chain.
//!
//! Equation numbers in brackets are those of Louf, Gallimard and Pelle, *Un estimateur d'erreur
//! en relation de comportement pour les problèmes d'impact*. All units are SI.
//!
#![doc = include_str!("method.md")]

pub mod border;
pub mod cell;
pub mod contact;
pub mod contact_results;
pub mod dynamics;
pub mod element_state;
pub mod history;
pub mod ids;
pub mod kernel;
pub mod load;
pub mod material;
pub mod memory;
pub mod mesh;
pub mod message;
pub mod observer;
pub mod problem;
mod ratio;
pub mod simd;
pub mod time;
pub mod units;
pub mod variable_steps;

pub use ratio::ratio;
