//! Parameter correction on surfaces: parameters (u, v) of the points of a grid move towards their
//! foot points and stay in order along both directions.
//!
//! One safeguarded Gauss-Newton step a call; a parameter moves at most half-way to where its
//! neighbours were, and only to where the point is closer.

use crate::basis::basis_derivatives;
use crate::knots::{Boundary, KnotVector, MAX_DEGREE};

/// A surface under way: a net that moves over knots.
#[derive(Debug)]
pub(crate) struct MovingSurface<'a> {
    knots: [&'a KnotVector; 2],
    net: &'a [f64],
    dimension: usize,
    /// Rows and columns that move.
    shape: [usize; 2],
    /// Point and first derivatives where a walk stands, and where it may go.
    jet: Vec<f64>,
    trial: Vec<f64>,
}

/// Share of the gap to a neighbour that a parameter may use up.
const SHARE: f64 = 0.45;

impl<'a> MovingSurface<'a> {
    /// `net`: the control points that move, row by row.
    pub(crate) fn new(knots: [&'a KnotVector; 2], net: &'a [f64], dimension: usize) -> Self {
        let lines = |knots: &KnotVector| match knots.boundary() {
            Boundary::Periodic => knots.control_points() - knots.degree(),
            Boundary::Open => knots.control_points(),
        };
        Self {
            knots,
            net,
            dimension,
            shape: knots.map(lines),
            jet: vec![0.0; 3 * dimension],
            trial: vec![0.0; 3 * dimension],
        }
    }

    /// The parameters inside the domain: round a periodic direction, else to its end.
    pub(crate) fn inside(&self, pair: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|k| inside(self.knots[k], pair[k]))
    }

    /// The point at parameters (u, v).
    pub(crate) fn point(&mut self, pair: [f64; 2], point: &mut [f64]) {
        let mut jet = std::mem::take(&mut self.trial);
        self.jet_at(pair, 0, &mut jet);
        point.copy_from_slice(&jet[..self.dimension]);
        self.trial = jet;
    }

    /// Point, and for order 1 the derivatives in u and v, one after another.
    fn jet_at(&self, pair: [f64; 2], order: usize, jet: &mut [f64]) {
        let d = self.dimension;
        let mut rows = [[0.0; 2 * (MAX_DEGREE + 1)]; 2];
        let mut first = [0; 2];
        for (k, t) in self.inside(pair).into_iter().enumerate() {
            let (knots, degree) = (self.knots[k], self.knots[k].degree());
            let span = knots.span(t).unwrap_or(degree);
            basis_derivatives(knots.values(), degree, span, t, order, &mut rows[k]);
            first[k] = span - degree;
        }
        let [p, q] = self.knots.map(KnotVector::degree);
        let ([of_u, of_v], [rows, columns]) = (&rows, self.shape);
        jet.fill(0.0);
        for a in 0..=p {
            let row = (first[0] + a) % rows * columns;
            for b in 0..=q {
                let control = &self.net[(row + (first[1] + b) % columns) * d..][..d];
                let value = of_u[a] * of_v[b];
                jet[..d].iter_mut().zip(control).for_each(|(x, c)| *x += value * c);
                if order > 0 {
                    let (in_u, in_v) = (of_u[p + 1 + a] * of_v[b], of_u[a] * of_v[q + 1 + b]);
                    for (i, c) in control.iter().enumerate() {
                        jet[d + i] += in_u * c;
                        jet[2 * d + i] += in_v * c;
                    }
                }
            }
        }
    }

    /// Moves the parameters of one point inside a box; writes the vector from the surface to the
    /// point and returns the parameters and the distance left.
    fn correct(
        &mut self,
        point: &[f64],
        start: [f64; 2],
        room: [[f64; 2]; 2],
        vector: &mut [f64],
    ) -> ([f64; 2], f64) {
        let d = self.dimension;
        let (mut jet, mut trial) = (std::mem::take(&mut self.jet), std::mem::take(&mut self.trial));
        self.jet_at(start, 1, &mut jet);
        let (mut gradient, mut metric) = ([0.0; 2], [0.0; 3]);
        let mut square = 0.0;
        for i in 0..d {
            let gap = point[i] - jet[i];
            let (s_u, s_v) = (jet[d + i], jet[2 * d + i]);
            vector[i] = gap;
            square += gap * gap;
            gradient[0] += gap * s_u;
            gradient[1] += gap * s_v;
            metric[0] += s_u * s_u;
            metric[1] += s_u * s_v;
            metric[2] += s_v * s_v;
        }
        let free = room.map(|[low, high]| high > low);
        let step = step(gradient, metric, free);
        let mut pair = start;
        for share in [1.0, 0.4] {
            let next = [0, 1].map(|k| {
                let moved = start[k] + share * step[k];
                if free[k] && moved.is_finite() {
                    moved.clamp(room[k][0], room[k][1])
                } else {
                    start[k]
                }
            });
            if next == start {
                break;
            }
            self.jet_at(next, 0, &mut trial);
            let shorter: f64 = point.iter().zip(&trial).map(|(q, s)| (q - s) * (q - s)).sum();
            if shorter < square {
                (pair, square) = (next, shorter);
                for i in 0..d {
                    vector[i] = point[i] - trial[i];
                }
                break;
            }
        }
        (self.jet, self.trial) = (jet, trial);
        (pair, square.sqrt())
    }

