//! The shape of the control polygon as constraints. Corners, and what closes successive points to a
//! convex polygon, must stay on their side: `c > 0` with `c = s (P_1 - P_0) x (P_2 - P_1)`. The first
//! and the last leg of a stretch must lead ahead: `c > 0` with `c = (P_1 - P_0) . d` and the leg `d`
//! of the data, which is a corner as well, of that leg and `d` turned by a right angle.

use super::least_squares::LeastSquares;
use super::normal::SymmetricBand;
use crate::shape::{self, Shape, point};

/// Share of the way to the straight line that a step may take at most.
const MOST_OF_THE_WAY: f64 = 0.995;
/// Multipliers are kept within this factor of `mu / c` (Waechter and Biegler 2006, eq. 16).
const FARTHEST_MULTIPLIER: f64 = 1e10;

/// What is known of the corners that have a side, at the control points of a step.
#[derive(Debug)]
pub(super) struct Corners {
    list: Vec<Corner>,
}

#[derive(Debug, Clone, Copy)]
struct Corner {
    /// Where the second leg is fixed, the last point is none of its own.
    points: [usize; 3],
    /// 1 for left, -1 for right.
    side: f64,
    /// The second leg stays as it is.
    fixed: bool,
    /// The legs.
    legs: [[f64; 2]; 2],
    /// How far the corner is from straight: `c`, an area.
    slack: f64,
    /// How hard it holds the fit back; `slack * multiplier` is `mu` on the central path.
    multiplier: f64,
    /// Change of `c` along the step: `c + share * linear + share^2 * quadratic`.
    linear: f64,
    quadratic: f64,
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

impl Corner {
    /// Derivatives of `c` with respect to the three points.
    fn gradient(&self) -> [[f64; 2]; 3] {
        let [a, b] = self.legs;
        let s = self.side;
        let by_a = [s * b[1], -s * b[0]];
        let by_b = if self.fixed { [0.0; 2] } else { [-s * a[1], s * a[0]] };
        [[-by_a[0], -by_a[1]], [by_a[0] - by_b[0], by_a[1] - by_b[1]], by_b]
    }

    fn along(&self, share: f64) -> f64 {
        share * (self.linear + share * self.quadratic)
    }
}

impl Corners {
    pub(super) fn of(shape: &Shape) -> Self {
        let corner = |points, side, legs, fixed| Corner {
            points,
            side,
            fixed,
            legs,
            slack: 0.0,
            multiplier: 0.0,
            linear: 0.0,
            quadratic: 0.0,
        };
        let turns =
            shape.triples().map(|(points, side)| corner(points, side.sign(), [[0.0; 2]; 2], false));
        let leads = shape.leads().iter().map(|lead| {
            let ([from, to], [x, y]) = (lead.points, lead.along);
            corner([from, to, to], 1.0, [[0.0; 2], [-y, x]], true)
        });
        let list = turns.chain(leads);
        Self { list: list.collect() }
    }

    pub(super) fn len(&self) -> usize {
        self.list.len()
    }

    /// Looks at control points. False if a corner is straight or on the wrong side.
    pub(super) fn look(&mut self, control: &[f64]) -> bool {
        let mut inside = true;
        for corner in &mut self.list {
            let [p, q, r] = corner.points.map(|i| point(control, i));
            corner.legs[0] = [q[0] - p[0], q[1] - p[1]];
            corner.slack = if corner.fixed {
                cross(corner.legs[0], corner.legs[1])
            } else {
                corner.legs[1] = [r[0] - q[0], r[1] - q[1]];
                corner.side * shape::cross(p, q, r)
            };
            inside &= corner.slack > 0.0;
        }
        inside
    }

    /// Multipliers on the central path of `mu`.
    pub(super) fn centre(&mut self, mu: f64) {
        self.list.iter_mut().for_each(|corner| corner.multiplier = mu / corner.slack);
    }

    /// Adds the gradient of `mu * sum log c` to a vector in the order of the unknowns.
    pub(super) fn add_gradient(&self, mu: f64, fit: &LeastSquares, result: &mut [f64]) {
        for corner in &self.list {
            let force = mu / corner.slack;
            for (i, g) in corner.points.into_iter().zip(corner.gradient()) {
                let at = fit.unknown(i);
                result[at] += force * g[0];
                result[at + 1] += force * g[1];
            }
        }
    }

