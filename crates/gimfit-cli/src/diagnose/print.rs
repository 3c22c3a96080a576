//! The diagnosis that a person reads.

use super::{Case, advice};
use crate::report_text::Lines;
use gimfit::diagnosis::{Diagnosis, Dominance, Forecast, TotalPositivity};

pub(super) fn report(case: &Case<'_>) -> String {
    let (table, diagnosis) = (case.table, case.diagnosis);
    let matrix = &diagnosis.matrix;
    let mut lines = Lines::new(&table.source, table.title.as_deref());
    lines.add(
        "read",
        &format!(
            "{} points of dimension {} ({}) as {}",
            table.rows(),
            table.dimension(),
            table.column_names.join(", "),
            table.format
        ),
    );
    lines.add_all("", &table.notes);
    lines.add(
        "curve",
        &format!(
            "{}degree {}, {}, {} points, {} parameters, {}; longest step over shortest {}",
            case.basis.as_ref().map(|name| format!("{name}, ")).unwrap_or_default(),
            diagnosis.degree,
            if diagnosis.closed { "closed" } else { "open" },
            matrix.points,
            diagnosis.parameterization,
            match &case.basis {
                None => format!("{} knots", diagnosis.knot_placement),
                Some(_) => "no knots".into(),
            },
            number(diagnosis.spacing_ratio)
        ),
    );
    lines.add_all("chosen", &diagnosis.choices);
    lines.add_all("spectrum", &spectrum(matrix));
    lines.add_all("proofs", &proofs(matrix));
    lines.add_all("weight", &weights(matrix));
    lines.add_all("condition", &condition(case));
    lines.add_all("steps", &steps(case));
    lines.add_all("places", &advice::places(case));
    lines.add_all("advice", &advice::advice(case));
    lines.finish()
}

/// Few digits, in plain form where they are few.
pub(super) fn number(x: f64) -> String {
    if x == 0.0 || (1e-3..1e5).contains(&x.abs()) {
        let decimals = (3 - x.abs().max(1e-3).log10().floor() as i32).max(0) as usize;
        let text = format!("{x:.decimals$}");
        if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        } else {
            text
        }
    } else {
        format!("{x:.3e}")
    }
}

pub(super) fn spectrum(matrix: &Diagnosis) -> Vec<String> {
    let bounds = &matrix.smallest;
    let mut list = Vec::new();
    if matrix.total_positivity.holds() {
        list.push(format!(
            "all eigenvalues are real; the smallest is about {} ({}), the largest 1",
            number(bounds.estimate),
            if bounds.upper < 1.0 || matrix.points == 1 {
                format!("between {:.4e} and {:.4e}", bounds.lower, bounds.upper)
            } else {
                format!("at least {:.4e}", bounds.lower)
            }
        ));
        return list;
    }
    match &matrix.eigenvalues {
        Some(all) => {
            let complex = all.iter().filter(|value| value.im != 0.0).count();
            list.push(format!(
                "{} eigenvalues, {}; moduli from {:.6e} to {:.6}",
                all.len(),
                if complex == 0 { "all real".into() } else { format!("{complex} of them complex") },
                bounds.estimate,
                all.iter().fold(0.0, |most: f64, value| most.max(value.modulus()))
            ));
            if let Some(last) = all.last() {
                list.push(format!("smallest real part {:.6e}", last.re));
            }
        }
        None => list.push(format!(
            "smallest modulus of an eigenvalue about {:.4e}, an estimate; none exceeds 1",
            bounds.estimate
        )),
    }
    list
}

pub(super) fn proofs(matrix: &Diagnosis) -> Vec<String> {
    let positivity = match matrix.total_positivity {
        TotalPositivity::Known => {
            "totally positive, by the theory of the basis: plain PIA converges, whatever the spacing"
        }
        TotalPositivity::Verified => {
            "totally positive, found by testing minors: plain PIA converges"
        }
        TotalPositivity::Refuted => "not totally positive: a minor is negative",
        TotalPositivity::Unknown => "total positivity is not known",
    };
    let dominance = match &matrix.dominance {
        Dominance::Strict => "diagonally dominant, strictly: Jacobi converges".into(),
        Dominance::Generalised { scaling } => format!(
            "diagonally dominant after columns are scaled by {} to 1 (property GDD): Jacobi \
             converges",
            number(scaling.iter().fold(1.0, |least: f64, x| least.min(*x)))
        ),
        Dominance::None => "not diagonally dominant, however columns are scaled (no GDD)".into(),
    };
    let contraction = format!(
        "||I - A|| = {} {} 1{}",
        number(matrix.contraction),
        if matrix.contraction < 1.0 { "<" } else { ">=" },
        if matrix.contraction < 1.0 {
            ": every step of PIA shrinks the largest residual"
        } else {
            ": this norm proves nothing, and residuals may rise at first"
        }
    );
    vec![positivity.into(), dominance, contraction]
}

