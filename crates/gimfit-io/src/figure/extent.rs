//! Which values the axes of a figure must hold.

use super::CurveFigure;
use super::notes::Notes;
use super::rows::Rows;
use super::scale::{Interval, drawable};

/// Room between the outermost values and the frame, relative to the span.
const PADDING: f64 = 0.05;

/// For each of `coordinates` the interval to show, without padding.
///
/// Data points are always inside. Curves and control points count as far as
/// they stray no further than the data are wide: one that flies off must not
/// shrink the rest to a dot. `None` where there is nothing to show.
pub(super) fn of_coordinates(
    figure: &CurveFigure<'_>,
    coordinates: std::ops::Range<usize>,
    notes: &mut Notes,
) -> Vec<Option<Interval>> {
    let around = |rows: Rows<'_>, k: usize| Interval::around(rows.iter().map(|row| row[k]));
    let data: Vec<_> = coordinates.clone().map(|k| around(figure.data(), k)).collect();
    let allowance = data.iter().flatten().map(Interval::span).fold(0.0, f64::max);
    let mut strayed = false;
    let made = coordinates
        .zip(data)
        .map(|(k, data)| {
            let mut shown = data;
            let others = [
                around(figure.curve(), k),
                Interval::around(beziers(figure, k)),
                around(figure.control(), k),
            ];
            let earlier = figure
                .sequence
                .iter()
                .map(|kept| around(Rows::new(kept.curve.points, figure.dimension), k));
            for other in others.into_iter().chain(earlier).flatten() {
                let (other, cut) = cut(other, data, allowance);
                strayed |= cut;
                shown = Some(shown.map_or(other, |old| old.union(other)));
            }
            shown
        })
        .collect();
    if strayed {
        notes.add("curves or control polygon reach beyond the picture".to_owned());
    }
    made
}

/// What of `other` lies no further than `allowance` from `data`, and whether
/// that is not all.
pub(crate) fn cut(other: Interval, data: Option<Interval>, allowance: f64) -> (Interval, bool) {
    match data {
        Some(data) if allowance > 0.0 => {
            let limit = data.grown(allowance);
            let within = Interval {
                low: other.low.clamp(limit.low, limit.high),
                high: other.high.clamp(limit.low, limit.high),
            };
            (within, other.low < limit.low || other.high > limit.high)
        }
        _ => (other, false),
    }
}

/// Values of coordinate `k` of the Bezier points, which a 2-D curve may have.
fn beziers<'a>(figure: &'a CurveFigure<'_>, k: usize) -> impl Iterator<Item = f64> + 'a {
    let flat = match figure.curve_samples.beziers {
        Some(flat) if figure.dimension == 2 => flat,
        _ => &[],
    };
    flat.iter().copied().skip(k).step_by(2)
}

/// The interval of all parameters in the figure.
pub(super) fn of_parameters(figure: &CurveFigure<'_>) -> Option<Interval> {
    let all =
        [figure.parameters, figure.curve_samples.parameters, figure.abscissae_of_control_points];
    Interval::around(all.into_iter().flatten().copied().filter_map(drawable))
}

/// `values` with room at both ends.
pub(crate) fn padded(values: Interval) -> Interval {
    let opened = values.opened();
    opened.grown(PADDING * opened.span())
}
