//! The same for a grid of points: each direction by itself, and both at once.

use super::method::ChosenRule;
use super::net::tensor;
use super::prepare::check_extent;
use super::rational::{fitted_weights, separate};
use super::solve::Size;
use super::surface::{direction, open_up};
use super::surface_method::{
    Directions, choose_across, choose_along, choose_both, smallest_rational_eigenvalue,
};
use super::{BlendingSurfaceOptions, IterationWeight, Method, SurfaceOptions, blending_surface};
use crate::Error;
use crate::basis::BlendingBasis;
use crate::collocation::{AcrossCollocation, AlongCollocation, CollocationOperator, NetWeights};
use crate::diagnosis::{
    Diagnosis, Forecast, Spacing, Start, at_once, diagnose, product_weights, rehearse,
    steps_at_rate,
};
use crate::iteration::{ROUNDING, Step, UpdateRule};
use crate::parameters::Parameters;
use crate::points::{Extent, GridView};

/// The diagnosis of a surface before it is fitted. Pairs hold direction u (rows), then direction v
/// (columns); positions in a direction count its lines of points.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceDiagnosis {
    /// What the matrix of each direction says; with rational weights that are no product of weights
    /// of rows and of columns, without them. Steps are those of that direction alone, as a run of one
    /// direction after the other takes them.
    pub directions: [Diagnosis; 2],
    /// Forecasts for a net that moves as a whole; sor is known for one direction only.
    pub at_once: Vec<Forecast>,
    /// The weight of Lemma 2 for the net as a whole; `None` where no weight converges, or it is not
    /// known.
    pub lemma2_weight: Option<f64>,
    /// Condition of the net as a whole in the maximum norm, the product of those of the directions;
    /// with rational weights that are no product, of their bases without them.
    pub condition: f64,
    /// Rows and columns of points fitted.
    pub points: [usize; 2],
    /// Degrees.
    pub degrees: [usize; 2],
    /// The residual that forecasts aim at, in the unit of the data.
    pub residual_target: f64,
    /// Largest residual before the first step.
    pub first_residual: f64,
    /// The residual that rounding leaves, as in [`CurveDiagnosis::rounding`](super::CurveDiagnosis).
    pub rounding: f64,
    /// What was chosen for the caller, and why.
    pub choices: Vec<String>,
}

/// Tells how a surface fit with these options would go, without running it. The method of the options
/// is left aside: all are forecast.
///
/// # Errors
/// As [`fit_surface`](super::fit_surface).
pub fn diagnose_surface(
    grid: GridView<'_>,
    options: &SurfaceOptions,
) -> Result<SurfaceDiagnosis, Error> {
    let needed = options.degrees.map(|p| p.saturating_add(1));
    if grid.points().is_empty() {
        return Err(Error::NoPoints { needed: needed[0].saturating_mul(needed[1]) });
    }
    let size = Size::of(Extent::of(grid.points())?);
    let mut choices = Vec::new();
    let (shape, data) =
        open_up(grid, &size, options.closed, &options.parameterizations, &mut choices);
    let dimension = grid.dimension();
    let data = size.scale.apply(&data);
    let view = GridView::new(shape, dimension, &data)?;
    let mut u = direction(view, 0, options, &mut choices)?;
    let mut v = direction(view, 1, options, &mut choices)?;
    let given = grid.shape();
    let weights = fitted_weights(
        options.rational_weights.as_deref(),
        given[0] * given[1],
        shape[0] * shape[1],
        |j| j / shape[1] * given[1] + j % shape[1],
    )?;
    let parts = weights.as_deref().map(|weights| separate(weights, shape[1]));
    if let Some(Some([of_rows, of_columns])) = &parts {
        choices.push("rational weights: a product of weights of rows and of columns".into());
        u.built.operator.weigh(of_rows);
        v.built.operator.weigh(of_columns);
    }
    let net = weights
        .filter(|_| parts == Some(None))
        .map(|weights| NetWeights::new(&u.built.operator, &v.built.operator, weights));
    if net.is_some() {
        choices.push(
            "rational weights: no product of weights of rows and of columns, so that what is told of \
             u and of v leaves them aside"
                .into(),
        );
    }
    let task = Task {
        view,
        size: &size,
        directions: Directions {
            u: &u.built.operator,
            v: &v.built.operator,
            rational: net.as_ref(),
        },
        parameters: [&u.parameters, &v.parameters],
        degrees: options.degrees,
        residual: options.residual,
    };
    task.diagnose(choices)
}

