//! Charts as SVG: curves, heat maps and values on meshes, in small multiples with one legend.
//!
//! All are drawn in fixed colours on white. The page knows the colours of ink, grid and ground, and turns them around
//! for dark screens; those of the data stay.

mod axis;
mod colours;
mod heat;
mod legend;
mod lines;
mod mesh;
mod sheet;

pub use axis::Axis;
pub use colours::Colours;
pub use heat::{HeatMap, HeatMaps};
pub use lines::{Band, Hue, Lines, Panel, Series};
pub use mesh::{MeshMap, MeshMaps};
