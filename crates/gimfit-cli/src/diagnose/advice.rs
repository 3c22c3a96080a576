//! Which point or spacing is to blame, and what to do.

use super::Case;
use super::print::number;
use gimfit::diagnosis::{Dominance, Place};

/// A rate of PIA, and a condition, below which nothing is to blame.
const SLOW: f64 = 0.93;
const BAD_CONDITION: f64 = 100.0;
/// Neighbouring steps that differ by more are uneven.
const UNEVEN: f64 = 3.0;

fn is_slow(case: &Case<'_>) -> bool {
    // A rate that is no number is slow, too.
    case.diagnosis.matrix.forecasts.first().is_some_and(|pia| pia.rate.is_nan() || pia.rate >= SLOW)
}

fn is_bad(case: &Case<'_>) -> bool {
    case.diagnosis.matrix.condition.value > BAD_CONDITION
}

/// The places that decide.
pub(super) fn places(case: &Case<'_>) -> Vec<String> {
    let matrix = &case.diagnosis.matrix;
    if !is_slow(case) && !is_bad(case) {
        return vec!["nothing is to blame: the spacing does no harm".into()];
    }
    let mut list = Vec::new();
    let mut told: Vec<usize> = Vec::new();
    let mut tell = |place: Option<Place>, what: &str| {
        let Some(place) = place else { return };
        if told.contains(&place.point) {
            list.push(format!("{what}: {} again", case.place(place.point)));
            return;
        }
        told.push(place.point);
        list.push(format!("{what}: {}", case.place(place.point)));
        if place.ratio > UNEVEN {
            list.push(format!(
                "  shortest step there {}, longest {}, {} times as long",
                case.step(place.shortest),
                case.step(place.longest),
                number(place.ratio)
            ));
        } else {
            list.push("  steps there are even: the degree is what makes it slow".into());
        }
    };
    tell(matrix.slowest, "residuals fall slowest at");
    tell(matrix.most_sensitive, "control points are most sensitive at");
    if let Some(place) = matrix.weakest {
        list.push(format!(
            "the basis function of a point is smallest at its parameter at {}: {}",
            case.place(place.point),
            number(place.diagonal)
        ));
    }
    list
}

/// What to try.
pub(super) fn advice(case: &Case<'_>) -> Vec<String> {
    let diagnosis = case.diagnosis;
    let matrix = &diagnosis.matrix;
    let mut list = Vec::new();
    let worst = [matrix.slowest, matrix.most_sensitive]
        .into_iter()
        .flatten()
        .max_by(|a, b| a.ratio.total_cmp(&b.ratio))
        .filter(|place| place.ratio > UNEVEN);
    if is_slow(case) || is_bad(case) {
        if let Some(place) = worst {
            let next = (place.shortest + 1) % matrix.points;
            list.push(format!(
                "drop {} or {}, which nearly coincide against their neighbours{}",
                case.place(place.shortest),
                case.place(next),
                if diagnosis.parameterization == "chord" {
                    ", or use --parameters centripetal"
                } else {
                    ""
                }
            ));
        }
        if case.basis.is_some() {
            list.push("use --basis b-spline, whose degree does not grow with the points".into());
        } else if diagnosis.degree > 3 {
            list.push("lower the --degree".into());
        }
    }
    if is_slow(case) {
        list.push("--method auto needs no more steps on this spacing than on any other".into());
    }
    if matrix.dominance == Dominance::None && is_slow(case) {
        list.push("leave jacobi aside".into());
    }
    if list.is_empty() {
        list.push("any method will do".into());
    }
    list
}
