//! Pictures of SVG text, drawn with the font that this crate carries.

use std::sync::{Arc, OnceLock};

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

/// Subset of DejaVu Sans; its licence lies beside it.
const FONT: &[u8] = include_bytes!("font/DejaVuSans-subset.ttf");

/// More pixels than any report needs, and about 400 MB of memory.
const MOST_PIXELS: f64 = 1.0e8;

/// Why a picture could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// The text is not SVG, or the SVG has no size.
    #[error("the figure is not readable as SVG: {0}")]
    Svg(String),
    /// The picture would have no pixels, or far too many.
    #[error("a picture of {width} x {height} pixels cannot be drawn")]
    Size {
        /// Width in pixels that the scale asks for.
        width: f64,
        /// Height in pixels that the scale asks for.
        height: f64,
    },
    /// The pixels could not be written as PNG.
    #[error("the picture could not be written as PNG: {0}")]
    Png(String),
}

/// Draws `svg` as a PNG file, `scale` pixels to each unit of the SVG.
///
/// Only the embedded font is used, never one of the machine, so that the same
/// SVG gives the same picture everywhere.
pub fn svg_to_png(svg: &str, scale: f32) -> Result<Vec<u8>, FigureError> {
    let options =
        Options { font_family: "DejaVu Sans".to_owned(), fontdb: fonts(), ..Options::default() };
    let tree = Tree::from_str(svg, &options).map_err(|e| FigureError::Svg(e.to_string()))?;
    let width = (f64::from(tree.size().width()) * f64::from(scale)).ceil();
    let height = (f64::from(tree.size().height()) * f64::from(scale)).ceil();
    let drawable = width >= 1.0 && height >= 1.0 && width * height <= MOST_PIXELS;
    let mut pixels = drawable
        .then(|| Pixmap::new(width as u32, height as u32))
        .flatten()
        .ok_or(FigureError::Size { width, height })?;
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixels.as_mut());
    pixels.encode_png().map_err(|e| FigureError::Png(e.to_string()))
}

/// The embedded font, read once.
fn fonts() -> Arc<fontdb::Database> {
    static FONTS: OnceLock<Arc<fontdb::Database>> = OnceLock::new();
    Arc::clone(FONTS.get_or_init(|| {
        let mut database = fontdb::Database::new();
        database.load_font_data(FONT.to_vec());
        database.set_sans_serif_family("DejaVu Sans");
        Arc::new(database)
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dark_pixels(svg: &str) -> usize {
        let png = svg_to_png(svg, 1.0).unwrap();
        let picture = Pixmap::decode_png(&png).unwrap();
        picture.pixels().iter().filter(|p| p.alpha() > 0 && p.red() < 100).count()
    }

    #[test]
    fn text_is_drawn_without_fonts_of_the_machine() {
        let svg = |text: &str| {
            format!(
                r##"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="40">
<text x="10" y="30" font-size="20" font-family="DejaVu Sans, Helvetica" fill="#000">{text}</text></svg>"##
            )
        };
        let a = dark_pixels(&svg("curve"));
        let b = dark_pixels(&svg("curve −10×"));
        assert!(a > 100 && b > a, "{a} {b}");
        assert_eq!(dark_pixels(&svg("")), 0);
    }

    #[test]
    fn bad_input_is_an_error() {
        let good = r#"<svg xmlns="http://www.w3.org/2000/svg" width="20" height="20"/>"#;
        assert!(svg_to_png(good, 1.0).is_ok());
        assert!(matches!(svg_to_png("no svg", 1.0), Err(FigureError::Svg(_))));
        for scale in [0.0, -1.0, f32::NAN, f32::INFINITY, 1.0e9] {
            assert!(matches!(svg_to_png(good, scale), Err(FigureError::Size { .. })));
        }
    }
}
