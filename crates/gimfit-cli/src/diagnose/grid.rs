//! The same for grids: each direction, and both at once.

use super::{json, print};
use crate::arguments::{
    BasisChoice, DiagnoseArguments, DuplicatesChoice, ParameterRule, RuleOrFile,
};
use crate::curve::knot_placement;
use crate::report_text::Lines;
use crate::{Ending, output};
use anyhow::{anyhow, bail, ensure};
use gimfit::{GridView, Parameterization, SurfaceDiagnosis, SurfaceOptions, diagnose_surface};
use gimfit_io::grids::{GridOptions, PointGrid, read_grid};
use serde_json::json;

pub(super) fn run(arguments: &DiagnoseArguments) -> anyhow::Result<Ending> {
    let (input, shape) = (&arguments.input, &arguments.shape);
    ensure!(input.format.is_none(), "--format names formats of points; a grid's is recognised");
    ensure!(shape.basis == BasisChoice::BSpline, "--grid goes with --basis b-spline");
    ensure!(shape.duplicates == DuplicatesChoice::Error, "--duplicates is for points, not grids");
    let parameterization = match &shape.parameters {
        None => None,
        Some(RuleOrFile::Rule(ParameterRule::Chord)) => Some(Parameterization::Chord),
        Some(RuleOrFile::Rule(ParameterRule::Centripetal)) => Some(Parameterization::Centripetal),
        Some(RuleOrFile::Rule(ParameterRule::Uniform)) => Some(Parameterization::Uniform),
        Some(_) => bail!("--parameters of a grid: chord, centripetal or uniform"),
    };
    let placement = shape.knots.as_ref().map(knot_placement).transpose()?;
    let degree = shape.degree.unwrap_or(3);
    let options = SurfaceOptions {
        degrees: [degree; 2],
        closed: [shape.closed; 2],
        parameterizations: [parameterization.clone(), parameterization],
        knot_placements: [placement.clone(), placement],
        residual: arguments.tolerance,
        ..SurfaceOptions::default()
    };
    let reading = GridOptions {
        columns: (!input.columns.is_empty()).then(|| input.columns.clone()),
        delimiter: input.delimiter,
        decimal: input.decimal,
        ..GridOptions::default()
    };
    let grid = read_grid(&input.points, &reading)?;
    let explain = |error| anyhow!("{}: {error}", grid.source);
    let view = GridView::new([grid.rows, grid.columns], grid.dimension(), &grid.coordinates)
        .map_err(explain)?;
    let found = diagnose_surface(view, &options).map_err(explain)?;
    if arguments.json {
        output::data(&(value(&grid, &found).to_string() + "\n"))?;
    } else {
        output::text(&report(&grid, &found))?;
    }
    Ok(Ending::Done)
}

fn report(grid: &PointGrid, found: &SurfaceDiagnosis) -> String {
    let mut lines = Lines::new(&grid.source, grid.title.as_deref());
    let [rows, columns] = found.points;
    lines.add("read", &format!("{rows} x {columns} points of dimension {}", grid.dimension()));
    lines.add_all("", &grid.notes);
    lines.add_all("chosen", &found.choices);
    let names = [("u", "row"), ("v", "column")];
    for ((name, line), matrix) in names.into_iter().zip(&found.directions) {
        lines.add_all(name, &print::spectrum(matrix));
        lines.add_all("", &print::proofs(matrix));
        if let Some(place) = matrix.slowest {
            let [point, from, to] =
                [place.point, place.shortest, (place.shortest + 1) % matrix.points];
            lines.add(
                "",
                &format!(
                    "residuals fall slowest at {line} {}; shortest step there from {line} {} to {}, \
                     the longest {} times as long",
                    point + 1,
                    from + 1,
                    to + 1,
                    print::number(place.ratio)
                ),
            );
        }
    }
    lines.add(
        "steps",
        &format!(
            "to a residual of {:.3e}; the largest of the start is {:.3e}; from rates alone",
            found.residual_target, found.first_residual
        ),
    );
    let head =
        |what: &str| format!("{what:<14}{:>12}{:>16}{:>14}", "weight", "a step leaves", "steps");
    lines.add("", &head("both at once"));
    lines.add_all("", &found.at_once.iter().map(print::row).collect::<Vec<_>>());
    for ((name, _), matrix) in names.into_iter().zip(&found.directions) {
        lines.add("", &head(&format!("{name} alone")));
        lines.add_all("", &matrix.forecasts.iter().map(print::row).collect::<Vec<_>>());
    }
    lines.finish()
}

fn value(grid: &PointGrid, found: &SurfaceDiagnosis) -> serde_json::Value {
    let directions: Vec<_> = found
        .directions
        .iter()
        .map(|matrix| {
            json!({
                "smallest_eigenvalue": matrix.smallest.estimate,
                "diagonal_dominance": matrix.dominance.is_generalised(),
                "totally_positive": matrix.total_positivity.holds(),
                "condition": matrix.condition.value,
                "methods": matrix.forecasts.iter().map(json::forecast).collect::<Vec<_>>(),
            })
        })
        .collect();
    json!({
        "source": grid.source,
        "points": found.points,
        "residual_target": found.residual_target,
        "first_residual": found.first_residual,
        "choices": found.choices,
        "directions": directions,
        "methods": found.at_once.iter().map(json::forecast).collect::<Vec<_>>(),
    })
}
