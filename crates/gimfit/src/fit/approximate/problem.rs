//! What an approximation has to meet: data points within a distance, and calm in between.

use super::noise::{self, CHANCE, smoothed_parameters};
use super::options::Robust;
use super::polyline::{Polyline, natural_overshoot};

/// How the distance is judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::fit) enum Measure {
    /// By the largest distance of a data point.
    Largest,
    /// By the root of the mean squared distance.
    Rms,
    /// By the root of the mean squared distance, in all and in every stretch of the data, against
    /// what noise explains.
    Noise,
}

impl Measure {
    /// What passes for the largest distance where a tolerance is kept.
    pub(super) fn stray(self, tolerance: f64) -> f64 {
        match self {
            Self::Largest | Self::Rms => tolerance,
            // Of many normal deviates.
            Self::Noise => 4.0 * tolerance,
        }
    }
}

/// A place between two data points where the curve is watched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Guard {
    /// The leg of the data polyline.
    pub(super) leg: usize,
    /// Where between the parameters of its ends.
    pub(super) share: f64,
}

/// Data and demands of one smooth piece; coordinates are scaled and centred.
#[derive(Debug, Clone)]
pub(super) struct Problem<'a> {
    /// Shape (points, dimension).
    pub(super) data: &'a [f64],
    pub(super) dimension: usize,
    pub(super) degree: usize,
    pub(super) closed: bool,
    /// Whether the curve starts and ends exactly at the first and the last point.
    pub(super) pinned: bool,
    pub(super) measure: Measure,
    /// The distance allowed.
    pub(super) tolerance: f64,
    /// The judged ratio that will do: 1, or 0 to get as close as can be.
    pub(super) enough: f64,
    /// How far the curve may stray from the data polyline between points.
    pub(super) allowance: f64,
    /// What a local interpolant of the same points strays.
    pub(super) natural: f64,
    /// Standard deviation of noise that misleads chords, or 0.
    pub(super) noise: f64,
    /// First parameters, where chords do not tell.
    pub(super) start: Option<Vec<f64>>,
    /// The abscissa, on [0, 1], where the points are values over one: parameters that stay.
    pub(super) over: Option<Vec<f64>>,
    /// How many places a parameter may move past its neighbours, and one more.
    pub(super) reach: usize,
    /// Whether outliers are looked for; the curve is not watched between the points then.
    pub(super) robust: Option<Robust>,
    /// Of points picked from more: the legs that join neighbours.
    legs: Option<Vec<bool>>,
}

/// Share of the distance allowed that the curve may stray beyond what the data themselves explain.
pub(super) const STRAY: f64 = 1.05;
/// Multiple of the overshoot of a local interpolant that passes for calm; a little less than the 1.5
/// reported, since the curve is watched at places.
const NATURAL: f64 = 1.4;
/// The multiple that is reported.
pub(super) const REPORTED: f64 = 1.5;
/// Noise of this part of the mean leg, and more, misleads chords.
const NOISY: f64 = 0.1;
/// Legs up to this many standard deviations may be noise.
const LEG_OF_NOISE: f64 = 16.0;
/// Most guards on a leg.
const MOST_GUARDS: usize = 5;

impl<'a> Problem<'a> {
    /// A smooth piece.
    pub(super) fn new(
        polyline: Polyline<'a>,
        degree: usize,
        measure: Measure,
        tolerance: f64,
    ) -> Self {
        let Polyline { data, dimension, closed, over } = polyline;
        let natural = natural_overshoot(&polyline);
        let mut problem = Self {
            data,
            dimension,
            degree,
            closed,
            pinned: false,
            measure,
            tolerance,
            enough: 1.0,
            allowance: 0.0,
            natural,
            noise: 0.0,
            start: None,
            over: over.map(<[f64]>::to_vec),
            reach: 1,
            robust: None,
            legs: None,
        };
        problem.allow(tolerance);
        if over.is_some() {
            return problem;
        }
        let noise = match measure {
            Measure::Noise => tolerance / problem.across().sqrt(),
            Measure::Rms if polyline.points() > 2 * degree + 2 => noise::deviation(&polyline),
            Measure::Rms | Measure::Largest => 0.0,
        };
        let legs = (0..polyline.legs()).map(|leg| polyline.leg_length(leg)).sum::<f64>();
        if noise * polyline.legs() as f64 > NOISY * legs {
            let (start, reach) = smoothed_parameters(&polyline, noise);
            (problem.start, problem.reach) = (Some(start), reach);
            problem.noise = noise;
        }
        problem
    }

    /// Directions across the curve: of the noise in a point, as many coordinates are seen.
    pub(super) fn across(&self) -> f64 {
        self.polyline().across()
    }

    /// What the mean of the squared ratios of this many points may be by chance.
    pub(super) fn chance(&self, points: f64, deviations: f64) -> f64 {
        noise::chance(points, self.across(), deviations)
    }

