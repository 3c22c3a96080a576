//! From a named method to a rule, with what had to be found out on the way.

use super::{IterationWeight, Method};
use crate::Error;
use crate::collocation::{
    CollocationMatrix, Eigenvalue, all_eigenvalues, best_weight, gauss_seidel_rate, lemma2_weight,
    smallest_eigenvalue_of,
};
use crate::diagnosis::dominance;
use crate::iteration::UpdateRule;
use crate::iteration::update::{
    Adaptive, AdaptiveRows, Anderson, Chebyshev, GaussSeidel, Jacobi, PerPoint, Pia,
    Preconditioned, Sor, Staged, Weighted,
};

/// A rule ready to run.
pub(super) struct ChosenRule<'a> {
    pub(super) rule: Box<dyn UpdateRule + 'a>,
    pub(super) name: &'static str,
    pub(super) choices: Vec<String>,
    pub(super) smallest_eigenvalue: Option<f64>,
}

/// Prepares the rule of a method. `gradual` steps of plain PIA come first where the method is left
/// to us and fits of the way there are wanted.
pub(super) fn choose<'a>(
    method: Method,
    weight: &IterationWeight,
    operator: &'a dyn CollocationMatrix,
    dimension: usize,
    gradual: usize,
) -> Result<ChosenRule<'a>, Error> {
    check_weight(method, weight, operator.points())?;
    let mut choices = Vec::from_iter(positivity_caution(operator, method, ""));
    let mut eigenvalue = None;
    let mut smallest = || -> Result<f64, Error> {
        let bounds = smallest_eigenvalue_of(operator)?;
        // Where the enclosure did not close, the estimate is not worth telling.
        eigenvalue = (bounds.estimate <= 1.5 * bounds.lower).then_some(bounds.estimate);
        Ok(bounds.for_weights())
    };
    let (name, rule): (_, Box<dyn UpdateRule + 'a>) = match method {
        Method::Auto => {
            let whole_band = Preconditioned::new(operator, None)?;
            if gradual > 0 {
                choices.push(format!(
                    "method: plain PIA up to step {gradual}, because fits of the way are kept, then \
                     preconditioned PIA"
                ));
                ("auto", Box::new(Staged::new(Pia, gradual, whole_band)))
            } else {
                choices.push(format!("method: {}", whole(operator, "")));
                ("preconditioned", Box::new(whole_band))
            }
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
                with: "this recipe",
                why: "it is for curves of B-splines, and for grids in both directions at once; use \
                      another method",
            });
        }
        Method::Weighted => {
            ("weighted", weighted(weight, &[operator], &mut smallest, &mut choices)?)
        }
        Method::Jacobi => ("jacobi", Box::new(Jacobi::new(operator))),
        Method::GaussSeidel => ("gauss-seidel", Box::new(GaussSeidel::new(operator))),
        Method::Sor => {
            let omega = match weight {
                IterationWeight::Same(omega) => *omega,
                _ => {
                    let omega = Sor::best_for(gauss_seidel_rate(operator));
                    choices.push(format!("weight: {omega:.6}, from the rate of Gauss-Seidel"));
                    omega
                }
            };
            ("sor", Box::new(Sor::new(operator, omega)))
        }
        Method::Chebyshev => {
            let least = smallest()?;
            choices.push(format!("interval of eigenvalues: [{least:.4e}, 1]"));
            let length = operator.points() * dimension;
            ("chebyshev", Box::new(Chebyshev::new(least, 1.0, length)))
        }
        Method::Anderson { memory } => (
            "anderson",
            Box::new(anderson(
                memory,
                (operator.points(), operator.is_dense()),
                dimension,
                &mut choices,
            )?),
        ),
        Method::Preconditioned { half_bandwidth } => {
            ("preconditioned", Box::new(Preconditioned::new(operator, half_bandwidth)?))
        }
        Method::Geometric { .. } => return Err(NO_FOOT_POINTS),
    };
    Ok(ChosenRule { rule, name, choices, smallest_eigenvalue: eigenvalue })
}

