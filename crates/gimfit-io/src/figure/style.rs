//! Colours, sizes and fonts of every figure.
//!
//! The hues are those of Okabe and Ito, which stay apart for the common forms
//! of colour blindness; line width and marker shape repeat each distinction.

pub(crate) const FONT_FAMILY: &str = "DejaVu Sans, Helvetica, Arial, sans-serif";

pub(crate) const BACKGROUND: &str = "#ffffff";
pub(crate) const INK: &str = "#1f2328";
pub(crate) const INK_SOFT: &str = "#57606a";
pub(crate) const GRID: &str = "#eceef1";
pub(crate) const FRAME: &str = "#b6bcc4";
pub(crate) const LEVEL: &str = "#8c959f";

pub(crate) const CURVE: &str = "#0072b2";
pub(crate) const CONTROL: &str = "#d55e00";
pub(crate) const DATA: &str = "#1f2328";
pub(crate) const DATA_MANY: &str = "#a9b0b8";
pub(crate) const ERROR: &str = "#7a4e9e";
pub(crate) const LARGEST: &str = "#d55e00";
pub(crate) const RMS: &str = "#0072b2";
pub(crate) const NORMAL: &str = "#008a69";

/// Ends of the ramp in which earlier iterations are drawn, pale to strong.
const RAMP_PALE: [f64; 3] = [190.0, 226.0, 214.0];
const RAMP_STRONG: [f64; 3] = [0.0, 138.0, 105.0];

pub(crate) const TITLE_SIZE: f64 = 20.0;
pub(crate) const CAPTION_SIZE: f64 = 12.0;
pub(crate) const HEADING_SIZE: f64 = 12.5;
pub(crate) const LABEL_SIZE: f64 = 11.0;
pub(crate) const NOTE_SIZE: f64 = 10.0;

/// White space around the whole figure.
pub(crate) const MARGIN: f64 = 28.0;
/// Room left of a plot for its tick labels and the name of its axis.
pub(crate) const AXIS_LEFT: f64 = 72.0;
/// Room under a plot for its tick labels and the name of its axis.
pub(crate) const AXIS_BELOW: f64 = 42.0;

/// Colour number `index` of `count` of the ramp for earlier iterations.
pub(crate) fn ramp(index: usize, count: usize) -> String {
    let t = if count > 1 { index as f64 / (count - 1) as f64 } else { 1.0 };
    let channel = |k: usize| (RAMP_PALE[k] + (RAMP_STRONG[k] - RAMP_PALE[k]) * t).round() as u8;
    format!("#{:02x}{:02x}{:02x}", channel(0), channel(1), channel(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ramp_runs_from_pale_to_strong() {
        assert_eq!(ramp(0, 5), "#bee2d6");
        assert_eq!(ramp(4, 5), "#008a69");
        assert_eq!(ramp(0, 1), "#008a69");
    }
}
