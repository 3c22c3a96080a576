//! From a whole fit to a curve that can be edited, and back.

use super::blocks::Blocks;
use super::place::Spacing;
use super::ring::layout;
use super::row_sums::row_sums;
use super::{Account, EditableCurve, residual_target};
use crate::Error;
use crate::collocation::{CollocationOperator, ResidualNorms, interpolation};
use crate::fit::curve::{finish_parameters, unscale};
use crate::fit::solve::{Size, norm, unscaled};
use crate::fit::{CurveFit, CurveOptions, fit_curve};
use crate::geometry::Curve;
use crate::iteration::{HistoryEntry, ROUNDING};
use crate::knots::{Boundary, KnotPlacement, KnotVector, place_knots};
use crate::memory;
use crate::parameters::Parameters;
use crate::points::{Extent, Points, PointsView};
use crate::projection::largest_deviation;
use crate::report::{CurveReport, RunReport};

/// An error that says what cannot be edited.
pub(super) fn refused(with: &'static str, why: &'static str) -> Error {
    Error::Incompatible { what: "editing point by point", with, why }
}

/// The sentence on a bound.
pub(super) fn within(bound: f64) -> String {
    if bound.is_finite() {
        return format!("no control point is farther than {bound:.1e} from the fit of all points");
    }
    "with parameters this close together, how far control points are from the fit of all points has \
     no bound"
        .into()
}

/// Parameters of a closed curve in rising order, as they were before the seam stepped back.
pub(super) fn unwrapped(values: &[f64], period: f64) -> Vec<f64> {
    let seam = values.windows(2).position(|t| t[1] <= t[0]).map_or(0, |at| at + 1);
    let late = seam > values.len() / 2;
    let each = values.iter().enumerate();
    each.map(|(j, t)| match (j < seam, late) {
        (true, false) => t - period,
        (false, true) => t + period,
        _ => *t,
    })
    .collect()
}

/// The parameters behind a fit, if its knots are averaged ones, and these.
fn averaged(knots: &KnotVector, values: &[f64]) -> Result<Option<(Parameters, KnotVector)>, Error> {
    let parameters = match knots.boundary() {
        Boundary::Open => Parameters::open(values.to_vec())?,
        Boundary::Periodic => {
            let (start, end) = knots.domain();
            Parameters::closed(unwrapped(values, end - start), end - start)?
        }
    };
    let placed = place_knots(knots.degree(), &parameters, &KnotPlacement::Averaged)?;
    let (start, end) = knots.domain();
    // Parameters that were wrapped and unwrapped have been rounded.
    let slack = match knots.boundary() {
        Boundary::Open => 0.0,
        Boundary::Periodic => 16.0 * f64::EPSILON * (start.abs() + end.abs()),
    };
    let mut pairs = placed.values().iter().zip(knots.values());
    let same = placed.values().len() == knots.values().len()
        && pairs.all(|(ours, theirs)| (ours - theirs).abs() <= slack);
    Ok(same.then_some((parameters, placed)))
}

/// The difference vectors of all points, from stored control points.
fn differences(
    parameters: &Parameters,
    knots: &KnotVector,
    data: &[f64],
    stored: &[f64],
) -> Result<(ResidualNorms, Vec<f64>), Error> {
    let built = interpolation(parameters, knots)?;
    let dimension = data.len() / parameters.values().len();
    let control = built.layout.collect(stored, dimension);
    let mut vectors = memory::zeros(data.len());
    let norms = built.operator.difference_vectors(data, &control, dimension, &mut vectors);
    Ok((norms, vectors))
}

