//! The part of space that the surface panel shows, and its proportions.

use super::SurfaceFigure;
use super::grid::{Grid, Point, Source};
use crate::figure::extent::{cut, padded};
use crate::figure::notes::Notes;
use crate::figure::panel_space::THINNEST;
use crate::figure::scale::{Interval, shortest_span};
use crate::figure::view::View;

/// Heights over parameters: the height of the box, relative to its floor.
const HEIGHT: f64 = 0.42;

/// The mean slope of heights that have that height; steeper, rougher ones are
/// drawn lower, down to [`LOWEST`] of it.
const STEEPEST: f64 = 0.55;
const LOWEST: f64 = 0.4;

/// Points looked at to find the slope, about as many as are drawn.
const MOST_POINTS: usize = 9000;

/// Heights over a plane grid with a relative height between these are drawn
/// at the scale of the floor, others like heights over parameters.
const PLAIN_HEIGHT: (f64, f64) = (0.12, 0.8);

/// Floors longer than this many times their width are drawn as squares, if
/// their sides are parameters.
const LONGEST_FLOOR: f64 = 3.0;

/// Coordinates whose span is less than this part of the largest one are drawn
/// at a scale of their own, with the length [`STRETCHED`].
const FLATTEST: f64 = 0.04;
const STRETCHED: f64 = 0.3;

/// A box of space, and the lengths along its axes that are drawn as one.
pub(super) struct Room {
    pub(super) sides: [Interval; 3],
    centre: [f64; 3],
    unit: [f64; 3],
}

impl Room {
    /// The room of `figure`, or `None` without any point.
    pub(super) fn of(figure: &SurfaceFigure<'_>, notes: &mut Notes) -> Option<Self> {
        let [x, y, z] = intervals(figure, notes);
        let shown = [x?, y?, z?];
        let size = shown.iter().map(|i| i.low.abs().max(i.high.abs())).fold(0.0, f64::max);
        let spans = shown.map(|values| values.span());
        let longest = spans.iter().copied().fold(0.0, f64::max);
        let unit = if figure.dimension == 1 {
            over_floor(figure, &shown)
        } else if is_steep_or_low(figure, &shown) {
            notes.add("coordinates drawn at unequal scales".to_owned());
            over_floor(figure, &shown)
        } else if longest > shortest_span(size) {
            let own = spans.map(|span| {
                span < FLATTEST * longest && span > shortest_span(size).max(1.0e-9 * longest)
            });
            if own.contains(&true) {
                notes.add("coordinates drawn at unequal scales".to_owned());
            }
            let unit = |k: usize| if own[k] { spans[k] / STRETCHED } else { longest };
            [0, 1, 2].map(|k| 0.5 * unit(k))
        } else {
            [0.5 * shown.map(|i| i.opened().span()).into_iter().fold(0.0, f64::max); 3]
        };
        let sides = [0, 1, 2].map(|k| {
            let missing = (THINNEST * 2.0 * unit[k] - spans[k]).max(0.0);
            padded(shown[k].grown(0.5 * missing))
        });
        Some(Self { sides, centre: sides.map(|side| side.centre()), unit })
    }

    /// The view of the room from these angles in degrees.
    pub(super) fn view(&self, azimuth: f64, elevation: f64) -> View {
        View::from_angles(azimuth, elevation, self.centre, self.unit)
    }
}

/// Whether `figure` shows heights over a plane grid that would be hard to see
/// at the scale of the floor.
fn is_steep_or_low(figure: &SurfaceFigure<'_>, shown: &[Interval; 3]) -> bool {
    let (width, floor) =
        (shown[0].span().min(shown[1].span()), shown[0].span().max(shown[1].span()));
    let (height, size) = (shown[2].span(), shown[2].low.abs().max(shown[2].high.abs()));
    let (low, high) = (PLAIN_HEIGHT.0 * floor, PLAIN_HEIGHT.1 * floor);
    let plain = (low..=high).contains(&height);
    let flat = height <= shortest_span(size).max(1.0e-9 * floor);
    !plain && !flat && width > FLATTEST * floor && figure.data().is_over_plane_grid()
}

/// Units for heights over a floor of parameters or a plane grid.
fn over_floor(figure: &SurfaceFigure<'_>, shown: &[Interval; 3]) -> [f64; 3] {
    let [u, v, z] = shown.map(|values| 0.5 * values.opened().span());
    let (u, v) =
        if u < LONGEST_FLOOR * v && v < LONGEST_FLOOR * u { (u.max(v), u.max(v)) } else { (u, v) };
    let unit = [u, v, z / HEIGHT];
    let slope = mean_slope(&figure.data().thinned(MOST_POINTS, [false; 2]), unit);
    // A slope that is no number asks for nothing.
    let lowered = if slope > STEEPEST { (STEEPEST / slope).max(LOWEST) } else { 1.0 };
    [u, v, unit[2] / lowered]
}

/// How far the heights of `grid` rise or fall from point to point, relative to
/// how far the points lie apart on the floor, in these units.
fn mean_slope(grid: &Grid, unit: [f64; 3]) -> f64 {
    let (mut risen, mut walked) = (0.0, 0.0);
    let mut step = |from: &Point, to: &Point| {
        let [u, v, z] = [0, 1, 2].map(|k| (to[k] - from[k]) / unit[k]);
        if u.is_finite() && v.is_finite() && z.is_finite() {
            risen += z.abs();
            walked += u.hypot(v);
        }
    };
    for (k, point) in grid.points.iter().enumerate() {
        if k % grid.columns > 0 {
            step(&grid.points[k - 1], point);
        }
        if k >= grid.columns {
            step(&grid.points[k - grid.columns], point);
        }
    }
    risen / walked
}

/// For each coordinate the interval to show, without padding.
///
/// Data points are always inside; the surface and its net count as far as
/// they stray no further than the data are wide.
pub(super) fn intervals(figure: &SurfaceFigure<'_>, notes: &mut Notes) -> [Option<Interval>; 3] {
    let data = figure.data().intervals();
    let spans = data.map(|values| values.map_or(0.0, |values| values.span()));
    let longest = spans.into_iter().fold(0.0, f64::max);
    let mut shown = data;
    let mut strayed = false;
    let others: [Source<'_>; 2] = [figure.mesh(), figure.net()];
    for other in others.map(|source| source.intervals()) {
        for k in 0..3 {
            let Some(values) = other[k] else { continue };
            // Parameters and heights have no length in common.
            let allowance = if figure.dimension == 1 { spans[k] } else { longest };
            let (values, cut) = cut(values, data[k], allowance);
            strayed |= cut;
            shown[k] = Some(shown[k].map_or(values, |old| old.union(values)));
        }
    }
    if strayed {
        notes.add("surface or control net reach beyond the picture".to_owned());
    }
    shown
}
