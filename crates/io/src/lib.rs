//! Files of histories and estimates.

mod library;

pub use library::hdf5_version;