/// As [`diagnose_surface`], over a blending basis in each direction.
///
/// # Errors
/// As [`fit_blending_surface`](super::fit_blending_surface).
pub fn diagnose_blending_surface(
    grid: GridView<'_>,
    bases: [&dyn BlendingBasis; 2],
    options: &BlendingSurfaceOptions,
) -> Result<SurfaceDiagnosis, Error> {
    if grid.points().is_empty() {
        return Err(Error::NoPoints { needed: bases[0].functions() * bases[1].functions() });
    }
    let size = Size::of(Extent::of(grid.points())?);
    check_extent(&size.extent)?;
    let data = size.scale.apply(grid.points().coordinates());
    let view = GridView::new(grid.shape(), grid.dimension(), &data)?;
    let mut choices = Vec::new();
    // Cautions on the method of the options would tell of one of many.
    let options = BlendingSurfaceOptions { method: Method::Auto, ..options.clone() };
    let u = blending_surface::direction(view, 0, bases[0], &options, &mut choices)?;
    let v = blending_surface::direction(view, 1, bases[1], &options, &mut choices)?;
    let task = Task {
        view,
        size: &size,
        directions: Directions { u: &u.operator, v: &v.operator, rational: None },
        parameters: [&u.parameters, &v.parameters],
        degrees: view.shape().map(|count| count - 1),
        residual: options.residual,
    };
    task.diagnose(choices)
}

/// What is diagnosed; the data are scaled.
struct Task<'a> {
    view: GridView<'a>,
    size: &'a Size,
    directions: Directions<'a>,
    parameters: [&'a Parameters; 2],
    degrees: [usize; 2],
    residual: Option<f64>,
}

/// Numbers that a rehearsal may move, all steps counted; beyond, the rate tells the rest.
const MOST_MOVED: usize = 200_000_000;

