//! Least squares with given knots and parameters: a method of that family with `--control-points` or
//! a file of knots.

use super::constraints;
use super::plan::Shape;
use crate::arguments::{CurveArguments, DuplicatesChoice, KnotRule, MethodChoice, RuleOrFile};
use crate::input;
use crate::method::check_owners;
use crate::values;
use anyhow::{anyhow, bail, ensure};
use clap::Args;
use gimfit::{
    Constraints, LeastSquaresKnots, LeastSquaresMethod, LeastSquaresOptions, LeastSquaresWeight,
    Points,
};
use gimfit_io::document::{Geometry, read_document};
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(crate) struct LeastSquaresArguments {
    /// With a method of least squares: file of weights of the data, one per point, none negative; the
    /// squares of residuals count so often
    #[arg(long, value_name = "FILE", help_heading = "Least squares")]
    pub(crate) data_weights: Option<PathBuf>,

    /// With a method of least squares, or within a distance: start an open curve at the first point and
    /// end it at the last
    #[arg(long, help_heading = "Least squares")]
    pub(crate) hold_ends: bool,

    /// With a method of least squares: file of what the curve meets exactly, a line each: `through
    /// ROW`, `tangent ROW X Y..`, `normal ROW X Y..`, `derivative ROW ORDER X Y..`, `control NUMBER X
    /// Y..`, `straight first|last COUNT X Y..`, `planar first|last COUNT X Y..`, `mirror COORDINATE
    /// VALUE`; rows, coordinates and control points count from 1
    #[arg(long, value_name = "FILE", help_heading = "Least squares")]
    pub(crate) constraints: Option<PathBuf>,

    /// With a method of least squares: document of a fitted curve (.json) whose control points the
    /// iteration starts from [default: chosen data points]
    #[arg(long, value_name = "FIT", help_heading = "Least squares")]
    pub(crate) start: Option<PathBuf>,

    /// Seed of random-columns and random-rows; the same seed draws the same [default: 0]
    #[arg(long, value_name = "N", help_heading = "Least squares")]
    pub(crate) seed: Option<u64>,
}

/// The method of a choice, if it is one of least squares.
pub(crate) fn method(choice: MethodChoice) -> Option<LeastSquaresMethod> {
    Some(match choice {
        MethodChoice::LeastSquares => LeastSquaresMethod::Auto,
        MethodChoice::Lspia => LeastSquaresMethod::Lspia,
        MethodChoice::ColumnSums => LeastSquaresMethod::ColumnSums,
        MethodChoice::GsLspia => LeastSquaresMethod::GaussSeidel,
        MethodChoice::SorLspia => LeastSquaresMethod::Sor,
        MethodChoice::Mlspia => LeastSquaresMethod::HeavyBall,
        MethodChoice::Nesterov => LeastSquaresMethod::Nesterov,
        MethodChoice::ChebyshevLspia => LeastSquaresMethod::Chebyshev,
        MethodChoice::Salspia => LeastSquaresMethod::SaLspia,
        MethodChoice::RandomColumns => LeastSquaresMethod::RandomColumns,
        MethodChoice::RandomRows => LeastSquaresMethod::RandomRows,
        MethodChoice::Epia => LeastSquaresMethod::Extended,
        MethodChoice::Cgls => LeastSquaresMethod::Cgls,
        MethodChoice::Pcg => LeastSquaresMethod::Pcg,
        _ => return None,
    })
}

