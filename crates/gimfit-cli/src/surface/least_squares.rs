//! Least squares over grids: a method of that family with `--control-points` or files of knots.

use super::arguments::SurfaceArguments;
use super::plan::Form;
use crate::curve::{least_squares_method, least_squares_weight};
use crate::method::check_owners;
use anyhow::{bail, ensure};
use gimfit::{KnotPlacement, LeastSquaresKnots, LeastSquaresMethod, LeastSquaresSurfaceOptions};

/// The options of a least squares fit; `None` where another kind of fit is asked for.
pub(super) fn options(
    arguments: &SurfaceArguments,
    form: &Form,
) -> anyhow::Result<Option<LeastSquaresSurfaceOptions>> {
    let iteration = &arguments.iteration;
    let Some(method) = least_squares_method(iteration.method) else {
        let foreign = [("--hold-ends", arguments.hold_ends), ("--seed", arguments.seed.is_some())];
        if let Some((name, _)) = foreign.iter().find(|(_, given)| *given) {
            bail!("{name} belongs to methods of least squares, such as --method least-squares");
        }
        return Ok(None);
    };
    refuse_others(arguments, form)?;
    let random =
        matches!(method, LeastSquaresMethod::RandomColumns | LeastSquaresMethod::RandomRows);
    ensure!(
        arguments.seed.is_none() || random,
        "--seed belongs to --method random-columns and random-rows"
    );
    Ok(Some(LeastSquaresSurfaceOptions {
        degrees: form.options.degrees,
        closed: form.options.closed,
        parameterizations: form.options.parameterizations.clone(),
        hold_ends: arguments.hold_ends,
        method,
        weight: least_squares_weight(&iteration.weight)?,
        seed: arguments.seed.unwrap_or(0),
        iterations: iteration.iterations,
        residual: iteration.residual,
        ..LeastSquaresSurfaceOptions::new(knots(arguments, form)?)
    }))
}

/// Knots from files, or how many control points.
fn knots(arguments: &SurfaceArguments, form: &Form) -> anyhow::Result<[LeastSquaresKnots; 2]> {
    let name = arguments.iteration.method_name();
    match (&form.options.knot_placements, arguments.approximation.control_points) {
        ([Some(KnotPlacement::Given(u)), Some(KnotPlacement::Given(v))], None) => {
            Ok([u.clone(), v.clone()].map(LeastSquaresKnots::Given))
        }
        ([None, None], Some((rows, columns))) => {
            Ok([rows, columns].map(LeastSquaresKnots::ControlPoints))
        }
        (_, Some(_)) => {
            bail!("--knots and --control-points both decide the knots; use one of them")
        }
        ([None, None], None) => bail!(
            "--method {name} fits fewer control points than points: say how many with \
             --control-points MxN, or give --knots FILE,FILE"
        ),
        (_, None) => bail!(
            "--method {name} takes knots from files only: the rules place one for every row and \
             column; use --control-points MxN"
        ),
    }
}

/// Refuses what least squares does not have.
fn refuse_others(arguments: &SurfaceArguments, form: &Form) -> anyhow::Result<()> {
    let iteration = &arguments.iteration;
    check_owners(iteration)?;
    let others = [
        ("--tolerance", arguments.approximation.tolerance.is_some()),
        ("--rms", arguments.approximation.rms.is_some()),
        ("--only", !iteration.only.is_empty()),
        ("--keep", !iteration.keep.is_empty()),
        ("--move", !arguments.moves.is_empty()),
        ("--rational-weights", form.options.rational_weights.is_some()),
        ("--basis", form.bases.is_some()),
    ];
    match others.iter().find(|(_, given)| *given) {
        None => Ok(()),
        Some((name, _)) => bail!("{name} does not go with --method {}", iteration.method_name()),
    }
}
