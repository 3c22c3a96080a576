//! Where the data of a least squares fit sit, over which knots, and where their control points start.

use super::{LeastSquaresKnots, LeastSquaresOptions};
use crate::Error;
use crate::collocation::wrap;
use crate::knots::{Boundary, KnotVector, check_period, place_least_squares_knots};
use crate::parameters::{Parameterization, Parameters, assign_parameters};
use crate::points::{Duplicates, PointsView, clean};
use std::borrow::Cow;

/// Parameters of data points, which may repeat.
pub(super) struct Sites {
    /// One per point.
    pub(super) values: Vec<f64>,
    /// Where a closed curve returns to its first point, less its first parameter.
    pub(super) period: Option<f64>,
    /// Positions by ascending parameter; `None` if they ascend as they are.
    order: Option<Vec<u32>>,
}

impl Sites {
    /// Assigns parameters; points that repeat their predecessor share its own.
    pub(super) fn new(
        points: PointsView<'_>,
        closed: bool,
        parameterization: &Parameterization,
    ) -> Result<Self, Error> {
        match parameterization {
            Parameterization::Given(values) => Self::given(points.len(), closed, values.clone()),
            Parameterization::ChordRatio => Err(Error::Incompatible {
                what: "the chord-ratio parameterization",
                with: "least squares",
                why: "it is for interpolating closed quadratic curves; choose chord",
            }),
            Parameterization::Uniform => {
                Ok(assign_parameters(points, closed, parameterization)?.into())
            }
            _ => {
                let same = |j: usize| points.point(j) == points.point(j - 1);
                let apart = clean(points, Duplicates::Drop, same)?;
                let view = PointsView::new(points.dimension(), &apart.coordinates)?;
                let parameters = assign_parameters(view, closed, parameterization).map_err(
                    |error| match &apart.kept {
                        Some(kept) => error.renumbered(kept),
                        None => error,
                    },
                )?;
                let Some(kept) = apart.kept else { return Ok(parameters.into()) };
                let (period, t) = (parameters.period(), parameters.values());
                let mut place = 0;
                let values = (0..points.len()).map(|j| {
                    if kept.get(place + 1) == Some(&j) {
                        place += 1;
                    }
                    t[place]
                });
                Ok(Self { values: values.collect(), period, order: None })
            }
        }
    }

    /// Takes given parameters; those of a closed curve are one more than the points.
    fn given(count: usize, closed: bool, mut values: Vec<f64>) -> Result<Self, Error> {
        let expected = count + usize::from(closed);
        if values.len() != expected {
            return Err(Error::WrongCount {
                what: "parameters",
                given: values.len(),
                expected,
                why: if closed {
                    "one per point and one where the closed curve returns to its first point"
                } else {
                    "one per point"
                },
            });
        }
        check_finite(&values)?;
        let mut period = None;
        if closed {
            let last = values.pop().unwrap_or_default();
            let first = values.first().copied().unwrap_or_default();
            if let Some(j) = values.iter().position(|t| !(first <= *t && *t < last)) {
                return Err(Error::OutOfRange {
                    what: format!("parameter {j}"),
                    value: values[j],
                    rule: "on a closed curve it must lie between the first one and the closing one",
                });
            }
            period = Some(last - first);
        }
        Ok(Self::in_order(values, period))
    }

    /// Takes parameters in the domain of knots.
    pub(super) fn over(values: Vec<f64>, knots: &KnotVector) -> Result<Self, Error> {
        check_finite(&values)?;
        let (start, end) = knots.domain();
        let period = (knots.boundary() == Boundary::Periodic).then_some(end - start);
        Ok(Self::in_order(values, period))
    }

    fn in_order(values: Vec<f64>, period: Option<f64>) -> Self {
        let ascends = values.windows(2).all(|t| t[0] <= t[1]);
        let order = (!ascends).then(|| {
            let mut order: Vec<u32> = (0..values.len() as u32).collect();
            order.sort_by(|&a, &b| values[a as usize].total_cmp(&values[b as usize]));
            order
        });
        Self { values, period, order }
    }

    /// Longest step between parameters that differ over the shortest.
    pub(super) fn spacing_ratio(&self) -> f64 {
        let (mut shortest, mut longest) = (f64::INFINITY, 0.0);
        let mut note = |step: f64| {
            if step > 0.0 {
                shortest = if step < shortest { step } else { shortest };
                longest = if step > longest { step } else { longest };
            }
        };
        match &self.order {
            None => self.values.windows(2).for_each(|t| note(t[1] - t[0])),
            Some(order) => order
                .windows(2)
                .for_each(|j| note(self.values[j[1] as usize] - self.values[j[0] as usize])),
        }
        if let Some(period) = self.period {
            let [first, last] = self.ends().map(|j| self.values[j]);
            note(first + period - last);
        }
        if longest > 0.0 { longest / shortest } else { 1.0 }
    }

