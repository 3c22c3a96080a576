//! From arguments to points and options, with all that can be checked before the run.

use super::least_squares;
use crate::arguments::{
    ConvexChoice, CurveArguments, DuplicatesChoice, InputArguments, KnotRule, ParameterRule,
    RuleOrFile, ShapeArguments,
};
use crate::basis::{basis, ensure_document_holds, ensure_no_foot_points, only_b_splines};
use crate::input;
use crate::method::{ensure_kept_fits_fit, method, only, weight, weight_file};
use anyhow::{bail, ensure};
use gimfit::basis::{BlendingBasis, Rational};
use gimfit::knots::MAX_DEGREE;
use gimfit::{
    ApproximationOptions, Convexity, CurveOptions, KnotPlacement, LeastSquaresOptions, Method,
    Parameterization,
};
use gimfit_io::points::PointTable;
use std::path::Path;
use std::sync::Arc;

/// What will be run.
pub(super) struct Plan {
    pub(super) table: PointTable,
    pub(super) options: CurveOptions,
    pub(super) recipe: Recipe,
}

/// The kinds of fits.
pub(super) enum Recipe {
    /// Through all points, by B-splines.
    Interpolate,
    /// Through all points, by another basis.
    Blend(Arc<dyn BlendingBasis>),
    /// Within a distance, or by few control points.
    Approximate(ApproximationOptions),
    /// By few control points over knots that are given or follow from the parameters.
    LeastSquares(LeastSquaresOptions),
}

impl Plan {
    pub(super) fn new(arguments: &CurveArguments) -> anyhow::Result<Self> {
        let shape = shape(&arguments.input, &arguments.shape)?;
        if let Some(options) = least_squares::options(arguments, &shape)? {
            let Shape { table, options: whole, .. } = shape;
            let (iterations, keep) = (options.iterations, &options.keep);
            ensure_kept_fits_fit(keep, iterations, table.coordinates.len(), &table.source)?;
            let whole = CurveOptions { iterations, ..whole };
            return Ok(Self { table, options: whole, recipe: Recipe::LeastSquares(options) });
        }
        let method = method(&arguments.iteration, false)?;
        arguments.approximation.check(arguments)?;
        let weight = weight(&arguments.iteration.weight)?;
        let Shape { table, options, basis } = shape;
        let local = only(&arguments.iteration, table.rows(), &table.source)?;
        let numbers = table.coordinates.len();
        ensure_kept_fits_fit(
            &arguments.iteration.keep,
            arguments.iteration.iterations,
            numbers,
            &table.source,
        )?;
        if basis.is_some() {
            ensure_document_holds(table.rows(), "points", &table.source)?;
            ensure_no_foot_points(method)?;
            let chosen = arguments.convex.is_some();
            only_b_splines("--convex", chosen, "other bases are fitted as they are")?;
        }
        if local.is_some() || matches!(method, Method::Adaptive) {
            let what = if local.is_some() { "--only" } else { "--method adaptive" };
            only_b_splines(what, basis.is_some(), "other bases move all points in every step")?;
        }
        let approximation = &arguments.approximation;
        let abscissae = match (&arguments.input.abscissa, &options.parameterization) {
            (Some(_), Some(Parameterization::Given(values))) => Some(values.clone()),
            _ => None,
        };
        let hold_ends = arguments.least_squares.hold_ends;
        let approximate =
            approximation.options(options.degree, options.closed, abscissae, hold_ends)?;
        let recipe = match (approximate, basis) {
            (Some(options), _) => Recipe::Approximate(options),
            (None, Some(basis)) => Recipe::Blend(basis),
            (None, None) => Recipe::Interpolate,
        };
        ensure!(
            local.is_none() || matches!(recipe, Recipe::Interpolate),
            "--only goes with fits through the points, not with --tolerance, --rms or \
             --control-points"
        );
        let options = CurveOptions {
            convexity: convexity(arguments)?,
            method,
            weight,
            least_eigenvalue: arguments.iteration.least_eigenvalue,
            local,
            iterations: arguments.iteration.iterations,
            residual: arguments.iteration.residual,
            keep: arguments.iteration.keep.clone(),
            ..options
        };
        Ok(Self { table, options, recipe })
    }
}

