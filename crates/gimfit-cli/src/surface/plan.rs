//! From arguments to a grid and options, with all that can be checked before the run.

use super::arguments::{ClosedChoice, GridArguments, GridParameterRule, SurfaceArguments};
use super::least_squares;
use crate::arguments::{KnotRule, RuleOrFile};
use crate::basis::{basis, ensure_document_holds, ensure_no_foot_points, only_b_splines};
use crate::curve::{degree, knot_placement, least_squares_method};
use crate::input;
use crate::method::{ensure_kept_fits_fit, method, only_windows, weight, weight_file};
use crate::targets::is_standard;
use anyhow::{Context, bail, ensure};
use gimfit::basis::BlendingBasis;
use gimfit::{LeastSquaresSurfaceOptions, Parameterization, SurfaceOptions, SurfaceWeight};
use gimfit_io::grids::{GridOptions, PointGrid, read_grid};
use std::path::Path;
use std::sync::Arc;

/// What will be run.
pub(super) struct Plan {
    pub(super) grid: PointGrid,
    pub(super) options: SurfaceOptions,
    /// What is blended in u and v, if no B-splines are.
    pub(super) bases: Option<[Arc<dyn BlendingBasis>; 2]>,
    /// What was made of the arguments that a reader of the report must know.
    pub(super) remarks: Vec<String>,
    /// Fewer control points than points, over knots that stay.
    pub(super) least_squares: Option<LeastSquaresSurfaceOptions>,
}

impl Plan {
    pub(super) fn new(arguments: &SurfaceArguments) -> anyhow::Result<Self> {
        ensure!(
            arguments.convex.is_none(),
            "--convex keeps the turns of planar polygons; a net of control points has none: fit \
             its rows or columns one by one with gimfit curve"
        );
        if least_squares_method(arguments.iteration.method).is_some() {
            let form = form(&arguments.grid)?;
            let least_squares = least_squares::options(arguments, &form)?;
            let Form { grid, options, remarks, .. } = form;
            return Ok(Self { grid, options, bases: None, remarks, least_squares });
        }
        let method = method(&arguments.iteration, false)?;
        let weight = surface_weight(&arguments.iteration.weight)?;
        ensure!(
            arguments.per_direction || matches!(weight, SurfaceWeight::Both(_)),
            "--weight {}: a weight for each direction goes with --per-direction; a net that moves as \
             a whole has one",
            arguments.iteration.weight
        );
        let form = form(&arguments.grid)?;
        least_squares::options(arguments, &form)?;
        arguments.approximation.check(arguments)?;
        let Form { grid, options, bases, remarks } = form;
        arguments.ensure_moves_fit()?;
        let numbers = grid.coordinates.len();
        ensure_kept_fits_fit(
            &arguments.iteration.keep,
            arguments.iteration.iterations,
            numbers,
            &grid.source,
        )?;
        let local = only_windows(&arguments.iteration, [grid.rows, grid.columns], &grid.source)?;
        if bases.is_some() {
            ensure_document_holds(grid.rows, "rows of points", &grid.source)?;
            ensure_document_holds(grid.columns, "columns of points", &grid.source)?;
            ensure_no_foot_points(method)?;
            let only = !arguments.iteration.only.is_empty();
            only_b_splines("--only", only, "other bases move all points in every step")?;
            let moves = !arguments.moves.is_empty();
            only_b_splines("--move", moves, "other bases are fitted as they are")?;
        }
        let options = SurfaceOptions {
            method,
            weight,
            least_eigenvalue: arguments.iteration.least_eigenvalue,
            local,
            per_direction: arguments.per_direction,
            iterations: arguments.iteration.iterations,
            residual: arguments.iteration.residual,
            keep: arguments.iteration.keep.clone(),
            ..options
        };
        Ok(Self { grid, options, bases, remarks, least_squares: None })
    }
}

