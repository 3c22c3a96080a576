//! From arguments to a grid and options, with all that can be checked before the run.

use super::arguments::{ClosedChoice, GridParameterRule, SurfaceArguments};
use crate::arguments::KnotRule;
use crate::basis::{basis, only_b_splines};
use crate::method::{ensure_kept_fits_fit, method, weight, weight_file};
use anyhow::{Context, bail, ensure};
use gimfit::basis::BlendingBasis;
use gimfit::{KnotPlacement, Parameterization, SurfaceOptions};
use gimfit_io::grids::{GridOptions, PointGrid, read_grid};
use std::path::Path;
use std::sync::Arc;

/// What will be run.
pub(super) struct Plan {
    pub(super) grid: PointGrid,
    pub(super) options: SurfaceOptions,
    /// What is blended in u and v, if no B-splines are.
    pub(super) bases: Option<[Arc<dyn BlendingBasis>; 2]>,
}

impl Plan {
    pub(super) fn new(arguments: &SurfaceArguments) -> anyhow::Result<Self> {
        let method = method(&arguments.iteration)?;
        let weight = weight(&arguments.iteration.weight)?;
        ensure!(
            matches!(arguments.index_columns.len(), 0 | 2),
            "--index-columns takes two columns with a comma between: that of the rows, then that of \
             the columns"
        );
        let grid = read_grid(&arguments.grid, &reading(arguments))?;
        let numbers = grid.coordinates.len();
        ensure_kept_fits_fit(
            &arguments.iteration.keep,
            arguments.iteration.iterations,
            numbers,
            &grid.source,
        )?;
        let parameterization = |k: usize| -> anyhow::Result<Option<Parameterization>> {
            arguments.parameters.map(|rules| parameterization(rules.0[k], k, &grid)).transpose()
        };
        let bases = blending(arguments, &grid)?;
        let options = SurfaceOptions {
            degrees: arguments.degree.map_or(SurfaceOptions::default().degrees, |pair| pair.0),
            closed: arguments.closed.each(),
            parameterizations: [parameterization(0)?, parameterization(1)?],
            knot_placements: [0, 1].map(|k| arguments.knots.map(|rules| placement(rules.0[k]))),
            method,
            weight,
            per_direction: arguments.per_direction,
            iterations: arguments.iteration.iterations,
            residual: arguments.iteration.residual,
            keep: arguments.iteration.keep.clone(),
        };
        for k in 0..2 {
            let axes = matches!(options.parameterizations[k], Some(Parameterization::Given(_)));
            ensure!(
                !(axes && options.closed[k]),
                "--parameters axes does not tell where a closed direction returns to its start; \
                 use chord or uniform in {}",
                ["u", "v"][k]
            );
        }
        Ok(Self { grid, options, bases })
    }
}

/// The bases that are no B-splines, with the options that would contradict them refused.
fn blending(
    arguments: &SurfaceArguments,
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
             name two of bernstein, wang-ball, said-ball and dp"
        ),
    };
    only_b_splines("--degree", arguments.degree.is_some(), "the points give the degrees")?;
    only_b_splines("--knots", arguments.knots.is_some(), "other bases have none")?;
    only_b_splines("--closed", arguments.closed != ClosedChoice::None, "other bases are open")?;
    Ok(Some(bases))
}

/// The files to read, by the argument that names them.
pub(super) fn inputs(arguments: &SurfaceArguments) -> Vec<(&str, &Path)> {
    let mut inputs = vec![("GRID", arguments.grid.as_path())];
    inputs.extend(weight_file(&arguments.iteration.weight).map(|path| ("--weight", path)));
    inputs
}

fn reading(arguments: &SurfaceArguments) -> GridOptions {
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
    }
}

fn parameterization(
    rule: GridParameterRule,
    k: usize,
    grid: &PointGrid,
) -> anyhow::Result<Parameterization> {
    Ok(match rule {
        GridParameterRule::Chord => Parameterization::Chord,
        GridParameterRule::Centripetal => Parameterization::Centripetal,
        GridParameterRule::Uniform => Parameterization::Uniform,
        GridParameterRule::Axes => {
            let abscissae = [&grid.row_abscissae, &grid.column_abscissae][k];
            let values = abscissae.clone().with_context(|| {
                format!(
                    "{}: the file gives no abscissae of its {}; use --parameters chord or uniform",
                    grid.source,
                    ["rows", "columns"][k]
                )
            })?;
            Parameterization::Given(values)
        }
    })
}

fn placement(rule: KnotRule) -> KnotPlacement {
    match rule {
        KnotRule::Averaged => KnotPlacement::Averaged,
        KnotRule::NotAKnot => KnotPlacement::NotAKnot,
        KnotRule::AtData => KnotPlacement::AtData,
        KnotRule::Uniform => KnotPlacement::Uniform,
    }
}
