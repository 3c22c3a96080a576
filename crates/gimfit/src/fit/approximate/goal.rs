//! What is asked for, checked, in the unit that the search works in.

use super::noise;
use super::options::{ApproximationOptions, Corners, Goal};
use super::polyline::Polyline;
use super::problem::Measure;
use crate::Error;
use crate::fit::solve::Size;

/// A goal in the unit that the search works in.
pub(super) struct ScaledGoal {
    pub(super) measure: Measure,
    /// What a search keeps below.
    pub(super) tolerance: Option<f64>,
    /// What the finished curve is judged by: the same, and in noise the play of chance.
    pub(super) judged: Option<f64>,
    /// The scale at which corners are looked for, where one is known.
    pub(super) detail: Option<f64>,
    pub(super) breaks: Option<usize>,
    /// Standard deviation of the noise, and whether it was estimated.
    pub(super) noise: Option<(f64, bool)>,
}

/// Noise below this part of the extent is none.
const NO_NOISE: f64 = 1e-9;
/// What the root mean square may be above what noise makes of it: no standard deviation is known to
/// the last digit, and a curve that would have to make up for the difference would follow the noise.
const SPARE_GIVEN: f64 = 1.02;
const SPARE_ESTIMATED: f64 = 1.05;
/// Corners of noisy data are looked for at this many standard deviations.
const DETAIL: f64 = 6.0;

impl ScaledGoal {
    fn distance(measure: Measure, tolerance: f64) -> Self {
        let tolerance = Some(tolerance);
        let (judged, detail) = (tolerance, tolerance);
        Self { measure, tolerance, judged, detail, breaks: None, noise: None }
    }

    /// Noise of a standard deviation, or estimated.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] where there is none to be seen.
    pub(super) fn with_noise(
        mut self,
        given: Option<f64>,
        polyline: &Polyline<'_>,
        extent: f64,
    ) -> Result<Self, Error> {
        let deviation = given.unwrap_or_else(|| noise::deviation(polyline));
        if given.is_none() && deviation <= NO_NOISE * extent {
            return Err(Error::OutOfRange {
                what: "estimated noise, in parts of the extent".into(),
                value: deviation / extent,
                rule: "there is none to be seen; state a tolerance, or the standard deviation",
            });
        }
        let across = polyline.across();
        let tolerance = deviation * across.sqrt();
        let spare = if given.is_some() { SPARE_GIVEN } else { SPARE_ESTIMATED };
        self.measure = Measure::Noise;
        self.tolerance = Some(tolerance * spare);
        let chance = noise::chance(polyline.points() as f64, across, noise::CHANCE);
        self.judged = Some(tolerance * spare * chance.sqrt());
        self.detail = Some(DETAIL * deviation);
        self.noise = Some((deviation, given.is_none()));
        Ok(self)
    }
}

pub(super) fn check_goal(
    options: &ApproximationOptions,
    size: &Size,
    polyline: &Polyline<'_>,
) -> Result<ScaledGoal, Error> {
    let distance = |what: &str, value: f64| {
        if value > 0.0 && value.is_finite() {
            return Ok(size.scale.up(value));
        }
        Err(Error::OutOfRange {
            what: what.into(),
            value,
            rule: "it must be a distance above 0, in the unit of the points",
        })
    };
    if let Corners::Angle(angle) = options.corners
        && !(angle > 0.0 && angle < 180.0)
    {
        return Err(Error::OutOfRange {
            what: "angle of corners".into(),
            value: angle,
            rule: "it must lie between 0 and 180 degrees",
        });
    }
    Ok(match options.goal {
        Goal::Tolerance(tolerance) => {
            ScaledGoal::distance(Measure::Largest, distance("tolerance", tolerance)?)
        }
        Goal::Rms(rms) => ScaledGoal::distance(Measure::Rms, distance("rms distance", rms)?),
        Goal::Noise(given) => {
            let given = given.map(|sigma| distance("standard deviation of the noise", sigma));
            return ScaledGoal::distance(Measure::Noise, 0.0).with_noise(
                given.transpose()?,
                polyline,
                size.scale.up(size.extent.diagonal()),
            );
        }
        Goal::ControlPoints(count) => {
            let least = options.degree + 1;
            if count < least {
                return Err(Error::WrongCount {
                    what: "control points",
                    given: count,
                    expected: least,
                    why: "a curve has at least degree + 1; ask for more, or lower the degree",
                });
            }
            let breaks = if options.closed { count } else { count - least };
            ScaledGoal {
                measure: Measure::Largest,
                tolerance: None,
                judged: None,
                detail: None,
                breaks: Some(breaks),
                noise: None,
            }
        }
    })
}
