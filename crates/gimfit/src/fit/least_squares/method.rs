//! From a named method of least squares to a rule, with what had to be found out on the way.

use super::{LeastSquaresMethod as Method, LeastSquaresWeight as Weight};
use crate::Error;
use crate::collocation::{
    CollocationMatrix, Factorization, LeastSquaresCollocation, NormalMatrix, gauss_seidel_rate,
};
use crate::fit::method::ChosenRule;
use crate::iteration::UpdateRule;
use crate::iteration::update::{
    Chebyshev, ConjugateGradients, GaussSeidel, HeavyBall, Nesterov, PerPoint, Pia, Preconditioner,
    RandomColumns, RandomRows, SaLspia, Scaled, Sor, Staged, Weighted,
};

/// What a rule is made of.
pub(super) struct Setting<'a> {
    pub(super) operator: &'a LeastSquaresCollocation,
    pub(super) normal: &'a NormalMatrix,
    /// Scaled, shape (points, dimension).
    pub(super) data: &'a [f64],
    pub(super) dimension: usize,
    pub(super) weight: Weight,
    pub(super) seed: u64,
    /// Steps of the way there that are wanted, where the method is left to us.
    pub(super) gradual: usize,
    /// Whether constraints may couple the coordinates.
    pub(super) coupled: bool,
}

/// Prepares the rule of a method.
pub(super) fn choose<'a>(method: Method, setting: &Setting<'a>) -> Result<ChosenRule<'a>, Error> {
    let &Setting { operator, normal, data, dimension, weight, seed, gradual, coupled } = setting;
    check_weight(method, weight)?;
    let matrix = normal.matrix();
    let length = operator.stays().len() * dimension;
    let mut choices = Vec::new();
    let mut smallest_eigenvalue = None;
    let gradients = |preconditioner| -> Box<dyn UpdateRule + 'a> {
        let rule = ConjugateGradients::new(matrix, preconditioner, dimension);
        Box::new(if coupled { rule.joint() } else { rule })
    };
    // Where no control point moves there are no eigenvalues, and any weight will do.
    let mut spectrum = |scaled: bool| {
        let found = if scaled { normal.scaled_eigenvalues() } else { normal.eigenvalues() };
        smallest_eigenvalue = found.map(|(smallest, _)| smallest);
        found.unwrap_or((1.0, 1.0))
    };
    let rule: Box<dyn UpdateRule + 'a> = match method {
        Method::Auto => {
            let whole = gradients(whole_band(normal, &mut choices)?);
            if gradual > 0 {
                choices.push(format!(
                    "method: LSPIA weighted by column sums up to step {gradual}, because fits of the \
                     way are kept, then conjugate gradients preconditioned by the whole band"
                ));
                Box::new(Staged::new(PerPoint::new(normal.reciprocal_sums()), gradual, whole))
            } else {
                choices.push(
                    "method: conjugate gradients preconditioned by the whole band of the normal \
                     matrix, which reach the limit in a few steps"
                        .into(),
                );
                whole
            }
        }
        Method::Lspia => {
            let omega = match weight {
                Weight::Published => {
                    let largest = largest(operator.column_sums());
                    choices.push(format!(
                        "weight: {:.6e}, 2 over the largest column sum, as published",
                        2.0 / largest
                    ));
                    2.0 / largest
                }
                Weight::Same(omega) => {
                    let bound = 2.0 / spectrum(false).1;
                    if omega >= bound {
                        return Err(Error::OutOfRange {
                            what: "weight of lspia".into(),
                            value: omega,
                            rule: "it must lie below 2 over the largest eigenvalue of the normal \
                                   matrix, or the iteration diverges; leave it to auto",
                        });
                    }
                    omega
                }
                Weight::Auto => {
                    let (low, high) = spectrum(false);
                    choices.push(format!(
                        "weight: {:.6e}, best for eigenvalues of the normal matrix in [{low:.4e}, \
                         {high:.4e}]",
                        2.0 / (low + high)
                    ));
                    2.0 / (low + high)
                }
            };
            Box::new(Weighted::new(omega))
        }
        Method::ColumnSums => {
            let factor = match weight {
                Weight::Published => 1.0,
                Weight::Same(factor) => factor,
                Weight::Auto => {
                    let (low, high) = spectrum(true);
                    choices.push(format!(
                        "weight: {:.6} over the column sums, best for eigenvalues in [{low:.4e}, \
                         {high:.4e}]",
                        2.0 / (low + high)
                    ));
                    2.0 / (low + high)
                }
            };
            let weights = normal.reciprocal_sums().into_iter().map(|w| factor * w).collect();
            Box::new(PerPoint::new(weights))
        }
        Method::GaussSeidel => Box::new(GaussSeidel::new(matrix)),
        Method::Sor => {
            let omega = match weight {
                Weight::Same(omega) => omega,
                _ => {
                    let omega = Sor::best_for(gauss_seidel_rate(matrix));
                    choices.push(format!("weight: {omega:.6}, from the rate of Gauss-Seidel"));
                    omega
                }
            };
            Box::new(Sor::new(matrix, omega))
        }
        Method::HeavyBall => {
            let (low, high) = spectrum(false);
            choices.push(interval(low, high));
            Box::new(HeavyBall::best_for(low, high, length))
        }
        Method::Nesterov => {
            let (low, high) = spectrum(false);
            choices.push(interval(low, high));
            Box::new(match weight {
                Weight::Published => Nesterov::best_for(low, high, length),
                _ => Nesterov::with_restarts(high, length),
            })
        }
        Method::Chebyshev => {
            let (low, high) = spectrum(true);
            choices.push(format!(
                "interval of eigenvalues, over the column sums: [{low:.4e}, {high:.4e}]"
            ));
            // Rounding must not leave the largest one outside.
            let chebyshev = Chebyshev::new(low, high * (1.0 + 1e-9), length);
            Box::new(Scaled::new(normal.reciprocal_sums(), chebyshev))
        }
        Method::SaLspia => {
            Box::new(SaLspia::new(matrix, largest(operator.column_sums()), dimension))
        }
        Method::RandomColumns => Box::new(RandomColumns::new(normal, dimension, seed)),
        Method::RandomRows => Box::new(RandomRows::new(operator, data, seed)),
        Method::Extended => Box::new(Pia),
        Method::Cgls => gradients(Preconditioner::Identity),
        Method::Pcg => gradients(Preconditioner::Diagonal(normal.reciprocal_diagonal())),
    };
    Ok(ChosenRule { rule, name: method.as_str(), choices, smallest_eigenvalue })
}

