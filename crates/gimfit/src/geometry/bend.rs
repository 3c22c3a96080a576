//! Which way a planar curve bends: the sign of `C' x C''` over whole intervals, from its Bernstein
//! coefficients and not from samples.

use super::Curve;
use crate::shape::Turn;

/// Rounding errors of a coefficient, in units of the largest coordinate times the legs it is made of.
const NOISE: f64 = 64.0 * f64::EPSILON;
/// Halvings of a piece whose coefficients do not decide.
const MOST_HALVINGS: usize = 30;

/// Appends the signs of `C' x C''` on `[from, to]` in the order met, none twice in a row and none
/// that rounding may have made. A closed curve may be followed past the end of its domain.
/// `size` is the largest coordinate of any control point.
pub(crate) fn bend_signs(curve: &Curve, from: f64, to: f64, size: f64, signs: &mut Vec<Turn>) {
    let (start, end) = curve.domain();
    let period = end - start;
    let lap = if curve.is_periodic() { ((from - start) / period).floor() * period } else { 0.0 };
    let (mut at, mut to) = ((from - lap).clamp(start, end), to - lap);
    while at < to {
        if at >= end {
            if !curve.is_periodic() {
                return;
            }
            (at, to) = (start, to - period);
            continue;
        }
        let Ok(span) = curve.knots().span(at) else { return };
        let until = curve.knots().values()[span + 1].min(to);
        if until > at {
            piece(curve, span, [at, until], size, signs);
        }
        at = if until > at { until } else { to };
    }
}

/// One polynomial piece.
fn piece(curve: &Curve, span: usize, [a, b]: [f64; 2], size: f64, signs: &mut Vec<Turn>) {
    let degree = curve.degree();
    if degree < 2 {
        return;
    }
    let points: Vec<[f64; 2]> = (0..=degree).map(|k| blossom(curve, span, a, b, k)).collect();
    let first = differences(&points);
    let second = differences(&first);
    let (n, m) = (degree - 1, degree - 2);
    let mut coefficients = vec![0.0; n + m + 1];
    let mut legs: f64 = 0.0;
    for (i, u) in first.iter().enumerate() {
        legs = legs.max(u[0].abs().max(u[1].abs()));
        for (j, v) in second.iter().enumerate() {
            let share = binomial(n, i) * binomial(m, j) / binomial(n + m, i + j);
            coefficients[i + j] += share * (u[0] * v[1] - u[1] * v[0]);
        }
    }
    let noise = NOISE * size * legs;
    classify(&mut coefficients, noise, MOST_HALVINGS, signs);
}

/// Point `k` of the Bezier form of a span's polynomial on `[a, b]`: its polar form at `a`, p - k
/// times, and `b`, k times. Within the span every step is a mean.
fn blossom(curve: &Curve, span: usize, a: f64, b: f64, k: usize) -> [f64; 2] {
    let degree = curve.degree();
    let knots = curve.knots().values();
    let mut work: Vec<[f64; 2]> = (span - degree..=span)
        .map(|i| {
            let point = curve.control_points().point(i);
            [point[0], point[1]]
        })
        .collect();
    for r in 1..=degree {
        let t = if r <= k { b } else { a };
        for j in 0..=degree - r {
            let low = knots[span - degree + r + j];
            let high = knots[span + 1 + j];
            let share = (t - low) / (high - low);
            for c in 0..2 {
                work[j][c] += share * (work[j + 1][c] - work[j][c]);
            }
        }
    }
    work[0]
}

fn differences(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    points.windows(2).map(|p| [p[1][0] - p[0][0], p[1][1] - p[0][1]]).collect()
}

fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |product, i| product * (n - i) as f64 / (i + 1) as f64)
}

/// Appends the signs that a polynomial takes, from its Bernstein coefficients: no more changes than
/// they have, and exactly one where they have one.
fn classify(coefficients: &mut [f64], noise: f64, halvings: usize, signs: &mut Vec<Turn>) {
    let sign = |x: f64| if x.abs() <= noise { Turn::Straight } else { Turn::of(x) };
    let mut met: Vec<Turn> = Vec::new();
    for turn in coefficients.iter().map(|&x| sign(x)).filter(|&turn| turn != Turn::Straight) {
        if met.last() != Some(&turn) {
            met.push(turn);
        }
    }
    let ends = [coefficients[0], coefficients[coefficients.len() - 1]].map(sign);
    let decided = met.len() <= 1 || (met.len() == 2 && !ends.contains(&Turn::Straight));
    if !decided && halvings > 0 {
        // De Casteljau: the left half into `left`, the right one in place.
        let mut left = vec![0.0; coefficients.len()];
        for r in 0..coefficients.len() {
            left[r] = coefficients[0];
            for j in 0..coefficients.len() - 1 - r {
                coefficients[j] = 0.5 * (coefficients[j] + coefficients[j + 1]);
            }
        }
        classify(&mut left, noise, halvings - 1, signs);
        classify(coefficients, noise, halvings - 1, signs);
        return;
    }
    let list: &[Turn] = if decided { &met } else { &ends };
    for &turn in list.iter().filter(|&&turn| turn != Turn::Straight) {
        if signs.last() != Some(&turn) {
            signs.push(turn);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::knots::KnotVector;
    use crate::points::Points;

    fn signs(degree: usize, knots: Vec<f64>, control: &[[f64; 2]]) -> Vec<Turn> {
        let knots = KnotVector::open(degree, knots).unwrap();
        let curve = Curve::new(knots, Points::from(control)).unwrap();
        let (start, end) = curve.domain();
        let mut signs = Vec::new();
        bend_signs(&curve, start, end, 10.0, &mut signs);
        signs
    }

    #[test]
    fn bends_are_found_between_samples() {
        let bezier = |degree: usize| [vec![0.0; degree + 1], vec![1.0; degree + 1]].concat();
        let arch = [[0.0, 0.0], [1.0, 2.0], [2.0, 2.0], [3.0, 0.0]];
        assert_eq!(signs(3, bezier(3), &arch), [Turn::Right]);
        let s = [[0.0, 0.0], [1.0, 2.0], [2.0, -2.0], [3.0, 0.0]];
        assert_eq!(signs(3, bezier(3), &s), [Turn::Right, Turn::Left]);
        let line = [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [3.0, 3.0]];
        assert_eq!(signs(3, bezier(3), &line), []);
        // The polygon turns both ways, the curve does not.
        let flat = [[0.0, 0.0], [1.0, 1.0], [1.5, 0.9], [2.0, 1.0], [3.0, 0.0]];
        assert_eq!(signs(4, bezier(4), &flat), [Turn::Right]);
        // y = x^4 (1 - x): bends once in (0, 1), at x = 3/5, and only touches zero at 0.
        let quintic = [[0.0, 0.0], [0.2, 0.0], [0.4, 0.0], [0.6, 0.0], [0.8, 0.2], [1.0, 0.0]];
        assert_eq!(signs(5, bezier(5), &quintic), [Turn::Left, Turn::Right]);
    }
}
