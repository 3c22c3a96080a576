//! A kept fit as a whole: its own geometry, difference vectors and report, measured anew.

use super::solve::{Size, norm};
use super::triangle::places;
use super::{CurveFit, KeptFit, SurfaceFit, TriangleFit};
use crate::Error;
use crate::geometry::TriangularPatch;
use crate::iteration::{HistoryEntry, Termination};
use crate::points::{Extent, PointGrid, Points, PointsView};
use crate::projection::{
    largest_deviation, largest_surface_deviation_from, largest_triangle_deviation,
};
use crate::report::{LeastSquaresReport, RunReport};

impl CurveFit {
    /// The fit kept at an iteration as a fit of its own: the curve, its difference vectors, and a
    /// report with the residuals and the deviation of that curve. What was fitted, and over which
    /// parameters and knots, is the same: of geometric interpolation, the parameters are the last
    /// ones, so that the residuals are not those from the foot points of that curve.
    ///
    /// # Errors
    /// [`Error::NotKept`] for an iteration that [`CurveOptions::keep`](super::CurveOptions::keep)
    /// did not ask for, or that the run did not reach.
    ///
    /// # Examples
    /// ```
    /// use gimfit::{CurveOptions, fit_curve};
    /// let points = [[0.0, 0.0], [1.0, 2.0], [3.0, 3.0], [4.0, 1.0], [6.0, 0.0]];
    /// let options = CurveOptions { keep: vec![0, 5], ..Default::default() };
    /// let member = fit_curve(&points, &options)?.member(5)?;
    /// assert_eq!(member.report.run.iterations, 5);
    /// assert!(member.report.max_deviation <= member.report.run.max_residual);
    /// # Ok::<(), gimfit::Error>(())
    /// ```
    pub fn member(&self, iteration: usize) -> Result<CurveFit, Error> {
        let kept = kept(&self.sequence, iteration)?;
        let dimension = self.curve.dimension();
        let curve = self.curve.with_control_points(kept.control_points.clone())?;
        let mut vectors = self.difference_vectors.coordinates().to_vec();
        // The data, from the fit that was returned and what it left.
        let mut data = vectors.clone();
        let mut ours = vec![0.0; dimension];
        let mut theirs = vec![0.0; dimension];
        let each = vectors.chunks_exact_mut(dimension).zip(data.chunks_exact_mut(dimension));
        for ((vector, point), &t) in each.zip(&self.parameters) {
            self.curve.evaluate_into(t, &mut theirs)?;
            curve.evaluate_into(t, &mut ours)?;
            for i in 0..dimension {
                point[i] += theirs[i];
                vector[i] += theirs[i] - ours[i];
            }
        }
        let measured = measure(&data, &vectors, dimension, |size, view, residuals| {
            let control = size.scale.apply(kept.control_points.coordinates()).into_owned();
            let curve = curve.with_control_points(Points::new(dimension, control)?)?;
            largest_deviation(&curve, view, &self.parameters, residuals)
        })?;
        let mut report = self.report.clone();
        report.run = run_of(&self.report.run, &measured, iteration);
        report.max_residual_index = measured.max_residual.1;
        (report.max_deviation, report.max_deviation_index) = measured.max_deviation;
        Ok(CurveFit {
            curve,
            parameters: self.parameters.clone(),
            kept_points: self.kept_points.clone(),
            difference_vectors: Points::new(dimension, vectors)?,
            report,
            sequence: Vec::new(),
        })
    }
}

impl SurfaceFit {
    /// The fit kept at an iteration as a fit of its own, as [`CurveFit::member`].
    ///
    /// # Errors
    /// As [`CurveFit::member`].
    pub fn member(&self, iteration: usize) -> Result<SurfaceFit, Error> {
        let kept = kept(&self.sequence, iteration)?;
        let dimension = self.surface.dimension();
        let shape = self.surface.control_net().shape();
        let net = |control: Vec<f64>| PointGrid::new(shape, dimension, control);
        let surface =
            self.surface.with_control_net(net(kept.control_points.coordinates().to_vec())?)?;
        let [rows, columns] = self.parameters.each_ref().map(|t| t.as_slice());
        let mut vectors = self.difference_vectors.coordinates().to_vec();
        let mut data = vectors.clone();
        let mut ours = vec![0.0; dimension];
        let mut theirs = vec![0.0; dimension];
        let places: Vec<[f64; 2]> = match &self.foot_parameters {
            Some(pairs) => pairs.clone(),
            None => rows.iter().flat_map(|&u| columns.iter().map(move |&v| [u, v])).collect(),
        };
        let each = vectors.chunks_exact_mut(dimension).zip(data.chunks_exact_mut(dimension));
        for ((vector, point), &[u, v]) in each.zip(&places) {
            self.surface.evaluate_into(u, v, &mut theirs)?;
            surface.evaluate_into(u, v, &mut ours)?;
            for i in 0..dimension {
                point[i] += theirs[i];
                vector[i] += theirs[i] - ours[i];
            }
        }
        let measured = measure(&data, &vectors, dimension, |size, view, residuals| {
            let control = size.scale.apply(kept.control_points.coordinates()).into_owned();
            let surface = surface.with_control_net(net(control)?)?;
            largest_surface_deviation_from(&surface, view, &places, residuals)
        })?;
        let cell = |index: usize| [index / columns.len(), index % columns.len()];
        let mut report = self.report.clone();
        report.run = run_of(&self.report.run, &measured, iteration);
        report.max_residual_index = cell(measured.max_residual.1);
        report.max_deviation = measured.max_deviation.0;
        report.max_deviation_index = cell(measured.max_deviation.1);
        Ok(SurfaceFit {
            surface,
            parameters: self.parameters.clone(),
            foot_parameters: self.foot_parameters.clone(),
            difference_vectors: Points::new(dimension, vectors)?,
            report,
            sequence: Vec::new(),
        })
    }
}

