//! Uniform, chord length, centripetal, the local ratio of the 2007 paper, and given parameters.

use crate::points::{GridView, PointsView};
use crate::{Error, memory};

/// How parameters are assigned to data points.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Parameterization {
    /// Cumulated chord lengths, scaled to [0, 1].
    #[default]
    Chord,
    /// Cumulated square roots of chord lengths, scaled to [0, 1] (Lee 1989).
    Centripetal,
    /// Equal steps on [0, 1].
    Uniform,
    /// `t_j = j - 1/2 + s_j` with `s_j = h_(j-1) / (h_(j-1) + h_j)` from the chord lengths `h`
    /// before and after point `j`: the unequally spaced quadratic scheme of Wang, Li, Jiang and Li
    /// (2007), section 4.2, with one geometric ratio in place of the paper's ratio per coordinate,
    /// which leaves (0, 1) unless every coordinate is monotone. Closed curves of degree 2 only; the
    /// knots are the half-integers, `s_j` is the paper's local parameter.
    ChordRatio,
    /// The caller's parameters, strictly increasing, in any range: one per point; for a closed
    /// curve one more, at which the curve returns to its first point.
    Given(Vec<f64>),
}

impl Parameterization {
    /// Whether coinciding neighbours would share a parameter.
    pub(crate) fn needs_distinct_points(&self) -> bool {
        matches!(self, Self::Chord | Self::Centripetal | Self::ChordRatio)
    }
}

/// Strictly increasing parameters, one per data point.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameters {
    values: Vec<f64>,
    period: Option<f64>,
    origin: f64,
}

impl Parameters {
    /// Takes parameters of an open curve.
    ///
    /// # Errors
    /// [`Error::ParametersNotIncreasing`]; [`Error::OutOfRange`] for one that is not finite.
    pub fn open(values: Vec<f64>) -> Result<Self, Error> {
        check_increasing(&values)?;
        let origin = values.first().copied().unwrap_or(0.0);
        Ok(Self { values, period: None, origin })
    }

    /// Takes parameters of a closed curve that returns to its first point at `values[0] + period`.
    ///
    /// # Errors
    /// As [`Parameters::open`]; also if the period does not exceed the span of the values.
    pub fn closed(values: Vec<f64>, period: f64) -> Result<Self, Error> {
        check_increasing(&values)?;
        let span = values.last().zip(values.first()).map_or(0.0, |(last, first)| last - first);
        if !(period.is_finite() && period > span) {
            return Err(Error::OutOfRange {
                what: "period of the parameters".into(),
                value: period,
                rule: "it must exceed the difference of the last and the first parameter",
            });
        }
        let origin = values.first().copied().unwrap_or(0.0);
        Ok(Self { values, period: Some(period), origin })
    }

    /// The parameters, one per data point.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The period of a closed curve.
    #[must_use]
    pub fn period(&self) -> Option<f64> {
        self.period
    }

    /// Where equal steps start: the first parameter, but for the chord-ratio parameterization,
    /// whose parameters scatter around 0, 1, 2, ...
    pub(crate) fn origin(&self) -> f64 {
        self.origin
    }

    /// Other values in place of these, on a curve of the same kind and period.
    ///
    /// # Errors
    /// As [`Parameters::open`] and [`Parameters::closed`].
    pub(crate) fn moved(self, values: Vec<f64>) -> Result<Self, Error> {
        match self.period {
            Some(period) => Self::closed(values, period),
            None => Self::open(values),
        }
    }

    pub(crate) fn into_values(self) -> Vec<f64> {
        self.values
    }
}

