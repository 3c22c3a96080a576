//! The shape that a fit is to keep: the turns of the data polygon, one by one.

use super::guards::{Guards, Lead};
use super::turn::{Turn, cross, turn_beyond_rounding};

/// The turns of a planar polygon, and how far it may turn to be the control polygon of a curve that
/// bends as it does.
///
/// A polygon can turn to the left at every corner and yet fold back at each, or wind round more than
/// once. To keep a shape it must not: any degree + 1 successive points that are the corners of a
/// convex polygon must stay so, and a stretch of successive turns to one side must turn by less than
/// half a turn more or less than it did.
///
/// A straight corner of the data, straight up to the rounding of its coordinates, has no sign to
/// keep. Between two left turns it is taken for one
/// that must not turn right, and so on; a straight run between a left and a right turn belongs half
/// to either, its middle corner, if there is one, to neither. Where everything is straight nothing
/// is to be kept.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    closed: bool,
    points: usize,
    degree: usize,
    corners: Vec<Corner>,
    guards: Guards,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Corner {
    /// The side it must not leave; [`Turn::Straight`] where it may turn as it likes.
    side: Turn,
    /// Whether the data are straight here, so that a straight corner will do.
    straight: bool,
}

impl Shape {
    /// The shape of a polygon of shape (points, 2), whose last point is followed by its first where
    /// it is closed, for control polygons of curves of this degree.
    #[must_use]
    pub fn of(polygon: &[f64], closed: bool, degree: usize) -> Self {
        let points = polygon.len() / 2;
        let count = if points < 3 {
            0
        } else if closed {
            points
        } else {
            points - 2
        };
        let corners = Vec::with_capacity(count);
        let mut shape = Self { closed, points, degree, corners, guards: Guards::default() };
        for k in 0..count {
            let [a, b, c] = shape.points_of(k).map(|i| point(polygon, i));
            let side = turn_beyond_rounding(a, b, c);
            shape.corners.push(Corner::new(side, side == Turn::Straight));
        }
        shape.settle_straight_runs();
        shape.guards = Guards::of(&shape, polygon, degree);
        shape
    }

    /// Gives the corners of straight runs the sides of their neighbours.
    fn settle_straight_runs(&mut self) {
        let count = self.corners.len();
        // Start where a run cannot go round the seam.
        let Some(start) = self.corners.iter().position(|corner| !corner.straight) else { return };
        let start = if self.closed { start } else { 0 };
        let mut k = 0;
        while k < count {
            if !self.corners[(start + k) % count].straight {
                k += 1;
                continue;
            }
            let length =
                (k..count).take_while(|&k| self.corners[(start + k) % count].straight).count();
            let end = k + length;
            let before = (k > 0).then(|| self.corners[(start + k - 1) % count].side);
            let after =
                (end < count || self.closed).then(|| self.corners[(start + end) % count].side);
            let (first, second) = match (before, after) {
                (Some(before), Some(after)) => (before, after),
                (Some(only), None) | (None, Some(only)) => (only, only),
                (None, None) => return,
            };
            for i in 0..length {
                let side = if first == second || 2 * i + 1 < length {
                    first
                } else if 2 * i + 1 == length {
                    Turn::Straight
                } else {
                    second
                };
                self.corners[(start + k + i) % count].side = side;
            }
            k = end;
        }
    }

    /// Corners, straight ones included.
    #[must_use]
    pub fn len(&self) -> usize {
        self.corners.len()
    }

    /// Whether the polygon has no corners: fewer than three points.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }

    /// Whether the polygon returns to its first point.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// How many corners of the polygon turn this way.
    #[must_use]
    pub fn count(&self, turn: Turn) -> usize {
        let is = |corner: &&Corner| match turn {
            Turn::Straight => corner.straight,
            _ => corner.side == turn && !corner.straight,
        };
        self.corners.iter().filter(is).count()
    }

    /// The side that corner `k` must not leave; [`Turn::Straight`] where it is free.
    #[must_use]
    pub fn side(&self, k: usize) -> Turn {
        self.corners[k].side
    }

