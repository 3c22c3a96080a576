//! Geometric interpolation: the rule of PIA on an operator whose parameters follow the foot points,
//! until those must be given up; then preconditioned PIA at parameters that stay.

use super::method::{ChosenRule, check_weight};
use super::solve::{Solved, Task, solve};
use super::surface_method::smallest_rational_eigenvalue;
use super::{IterationWeight, KeptFootPoints, Method};
use crate::Error;
use crate::collocation::{
    CollocationMatrix, Factorization, NetLayout, NetWeights, smallest_eigenvalue_of,
};
use crate::iteration::update::{Both, Preconditioned, Rescaled};
use crate::iteration::{Observer, Step, UpdateRule};
use crate::knots::KnotVector;
use crate::parameters::Parameters;
use crate::projection::{
    FallBack, FootPointCollocation, SMALLEST_EIGENVALUE, SurfaceFootPointCollocation,
};
use crate::report::{FootPointReport, RunReport};

/// PIA while foot points move; once they are given up, steps with all of the matrix.
#[derive(Debug)]
struct CurveRule<'a> {
    operator: &'a FootPointCollocation,
    factors: Option<Factorization>,
}

impl UpdateRule for CurveRule<'_> {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        if !self.operator.is_fixed() {
            return;
        }
        if self.factors.is_none() {
            // A matrix that cannot be factored leaves plain PIA.
            self.factors = self.operator.factor().ok();
        }
        if let Some(factors) = &self.factors {
            factors.solve_in_place(vectors, step.dimension);
        }
    }
}

/// The same on a net.
#[derive(Debug)]
struct SurfaceRule<'a> {
    operator: &'a SurfaceFootPointCollocation<'a>,
    directions: [&'a dyn CollocationMatrix; 2],
    /// Weights of a rational surface that are no product of weights of the directions.
    rational: Option<&'a NetWeights>,
    finish: Option<Box<dyn UpdateRule + 'a>>,
}

impl UpdateRule for SurfaceRule<'_> {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        if !self.operator.is_fixed() {
            return;
        }
        let [u, v] = self.directions;
        if self.finish.is_none()
            && let (Ok(across), Ok(along)) =
                (Preconditioned::new(u, None), Preconditioned::new(v, None))
        {
            let both = Both::new(across, along, v.points());
            self.finish = Some(match self.rational {
                None => Box::new(both),
                Some(net) => Box::new(Rescaled::new(Box::new(both), net)),
            });
        }
        if let Some(rule) = &mut self.finish {
            rule.adjust(step, vectors);
        }
    }
}

/// The rule of a curve.
pub(super) fn curve_rule<'a>(
    operator: &'a FootPointCollocation,
    method: Method,
    weight: &IterationWeight,
) -> Result<ChosenRule<'a>, Error> {
    chosen(Box::new(CurveRule { operator, factors: None }), method, weight)
}

/// Parameters (u, v) of every point, row by row.
pub(super) type Pairs = Vec<[f64; 2]>;

/// What a surface needs beside its task.
#[derive(Debug, Clone, Copy)]
pub(super) struct Net<'a> {
    /// The operators at the parameters assigned.
    pub(super) directions: [&'a dyn CollocationMatrix; 2],
    pub(super) layout: NetLayout,
    pub(super) knots: [&'a KnotVector; 2],
    pub(super) parameters: [&'a Parameters; 2],
    /// Of the control points that move, row by row, for a rational surface.
    pub(super) rational_weights: Option<&'a [f64]>,
    /// The same where they are no product of weights of the directions.
    pub(super) rational: Option<&'a NetWeights>,
    /// The alpha of the theorem, if the caller gave one.
    pub(super) least_eigenvalue: Option<f64>,
}

/// Runs a surface. Also returns the pairs of parameters of its points, unless they ended at those of
/// rows and columns. The operator of `task` is that at the parameters assigned.
pub(super) fn solve_surface(
    task: &Task<'_>,
    method: Method,
    weight: &IterationWeight,
    net: Net<'_>,
    observer: &mut dyn Observer,
) -> Result<(Solved, Option<Pairs>), Error> {
    check_dimension(task.dimension, 3)?;
    let start = net.parameters.map(Parameters::values);
    let knots = net.knots.map(Clone::clone);
    let operator = SurfaceFootPointCollocation::new(
        task.operator,
        net.layout,
        knots,
        start,
        task.dimension,
        net.rational_weights,
    )?;
    let [u, v] = net.directions;
    let (least, note) = least_eigenvalue(net.least_eigenvalue, || match net.rational {
        Some(rational) => smallest_rational_eigenvalue(u, v, rational),
        None => Ok(smallest_eigenvalue_of(u)?.estimate * smallest_eigenvalue_of(v)?.estimate),
    })?;
    let operator = operator.with_least_eigenvalue(least);
    let global_start = matches!(method, Method::Geometric { global_start: true });
    let operator = if global_start { operator.with_global_start() } else { operator };
    let (directions, rational) = (net.directions, net.rational);
    let rule = SurfaceRule { operator: &operator, directions, rational, finish: None };
    let mut chosen = chosen(Box::new(rule), method, weight)?;
    chosen.choices.extend(note);
    let foot_points = || surface_account(&operator);
    let task = Task { operator: &operator, foot_points: Some(&foot_points), ..*task };
    let mut solved = solve(&task, &mut chosen, observer)?;
    drop(chosen);
    let columns = net.parameters[1].values().len();
    let account = surface_account(&operator);
    tell(&account, surface_sentences(&account.report, columns), &mut solved.run);
    Ok((solved, operator.parameters()))
}

fn chosen<'a>(
    rule: Box<dyn UpdateRule + 'a>,
    method: Method,
    weight: &IterationWeight,
) -> Result<ChosenRule<'a>, Error> {
    check_weight(method, weight, 0)?;
    let first = match method {
        Method::Geometric { global_start: true } => "the nearest of all at first",
        _ => "looked for from the parameters assigned",
    };
    let choices = vec![format!("foot points: {first}, then each from its last one")];
    Ok(ChosenRule { rule, name: "geometric", choices, smallest_eigenvalue: None })
}

