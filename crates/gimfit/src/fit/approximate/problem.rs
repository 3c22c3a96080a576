//! What an approximation has to meet: data points within a distance, and calm in between.

use super::polyline::{Polyline, natural_overshoot};

/// How the distance is judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Measure {
    /// By the largest distance of a data point.
    Largest,
    /// By the root of the mean squared distance.
    Rms,
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
}

/// Share of the distance allowed that the curve may stray beyond what the data themselves explain.
const STRAY: f64 = 1.05;
/// Multiple of the overshoot of a local interpolant that passes for calm; a little less than the 1.5
/// reported, since the curve is watched at places.
const NATURAL: f64 = 1.4;
/// Most guards on a leg.
const MOST_GUARDS: usize = 5;

impl<'a> Problem<'a> {
    /// A smooth piece.
    pub(super) fn new(
        data: &'a [f64],
        dimension: usize,
        degree: usize,
        closed: bool,
        measure: Measure,
        tolerance: f64,
    ) -> Self {
        let polyline = Polyline { data, dimension, closed };
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
        };
        problem.allow(tolerance);
        problem
    }

    /// Legs so long that the curve could stray farther than is allowed between their ends.
    pub(super) fn long_legs(&self) -> impl Iterator<Item = usize> + use<'a> {
        let (polyline, least) = (self.polyline(), 0.5 * self.allowance);
        (0..polyline.legs()).filter(move |&leg| polyline.leg_length(leg) > least)
    }

    /// Guards to begin with: more on longer legs.
    pub(super) fn guards(&self) -> Vec<Guard> {
        let polyline = self.polyline();
        self.long_legs()
            .flat_map(|leg| {
                let count = (polyline.leg_length(leg) / self.allowance).ceil() as usize;
                let count = count.clamp(1, MOST_GUARDS);
                (1..=count).map(move |i| Guard { leg, share: i as f64 / (count + 1) as f64 })
            })
            .collect()
    }

    /// Sets the distance allowed, and with it how far the curve may stray.
    pub(super) fn allow(&mut self, tolerance: f64) {
        self.tolerance = tolerance;
        self.allowance = NATURAL * self.natural + STRAY * tolerance;
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
    pub(super) fn polyline(&self) -> Polyline<'a> {
        Polyline { data: self.data, dimension: self.dimension, closed: self.closed }
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
