//! From a named method to a rule on a grid of points.

use super::method::{
    ChosenRule, NO_FOOT_POINTS, anderson, check_weight, choose, positivity_caution, weighted, whole,
};
use super::{IterationWeight, Method};
use crate::Error;
use crate::collocation::{
    CollocationMatrix, NetWeights, largest_jacobi_eigenvalue, smallest_eigenvalue_of,
};
use crate::iteration::update::{
    Across, Along, Both, Chebyshev, GaussSeidel, Jacobi, NetPreconditioned, Pia, Rescaled, Staged,
};
use crate::iteration::{Step, UpdateRule};

/// The operators of both directions.
#[derive(Debug, Clone, Copy)]
pub(super) struct Directions<'a> {
    pub(super) u: &'a dyn CollocationMatrix,
    pub(super) v: &'a dyn CollocationMatrix,
    /// Weights of a rational surface that are no product of weights of the directions.
    pub(super) rational: Option<&'a NetWeights>,
}

impl Directions<'_> {
    fn points(&self) -> usize {
        self.u.points() * self.v.points()
    }
}

/// Products of eigenvalues beyond this diverge; a hundredth above 2, which the estimates may miss.
pub(super) const JACOBI_DIVERGES: f64 = 2.02;

/// Prepares a rule that moves the whole net at once.
pub(super) fn choose_both<'a>(
    method: Method,
    weight: &IterationWeight,
    directions: Directions<'a>,
    dimension: usize,
    gradual: usize,
) -> Result<ChosenRule<'a>, Error> {
    check_weight(method, weight, directions.points())?;
    let Directions { u, v, rational } = directions;
    let columns = v.points();
    let mut choices = Vec::from_iter(positivity_caution(u, method, " in u"));
    choices.extend(positivity_caution(v, method, " in v"));
    let mut eigenvalue = None;
    let mut smallest = || -> Result<f64, Error> {
        if let Some(net) = rational {
            return smallest_rational_eigenvalue(u, v, net);
        }
        let (u, v) = (smallest_eigenvalue_of(u)?, smallest_eigenvalue_of(v)?);
        let tight = u.estimate <= 1.5 * u.lower && v.estimate <= 1.5 * v.lower;
        eigenvalue = tight.then_some(u.estimate * v.estimate);
        // Eigenvalues of a Kronecker product are products.
        Ok(u.for_weights() * v.for_weights())
    };
    // The matrix of a rational surface is scaled from both sides; so are its parts.
    let scaled = |rule: Box<dyn UpdateRule + 'a>| -> Box<dyn UpdateRule + 'a> {
        match rational {
            None => rule,
            Some(net) => Box::new(Rescaled::new(rule, net)),
        }
    };
    let banded = |q: Option<usize>| -> Result<_, Error> {
        Ok(scaled(Box::new(NetPreconditioned::new(u, v, q)?)))
    };
    if rational.is_some() && *weight == IterationWeight::Lemma2 {
        return Err(Error::Incompatible {
            what: "the weight of lemma 2",
            with: "rational weights that are no product",
            why: "it is told from the matrices of the directions; use auto or a number",
        });
    }
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
            ("preconditioned", banded(None)?)
        }
        Method::Pia => ("pia", Box::new(Pia)),
        Method::Local => {
            return Err(Error::Incompatible {
                what: "local",
                with: "this recipe",
                why: "points are chosen for fits of B-splines only; use another method",
            });
        }
        Method::Adaptive => {
            return Err(Error::Incompatible {
                what: "adaptive",
                with: "no residual",
                why: "it needs the residual at which a point is done; use another method",
            });
        }
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
            ("jacobi", scaled(Box::new(Both::new(Jacobi::new(u), Jacobi::new(v), columns))))
        }
        Method::GaussSeidel => {
            let both = Both::new(GaussSeidel::new(u), GaussSeidel::new(v), columns);
            ("gauss-seidel", scaled(Box::new(both)))
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
        Method::Preconditioned { half_bandwidth } => ("preconditioned", banded(half_bandwidth)?),
        Method::Geometric { .. } => return Err(NO_FOOT_POINTS),
    };
    Ok(ChosenRule { rule, name, choices, smallest_eigenvalue: eigenvalue })
}

/// A safe lower estimate of the smallest eigenvalue of a matrix whose inverse is at hand, with signs
/// like a chessboard as inverses of totally positive matrices have: powers of the inverse without its
/// signs, between whose bounds the largest eigenvalue lies (Collatz 1942).
pub(super) fn smallest_rational_eigenvalue(
    u: &dyn CollocationMatrix,
    v: &dyn CollocationMatrix,
    net: &NetWeights,
) -> Result<f64, Error> {
    const MOST: usize = 200;
    let mut inverse = Rescaled::new(NetPreconditioned::new(u, v, None)?, net);
    let (count, columns) = (net.sums().len(), v.points());
    let sign = |k: usize| if (k / columns + k % columns).is_multiple_of(2) { 1.0 } else { -1.0 };
    let still = vec![0.0; count];
    let mut x = vec![1.0; count];
    let mut y = x.clone();
    let mut bounds = (0.0, f64::INFINITY);
    for iteration in 0..MOST {
        y.iter_mut().zip(&x).enumerate().for_each(|(k, (y, x))| *y = sign(k) * x);
        inverse.adjust(Step { iteration, control: &still, dimension: 1 }, &mut y);
        y.iter_mut().enumerate().for_each(|(k, y)| *y = (sign(k) * *y).abs());
        let ratios = y.iter().zip(&x).map(|(y, x)| y / x);
        bounds = ratios.fold((f64::INFINITY, 0.0), |(a, b), r| (r.min(a), f64::max(b, r)));
        let largest = y.iter().copied().fold(0.0, f64::max);
        if !(largest > 0.0 && largest.is_finite()) {
            return Err(Error::LeavesDoubles);
        }
        // No entry vanishes, so that no ratio does.
        x.iter_mut().zip(&y).for_each(|(x, y)| *x = (y / largest).max(1e-12));
        if bounds.1 <= 1.01 * bounds.0 {
            break;
        }
    }
    let (lower, middle) = (1.0 / bounds.1, 2.0 / (bounds.0 + bounds.1));
    Ok(lower.max(0.5 * middle).min(1.0))
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