fn weights(matrix: &Diagnosis) -> Vec<String> {
    let mut list = Vec::new();
    match matrix.best_weight {
        Some((omega, rate)) => {
            list.push(format!("best single weight {omega:.6}: a step leaves {rate:.4}"));
        }
        None if matrix.eigenvalues.is_some() => list.push(
            "no weight makes PIA converge: an eigenvalue has a real part that is not positive"
                .into(),
        ),
        None => {}
    }
    if let Some(omega) = matrix.lemma2_weight.filter(|_| !matrix.total_positivity.holds()) {
        list.push(format!("weight of Chen, Wang and Jin 2012, Lemma 2: {}", number(omega)));
    }
    // The upper bound of the singular value gives the weight that is safe.
    let bound = number(1.0 / matrix.largest_singular_value.1);
    list.push(if matrix.total_positivity.holds() {
        format!(
            "weights per point: any between 0 and 2 converge; Chen, Wang and Jin 2012, Theorem 2, \
             asks for less than 1 / sigma_max = {bound}"
        )
    } else {
        format!(
            "weights per point: nothing is proved without total positivity; 1 / sigma_max = {bound}"
        )
    });
    list
}

fn condition(case: &Case<'_>) -> Vec<String> {
    let diagnosis = case.diagnosis;
    let condition = diagnosis.matrix.condition;
    let list = vec![format!(
        "{}{} in the maximum norm: control points may move that much farther than data points",
        if condition.exact { "" } else { "at least " },
        number(condition.value)
    )];
    list
}

fn steps(case: &Case<'_>) -> Vec<String> {
    let diagnosis = case.diagnosis;
    let mut list = vec![format!(
        "to a residual of {:.3e}; the largest of the start is {:.3e}",
        diagnosis.residual_target.max(diagnosis.rounding),
        diagnosis.first_residual
    )];
    if diagnosis.rounding > diagnosis.residual_target {
        list.push(format!(
            "(the target is {:.3e}, but rounding allows no less with control points this large)",
            diagnosis.residual_target
        ));
    }
    list.push(format!("{:<14}{:>12}{:>16}{:>14}", "method", "weight", "a step leaves", "steps"));
    list.push(format!("{:<14}{:>12}{:>16}{:>14}", "auto", "", "rounding", "1 or 2"));
    for forecast in &diagnosis.matrix.forecasts {
        list.push(row(forecast));
    }
    let pia = diagnosis.matrix.forecasts.first().filter(|forecast| forecast.converges());
    if let Some(growth) = pia.map(|forecast| forecast.growth).filter(|growth| *growth > GROWTH) {
        list.push(format!(
            "residuals of pia may grow up to {} fold on the way: the matrix is far from normal",
            number(growth)
        ));
    }
    list
}

/// Growth of residuals that is worth a line.
const GROWTH: f64 = 2.0;

pub(super) fn row(forecast: &Forecast) -> String {
    let weight = match forecast.weight {
        Some(least) if forecast.method == "chebyshev" => format!("from {}", number(least)),
        Some(omega) => format!("{omega:.6}"),
        None => String::new(),
    };
    let leaves = if forecast.rate.is_nan() { "unknown".into() } else { rate(forecast.rate) };
    let steps = match forecast.iterations {
        Some(steps) => steps.to_string(),
        None if !forecast.converges() => "diverges".into(),
        None if forecast.stalls => "stalls".into(),
        None => "too many".into(),
    };
    format!("{:<14}{weight:>12}{leaves:>16}{steps:>14}", forecast.method)
}

/// A rate, with the digits that tell it from 1.
fn rate(rate: f64) -> String {
    if !(0.9995..1.0 - 1e-13).contains(&rate) {
        format!("{rate:.4}")
    } else {
        format!("1 - {:.2e}", 1.0 - rate)
    }
}
