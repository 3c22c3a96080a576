//! What keeps a polygon whose corners all turn to the right side from folding back or winding round.
//!
//! The sign of a turn does not tell a little to the left from all but half round. A curve of degree p
//! consists of pieces, each of which p + 1 successive control points govern. Where these are the
//! corners, in their order, of a convex polygon, no line crosses it more than twice, hence the piece
//! no more than twice, and it has no inflection (variation diminution). Where all polygons have that
//! at most, and the directions at both ends of a stretch of equal turns stay ahead, the whole turns
//! by less than half a turn more than the data do.

use super::polygon::{Corner, Shape, point};
use super::turn::{Turn, cross, turn_beyond_rounding};
use std::f64::consts::PI;

/// Three points, not neighbours all, that are to turn to one side.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Triangle {
    pub(super) points: [usize; 3],
    pub(super) corner: Corner,
}

/// The first or last leg of a stretch, which is to lead ahead as that of the data does.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Lead {
    pub(crate) points: [usize; 2],
    /// The leg of the data.
    pub(crate) along: [f64; 2],
}

/// Two or more successive corners with the same side, as many as there are.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Stretch {
    first: usize,
    corners: usize,
    /// Sum of the angles by which the data turn.
    turning: f64,
}

/// The guards of a shape.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Guards {
    pub(super) triangles: Vec<Triangle>,
    pub(super) leads: Vec<Lead>,
    stretches: Vec<Stretch>,
    /// Sum of all angles by which the data turn, with and without their signs.
    turning: [f64; 2],
    /// Whether a polygon that keeps the corners and guards is known to make a curve without
    /// inflections.
    convex: bool,
}

