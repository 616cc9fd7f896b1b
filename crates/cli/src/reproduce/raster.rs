//! From SVG to PNG, with a font of its own: a machine may have none.

use super::error::ReproduceError;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};
use std::sync::Arc;

/// Pixels of the image for each pixel of the drawing: sharp on fine screens and in print.
pub const SCALE: f32 = 2.0;

/// Makes images of drawings.
pub struct Raster {
    options: Options<'static>,
}

impl Raster {
    /// With DejaVu Sans for all text.
    #[must_use]
    pub fn new() -> Self {
        let mut options = Options::default();
        let fonts = Arc::make_mut(&mut options.fontdb);
        fonts.load_font_data(dejavu::sans::regular().to_vec());
        fonts.load_font_data(dejavu::sans::bold().to_vec());
        fonts.set_sans_serif_family("DejaVu Sans");
        options.font_family = "DejaVu Sans".to_string();
        Self { options }
    }

    /// The PNG of a drawing, [`SCALE`] times as large.
    ///
    /// # Errors
    /// [`ReproduceError::Unexpected`] for what is no drawing.
    pub fn png(&self, svg: &str) -> Result<Vec<u8>, ReproduceError> {
        let wrong = |cause: String| ReproduceError::Unexpected(format!("a figure cannot be made an image: {cause}"));
        let tree = Tree::from_str(svg, &self.options).map_err(|error| wrong(error.to_string()))?;
        let [width, height] = [tree.size().width(), tree.size().height()].map(|side| (side * SCALE).round() as u32);
        let mut image = Pixmap::new(width, height).ok_or_else(|| wrong(format!("it is {width} by {height} pixels")))?;
        resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut image.as_mut());
        image.encode_png().map_err(|error| wrong(error.to_string()))
    }
}

impl Default for Raster {
    fn default() -> Self {
        Self::new()
    }
}
