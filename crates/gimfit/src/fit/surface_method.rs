//! From a named method to a rule on a grid of points.

use super::method::{ChosenRule, anderson, check_weight, choose, weighted, whole};
use super::{IterationWeight, Method};
use crate::Error;
use crate::collocation::{CollocationMatrix, largest_jacobi_eigenvalue, smallest_eigenvalue_of};
use crate::iteration::UpdateRule;
use crate::iteration::update::{
    Across, Along, Both, Chebyshev, GaussSeidel, Jacobi, NetPreconditioned, Pia, Staged,
};

/// The operators of both directions.
#[derive(Debug, Clone, Copy)]
pub(super) struct Directions<'a> {
    pub(super) u: &'a dyn CollocationMatrix,
    pub(super) v: &'a dyn CollocationMatrix,
}

impl Directions<'_> {
    fn points(&self) -> usize {
        self.u.points() * self.v.points()
    }
}

/// Products of eigenvalues beyond this diverge; a hundredth above 2, which the estimates may miss.
const JACOBI_DIVERGES: f64 = 2.02;

/// Prepares a rule that moves the whole net at once.
pub(super) fn choose_both<'a>(
    method: Method,
    weight: &IterationWeight,
    directions: Directions<'a>,
    dimension: usize,
    gradual: usize,
) -> Result<ChosenRule<'a>, Error> {
    check_weight(method, weight, directions.points())?;
    let Directions { u, v } = directions;
    let columns = v.points();
    let mut choices = Vec::new();
    let mut eigenvalue = None;
    let mut smallest = || -> Result<f64, Error> {
        let (u, v) = (smallest_eigenvalue_of(u)?, smallest_eigenvalue_of(v)?);
        let tight = u.estimate <= 1.5 * u.lower && v.estimate <= 1.5 * v.lower;
        eigenvalue = tight.then_some(u.estimate * v.estimate);
        // Eigenvalues of a Kronecker product are products.
        Ok(u.for_weights() * v.for_weights())
    };
    let banded = |q: Option<usize>| NetPreconditioned::new(u, v, q);
    let (name, rule): (_, Box<dyn UpdateRule + 'a>) = match method {
        Method::Auto if gradual > 0 => {
            choices.push(format!(
                "method: plain PIA for {gradual} steps, because fits of the way are kept, then \
                 preconditioned PIA in both directions"
            ));
            ("auto", Box::new(Staged::new(Pia, gradual, banded(None)?)))
        }
        Method::Auto => {
            choices.push(format!("method: {}", whole(u, " in both directions")));
            ("preconditioned", Box::new(banded(None)?))
        }
        Method::Pia => ("pia", Box::new(Pia)),
        Method::Weighted => ("weighted", weighted(weight, &[u, v], &mut smallest, &mut choices)?),
        Method::Jacobi => {
            let largest = [u, v].map(largest_jacobi_eigenvalue);
            if largest[0] * largest[1] > JACOBI_DIVERGES {
                return Err(Error::Incompatible {
                    what: "jacobi",
                    with: "this net as a whole",
                    why: "its largest eigenvalue, the product of those of both directions, passes 2 \
                          (2.25 for bicubics), so that the run would diverge; run one direction \
                          after the other, or use gauss-seidel",
                });
            }
            choices.push(format!(
                "jacobi: largest eigenvalue about {:.3} in u times {:.3} in v, below 2: it converges",
                largest[0], largest[1]
            ));
            ("jacobi", Box::new(Both::new(Jacobi::new(u), Jacobi::new(v), columns)))
        }
        Method::GaussSeidel => {
            ("gauss-seidel", Box::new(Both::new(GaussSeidel::new(u), GaussSeidel::new(v), columns)))
        }
        Method::Sor => {
            return Err(Error::Incompatible {
                what: "sor",
                with: "a whole net at once",
                why: "over-relaxation is known for one direction only; run per direction, or use \
                      gauss-seidel",
            });
        }
        Method::Chebyshev => {
            let least = smallest()?;
            choices.push(format!("interval of eigenvalues: [{least:.4e}, 1]"));
            ("chebyshev", Box::new(Chebyshev::new(least, 1.0, directions.points() * dimension)))
        }
        Method::Anderson { memory } => (
            "anderson",
            Box::new(anderson(
                memory,
                (directions.points(), u.is_dense()),
                dimension,
                &mut choices,
            )?),
        ),
        Method::Preconditioned { half_bandwidth } => {
            ("preconditioned", Box::new(banded(half_bandwidth)?))
        }
    };
    Ok(ChosenRule { rule, name, choices, smallest_eigenvalue: eigenvalue })
}

/// Prepares a rule that takes each column of the grid for a curve.
pub(super) fn choose_across<'a>(
    method: Method,
    weight: &IterationWeight,
    directions: Directions<'a>,
    dimension: usize,
) -> Result<ChosenRule<'a>, Error> {
    let columns = directions.v.points();
    let mut chosen = choose(method, weight, directions.u, columns * dimension, 0)?;
    chosen.rule = Box::new(Across::new(chosen.rule, columns));
    Ok(chosen)
}

/// Prepares a rule that takes each row of the grid for a curve.
pub(super) fn choose_along<'a>(
    method: Method,
    weight: &IterationWeight,
    directions: Directions<'a>,
    dimension: usize,
) -> Result<ChosenRule<'a>, Error> {
    let rows = directions.u.points();
    let mut chosen = choose(method, weight, directions.v, rows * dimension, 0)?;
    // A rule that scales and adds whole arrays serves all rows at once, and may remember them.
    let whole = match method {
        Method::Pia | Method::Chebyshev | Method::Anderson { .. } => true,
        Method::Weighted => !matches!(weight, IterationWeight::PerPoint(_)),
        _ => false,
    };
    if !whole {
        chosen.rule = Box::new(Along::new(chosen.rule, directions.v.points()));
    }
    Ok(chosen)
}