fn leg(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [b[0] - a[0], b[1] - a[1]]
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// The angle, from 0 to half a turn, of a corner that turns to its side or not at all.
fn angle(side: Turn, [a, b, c]: [[f64; 2]; 3]) -> f64 {
    // A leg that folds back makes half a turn, whatever the sign of a zero.
    (side.sign() * cross(a, b, c)).max(0.0).abs().atan2(dot(leg(a, b), leg(b, c)))
}

/// Sum of the angles by which a polygon turns, with and without their signs. Legs of no length have
/// no direction and are passed over.
fn turning(polygon: &[f64], closed: bool) -> [f64; 2] {
    let points = polygon.len() / 2;
    let mut legs: Vec<[f64; 2]> = (1..points + usize::from(closed))
        .map(|i| leg(point(polygon, i - 1), point(polygon, i % points)))
        .filter(|&leg| leg != [0.0; 2])
        .collect();
    if closed {
        legs.extend(legs.first().copied());
    }
    legs.windows(2).fold([0.0; 2], |[sum, size], pair| {
        let [a, b] = [pair[0], pair[1]];
        let turn = (a[0] * b[1] - a[1] * b[0]).atan2(dot(a, b));
        [sum + turn, size + turn.abs()]
    })
}

impl Guards {
    /// The guards for curves of a degree, from the data and the sides of their corners.
    pub(super) fn of(shape: &Shape, polygon: &[f64], degree: usize) -> Self {
        let turning = turning(polygon, shape.is_closed());
        let mut guards = Self { turning, ..Default::default() };
        guards.find_stretches(shape, polygon);
        // A closed polygon whose turns make one whole turn is convex.
        let whole = shape.is_closed() && guards.stretches.len() == 1 && guards.leads.is_empty();
        if whole && guards.stretches[0].turning < 3.0 * PI {
            guards.convex = true;
            return guards;
        }
        let complete = guards.find_triangles(shape, polygon, degree);
        let first = if shape.is_empty() { Turn::Straight } else { shape.side(0) };
        let one_side = first != Turn::Straight && (0..shape.len()).all(|k| shape.side(k) == first);
        guards.convex = complete && one_side;
        guards
    }

    fn find_stretches(&mut self, shape: &Shape, polygon: &[f64]) {
        let count = shape.len();
        let before = |k: usize| shape.side((k + count - 1) % count);
        let begin = (0..count)
            .find(|&k| if shape.is_closed() { shape.side(k) != before(k) } else { k == 0 });
        let mut k = 0;
        while k < count {
            let first = (begin.unwrap_or(0) + k) % count;
            let side = shape.side(first);
            let corners = (k..count)
                .take_while(|j| shape.side((begin.unwrap_or(0) + j) % count) == side)
                .count();
            k += corners;
            if corners < 2 || side == Turn::Straight {
                continue;
            }
            let mut stretch = Stretch { first, corners, turning: 0.0 };
            stretch.turning = stretch.turning_of(shape, |i| point(polygon, i));
            self.stretches.push(stretch);
            if begin.is_some() {
                let [a, b, _] = shape.points_of(first);
                let [_, c, d] = shape.points_of((first + corners - 1) % count);
                self.leads.extend([[a, b], [c, d]].map(|points| {
                    let [from, to] = points.map(|i| point(polygon, i));
                    Lead { points, along: leg(from, to) }
                }));
            }
        }
    }

    /// The corners that close polygons of up to degree + 1 successive points. False if some are
    /// missing, because the data themselves are not convex there.
    fn find_triangles(&mut self, shape: &Shape, polygon: &[f64], degree: usize) -> bool {
        let (count, points) = (shape.len(), polygon.len() / 2);
        let wrap = |i: usize| if i < points { i } else { i - points };
        let folds = |k: usize| {
            let [a, b, c] = shape.points_of(k).map(|i| point(polygon, i));
            shape.is_straight(k) && dot(leg(a, b), leg(b, c)) < 0.0
        };
        let longest = degree.min(points.saturating_sub(if shape.is_closed() { 2 } else { 1 }));
        let mut complete = true;
        for first in 0..count {
            let side = shape.side(first);
            if side == Turn::Straight || folds(first) {
                complete = false;
                continue;
            }
            for last in first + 3..=first + longest {
                if !shape.is_closed() && last >= points {
                    break;
                }
                let added = (last - 2) % count;
                let closing = [[last - 1, last, first], [last, first, first + 1]]
                    .map(|triangle| triangle.map(wrap));
                let turns = closing.map(|triangle| {
                    let [a, b, c] = triangle.map(|i| point(polygon, i));
                    turn_beyond_rounding(a, b, c)
                });
                if shape.side(added) != side
                    || folds(added)
                    || turns.iter().any(|&turn| turn != side && turn != Turn::Straight)
                {
                    complete = false;
                    break;
                }
                self.triangles.extend(closing.into_iter().zip(turns).map(|(points, turn)| {
                    Triangle { points, corner: Corner::new(side, turn == Turn::Straight) }
                }));
            }
        }
        complete
    }

    /// Whether a polygon turns, stretch by stretch, as far as the data do, give or take less than
    /// half a turn.
    pub(super) fn winds_as_the_data(
        &self,
        shape: &Shape,
        point: impl Fn(usize) -> [f64; 2] + Copy,
    ) -> bool {
        self.stretches
            .iter()
            .all(|stretch| (stretch.turning_of(shape, point) - stretch.turning).abs() < PI)
    }

    /// Whether another polygon turns by less than half a turn more or less in all, and by less than
    /// half a turn per stretch more without regard to the sides.
    pub(super) fn turn_no_further(&self, polygon: &[f64], closed: bool, changes: usize) -> bool {
        let [sum, size] = turning(polygon, closed);
        (sum - self.turning[0]).abs() < PI && size < self.turning[1] + PI * (1 + changes) as f64
    }

    /// Whether curves of a degree have no more inflections than such a polygon has, which keeps
    /// corners and guards: either because all is convex, or because the directions of any `degree`
    /// successive legs lie within half a turn. (Knots can be inserted then without a leg's turning
    /// beyond its neighbours; in the limit the legs are the tangents of the curve.)
    pub(super) fn assure(&self, shape: &Shape, polygon: &[f64], degree: usize) -> bool {
        if self.convex || degree < 2 {
            return true;
        }
        let count = shape.len();
        let mut directions = vec![0.0];
        let wrapped = if shape.is_closed() { degree.min(count) } else { 0 };
        for k in 0..count + wrapped {
            let [a, b, c] = shape.points_of(k % count).map(|i| point(polygon, i));
            let turn = cross(a, b, c).atan2(dot(leg(a, b), leg(b, c)));
            directions.push(directions[k] + turn);
        }
        directions.windows(degree.min(directions.len())).all(|window| {
            let low = window.iter().copied().fold(f64::INFINITY, f64::min);
            let high = window.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            high - low < PI - 1e-9
        })
    }
}

impl Stretch {
    fn turning_of(&self, shape: &Shape, point: impl Fn(usize) -> [f64; 2]) -> f64 {
        (self.first..self.first + self.corners)
            .map(|k| k % shape.len())
            .map(|k| angle(shape.side(k), shape.points_of(k).map(&point)))
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::super::Shape;

    #[test]
    fn a_polygon_that_folds_back_or_winds_round_is_no_convex_one() {
        // All turn left: once round, twice round, and with a last leg that folds back.
        let angle = |degrees: f64| [degrees.to_radians().cos(), degrees.to_radians().sin()];
        let pentagon: Vec<[f64; 2]> = (0..5).map(|i| angle(72.0 * f64::from(i))).collect();
        let star: Vec<[f64; 2]> = (0..5).map(|i| angle(144.0 * f64::from(i))).collect();
        for closed in [false, true] {
            for degree in [1, 2, 3, 4, 5] {
                let shape = Shape::of(pentagon.as_flattened(), closed, degree);
                assert!(shape.is_kept_by(pentagon.as_flattened()));
                assert!(!shape.is_kept_by(star.as_flattened()), "{closed} {degree}");
            }
        }
        let mut folded = pentagon.clone();
        folded[4] = [folded[3][0] + 0.01, folded[3][1] - 0.1];
        let shape = Shape::of(pentagon.as_flattened(), false, 3);
        folded[3] = [-1.0, -3.0];
        assert!(!shape.is_strict_after(folded.as_flattened(), &[0.0; 10], 1.0));
    }
}
