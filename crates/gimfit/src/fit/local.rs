//! Local PIA as an option of every method: the chosen points, their matrix, and what becomes of the
//! others.

use super::method::{self, ChosenRule, choose_adaptive};
use super::solve::Solved;
use super::{CurveOptions, IterationWeight, Method};
use crate::Error;
use crate::collocation::{BandedCollocation, CollocationOperator, LocalCollocation};
use crate::iteration::Stopping;
use crate::iteration::update::{AdaptiveRows, Local};
use crate::points::{PointsView, PowerOfTwoScale};
use crate::report::LocalReport;

/// Chosen points of a curve and the matrix of their control points.
pub(super) struct Chosen {
    pub(super) points: Vec<usize>,
    pub(super) matrix: BandedCollocation,
}

impl Chosen {
    /// What the options choose; their positions count the points fitted.
    pub(super) fn of(
        options: &CurveOptions,
        operator: &BandedCollocation,
    ) -> Result<Option<Self>, Error> {
        let Some(list) = &options.local else {
            if options.method == Method::Local {
                return Err(Error::Incompatible {
                    what: "local",
                    with: "no choice of points",
                    why: "name the points whose control points are to move",
                });
            }
            return Ok(None);
        };
        if options.convexity.is_some() {
            return Err(Error::Incompatible {
                what: "local PIA",
                with: "keeping convexity",
                why: "the turns are those of all points; leave out one of them",
            });
        }
        if list.is_empty() {
            return Err(Error::Incompatible {
                what: "local PIA",
                with: "an empty choice of points",
                why: "name at least one point",
            });
        }
        let mut points = list.clone();
        points.sort_unstable();
        points.dedup();
        let matrix = operator.restricted(&points);
        Ok(Some(Self { points, matrix }))
    }

    /// The weights of the chosen points.
    fn weight(&self, weight: &IterationWeight, count: usize) -> Result<IterationWeight, Error> {
        match weight {
            IterationWeight::PerPoint(all) if all.len() == count => {
                Ok(IterationWeight::PerPoint(self.points.iter().map(|&j| all[j]).collect()))
            }
            IterationWeight::PerPoint(all) => Err(Error::WrongCount {
                what: "iteration weights",
                given: all.len(),
                expected: count,
                why: "one per data point",
            }),
            other => Ok(other.clone()),
        }
    }

    /// The sentence for the report.
    fn choice(&self, count: usize) -> String {
        format!(
            "points: {} of {count} iterate, on the matrix of their own; the others keep their \
             control points, and their residuals count for nothing",
            self.points.len()
        )
    }

    /// Measures all points, and notes the worst of those left aside.
    pub(super) fn look_outside(
        &self,
        seen: &LocalCollocation<'_>,
        data: &[f64],
        dimension: usize,
        scale: PowerOfTwoScale,
        solved: &mut Solved,
    ) {
        let norms = seen.outside(data, &solved.control, dimension, &mut solved.vectors);
        solved.run.local = Some(LocalReport {
            chosen: self.points.clone(),
            outside_max_residual: scale.undo(norms.max),
            outside_max_residual_index: norms.max_index,
        });
    }
}

/// The rule that the options name, on the matrix of the chosen points, or of all.
pub(super) fn choose<'a>(
    options: &CurveOptions,
    local: Option<&'a Chosen>,
    operator: &'a BandedCollocation,
    dimension: usize,
    gradual: usize,
    stopping: Stopping,
) -> Result<ChosenRule<'a>, Error> {
    let matrix = local.map_or(operator, |local| &local.matrix);
    let weight = match local {
        Some(local) => &local.weight(&options.weight, operator.points())?,
        None => &options.weight,
    };
    let mut chosen = match options.method {
        Method::Adaptive => {
            let rows = AdaptiveRows::Curve(matrix);
            choose_adaptive(rows, weight, matrix.points(), stopping.residual)?
        }
        Method::Local => {
            let plain = method::choose(Method::Pia, weight, matrix, dimension, gradual)?;
            ChosenRule { name: "local", ..plain }
        }
        method => method::choose(method, weight, matrix, dimension, gradual)?,
    };
    if let Some(local) = local {
        chosen.rule = Box::new(Local::new(chosen.rule, local.points.clone(), dimension));
        chosen.choices.push(local.choice(operator.points()));
    }
    Ok(chosen)
}

/// Positions in the caller's array as positions among the points fitted. A repetition that was left
/// out stands for the point it repeats, the closing point of a closed curve for the first.
pub(super) fn positions_fitted(
    list: &[usize],
    points: PointsView<'_>,
    kept: Option<&[usize]>,
    fitted: usize,
) -> Result<Vec<usize>, Error> {
    let distance = |a: usize, b: usize| {
        let pairs = points.point(a).iter().zip(points.point(b));
        pairs.fold(0.0, |sum: f64, (x, y)| sum.hypot(x - y))
    };
    let place = |&j: &usize| {
        if j >= points.len() {
            return Err(Error::OutOfRange {
                what: "position of a point to move".into(),
                value: j as f64,
                rule: "it counts from 0 and must be less than the number of points",
            });
        }
        let Some(kept) = kept else { return Ok(if j < fitted { j } else { 0 }) };
        let at = kept.partition_point(|&k| k <= j).max(1) - 1;
        let closes = j != kept[at] && at + 1 == fitted && distance(j, 0) < distance(j, kept[at]);
        Ok(if closes { 0 } else { at })
    };
    list.iter().map(place).collect()
}
