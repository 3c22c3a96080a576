//! The figure of fits to choose from: errors over numbers of control points.

use super::layout::{Layout, whole, wrapped_caption};
use super::notes::Notes;
use super::panel_history::{Histories, draw};
use super::plot::Rect;
use super::style::{AXIS_BELOW, AXIS_LEFT, MARGIN};
use super::svg::Svg;

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 400.0;

/// All that a figure of fits to choose from shows; slices of unequal length are drawn as far as they go
/// together.
#[derive(Clone, Copy, Debug)]
pub struct ChoicesFigure<'a> {
    /// Heading of the figure, such as the name of the file.
    pub title: &'a str,
    /// What was done, in a line or two.
    pub caption: &'a str,
    /// Control points of each fit, ascending.
    pub control_points: &'a [usize],
    /// Largest distance of a data point from each fit.
    pub largest: &'a [f64],
    /// Root of the mean squared distance from each fit.
    pub rms: &'a [f64],
}

/// Draws `figure` as SVG.
pub fn choices_figure_svg(figure: &ChoicesFigure<'_>) -> String {
    let width = 2.0 * MARGIN + AXIS_LEFT + WIDTH;
    let (caption, top) = wrapped_caption(figure.caption, width);
    let area = Rect { x: MARGIN + AXIS_LEFT, y: top + 24.0, width: WIDTH, height: HEIGHT };
    let layout = Layout {
        main: area,
        error: area,
        history: area,
        width,
        bottom: area.bottom() + AXIS_BELOW,
    };
    let errors = figure.largest.iter().zip(figure.rms);
    let residuals: Vec<(usize, f64, f64)> =
        figure.control_points.iter().zip(errors).map(|(n, (max, rms))| (*n, *max, *rms)).collect();
    let histories = Histories {
        residuals: &residuals,
        normal: &[],
        names: ["Fits to choose from", "control points", "distance"],
    };
    let (mut svg, mut notes) = (Svg::default(), Notes::default());
    draw(&mut svg, area, histories, 0.0, &mut notes);
    whole(figure.title, &layout, &caption, &notes, &svg.finish())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_fit_is_drawn_and_none_is_no_panic() {
        let figure = ChoicesFigure {
            title: "an airfoil",
            caption: "degree 3",
            control_points: &[5, 8, 13],
            largest: &[0.1, 0.01, 0.001],
            rms: &[0.05, 0.004, 0.0002],
        };
        let svg = choices_figure_svg(&figure);
        for text in ["an airfoil", "control points", "distance", "largest", "rms"] {
            assert!(svg.contains(text), "{text}");
        }
        // A dot for each of three fits in each of two series.
        assert_eq!(svg.matches("h.01").count(), 6);
        let none = ChoicesFigure { control_points: &[], largest: &[], rms: &[], ..figure };
        assert!(choices_figure_svg(&none).contains("no history"));
    }
}
