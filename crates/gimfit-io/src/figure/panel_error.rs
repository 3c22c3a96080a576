//! The panel of residuals, one for each data point.

use super::decimate::{Bin, bins};
use super::layers;
use super::legend;
use super::log_axis::LogScale;
use super::notes::Notes;
use super::plot::{self, Axis, Rect};
use super::scale::{Interval, Scale};
use super::svg::{Path, Svg};
use super::ticks::Direction;
use super::{CurveFigure, level, message, style, text};

/// Residuals are drawn one by one up to this number, in stretches beyond.
const MOST_SINGLE: usize = 1500;

/// Stretches, about one for each pixel of the panel.
const MOST_BINS: usize = 700;

/// Residuals that differ by this factor are drawn on a logarithmic axis.
const WIDE: f64 = 50.0;

/// So are residuals beyond this size, however alike.
const HUGE: f64 = 1.0e290;

/// Draws the panel into `area`.
pub(super) fn draw(svg: &mut Svg, area: Rect, figure: &CurveFigure<'_>, notes: &mut Notes) {
    plot::heading(svg, area, "Error at each point");
    let residuals = figure.residuals;
    let Some(values) = Interval::around(residuals.iter().copied()) else {
        message(svg, area, "no residuals");
        return;
    };
    let indices = Interval { low: 0.0, high: (residuals.len() - 1) as f64 };
    let sx = if residuals.len() == 1 {
        Scale::new(indices.grown(0.6), area.x, area.right())
    } else {
        Scale::new(indices, area.x + 6.0, area.right() - 6.0)
    };
    let across = Axis::whole(&sx, Direction::Across, "index of the point (from 0)");
    if values.high <= 0.0 {
        plot::draw_axes(svg, area, &across, &Axis::default());
        message(svg, area, "all errors are 0");
        return;
    }
    let single = residuals.len() <= MOST_SINGLE;
    let made = bins(residuals, if single { residuals.len() } else { MOST_BINS });
    if !single && let Some(bin) = made.first() {
        let count = text::grouped(bin.count);
        notes.add(format!("error drawn from smallest to largest (dot) of each {count} points"));
    }
    let bars = Bars { sx, half: 0.5 * (made.first().map_or(1, |bin| bin.count) - 1) as f64 };
    let least = residuals.iter().copied().filter(|v| *v > 0.0);
    let least = least.fold(f64::INFINITY, f64::min);
    // On a logarithmic axis nothing overflows either.
    let log = (values.high / least > WIDE || values.high > HUGE)
        .then(|| LogScale::around(residuals.iter().copied(), area.bottom() - 5.0, area.y + 5.0))
        .flatten();
    match log {
        Some(log) => {
            let log = log.reaching(level::value(figure.extent), 2);
            let below = residuals.iter().filter(|v| log.at(**v).1).count();
            if below > 0 {
                notes.add(below_sentence(below, residuals.len(), &log, single));
            }
            let axis = Axis::logarithmic(&log, "residual");
            plot::draw_axes(svg, area, &across, &axis);
            if level::draw(svg, area, figure.extent, &log) {
                legend::draw_right(svg, area, &[level::entry()]);
            }
            bars.draw(svg, area, &made, |v| log.at(v));
        }
        None => {
            let from_zero = Interval { low: 0.0, high: 1.08 * values.high };
            let sy = Scale::new(from_zero, area.bottom(), area.y);
            let upward = Axis::linear(&sy, Direction::Upward, "residual", 0);
            plot::draw_axes(svg, area, &across, &upward);
            bars.draw(svg, area, &made, |v| (sy.at(v), false));
        }
    }
}

fn below_sentence(below: usize, all: usize, log: &LogScale, single: bool) -> String {
    format!(
        "{} of {} errors below {} (0 included) drawn {} the lower edge",
        text::grouped(below),
        text::grouped(all),
        log.bottom_label(),
        if single { "as rings at" } else { "at" }
    )
}

/// Where the errors stand across the panel.
struct Bars {
    sx: Scale,
    /// From the first index of a stretch to its middle.
    half: f64,
}

impl Bars {
    fn draw(&self, svg: &mut Svg, area: Rect, bins: &[Bin], height: impl Fn(f64) -> (f64, bool)) {
        let mut dots = Path::default();
        let mut below_axis = Path::default();
        let mut stems = Path::default();
        let few = bins.len() <= 120;
        for bin in bins {
            let x = self.sx.at(bin.first as f64 + self.half);
            let (top, below) = height(bin.high);
            if bin.count > 1 {
                stems.upright(x, height(bin.low).0, top);
            } else if few && !below {
                stems.upright(x, area.bottom(), top);
            }
            if below {
                below_axis.dot((x, top));
            } else {
                dots.dot((x, top));
            }
        }
        if !stems.is_empty() {
            svg.tag("g").number("opacity", 0.35).open();
            layers::stroke(svg, &stems, style::ERROR, 1.0);
            svg.close("g");
        }
        let size = if few { 4.0 } else { 2.6 };
        draw_dots(svg, &dots, style::ERROR, size);
        // Rings, since their place is not their value.
        draw_dots(svg, &below_axis, style::ERROR, size);
        draw_dots(svg, &below_axis, style::BACKGROUND, size - 1.4);
    }
}

fn draw_dots(svg: &mut Svg, dots: &Path, colour: &str, size: f64) {
    if dots.is_empty() {
        return;
    }
    svg.tag("path")
        .attribute("d", dots.data())
        .attribute("stroke", colour)
        .number("stroke-width", size)
        .attribute("stroke-linecap", "round")
        .end();
}
