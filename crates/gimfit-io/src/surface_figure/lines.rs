//! Lines on and about a surface, as far as nothing hides them.

use super::depth::{DepthMap, Spot};
use super::panel_surface::Placed;
use crate::figure::decimate::{Px, thin_polyline};
use crate::figure::svg::{Path, Svg};

/// Lines are looked at in steps of this length.
const STEP: f64 = 1.5;

/// Most steps of one segment; only those far outside the picture need more.
const MOST_STEPS: f64 = 800.0;

/// Ends one line before the next.
const GAP: Px = (f64::NAN, f64::NAN);

/// More vertices than thinned grids have.
const MOST_VERTICES: usize = 30_000;

/// Draws every `strides`-th row and column of `grid`, and the last ones, as
/// far as no facet lies more than `slack` before them.
pub(super) fn draw_visible(
    svg: &mut Svg,
    grid: &Placed,
    strides: [usize; 2],
    map: &DepthMap,
    slack: f64,
    pen: Pen,
) {
    let mut visible = Vec::new();
    for line in lines(grid, strides) {
        add_visible(&line, map, slack, &mut visible);
    }
    pen.draw(svg, &visible);
}

/// Draws all rows and columns of `grid`, hidden or not.
pub(super) fn draw_all(svg: &mut Svg, grid: &Placed, pen: Pen) {
    let mut all = Vec::new();
    for line in lines(grid, [1, 1]) {
        let place = |spot: &Spot| if spot.is_number() { spot.at } else { GAP };
        all.extend(line.iter().map(place));
        all.push(GAP);
    }
    pen.draw(svg, &all);
}

/// What lines look like.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pen {
    pub(super) colour: &'static str,
    pub(super) width: f64,
    pub(super) opacity: f64,
}

impl Pen {
    fn draw(self, svg: &mut Svg, points: &[Px]) {
        let mut path = Path::default();
        path.lines_in_tenths(&thin_polyline(points, MOST_VERTICES).points);
        if path.is_empty() {
            return;
        }
        svg.tag("path")
            .attribute("d", path.data())
            .attribute("fill", "none")
            .attribute("stroke", self.colour)
            .number("stroke-width", self.width)
            .attribute("stroke-linejoin", "round")
            .number("opacity", self.opacity)
            .end();
    }
}

/// Every `strides`-th row and column of `grid`, and the last ones.
fn lines(grid: &Placed, strides: [usize; 2]) -> impl Iterator<Item = Vec<Spot>> {
    let rows = chosen(grid.rows, strides[0])
        .map(|i| (0..grid.columns).map(|j| grid.spots[i * grid.columns + j]).collect::<Vec<_>>());
    let columns = chosen(grid.columns, strides[1])
        .map(|j| (0..grid.rows).map(|i| grid.spots[i * grid.columns + j]).collect());
    rows.chain(columns)
}

/// Every `stride`-th of `count` lines, and the last.
fn chosen(count: usize, stride: usize) -> impl Iterator<Item = usize> {
    (0..count).filter(move |k| k.is_multiple_of(stride.max(1)) || k + 1 == count)
}

/// Appends the visible parts of the line through `spots`, each part with no
/// number at its end.
fn add_visible(spots: &[Spot], map: &DepthMap, slack: f64, visible: &mut Vec<Px>) {
    for pair in spots.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        if !from.is_number() || !to.is_number() {
            visible.push(GAP);
            continue;
        }
        let length = (to.at.0 - from.at.0).hypot(to.at.1 - from.at.1);
        let steps = (length / STEP).ceil().clamp(1.0, MOST_STEPS);
        for k in 0..=steps as usize {
            let t = k as f64 / steps;
            let between = |a: f64, b: f64| a + t * (b - a);
            let at = (between(from.at.0, to.at.0), between(from.at.1, to.at.1));
            let spot = Spot { at, depth: between(from.depth, to.depth) };
            visible.push(if map.hides(spot, slack) { GAP } else { at });
        }
    }
    visible.push(GAP);
}