    /// Whether the data are straight at corner `k`.
    pub(super) fn is_straight(&self, k: usize) -> bool {
        self.corners[k].straight
    }

    /// How often the side changes from one corner that has one to the next.
    pub(crate) fn changes_of_side(&self) -> usize {
        let mut sides: Vec<Turn> = self.corners.iter().map(|corner| corner.side).collect();
        sides.retain(|&side| side != Turn::Straight);
        sides.dedup();
        let round = self.closed && sides.first() != sides.last();
        sides.len().saturating_sub(1) + usize::from(round)
    }

    /// The triples of points that must turn to a side, with that side: at corners, and where
    /// successive points close to a convex polygon.
    pub(crate) fn triples(&self) -> impl Iterator<Item = ([usize; 3], Turn)> {
        let corners = (0..self.len()).map(|k| (self.points_of(k), self.side(k)));
        let closing = self.guards.triangles.iter().map(|t| (t.points, t.corner.side));
        corners.filter(|(_, side)| *side != Turn::Straight).chain(closing)
    }

    /// The legs that must not turn away from those of the data by a right angle.
    pub(crate) fn leads(&self) -> &[Lead] {
        &self.guards.leads
    }

    /// How many legs a triple spans at most.
    pub(crate) fn reach(&self) -> usize {
        if self.guards.triangles.is_empty() { 2 } else { self.degree.max(2) }
    }

    /// The side kept at a point of the polygon; an open one has no corner at its ends, which take
    /// that of their neighbours.
    pub(crate) fn side_at(&self, point: usize) -> Turn {
        let last = self.corners.len() - 1;
        let k =
            if self.closed { (point + last) % (last + 1) } else { point.clamp(1, last + 1) - 1 };
        self.corners[k].side
    }

    /// The three points of corner `k`.
    #[must_use]
    pub fn points_of(&self, k: usize) -> [usize; 3] {
        let wrap = |i: usize| if i < self.points { i } else { i - self.points };
        [k, wrap(k + 1), wrap(k + 2)]
    }

    /// Whether another polygon of as many points, shape (points, 2), turns the same way at every
    /// corner, nowhere folds back, and winds no further.
    #[must_use]
    pub fn is_kept_by(&self, polygon: &[f64]) -> bool {
        self.is_kept_at(|i| point(polygon, i))
    }

    /// The same for a polygon that has moved by `scale` times some vectors, as it would be stored.
    pub(crate) fn is_kept_after(&self, polygon: &[f64], vectors: &[f64], scale: f64) -> bool {
        self.is_kept_at(|i| moved(polygon, vectors, scale, i))
    }

    fn is_kept_at(&self, point: impl Fn(usize) -> [f64; 2] + Copy) -> bool {
        self.holds_for(point, Corner::allows) && self.guards.winds_as_the_data(self, point)
    }

    /// Whether a polygon of any number of points winds, all in all, no further than this one: by less
    /// than half a turn more from end to end, and for each change of side.
    pub(crate) fn turns_no_further(&self, polygon: &[f64]) -> bool {
        self.guards.turn_no_further(polygon, self.closed, self.changes_of_side())
    }

    /// Whether it is certain that a curve whose control polygon keeps this shape has no more
    /// inflections than the data.
    pub(crate) fn is_assured_by(&self, polygon: &[f64]) -> bool {
        self.guards.assure(self, polygon, self.degree)
    }

    /// Whether a polygon that has moved by less than would fold it back keeps the shape, and has no
    /// straight corner where it has a side.
    pub(crate) fn is_strict_after(&self, polygon: &[f64], vectors: &[f64], scale: f64) -> bool {
        let at = |i| moved(polygon, vectors, scale, i);
        let ahead = |lead: &Lead| {
            let [from, to] = lead.points.map(at);
            (to[0] - from[0]) * lead.along[0] + (to[1] - from[1]) * lead.along[1] > 0.0
        };
        self.holds_for(at, |corner, [a, b, c]| {
            corner.side == Turn::Straight || corner.side == Turn::of(cross(a, b, c))
        }) && self.guards.leads.iter().all(ahead)
    }

