//! The panel of errors along a sequence: the convergence history, or fits to choose from.

use super::decimate::{Px, thin_polyline};
use super::layers;
use super::legend::{self, Entry, Sample};
use super::log_axis::LogScale;
use super::notes::Notes;
use super::plot::{self, Axis, Rect};
use super::scale::{Interval, Scale};
use super::svg::{Path, Svg};
use super::ticks::Direction;
use super::{level, message, style};

/// Iterations are marked one by one up to this number.
const MOST_MARKED: usize = 50;

const MOST_POINTS: usize = 1500;

/// What the panel shows, as in a [`super::CurveFigure`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Histories<'a> {
    pub(crate) residuals: &'a [(usize, f64, f64)],
    pub(crate) normal: &'a [(usize, f64)],
    /// What the panel shows, the members of the sequence, and what is measured.
    pub(crate) names: [&'a str; 3],
}

/// The names of a convergence history.
pub(crate) const CONVERGENCE: [&str; 3] = ["Convergence", "iteration", "residual"];

/// Draws the panel into `area`.
pub(crate) fn draw(
    svg: &mut Svg,
    area: Rect,
    Histories { residuals: history, normal, names }: Histories<'_>,
    extent: f64,
    notes: &mut Notes,
) {
    plot::heading(svg, area, names[0]);
    let Some(iterations) = Interval::around(history.iter().map(|h| h.0 as f64)) else {
        message(svg, area, "no history");
        return;
    };
    let sx = if iterations.span() == 0.0 {
        Scale::new(iterations.grown(0.6), area.x, area.right())
    } else {
        Scale::new(iterations, area.x + 8.0, area.right() - 8.0)
    };
    let across = Axis::whole(&sx, Direction::Across, names[1]);
    let normal_values = normal.iter().map(|h| h.1);
    let values = history.iter().flat_map(|h| [h.1, h.2]).chain(normal_values);
    let Some(log) = LogScale::around(values, area.bottom() - 5.0, area.y + 5.0) else {
        plot::draw_axes(svg, area, &across, &Axis::default());
        message(svg, area, &format!("all {}s are 0", names[2]));
        return;
    };
    let log = log.reaching(level::value(extent), 2);
    let axis = Axis::logarithmic(&log, names[2]);
    plot::draw_axes(svg, area, &across, &axis);
    if level::draw(svg, area, extent, &log) {
        level::label(svg, area, extent, &log);
    }
    let rms = Series::new(history.iter().map(|h| (h.0, h.2)), &sx, &log);
    let largest = Series::new(history.iter().map(|h| (h.0, h.1)), &sx, &log);
    let normal_series = Series::new(normal.iter().copied(), &sx, &log);
    if rms.any_below || largest.any_below || normal_series.any_below {
        notes.add(format!(
            "history below {} (0 included) drawn at the lower edge",
            log.bottom_label()
        ));
    }
    rms.draw(svg, style::RMS, true, history.len());
    largest.draw(svg, style::LARGEST, false, history.len());
    normal_series.draw(svg, style::NORMAL, false, history.len());
    let entry = |sample, name: &str| Entry { sample, name: name.to_owned() };
    let mut row = vec![
        entry(Sample::Line(style::LARGEST.to_owned(), 1.6), "largest"),
        entry(Sample::Dashes(style::RMS.to_owned(), 1.6), "rms"),
    ];
    if !normal.is_empty() {
        row.push(entry(Sample::Line(style::NORMAL.to_owned(), 1.6), "normal"));
    }
    legend::draw_right(svg, area, &row);
}

/// One measure of the residuals, iteration by iteration.
struct Series {
    places: Vec<Px>,
    any_below: bool,
}

impl Series {
    fn new(values: impl Iterator<Item = (usize, f64)>, sx: &Scale, log: &LogScale) -> Self {
        let mut any_below = false;
        let places = values
            .map(|(iteration, value)| {
                if value.is_nan() {
                    return (f64::NAN, f64::NAN);
                }
                let (y, below) = log.at(value);
                any_below |= below;
                (sx.at(iteration as f64), y)
            })
            .collect();
        Self { places, any_below }
    }

    fn draw(&self, svg: &mut Svg, colour: &str, dashed: bool, count: usize) {
        let line = layers::polyline(&thin_polyline(&self.places, MOST_POINTS).points);
        if !line.is_empty() {
            let tag = svg
                .tag("path")
                .attribute("d", line.data())
                .attribute("fill", "none")
                .attribute("stroke", colour)
                .number("stroke-width", 1.6)
                .attribute("stroke-linejoin", "round");
            if dashed {
                tag.attribute("stroke-dasharray", "5 3").end();
            } else {
                tag.end();
            }
        }
        if count > MOST_MARKED {
            return;
        }
        let mut dots = Path::default();
        for p in self.places.iter().filter(|p| !p.0.is_nan()) {
            dots.dot(*p);
        }
        if !dots.is_empty() {
            svg.tag("path")
                .attribute("d", dots.data())
                .attribute("stroke", colour)
                .number("stroke-width", 4.2)
                .attribute("stroke-linecap", "round")
                .end();
        }
    }
}
