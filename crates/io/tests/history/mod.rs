//! History files: what comes back, what is refused, and what a kill leaves.

mod common;
mod damage;
mod foreign;
mod kill;
mod places;
mod refusals;
mod resume;
mod round_trip;
