//! What a fit yields: curves and surfaces that can be evaluated, derived and drawn.

mod blending;
mod curve;
mod rational;
mod surface;

pub use blending::{BlendingCurve, BlendingSurface};
pub use curve::Curve;
pub use surface::Surface;

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