    /// Adds what the corners put into the primal-dual Newton matrix,
    /// `sum (z / c) g g^T - z H` with the gradient `g` and the second derivatives `H` of `c`. As a
    /// form in the two legs `H` has the eigenvalues 1 and -1, so that `(H - 1) / 2` is its negative
    /// part, which is all that is taken where the sum must be `convex`.
    pub(super) fn add_second(&self, convex: bool, fit: &LeastSquares, matrix: &mut SymmetricBand) {
        for corner in &self.list {
            let (z, g) = (corner.multiplier, corner.gradient());
            let stiffness = z / corner.slack;
            let at = corner.points.map(|i| fit.unknown(i));
            for (i, j) in [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)] {
                let mut block = [[0.0; 2]; 2];
                for a in 0..2 {
                    for b in 0..2 {
                        block[a][b] = stiffness * g[i][a] * g[j][b];
                    }
                }
                // H couples the points by the matrix s [0 1; -1 0].
                let sign = match (i, j) {
                    _ if corner.fixed => 0.0,
                    (0, 1) | (1, 2) => 1.0,
                    (0, 2) => -1.0,
                    _ => 0.0,
                };
                let bend = sign * corner.side * z * if convex { 0.5 } else { 1.0 };
                block[0][1] -= bend;
                block[1][0] += bend;
                if convex && !corner.fixed {
                    let spread = match (i, j) {
                        (0, 0) | (2, 2) => 0.5,
                        (1, 1) => 1.0,
                        (0, 1) | (1, 2) => -0.5,
                        _ => 0.0,
                    };
                    block[0][0] += spread * z;
                    block[1][1] += spread * z;
                }
                for a in 0..2 {
                    for b in 0..2 {
                        matrix.add(at[i] + a, at[j] + b, block[a][b]);
                        if i != j {
                            matrix.add(at[j] + b, at[i] + a, block[a][b]);
                        }
                    }
                }
            }
        }
    }

    /// Looks along a step in the order of the unknowns, and returns the longest share of it that
    /// leaves every corner some of its slack: exactly, because areas are quadratic in the share.
    pub(super) fn look_along(&mut self, fit: &LeastSquares, step: &[f64]) -> f64 {
        let mut longest: f64 = 1.0;
        for corner in &mut self.list {
            let [p, q, r] =
                corner.points.map(|i| fit.unknown(i)).map(|at| [step[at], step[at + 1]]);
            // Of a fixed leg both ends are the same point.
            let (da, db) = ([q[0] - p[0], q[1] - p[1]], [r[0] - q[0], r[1] - q[1]]);
            let [a, b] = corner.legs;
            corner.linear = corner.side * (cross(da, b) + cross(a, db));
            corner.quadratic = corner.side * cross(da, db);
            let reserve = MOST_OF_THE_WAY * corner.slack;
            let discriminant = corner.linear * corner.linear - 4.0 * corner.quadratic * reserve;
            if discriminant >= 0.0 {
                let below = discriminant.sqrt() - corner.linear;
                if below > 0.0 {
                    longest = longest.min(2.0 * reserve / below);
                }
            }
        }
        longest
    }

    /// How much `sum log c` grows by a share of the step.
    pub(super) fn gain(&self, share: f64) -> f64 {
        self.list.iter().map(|corner| (corner.along(share) / corner.slack).ln_1p()).sum()
    }

    /// Moves the multipliers along their own Newton step, after the control points have taken a
    /// share of theirs.
    pub(super) fn move_multipliers(&mut self, mu: f64, share: f64) {
        let change = |corner: &Corner| {
            (mu - corner.multiplier * (corner.slack + corner.linear)) / corner.slack
        };
        let longest = self.list.iter().fold(1.0_f64, |longest, corner| {
            let change = change(corner);
            if change < 0.0 {
                longest.min(-MOST_OF_THE_WAY * corner.multiplier / change)
            } else {
                longest
            }
        });
        for corner in &mut self.list {
            let centre = mu / (corner.slack + corner.along(share));
            let moved = corner.multiplier + longest * change(corner);
            corner.multiplier =
                moved.max(centre / FARTHEST_MULTIPLIER).min(centre * FARTHEST_MULTIPLIER);
        }
    }
}
