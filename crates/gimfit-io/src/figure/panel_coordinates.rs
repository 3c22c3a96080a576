//! The main panel of a curve that is no picture in itself: each coordinate
//! over the parameter, one panel above the other.

use super::extent;
use super::layers::{self, Layers, Looks};
use super::message;
use super::notes::Notes;
use super::plot::{self, Axis, Rect};
use super::range::InUnits;
use super::rows::Rows;
use super::scale::Scale;
use super::svg::Svg;
use super::ticks::Direction;

/// Most coordinates that are drawn.
const MOST: usize = 12;

/// Room between two panels.
const GAP: f64 = 12.0;

/// How many coordinates of `dimension` are drawn.
pub(super) fn drawn(dimension: usize) -> usize {
    dimension.min(MOST)
}

/// Draws all panels into `area`.
pub(super) fn draw(svg: &mut Svg, area: Rect, figure: &InUnits<'_>, notes: &mut Notes) -> Looks {
    let count = drawn(figure.dimension);
    let Some(parameters) = extent::of_parameters(figure).filter(|_| count > 0) else {
        message(svg, area, "no points to draw");
        return Looks::default();
    };
    if count < figure.dimension {
        notes.add(format!("{count} of {} coordinates drawn", figure.dimension));
    }
    let sx = Scale::new(parameters, area.x + 8.0, area.right() - 8.0);
    let across = Axis::linear(&sx, Direction::Across, figure.parameter_name, figure.parameter_unit);
    let height = (area.height - GAP * (count - 1) as f64) / count as f64;
    let mut looks = Looks::default();
    for k in 0..count {
        let panel = Rect { y: area.y + (height + GAP) * k as f64, height, ..area };
        let mut across = across.clone();
        if k + 1 < count {
            across.name.clear();
            across.marks.iter_mut().for_each(|mark| mark.1.clear());
        }
        looks = draw_one(svg, panel, figure, k, &sx, &across, notes);
    }
    looks
}

fn draw_one(
    svg: &mut Svg,
    area: Rect,
    figure: &InUnits<'_>,
    k: usize,
    sx: &Scale,
    across: &Axis,
    notes: &mut Notes,
) -> Looks {
    let shown = extent::of_coordinates(figure, k..k + 1, notes);
    let Some(values) = shown.first().copied().flatten() else {
        message(svg, area, "no points to draw");
        return Looks::default();
    };
    let sy = Scale::new(extent::padded(values), area.bottom(), area.y);
    let upward = Axis::linear(&sy, Direction::Upward, &figure.coordinate_name(k), figure.unit(k));
    notes.offset(&[across, &upward]);
    plot::draw_axes(svg, area, across, &upward);
    let places = |parameters: &[f64], rows: Rows<'_>| {
        parameters
            .iter()
            .zip(rows.iter())
            .map(|(&t, row)| (sx.at(t), sy.at(row[k])))
            .collect::<Vec<_>>()
    };
    let layers = Layers {
        data: places(figure.parameters, figure.data()),
        control: places(figure.abscissae_of_control_points, figure.control()),
        // Over the parameter, the end of a closed curve is not its start.
        closed: false,
        curve: places(figure.curve_samples.parameters, figure.curve()),
        pieces: Vec::new(),
        earlier: layers::earlier_drawn(figure.sequence.len())
            .into_iter()
            .map(|index| {
                let curve = &figure.sequence[index].curve;
                places(curve.parameters, Rows::new(curve.points, figure.dimension))
            })
            .collect(),
    };
    let share = 1.0 / drawn(figure.dimension) as f64;
    layers.draw(svg, area, &format!("coordinate-{k}"), share, notes)
}
