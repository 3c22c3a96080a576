//! Weighted least squares over a net of control points.
//!
//! With weights of the points' own, or parameters of their own, the normal equations are no product
//! of one direction and the other, but near one: conjugate gradients preconditioned by that product
//! need a few steps, each in time proportional to the points, and no matrix of the net is stored.

use super::{CollocationMatrix, Factorization, NetRows};
use crate::Error;
use crate::memory;

/// Points wanted somewhere, with a weight each.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WeightedPart<'a> {
    pub(crate) rows: &'a NetRows,
    pub(crate) weights: &'a [f64],
    /// Shape (points, dimension).
    pub(crate) targets: &'a [f64],
}

/// The product of the normal bands of both directions, over the weights summed across.
#[derive(Debug, Clone)]
pub(crate) struct NetPreconditioner {
    sides: [Factorization; 2],
}

/// Share of the mean diagonal that keeps the bands regular where no data hold a control point.
const REGULAR: f64 = 1e-9;

impl NetPreconditioner {
    /// For the rows of the data and their weights.
    ///
    /// # Errors
    /// [`Error::Singular`].
    pub(crate) fn new(rows: &NetRows, weights: &[f64]) -> Result<Self, Error> {
        let total: f64 = weights.iter().sum();
        let side = |k: usize| {
            let (lines, sums) = rows.marginal(k, weights);
            let mut equations = lines.equations(1);
            let share = if k == 0 && total > 0.0 { total.recip() } else { 1.0 };
            for (j, sum) in sums.iter().enumerate() {
                lines.add_to(j, share * sum, &[0.0], &mut equations);
            }
            equations.hold(&[], REGULAR);
            equations.into_parts().0.factor(None)
        };
        Ok(Self { sides: [side(0)?, side(1)?] })
    }

    /// Solves in place, for a net of points of a dimension.
    pub(crate) fn solve_in_place(&self, net: &mut [f64], dimension: usize) {
        let width = self.sides[1].size() * dimension;
        self.sides[0].solve_in_place(net, width);
        for row in net.chunks_exact_mut(width) {
            self.sides[1].solve_in_place(row, dimension);
        }
    }
}

/// Moves a net to the weighted least squares solution of all parts together, from where it stands:
/// what no data hold stays. Ends when the norm of the gradient, as the preconditioner sees it, has
/// fallen to `reduction` of what it was, or after `most` steps; the steps are returned.
pub(crate) fn solve_weighted(
    parts: &[WeightedPart<'_>],
    preconditioner: &NetPreconditioner,
    net: &mut [f64],
    dimension: usize,
    reduction: f64,
    most: usize,
) -> usize {
    let size = net.len();
    let longest = parts.iter().map(|part| part.rows.points()).max().unwrap_or(0);
    let mut vectors = memory::zeros(longest * dimension);
    let mut gradient = memory::zeros(size);
    for part in parts {
        let vectors = &mut vectors[..part.rows.points() * dimension];
        part.rows.visit(net, dimension, |k, point| {
            let target = &part.targets[k * dimension..][..dimension];
            for ((x, q), s) in
                vectors[k * dimension..][..dimension].iter_mut().zip(target).zip(point)
            {
                *x = part.weights[k] * (q - s);
            }
        });
        part.rows.add_transposed(vectors, dimension, &mut gradient);
    }
    let mut step = gradient.clone();
    preconditioner.solve_in_place(&mut step, dimension);
    let mut direction = step.clone();
    let mut image = memory::zeros(size);
    let mut slope = dot(&gradient, &step);
    let enough = reduction * reduction * slope;
    for count in 0..most {
        if !(slope > enough && slope.is_finite()) {
            return count;
        }
        image.fill(0.0);
        for part in parts {
            let vectors = &mut vectors[..part.rows.points() * dimension];
            part.rows.visit(&direction, dimension, |k, point| {
                let target = &mut vectors[k * dimension..][..dimension];
                target.iter_mut().zip(point).for_each(|(x, s)| *x = part.weights[k] * s);
            });
            part.rows.add_transposed(vectors, dimension, &mut image);
        }
        let bend = dot(&direction, &image);
        if !(bend > 0.0 && bend.is_finite()) {
            return count;
        }
        let along = slope / bend;
        net.iter_mut().zip(&direction).for_each(|(x, y)| *x += along * y);
        gradient.iter_mut().zip(&image).for_each(|(x, y)| *x -= along * y);
        step.copy_from_slice(&gradient);
        preconditioner.solve_in_place(&mut step, dimension);
        let next = dot(&gradient, &step);
        let share = next / slope;
        slope = next;
        direction.iter_mut().zip(&step).for_each(|(x, y)| *x = y + share * *x);
    }
    most
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::knots::KnotVector;

    /// Gradient of the weighted squares at a net.
    fn gradient(part: &WeightedPart<'_>, net: &[f64]) -> Vec<f64> {
        let mut vectors = vec![0.0; part.targets.len()];
        part.rows.visit(net, 1, |k, point| {
            vectors[k] = part.weights[k] * (part.targets[k] - point[0]);
        });
        let mut sum = vec![0.0; net.len()];
        part.rows.add_transposed(&vectors, 1, &mut sum);
        sum
    }

    #[test]
    fn equal_weights_on_lines_take_one_step_and_others_a_few() {
        let u = KnotVector::open(3, vec![0., 0., 0., 0., 0.3, 0.7, 1., 1., 1., 1.]).unwrap();
        let v = KnotVector::open(2, vec![0.0, 0.0, 0.0, 0.2, 0.5, 1.0, 1.0, 1.0]).unwrap();
        let lines =
            |n: i32| -> Vec<f64> { (0..n).map(|i| f64::from(i) / f64::from(n - 1)).collect() };
        let (t_u, t_v) = (lines(13), lines(11));
        let rows = NetRows::of_lines([&t_u, &t_v], [&u, &v]);
        let targets: Vec<f64> = (0..143).map(|i| f64::from(i * i % 29)).collect();
        let equal = vec![1.0; 143];
        let uneven: Vec<f64> = (0..143).map(|i| 0.2 + f64::from(i * 7 % 10)).collect();
        for (weights, most) in [(&equal, 2), (&uneven, 30)] {
            let part = WeightedPart { rows: &rows, weights, targets: &targets };
            let preconditioner = NetPreconditioner::new(&rows, weights).unwrap();
            let mut net = vec![0.0; 30];
            let steps = solve_weighted(&[part], &preconditioner, &mut net, 1, 1e-9, 100);
            assert!((1..=most).contains(&steps), "{steps}");
            assert!(gradient(&part, &net).iter().all(|x| x.abs() < 1e-6));
        }
    }
}
