//! The facets of a surface, drawn from the farthest to the nearest.

use super::depth::{DepthMap, Spot};
use super::panel_surface::Placed;
use super::shades::{self, Shade};
use crate::figure::decimate::Px;
use crate::figure::svg::{Path, Svg};

/// Each facet is drawn larger by this much, lest the white of the paper show
/// between neighbours.
const OVERLAP: f64 = 0.35;

/// Numbers of the corners of each facet between `rows` and `columns`.
pub(super) fn corners(rows: usize, columns: usize) -> Vec<[usize; 4]> {
    let mut facets = Vec::new();
    for i in 1..rows {
        for j in 1..columns {
            let last = i * columns + j;
            facets.push([last - columns - 1, last - columns, last, last - 1]);
        }
    }
    facets
}

/// Lays all facets of `mesh` into `map`.
pub(super) fn lay(mesh: &Placed, map: &mut DepthMap) {
    for (number, corners) in corners(mesh.rows, mesh.columns).into_iter().enumerate() {
        map.lay(corners.map(|k| mesh.spots[k]), number as u32);
    }
}

/// Draws the facets of `mesh` that are seen in `map`.
pub(super) fn draw(svg: &mut Svg, mesh: &Placed, map: &DepthMap) {
    let facets = corners(mesh.rows, mesh.columns);
    let seen = map.seen(facets.len());
    let mut drawn: Vec<Facet> = Vec::new();
    let mut toward = 0.0;
    for (corners, seen) in facets.iter().zip(seen) {
        let spots = corners.map(|k| mesh.spots[k]);
        let centre = centre(&spots);
        if !centre.is_number() || (seen == 0 && map.hides(centre, 0.0)) {
            continue;
        }
        let [a, b, c, d] = corners.map(|k| mesh.turned[k]);
        let normal = shades::normal(a, b, c, d);
        if normal[2].is_finite() {
            toward += normal[2].signum() * f64::from(seen);
        }
        drawn.push(Facet { spots, centre, normal });
    }
    // The side of which more is seen counts as the front.
    let front_is_toward = toward >= 0.0;
    drawn.sort_by(|a, b| a.centre.depth.total_cmp(&b.centre.depth));
    let shaded: Vec<(Shade, [Px; 4])> = drawn
        .iter()
        .map(|facet| (Shade::of(facet.normal, front_is_toward), facet.outline()))
        .collect();
    let mut order = Order::new(map);
    let mut paths: Vec<(Shade, Path)> = Vec::new();
    for (facet, (shade, outline)) in drawn.iter().zip(&shaded) {
        // The latest path of this shade will do unless a later one lies under the facet.
        let under = order.under(facet.spots);
        let same = paths.iter().rposition(|path| path.0 == *shade);
        let place = same.filter(|place| *place >= under).unwrap_or(paths.len());
        if place == paths.len() {
            paths.push((*shade, Path::default()));
        }
        if let Some((_, path)) = paths.get_mut(place) {
            path.polygon_in_tenths(outline);
        }
        order.lay(facet.spots, place);
    }
    for (shade, path) in &paths {
        svg.tag("path").attribute("d", path.data()).attribute("fill", &shade.colour()).end();
    }
}

/// Which path was last drawn where.
struct Order<'a> {
    map: &'a DepthMap,
    last: Vec<u32>,
}

impl<'a> Order<'a> {
    fn new(map: &'a DepthMap) -> Self {
        Self { map, last: vec![0; map.len()] }
    }

    /// The last path drawn under a facet with these corners.
    fn under(&self, corners: [Spot; 4]) -> usize {
        let mut last = 0;
        self.map.each_cell(corners, |cell| last = last.max(self.last[cell]));
        last as usize
    }

    fn lay(&mut self, corners: [Spot; 4], path: usize) {
        let last = &mut self.last;
        self.map.each_cell(corners, |cell| last[cell] = last[cell].max(path as u32));
    }
}

/// One facet.
struct Facet {
    spots: [Spot; 4],
    centre: Spot,
    normal: [f64; 3],
}

fn centre(spots: &[Spot; 4]) -> Spot {
    let mean = |value: fn(&Spot) -> f64| 0.25 * spots.iter().map(value).sum::<f64>();
    Spot { at: (mean(|s| s.at.0), mean(|s| s.at.1)), depth: mean(|s| s.depth) }
}

impl Facet {
    /// The corners, a little outward, in whole tenths, always in the same
    /// sense of turning: facets of one path must not cut holes into others.
    fn outline(&self) -> [Px; 4] {
        let (x, y) = self.centre.at;
        let mut outline = self.spots.map(|spot| {
            let (dx, dy) = (spot.at.0 - x, spot.at.1 - y);
            let length = dx.hypot(dy);
            let grown = if length > 0.0 { 1.0 + OVERLAP / length } else { 1.0 };
            let tenths = |value: f64| (10.0 * value).round() / 10.0;
            (tenths(x + grown * dx), tenths(y + grown * dy))
        });
        let [a, b, c, d] = outline;
        if (c.0 - a.0) * (d.1 - b.1) < (c.1 - a.1) * (d.0 - b.0) {
            outline.reverse();
        }
        outline
    }
}
