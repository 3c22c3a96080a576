//! Geometric interpolation as it is told (Maekawa, Matsumoto and Namiki 2007): move every control
//! point by the vector from the foot point of its data point. Foot points by walking in small steps
//! and halving an interval.

use crate::dense::Rows;
use crate::textbook::{basis_derivative, basis_function, curve_point};

/// Steps from end to end of the domain, of the walk to a foot point.
const WALK: f64 = 4000.0;

/// Half the derivative of the squared distance of `point` from the curve.
fn slope(u: &[f64], p: usize, control: &Rows, point: &[f64], t: f64) -> f64 {
    let on_curve = curve_point(u, p, control, t);
    let mut sum = 0.0;
    for (i, row) in control.iter().enumerate() {
        let weight = basis_derivative(u, p, i, t);
        sum += (0..point.len()).map(|c| (on_curve[c] - point[c]) * weight * row[c]).sum::<f64>();
    }
    sum
}

/// The local foot point of `point` on an open curve: downhill from `start`, step by step, to where
/// the slope changes its sign, then halving; or an end of the domain.
#[must_use]
pub fn foot_parameter(u: &[f64], p: usize, control: &Rows, point: &[f64], start: f64) -> f64 {
    let (from, to) = (u[p], u[u.len() - p - 1]);
    let downhill = -slope(u, p, control, point, start).signum();
    let step = (to - from) / WALK * downhill;
    let mut here = start;
    let mut ahead = start;
    loop {
        if (ahead <= from && downhill < 0.0) || (ahead >= to && downhill > 0.0) {
            return ahead;
        }
        ahead = (here + step).clamp(from, to);
        if slope(u, p, control, point, ahead) * downhill >= 0.0 {
            break;
        }
        here = ahead;
    }
    for _ in 0..60 {
        let middle = 0.5 * (here + ahead);
        if slope(u, p, control, point, middle) * downhill >= 0.0 {
            ahead = middle;
        } else {
            here = middle;
        }
    }
    0.5 * (here + ahead)
}

/// Control points and parameters after each of `steps` steps, those of the start first. The end
/// parameters stay.
#[must_use]
pub fn iterates(
    u: &[f64],
    p: usize,
    data: &Rows,
    start: &[f64],
    steps: usize,
) -> Vec<(Rows, Vec<f64>)> {
    let (mut control, mut t) = (data.clone(), start.to_vec());
    let mut all = Vec::new();
    for _ in 0..=steps {
        for j in 1..data.len() - 1 {
            t[j] = foot_parameter(u, p, &control, &data[j], t[j]);
        }
        all.push((control.clone(), t.clone()));
        control = control
            .iter()
            .zip(data)
            .zip(&t)
            .map(|((row, q), &t)| {
                let foot = curve_point(u, p, &all[all.len() - 1].0, t);
                (0..q.len()).map(|c| row[c] + q[c] - foot[c]).collect()
            })
            .collect();
    }
    all
}

/// A net of control points over the knots `u` and `v` of degrees `p` and `q`, in rows.
#[derive(Debug, Clone)]
pub struct Net<'a> {
    /// Knots of both directions.
    pub knots: [&'a [f64]; 2],
    /// Degrees.
    pub degrees: [usize; 2],
    /// Rows and columns.
    pub shape: [usize; 2],
    /// The control points, row by row.
    pub control: Rows,
}

impl Net<'_> {
    /// The point at (u, v), from the definition.
    #[must_use]
    pub fn point(&self, [u, v]: [f64; 2]) -> Vec<f64> {
        let mut point = vec![0.0; self.control[0].len()];
        for a in 0..self.shape[0] {
            let weight_u = basis_function(self.knots[0], self.degrees[0], a, u);
            for b in 0..self.shape[1] {
                let weight = weight_u * basis_function(self.knots[1], self.degrees[1], b, v);
                let control = &self.control[a * self.shape[1] + b];
                point.iter_mut().zip(control).for_each(|(x, c)| *x += weight * c);
            }
        }
        point
    }

    /// The local foot point of `point` on the domain [0, 1] x [0, 1], by a pattern search: the best
    /// of the neighbours at a distance, and half the distance once none is better. Parameters that
    /// are `held` stay. Accurate to about 1e-8.
    #[must_use]
    pub fn foot(&self, point: &[f64], start: [f64; 2], held: [bool; 2]) -> [f64; 2] {
        let square = |at: [f64; 2]| -> f64 {
            self.point(at).iter().zip(point).map(|(a, b)| (a - b).powi(2)).sum()
        };
        let (mut here, mut step) = (start, 1e-2);
        let mut least = square(here);
        while step > 1e-9 {
            let mut better = None;
            for offset in [
                [1., 0.],
                [-1., 0.],
                [0., 1.],
                [0., -1.],
                [1., 1.],
                [-1., -1.],
                [1., -1.],
                [-1., 1.],
            ] {
                let trial = [0, 1].map(|k| {
                    if held[k] { here[k] } else { (here[k] + step * offset[k]).clamp(0.0, 1.0) }
                });
                let value = square(trial);
                if value < least {
                    (better, least) = (Some(trial), value);
                }
            }
            match better {
                Some(trial) => here = trial,
                None => step *= 0.5,
            }
        }
        here
    }
}