/// Refuses points that lie on every curve, or surface, of their space.
pub(super) fn check_dimension(dimension: usize, least: usize) -> Result<(), Error> {
    if dimension >= least {
        return Ok(());
    }
    Err(Error::Incompatible {
        what: "geometric interpolation",
        with: "points of this dimension",
        why: "on a line every point meets the curve, and in a plane every point meets the surface, \
              wherever the control points are: curves need dimension 2, surfaces 3; of values over \
              parameters, make the parameters coordinates",
    })
}

/// How the foot points of a curve have fared up to now. Parameters rise: those of a closed curve go on
/// past the seam.
pub(super) fn curve_account(operator: &FootPointCollocation) -> KeptFootPoints {
    let (largest_move, fall_back) = (operator.largest_move(), operator.fall_back());
    KeptFootPoints {
        parameters: Some(operator.rising_parameters()),
        report: FootPointReport { largest_move, fall_back },
        smallest_eigenvalue: operator.smallest_eigenvalue(),
    }
}

fn surface_account(operator: &SurfaceFootPointCollocation<'_>) -> KeptFootPoints {
    let (largest_move, fall_back) = (operator.largest_move(), operator.fall_back());
    KeptFootPoints {
        parameters: operator.parameters().map(|pairs| pairs.into_flattened()),
        report: FootPointReport { largest_move, fall_back },
        smallest_eigenvalue: operator.smallest_eigenvalue(),
    }
}

/// What a report says of the foot points of a curve.
pub(super) fn curve_sentences(report: &FootPointReport) -> Vec<String> {
    let name = |j: usize| format!("number {}", j + 1);
    sentences(report, "those of the last good foot points", name)
}

/// The same of a surface through rows of so many points.
pub(super) fn surface_sentences(report: &FootPointReport, columns: usize) -> Vec<String> {
    sentences(report, "those assigned to rows and columns", |point| {
        format!("in row {}, column {}", point / columns + 1, point % columns + 1)
    })
}

/// `fixed`: the parameters it falls back to; `name` names a data point by its index.
fn sentences(report: &FootPointReport, fixed: &str, name: impl Fn(usize) -> String) -> Vec<String> {
    let mut list = Vec::new();
    if let Some(FallBack { iteration, reason }) = report.fall_back {
        let fixed = if iteration == 0 { "those assigned" } else { fixed };
        list.push(format!(
            "fell back at iteration {iteration} to fixed parameters, {fixed}: {}",
            reason.sentence(name)
        ));
        list.push(
            "method from there: preconditioned PIA with the whole band, which reaches the \
             interpolant at these parameters in a few steps"
                .into(),
        );
    }
    if report.largest_move > 0.0 {
        list.push(format!("parameters: moved by up to {:.4e}", report.largest_move));
    }
    list
}

/// Puts the account into the report of a run.
pub(super) fn tell(account: &KeptFootPoints, mut sentences: Vec<String>, run: &mut RunReport) {
    run.choices.append(&mut sentences);
    run.smallest_eigenvalue = account.smallest_eigenvalue;
    run.foot_points = Some(account.report);
}

/// The share of the smallest eigenvalue at the parameters assigned that must be left of it.
const LEFT_OF_EIGENVALUE: f64 = 0.1;

/// The alpha of the convergence theorem: what the caller gave, or what suits the `start`, the
/// smallest eigenvalue at the parameters assigned. Also the sentence on it, where it is not the usual.
pub(super) fn least_eigenvalue(
    given: Option<f64>,
    start: impl FnOnce() -> Result<f64, Error>,
) -> Result<(f64, Option<String>), Error> {
    if let Some(alpha) = given {
        if alpha > 0.0 && alpha < 1.0 {
            return Ok((alpha, None));
        }
        return Err(Error::OutOfRange {
            what: "least eigenvalue of geometric interpolation".into(),
            value: alpha,
            rule: "it must lie between 0 and 1, as the eigenvalues do",
        });
    }
    let start = start()?;
    let share = LEFT_OF_EIGENVALUE * start;
    // A matrix that is singular to doubles has nothing to be a share of.
    if !(share > f64::EPSILON && share < SMALLEST_EIGENVALUE) {
        return Ok((SMALLEST_EIGENVALUE, None));
    }
    Ok((
        share,
        Some(format!(
            "least eigenvalue: {share:.1e}, a tenth of that at the parameters assigned, {start:.1e}, \
             which is small: expect slow steps"
        )),
    ))
}
