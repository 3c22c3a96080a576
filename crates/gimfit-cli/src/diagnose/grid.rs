//! The same for grids: each direction, and both at once.

use super::DiagnoseGridArguments;
use super::{json, print};
use crate::basis::described;
use crate::input::check_standard_input;
use crate::report_text::Lines;
use crate::surface::{Form, explain, form, form_inputs};
use crate::{Ending, output};
use gimfit::diagnosis::Diagnosis;
use gimfit::{
    BlendingSurfaceOptions, GridView, SurfaceDiagnosis, SurfaceOptions, diagnose_blending_surface,
    diagnose_surface,
};
use gimfit_io::grids::PointGrid;
use serde_json::json;

/// A diagnosis with the grid it is of.
struct Case<'a> {
    grid: &'a PointGrid,
    found: &'a SurfaceDiagnosis,
    options: &'a SurfaceOptions,
    /// Names of bases that are no B-splines.
    bases: Option<[String; 2]>,
    remarks: &'a [String],
}

const DIRECTIONS: [(&str, &str); 2] = [("u", "row"), ("v", "column")];

pub(crate) fn run(arguments: &DiagnoseGridArguments) -> anyhow::Result<Ending> {
    check_standard_input(&form_inputs(&arguments.grid))?;
    let Form { grid, options, bases, remarks } = form(&arguments.grid)?;
    let options = SurfaceOptions { residual: arguments.target.tolerance, ..options };
    let explain = |error| explain(error, &grid);
    let view = GridView::new([grid.rows, grid.columns], grid.dimension(), &grid.coordinates)
        .map_err(explain)?;
    let found = match &bases {
        None => diagnose_surface(view, &options),
        Some([u, v]) => {
            let options = BlendingSurfaceOptions {
                parameterizations: options.parameterizations.clone(),
                residual: options.residual,
                ..BlendingSurfaceOptions::default()
            };
            diagnose_blending_surface(view, [&**u, &**v], &options)
        }
    };
    let found = found.map_err(explain)?;
    let bases = bases.as_ref().map(|bases| bases.each_ref().map(|basis| described(&**basis)));
    let case = Case { grid: &grid, found: &found, options: &options, bases, remarks: &remarks };
    if arguments.json {
        output::data(&(value(&case).to_string() + "\n"))?;
    } else {
        output::text(&report(&case))?;
    }
    Ok(Ending::Done)
}

fn report(case: &Case<'_>) -> String {
    let Case { grid, found, options, bases, remarks } = case;
    let mut lines = Lines::new(&grid.source, grid.title.as_deref());
    let [rows, columns] = found.points;
    lines.add("read", &format!("{rows} x {columns} points of dimension {}", grid.dimension()));
    lines.add_all("", &grid.notes);
    let closed = match options.closed {
        [false, false] => "open",
        [true, false] => "closed in u",
        [false, true] => "closed in v",
        [true, true] => "closed in u and v",
    };
    let [p, q] = found.degrees;
    let names = bases.as_ref().map(|[u, v]| format!("{u} in u, {v} in v, ")).unwrap_or_default();
    lines.add("surface", &format!("{names}degrees {p} and {q}, {closed}"));
    lines.add_all("chosen", &[remarks, found.choices.as_slice()].concat());
    for ((name, line), matrix) in DIRECTIONS.into_iter().zip(&found.directions) {
        lines.add_all(name, &print::spectrum(matrix));
        lines.add_all("", &print::proofs(matrix));
        lines.add("", &place(matrix, line));
        let condition = condition(matrix.condition.value, matrix.condition.exact);
        lines.add("", &format!("condition {condition}"));
    }
    lines.add("weight", &weight(found));
    let exact = found.directions.iter().all(|matrix| matrix.condition.exact);
    let both = condition(found.condition, exact);
    lines.add("condition", &format!("{both}, both directions together"));
    lines.add_all("steps", &target(found));
    let head =
        |what: &str| format!("{what:<14}{:>12}{:>16}{:>14}", "weight", "a step leaves", "steps");
    lines.add("", &head("both at once"));
    lines.add_all("", &found.at_once.iter().map(print::row).collect::<Vec<_>>());
    for ((name, _), matrix) in DIRECTIONS.into_iter().zip(&found.directions) {
        lines.add("", &head(&format!("{name} alone")));
        lines.add_all("", &matrix.forecasts.iter().map(print::row).collect::<Vec<_>>());
    }
    lines.finish()
}

/// Where residuals fall slowest.
fn place(matrix: &Diagnosis, line: &str) -> String {
    let Some(place) = matrix.slowest else { return "no place is slower than others".into() };
    let [point, from, to] = [place.point, place.shortest, (place.shortest + 1) % matrix.points];
    format!(
        "residuals fall slowest at {line} {}; shortest step there from {line} {} to {}, the longest {} \
         times as long",
        point + 1,
        from + 1,
        to + 1,
        print::number(place.ratio)
    )
}

fn condition(value: f64, exact: bool) -> String {
    format!("{}{} in the maximum norm", if exact { "" } else { "at least " }, print::number(value))
}

fn weight(found: &SurfaceDiagnosis) -> String {
    let whole = |matrix: &Diagnosis| matrix.total_positivity.holds();
    match found.lemma2_weight {
        Some(omega) => format!(
            "of Chen, Wang and Jin 2012, Lemma 2, for both at once: {}{}",
            print::number(omega),
            if found.directions.iter().all(whole) {
                ", as all eigenvalues lie in (0, 1]"
            } else {
                ", from the products of all eigenvalues"
            }
        ),
        None => "that of Lemma 2 is not known for both at once, or no weight converges".into(),
    }
}

fn target(found: &SurfaceDiagnosis) -> Vec<String> {
    let mut list = vec![format!(
        "to a residual of {:.3e}; the largest of the start is {:.3e}",
        found.residual_target.max(found.rounding),
        found.first_residual
    )];
    if found.rounding > found.residual_target {
        list.push(format!(
            "(the target is {:.3e}, but rounding allows no less with control points this large)",
            found.residual_target
        ));
    }
    list
}

fn value(case: &Case<'_>) -> serde_json::Value {
    let Case { grid, found, options, bases, remarks } = case;
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
    let choices = [remarks, found.choices.as_slice()].concat();
    json!({
        "source": grid.source,
        "points": found.points,
        "degrees": found.degrees,
        "bases": bases,
        "closed": options.closed,
        "residual_target": found.residual_target,
        "first_residual": found.first_residual,
        "rounding": found.rounding,
        "choices": choices,
        "condition": found.condition,
        "lemma2_weight": found.lemma2_weight,
        "directions": directions,
        "methods": found.at_once.iter().map(json::forecast).collect::<Vec<_>>(),
    })
}