/// Assigns a parameter to every point of an open or closed curve. A closed curve's first point is
/// not repeated at the end.
///
/// # Errors
/// [`Error::RepeatedPoints`] and [`Error::ParametersCollide`] where two neighbours would share a
/// parameter; [`Error::WrongCount`], [`Error::ParametersNotIncreasing`] for given parameters;
/// [`Error::Incompatible`] for [`Parameterization::ChordRatio`] on an open curve.
pub fn assign_parameters(
    points: PointsView<'_>,
    closed: bool,
    parameterization: &Parameterization,
) -> Result<Parameters, Error> {
    match parameterization {
        Parameterization::Uniform => uniform(points.len(), closed),
        Parameterization::Chord => cumulated(points, closed, |h| h),
        Parameterization::Centripetal => cumulated(points, closed, f64::sqrt),
        Parameterization::ChordRatio => chord_ratio(points, closed),
        Parameterization::Given(values) => given(points.len(), closed, values),
    }
}

fn uniform(count: usize, closed: bool) -> Result<Parameters, Error> {
    let steps = if closed { count } else { count.saturating_sub(1) }.max(1) as f64;
    let values = (0..count).map(|j| j as f64 / steps).collect();
    if closed { Parameters::closed(values, 1.0) } else { Parameters::open(values) }
}

fn given(count: usize, closed: bool, values: &[f64]) -> Result<Parameters, Error> {
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
    if !closed {
        return Parameters::open(values.to_vec());
    }
    check_increasing(values)?;
    let period = values[count] - values[0];
    Parameters::closed(values[..count].to_vec(), period)
}

fn cumulated(
    points: PointsView<'_>,
    closed: bool,
    weight: impl Fn(f64) -> f64,
) -> Result<Parameters, Error> {
    let count = points.len();
    let mut steps = memory::with_capacity(count);
    for_each_chord(points, |chord| steps.push(weight(chord)));
    if closed && count > 1 {
        steps.push(weight(distance(points.point(count - 1), points.point(0))));
    }
    from_steps(steps, closed)
}

/// Parameters on [0, 1] whose steps are in the ratio of those given: one less than there are
/// parameters, or for a closed curve as many.
fn from_steps(mut steps: Vec<f64>, closed: bool) -> Result<Parameters, Error> {
    let count = steps.len() + usize::from(!closed);
    let next = |j: usize| if j == count { 0 } else { j };
    if let Some(first) = steps.iter().position(|&step| step == 0.0) {
        return Err(Error::RepeatedPoints { first, second: next(first + 1), others: 0 });
    }
    // In place: the array holds the parameter each step starts from.
    let mut total = 0.0;
    for step in &mut steps {
        total += std::mem::replace(step, total);
    }
    if !closed {
        steps.push(total);
    }
    let scale = total.recip();
    steps.iter_mut().for_each(|t| *t *= scale);
    if !closed && let Some(last) = steps.last_mut() {
        *last = 1.0;
    }
    if let Some(second) = (1..count).find(|&j| steps[j] <= steps[j - 1]) {
        return Err(Error::ParametersCollide { first: second - 1, second });
    }
    if closed && steps.last().is_some_and(|&last| last >= 1.0) {
        return Err(Error::ParametersCollide { first: count - 1, second: 0 });
    }
    Ok(Parameters { values: steps, period: closed.then_some(1.0), origin: 0.0 })
}

/// Assigns parameters to the rows (`direction` 0) or the columns (1) of a grid. Chord lengths are
/// averaged over the lines across (Lin, Wang and Dong 2004, eq. 12 and 13), then scaled to [0, 1].
///
/// # Errors
/// As [`assign_parameters`], where positions are those of rows or columns;
/// [`Error::Incompatible`] for [`Parameterization::ChordRatio`].
pub fn assign_grid_parameters(
    grid: GridView<'_>,
    direction: usize,
    closed: bool,
    parameterization: &Parameterization,
) -> Result<Parameters, Error> {
    let count = grid.shape()[direction];
    let across = grid.shape()[1 - direction];
    let weight = match parameterization {
        Parameterization::Uniform => return uniform(count, closed),
        Parameterization::Given(values) => return given(count, closed, values),
        Parameterization::ChordRatio => {
            return Err(Error::Incompatible {
                what: "the chord-ratio parameterization",
                with: "a surface",
                why: "it is for closed quadratic curves; choose chord",
            });
        }
        Parameterization::Chord => |h| h,
        Parameterization::Centripetal => f64::sqrt,
    };
    let point = |along: usize, line: usize| match direction {
        0 => grid.point(along, line),
        _ => grid.point(line, along),
    };
    let mean = |from: usize| {
        let to = (from + 1) % count;
        let sum: f64 =
            (0..across).map(|line| weight(distance(point(from, line), point(to, line)))).sum();
        sum / across as f64
    };
    let steps = if closed { count } else { count.saturating_sub(1) };
    from_steps((0..steps).map(mean).collect(), closed)
}