/// Points, with what decides where they sit.
pub(crate) struct Shape {
    pub(crate) table: PointTable,
    pub(crate) options: CurveOptions,
    /// What is blended, if no B-splines are.
    pub(crate) basis: Option<Arc<dyn BlendingBasis>>,
}

/// Reads points, with the options that decide where they sit.
pub(crate) fn shape(input: &InputArguments, shape: &ShapeArguments) -> anyhow::Result<Shape> {
    ensure!(
        !(input.abscissa.is_some() && shape.parameters.is_some()),
        "--abscissa and --parameters both give the parameters; use one of them"
    );
    let mut table = input::points(input)?;
    if shape.sort {
        table.sort_by_abscissa();
    }
    let weights = rational_weights(shape, &table)?;
    let basis = blending(shape, &table, weights.as_deref())?;
    let bezier = shape.knots == Some(RuleOrFile::Rule(KnotRule::Bezier));
    let default = CurveOptions::default().degree;
    let options = CurveOptions {
        degree: degree(shape.degree, bezier, table.rows(), "points", default, &table.source)?,
        closed: shape.closed,
        parameterization: parameterization(shape, &mut table)?,
        knot_placement: shape.knots.as_ref().map(knot_placement).transpose()?,
        rational_weights: weights,
        duplicates: shape.duplicates.into(),
        ..CurveOptions::default()
    };
    Ok(Shape { table, options, basis })
}

/// The degree: that asked for, or of a Bezier curve what the number of `points` makes it.
pub(crate) fn degree(
    asked: Option<usize>,
    bezier: bool,
    count: usize,
    points: &str,
    default: usize,
    source: &str,
) -> anyhow::Result<usize> {
    if !bezier || asked.is_some() {
        return Ok(asked.unwrap_or(default));
    }
    ensure!(
        (2..=MAX_DEGREE + 1).contains(&count),
        "{source}: --knots bezier makes one piece of degree {} of {count} {points}, and degrees from \
         1 to {MAX_DEGREE} are possible; use other knots",
        count as i64 - 1
    );
    Ok(count - 1)
}

/// The weights of `--rational-weights`, in the order of the points.
fn rational_weights(
    shape: &ShapeArguments,
    table: &PointTable,
) -> anyhow::Result<Option<Vec<f64>>> {
    let Some(path) = &shape.rational_weights else { return Ok(None) };
    Ok(Some(input::numbers_of_rows(path, "--rational-weights", table)?))
}

/// The basis that is no B-spline, with the options that would contradict it refused.
fn blending(
    shape: &ShapeArguments,
    table: &PointTable,
    weights: Option<&[f64]>,
) -> anyhow::Result<Option<Arc<dyn BlendingBasis>>> {
    let basis = basis(shape.basis, table.rows(), "points", &table.source)?;
    if basis.is_some() {
        only_b_splines("--degree", shape.degree.is_some(), "the points give the degree")?;
        only_b_splines("--knots", shape.knots.is_some(), "other bases have none")?;
        only_b_splines("--closed", shape.closed, "other bases are open")?;
        only_b_splines(
            "--duplicates",
            shape.duplicates != DuplicatesChoice::Error,
            "with uniform parameters repeated points are fitted as they are",
        )?;
    }
    if let (Some(basis), Some(weights)) = (&basis, weights) {
        return Ok(Some(Arc::new(Rational::new(Arc::clone(basis), weights.to_vec())?)));
    }
    Ok(basis)
}

/// How the turns of the data are kept.
fn convexity(arguments: &CurveArguments) -> anyhow::Result<Option<Convexity>> {
    let threshold = arguments.convex_threshold;
    ensure!(
        threshold.is_none() || arguments.convex == Some(ConvexChoice::Published),
        "--convex-threshold belongs to --convex=published"
    );
    ensure!(
        threshold.is_none_or(|length| length > 0.0 && length.is_finite()),
        "--convex-threshold must be a length above 0"
    );
    Ok(arguments.convex.map(|choice| match choice {
        ConvexChoice::Closest => Convexity::Closest,
        ConvexChoice::Published => Convexity::Published { threshold },
    }))
}

