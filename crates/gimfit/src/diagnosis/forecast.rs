//! How fast each method will run, told by its error matrix and not by running it.
//!
//! A rule that is linear turns difference vectors `R` into `(I - A W) R`. Of a window of the
//! collocation matrix that matrix is formed; its eigenvalues give the rate in the long run, and its
//! powers, by repeated squaring, the step in which the residual falls to a tolerance, transient
//! growth included. What happens at one place of a long curve depends on its neighbourhood only, so
//! windows around the places that decide stand for the whole.

use crate::collocation::{CollocationOperator, DenseCollocation, eigenvalues};
use crate::iteration::UpdateRule;
use crate::iteration::update::Step;

/// What is expected of a method.
#[derive(Debug, Clone, PartialEq)]
pub struct Forecast {
    /// The method.
    pub method: &'static str,
    /// Its weight; for Chebyshev the lower end of its interval.
    pub weight: Option<f64>,
    /// What a step leaves of a residual in the long run; 1 or more means divergence.
    pub rate: f64,
    /// Largest factor by which the norm of a residual may grow on the way.
    pub growth: f64,
    /// The step in which the largest residual falls to the tolerance; `None` if it never does, or
    /// only after 2^40 steps, if the run stalls, or if no tolerance was given.
    pub iterations: Option<u64>,
    /// Whether residuals rise so far, or so long, before they fall that a run gives up.
    pub stalls: bool,
    /// Smallest and largest real part of the eigenvalues of `A W`.
    pub(super) spectrum: (f64, f64),
}

impl Forecast {
    /// Whether the method converges.
    #[must_use]
    pub fn converges(&self) -> bool {
        self.rate < 1.0 - ROUNDING
    }
}

/// Rates closer to 1 cannot be told from it.
const ROUNDING: f64 = 1e-13;

/// Residuals of the start, and the tolerance asked for.
#[derive(Debug, Clone, Copy)]
pub struct Start<'a> {
    /// Difference vectors of the start, shape (points, dimension).
    pub difference_vectors: &'a [f64],
    /// Coordinates per point.
    pub dimension: usize,
    /// The residual to be reached.
    pub tolerance: f64,
}

/// A part of the matrix with the difference vectors there.
#[derive(Debug)]
pub(super) struct Window {
    pub(super) matrix: DenseCollocation,
    /// Empty without a [`Start`].
    pub(super) vectors: Vec<f64>,
    pub(super) dimension: usize,
    pub(super) tolerance: f64,
}

/// Squarings before the search for a step is given up.
const MOST_SQUARINGS: usize = 40;

/// What one window says.
#[derive(Debug, Clone, Copy)]
pub(super) struct WindowForecast {
    pub(super) rate: f64,
    pub(super) spectrum: (f64, f64),
    pub(super) growth: f64,
    pub(super) iterations: Option<u64>,
    pub(super) stalls: bool,
}

/// Forecasts a rule without memory on a window.
pub(super) fn forecast(window: &Window, rule: &mut dyn UpdateRule) -> WindowForecast {
    let n = window.matrix.points();
    let error = error_matrix(&window.matrix, rule);
    let (mut rate, mut spectrum) = (0.0_f64, (f64::INFINITY, f64::NEG_INFINITY));
    match eigenvalues(error.clone(), n) {
        Some(all) => {
            for value in all {
                rate = rate.max(value.modulus());
                spectrum = (spectrum.0.min(1.0 - value.re), spectrum.1.max(1.0 - value.re));
            }
        }
        None => rate = f64::NAN,
    }
    let Course { iterations, growth, stalls } = steps(window, error);
    WindowForecast { rate, spectrum, growth, iterations, stalls: stalls && rate < 1.0 }
}

/// `I - A W`, row by row.
fn error_matrix(matrix: &DenseCollocation, rule: &mut dyn UpdateRule) -> Vec<f64> {
    let n = matrix.points();
    let control = vec![0.0; n * n];
    // All unit vectors at once, as coordinates of points of dimension n.
    let mut vectors = vec![0.0; n * n];
    (0..n).for_each(|j| vectors[j * n + j] = 1.0);
    rule.adjust(Step { iteration: 0, control: &control, dimension: n }, &mut vectors);
    let mut error = control;
    matrix.apply(&vectors, n, &mut error);
    error.iter_mut().for_each(|x| *x = -*x);
    (0..n).for_each(|j| error[j * n + j] += 1.0);
    error
}

/// How residuals go.
struct Course {
    iterations: Option<u64>,
    /// Largest norm of a power of the error matrix met.
    growth: f64,
    stalls: bool,
}

/// Steps without gain that end a run, and the growth of a residual that does.
const PATIENCE: u64 = 100;
const DIVERGENCE: f64 = 1e8;