impl TriangleFit {
    /// The fit kept at an iteration as a fit of its own, as [`CurveFit::member`].
    ///
    /// # Errors
    /// As [`CurveFit::member`].
    pub fn member(&self, iteration: usize) -> Result<TriangleFit, Error> {
        let kept = kept(&self.sequence, iteration)?;
        let (degree, dimension) = (self.report.degree, self.patch.dimension());
        let patch = TriangularPatch::new(degree, kept.control_points.clone())?;
        let places = places(degree);
        let mut vectors = self.difference_vectors.coordinates().to_vec();
        let mut data = vectors.clone();
        let each = vectors.chunks_exact_mut(dimension).zip(data.chunks_exact_mut(dimension));
        for ((vector, point), &[u, v]) in each.zip(&places) {
            let (theirs, ours) = (self.patch.evaluate(u, v)?, patch.evaluate(u, v)?);
            for i in 0..dimension {
                point[i] += theirs[i];
                vector[i] += theirs[i] - ours[i];
            }
        }
        let measured = measure(&data, &vectors, dimension, |size, view, residuals| {
            let control = size.scale.apply(kept.control_points.coordinates()).into_owned();
            let patch = TriangularPatch::new(degree, Points::new(dimension, control)?)?;
            largest_triangle_deviation(&patch, view, &places, residuals)
        })?;
        let mut report = self.report.clone();
        report.run = run_of(&self.report.run, &measured, iteration);
        report.max_residual_index = measured.max_residual.1;
        (report.max_deviation, report.max_deviation_index) = measured.max_deviation;
        Ok(TriangleFit {
            patch,
            difference_vectors: Points::new(dimension, vectors)?,
            report,
            sequence: Vec::new(),
        })
    }
}

fn kept(sequence: &[KeptFit], iteration: usize) -> Result<&KeptFit, Error> {
    sequence.iter().find(|kept| kept.entry.iteration == iteration).ok_or_else(|| Error::NotKept {
        iteration,
        kept: sequence.iter().map(|kept| kept.entry.iteration).collect(),
    })
}

/// The errors of one member, in the unit of the data.
struct Measured {
    max_residual: (f64, usize),
    rms_residual: f64,
    max_deviation: (f64, usize),
}

/// Measures difference vectors; `deviation` looks for the foot points, on data that are scaled.
fn measure(
    data: &[f64],
    vectors: &[f64],
    dimension: usize,
    deviation: impl FnOnce(&Size, PointsView<'_>, &[f64]) -> Result<(f64, usize), Error>,
) -> Result<Measured, Error> {
    let size = Size::of(Extent::of(PointsView::new(dimension, data)?)?);
    let scale = size.scale;
    let (data, vectors) = (scale.apply(data), scale.apply(vectors));
    let residuals: Vec<f64> = vectors.chunks_exact(dimension).map(norm).collect();
    let worst =
        (0..residuals.len()).fold(0, |w, j| if residuals[j] > residuals[w] { j } else { w });
    let mean = residuals.iter().map(|r| r * r).sum::<f64>() / residuals.len() as f64;
    let largest = if residuals[worst] <= size.rounding_level() {
        // Down there a foot point is decided by rounding; the residual bounds the distance.
        (residuals[worst], worst)
    } else {
        deviation(&size, PointsView::new(dimension, &data)?, &residuals)?
    };
    Ok(Measured {
        max_residual: (scale.undo(residuals[worst]), worst),
        rms_residual: scale.undo(mean.sqrt()),
        max_deviation: (scale.undo(largest.0), largest.1),
    })
}

/// The account of the run up to an iteration. Its residuals are those of all points, of local PIA, too.
fn run_of(run: &RunReport, measured: &Measured, iteration: usize) -> RunReport {
    // Of a least squares fit what was seen on the way counts: residuals stay.
    let seen = run.history.iter().rev().find(|entry| entry.iteration <= iteration);
    let least_squares = run.least_squares.map(|account| LeastSquaresReport {
        normal_residual: seen.map_or(f64::NAN, HistoryEntry::to_limit),
        ..account
    });
    let to_limit = least_squares.map_or(measured.max_residual.0, |account| account.normal_residual);
    let met = run.residual_target > 0.0 && to_limit <= run.residual_target;
    let mut choices = run.choices.clone();
    choices.push(format!(
        "family: the fit after {iteration} of {} iterations of a run that ended by {}",
        run.iterations, run.termination
    ));
    RunReport {
        choices,
        iterations: iteration,
        iteration_returned: iteration,
        termination: if met { Termination::Residual } else { Termination::Iterations },
        max_residual: measured.max_residual.0,
        rms_residual: measured.rms_residual,
        local: None,
        least_squares,
        history: run.history.iter().filter(|entry| entry.iteration <= iteration).copied().collect(),
        ..run.clone()
    }
}
