//! Corners of the data: points where the direction turns at once, at every scale down to that of the
//! tolerance, and more than around them.

use super::polyline::{Polyline, distance};

/// Arms, in tolerances, over which the turn at a point is judged. Over longer arms a bend turns more,
/// a corner does not.
const ARMS: [f64; 3] = [1.0, 4.0, 10.0];
/// Least part of the turn over the middle arms that the shortest and the longest must show.
const AT_ONCE: f64 = 0.75;
/// Turn from which a corner is a corner, in degrees, where it is left to us.
pub(super) const AUTO_ANGLE: f64 = 40.0;
/// A corner turns at least this many times as much as the data on either side of it.
const CONTRAST: f64 = 4.0;

/// Positions of the corners, ascending; `least` is the smallest turn in degrees. Ends of an open
/// polyline are no corners.
pub(super) fn find_corners(polyline: &Polyline<'_>, tolerance: f64, least: f64) -> Vec<usize> {
    let points = polyline.points();
    if points < 4 {
        return Vec::new();
    }
    let arms = Arms::new(polyline);
    let turns =
        |arm: f64| -> Vec<f64> { (0..points).map(|j| arms.turn(j, arm * tolerance)).collect() };
    let [at_once, near, far] = ARMS.map(turns);
    let is_end = |j: usize| !polyline.closed && (j == 0 || j + 1 == points);
    let at = |j: usize, offset: isize| -> f64 {
        let k = j as isize + offset;
        if polyline.closed {
            near[k.rem_euclid(points as isize) as usize]
        } else {
            usize::try_from(k).ok().and_then(|k| near.get(k)).copied().unwrap_or(0.0)
        }
    };
    let mut corners: Vec<usize> = (0..points)
        .filter(|&j| {
            let turned = at_once[j].min(far[j]) >= AT_ONCE * near[j];
            if is_end(j) || near[j] < least || !turned {
                return false;
            }
            // The same turn, seen from a neighbour within the arm, must not count twice.
            let greatest = [-1, 1]
                .iter()
                .all(|&offset| near[j] > at(j, offset) || (near[j] == at(j, offset) && offset > 0));
            greatest && near[j] >= CONTRAST * usual_turn(&arms, j)
        })
        .collect();
    // Two corners closer than an arm are one.
    let mut kept: Vec<usize> = Vec::new();
    for j in corners.drain(..) {
        match kept.last() {
            Some(&last)
                if distance(polyline.point(last), polyline.point(j)) < ARMS[1] * tolerance =>
            {
                if near[j] > near[last] {
                    kept.pop();
                    kept.push(j);
                }
            }
            _ => kept.push(j),
        }
    }
    kept
}

/// The usual turn beside a point, on the side where it is greater: the median over three neighbours,
/// leg against leg. Corners may stand side by side.
fn usual_turn(arms: &Arms<'_>, j: usize) -> f64 {
    let (points, closed) = (arms.polyline.points() as isize, arms.polyline.closed);
    let beside = |direction: isize| {
        let mut turns: Vec<f64> = (1..=3)
            .filter_map(|offset| {
                let k = j as isize + direction * offset;
                let k = if closed { k.rem_euclid(points) } else { k };
                let inner = closed || (k > 0 && k + 1 < points);
                inner.then(|| arms.turn(k as usize, 0.0))
            })
            .collect();
        turns.sort_by(f64::total_cmp);
        turns.get(turns.len().saturating_sub(1) / 2).copied().unwrap_or(0.0)
    };
    beside(-1).max(beside(1))
}

/// A polyline with the lengths along it.
struct Arms<'a> {
    polyline: &'a Polyline<'a>,
    /// From the first point to each; of a closed polyline, once round more.
    lengths: Vec<f64>,
}

impl<'a> Arms<'a> {
    fn new(polyline: &'a Polyline<'a>) -> Self {
        let points = polyline.points();
        let count = if polyline.closed { 2 * points } else { points };
        let mut length = 0.0;
        let lengths = (0..count)
            .map(|j| {
                let here = length;
                if j + 1 < count {
                    length += polyline.leg_length(j % points);
                }
                here
            })
            .collect();
        Self { polyline, lengths }
    }

    /// Turn in degrees at point `j` between the chords to the points an arm away along the polyline,
    /// or to the neighbours where they are farther; from an end of an open one, to the other end at
    /// most.
    fn turn(&self, j: usize, arm: f64) -> f64 {
        let (points, closed) = (self.polyline.points(), self.polyline.closed);
        let lengths = &self.lengths;
        let far = |length: f64| length > 0.0 && length >= arm;
        let reach = if closed { points / 2 } else { points };
        let (here, back) = if closed { (j, j + points) } else { (j, j) };

        // The first point ahead, and the last one behind, that is an arm away.
        let last = (here + reach).min(lengths.len() - 1);
        let ahead = here + lengths[here..=last].partition_point(|&x| !far(x - lengths[here]));
        let after = if ahead <= last { Some(ahead) } else { (!closed).then_some(last) };
        let first = back.saturating_sub(reach);
        let behind = first + lengths[first..=back].partition_point(|&x| far(lengths[back] - x));
        let before = if behind > first { Some(behind - 1) } else { (!closed).then_some(first) };
        match (before, after) {
            (Some(before), Some(after)) if before != back && after != here => {
                self.between(before % points, j, after % points)
            }
            _ => 0.0,
        }
    }

    /// Turn in degrees between two chords.
    fn between(&self, before: usize, j: usize, after: usize) -> f64 {
        let [a, b, c] = [before, j, after].map(|k| self.polyline.point(k));
        let (mut dot, mut one, mut two) = (0.0, 0.0, 0.0);
        for i in 0..self.polyline.dimension {
            let (x, y) = (b[i] - a[i], c[i] - b[i]);
            dot += x * y;
            one += x * x;
            two += y * y;
        }
        let cosine = dot / (one * two).sqrt();
        if cosine.is_finite() { cosine.clamp(-1.0, 1.0).acos().to_degrees() } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners(data: &[[f64; 2]], closed: bool, tolerance: f64) -> Vec<usize> {
        let polyline = Polyline { data: data.as_flattened(), dimension: 2, closed, over: None };
        find_corners(&polyline, tolerance, AUTO_ANGLE)
    }

    #[test]
    fn a_square_has_four_corners_and_a_circle_none() {
        let square: Vec<[f64; 2]> = (0..40)
            .map(|i| {
                let s = f64::from(i % 10) / 10.0;
                [[s, 0.0], [1.0, s], [1.0 - s, 1.0], [0.0, 1.0 - s]][i as usize / 10]
            })
            .collect();
        assert_eq!(corners(&square, true, 1e-3), [0, 10, 20, 30]);
        assert_eq!(corners(&square, false, 1e-3), [10, 20, 30]);
        for count in [8, 12, 100] {
            let circle: Vec<[f64; 2]> = (0..count)
                .map(|i| {
                    let angle = f64::from(i) * std::f64::consts::TAU / f64::from(count);
                    [angle.cos(), angle.sin()]
                })
                .collect();
            assert!(corners(&circle, true, 1e-3).is_empty(), "{count}");
        }
    }

    #[test]
    fn noise_below_the_tolerance_makes_no_corners() {
        let noisy: Vec<[f64; 2]> = (0..200)
            .map(|i| {
                let x = f64::from(i) * 0.01;
                [x, 0.004 * f64::from(i * 7919 % 13 - 6) / 6.0]
            })
            .collect();
        assert!(corners(&noisy, false, 5e-3).is_empty());
    }
}