/// A grid, with what decides where its points sit.
pub(crate) struct Form {
    pub(crate) grid: PointGrid,
    pub(crate) options: SurfaceOptions,
    /// What is blended in u and v, if no B-splines are.
    pub(crate) bases: Option<[Arc<dyn BlendingBasis>; 2]>,
    pub(crate) remarks: Vec<String>,
}

/// Reads a grid, with the options that decide where its points sit.
pub(crate) fn form(arguments: &GridArguments) -> anyhow::Result<Form> {
    ensure!(
        matches!(arguments.index_columns.len(), 0 | 2),
        "--index-columns takes two columns with a comma between: that of the rows, then that of \
         the columns"
    );
    let grid = read_grid(&arguments.file, &reading(arguments))?;
    let mut remarks = Vec::new();
    let mut parameterization = |k: usize| -> anyhow::Result<Option<Parameterization>> {
        let Some(choices) = &arguments.parameters else { return Ok(None) };
        parameterization(&choices.0[k], k, &grid, &mut remarks).map(Some)
    };
    let placement = |k: usize| {
        arguments.knots.as_ref().map(|choices| knot_placement(&choices.0[k])).transpose()
    };
    let bases = blending(arguments, &grid)?;
    let counts = [(grid.rows, "rows of points"), (grid.columns, "columns of points")];
    let degree = |k: usize| {
        let rule = arguments.knots.as_ref().map(|choices| &choices.0[k]);
        let bezier = rule == Some(&RuleOrFile::Rule(KnotRule::Bezier));
        let asked = arguments.degree.as_ref().map(|pair| pair.0[k]);
        let default = SurfaceOptions::default().degrees[k];
        degree(asked, bezier, counts[k].0, counts[k].1, default, &grid.source)
    };
    let options = SurfaceOptions {
        degrees: [degree(0)?, degree(1)?],
        closed: arguments.closed.each(),
        parameterizations: [parameterization(0)?, parameterization(1)?],
        knot_placements: [placement(0)?, placement(1)?],
        rational_weights: arguments
            .rational_weights
            .as_ref()
            .map(|path| input::numbers(path, "--rational-weights", &[]))
            .transpose()?,
        ..SurfaceOptions::default()
    };
    for k in 0..2 {
        let axes = arguments
            .parameters
            .as_ref()
            .is_some_and(|choices| choices.0[k] == RuleOrFile::Rule(GridParameterRule::Axes));
        ensure!(
            !(axes && options.closed[k]),
            "--parameters axes does not tell where a closed direction returns to its start; \
             use chord, uniform or a file of numbers in {}",
            ["u", "v"][k]
        );
    }
    Ok(Form { grid, options, bases, remarks })
}

/// The bases that are no B-splines, with the options that would contradict them refused.
fn blending(
    arguments: &GridArguments,
    grid: &PointGrid,
) -> anyhow::Result<Option<[Arc<dyn BlendingBasis>; 2]>> {
    let [u, v] = arguments.basis.0;
    let bases = [
        basis(u, grid.rows, "rows of points", &grid.source)?,
        basis(v, grid.columns, "columns of points", &grid.source)?,
    ];
    let bases = match bases {
        [None, None] => return Ok(None),
        [Some(u), Some(v)] => [u, v],
        _ => bail!(
            "--basis: b-spline in one direction and another basis in the other do not go together; \
             name two of bernstein, wang-ball, said-ball and dp, or make a direction Bezier by --knots, \
             such as --knots averaged,bezier"
        ),
    };
    only_b_splines("--degree", arguments.degree.is_some(), "the points give the degrees")?;
    only_b_splines("--knots", arguments.knots.is_some(), "other bases have none")?;
    ensure!(
        arguments.rational_weights.is_none(),
        "--rational-weights go with any basis of a curve, but of surfaces with --basis b-spline only; \
         --knots bezier makes a rational Bezier surface of them"
    );
    only_b_splines("--closed", arguments.closed != ClosedChoice::None, "other bases are open")?;
    Ok(Some(bases))
}

