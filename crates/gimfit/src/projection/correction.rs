//! Parameter correction (intrinsic parametrisation): parameters of ordered data move towards their
//! foot points and stay in order.
//!
//! One or two safeguarded Newton steps a call; a parameter moves at most half-way to where its
//! neighbours were, so that none overtakes another, and only to where the point is closer.

use crate::knots::{Boundary, KnotVector};

/// A curve under way: control points that move over knots, as one polynomial a span.
///
/// Powers of the place in the span, 0 to 1, are what evaluates fastest, and a round evaluates every
/// span at several points. They are as exact as a search needs; figures that are reported come from
/// the finished curve.
#[derive(Debug)]
pub(crate) struct MovingCurve<'a> {
    knots: &'a KnotVector,
    dimension: usize,
    /// Coordinates taken together: all up to 4, else 4 by 4, the last ones padded.
    lanes: usize,
    /// From the span that begins at knot `p` on: groups of `lanes` coordinates, of each the
    /// coefficients of powers 0 to `p`.
    coefficients: Vec<f64>,
    /// Span found last: parameters mostly ascend.
    last: usize,
}

/// Newton steps a call.
const STEPS: usize = 2;
/// Share of the gap to a neighbour that a parameter may use up.
const SHARE: f64 = 0.45;

/// Where a point is from a place on the curve: the squared distance, and the products of the
/// difference and the derivatives that Newton's iteration needs, by the place in the span.
#[derive(Debug, Clone, Copy, Default)]
struct Moments {
    square: f64,
    /// Difference times first derivative.
    slope: f64,
    /// First derivative squared.
    speed: f64,
    /// Difference times second derivative.
    bend: f64,
}

impl<'a> MovingCurve<'a> {
    /// `control`: the control points that move, shape (columns, dimension).
    pub(crate) fn new(knots: &'a KnotVector, control: &[f64], dimension: usize) -> Self {
        let lanes = dimension.min(4);
        let mut curve = Self {
            knots,
            dimension,
            lanes,
            coefficients: vec![
                0.0;
                (knots.control_points() - knots.degree()) * {
                    dimension.div_ceil(lanes) * lanes * (knots.degree() + 1)
                }
            ],
            last: knots.degree(),
        };
        curve.expand(control);
        curve
    }

    /// Numbers a span.
    fn stride(&self) -> usize {
        self.dimension.div_ceil(self.lanes) * self.lanes * (self.knots.degree() + 1)
    }