fn chord_ratio(points: PointsView<'_>, closed: bool) -> Result<Parameters, Error> {
    if !closed {
        return Err(Error::Incompatible {
            what: "the chord-ratio parameterization",
            with: "an open curve",
            why: "the 2007 scheme is for closed curves; close the curve or choose chord",
        });
    }
    let count = points.len();
    let chord = |j: usize| distance(points.point(j % count), points.point((j + 1) % count));
    let mut before = if count > 0 { chord(count - 1) } else { 0.0 };
    let mut values = Vec::with_capacity(count);
    for j in 0..count {
        let after = chord(j);
        // A ratio of 0 or 1 would put the point on a knot shared with its neighbour.
        let ratio = before / (before + after);
        if !(ratio > 0.0 && ratio < 1.0) {
            let second = (j + 1) % count;
            return Err(if after == 0.0 {
                Error::RepeatedPoints { first: j, second, others: 0 }
            } else {
                Error::ParametersCollide { first: j, second }
            });
        }
        values.push(j as f64 + (ratio - 0.5));
        before = after;
    }
    check_increasing(&values)?;
    Ok(Parameters { values, period: Some(count as f64), origin: 0.0 })
}

/// Calls `visit` with the distance of every point from its predecessor; the usual dimensions are
/// unrolled.
fn for_each_chord(points: PointsView<'_>, mut visit: impl FnMut(f64)) {
    let count = points.len();
    match points.dimension() {
        2 => (1..count).for_each(|j| visit(fixed::<2>(points, j))),
        3 => (1..count).for_each(|j| visit(fixed::<3>(points, j))),
        _ => (1..count).for_each(|j| visit(distance(points.point(j - 1), points.point(j)))),
    }
}

#[inline]
fn fixed<const D: usize>(points: PointsView<'_>, j: usize) -> f64 {
    let pair: &[f64] = &points.coordinates()[(j - 1) * D..][..2 * D];
    distance(&pair[..D], &pair[D..])
}

/// Euclidean distance; differences whose squares underflow are met with `hypot`.
#[inline]
fn distance(a: &[f64], b: &[f64]) -> f64 {
    const SMALLEST_SAFE_SQUARE: f64 = 1e-280;
    let square = a.iter().zip(b).fold(0.0, |sum, (x, y)| sum + (y - x) * (y - x));
    if square < SMALLEST_SAFE_SQUARE {
        return a.iter().zip(b).fold(0.0, |sum: f64, (x, y)| sum.hypot(y - x));
    }
    square.sqrt()
}

fn check_increasing(values: &[f64]) -> Result<(), Error> {
    if let Some(index) = values.iter().position(|t| !t.is_finite()) {
        return Err(Error::OutOfRange {
            what: format!("parameter {index}"),
            value: values[index],
            rule: "parameters must be finite",
        });
    }
    match (1..values.len()).find(|&j| values[j] <= values[j - 1]) {
        Some(index) => Err(Error::ParametersNotIncreasing {
            index,
            value: values[index],
            previous: values[index - 1],
        }),
        None => Ok(()),
    }
}
