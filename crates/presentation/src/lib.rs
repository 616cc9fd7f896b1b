//! Pictures of an estimated simulation, and the page that hands it over: SVG, PNG and HTML from the JSON report, the
//! mesh and the contact results, be they of a run or of an estimate file. Nothing here prints.

mod axes;
mod body;
pub mod chart;
mod deformed;
mod document;
pub mod file;
mod page;
pub mod picture;
mod png;
mod scale;
mod svg;
mod typeset;

pub use body::Body;
pub use deformed::Deformed;
pub use document::{Document, NoDocument};
pub use page::{About, Contents, Surface, page};
pub use png::DrawError;
pub use scale::{ColourScale, colour_scale};
pub use svg::SERIES;