/// The rule of adaptive PIA, which needs to know when a point is done.
pub(super) fn choose_adaptive<'a>(
    rows: AdaptiveRows<'a>,
    weight: &IterationWeight,
    points: usize,
    residual: f64,
) -> Result<ChosenRule<'a>, Error> {
    check_weight(Method::Adaptive, weight, points)?;
    if residual <= 0.0 {
        return Err(Error::Incompatible {
            what: "adaptive",
            with: "a residual of 0",
            why: "points are frozen once they are within the residual; give one above 0",
        });
    }
    let caution = |matrix, place| positivity_caution(matrix, Method::Adaptive, place);
    let choices = match rows {
        AdaptiveRows::Curve(matrix) => Vec::from_iter(caution(matrix, "")),
        AdaptiveRows::Grid([u, v]) => {
            caution(u, " in u").into_iter().chain(caution(v, " in v")).collect()
        }
    };
    let rule = Box::new(Adaptive::new(rows, residual));
    Ok(ChosenRule { rule, name: "adaptive", choices, smallest_eigenvalue: None })
}

/// What a method rests on and the matrix of a closed curve does not offer: in general it has a negative
/// minor, and where the diagonal does not dominate the rows either, nothing proves that the method
/// converges. `place` is empty, or names the direction. Bases without a band have their own.
pub(super) fn positivity_caution(
    operator: &dyn CollocationMatrix,
    method: Method,
    place: &str,
) -> Option<String> {
    let rests = matches!(
        method,
        Method::Pia
            | Method::Local
            | Method::Adaptive
            | Method::Weighted
            | Method::GaussSeidel
            | Method::Sor
            | Method::Chebyshev
            | Method::Preconditioned { half_bandwidth: Some(_) }
    );
    if !rests || operator.is_dense() || operator.is_totally_positive() {
        return None;
    }
    let weak = (0..operator.points()).filter(|&j| operator.diagonal(j) <= 0.5).count();
    (weak > 0).then(|| {
        format!(
            "caution: {}, so that the collocation matrix need not be totally positive, and \
             its diagonal does not dominate at {weak} of {} points: the convergence of this method is \
             not proved; auto and anderson do without, and gimfit diagnose tells",
            if place.is_empty() { "the curve is closed".into() } else { format!("closed{place}") },
            operator.points()
        )
    })
}

/// Geometric interpolation is no rule for a matrix that stays; the recipes that know it run it on an
/// operator of its own.
pub(super) const NO_FOOT_POINTS: Error = Error::Incompatible {
    what: "geometric interpolation",
    with: "this kind of fit",
    why: "foot points move on whole B-spline curves, and on surfaces in both directions at once; use \
          pia or auto",
};

/// The rule of weighted PIA on the Kronecker product of operators; `smallest` finds the smallest
/// eigenvalue where the weight is left to us.
pub(super) fn weighted(
    weight: &IterationWeight,
    operators: &[&dyn CollocationMatrix],
    smallest: impl FnOnce() -> Result<f64, Error>,
    choices: &mut Vec<String>,
) -> Result<Box<dyn UpdateRule>, Error> {
    Ok(match weight {
        IterationWeight::PerPoint(omega) => Box::new(PerPoint::new(omega.clone())),
        IterationWeight::Same(omega) => Box::new(Weighted::new(*omega)),
        IterationWeight::Lemma2 => Box::new(Weighted::new(generalised(operators, choices)?)),
        IterationWeight::Auto => {
            let positive = operators.iter().all(|operator| operator.is_totally_positive());
            let few = operators.iter().all(|operator| operator.points() <= FEW_POINTS);
            let all = if few && !positive { spectrum(operators)? } else { None };
            let omega = match all.as_deref().and_then(best_weight) {
                Some((omega, rate)) => {
                    choices.push(format!(
                        "weight: {omega:.6}, best for all eigenvalues: a step leaves {rate:.4}"
                    ));
                    omega
                }
                None => {
                    let omega = Weighted::best_for(smallest()?);
                    choices.push(format!("weight: {omega:.6}, best for the smallest eigenvalue"));
                    omega
                }
            };
            Box::new(Weighted::new(omega))
        }
    })
}

/// What `auto` is, and why. `place` is empty, or names the directions.
pub(super) fn whole(operator: &dyn CollocationMatrix, place: &str) -> String {
    let (what, where_to) = if operator.is_dense() {
        ("matrix", "unless the matrix is close to singular")
    } else {
        ("band", "on any spacing")
    };
    format!(
        "preconditioned PIA with the whole {what}{place}, which reaches rounding level in a few \
         steps {where_to}"
    )
}

/// Anderson acceleration of PIA on so many points.
pub(super) fn anderson(
    memory: Option<usize>,
    (points, dense): (usize, bool),
    dimension: usize,
    choices: &mut Vec<String>,
) -> Result<Anderson, Error> {
    let steps = memory.unwrap_or_else(|| {
        let steps = Anderson::default_memory(points, dense);
        choices.push(format!("memory: {steps} steps"));
        steps
    });
    if !(1..=MOST_MEMORY).contains(&steps) {
        return Err(Error::OutOfRange {
            what: "memory of anderson".into(),
            value: steps as f64,
            rule: "it must lie between 1 and 1000 steps",
        });
    }
    Ok(Anderson::new(steps, points * dimension))
}

