//! The main panel of a plane curve: both coordinates at the same scale.

use super::decimate::Px;
use super::extent;
use super::layers::{self, Layers, Looks};
use super::notes::Notes;
use super::plot::{self, Axis, Rect};
use super::range::InUnits;
use super::rows::Rows;
use super::scale::{Interval, Scale, equal_scales};
use super::svg::Svg;
use super::ticks::Direction;
use super::{CurveFigure, message};

/// Room between the outermost points and the frame.
pub(crate) const INSET: f64 = 26.0;

/// The intervals that the panel shows, or `None` without any point.
pub(super) fn intervals(figure: &CurveFigure<'_>, notes: &mut Notes) -> Option<[Interval; 2]> {
    match extent::of_coordinates(figure, 0..2, notes).as_slice() {
        [Some(x), Some(y)] => Some([*x, *y]),
        _ => None,
    }
}

/// Width over height of the curve, for the choice of a layout.
pub(crate) fn aspect(shown: &[Interval; 2]) -> f64 {
    let (x, y) = (shown[0].span(), shown[1].span());
    if x.max(y) > 0.0 { x / y } else { 1.0 }
}

/// Draws the panel into `area`.
pub(super) fn draw(
    svg: &mut Svg,
    area: Rect,
    figure: &InUnits<'_>,
    shown: Option<[Interval; 2]>,
    notes: &mut Notes,
) -> Looks {
    let Some([x, y]) = shown else {
        message(svg, area, "no points to draw");
        return Looks::default();
    };
    let (sx, sy) = equal_scales(x, y, area.across(), area.upward(), INSET);
    let horizontal =
        Axis::linear(&sx, Direction::Across, &figure.coordinate_name(0), figure.unit(0));
    let upright = Axis::linear(&sy, Direction::Upward, &figure.coordinate_name(1), figure.unit(1));
    notes.offset(&[&horizontal, &upright]);
    plot::draw_axes(svg, area, &horizontal, &upright);
    layers_of(figure, sx, sy).draw(svg, area, "shape", 1.0, notes)
}

fn layers_of(figure: &CurveFigure<'_>, sx: Scale, sy: Scale) -> Layers {
    let place = |x: f64, y: f64| -> Px { (sx.at(x), sy.at(y)) };
    let places = |rows: Rows<'_>| -> Vec<Px> { rows.iter().map(|p| place(p[0], p[1])).collect() };
    let pieces = figure.curve_samples.beziers.unwrap_or_default();
    Layers {
        data: places(figure.data()),
        control: places(figure.control()),
        closed: figure.closed,
        curve: places(figure.curve()),
        pieces: pieces
            .chunks_exact(8)
            .map(|b| [place(b[0], b[1]), place(b[2], b[3]), place(b[4], b[5]), place(b[6], b[7])])
            .collect(),
        earlier: layers::earlier_drawn(figure.sequence.len())
            .into_iter()
            .map(|k| places(Rows::new(figure.sequence[k].curve.points, 2)))
            .collect(),
    }
}
