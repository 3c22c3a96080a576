//! A faint line at the residual below which rounding rules.

use super::CurveFigure;
use super::log_axis::LogScale;
use super::plot::Rect;
use super::style;
use super::svg::Svg;

/// Residual, relative to the extent of the data, that counts as reached.
const RELATIVE: f64 = 1.0e-12;

/// The residual at which the line lies; not positive where there is no extent.
pub(super) fn value(figure: &CurveFigure<'_>) -> f64 {
    if figure.extent.is_finite() {
        RELATIVE * figure.extent
    } else {
        0.0
    }
}

/// Draws the line with its name, if the axis holds it.
pub(super) fn draw(svg: &mut Svg, area: Rect, figure: &CurveFigure<'_>, log: &LogScale) {
    let value = value(figure);
    if !log.holds(value) {
        return;
    }
    let (y, _) = log.at(value);
    svg.tag("path")
        .attribute("d", &format!("M{:.2} {y:.2}H{:.2}", area.x, area.right()))
        .attribute("stroke", style::LEVEL)
        .number("stroke-width", 0.9)
        .attribute("stroke-dasharray", "2 3")
        .end();
    // Above the line, unless the frame leaves no room there.
    let above = y - 4.0 > area.y + style::NOTE_SIZE;
    let place = (
        area.x + 6.0,
        if above { y - 4.0 } else { y + style::NOTE_SIZE + 2.0 },
    );
    svg.label(place, style::NOTE_SIZE, style::LEVEL, "start", "10⁻¹² of the extent");
}
