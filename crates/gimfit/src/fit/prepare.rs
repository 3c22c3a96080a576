//! What happens to the points before a parameter is assigned: checks, and the policies on repeated
//! points and on the closing point.

use super::CurveOptions;
use crate::Error;
use crate::parameters::Parameterization;
use crate::points::{Cleaned, Extent, PointsView, clean};

/// Points ready for parameters.
pub(super) struct Prepared<'a> {
    pub(super) cleaned: Cleaned<'a>,
    pub(super) extent: Extent,
    pub(super) parameterization: Parameterization,
    pub(super) choices: Vec<String>,
    pub(super) dimension: usize,
}

/// A last point this close to the first, in units of the extent, is taken for its repetition.
const CLOSING_GAP: f64 = 1e-9;
/// Below this, coordinates lose digits to underflow.
const SMALLEST_EXTENT: f64 = 1e-307;

/// Checks the points and takes out what the options say.
pub(super) fn prepare<'a>(
    points: PointsView<'a>,
    options: &CurveOptions,
) -> Result<Prepared<'a>, Error> {
    let mut choices = Vec::new();
    let needed = options.degree.saturating_add(1);
    if points.is_empty() {
        return Err(Error::NoPoints { needed });
    }
    let extent = Extent::of(points)?;
    check_extent(&extent)?;
    let diagonal = extent.diagonal();
    let mut parameterization = match &options.parameterization {
        Some(parameterization) => parameterization.clone(),
        None if points.dimension() == 1 => {
            choices
                .push("parameters: uniform, because values of dimension 1 have no chords".into());
            Parameterization::Uniform
        }
        None => {
            choices.push("parameters: chord length".into());
            Parameterization::Chord
        }
    };
    if parameterization == Parameterization::ChordRatio && options.degree != 2 {
        return Err(Error::Incompatible {
            what: "the chord-ratio parameterization",
            with: "this degree",
            why: "the 2007 scheme is for degree 2; choose degree 2 or chord",
        });
    }
    if diagonal == 0.0 && points.len() > 1 && parameterization.needs_distinct_points() {
        return Err(Error::AllPointsEqual { points: points.len() });
    }
    let dimension = points.dimension();
    let cleaned = if matches!(parameterization, Parameterization::Given(_)) {
        let points = open_up(points, diagonal, options.closed, &parameterization, &mut choices)?;
        clean_points(points, options, &mut parameterization, &mut choices)?
    } else {
        // The closing point itself may be repeated.
        let mut cleaned = clean_points(points, options, &mut parameterization, &mut choices)?;
        let view = PointsView::new(dimension, &cleaned.coordinates)?;
        let left = open_up(view, diagonal, options.closed, &parameterization, &mut choices)?.len();
        cleaned.truncate(left, dimension);
        cleaned
    };
    let left = cleaned.coordinates.len() / dimension;
    if left < needed {
        return Err(Error::TooFewPoints { points: left, degree: options.degree, needed });
    }
    Ok(Prepared { cleaned, extent, parameterization, choices, dimension })
}

/// Refuses data whose differences underflow.
pub(super) fn check_extent(extent: &Extent) -> Result<(), Error> {
    let diagonal = extent.diagonal();
    if diagonal > 0.0 && diagonal < SMALLEST_EXTENT {
        return Err(Error::OutOfRange {
            what: "extent of the data".into(),
            value: diagonal,
            rule: "below 1e-307 doubles lose digits; scale the data up",
        });
    }
    Ok(())
}

/// Takes the repetition of the first point off the end of a closed curve.
pub(super) fn open_up<'a>(
    points: PointsView<'a>,
    diagonal: f64,
    closed: bool,
    parameterization: &Parameterization,
    choices: &mut Vec<String>,
) -> Result<PointsView<'a>, Error> {
    if !closed || points.len() < 2 {
        return Ok(points);
    }
    let last = points.len() - 1;
    let gap = points
        .point(0)
        .iter()
        .zip(points.point(last))
        .fold(0.0, |sum: f64, (a, b)| sum.hypot(a - b));
    // A list of parameters as long as the points counts the closing point in.
    let counted = matches!(parameterization, Parameterization::Given(t) if t.len() == points.len());
    if gap > CLOSING_GAP * diagonal {
        if counted {
            return Err(Error::WrongCount {
                what: "parameters",
                given: points.len(),
                expected: points.len() + 1,
                why: "one per point and one where the closed curve returns to its first point",
            });
        }
        return Ok(points);
    }
    if matches!(parameterization, Parameterization::Given(_)) && !counted {
        return Ok(points);
    }
    choices.push(if gap == 0.0 {
        "closing: the last point repeats the first and is taken as the closing point".into()
    } else {
        format!(
            "closing: the last point lies {gap:e} from the first and is taken as the closing point"
        )
    });
    PointsView::new(points.dimension(), &points.coordinates()[..last * points.dimension()])
}

/// Applies the policy on repeated points; parameters that go with dropped points go too.
fn clean_points<'a>(
    points: PointsView<'a>,
    options: &CurveOptions,
    parameterization: &mut Parameterization,
    choices: &mut Vec<String>,
) -> Result<Cleaned<'a>, Error> {
    let policy = options.duplicates;
    let count = points.len();
    let cleaned = match parameterization {
        Parameterization::Given(t) => {
            let expected = count + usize::from(options.closed);
            if t.len() != expected {
                return Err(Error::WrongCount {
                    what: "parameters",
                    given: t.len(),
                    expected,
                    why: if options.closed {
                        "one per point and one where the closed curve returns to its first point"
                    } else {
                        "one per point"
                    },
                });
            }
            let cleaned = clean(points, policy, |j| t[j] == t[j - 1])?;
            if let Some(kept) = &cleaned.kept {
                let closing = t.get(count).copied();
                *t = kept.iter().map(|&j| t[j]).chain(closing).collect();
            }
            cleaned
        }
        Parameterization::Uniform => clean(points, policy, |_| false)?,
        _ => clean(points, policy, |j| points.point(j) == points.point(j - 1))?,
    };
    if let Some(kept) = &cleaned.kept {
        choices.push(format!(
            "duplicates: {} of {count} points repeat their predecessor and were {}",
            count - kept.len(),
            match policy {
                crate::points::Duplicates::Merge => "merged with it",
                _ => "dropped",
            }
        ));
    }
    Ok(cleaned)
}