fn interval(low: f64, high: f64) -> String {
    format!("interval of eigenvalues of the normal matrix: [{low:.4e}, {high:.4e}]")
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

/// An eigenvalue, over the column sums, below which the data leave a combination of control points
/// free.
const FREE: f64 = 1e-13;
/// Share of the column sums that is then added to the diagonal of the preconditioner. Rounding moves
/// what is free by the rounding of a double over this.
const SHARE: f64 = 1e-8;

/// The factors of the normal matrix, or of one close to it where it is singular.
pub(super) fn whole_band(
    normal: &NormalMatrix,
    choices: &mut Vec<String>,
) -> Result<Preconditioner, Error> {
    let factors = normal.matrix().factor(None).ok();
    if let Some(factors) = factors.filter(|factors| smallest_scaled(factors, normal) > FREE) {
        return Ok(Preconditioner::Factors(factors));
    }
    choices.push(
        "caution: the data leave control points free, or nearly so: these stay as near their start \
         as can be, in the measure of column sums"
            .into(),
    );
    Ok(Preconditioner::Factors(normal.shifted(SHARE).factor(None)?))
}

/// The smallest eigenvalue over the column sums, by a few steps of inverse iteration; 0 where numbers
/// run out.
fn smallest_scaled(factors: &Factorization, normal: &NormalMatrix) -> f64 {
    const STEPS: usize = 4;
    let (sums, stays) = (normal.column_sums(), normal.stays());
    // Rough, and without symmetry, so that no eigenvector is missed.
    let mut x: Vec<f64> = (0..sums.len())
        .map(|j| if j % 2 == 0 { 1.0 } else { -1.0 } + 0.37 * ((j * j % 11) as f64))
        .collect();
    let size = |x: &[f64]| -> f64 {
        let each = x.iter().zip(sums.iter().zip(stays));
        each.map(|(x, (c, stays))| if *stays { 0.0 } else { c * x * x }).sum::<f64>().sqrt()
    };
    let mut smallest = f64::INFINITY;
    for _ in 0..STEPS {
        let before = size(&x);
        if before == 0.0 {
            return 1.0;
        }
        for (x, (c, stays)) in x.iter_mut().zip(sums.iter().zip(stays)) {
            *x = if *stays { 0.0 } else { *x * c / before };
        }
        factors.solve_in_place(&mut x, 1);
        let now = size(&x);
        smallest = if now.is_finite() && now > 0.0 { f64::min(smallest, now.recip()) } else { 0.0 };
    }
    smallest
}

fn check_weight(method: Method, weight: Weight) -> Result<(), Error> {
    let takes_one = matches!(method, Method::Lspia | Method::ColumnSums | Method::Sor);
    match weight {
        Weight::Auto => Ok(()),
        Weight::Published => match method {
            Method::Lspia | Method::ColumnSums | Method::HeavyBall | Method::Nesterov => Ok(()),
            _ => Err(Error::Incompatible {
                what: "the published weight",
                with: "this method",
                why: "only lspia, column-sums, mlspia and nesterov have one",
            }),
        },
        Weight::Same(_) if !takes_one => Err(Error::Incompatible {
            what: "an iteration weight",
            with: "this method",
            why: "of least squares only lspia, column-sums and sor-lspia have one",
        }),
        Weight::Same(omega) => {
            let most = if method == Method::Lspia { f64::INFINITY } else { 2.0 };
            if omega > 0.0 && omega < most {
                return Ok(());
            }
            Err(Error::OutOfRange {
                what: "iteration weight".into(),
                value: omega,
                rule: "it must lie above 0, and below 2 for column-sums and sor-lspia",
            })
        }
    }
}
