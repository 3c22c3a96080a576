//! A faint line at the residual below which rounding rules.

use super::legend::{Entry, Sample};
use super::log_axis::LogScale;
use super::plot::Rect;
use super::style;
use super::svg::Svg;

const NAME: &str = "10⁻¹² × extent";

/// Residual, relative to the extent of the data, that counts as reached.
const RELATIVE: f64 = 1.0e-12;

/// The residual at which the line lies; not positive where there is no extent.
pub(super) fn value(extent: f64) -> f64 {
    if extent.is_finite() { RELATIVE * extent } else { 0.0 }
}

/// Draws the line, if the axis holds it; tells whether it does.
pub(super) fn draw(svg: &mut Svg, area: Rect, extent: f64, log: &LogScale) -> bool {
    let value = value(extent);
    if !log.holds(value) {
        return false;
    }
    let (y, _) = log.at(value);
    svg.tag("path")
        .attribute("d", &format!("M{:.2} {y:.2}H{:.2}", area.x, area.right()))
        .attribute("stroke", style::LEVEL)
        .number("stroke-width", 1.0)
        .attribute("stroke-dasharray", "2 3")
        .end();
    true
}

/// Its entry in a legend.
pub(super) fn entry() -> Entry {
    Entry {
        sample: Sample::Dots(style::LEVEL.to_owned(), 1.0), name: "10⁻¹² × extent".to_owned()
    }
}

/// Writes its name beside the line, on the side where a falling curve is not.
pub(super) fn label(svg: &mut Svg, area: Rect, extent: f64, log: &LogScale) {
    let (y, _) = log.at(value(extent));
    let low = y > area.y + 0.5 * area.height;
    let (x, anchor) = if low { (area.x + 6.0, "start") } else { (area.right() - 6.0, "end") };
    // Above the line, unless the frame leaves no room there.
    let above = y - 4.0 > area.y + style::NOTE_SIZE;
    let y = if above { y - 4.0 } else { y + style::NOTE_SIZE + 2.0 };
    svg.label((x, y), style::NOTE_SIZE, style::LEVEL, anchor, NAME);
}