impl Task<'_> {
    fn diagnose(&self, mut choices: Vec<String>) -> Result<SurfaceDiagnosis, Error> {
        let Self { view, size, directions, degrees, residual, .. } = *self;
        let (dimension, [rows, columns]) = (view.dimension(), view.shape());
        let data = view.points().coordinates();
        let stopping = size.stopping(residual, 0, &mut choices)?;
        let net = tensor(directions, dimension);
        let mut vectors = vec![0.0; data.len()];
        let first = net.difference_vectors(data, data, dimension, &mut vectors).max;

        // Where the columns, and then the rows, lead to.
        let of_columns = self.solved(data, true)?;
        let limit = match directions.rational {
            None => self.solved(&of_columns, false)?,
            Some(_) => self.limit(data)?,
        };
        let largest = limit.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        drop(limit);
        if !largest.is_finite() {
            return Err(Error::LeavesDoubles);
        }
        let rounding = ROUNDING * largest;
        let tolerance = stopping.residual.max(rounding);

        let told = |k: usize| {
            let matrix = [directions.u, directions.v][k];
            let spacing = Spacing {
                parameters: self.parameters[k].values(),
                period: self.parameters[k].period(),
                reach: degrees[k].div_ceil(2) + 1,
            };
            diagnose(matrix, Some(spacing), None)
        };
        let mut each = [told(0)?, told(1)?];
        let mut both = at_once([&each[0], &each[1]]);
        if let Some(rational) = directions.rational {
            let least = smallest_rational_eigenvalue(directions.u, directions.v, rational)?;
            correct_rates(&mut both, least);
        }
        let start = Start { difference_vectors: &vectors, dimension, tolerance };
        rehearse_all(&mut both, &*net, start, |method| {
            choose_both(method, &IterationWeight::Auto, directions, dimension, 0)
        });
        drop(net);
        // What is left of the first direction adds to what is left of the second.
        let (across, along) = (
            AcrossCollocation::new(directions.u, columns),
            AlongCollocation::new(directions.v, rows),
        );
        let tolerance = 0.5 * tolerance;
        across.difference_vectors(data, data, dimension, &mut vectors);
        let start = Start { difference_vectors: &vectors, dimension, tolerance };
        rehearse_all(&mut each[0].forecasts, &across, start, |method| {
            choose_across(method, &IterationWeight::Auto, directions, dimension)
        });
        along.difference_vectors(&of_columns, &of_columns, dimension, &mut vectors);
        let start = Start { difference_vectors: &vectors, dimension, tolerance };
        rehearse_all(&mut each[1].forecasts, &along, start, |method| {
            choose_along(method, &IterationWeight::Auto, directions, dimension)
        });

        let lemma2_weight = match directions.rational {
            None => product_weights([&each[0], &each[1]]).0,
            Some(_) => None,
        };
        Ok(SurfaceDiagnosis {
            lemma2_weight,
            condition: each[0].condition.value * each[1].condition.value,
            directions: each,
            at_once: both,
            points: [rows, columns],
            degrees,
            residual_target: size.scale.undo(stopping.residual),
            first_residual: size.scale.undo(first),
            rounding: size.scale.undo(rounding),
            choices,
        })
    }

    /// Control points that interpolate every column, or every row, as a curve.
    fn solved(&self, data: &[f64], columns: bool) -> Result<Vec<f64>, Error> {
        let Directions { u, v, .. } = self.directions;
        let mut control = data.to_vec();
        let dimension = self.view.dimension();
        if columns {
            u.factor(None)?.solve_in_place(&mut control, self.view.shape()[1] * dimension);
        } else {
            let factors = v.factor(None)?;
            for row in control.chunks_exact_mut(v.points() * dimension) {
                factors.solve_in_place(row, dimension);
            }
        }
        Ok(control)
    }

    /// The control points of a rational interpolant.
    fn limit(&self, data: &[f64]) -> Result<Vec<f64>, Error> {
        let dimension = self.view.dimension();
        let method = Method::Preconditioned { half_bandwidth: None };
        let mut whole = choose_both(method, &IterationWeight::Auto, self.directions, dimension, 0)?;
        let mut control = data.to_vec();
        let still = vec![0.0; data.len()];
        whole.rule.adjust(Step { iteration: 0, control: &still, dimension }, &mut control);
        Ok(control)
    }
}

/// Rates of a net whose rational weights are no product, from its smallest eigenvalue.
fn correct_rates(forecasts: &mut [Forecast], least: f64) {
    for forecast in forecasts {
        let root = least.sqrt();
        let omega = 2.0 / (1.0 + least);
        (forecast.weight, forecast.rate) = match forecast.method {
            "pia" => (None, 1.0 - least),
            "weighted" => (Some(omega), omega - 1.0),
            "chebyshev" => (Some(least), (1.0 - root) / (1.0 + root)),
            // Of no matrix at hand.
            _ => (None, f64::NAN),
        };
    }
}

/// Fills in the steps of every method: the rule that a fit would run is followed on the difference
/// vectors of the start, and where that would be long, its rate tells the rest.
fn rehearse_all<'a>(
    forecasts: &mut [Forecast],
    operator: &dyn CollocationOperator,
    start: Start<'_>,
    choose: impl Fn(Method) -> Result<ChosenRule<'a>, Error>,
) {
    let most = (MOST_MOVED / start.difference_vectors.len().max(1)).clamp(20, 4000);
    for forecast in forecasts {
        let method = match forecast.method {
            "pia" => Method::Pia,
            "weighted" => Method::Weighted,
            "jacobi" => Method::Jacobi,
            "gauss-seidel" => Method::GaussSeidel,
            "sor" => Method::Sor,
            "chebyshev" => Method::Chebyshev,
            _ => continue,
        };
        // A method that is refused is one that diverges.
        let Ok(mut chosen) = choose(method) else { continue };
        if forecast.rate >= 1.0 && !forecast.converges() {
            continue;
        }
        let seen = rehearse(operator, start, chosen.rule.as_mut(), most);
        forecast.stalls = seen.stalls;
        forecast.iterations = if seen.end.is_some() || seen.stalls {
            seen.end
        } else {
            steps_at_rate(seen.left, start.tolerance, forecast.rate)
                .and_then(|rest| rest.checked_add(seen.taken))
        };
    }
}