    /// What the mean square of points picked from more may exceed that of all by.
    pub(super) fn luck_of_few(&self) -> f64 {
        match self.legs {
            Some(_) => self.chance(self.points() as f64, CHANCE),
            None => 1.0,
        }
    }

    /// The same demands on some of the points, at these positions, ascending.
    pub(super) fn sampled<'b>(&self, data: &'b [f64], positions: &[usize]) -> Problem<'b> {
        let count = self.points();
        let next = positions[1..].iter().copied().chain([positions[0] + count]);
        let joined = positions.iter().zip(next).map(|(&j, next)| next == j + 1).collect();
        let pick = |values: &Option<Vec<f64>>| {
            values.as_ref().map(|values| positions.iter().map(|&j| values[j]).collect())
        };
        Problem {
            data,
            legs: Some(joined),
            start: pick(&self.start),
            over: pick(&self.over),
            reach: (self.reach * positions.len() / count).max(1),
            ..*self
        }
    }

    /// Whether the curve is watched along a leg: not where there are points in between that were not
    /// picked.
    pub(super) fn is_watched(&self, leg: usize) -> bool {
        self.robust.is_none() && self.legs.as_ref().is_none_or(|legs| legs[leg])
    }

    /// How long a leg is where the curve may stray from it: over an abscissa, how far the values are
    /// apart, or longer where neighbours are farther apart than usual.
    pub(super) fn leg_length(&self, leg: usize) -> f64 {
        let polyline = self.polyline();
        let length = polyline.leg_length(leg);
        if self.over.is_none() {
            return length;
        }
        let steps = polyline.step(leg) * polyline.legs() as f64;
        length.max((0.5 * steps - 0.5) * self.allowance)
    }

    /// Legs so long that the curve could stray farther than is allowed between their ends.
    pub(super) fn long_legs(&self) -> impl Iterator<Item = usize> {
        // Noise makes legs of its own; picking the long ones would pick the noise.
        let polyline = self.polyline();
        let least = (0.5 * self.allowance).max(LEG_OF_NOISE * self.noise);
        (0..polyline.legs())
            .filter(move |&leg| self.is_watched(leg) && self.leg_length(leg) > least)
    }

    /// Guards to begin with: more on longer legs.
    pub(super) fn guards(&self) -> Vec<Guard> {
        self.long_legs()
            .flat_map(|leg| {
                let count = (self.leg_length(leg) / self.allowance).ceil() as usize;
                let count = count.clamp(1, MOST_GUARDS);
                (1..=count).map(move |i| Guard { leg, share: i as f64 / (count + 1) as f64 })
            })
            .collect()
    }

    /// Sets the distance allowed, and with it how far the curve may stray.
    pub(super) fn allow(&mut self, tolerance: f64) {
        self.tolerance = tolerance;
        self.allowance = NATURAL * self.natural + STRAY * self.measure.stray(tolerance);
    }

    /// The judged ratio up to which a report calls the curve calm.
    pub(super) fn nearly_calm(&self) -> f64 {
        let reported = REPORTED * self.natural + STRAY * self.measure.stray(self.tolerance);
        (reported / self.allowance).max(self.enough)
    }

    /// Data points.
    pub(super) fn points(&self) -> usize {
        self.data.len() / self.dimension
    }

    /// Data point `j`.
    pub(super) fn point(&self, j: usize) -> &'a [f64] {
        &self.data[j * self.dimension..][..self.dimension]
    }

    /// The data polyline.
    pub(super) fn polyline(&self) -> Polyline<'_> {
        let &Self { data, dimension, closed, ref over, .. } = self;
        Polyline { data, dimension, closed, over: over.as_deref() }
    }

    /// Fewest breakpoints: inner knots of an open curve, knots in a period of a closed one.
    pub(super) fn fewest_breaks(&self) -> usize {
        if self.closed { self.degree + 1 } else { 0 }
    }

    /// Control points that move, for a number of breakpoints.
    pub(super) fn control_points(&self, breaks: usize) -> usize {
        if self.closed { breaks } else { breaks + self.degree + 1 }
    }

    /// Parameters from cumulated chords to a power, on [0, 1]; coinciding points share one.
    pub(super) fn first_parameters(&self, power: f64) -> Vec<f64> {
        if let Some(start) = self.over.as_ref().or(self.start.as_ref()) {
            return start.clone();
        }
        let polyline = self.polyline();
        let count = self.points();
        let mut total = 0.0;
        let mut parameters = Vec::with_capacity(count);
        for j in 0..count {
            parameters.push(total);
            if j < polyline.legs() {
                total += polyline.leg_length(j).powf(power);
            }
        }
        if total > 0.0 {
            parameters.iter_mut().for_each(|t| *t /= total);
        }
        if !self.closed
            && let Some(last) = parameters.last_mut()
        {
            *last = 1.0;
        }
        parameters
    }
}
