//! Dots and squares at points, as far as nothing hides them.

use super::depth::DepthMap;
use super::panel_surface::Placed;
use crate::figure::decimate::Px;
use crate::figure::style;
use crate::figure::svg::{Path, Svg};

/// Control points closer together than this get no squares.
const CLOSEST_SQUARES: f64 = 9.0;

/// Far outside the picture, where marks would only take up bytes.
const FAR: f64 = 5000.0;

/// Draws a dot at each point of `data`.
pub(super) fn draw_dots(svg: &mut Svg, data: &Placed, map: &DepthMap, slack: f64) {
    let mut path = Path::default();
    for p in visible(data, map, slack) {
        path.dot(p);
    }
    if path.is_empty() {
        return;
    }
    svg.tag("path")
        .attribute("d", path.data())
        .attribute("fill", "none")
        .attribute("stroke", style::DATA)
        .number("stroke-width", 2.0 * dot_radius(data))
        .attribute("stroke-linecap", "round")
        .end();
}

/// Draws a square at each point of `net`, if there is room for squares.
pub(super) fn draw_squares(svg: &mut Svg, net: &Placed, map: &DepthMap, slack: f64) {
    let gap = typical_gap(net);
    if gap < CLOSEST_SQUARES {
        return;
    }
    let mut path = Path::default();
    for p in visible(net, map, slack) {
        path.square(p, (0.25 * gap).clamp(2.6, 4.6));
    }
    if path.is_empty() {
        return;
    }
    svg.tag("path")
        .attribute("d", path.data())
        .attribute("fill", style::BACKGROUND)
        .attribute("stroke", style::CONTROL)
        .number("stroke-width", 0.8)
        .end();
}

/// Radius of the dots at `data`.
pub(super) fn dot_radius(data: &Placed) -> f64 {
    (0.13 * typical_gap(data)).clamp(0.8, 1.9)
}

fn visible(grid: &Placed, map: &DepthMap, slack: f64) -> impl Iterator<Item = Px> {
    grid.spots
        .iter()
        .filter(|spot| spot.is_number() && spot.at.0.abs() < FAR && spot.at.1.abs() < FAR)
        .filter(move |spot| !map.hides(**spot, slack))
        .map(|spot| spot.at)
}

/// The median distance between neighbours in a row or a column.
fn typical_gap(grid: &Placed) -> f64 {
    let apart = |a: Px, b: Px| (a.0 - b.0).hypot(a.1 - b.1);
    let mut gaps = Vec::new();
    for (k, spot) in grid.spots.iter().enumerate() {
        if k % grid.columns > 0 {
            gaps.push(apart(grid.spots[k - 1].at, spot.at));
        }
        if k >= grid.columns {
            gaps.push(apart(grid.spots[k - grid.columns].at, spot.at));
        }
    }
    gaps.retain(|gap| gap.is_finite());
    if gaps.is_empty() {
        return 100.0;
    }
    let middle = gaps.len() / 2;
    *gaps.select_nth_unstable_by(middle, f64::total_cmp).1
}
