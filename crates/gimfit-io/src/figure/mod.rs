//! Figures of a fit: SVG text, and PNG pictures drawn from it.
//!
//! A figure of a curve shows the curve with its data points and control
//! polygon, the error at each data point, and how the iteration converged.
//! The same input gives the same bytes, and however many points there are,
//! the SVG stays below about a megabyte.
//!
//! ```
//! use gimfit_io::figure::{CurveFigure, CurveSamples, curve_figure_svg, svg_to_png};
//!
//! let points = [0.0, 0.0, 1.0, 2.0, 3.0, 1.0];
//! let parameters = [0.0, 0.5, 1.0];
//! let svg = curve_figure_svg(&CurveFigure {
//!     title: "three points",
//!     caption: "degree 1",
//!     dimension: 2,
//!     coordinate_names: &[],
//!     parameter_name: "parameter",
//!     closed: false,
//!     data_points: &points,
//!     parameters: &parameters,
//!     control_points: &points,
//!     abscissae_of_control_points: &parameters,
//!     curve_samples: CurveSamples {
//!         parameters: &parameters,
//!         points: &points,
//!         beziers: None,
//!     },
//!     residuals: &[0.0, 0.0, 0.0],
//!     extent: 3.6,
//!     history: &[(0, 0.0, 0.0)],
//!     normal_history: &[],
//!     sequence: &[],
//! });
//! let png = svg_to_png(&svg, 2.0)?;
//! assert!(png.starts_with(b"\x89PNG"));
//! # Ok::<(), gimfit_io::figure::FigureError>(())
//! ```

mod choices;
pub(crate) mod decimate;
pub(crate) mod extent;
pub(crate) mod layers;
pub(crate) mod layout;
pub(crate) mod legend;
mod level;
pub(crate) mod log_axis;
pub(crate) mod notes;
mod panel_coordinates;
mod panel_error;
pub(crate) mod panel_history;
pub(crate) mod panel_shape;
pub(crate) mod panel_space;
pub(crate) mod plot;
mod png;
mod range;
pub(crate) mod rows;
pub(crate) mod scale;
pub(crate) mod style;
pub(crate) mod svg;
pub(crate) mod text;
pub(crate) mod ticks;
pub(crate) mod view;

#[cfg(test)]
mod tests;

pub use choices::{ChoicesFigure, choices_figure_svg};
pub use png::{FigureError, svg_to_png};

use plot::Rect;
use rows::Rows;
use svg::Svg;

/// All that a figure of a curve fit shows.
///
/// Slices of unequal length are drawn as far as they go together; values that
/// are no numbers are left out.
#[derive(Clone, Copy, Debug)]
pub struct CurveFigure<'a> {
    /// Heading of the figure, such as the name of the file.
    pub title: &'a str,
    /// What was done, in a line or two.
    pub caption: &'a str,
    /// Number of coordinates of each point.
    pub dimension: usize,
    /// Names of the coordinates; where there is none, one is made up.
    pub coordinate_names: &'a [String],
    /// Name of the parameter, such as that of a column of abscissae.
    pub parameter_name: &'a str,
    /// Whether the curve is closed; its control polygon is then drawn closed.
    pub closed: bool,
    /// Data points, `dimension` values each, one after the other.
    pub data_points: &'a [f64],
    /// Parameter of each data point.
    pub parameters: &'a [f64],
    /// Control points as the data points; those of a closed curve once each.
    pub control_points: &'a [f64],
    /// Greville abscissa of each control point: where it stands in a graph
    /// over the parameter, as curves of one or more than three coordinates
    /// are drawn.
    pub abscissae_of_control_points: &'a [f64],
    /// The fitted curve.
    pub curve_samples: CurveSamples<'a>,
    /// Distance of the curve from each data point.
    pub residuals: &'a [f64],
    /// Diagonal of the bounding box of the data points.
    pub extent: f64,
    /// Iteration, largest residual and root mean square residual.
    pub history: &'a [(usize, f64, f64)],
    /// Normal residual of least squares at each iteration; empty otherwise.
    pub normal_history: &'a [(usize, f64)],
    /// Curves of earlier iterations, the oldest first.
    pub sequence: &'a [SequenceCurve<'a>],
}

/// A curve, as points close enough together to be joined by lines.
#[derive(Clone, Copy, Debug)]
pub struct CurveSamples<'a> {
    /// Parameter of each sample.
    pub parameters: &'a [f64],
    /// Samples, as many coordinates each as the curve has; for a closed curve
    /// the first one again at the end.
    pub points: &'a [f64],
    /// The same curve, if plane and at most cubic, as cubic Bezier pieces:
    /// four points of two coordinates for each piece. Then samples may be
    /// absent.
    pub beziers: Option<&'a [f64]>,
}

/// The curve of an earlier iteration.
#[derive(Clone, Copy, Debug)]
pub struct SequenceCurve<'a> {
    /// Number of the iteration.
    pub iteration: usize,
    /// The curve after that iteration. Its Bezier pieces are not used.
    pub curve: CurveSamples<'a>,
}

/// Draws `figure` as SVG.
pub fn curve_figure_svg(figure: &CurveFigure<'_>) -> String {
    layout::curve_figure(figure)
}

impl<'a> CurveFigure<'a> {
    fn data(&self) -> Rows<'a> {
        Rows::new(self.data_points, self.dimension)
    }

    fn control(&self) -> Rows<'a> {
        Rows::new(self.control_points, self.dimension)
    }

    fn curve(&self) -> Rows<'a> {
        Rows::new(self.curve_samples.points, self.dimension)
    }

    /// The given name of coordinate `k`, or one that suits the dimension.
    fn coordinate_name(&self, k: usize) -> String {
        coordinate_name(self.coordinate_names, self.dimension, k)
    }
}

/// The name of coordinate `k` in `names`, or one that suits the dimension.
pub(crate) fn coordinate_name(names: &[String], dimension: usize, k: usize) -> String {
    match (names.get(k), dimension) {
        (Some(name), _) if !name.trim().is_empty() => name.trim().to_owned(),
        (_, 1) => "value".to_owned(),
        (_, 2 | 3) => ["x", "y", "z"].get(k).copied().unwrap_or("").to_owned(),
        _ => format!("x{}", k.saturating_add(1)),
    }
}

/// Writes `content` in the middle of an `area` that shows nothing else.
pub(crate) fn message(svg: &mut Svg, area: Rect, content: &str) {
    svg.tag("rect")
        .number("x", area.x)
        .number("y", area.y)
        .number("width", area.width)
        .number("height", area.height)
        .attribute("fill", "none")
        .attribute("stroke", style::FRAME)
        .end();
    let middle = (area.x + 0.5 * area.width, area.y + 0.5 * area.height);
    let width = text::width(content, style::CAPTION_SIZE) + 16.0;
    svg.tag("rect")
        .number("x", middle.0 - 0.5 * width)
        .number("y", middle.1 - 16.0)
        .number("width", width)
        .number("height", 24.0)
        .attribute("fill", style::BACKGROUND)
        .end();
    svg.label(middle, style::CAPTION_SIZE, style::INK_SOFT, "middle", content);
}
