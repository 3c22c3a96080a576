//! Geometric interpolation: the rule of PIA on an operator whose parameters follow the foot points,
//! until those must be given up; then preconditioned PIA at parameters that stay.

use super::method::{ChosenRule, check_weight};
use super::solve::{Solved, Task, solve};
use super::{IterationWeight, Method};
use crate::Error;
use crate::collocation::{CollocationMatrix, Factorization, NetLayout, NetWeights};
use crate::iteration::update::{Both, Preconditioned, Rescaled};
use crate::iteration::{Observer, Step, UpdateRule};
use crate::knots::KnotVector;
use crate::parameters::Parameters;
use crate::projection::{FallBack, FootPointCollocation, SurfaceFootPointCollocation};
use crate::report::FootPointReport;

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
    let global_start = matches!(method, Method::Geometric { global_start: true });
    let operator = if global_start { operator.with_global_start() } else { operator };
    let (directions, rational) = (net.directions, net.rational);
    let rule = SurfaceRule { operator: &operator, directions, rational, finish: None };
    let mut chosen = chosen(Box::new(rule), method, weight)?;
    let mut solved = solve(&Task { operator: &operator, ..*task }, &mut chosen, observer)?;
    drop(chosen);
    let columns = net.parameters[1].values().len();
    Account::of_surface(&operator).tell(&mut solved, |point| {
        format!("in row {}, column {}", point / columns + 1, point % columns + 1)
    });
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

/// How foot points fared.
pub(super) struct Account {
    largest_move: f64,
    smallest_eigenvalue: Option<f64>,
    fall_back: Option<FallBack>,
    /// The parameters it falls back to.
    fixed: &'static str,
}

impl Account {
    pub(super) fn of_curve(operator: &FootPointCollocation) -> Self {
        Self {
            largest_move: operator.largest_move(),
            smallest_eigenvalue: operator.smallest_eigenvalue(),
            fall_back: operator.fall_back(),
            fixed: "those of the last good foot points",
        }
    }

    fn of_surface(operator: &SurfaceFootPointCollocation<'_>) -> Self {
        Self {
            largest_move: operator.largest_move(),
            smallest_eigenvalue: operator.smallest_eigenvalue(),
            fall_back: operator.fall_back(),
            fixed: "those assigned to rows and columns",
        }
    }

    /// Puts the account into the report of a run, where `name` names a data point by its index.
    pub(super) fn tell(self, solved: &mut Solved, name: impl Fn(usize) -> String) {
        let Self { largest_move, smallest_eigenvalue, fall_back, fixed } = self;
        let choices = &mut solved.run.choices;
        if let Some(FallBack { iteration, reason }) = fall_back {
            let fixed = if iteration == 0 { "those assigned" } else { fixed };
            choices.push(format!(
                "fell back at iteration {iteration} to fixed parameters, {fixed}: {}",
                reason.sentence(name)
            ));
            choices.push(
                "method from there: preconditioned PIA with the whole band, which reaches the \
                 interpolant at these parameters in a few steps"
                    .into(),
            );
        }
        if largest_move > 0.0 {
            choices.push(format!("parameters: moved by up to {largest_move:.4e}"));
        }
        solved.run.smallest_eigenvalue = smallest_eigenvalue;
        solved.run.foot_points = Some(FootPointReport { largest_move, fall_back });
    }
}