/// Follows residuals through powers of the error matrix to the first after which none exceeds the
/// tolerance.
fn steps(window: &Window, error: Vec<f64>) -> Course {
    let n = window.matrix.points();
    let mut course = Course { iterations: None, growth: row_norm(&error, n), stalls: false };
    if window.vectors.is_empty() {
        let mut power = error;
        for _ in 0..8 {
            power = multiply(&power, &power, n);
            course.grow(row_norm(&power, n));
        }
        return course;
    }
    let size = |vectors: &[f64]| largest_norm(vectors, window.dimension);
    let first = size(&window.vectors);
    if first <= window.tolerance {
        return Course { iterations: Some(0), growth: 1.0, ..course };
    }
    let mut powers = vec![error];
    let (mut best, mut best_step) = (first, 0);
    loop {
        let power = &powers[powers.len() - 1];
        course.grow(row_norm(power, n));
        let now = size(&multiply(power, &window.vectors, window.dimension));
        if now <= window.tolerance {
            break;
        }
        let step = 1_u64 << (powers.len() - 1);
        course.stalls |= now > DIVERGENCE * first || (now >= best && step - best_step >= PATIENCE);
        if now < best {
            (best, best_step) = (now, step);
        }
        if course.stalls || !course.growth.is_finite() || powers.len() > MOST_SQUARINGS {
            return course;
        }
        let square = multiply(power, power, n);
        powers.push(square);
    }
    // The last power is enough; those before it, largest first, say how little is.
    let mut vectors = window.vectors.clone();
    let mut taken = 0;
    powers.pop();
    for (k, power) in powers.iter().enumerate().rev() {
        let after = multiply(power, &vectors, window.dimension);
        if size(&after) > window.tolerance {
            vectors = after;
            taken += 1_u64 << k;
        }
    }
    course.iterations = Some(taken + 1);
    course
}

impl Course {
    fn grow(&mut self, norm: f64) {
        // A norm that is no number came of an overflow.
        self.growth = if norm.is_nan() { f64::INFINITY } else { self.growth.max(norm) };
    }
}

/// How far a rehearsal came.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rehearsed {
    /// The step in which the largest residual fell to the tolerance.
    pub(crate) end: Option<u64>,
    /// Whether residuals rose so far, or so long, that a run gives up.
    pub(crate) stalls: bool,
    /// Steps rehearsed, and the largest residual they left.
    pub(crate) taken: u64,
    pub(crate) left: f64,
}

/// Follows difference vectors step by step, for rules with memory and operators that are no small
/// matrix: a rule that is given no control points leaves `R - A W R`.
pub(crate) fn rehearse(
    operator: &dyn CollocationOperator,
    start: Start<'_>,
    rule: &mut dyn UpdateRule,
    most: usize,
) -> Rehearsed {
    let dimension = start.dimension;
    let mut vectors = start.difference_vectors.to_vec();
    let control = vec![0.0; vectors.len()];
    let mut change = control.clone();
    let mut adjusting = control.clone();
    let (mut first, mut best, mut best_step) = (f64::INFINITY, f64::INFINITY, 0);
    let mut found = Rehearsed { end: None, stalls: false, taken: 0, left: f64::INFINITY };
    for iteration in 0..=most {
        let (now, step) = (largest_norm(&vectors, dimension), iteration as u64);
        (found.taken, found.left) = (step, now);
        if now <= start.tolerance {
            found.end = Some(step);
            break;
        }
        first = if iteration == 0 { now } else { first };
        if now < best {
            (best, best_step) = (now, step);
        } else if now.is_nan() || now > DIVERGENCE * first || step - best_step >= PATIENCE {
            found.stalls = true;
            break;
        }
        if iteration == most {
            break;
        }
        adjusting.copy_from_slice(&vectors);
        rule.adjust(Step { iteration, control: &control, dimension }, &mut adjusting);
        operator.apply(&adjusting, dimension, &mut change);
        vectors.iter_mut().zip(&change).for_each(|(x, change)| *x -= change);
    }
    found
}

/// `A B` for a square `A` and rows of `B` of a length.
fn multiply(a: &[f64], b: &[f64], length: usize) -> Vec<f64> {
    let n = b.len() / length;
    let mut product = vec![0.0; b.len()];
    for (row, result) in a.chunks_exact(n).zip(product.chunks_exact_mut(length)) {
        for (factor, line) in row.iter().zip(b.chunks_exact(length)) {
            if *factor != 0.0 {
                result.iter_mut().zip(line).for_each(|(x, y)| *x += factor * y);
            }
        }
    }
    product
}

fn row_norm(a: &[f64], n: usize) -> f64 {
    a.chunks_exact(n).map(|row| row.iter().map(|x| x.abs()).sum::<f64>()).fold(0.0, |most, sum| {
        // A sum that is no number must not be passed over.
        if sum > most || sum.is_nan() { sum } else { most }
    })
}

pub(super) fn largest_norm(vectors: &[f64], dimension: usize) -> f64 {
    vectors
        .chunks_exact(dimension)
        .map(|vector| vector.iter().map(|x| x * x).sum::<f64>().sqrt())
        .fold(0.0, |most, norm| if norm > most || norm.is_nan() { norm } else { most })
}
