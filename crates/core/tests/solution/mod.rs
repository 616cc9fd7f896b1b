//! The explicit solution against mathematics: exact solutions, convergence, balances, invariance.

mod balance;
mod bar_impact;
mod contact;
mod contact_results;
mod corner;
mod critical_step;
mod early_end;
mod element_state;
mod finite;
mod free_vibration;
mod from_rest;
mod invariance;
mod loads;
mod mortar;
mod numbering;
mod pairs;
mod resume;
mod run;
mod solids;
mod supports;
mod symmetry_plane;
mod threads;
mod variable_steps;