    /// Corrects the parameters of all points of a grid, row by row; `vectors` and `distances` receive
    /// what is left. The lines at the ends of an open direction stay there. Parameters in a closed
    /// direction span less than a period, which may lie anywhere.
    pub(crate) fn correct_grid(
        &mut self,
        data: &[f64],
        shape: [usize; 2],
        parameters: &mut [[f64; 2]],
        vectors: &mut [f64],
        distances: &mut [f64],
    ) {
        let ([rows, columns], d) = (shape, self.dimension);
        let periods = self.knots.map(|knots| {
            let (start, end) = knots.domain();
            (knots.boundary() == Boundary::Periodic).then_some(end - start)
        });
        let before = parameters.to_vec();
        for i in 0..rows {
            for j in 0..columns {
                let k = i * columns + j;
                let neighbour = |at: usize, side: usize, line: [usize; 2]| {
                    before[line[0] * columns + line[1]][at]
                        + side as f64 * periods[at].unwrap_or(0.0)
                };
                let room = [0, 1].map(|at| {
                    let (index, count) = ([i, j][at], shape[at]);
                    let here = before[k][at];
                    let with = |index: usize| if at == 0 { [index, j] } else { [i, index] };
                    let low = match (index, periods[at]) {
                        (0, None) => return [here, here],
                        (0, Some(period)) => neighbour(at, 0, with(count - 1)) - period,
                        _ => neighbour(at, 0, with(index - 1)),
                    };
                    let high = if index + 1 < count {
                        neighbour(at, 0, with(index + 1))
                    } else if periods[at].is_some() {
                        neighbour(at, 1, with(0))
                    } else {
                        return [here, here];
                    };
                    [here - SHARE * (here - low).max(0.0), here + SHARE * (high - here).max(0.0)]
                });
                let point = &data[k * d..][..d];
                let vector = &mut vectors[k * d..][..d];
                let (moved, distance) = self.correct(point, before[k], room, vector);
                parameters[k] = moved;
                distances[k] = distance;
            }
        }
    }
}

/// The Gauss-Newton step in the free directions.
fn step(gradient: [f64; 2], [a, b, c]: [f64; 3], free: [bool; 2]) -> [f64; 2] {
    let determinant = a * c - b * b;
    match free {
        [true, true] if determinant > 1e-8 * a * c => [
            (c * gradient[0] - b * gradient[1]) / determinant,
            (a * gradient[1] - b * gradient[0]) / determinant,
        ],
        [true, true] if a >= c && a > 0.0 => [gradient[0] / a, 0.0],
        [true, true] if c > 0.0 => [0.0, gradient[1] / c],
        [true, false] if a > 0.0 => [gradient[0] / a, 0.0],
        [false, true] if c > 0.0 => [0.0, gradient[1] / c],
        _ => [0.0, 0.0],
    }
}

fn inside(knots: &KnotVector, t: f64) -> f64 {
    let (start, end) = knots.domain();
    if knots.boundary() == Boundary::Periodic && !(start..=end).contains(&t) {
        return (start + (t - start).rem_euclid(end - start)).clamp(start, end);
    }
    t.clamp(start, end)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corrected_parameters_stay_in_order_and_distances_do_not_grow() {
        let u = KnotVector::open(2, vec![0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0]).unwrap();
        let v = KnotVector::periodic(3, (-3..11).map(|i| f64::from(i) / 7.0).collect()).unwrap();
        let net: Vec<f64> = (0..4)
            .flat_map(|i| {
                (0..7).flat_map(move |j| {
                    let angle = f64::from(j) * std::f64::consts::TAU / 7.0;
                    [angle.cos() * (2.0 + f64::from(i)), angle.sin() * 3.0, f64::from(i * i)]
                })
            })
            .collect();
        let shape = [6, 15];
        let mut pairs = Vec::new();
        let mut data = Vec::new();
        for i in 0..6 {
            for j in 0..15 {
                pairs.push([f64::from(i) / 5.0, f64::from(j) / 15.0]);
                let angle = f64::from(j) * std::f64::consts::TAU / 15.0 + 0.2;
                let size = 1.5 + 0.5 * f64::from(i);
                data.extend([angle.cos() * size, angle.sin() * 2.0, 1.7 * f64::from(i)]);
            }
        }
        let mut moving = MovingSurface::new([&u, &v], &net, 3);
        let (mut vectors, mut distances) = (vec![0.0; 270], vec![f64::INFINITY; 90]);
        for _ in 0..40 {
            let before = distances.clone();
            moving.correct_grid(&data, shape, &mut pairs, &mut vectors, &mut distances);
            assert!(distances.iter().zip(before).all(|(now, before)| *now <= before + 1e-14));
            for i in 0..6 {
                let row = &pairs[i * 15..][..15];
                assert!(row.windows(2).all(|pair| pair[0][1] < pair[1][1]));
                assert!(row[14][1] < row[0][1] + 1.0);
            }
            assert!((0..75).all(|k| pairs[k][0] < pairs[k + 15][0]));
        }
        // Inside the patch the way from the surface is at right angles to it.
        let mut square = 0.0;
        for k in 15..75 {
            let mut jet = [0.0; 9];
            moving.jet_at(pairs[k], 1, &mut jet);
            let along: f64 = (0..3).map(|i| vectors[3 * k + i] * jet[6 + i]).sum();
            square += along * along;
        }
        assert!(square < 1e-6, "{square}");
    }
}
