//! Lines on and about a surface, as far as nothing hides them.

use super::depth::{DepthMap, Spot};
use super::panel_surface::Placed;
use crate::figure::decimate::{Px, thin_polyline};
use crate::figure::layers;
use crate::figure::svg::Svg;

/// Lines are looked at in steps of this length.
const STEP: f64 = 1.5;

/// Most steps of one segment; only those far outside the picture need more.
const MOST_STEPS: f64 = 800.0;

/// More vertices than thinned grids have.
const MOST_VERTICES: usize = 30_000;

/// Draws every `strides`-th row and column of `grid`, and the last ones.
pub(super) fn draw(
    svg: &mut Svg,
    grid: &Placed,
    strides: [usize; 2],
    map: &DepthMap,
    slack: f64,
    colour: &str,
    width: f64,
) {
    let mut visible = Vec::new();
    for i in chosen(grid.rows, strides[0]) {
        let row: Vec<Spot> = (0..grid.columns).map(|j| grid.spots[i * grid.columns + j]).collect();
        add_visible(&row, map, slack, &mut visible);
    }
    for j in chosen(grid.columns, strides[1]) {
        let column: Vec<Spot> = (0..grid.rows).map(|i| grid.spots[i * grid.columns + j]).collect();
        add_visible(&column, map, slack, &mut visible);
    }
    let thinned = thin_polyline(&visible, MOST_VERTICES);
    layers::stroke(svg, &layers::polyline(&thinned.points), colour, width);
}

/// Every `stride`-th of `count` lines, and the last.
fn chosen(count: usize, stride: usize) -> impl Iterator<Item = usize> {
    (0..count).filter(move |k| k.is_multiple_of(stride.max(1)) || k + 1 == count)
}

/// Appends the visible parts of the line through `spots`, each part with no
/// number at its end.
fn add_visible(spots: &[Spot], map: &DepthMap, slack: f64, visible: &mut Vec<Px>) {
    let gap = (f64::NAN, f64::NAN);
    for pair in spots.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        if !from.is_number() || !to.is_number() {
            visible.push(gap);
            continue;
        }
        let length = (to.at.0 - from.at.0).hypot(to.at.1 - from.at.1);
        let steps = (length / STEP).ceil().clamp(1.0, MOST_STEPS);
        for k in 0..=steps as usize {
            let t = k as f64 / steps;
            let between = |a: f64, b: f64| a + t * (b - a);
            let at = (between(from.at.0, to.at.0), between(from.at.1, to.at.1));
            let spot = Spot { at, depth: between(from.depth, to.depth) };
            visible.push(if map.hides(spot, slack) { gap } else { at });
        }
    }
    visible.push(gap);
}