/// The files to read, by the argument that names them.
pub(super) fn inputs(arguments: &SurfaceArguments) -> Vec<(&str, &Path)> {
    let mut inputs = form_inputs(&arguments.grid);
    let weights = arguments.iteration.weight.split(',').map(str::trim);
    inputs.extend(weights.filter_map(weight_file).map(|path| ("--weight", path)));
    inputs
}

/// The same of a diagnosis.
pub(crate) fn form_inputs(arguments: &GridArguments) -> Vec<(&str, &Path)> {
    let mut inputs = vec![("GRID", arguments.file.as_path())];
    for choice in arguments.parameters.iter().flat_map(|pair| &pair.0) {
        inputs.extend(file(choice).map(|path| ("--parameters", path)));
    }
    for choice in arguments.knots.iter().flat_map(|pair| &pair.0) {
        inputs.extend(file(choice).map(|path| ("--knots", path)));
    }
    inputs.extend(arguments.rational_weights.as_deref().map(|path| ("--rational-weights", path)));
    // One file for both directions is read twice, which standard input cannot be.
    inputs.dedup_by(|a, b| a == b && !is_standard(a.1));
    inputs
}

fn file<R>(choice: &RuleOrFile<R>) -> Option<&Path> {
    match choice {
        RuleOrFile::File(path) => Some(path),
        RuleOrFile::Rule(_) => None,
    }
}

/// One weight, or two with a comma between.
fn surface_weight(text: &str) -> anyhow::Result<SurfaceWeight> {
    let each: Vec<&str> = text.split(',').map(str::trim).collect();
    Ok(match each.as_slice() {
        [both] => SurfaceWeight::Both(weight(both)?),
        [u, v] => SurfaceWeight::PerDirection([weight(u)?, weight(v)?]),
        _ => bail!(
            "--weight {text}: give one value for both directions, or two with a comma between"
        ),
    })
}

fn reading(arguments: &GridArguments) -> GridOptions {
    let index_columns = match arguments.index_columns.as_slice() {
        [row, column] => Some((row.clone(), column.clone())),
        _ => None,
    };
    GridOptions {
        shape: arguments.shape,
        columns: (!arguments.columns.is_empty()).then(|| arguments.columns.clone()),
        format: arguments.format,
        index_columns,
        axes: arguments.axes,
        delimiter: arguments.delimiter,
        decimal: arguments.decimal,
        keep_holes: false,
    }
}

fn parameterization(
    choice: &RuleOrFile<GridParameterRule>,
    k: usize,
    grid: &PointGrid,
    remarks: &mut Vec<String>,
) -> anyhow::Result<Parameterization> {
    let rule = match choice {
        RuleOrFile::Rule(rule) => rule,
        RuleOrFile::File(path) => {
            let names = RuleOrFile::<GridParameterRule>::names();
            return Ok(Parameterization::Given(input::numbers(path, "--parameters", &names)?));
        }
    };
    Ok(match rule {
        GridParameterRule::Chord => Parameterization::Chord,
        GridParameterRule::Centripetal => Parameterization::Centripetal,
        GridParameterRule::Uniform => Parameterization::Uniform,
        GridParameterRule::Axes => {
            let (direction, lines) = [("u", "rows"), ("v", "columns")][k];
            let abscissae = [&grid.row_abscissae, &grid.column_abscissae][k];
            let mut values = abscissae.clone().with_context(|| {
                format!(
                    "{}: the file gives no abscissae of its {lines}; use --parameters chord or \
                     uniform",
                    grid.source
                )
            })?;
            if values.len() > 1 && values.windows(2).all(|pair| pair[1] < pair[0]) {
                values.iter_mut().for_each(|value| *value = -*value);
                remarks.push(format!(
                    "parameters in {direction}: minus the abscissae of the {lines}, which fall from \
                     the first to the last"
                ));
            }
            Parameterization::Given(values)
        }
    })
}
