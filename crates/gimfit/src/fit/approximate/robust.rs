//! Outliers: points that a curve through the others leaves far off, one here and one there.

use super::attempt::{Attempt, Effort};
use super::noise::median_of_squares;
use super::options::Robust;
use super::polyline::Polyline;
use super::problem::{Measure, Problem};
use super::sample;
use crate::Error;
use crate::projection::MovingCurve;

/// A point this many times as far off as is usual, or allowed, is an outlier.
const FAR: f64 = 4.0;
/// Rounds before outliers are named.
const SETTLING: usize = 20;
/// Huber's constant: where weights begin to fall, in usual distances.
const HUBER: f64 = 1.345;
/// Neighbours looked at on either side, and the part of them that may be outliers too: more of them
/// together are a feature of the data.
const NEIGHBOURS: usize = 8;
const CROWD: f64 = 1.0 / 3.0;

/// Positions of the outliers, ascending. `breaks`: how many breakpoints are allowed.
pub(super) fn outliers(
    problem: &Problem<'_>,
    breaks: Option<usize>,
    effort: &mut Effort<'_>,
) -> Result<Vec<usize>, Error> {
    let breaks = breaks.unwrap_or(problem.points() / 2);
    let mut found = sample::grown(problem, breaks, effort)?;
    // Until parameters have settled, good points may be far off too.
    let mut settling = problem.clone();
    settling.enough = 0.0;
    found.trust.clear();
    found.refine(&settling, SETTLING, effort)?;
    let (suspects, others): (Vec<usize>, Vec<usize>) =
        (0..problem.points()).partition(|&j| found.is_outlier(j));
    if suspects.is_empty() || others.len() <= problem.degree + 1 {
        return Ok(suspects);
    }
    // An outlier misleads the parameters of its neighbours: they are judged by a curve without it.
    let data = sample::gather(problem, &others);
    let over: Option<Vec<f64>> =
        problem.over.as_ref().map(|over| others.iter().map(|&j| over[j]).collect());
    let polyline = Polyline { data: &data, over: over.as_deref(), ..problem.polyline() };
    let without = Problem::new(polyline, problem.degree, problem.measure, problem.tolerance);
    let fit = sample::grown(&without, breaks, effort)?;
    let knots = fit.knots(&without)?;
    let mut curve = MovingCurve::new(&knots, &fit.control, problem.dimension);
    let mut places = fit.parameters.clone();
    places.sort_by(f64::total_cmp);
    let limit = FAR * usual(&fit.ratios, &without) * problem.tolerance;
    let mut is_far = |j: usize| {
        let after = others.partition_point(|&other| other < j);
        let low = places[after.saturating_sub(NEIGHBOURS)];
        let high = places[(after + NEIGHBOURS).min(places.len() - 1)];
        let mut t = places[after.min(places.len() - 1)];
        let mut distance = f64::INFINITY;
        if let Some(over) = &problem.over {
            let t = over[j];
            return curve.foot(problem.point(j), t, (t, t)).1 > limit;
        }
        for _ in 0..SETTLING {
            (t, distance) = curve.foot(problem.point(j), t, (low, high));
        }
        // A point before the first of the others, or after the last, is farther by a step or two.
        let step = |leg: usize| 2.0 * without.polyline().leg_length(leg);
        let beyond = match after {
            _ if problem.closed => 0.0,
            0 => step(0),
            _ if after == others.len() => step(others.len() - 2),
            _ => 0.0,
        };
        distance > limit + beyond
    };
    Ok(suspects.into_iter().filter(|&j| is_far(j)).collect())
}

impl Attempt {
    /// Whether a point was found to be an outlier.
    pub(super) fn is_outlier(&self, j: usize) -> bool {
        self.trust.get(j) == Some(&0.0)
    }

    /// Weights after how far points are off; outliers count for nothing.
    pub(super) fn distrust(&mut self, problem: &Problem<'_>, robust: Robust) {
        let usual = usual(&self.ratios, problem);
        let points = self.ratios.len();
        let out: Vec<bool> = self.ratios.iter().map(|ratio| *ratio > FAR * usual).collect();
        let mut sums = vec![0_usize];
        let mut sum = 0;
        for &is_out in &out {
            sum += usize::from(is_out);
            sums.push(sum);
        }
        let crowded = |j: usize| {
            let (from, to) = (j.saturating_sub(NEIGHBOURS), (j + NEIGHBOURS + 1).min(points));
            (sums[to] - sums[from]) as f64 > CROWD * (to - from) as f64
        };
        self.trust.clear();
        for j in 0..points {
            let far = self.ratios[j] / usual;
            self.trust.push(match robust {
                _ if crowded(j) => 1.0,
                _ if out[j] => 0.0,
                Robust::Huber => (HUBER / far).min(1.0),
                Robust::Tukey => (1.0 - (far / FAR).powi(2)).powi(2),
            });
            if self.trust[j] == 0.0 {
                self.ratios[j] = 0.0;
            }
        }
    }
}

/// The usual distance, as a ratio: what is allowed, or where more is usual the root of the mean
/// square that the median stands for.
fn usual(ratios: &[f64], problem: &Problem<'_>) -> f64 {
    let mut sorted = ratios.to_vec();
    let middle = sorted.len() / 2;
    let (_, median, _) = sorted.select_nth_unstable_by(middle, f64::total_cmp);
    let across = problem.across();
    let root = *median * (across / median_of_squares(across as usize)).sqrt();
    let allowed = match problem.measure {
        Measure::Largest => 0.5,
        Measure::Rms | Measure::Noise => 1.0,
    };
    if root.is_finite() { root.max(allowed) } else { f64::INFINITY }
}
