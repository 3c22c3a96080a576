//! The direction from which most of a surface is seen.

use super::depth::{DepthMap, Spot};
use super::facets::corners;
use super::grid::Grid;
use super::room::Room;
use crate::figure::plot::Rect;
use crate::figure::view::View;

/// The view that readers know best; others must show more to replace it.
const FAMILIAR: (f64, f64) = (-60.0, 30.0);

/// Directions tried in each quadrant, in degrees; none looks along an axis,
/// which would hide it.
const IN_QUADRANT: [f64; 5] = [30.0, 40.0, 50.0, 60.0, 70.0];
const QUADRANTS: [f64; 4] = [-90.0, 0.0, 180.0, 90.0];

/// Heights of the viewer above the horizon, in degrees, and by how much a
/// view from there must be better.
const ELEVATIONS: [(f64, f64); 2] = [(FAMILIAR.1, 1.0), (45.0, 1.18)];

/// A small gain is not worth leaving the more familiar view.
const GAIN: f64 = 1.1;

/// Cells of the small pictures to each unit of the room, which reaches about
/// from -1 to 1.
const FINENESS: f64 = 56.0;

/// Points of the surface looked at; more would not change the view.
pub(super) const MOST_POINTS: usize = 900;

/// The view of `room` that shows most of the surface through `mesh`.
pub(super) fn choose(room: &Room, mesh: &Grid) -> View {
    let mut map = DepthMap::new(Rect { x: -1.5, y: -1.5, width: 3.0, height: 3.0 }, FINENESS);
    let familiar = room.view(FAMILIAR.0, FAMILIAR.1);
    let mut best = familiar;
    let mut most = GAIN * shown(&familiar, mesh, &mut map);
    for (elevation, handicap) in ELEVATIONS {
        for quadrant in QUADRANTS {
            for azimuth in IN_QUADRANT {
                let view = room.view(quadrant + azimuth, elevation);
                let shows = shown(&view, mesh, &mut map) / handicap;
                if shows > 1.001 * most {
                    (best, most) = (view, shows);
                }
            }
        }
    }
    best
}

/// How much of the surface `view` shows: the sum over all facets of the mean
/// of the true and the seen area, which favours facets seen a little over
/// facets seen a little better.
fn shown(view: &View, mesh: &Grid, map: &mut DepthMap) -> f64 {
    map.clear();
    let turned: Vec<[f64; 3]> = mesh.points.iter().map(|p| view.turned(p)).collect();
    let facets = corners(mesh.rows, mesh.columns);
    for (number, corners) in facets.iter().enumerate() {
        let spots = corners.map(|k| {
            let [x, y, depth] = turned[k];
            Spot { at: (x, y), depth }
        });
        map.lay(spots, number as u32);
    }
    let seen = map.seen(facets.len());
    let mut sum = 0.0;
    for (corners, seen) in facets.iter().zip(seen) {
        let [a, b, c, d] = corners.map(|k| turned[k]);
        let normal = super::shades::normal(a, b, c, d);
        let area = 0.5 * FINENESS * FINENESS * normal.iter().map(|n| n * n).sum::<f64>().sqrt();
        if seen > 0 && area.is_finite() {
            sum += (area * f64::from(seen)).sqrt();
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::notes::Notes;
    use crate::surface_figure::tests::Sample;

    #[test]
    fn an_upright_wall_is_not_seen_from_its_edge() {
        for turn in 0..12 {
            let (sin, cos) = (f64::from(turn) * 0.52).sin_cos();
            let wall = Sample::of(3, [9, 9], |u, v| vec![u * cos, u * sin, v]);
            let room = Room::of(&wall.figure(), &mut Notes::default()).unwrap();
            let view = choose(&room, &wall.figure().mesh().thinned(MOST_POINTS, [false; 2]));
            let (from, to) = (view.project(&[0.0; 3]), view.project(&[cos, sin, 0.0]));
            assert!((to.0 - from.0).abs() > 1.0, "{turn}");
        }
    }

    #[test]
    fn a_half_pipe_is_seen_from_within_or_without_but_not_both() {
        let pipe = Sample::of(3, [9, 21], |u, v| {
            let angle = 3.1 * v;
            vec![-angle.sin(), 3.0 * u, angle.cos()]
        });
        let room = Room::of(&pipe.figure(), &mut Notes::default()).unwrap();
        let view = choose(&room, &pipe.figure().mesh().thinned(MOST_POINTS, [false; 2]));
        assert!(view.sees_high_side(2));
    }
}