    /// The data point that comes at a place by ascending parameter.
    fn at(&self, place: usize) -> usize {
        self.order.as_ref().map_or(place, |order| order[place] as usize)
    }

    /// The parameters that differ, ascending.
    pub(super) fn distinct(&self) -> Result<Parameters, Error> {
        let mut values: Vec<f64> =
            (0..self.values.len()).map(|k| self.values[self.at(k)]).collect();
        values.dedup();
        match self.period {
            Some(period) => Parameters::closed(values, period),
            None => Parameters::open(values),
        }
    }

    /// The knots that were asked for.
    pub(super) fn knots(&self, options: &LeastSquaresOptions) -> Result<KnotVector, Error> {
        let values = match &options.knots {
            LeastSquaresKnots::ControlPoints(count) => {
                return place_least_squares_knots(options.degree, &self.distinct()?, *count);
            }
            LeastSquaresKnots::Given(values) => values.clone(),
        };
        let Some(period) = self.period else { return KnotVector::open(options.degree, values) };
        let knots = KnotVector::periodic(options.degree, values)?;
        check_period(&knots, period)?;
        if knots.control_points() < 2 * options.degree + 1 {
            return Err(Error::WrongCount {
                what: "knots",
                given: knots.values().len(),
                expected: 3 * options.degree + 2,
                why: "a closed curve takes 3 * degree + 2 at least: degree + 1 spans, and degree spans \
                      past both ends",
            });
        }
        Ok(knots)
    }

    /// Parameters of a closed curve brought into the domain of its knots.
    pub(super) fn bring_inside(&mut self, knots: &KnotVector) {
        if let Some(period) = self.period {
            let domain = knots.domain();
            self.values.iter_mut().for_each(|t| *t = wrap(*t, domain, period));
        }
    }

    /// Control points to start from, before parameters are brought into the domain. Over knots that were placed, and on an open curve, they are data
    /// points at equal steps of their number (Deng and Lin 2014); otherwise points of the polyline
    /// through the data, at the Greville abscissae.
    pub(super) fn start(
        &self,
        data: &[f64],
        dimension: usize,
        knots: &KnotVector,
        placed: bool,
    ) -> Vec<f64> {
        let count = self.values.len();
        let point = |place: usize| &data[self.at(place) * dimension..][..dimension];
        let columns = match knots.boundary() {
            Boundary::Open => knots.control_points(),
            Boundary::Periodic => knots.control_points() - knots.degree(),
        };
        let mut start = Vec::with_capacity(columns * dimension);
        if placed && self.period.is_none() {
            for i in 0..columns {
                let place = (count as u128 * i as u128 / (columns - 1).max(1) as u128) as usize;
                start.extend_from_slice(point(place.min(count - 1)));
            }
            return start;
        }
        let t: Cow<'_, [f64]> = match &self.order {
            None => Cow::Borrowed(&self.values),
            Some(order) => order.iter().map(|&j| self.values[j as usize]).collect(),
        };
        for greville in knots.greville_abscissae().into_iter().take(columns) {
            let place = match self.period {
                Some(period) => t[0] + (greville - t[0]).rem_euclid(period),
                None => greville,
            };
            let next = t.partition_point(|t| *t <= place);
            let (last, before, after) = match (next, self.period) {
                (0, _) => (0, t[0], t[0]),
                (next, Some(period)) if next == count => (count - 1, t[count - 1], t[0] + period),
                (next, None) if next == count => (count - 1, t[count - 1], t[count - 1]),
                (next, _) => (next - 1, t[next - 1], t[next]),
            };
            let share = if after > before { (place - before) / (after - before) } else { 0.0 };
            extend_between(&mut start, point(last), point((last + 1) % count), share.min(1.0));
        }
        start
    }

    /// The first and the last data point by parameter.
    pub(super) fn ends(&self) -> [usize; 2] {
        [self.at(0), self.at(self.values.len() - 1)]
    }
}

impl From<Parameters> for Sites {
    fn from(parameters: Parameters) -> Self {
        Self { period: parameters.period(), values: parameters.into_values(), order: None }
    }
}

fn check_finite(values: &[f64]) -> Result<(), Error> {
    match values.iter().position(|t| !t.is_finite()) {
        None => Ok(()),
        Some(j) => Err(Error::OutOfRange {
            what: format!("parameter {j}"),
            value: values[j],
            rule: "parameters must be finite",
        }),
    }
}

fn extend_between(list: &mut Vec<f64>, a: &[f64], b: &[f64], share: f64) {
    list.extend(a.iter().zip(b).map(|(a, b)| a + share * (b - a)));
}