    /// Expands every span around its first knot.
    fn expand(&mut self, control: &[f64]) {
        let (p, d, lanes, stride) =
            (self.knots.degree(), self.dimension, self.lanes, self.stride());
        let knots = self.knots.values();
        let columns = control.len() / d;
        // Functions of all degrees at the first knot, degree q from q (q + 1) / 2 on.
        let mut functions = vec![0.0; (p + 1) * (p + 2) / 2];
        let mut points = vec![0.0; (p + 1) * d];
        for (span, piece) in (p..).zip(self.coefficients.chunks_exact_mut(stride)) {
            let length = knots[span + 1] - knots[span];
            if length <= 0.0 {
                continue;
            }
            functions_of_all_degrees(&knots[span + 1 - p..=span + p], p, &mut functions);
            for k in 0..=p {
                let from = (span - p + k) % columns * d;
                points[k * d..][..d].copy_from_slice(&control[from..][..d]);
            }
            let mut scale = 1.0;
            for order in 0..=p {
                let degree = p - order;
                let values = &functions[degree * (degree + 1) / 2..][..=degree];
                for (i, value) in values.iter().enumerate() {
                    for x in 0..d {
                        piece[(x / lanes * (p + 1) + order) * lanes + x % lanes] +=
                            scale * value * points[i * d + x];
                    }
                }
                // To the next derivative.
                scale *= length / (order + 1) as f64;
                for i in 0..degree {
                    let gap = knots[span + 1 + i] - knots[span + 1 + i - degree];
                    let factor = degree as f64 / gap;
                    for x in 0..d {
                        points[i * d + x] = (points[(i + 1) * d + x] - points[i * d + x]) * factor;
                    }
                }
            }
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

    /// The span of a parameter in the domain, looked for from another one on; its polynomial, its
    /// length, and the place in it.
    fn locate(&self, from: usize, t: f64) -> (usize, &[f64], f64, f64) {
        let values = self.knots.values();
        let degree = self.knots.degree();
        let spans = degree..self.knots.control_points();
        let within =
            |span: usize| spans.contains(&span) && values[span] <= t && t < values[span + 1];
        let span = if within(from) {
            from
        } else if within(from + 1) {
            from + 1
        } else {
            self.knots.span(t).unwrap_or(self.knots.degree())
        };
        let length = values[span + 1] - values[span];
        let stride = self.stride();
        let piece = &self.coefficients[(span - self.knots.degree()) * stride..][..stride];
        (span, piece, length, (t - values[span]) / length)
    }

    /// The point at a parameter.
    pub(crate) fn point(&mut self, t: f64, point: &mut [f64]) {
        let (span, piece, _, u) = self.locate(self.last, self.inside(t));
        match self.lanes {
            1 => evaluate::<1>(piece, self.knots.degree(), u, point),
            2 => evaluate::<2>(piece, self.knots.degree(), u, point),
            3 => evaluate::<3>(piece, self.knots.degree(), u, point),
            _ => evaluate::<4>(piece, self.knots.degree(), u, point),
        }
        self.last = span;
    }

    /// Moves the parameter of one point between `low` and `high`; returns it and the distance left.
    fn correct<const LANES: usize>(
        &mut self,
        point: &[f64],
        start: f64,
        (low, high): (f64, f64),
    ) -> (f64, f64) {
        let degree = self.knots.degree();
        let mut t = start;
        let (mut span, piece, mut length, u) = self.locate(self.last, self.inside(t));
        let mut here = moments::<LANES>(piece, degree, u, point);
        for _ in 0..STEPS {
            let Moments { slope, speed, bend, .. } = here;
            let curvature = if speed + bend > 0.1 * speed { speed + bend } else { speed };
            let next = (t - slope / curvature * length).clamp(low, high);
            if !next.is_finite() || next == t {
                break;
            }
            let (there, piece, its_length, u) = self.locate(span, self.inside(next));
            let trial = moments::<LANES>(piece, degree, u, point);
            span = there;
            if trial.square >= here.square || trial.square.is_nan() {
                break;
            }
            let small = (next - t).abs() < 1e-4 * (high - low);
            (t, here, length) = (next, trial, its_length);
            if small {
                break;
            }
        }
        self.last = span;
        (t, here.square.sqrt())
    }

    /// The foot point of one point between two parameters, from one in between on: its parameter and
    /// distance.
    pub(crate) fn foot(&mut self, point: &[f64], start: f64, room: (f64, f64)) -> (f64, f64) {
        match self.lanes {
            1 => self.correct::<1>(point, start, room),
            2 => self.correct::<2>(point, start, room),
            3 => self.correct::<3>(point, start, room),
            _ => self.correct::<4>(point, start, room),
        }
    }

    /// Distances of all points from the curve at parameters that stay.
    pub(crate) fn distances_at(&mut self, data: &[f64], parameters: &[f64], distances: &mut [f64]) {
        let points = data.chunks_exact(self.dimension).zip(parameters);
        for ((point, &t), distance) in points.zip(distances) {
            *distance = self.foot(point, t, (t, t)).1;
        }
    }

    /// Corrects all parameters; `distances` receives what is left. On an open curve the first and
    /// the last parameter stay. Parameters of a closed curve span less than a period, which may lie
    /// anywhere.
    ///
    /// With `reach` 1 parameters stay in order; with more they may pass up to so many neighbours, as
    /// those of noisy points must.
    pub(crate) fn correct_all(
        &mut self,
        data: &[f64],
        reach: usize,
        parameters: &mut [f64],
        distances: &mut [f64],
    ) {
        match self.lanes {
            1 => self.correct_each::<1>(data, reach, parameters, distances),
            2 => self.correct_each::<2>(data, reach, parameters, distances),
            3 => self.correct_each::<3>(data, reach, parameters, distances),
            _ => self.correct_each::<4>(data, reach, parameters, distances),
        }
    }

    fn correct_each<const LANES: usize>(
        &mut self,
        data: &[f64],
        reach: usize,
        parameters: &mut [f64],
        distances: &mut [f64],
    ) {
        let count = parameters.len();
        let (start, end) = self.knots.domain();
        let closed = self.knots.boundary() == Boundary::Periodic;
        let old = parameters.to_vec();
        let period = end - start;
        // Parameters of neighbours as they were, lap by lap round a closed curve.
        let before = |j: usize| match j.checked_sub(reach) {
            Some(k) => old[k],
            None if closed => old[j + count - reach] - period,
            None => start,
        };
        let after = |j: usize| match old.get(j + reach) {
            Some(&next) => next,
            None if closed => old[j + reach - count] + period,
            None => end,
        };
        for (j, point) in data.chunks_exact(self.dimension).enumerate() {
            let here = old[j];
            let fixed = !closed && (j == 0 || j + 1 == count);
            let room = if fixed {
                (here, here)
            } else {
                let (low, high) = (before(j).min(here), after(j).max(here));
                (here - SHARE * (here - low), here + SHARE * (high - here))
            };
            (parameters[j], distances[j]) = self.correct::<LANES>(point, here, room);
        }
    }
}

/// B-spline functions of degrees 0 to `p` at the first knot of a span, degree q from
/// `q (q + 1) / 2` on; `knots`: the `2 p` around the span, `p` of them up to its start.
fn functions_of_all_degrees(knots: &[f64], p: usize, values: &mut [f64]) {
    values[0] = 1.0;
    if p == 0 {
        return;
    }
    let t = knots[p - 1];
    for q in 1..=p {
        let (lower, row) = values.split_at_mut(q * (q + 1) / 2);
        let lower = &lower[q * (q - 1) / 2..];
        let mut saved = 0.0;
        for r in 0..q {
            let (left, right) = (knots[p - q + r], knots[p + r]);
            let part = lower[r] / (right - left);
            row[r] = saved + (right - t) * part;
            saved = (t - left) * part;
        }
        row[q] = saved;
    }
}

/// Value of a piece.
fn evaluate<const LANES: usize>(piece: &[f64], degree: usize, u: f64, point: &mut [f64]) {
    let groups = piece.chunks_exact(LANES * (degree + 1));
    for (group, out) in groups.zip(point.chunks_mut(LANES)) {
        let mut value = [0.0; LANES];
        for power in group.as_chunks::<LANES>().0.iter().rev() {
            for i in 0..LANES {
                value[i] = value[i] * u + power[i];
            }
        }
        let width = out.len();
        out.copy_from_slice(&value[..width]);
    }
}

/// Value and derivatives of a piece against a point.
fn moments<const LANES: usize>(piece: &[f64], degree: usize, u: f64, point: &[f64]) -> Moments {
    let mut sum = Moments::default();
    let groups = piece.chunks_exact(LANES * (degree + 1));
    for (group, wanted) in groups.zip(point.chunks(LANES)) {
        let (mut value, mut first, mut half) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for power in group.as_chunks::<LANES>().0.iter().rev() {
            for i in 0..LANES {
                half[i] = half[i] * u + first[i];
                first[i] = first[i] * u + value[i];
                value[i] = value[i] * u + power[i];
            }
        }
        for (i, q) in wanted.iter().enumerate().take(LANES) {
            let gap = value[i] - q;
            sum.square += gap * gap;
            sum.slope += gap * first[i];
            sum.speed += first[i] * first[i];
            sum.bend += 2.0 * gap * half[i];
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Curve;
    use crate::points::Points;

    #[test]
    fn pieces_and_their_derivatives_are_those_of_the_curve() {
        let inner = [0.3, 0.3, 0.7];
        for degree in 1..=7 {
            let mut knots = vec![0.0; degree + 1];
            knots.extend(&inner[usize::from(degree < 2)..]);
            knots.extend(vec![1.0; degree + 1]);
            let knots = KnotVector::open(degree, knots).unwrap();
            for dimension in [1, 2, 3, 4, 5, 9] {
                let numbers = knots.control_points() * dimension;
                let control: Vec<f64> = (0..numbers).map(|i| (i * i % 11) as f64).collect();
                let points = Points::new(dimension, control.clone()).unwrap();
                let curve = Curve::new(knots.clone(), points).unwrap();
                let mut moving = MovingCurve::new(&knots, &control, dimension);
                for t in [0.0, 0.1, 0.3, 0.31, 0.69, 0.95, 1.0] {
                    let mut jet = vec![0.0; 3 * dimension];
                    curve.derivatives_into(t, 2, &mut jet).unwrap();
                    let mut point = vec![0.0; dimension];
                    moving.point(t, &mut point);
                    let near = |x: f64, y: f64| (x - y).abs() <= 1e-10 * (1.0 + y.abs());
                    assert!(point.iter().zip(&jet).all(|(x, y)| near(*x, *y)), "{point:?} {jet:?}");

                    let wanted = vec![1.5; dimension];
                    let (_, piece, length, u) = moving.locate(0, t);
                    let found = match dimension {
                        1 => moments::<1>(piece, degree, u, &wanted),
                        2 => moments::<2>(piece, degree, u, &wanted),
                        3 => moments::<3>(piece, degree, u, &wanted),
                        _ => moments::<4>(piece, degree, u, &wanted),
                    };
                    let product = |order: usize| -> f64 {
                        let gap = |i: usize| jet[i] - wanted[i];
                        (0..dimension).map(|i| gap(i) * jet[order * dimension + i]).sum()
                    };
                    let speed: f64 = jet[dimension..2 * dimension].iter().map(|x| x * x).sum();
                    assert!(near(found.slope / length, product(1)), "{degree} {dimension} {t}");
                    assert!(near(found.bend / length.powi(2), product(2)));
                    assert!(near(found.speed / length.powi(2), speed));
                }
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
            moving.correct_all(&data, 1, &mut t, &mut distances);
            assert!(t.windows(2).all(|pair| pair[0] < pair[1]) && t[39] < t[0] + 8.0);
            assert!(distances.iter().zip(before).all(|(now, before)| *now <= before + 1e-15));
        }
    }
}
