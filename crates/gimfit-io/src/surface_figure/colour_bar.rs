//! The scale of the error map, and the bar beside the map that shows it.

use super::colours;
use crate::figure::log_axis::LogScale;
use crate::figure::plot::Rect;
use crate::figure::scale::{Interval, Scale};
use crate::figure::svg::Svg;
use crate::figure::ticks::{self, Direction};
use crate::figure::{style, text};

/// Errors that differ by this factor get a logarithmic scale.
const WIDE: f64 = 50.0;

/// On a logarithmic scale, this part of the errors may lie below its end: a
/// few that happen to be tiny would take all colours from the others.
const BELOW: f64 = 0.01;

/// A map from errors to the height at which the bar shows them.
pub(super) enum ErrorScale {
    /// For errors of about one size.
    Linear(Scale),
    /// For errors over decades.
    Logarithmic(LogScale),
}

impl ErrorScale {
    /// The scale for the positive ones of `errors` on a bar from `bottom` to
    /// `top`; `None` if there are none.
    pub(super) fn of(errors: &[f64], bottom: f64, top: f64) -> Option<Self> {
        let mut positive: Vec<f64> = errors.iter().copied().filter(|v| *v > 0.0).collect();
        let all = Interval::around(positive.iter().copied())?;
        if all.high / all.low <= WIDE {
            let low = if all.low > 0.5 * all.high { all.low } else { 0.0 };
            return Some(Self::Linear(Scale::new(Interval { low, ..all }, bottom, top)));
        }
        let rank = (BELOW * positive.len() as f64) as usize;
        let low = *positive.select_nth_unstable_by(rank, f64::total_cmp).1;
        LogScale::around([low, all.high].into_iter(), bottom, top).map(Self::Logarithmic)
    }

    /// The height of `error`, and whether it lies below the scale.
    pub(super) fn at(&self, error: f64) -> (f64, bool) {
        match self {
            Self::Linear(scale) => (scale.at(error), false),
            Self::Logarithmic(scale) => scale.at(error),
        }
    }

    /// The error at the lower end, as a label; empty on a linear scale.
    pub(super) fn bottom_label(&self) -> String {
        match self {
            Self::Linear(_) => String::new(),
            Self::Logarithmic(scale) => scale.bottom_label(),
        }
    }

    /// Heights and labels, and what all labels have in common.
    fn marks(&self) -> (Vec<(f64, String)>, String) {
        match self {
            Self::Linear(scale) => {
                let ticks =
                    ticks::linear_ticks(scale.values(), scale.length(), Direction::Upward, 0);
                let marks = ticks.marks.into_iter().map(|(v, label)| (scale.at(v), label));
                (marks.collect(), ticks.common)
            }
            Self::Logarithmic(scale) => (scale.marks(17.0), String::new()),
        }
    }
}

/// Draws the bar into `bar`, with labels at its right.
pub(super) fn draw(svg: &mut Svg, bar: Rect, scale: &ErrorScale) {
    let height = bar.height / colours::STEPS as f64;
    svg.tag("g").attribute("shape-rendering", "crispEdges").open();
    for step in 0..colours::STEPS {
        let y = bar.bottom() - (step + 1) as f64 * height;
        swatch(svg, Rect { y, height, ..bar }, &colours::colour(step));
    }
    svg.close("g");
    svg.tag("rect")
        .number("x", bar.x)
        .number("y", bar.y)
        .number("width", bar.width)
        .number("height", bar.height)
        .attribute("fill", "none")
        .attribute("stroke", style::FRAME)
        .end();
    let (marks, common) = scale.marks();
    for (at, label) in marks {
        svg.line((bar.right(), at), (bar.right() + 3.0, at), style::FRAME, 1.0);
        label_at(svg, bar, at, &label);
    }
    if !common.is_empty() {
        let common = text::fit(&common, style::LABEL_SIZE, 180.0);
        let right = bar.right() + 42.0;
        svg.label((right, bar.y - 10.0), style::LABEL_SIZE, style::INK_SOFT, "end", &common);
    }
}

/// Room under the bar for the colour of zeros.
pub(super) const FOR_ZERO: f64 = 22.0;

/// Draws the colour of zeros under the bar.
pub(super) fn draw_zero(svg: &mut Svg, bar: Rect) {
    let area = Rect { y: bar.bottom() + FOR_ZERO - 11.0, height: 11.0, ..bar };
    svg.tag("rect")
        .number("x", area.x)
        .number("y", area.y)
        .number("width", area.width)
        .number("height", area.height)
        .attribute("fill", colours::ZERO)
        .attribute("stroke", style::FRAME)
        .end();
    label_at(svg, area, area.y + 0.5 * area.height, "0");
}

fn label_at(svg: &mut Svg, bar: Rect, y: f64, label: &str) {
    let size = style::LABEL_SIZE;
    svg.label((bar.right() + 6.0, y + 0.36 * size), size, style::INK_SOFT, "start", label);
}

fn swatch(svg: &mut Svg, area: Rect, colour: &str) {
    svg.tag("rect")
        .number("x", area.x)
        .number("y", area.y)
        .number("width", area.width)
        .number("height", area.height)
        .attribute("fill", colour)
        .end();
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_logarithmic(errors: &[f64]) -> bool {
        matches!(ErrorScale::of(errors, 100.0, 0.0), Some(ErrorScale::Logarithmic(_)))
    }

    #[test]
    fn decades_make_the_scale_logarithmic() {
        assert!(is_logarithmic(&[1.0e-9, 1.0, 0.0, f64::NAN]));
        assert!(!is_logarithmic(&[0.1, 1.0, 0.0]));
        assert!(is_logarithmic(&[f64::INFINITY, 1.0e-320]));
        assert!(ErrorScale::of(&[0.0, -1.0, f64::NAN], 100.0, 0.0).is_none());
    }

    #[test]
    fn one_tiny_error_of_many_does_not_take_the_colours() {
        let mut errors = vec![1.0e-3; 500];
        errors[0] = 1.0e-17;
        errors[1] = 0.5;
        let scale = ErrorScale::of(&errors, 100.0, 0.0).unwrap();
        assert_eq!(scale.bottom_label(), "10⁻³");
        assert_eq!(scale.at(errors[0]), (100.0, true));
    }
}