/// The files to read, by the argument that names them.
pub(super) fn shape_inputs<'a>(
    input: &'a InputArguments,
    shape: &'a ShapeArguments,
) -> Vec<(&'a str, &'a Path)> {
    let mut inputs = vec![("POINTS", input.points.as_path())];
    if let Some(RuleOrFile::File(path)) = &shape.parameters {
        inputs.push(("--parameters", path));
    }
    if let Some(RuleOrFile::File(path)) = &shape.knots {
        inputs.push(("--knots", path));
    }
    if let Some(path) = &shape.rational_weights {
        inputs.push(("--rational-weights", path));
    }
    inputs
}

/// The same of a fit.
pub(super) fn inputs(arguments: &CurveArguments) -> Vec<(&str, &Path)> {
    let mut inputs = shape_inputs(&arguments.input, &arguments.shape);
    if let Some(path) = weight_file(&arguments.iteration.weight) {
        inputs.push(("--weight", path));
    }
    if let Some(path) = &arguments.least_squares.data_weights {
        inputs.push(("--data-weights", path));
    }
    if let Some(path) = &arguments.least_squares.constraints {
        inputs.push(("--constraints", path));
    }
    if let Some(path) = &arguments.least_squares.start {
        inputs.push(("--start", path));
    }
    inputs
}

fn parameterization(
    shape: &ShapeArguments,
    table: &mut PointTable,
) -> anyhow::Result<Option<Parameterization>> {
    let mut values = match (&shape.parameters, table.abscissa.take()) {
        (_, Some(abscissa)) => abscissa,
        (Some(RuleOrFile::File(path)), None) => {
            input::numbers(path, "--parameters", &RuleOrFile::<ParameterRule>::names())?
        }
        (Some(RuleOrFile::Rule(rule)), None) => {
            ensure!(
                shape.period.is_none(),
                "--period goes with --abscissa or with parameters from a file"
            );
            return Ok(Some(match rule {
                ParameterRule::Chord => Parameterization::Chord,
                ParameterRule::Centripetal => Parameterization::Centripetal,
                ParameterRule::Uniform => Parameterization::Uniform,
                ParameterRule::ChordRatio => Parameterization::ChordRatio,
            }));
        }
        (None, None) => {
            ensure!(
                shape.period.is_none(),
                "--period goes with --abscissa or with parameters from a file"
            );
            return Ok(None);
        }
    };
    if let Some(period) = shape.period {
        let Some(&first) = values.first() else { bail!("there are no parameters") };
        let closing = first + period;
        let beyond = values.last().is_some_and(|&last| last < closing);
        ensure!(
            period.is_finite() && beyond,
            "{}: --period {period} is too short: the parameters run from {first} to {}",
            table.source,
            values[values.len() - 1]
        );
        values.push(closing);
    } else if shape.closed && values.len() == table.rows() {
        let dimension = table.dimension();
        let last = table.coordinates.len().saturating_sub(dimension);
        ensure!(
            table.coordinates[..dimension] == table.coordinates[last..],
            "{}: a closed curve needs to know at which parameter it returns to its first point: \
             repeat the first point at the end, with that parameter, or give --period",
            table.source
        );
    }
    Ok(Some(Parameterization::Given(values)))
}

/// The knots of a rule or of a file.
pub(crate) fn knot_placement(choice: &RuleOrFile<KnotRule>) -> anyhow::Result<KnotPlacement> {
    Ok(match choice {
        RuleOrFile::Rule(KnotRule::Averaged) => KnotPlacement::Averaged,
        RuleOrFile::Rule(KnotRule::NotAKnot) => KnotPlacement::NotAKnot,
        RuleOrFile::Rule(KnotRule::AtData) => KnotPlacement::AtData,
        RuleOrFile::Rule(KnotRule::Uniform) => KnotPlacement::Uniform,
        RuleOrFile::Rule(KnotRule::Bezier) => KnotPlacement::Bezier,
        RuleOrFile::File(path) => {
            let names = RuleOrFile::<KnotRule>::names();
            KnotPlacement::Given(input::numbers(path, "--knots", &names)?)
        }
    })
}