/// Most steps that Anderson acceleration remembers.
const MOST_MEMORY: usize = 1000;

/// Points up to which the best weight is worth all eigenvalues.
const FEW_POINTS: usize = 64;
/// Points up to which all eigenvalues are found where they are asked for.
const MOST_POINTS: usize = 512;

/// The weight of Lemma 2.
fn generalised(
    operators: &[&dyn CollocationMatrix],
    choices: &mut Vec<String>,
) -> Result<f64, Error> {
    let refused = |why| {
        Err(Error::Incompatible {
            what: "the weight of Lemma 2",
            with: "these points and this basis",
            why,
        })
    };
    if operators.iter().all(|operator| operator.is_totally_positive()) {
        choices.push("weight: 1, by Lemma 2: all eigenvalues lie in (0, 1]".into());
        return Ok(1.0);
    }
    if operators.iter().all(|operator| operator.points() <= MOST_POINTS) {
        let all = spectrum(operators)?.unwrap_or_default();
        let Some(omega) = lemma2_weight(&all).filter(|_| !all.is_empty()) else {
            return refused(
                "an eigenvalue has a real part that is not positive, so no weight converges; use \
                 the method auto",
            );
        };
        choices.push(format!("weight: {omega:.6}, by Lemma 2, from all eigenvalues"));
        return Ok(omega);
    }
    // Gershgorin's discs, scaled, lie within distance 1 from 1, as rows sum to 1.
    if operators.iter().all(|operator| {
        operator.is_totally_positive()
            || (operators.len() == 1 && dominance(*operator).is_generalised())
    }) {
        choices.push("weight: 1, by Lemma 2: the diagonal dominates (property GDD)".into());
        return Ok(1.0);
    }
    refused(
        "beyond 512 points eigenvalues are not sought, and the diagonal does not dominate; use the \
         weight auto, or the method auto",
    )
}

/// All eigenvalues of a Kronecker product; `None` if they cannot be found.
fn spectrum(operators: &[&dyn CollocationMatrix]) -> Result<Option<Vec<Eigenvalue>>, Error> {
    let mut all = vec![Eigenvalue { re: 1.0, im: 0.0 }];
    for operator in operators {
        let Some(own) = all_eigenvalues(*operator)? else { return Ok(None) };
        all = all.iter().flat_map(|a| own.iter().map(|b| a.times(*b))).collect();
    }
    Ok(Some(all))
}

pub(super) fn check_weight(
    method: Method,
    weight: &IterationWeight,
    points: usize,
) -> Result<(), Error> {
    let (single, per_point) = match method {
        Method::Weighted => (true, true),
        Method::Sor => (true, false),
        _ => (false, false),
    };
    let in_range = |omega: f64| omega > 0.0 && omega < 2.0;
    let out_of_range = |what: String, value| {
        Err(Error::OutOfRange {
            what,
            value,
            rule: "weights must lie between 0 and 2, where the iteration converges",
        })
    };
    match weight {
        IterationWeight::Auto => Ok(()),
        IterationWeight::Same(_) if !single => Err(Error::Incompatible {
            what: "an iteration weight",
            with: "this method",
            why: "only weighted and sor have one",
        }),
        IterationWeight::Lemma2 if per_point => Ok(()),
        IterationWeight::Lemma2 => Err(Error::Incompatible {
            what: "the weight of Lemma 2",
            with: "this method",
            why: "it is one of weighted",
        }),
        IterationWeight::Same(omega) if in_range(*omega) => Ok(()),
        IterationWeight::Same(omega) => out_of_range("iteration weight".into(), *omega),
        IterationWeight::PerPoint(_) if !per_point => Err(Error::Incompatible {
            what: "a weight per point",
            with: "this method",
            why: "only weighted takes weights per point",
        }),
        IterationWeight::PerPoint(list) if list.len() != points => Err(Error::WrongCount {
            what: "iteration weights",
            given: list.len(),
            expected: points,
            why: "one per data point",
        }),
        IterationWeight::PerPoint(list) => match list.iter().position(|&omega| !in_range(omega)) {
            Some(j) => out_of_range(format!("iteration weight {j}"), list[j]),
            None => Ok(()),
        },
    }
}
