//! What a fit yields: curves and surfaces that can be evaluated, derived and drawn.

mod bend;
mod blending;
mod curve;
mod insertion;
mod rational;
mod surface;
mod triangle;

pub(crate) use bend::bend_signs;
pub use blending::{BlendingCurve, BlendingSurface};
pub use curve::Curve;
pub(crate) use insertion::KnotInsertion;
pub use surface::Surface;
pub(crate) use triangle::check_triangle_degree;
pub use triangle::{MAX_TRIANGLE_DEGREE, TriangularPatch, triangle_indices, triangle_points};

use crate::Error;

/// Refuses a buffer of another length.
fn check_buffer(buffer: &[f64], expected: usize) -> Result<(), Error> {
    if buffer.len() == expected {
        return Ok(());
    }
    Err(Error::WrongCount {
        what: "buffer entries",
        given: buffer.len(),
        expected,
        why: "the dimension times the number of derivatives asked for",
    })
}
