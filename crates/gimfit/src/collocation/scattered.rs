//! Collocation of tensor-product bases at points that share no parameters: every point of a grid has
//! its own (u, v), and no Kronecker product is left.

use super::grid::norms_of;
use super::{CollocationOperator, ControlLayout, NetLayout, ResidualNorms};
use crate::basis::basis_functions;
use crate::knots::KnotVector;

/// `[B_a(u_k) B_b(v_k)]` over the points k of a grid and the control points (a, b) of its net; the
/// product is formed row by row, from the few functions of either direction. Memory: `12 (p + q + 2)`
/// bytes a point.
#[derive(Debug, Clone)]
pub(crate) struct ScatteredCollocation {
    points: usize,
    /// Control points that move in direction v.
    columns: usize,
    sides: [Side; 2],
    /// Of the control points that move, row by row, for a rational surface.
    rational_weights: Option<Vec<f64>>,
}

/// The functions of one direction that do not vanish, and the lines of the net they belong to.
#[derive(Debug, Clone)]
struct Side {
    layout: ControlLayout,
    /// Lines of the net that move.
    lines: usize,
    width: usize,
    line: Vec<u32>,
    weights: Vec<f64>,
}

impl ScatteredCollocation {
    /// For a grid of this shape. Its rows are empty until [`ScatteredCollocation::collocate`].
    pub(crate) fn new(
        shape: [usize; 2],
        degrees: [usize; 2],
        layout: NetLayout,
        rational_weights: Option<Vec<f64>>,
    ) -> Self {
        let points = shape[0] * shape[1];
        let side = |k: usize, layout| Side {
            layout,
            lines: shape[k],
            width: degrees[k] + 1,
            line: vec![0; points * (degrees[k] + 1)],
            weights: vec![0.0; points * (degrees[k] + 1)],
        };
        let sides = [side(0, layout.u), side(1, layout.v)];
        Self { points, columns: shape[1], sides, rational_weights }
    }

    /// Collocates at parameters (u, v) in the domain, one pair per point. The first point that does
    /// not meet its own basis function is returned.
    pub(crate) fn collocate(
        &mut self,
        parameters: impl Iterator<Item = [f64; 2]>,
        knots: &[KnotVector; 2],
    ) -> Result<(), usize> {
        let mut missing = None;
        for (k, pair) in parameters.enumerate() {
            let own = [k / self.columns, k % self.columns];
            for (direction, side) in self.sides.iter_mut().enumerate() {
                let met = side.fill(k, pair[direction], &knots[direction], own[direction]);
                if !met && missing.is_none() {
                    missing = Some(k);
                }
            }
        }
        missing.map_or(Ok(()), Err)
    }

    /// Writes row `k` times `x` into `point`, which holds zeros.
    fn blend(&self, k: usize, x: &[f64], dimension: usize, point: &mut [f64]) {
        let [u, v] = &self.sides;
        let mut sum = 0.0;
        for (a, weight_u) in u.row(k) {
            for (b, weight_v) in v.row(k) {
                let place = a * self.columns + b;
                let rational = self.rational_weights.as_ref().map_or(1.0, |w| w[place]);
                let weight = weight_u * weight_v * rational;
                sum += weight;
                let control = &x[place * dimension..][..dimension];
                point.iter_mut().zip(control).for_each(|(x, c)| *x += weight * c);
            }
        }
        if self.rational_weights.is_some() {
            point.iter_mut().for_each(|x| *x /= sum);
        }
    }
}

impl Side {
    /// Row `k` at a parameter; whether the function of line `own` is met.
    fn fill(&mut self, k: usize, t: f64, knots: &KnotVector, own: usize) -> bool {
        let (width, degree) = (self.width, self.width - 1);
        let place = k * width..(k + 1) * width;
        let (lines, weights) = (&mut self.line[place.clone()], &mut self.weights[place]);
        let Ok(span) = knots.span(t) else { return false };
        basis_functions(knots.values(), degree, span, t, weights);
        let mut met = 0.0;
        for (offset, (line, weight)) in lines.iter_mut().zip(weights).enumerate() {
            let source = self.layout.source(span - degree + offset, self.lines);
            *line = source as u32;
            if source == own {
                met += *weight;
            }
        }
        met > 0.0
    }

    fn row(&self, k: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let place = k * self.width..(k + 1) * self.width;
        let lines = self.line[place.clone()].iter().map(|&line| line as usize);
        lines.zip(self.weights[place].iter().copied())
    }
}

impl CollocationOperator for ScatteredCollocation {
    fn points(&self) -> usize {
        self.points
    }

    fn control_points(&self) -> usize {
        self.points
    }

    fn apply(&self, x: &[f64], dimension: usize, result: &mut [f64]) {
        result.fill(0.0);
        for (k, point) in result.chunks_exact_mut(dimension).enumerate() {
            self.blend(k, x, dimension, point);
        }
    }

    fn difference_vectors(
        &self,
        data: &[f64],
        control: &[f64],
        dimension: usize,
        result: &mut [f64],
    ) -> ResidualNorms {
        self.apply(control, dimension, result);
        result.iter_mut().zip(data).for_each(|(x, q)| *x = q - *x);
        norms_of(result, dimension)
    }
}
