//! Eigenvalues, rates and decays measured on the library's operators until they stand still.

use gimfit::Error;
use gimfit::collocation::{
    BandedCollocation, CollocationMatrix, CollocationOperator, interpolation,
};
use gimfit::iteration::{Step, UpdateRule};
use gimfit::knots::{KnotPlacement, place_knots};
use gimfit::parameters::Parameters;

/// The operator of a closed curve through `count` points at equal steps, averaged knots.
pub(super) fn closed_uniform(degree: usize, count: usize) -> Result<BandedCollocation, Error> {
    let values = (0..count).map(|j| j as f64).collect();
    operator(degree, &Parameters::closed(values, count as f64)?)
}

/// The operator of an open curve at these parameters, averaged knots.
pub(super) fn open(degree: usize, values: Vec<f64>) -> Result<BandedCollocation, Error> {
    operator(degree, &Parameters::open(values)?)
}

fn operator(degree: usize, parameters: &Parameters) -> Result<BandedCollocation, Error> {
    let knots = place_knots(degree, parameters, &KnotPlacement::Averaged)?;
    Ok(interpolation(parameters, &knots)?.operator)
}

/// Smallest eigenvalue by inverse iteration to rounding level. The library's own search ends at
/// 1e-3, which is enough for weights but not for tables.
pub(super) fn smallest_eigenvalue(operator: &dyn CollocationMatrix) -> Result<f64, Error> {
    const MOST_STEPS: usize = 4000;
    let factors = operator.factor(None)?;
    // Close to the eigenvector: that of the largest frequency.
    let mut x: Vec<f64> =
        (0..factors.size()).map(|j| if j % 2 == 0 { 1.0 } else { -1.0 }).collect();
    let mut growth = 0.0;
    for _ in 0..MOST_STEPS {
        let before = norm(&x);
        x.iter_mut().for_each(|x| *x /= before);
        factors.solve_in_place(&mut x, 1);
        let now = norm(&x);
        if (now - growth).abs() <= f64::EPSILON * now {
            return Ok(1.0 / now);
        }
        growth = now;
    }
    Ok(1.0 / growth)
}

/// How much of a residual one step of a rule leaves in the long run: the spectral radius of its
/// step, by power iteration on the difference vectors themselves, `R <- R - A rule(R)`. They are
/// scaled back to length 1, so that rounding never takes over.
pub(super) fn rate(operator: &BandedCollocation, rule: &mut dyn UpdateRule) -> f64 {
    /// Steps before the measurement, until slower modes are gone.
    const FIRST: usize = 16_000;
    /// An even number: modes of opposite sign make single steps alternate.
    const MEASURED: usize = 200;
    let count = operator.points();
    // Without symmetry, so that no mode is missed.
    let mut residual: Vec<f64> = (0..count)
        .map(|j| if j % 2 == 0 { 1.0 } else { -1.0 } + 0.1 * (j * j % 7) as f64)
        .collect();
    let mut adjusting = vec![0.0; count];
    let mut change = vec![0.0; count];
    let mut logarithm = 0.0;
    for iteration in 0..FIRST + MEASURED {
        adjusting.copy_from_slice(&residual);
        rule.adjust(Step { iteration, control: &residual, dimension: 1 }, &mut adjusting);
        operator.apply(&adjusting, 1, &mut change);
        residual.iter_mut().zip(&change).for_each(|(r, change)| *r -= change);
        let left = norm(&residual);
        residual.iter_mut().for_each(|r| *r /= left);
        if iteration >= FIRST {
            logarithm += left.ln();
        }
    }
    (logarithm / MEASURED as f64).exp()
}

/// Factor by which a control point changes less, one data point farther from a data point that
/// moves: the dominant pole of the inverse. Read off where the smaller poles are gone and rounding
/// is not there yet.
pub(super) fn decay_of_inverse(operator: &BandedCollocation) -> Result<f64, Error> {
    const SMALL: f64 = 1e-5;
    let factors = operator.factor(None)?;
    let mut column = vec![0.0; factors.size()];
    let middle = column.len() / 2;
    column[middle] = 1.0;
    factors.solve_in_place(&mut column, 1);
    let tail = &column[middle..];
    let pair = tail.windows(2).find(|pair| pair[1].abs() < SMALL * tail[0].abs());
    Ok(pair.map_or(f64::NAN, |pair| pair[1] / pair[0]))
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}
