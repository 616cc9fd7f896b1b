//! Every way in which a mesh or a problem can be refused, with the numbers that the error names.

mod beside;
mod mesh;
mod parts;
mod problem;
mod proposals;
mod random;
mod time;
