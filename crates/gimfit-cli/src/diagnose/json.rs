//! The diagnosis for programs.

use super::Case;
use gimfit::diagnosis::{Dominance, Forecast, Place, TotalPositivity};
use serde_json::{Value, json};

/// One object, in a line.
pub(super) fn text(case: &Case<'_>) -> anyhow::Result<String> {
    Ok(serde_json::to_string(&value(case))? + "\n")
}

fn value(case: &Case<'_>) -> Value {
    let (table, diagnosis) = (case.table, case.diagnosis);
    let matrix = &diagnosis.matrix;
    let place = |place: &Option<Place>| {
        place.map(|place| {
            json!({
                "point": case.place(place.point),
                "index": place.point,
                "shortest_step": case.step(place.shortest),
                "longest_step": case.step(place.longest),
                "ratio": place.ratio,
                "basis_value": place.diagonal,
            })
        })
    };
    json!({
        "source": table.source,
        "points": matrix.points,
        "basis": case.basis.as_deref().unwrap_or("b-spline"),
        "degree": diagnosis.degree,
        "closed": diagnosis.closed,
        "parameterization": diagnosis.parameterization,
        "knot_placement": diagnosis.knot_placement,
        "spacing_ratio": diagnosis.spacing_ratio,
        "extent": diagnosis.extent,
        "choices": diagnosis.choices,
        "smallest_eigenvalue": {
            "lower": matrix.smallest.lower,
            "estimate": matrix.smallest.estimate,
            "upper": matrix.smallest.upper,
        },
        "eigenvalues": matrix.eigenvalues.as_ref().map(|all| {
            all.iter().map(|value| json!([value.re, value.im])).collect::<Vec<_>>()
        }),
        "total_positivity": match matrix.total_positivity {
            TotalPositivity::Known => "known",
            TotalPositivity::Verified => "verified",
            TotalPositivity::Refuted => "refuted",
            TotalPositivity::Unknown => "unknown",
        },
        "diagonal_dominance": match matrix.dominance {
            Dominance::Strict => "strict",
            Dominance::Generalised { .. } => "generalised",
            Dominance::None => "none",
        },
        "contraction": matrix.contraction,
        "largest_singular_value": {
            "lower": matrix.largest_singular_value.0,
            "upper": matrix.largest_singular_value.1,
        },
        "condition": { "value": matrix.condition.value, "exact": matrix.condition.exact },
        "lemma2_weight": matrix.lemma2_weight,
        "best_weight": matrix.best_weight.map(|(omega, _)| omega),
        "residual_target": diagnosis.residual_target,
        "first_residual": diagnosis.first_residual,
        "rounding": diagnosis.rounding,
        "methods": matrix.forecasts.iter().map(forecast).collect::<Vec<_>>(),
        "slowest": place(&matrix.slowest),
        "most_sensitive": place(&matrix.most_sensitive),
        "weakest": place(&matrix.weakest),
    })
}

pub(super) fn forecast(forecast: &Forecast) -> Value {
    json!({
        "method": forecast.method,
        "weight": forecast.weight,
        "rate": forecast.rate,
        "converges": forecast.converges(),
        "growth": forecast.growth,
        "iterations": forecast.iterations,
        "stalls": forecast.stalls,
    })
}
