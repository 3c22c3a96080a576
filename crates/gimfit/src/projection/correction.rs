//! Parameter correction (intrinsic parametrisation): parameters of ordered data move towards their
//! foot points and stay in order.
//!
//! One or two safeguarded Newton steps a call; a parameter moves at most half-way to where its
//! neighbours were, so that none overtakes another, and only to where the point is closer.

use crate::basis::basis_functions;
use crate::knots::{Boundary, KnotVector, MAX_DEGREE};

/// A curve under way: control points that move over knots, with scratch memory for evaluation.
#[derive(Debug)]
pub(crate) struct MovingCurve<'a> {
    knots: &'a KnotVector,
    control: &'a [f64],
    dimension: usize,
    columns: usize,
    /// Control points of a span, and their divided differences, first and second.
    local: Vec<f64>,
    slopes: Vec<f64>,
    bends: Vec<f64>,
    /// Span found last: parameters mostly ascend.
    last: usize,
}

/// Newton steps a call.
const STEPS: usize = 2;
/// Share of the gap to a neighbour that a parameter may use up.
const SHARE: f64 = 0.45;

impl<'a> MovingCurve<'a> {
    /// `control`: the control points that move, shape (columns, dimension).
    pub(crate) fn new(knots: &'a KnotVector, control: &'a [f64], dimension: usize) -> Self {
        let order = knots.degree() + 1;
        Self {
            knots,
            control,
            dimension,
            columns: control.len() / dimension,
            local: vec![0.0; order * dimension],
            slopes: vec![0.0; order * dimension],
            bends: vec![0.0; order * dimension],
            last: knots.degree(),
        }
    }

    /// The parameter inside the domain: round a periodic one, else to its end.
    pub(crate) fn inside(&self, t: f64) -> f64 {
        let (start, end) = self.knots.domain();
        if self.knots.boundary() == Boundary::Periodic && !(start..=end).contains(&t) {
            return (start + (t - start).rem_euclid(end - start)).clamp(start, end);
        }
        t.clamp(start, end)
    }

    /// The point at a parameter.
    pub(crate) fn point(&mut self, t: f64, point: &mut [f64]) {
        let t = self.inside(t);
        let span = self.find(self.last, t);
        self.last = span;
        let degree = self.knots.degree();
        let mut values = [0.0; MAX_DEGREE + 1];
        basis_functions(self.knots.values(), degree, span, t, &mut values);
        point.fill(0.0);
        for (k, value) in values[..=degree].iter().enumerate() {
            let from = (span - degree + k) % self.columns * self.dimension;
            let near = &self.control[from..][..self.dimension];
            point.iter_mut().zip(near).for_each(|(x, p)| *x += value * p);
        }
    }

    fn find(&self, from: usize, t: f64) -> usize {
        let values = self.knots.values();
        for span in [from, from + 1] {
            if span + 1 < values.len() && values[span] <= t && t < values[span + 1] {
                return span;
            }
        }
        self.knots.span(t).unwrap_or(self.knots.degree())
    }

    /// Point, first and second derivative at a parameter in the domain, one after another.
    fn jet(&mut self, span: usize, t: f64, jet: &mut [f64]) {
        let (p, d) = (self.knots.degree(), self.dimension);
        let knots = self.knots.values();
        for k in 0..=p {
            let from = (span - p + k) % self.columns * d;
            self.local[k * d..][..d].copy_from_slice(&self.control[from..][..d]);
        }
        differences(&self.local, &mut self.slopes, p, d, |i| {
            p as f64 / (knots[span + 1 + i] - knots[span + 1 + i - p])
        });
        if p >= 2 {
            differences(&self.slopes, &mut self.bends, p - 1, d, |i| {
                (p - 1) as f64 / (knots[span + 1 + i] - knots[span + 2 + i - p])
            });
        }
        let mut values = [0.0; MAX_DEGREE + 1];
        jet.fill(0.0);
        for (order, points) in [&self.local, &self.slopes, &self.bends].into_iter().enumerate() {
            let Some(degree) = p.checked_sub(order) else { break };
            if degree == 0 {
                values[0] = 1.0;
            } else {
                basis_functions(knots, degree, span, t, &mut values);
            }
            let part = &mut jet[order * d..][..d];
            for (value, point) in values[..=degree].iter().zip(points.chunks_exact(d)) {
                part.iter_mut().zip(point).for_each(|(x, y)| *x += value * y);
            }
        }
    }