impl EditableCurve {
    /// Fits all points, to be edited from then on.
    ///
    /// # Errors
    /// As [`fit_curve`]; [`Error::Incompatible`] for knots that are not averaged, rational weights, and whatever else does not give one control point per data point.
    pub fn new<'a>(
        points: impl Into<PointsView<'a>>,
        options: &CurveOptions,
    ) -> Result<Self, Error> {
        let points = points.into();
        let fit = fit_curve(points, options)?;
        let mut curve = Self::from_fit(points, &fit)?;
        let demanded = options.residual.filter(|residual| *residual > 0.0);
        curve.demanded = demanded.map(|residual| curve.scale.up(residual));
        Ok(curve)
    }

    /// Takes a fit of `points` over. Points that the fit left out as repetitions are left out here,
    /// too.
    ///
    /// # Errors
    /// As [`EditableCurve::new`].
    pub fn from_fit<'a>(points: impl Into<PointsView<'a>>, fit: &CurveFit) -> Result<Self, Error> {
        let points = points.into();
        let curve = &fit.curve;
        if curve.rational_weights().is_some() {
            return Err(refused("rational weights", "it is done for polynomial curves only"));
        }
        let dimension = points.dimension();
        let data: Vec<f64> = match &fit.kept_points {
            // A closed curve's first point may be repeated at the end.
            None if curve.is_periodic() && points.len() == fit.parameters.len() + 1 => {
                points.coordinates()[..fit.parameters.len() * dimension].to_vec()
            }
            None => points.coordinates().to_vec(),
            Some(kept) => {
                let inside = kept.iter().filter(|&&j| j < points.len());
                inside.flat_map(|&j| points.point(j)).copied().collect()
            }
        };
        let count = data.len() / dimension;
        if count != fit.parameters.len() || dimension != curve.dimension() {
            return Err(Error::WrongCount {
                what: "coordinates",
                given: data.len(),
                expected: fit.parameters.len() * curve.dimension(),
                why: "those of the points fitted",
            });
        }
        let Some((parameters, knots)) = averaged(curve.knots(), &fit.parameters)? else {
            return Err(refused(
                "these knots",
                "only averaged ones follow from parameters nearby; leave the knots to gimfit",
            ));
        };
        let extent = Extent::of(PointsView::new(dimension, &data)?)?;
        let scale = Size::of(extent).scale;
        let data = scale.apply(&data);
        let extent = Extent::of(PointsView::new(dimension, &data)?)?;
        let stored = scale.apply(curve.control_points().coordinates());
        let norms = differences(&parameters, &knots, &data, &stored)?.0;
        let layout = layout(curve.degree(), parameters.period());
        let control = layout.collect(&stored, dimension);
        let (row_sums, row_sum_residual) = row_sums(&parameters, &knots, layout)?;
        let period = parameters.period();
        let t = parameters.into_values();
        let mut rows = memory::with_capacity(count * (2 * dimension + 2));
        for j in 0..count {
            rows.extend([t[j], row_sums[j]]);
            rows.extend_from_slice(&data[j * dimension..][..dimension]);
            rows.extend_from_slice(&control[j * dimension..][..dimension]);
        }
        let largest = data.iter().chain(&*control).fold(0.0, |most: f64, x| most.max(x.abs()));
        Ok(Self {
            degree: curve.degree(),
            period,
            blocks: Blocks::new(dimension, &rows),
            scale,
            extent,
            spacing: match fit.report.parameterization {
                "chord" => Spacing::Chord,
                "centripetal" => Spacing::Centripetal,
                _ => Spacing::Free,
            },
            parameterization: fit.report.parameterization,
            demanded: None,
            account: Account {
                edits: 0,
                iterations: fit.report.run.iterations,
                termination: fit.report.run.termination,
                residual: norms.max,
                row_sum_residual,
                largest,
            },
        })
    }

    /// The parameters of all data points.
    #[must_use]
    pub fn parameters(&self) -> Vec<f64> {
        self.blocks.rows(0..self.len()).map(|row| row[0]).collect()
    }

    /// All data points.
    ///
    /// # Errors
    /// None that a curve which holds points can meet.
    pub fn points(&self) -> Result<Points, Error> {
        unscaled(Points::new(self.dimension(), self.columns(2))?, self.scale)
    }

    /// `dimension` columns of all rows.
    fn columns(&self, from: usize) -> Vec<f64> {
        let mut values = memory::with_capacity(self.len() * self.dimension());
        let rows = self.blocks.rows(0..self.len());
        rows.for_each(|row| values.extend_from_slice(&row[from..from + self.dimension()]));
        values
    }

    /// The whole curve as it is now, with its report: residuals and deviation are measured anew, at
    /// all points.
    ///
    /// # Errors
    /// [`Error::LeavesDoubles`] if a coordinate does.
    pub fn fit(&self) -> Result<CurveFit, Error> {
        let (dimension, scale) = (self.dimension(), self.scale);
        let parameters = match self.period {
            None => Parameters::open(self.parameters())?,
            Some(period) => Parameters::closed(self.parameters(), period)?,
        };
        let knots = place_knots(self.degree, &parameters, &KnotPlacement::Averaged)?;
        let layout = layout(self.degree, self.period);
        let (data, control) = (self.columns(2), self.columns(2 + dimension));
        let control = layout.expand(control, dimension);
        let (norms, vectors) = differences(&parameters, &knots, &data, &control)?;
        let (values, spacing_ratio) = finish_parameters(parameters, &knots, layout);
        let view = PointsView::new(dimension, &data)?;
        let extent = Extent::of(view)?;
        let rounding = ROUNDING * extent.largest_coordinate();
        let target = residual_target(&extent, self.demanded).max(rounding);
        let curve = Curve::new(knots, Points::new(dimension, control)?)?;
        let (max_deviation, max_deviation_index) = if norms.max <= rounding {
            // Down there a foot point is decided by rounding; the residual bounds the distance.
            (norms.max, norms.max_index)
        } else {
            let residuals: Vec<f64> = vectors.chunks_exact(dimension).map(norm).collect();
            largest_deviation(&curve, view, &values, &residuals)?
        };
        let Account { edits, iterations, termination, .. } = self.account;
        let (max_residual, rms_residual) = (scale.undo(norms.max), scale.undo(norms.rms));
        let run = RunReport {
            method: "local",
            choices: vec![format!(
                "edits: {edits}, each by local PIA of the points near it; {}",
                within(self.bound())
            )],
            iterations,
            iteration_returned: iterations,
            termination,
            residual_target: scale.undo(target),
            extent: scale.undo(extent.diagonal()),
            max_residual,
            rms_residual,
            smallest_eigenvalue: None,
            updates: None,
            local: None,
            foot_points: None,
            least_squares: None,
            history: vec![HistoryEntry {
                iteration: iterations,
                max_residual,
                rms_residual,
                normal_residual: None,
            }],
        };
        let report = CurveReport {
            points: view.len(),
            control_points: view.len(),
            degree: self.degree,
            dimension,
            closed: self.period.is_some(),
            parameterization: self.parameterization,
            knot_placement: "averaged",
            spacing_ratio,
            shape: None,
            run,
            approximation: None,
            max_residual_index: norms.max_index,
            max_deviation: scale.undo(max_deviation),
            max_deviation_index,
        };
        Ok(CurveFit {
            curve: unscale(curve, scale)?,
            parameters: values,
            kept_points: None,
            difference_vectors: unscaled(Points::new(dimension, vectors)?, scale)?,
            report,
            sequence: Vec::new(),
        })
    }
}
