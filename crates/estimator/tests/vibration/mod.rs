//! Free vibration in one mode, and motions without any error.

mod bar;
mod block;
mod nothing;
mod turning;