    /// Moves the parameter of one point between `low` and `high`; returns it and the distance left.
    fn correct(
        &mut self,
        point: &[f64],
        start: f64,
        (low, high): (f64, f64),
        jet: &mut [f64],
        trial: &mut [f64],
    ) -> (f64, f64) {
        let d = self.dimension;
        let mut t = start;
        let at = self.inside(t);
        let mut span = self.find(self.last, at);
        self.jet(span, at, jet);
        let mut square = square_distance(&jet[..d], point);
        for _ in 0..STEPS {
            let (mut slope, mut speed, mut bend) = (0.0, 0.0, 0.0);
            for i in 0..d {
                let gap = jet[i] - point[i];
                slope += gap * jet[d + i];
                speed += jet[d + i] * jet[d + i];
                bend += gap * jet[2 * d + i];
            }
            let curvature = if speed + bend > 0.1 * speed { speed + bend } else { speed };
            let next = (t - slope / curvature).clamp(low, high);
            if !next.is_finite() || next == t {
                break;
            }
            let at = self.inside(next);
            span = self.find(span, at);
            self.jet(span, at, trial);
            let shorter = square_distance(&trial[..d], point);
            if shorter >= square {
                break;
            }
            let small = (next - t).abs() < 1e-4 * (high - low);
            (t, square) = (next, shorter);
            jet.copy_from_slice(trial);
            if small {
                break;
            }
        }
        self.last = span;
        (t, square.sqrt())
    }

    /// Corrects all parameters; `distances` receives what is left. On an open curve the first and
    /// the last parameter stay. Parameters of a closed curve span less than a period, which may lie
    /// anywhere.
    pub(crate) fn correct_all(
        &mut self,
        data: &[f64],
        parameters: &mut [f64],
        distances: &mut [f64],
    ) {
        let (count, d) = (parameters.len(), self.dimension);
        let (start, end) = self.knots.domain();
        let closed = self.knots.boundary() == Boundary::Periodic;
        let mut jet = vec![0.0; 3 * d];
        let mut trial = vec![0.0; 3 * d];
        let first = parameters.first().copied().unwrap_or(start);
        let mut before = parameters
            .last()
            .map_or(start, |last| if closed { last - (end - start) } else { start });
        for j in 0..count {
            let here = parameters[j];
            let after = match parameters.get(j + 1) {
                Some(&next) => next,
                None if closed => first + (end - start),
                None => end,
            };
            let fixed = !closed && (j == 0 || j + 1 == count);
            let room = if fixed {
                (here, here)
            } else {
                (here - SHARE * (here - before), here + SHARE * (after - here))
            };
            let point = &data[j * d..][..d];
            let (moved, distance) = self.correct(point, here, room, &mut jet, &mut trial);
            parameters[j] = moved;
            distances[j] = distance;
            before = here;
        }
    }
}

/// `out[i] = (points[i + 1] - points[i]) * factor(i)` for `count` differences.
fn differences(
    points: &[f64],
    out: &mut [f64],
    count: usize,
    d: usize,
    factor: impl Fn(usize) -> f64,
) {
    for i in 0..count {
        let scale = factor(i);
        for x in 0..d {
            out[i * d + x] = (points[(i + 1) * d + x] - points[i * d + x]) * scale;
        }
    }
}

fn square_distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Curve;
    use crate::points::Points;

    #[test]
    fn jets_are_those_of_the_curve() {
        let knots =
            KnotVector::open(3, vec![0., 0., 0., 0., 0.3, 0.3, 0.7, 1., 1., 1., 1.]).unwrap();
        let control: Vec<f64> = (0..14).map(|i| f64::from(i * i % 11)).collect();
        let curve = Curve::new(knots.clone(), Points::new(2, control.clone()).unwrap()).unwrap();
        let mut moving = MovingCurve::new(&knots, &control, 2);
        for t in [0.0, 0.1, 0.3, 0.31, 0.69, 0.95, 1.0] {
            let (mut jet, mut expected) = ([0.0; 6], [0.0; 6]);
            moving.jet(knots.span(t).unwrap(), t, &mut jet);
            curve.derivatives_into(t, 2, &mut expected).unwrap();
            for (x, y) in jet.iter().zip(expected) {
                assert!((x - y).abs() <= 1e-11 * (1.0 + y.abs()), "{t}: {x} {y}");
            }
        }
    }

    #[test]
    fn corrected_parameters_stay_in_order_and_distances_do_not_grow() {
        let knots = KnotVector::periodic(3, (-3..12).map(f64::from).collect()).unwrap();
        let control: Vec<f64> = (0..8)
            .flat_map(|i| {
                let angle = f64::from(i) * std::f64::consts::TAU / 8.0;
                [3.0 * angle.cos(), angle.sin()]
            })
            .collect();
        let mut moving = MovingCurve::new(&knots, &control, 2);
        let mut t: Vec<f64> = (0..40).map(|j| 0.15 + 0.19 * f64::from(j)).collect();
        let data: Vec<f64> = (0..40)
            .flat_map(|j| {
                let angle = f64::from(j) * std::f64::consts::TAU / 40.0 + 0.3;
                [2.0 * angle.cos(), 0.8 * angle.sin()]
            })
            .collect();
        let mut distances = vec![f64::INFINITY; 40];
        for _ in 0..30 {
            let before = distances.clone();
            moving.correct_all(&data, &mut t, &mut distances);
            assert!(t.windows(2).all(|pair| pair[0] < pair[1]) && t[39] < t[0] + 8.0);
            assert!(distances.iter().zip(before).all(|(now, before)| *now <= before + 1e-15));
        }
    }
}
