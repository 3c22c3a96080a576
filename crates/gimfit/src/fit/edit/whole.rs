//! From a whole fit to a curve that can be edited, and back.

use super::blocks::Blocks;
use super::place::Spacing;
use super::{Account, EditableCurve};
use crate::Error;
use crate::collocation::{CollocationOperator, interpolation};
use crate::fit::curve::{spacing_ratio, unscale};
use crate::fit::solve::{DEFAULT_RESIDUAL, Size, norm, unscaled};
use crate::fit::{CurveFit, CurveOptions, fit_curve, interpolate};
use crate::geometry::Curve;
use crate::iteration::{HistoryEntry, ROUNDING};
use crate::knots::{KnotPlacement, place_knots};
use crate::memory;
use crate::parameters::Parameters;
use crate::points::{Extent, Points, PointsView};
use crate::projection::largest_deviation;
use crate::report::{CurveReport, RunReport};

/// An error that says what cannot be edited.
fn refused(with: &'static str, why: &'static str) -> Error {
    Error::Incompatible { what: "editing point by point", with, why }
}

impl EditableCurve {
    /// Fits all points, to be edited from then on.
    ///
    /// # Errors
    /// As [`fit_curve`]; [`Error::Incompatible`] for closed curves, knots that are not averaged,
    /// rational weights, and whatever else does not give one control point per data point.
    pub fn new<'a>(
        points: impl Into<PointsView<'a>>,
        options: &CurveOptions,
    ) -> Result<Self, Error> {
        if options.closed {
            return Err(refused("a closed curve", "it is done for open curves only"));
        }
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
        if curve.is_periodic() {
            return Err(refused("a closed curve", "it is done for open curves only"));
        }
        if curve.rational_weights().is_some() {
            return Err(refused("rational weights", "it is done for polynomial curves only"));
        }
        let dimension = points.dimension();
        let data: Vec<f64> = match &fit.kept_points {
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
        let parameters = Parameters::open(fit.parameters.clone())?;
        let knots = place_knots(curve.degree(), &parameters, &KnotPlacement::Averaged)?;
        if knots != *curve.knots() {
            return Err(refused(
                "these knots",
                "only averaged ones follow from parameters nearby; leave the knots to gimfit",
            ));
        }
        let extent = Extent::of(PointsView::new(dimension, &data)?)?;
        let scale = Size::of(extent).scale;
        let data = scale.apply(&data);
        let extent = Extent::of(PointsView::new(dimension, &data)?)?;
        let control = scale.apply(curve.control_points().coordinates());
        let operator = interpolation(&parameters, &knots)?.operator;
        let mut vectors = memory::zeros(data.len());
        let norms = operator.difference_vectors(&data, &control, dimension, &mut vectors);

        // Row sums of the inverse without its signs, which are those of a chessboard.
        let signs: Vec<f64> =
            (0..count).map(|j| if j.is_multiple_of(2) { 1.0 } else { -1.0 }).collect();
        let sums = interpolate(
            PointsView::new(1, &signs)?,
            parameters,
            knots,
            &CurveOptions { degree: curve.degree(), ..CurveOptions::default() },
        )?;
        let row_sums = sums.curve.control_points().coordinates();
        let mut rows = memory::with_capacity(count * (2 * dimension + 2));
        for j in 0..count {
            rows.extend([fit.parameters[j], row_sums[j] * signs[j]]);
            rows.extend_from_slice(&data[j * dimension..][..dimension]);
            rows.extend_from_slice(&control[j * dimension..][..dimension]);
        }
        let largest = data.iter().chain(&*control).fold(0.0, |most: f64, x| most.max(x.abs()));
        Ok(Self {
            degree: curve.degree(),
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
                row_sum_residual: sums.report.run.max_residual,
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
        let parameters = Parameters::open(self.parameters())?;
        let knots = place_knots(self.degree, &parameters, &KnotPlacement::Averaged)?;
        let operator = interpolation(&parameters, &knots)?.operator;
        let (data, control) = (self.columns(2), self.columns(2 + dimension));
        let mut vectors = memory::zeros(data.len());
        let norms = operator.difference_vectors(&data, &control, dimension, &mut vectors);
        let values = parameters.into_values();
        let view = PointsView::new(dimension, &data)?;
        let extent = Extent::of(view)?;
        let rounding = ROUNDING * extent.largest_coordinate();
        let target = self.demanded.unwrap_or(DEFAULT_RESIDUAL * extent.diagonal()).max(rounding);
        let curve = Curve::new(knots, Points::new(dimension, control)?)?;
        let (max_deviation, max_deviation_index) = if norms.max <= rounding {
            // Down there a foot point is decided by rounding; the residual bounds the distance.
            (norms.max, norms.max_index)
        } else {
            let residuals: Vec<f64> = vectors.chunks_exact(dimension).map(norm).collect();
            largest_deviation(&curve, view, &values, &residuals)?
        };
        let Account { edits, iterations, termination, .. } = self.account;
        let bound = self.bound();
        let within = if bound.is_finite() {
            format!("no control point is farther than {bound:.1e} from the fit of all points")
        } else {
            "with parameters this close together, how far control points are from the fit of all \
             points has no bound"
                .into()
        };
        let (max_residual, rms_residual) = (scale.undo(norms.max), scale.undo(norms.rms));
        let run = RunReport {
            method: "local",
            choices: vec![format!(
                "edits: {edits}, each by local PIA of the points near it; {within}"
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
            closed: false,
            parameterization: self.parameterization,
            knot_placement: "averaged",
            spacing_ratio: spacing_ratio(&values, None),
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
