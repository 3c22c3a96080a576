//! Figures of a fitted surface: SVG text, from which
//! [`svg_to_png`](crate::figure::svg_to_png) draws PNG pictures.
//!
//! A figure of a surface shows the shaded surface with its data points and
//! control net, the error at each data point as a map over the rows and
//! columns of the grid, and how the iteration converged. The same input gives
//! the same bytes, and however many points there are, the SVG stays below
//! about a megabyte.
//!
//! ```
//! use gimfit_io::figure::svg_to_png;
//! use gimfit_io::surface_figure::{SurfaceFigure, surface_figure_svg};
//!
//! let heights = [0.0, 1.0, 0.5, 2.0, 1.0, 0.0];
//! let (u, v) = ([0.0, 1.0], [0.0, 0.5, 1.0]);
//! let svg = surface_figure_svg(&SurfaceFigure {
//!     title: "six heights",
//!     caption: "degree 1 by 1",
//!     dimension: 1,
//!     coordinate_names: &[],
//!     closed: [false, false],
//!     data_shape: [2, 3],
//!     data_points: &heights,
//!     parameters: [&u, &v],
//!     net_shape: [2, 3],
//!     control_net: &heights,
//!     net_abscissae: [&u, &v],
//!     mesh_shape: [2, 3],
//!     mesh_parameters: [&u, &v],
//!     mesh_points: &heights,
//!     residuals: &[0.0; 6],
//!     extent: 2.4,
//!     history: &[(0, 0.0, 0.0)],
//!     triangle: false,
//!     stages: None,
//!     sequence: &[],
//! });
//! let png = svg_to_png(&svg, 2.0)?;
//! assert!(png.starts_with(b"\x89PNG"));
//! # Ok::<(), gimfit_io::figure::FigureError>(())
//! ```

mod best_view;
mod colour_bar;
mod colours;
mod depth;
mod facets;
mod family;
mod grid;
mod layout;
mod lines;
mod marks;
mod panel_map;
mod panel_surface;
mod room;
mod shades;

#[cfg(test)]
mod tests;

use crate::figure::{coordinate_name, style, text};
use grid::Source;

/// Room beside the box for the name of an axis.
const LONGEST_NAME: f64 = 90.0;

/// All that a figure of a surface fit shows.
///
/// Grids are stored row by row: the second parameter, v, changes fastest.
/// Slices shorter than their shape asks for are drawn as far as they go;
/// values that are no numbers are left out.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceFigure<'a> {
    /// Heading of the figure, such as the name of the file.
    pub title: &'a str,
    /// What was done, in a line or two.
    pub caption: &'a str,
    /// Number of coordinates of each point. Of one coordinate, heights are
    /// drawn over the parameters; of two, a plane grid; of more than three,
    /// the first three.
    pub dimension: usize,
    /// Names of the coordinates; where there is none, one is made up.
    pub coordinate_names: &'a [String],
    /// Whether the surface is closed in u and in v; its control net is then
    /// drawn closed.
    pub closed: [bool; 2],
    /// Rows (along u) and columns (along v) of the data points.
    pub data_shape: [usize; 2],
    /// Data points, `dimension` values each.
    pub data_points: &'a [f64],
    /// Parameter u of each row and v of each column of the data points.
    pub parameters: [&'a [f64]; 2],
    /// Rows and columns of the control net; those of a closed direction once
    /// each.
    pub net_shape: [usize; 2],
    /// Control points as the data points.
    pub control_net: &'a [f64],
    /// Greville abscissae of the rows and columns of the control net: where
    /// control points of one coordinate stand over the parameters. Not used
    /// for more coordinates.
    pub net_abscissae: [&'a [f64]; 2],
    /// Rows and columns of the samples of the surface.
    pub mesh_shape: [usize; 2],
    /// Parameter u of each row and v of each column of the samples.
    pub mesh_parameters: [&'a [f64]; 2],
    /// Samples of the surface as the data points. A direction in which it is
    /// closed may end with its first row or column again, or without.
    pub mesh_points: &'a [f64],
    /// Distance of the surface from each data point.
    pub residuals: &'a [f64],
    /// Diagonal of the bounding box of the data points.
    pub extent: f64,
    /// Iteration, largest residual and root mean square residual.
    pub history: &'a [(usize, f64, f64)],
    /// Whether the data points and the net fill only the lower left triangle
    /// of their square shapes, which the legend then counts.
    pub triangle: bool,
    /// The step after which the history is that of the rows of what the
    /// columns gave, where one direction ran after the other.
    pub stages: Option<usize>,
    /// Fits of earlier iterations, drawn side by side under the others.
    pub sequence: &'a [Member<'a>],
}

/// A fit of an earlier iteration.
#[derive(Clone, Copy, Debug)]
pub struct Member<'a> {
    /// Steps taken.
    pub iteration: usize,
    /// Samples of its surface, as those of the final one.
    pub mesh_points: &'a [f64],
    /// Its distance from each data point.
    pub residuals: &'a [f64],
}

/// Draws `figure` as SVG.
pub fn surface_figure_svg(figure: &SurfaceFigure<'_>) -> String {
    layout::surface_figure(figure)
}

impl<'a> SurfaceFigure<'a> {
    fn data(&self) -> Source<'a> {
        Source::new(self.data_shape, self.data_points, self.dimension, self.parameters)
    }

    fn net(&self) -> Source<'a> {
        Source::new(self.net_shape, self.control_net, self.dimension, self.net_abscissae)
    }

    fn mesh(&self) -> Source<'a> {
        Source::new(self.mesh_shape, self.mesh_points, self.dimension, self.mesh_parameters)
    }

    /// The names of the axes of the surface panel, cut where they are long.
    fn axis_names(&self) -> [String; 3] {
        let fitted = |name: &str| text::fit(name, style::LABEL_SIZE + 1.0, LONGEST_NAME);
        if self.dimension == 1 {
            let given = self.coordinate_names.first().map(|name| name.trim());
            let height = given.filter(|name| !name.is_empty()).unwrap_or("z");
            return ["u", "v", height].map(fitted);
        }
        [0, 1, 2].map(|k| fitted(&coordinate_name(self.coordinate_names, self.dimension, k)))
    }
}
