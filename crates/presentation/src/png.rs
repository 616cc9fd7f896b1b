//! Pictures in pixels.

use crate::svg::Svg;
use resvg::tiny_skia::{Pixmap, PremultipliedColorU8, Transform};
use resvg::usvg::fontdb::Database;
use resvg::usvg::{Options, Tree};
use std::sync::Arc;
use thiserror::Error;

/// Pixels of a PNG for a pixel of the SVG: sharp in print and on fine screens.
const SHARPNESS: f32 = 2.0;

/// Why a picture could not be drawn.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("the picture could not be drawn: {0}")]
pub struct DrawError(String);

impl DrawError {
    fn from_library(error: impl std::fmt::Display) -> Self {
        Self(error.to_string())
    }
}

/// Renders an SVG document as PNG, with a font of its own: it is the same on all machines.
pub(crate) fn rendered(document: &str) -> Result<Vec<u8>, DrawError> {
    let mut fonts = Database::new();
    fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
    let family = fonts.faces().next().and_then(|face| face.families.first().map(|(name, _)| name.clone()));
    let family = family.unwrap_or_default();
    fonts.set_sans_serif_family(family.clone());
    let options = Options { font_family: family, fontdb: Arc::new(fonts), ..Options::default() };
    let tree = Tree::from_str(document, &options).map_err(DrawError::from_library)?;
    let size = tree.size().to_int_size().scale_by(SHARPNESS);
    let size = size.ok_or_else(|| DrawError("it has no size".to_string()))?;
    let pixels = Pixmap::new(size.width(), size.height());
    let mut pixels = pixels.ok_or_else(|| DrawError("no memory for its pixels".to_string()))?;
    resvg::render(&tree, Transform::from_scale(SHARPNESS, SHARPNESS), &mut pixels.as_mut());
    pixels.encode_png().map_err(DrawError::from_library)
}

/// Renders marks on a transparent ground.
pub(crate) fn marks(svg: &Svg) -> Result<Vec<u8>, DrawError> {
    rendered(&svg.transparent())
}

/// A PNG of rows of colours, from the top; `None` is transparent.
pub(crate) fn raster(width: usize, rows: &[Vec<Option<[u8; 3]>>]) -> Result<Vec<u8>, DrawError> {
    let pixels = Pixmap::new(width as u32, rows.len() as u32);
    let mut pixels = pixels.ok_or_else(|| DrawError("a picture without pixels".to_string()))?;
    for (pixel, colour) in pixels.pixels_mut().iter_mut().zip(rows.iter().flatten()) {
        if let Some([r, g, b]) = *colour {
            *pixel = PremultipliedColorU8::from_rgba(r, g, b, 255).unwrap_or(*pixel);
        }
    }
    pixels.encode_png().map_err(DrawError::from_library)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::svg::Anchor;

    /// Share of the pixels that are not white.
    fn inked(png: &[u8]) -> f64 {
        let pixels = Pixmap::decode_png(png).unwrap();
        let dark = pixels.pixels().iter().filter(|p| p.red() < 128 && p.alpha() > 128).count();
        dark as f64 / pixels.pixels().len() as f64
    }

    #[test]
    fn every_symbol_of_the_pictures_leaves_ink_without_system_fonts() {
        for symbol in ["√", "½", "Δ", "η", "µ", "−", "·", "e_E"] {
            let mut svg = Svg::new([40.0, 20.0]);
            svg.text("label", [10.0, 15.0], Anchor::Start, false, symbol);
            let ink = inked(&rendered(&svg.alone()).unwrap());
            assert!(ink > 0.0005, "{symbol}: {ink}");
        }
        assert!(inked(&rendered(&Svg::new([40.0, 20.0]).alone()).unwrap()) == 0.0);
    }

    #[test]
    fn a_raster_has_its_pixels() {
        let png = raster(2, &[vec![Some([1, 2, 3]), None]]).unwrap();
        let pixels = Pixmap::decode_png(&png).unwrap();
        assert_eq!((pixels.width(), pixels.height(), pixels.pixels()[1].alpha()), (2, 1, 0));
        assert_eq!(pixels.pixels()[0].red(), 1);
        assert!(raster(0, &[]).is_err());
    }
}