/// The options of a least squares fit; `None` where another kind of fit is asked for.
pub(super) fn options(
    arguments: &CurveArguments,
    shape: &Shape,
) -> anyhow::Result<Option<LeastSquaresOptions>> {
    let choice = arguments.iteration.method;
    let own = &arguments.least_squares;
    let Some(method) = method(choice) else {
        let foreign = [
            ("--data-weights", own.data_weights.is_some()),
            ("--constraints", own.constraints.is_some()),
            ("--start", own.start.is_some()),
            ("--seed", own.seed.is_some()),
        ];
        if let Some((name, _)) = foreign.iter().find(|(_, given)| *given) {
            bail!("{name} belongs to methods of least squares, such as --method least-squares");
        }
        return Ok(None);
    };
    refuse_others(arguments)?;
    let random =
        matches!(method, LeastSquaresMethod::RandomColumns | LeastSquaresMethod::RandomRows);
    ensure!(
        own.seed.is_none() || random,
        "--seed belongs to --method random-columns and random-rows"
    );
    let data_weights = match &own.data_weights {
        Some(path) => Some(input::numbers_of_rows(path, "--data-weights", &shape.table)?),
        None => None,
    };
    let constraints = match &own.constraints {
        Some(path) => constraints::read(path, shape.table.rows())?,
        None => Constraints::new(),
    };
    let iteration = &arguments.iteration;
    Ok(Some(LeastSquaresOptions {
        degree: shape.options.degree,
        closed: shape.options.closed,
        parameterization: shape.options.parameterization.clone(),
        data_weights,
        hold_ends: own.hold_ends,
        constraints,
        start: own.start.as_deref().map(start).transpose()?,
        method,
        weight: weight(&iteration.weight)?,
        seed: own.seed.unwrap_or(0),
        iterations: iteration.iterations,
        residual: iteration.residual,
        keep: iteration.keep.clone(),
        ..LeastSquaresOptions::new(knots(arguments)?)
    }))
}

/// The control points of a fit, without those that a closed curve repeats.
fn start(path: &Path) -> anyhow::Result<Points> {
    let document = read_document(path)?;
    let Some(Geometry::Curve(geometry)) = &document.geometry else {
        bail!("--start {}: the document holds no curve", path.display());
    };
    let curve = geometry.curve()?;
    let length = curve.free_control_points() * curve.dimension();
    let control = curve.control_points().coordinates();
    Ok(Points::new(curve.dimension(), control[..length].to_vec())?)
}

/// Knots from a file, or how many control points.
fn knots(arguments: &CurveArguments) -> anyhow::Result<LeastSquaresKnots> {
    let name = arguments.iteration.method_name();
    match (&arguments.shape.knots, arguments.approximation.control_points) {
        (Some(RuleOrFile::File(path)), None) => {
            let names = RuleOrFile::<KnotRule>::names();
            Ok(LeastSquaresKnots::Given(input::numbers(path, "--knots", &names)?))
        }
        (None, Some(count)) => Ok(LeastSquaresKnots::ControlPoints(count)),
        (Some(_), Some(_)) => {
            bail!("--knots and --control-points both decide the knots; use one of them")
        }
        (Some(RuleOrFile::Rule(_)), None) => bail!(
            "--method {name} takes knots from a file only: the rules place one for every point; use \
             --control-points N"
        ),
        (None, None) => bail!(
            "--method {name} fits fewer control points than points: say how many with \
             --control-points N, or give --knots FILE"
        ),
    }
}

/// Refuses what least squares does not have.
fn refuse_others(arguments: &CurveArguments) -> anyhow::Result<()> {
    let (shape, iteration) = (&arguments.shape, &arguments.iteration);
    check_owners(iteration)?;
    let others = [
        ("--tolerance", arguments.approximation.tolerance.is_some()),
        ("--rms", arguments.approximation.rms.is_some()),
        ("--corners", arguments.approximation.corners.is_some()),
        ("--convex", arguments.convex.is_some()),
        ("--only", !iteration.only.is_empty()),
        ("--rational-weights", shape.rational_weights.is_some()),
        ("--basis", shape.basis != crate::arguments::BasisChoice::BSpline),
    ];
    if let Some((name, _)) = others.iter().find(|(_, given)| *given) {
        bail!("{name} does not go with --method {}", iteration.method_name());
    }
    ensure!(
        shape.duplicates == DuplicatesChoice::Error,
        "--duplicates does not go with --method {}: least squares takes points that repeat as they are",
        iteration.method_name()
    );
    Ok(())
}

/// The weight of `--weight`: auto, published or a number.
pub(crate) fn weight(text: &str) -> anyhow::Result<LeastSquaresWeight> {
    match text {
        "auto" => Ok(LeastSquaresWeight::Auto),
        "published" => Ok(LeastSquaresWeight::Published),
        _ => Ok(LeastSquaresWeight::Same(values::number(text).map_err(|error| {
            anyhow!("--weight {text}: {error}; of least squares it is auto, published or a number")
        })?)),
    }
}