    /// Whether corner `k` of a polygon, which has a side to keep, is straight up to rounding or on
    /// the other side.
    pub(crate) fn is_flat(&self, k: usize, polygon: &[f64]) -> bool {
        let [a, b, c] = self.points_of(k).map(|i| point(polygon, i));
        let turn = turn_beyond_rounding(a, b, c);
        turn == Turn::Straight
            || (self.corners[k].side != Turn::Straight && turn != self.corners[k].side)
    }

    /// Whether a corner that has a side to keep is flat.
    pub(crate) fn has_flat_corner(&self, polygon: &[f64]) -> bool {
        (0..self.len()).any(|k| self.side(k) != Turn::Straight && self.is_flat(k, polygon))
    }

    fn holds_for(
        &self,
        point: impl Fn(usize) -> [f64; 2] + Copy,
        allowed: impl Fn(Corner, [[f64; 2]; 3]) -> bool,
    ) -> bool {
        self.corners
            .iter()
            .enumerate()
            .all(|(k, &corner)| allowed(corner, self.points_of(k).map(point)))
            && self.guards.triangles.iter().all(|t| allowed(t.corner, t.points.map(point)))
    }
}

impl Corner {
    pub(super) fn new(side: Turn, straight: bool) -> Self {
        Self { side, straight }
    }

    fn allows(self, [a, b, c]: [[f64; 2]; 3]) -> bool {
        self.side == Turn::Straight
            || self.side == Turn::of(cross(a, b, c))
            || (self.straight && turn_beyond_rounding(a, b, c) == Turn::Straight)
    }
}

pub(crate) fn point(polygon: &[f64], i: usize) -> [f64; 2] {
    [polygon[2 * i], polygon[2 * i + 1]]
}

fn moved(polygon: &[f64], vectors: &[f64], scale: f64, i: usize) -> [f64; 2] {
    [polygon[2 * i] + scale * vectors[2 * i], polygon[2 * i + 1] + scale * vectors[2 * i + 1]]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sides(polygon: &[[f64; 2]], closed: bool) -> Vec<f64> {
        let shape = Shape::of(polygon.as_flattened(), closed, 3);
        (0..shape.len()).map(|k| shape.side(k).sign()).collect()
    }

    #[test]
    fn straight_runs_take_the_sides_of_their_neighbours() {
        let square =
            [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [2.0, 2.0], [0.0, 2.0], [0.0, 1.0]];
        assert_eq!(sides(&square, true), [1.0; 7]);
        assert_eq!(sides(&square, false), [1.0; 5]);
        // Left, three straight corners, right: the middle one is free.
        let step =
            [[0.0, 1.0], [0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [4.0, 0.0], [4.0, -1.0]];
        assert_eq!(sides(&step, false), [1.0, 1.0, 0.0, -1.0, -1.0]);
        let line: Vec<[f64; 2]> = (0..5).map(|i| [f64::from(i), 0.0]).collect();
        assert_eq!(sides(&line, false), [0.0; 3]);
        assert_eq!(sides(&line[..2], true), [0.0; 0]);
    }

    #[test]
    fn a_straight_corner_of_the_data_may_stay_straight_but_not_turn_away() {
        let data = [0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 2.0, 0.0, 2.0, 1.0];
        let shape = Shape::of(&data, false, 3);
        assert!(shape.is_kept_by(&data) && !shape.is_strict_after(&data, &[0.0; 10], 1.0));
        let out = [0.0, 1.0, 0.0, 0.0, 1.0, -0.1, 2.0, 0.0, 2.0, 1.0];
        let into = [0.0, 1.0, 0.0, 0.0, 1.0, 0.1, 2.0, 0.0, 2.0, 1.0];
        assert!(shape.is_kept_by(&out) && !shape.is_kept_by(&into));
        assert_eq!(shape.count(Turn::Left), 2);
        assert_eq!(shape.count(Turn::Straight), 1);
    }
}
