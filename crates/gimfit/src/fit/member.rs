//! A kept fit as a whole: its own geometry, difference vectors and report, measured anew.

use super::curve::spacing_ratio;
use super::geometric::{curve_sentences, surface_sentences};
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
use crate::report::{FootPointReport, LeastSquaresReport, LocalReport, RunReport};

impl CurveFit {
    /// The fit kept at an iteration as a fit of its own: the curve, its difference vectors, and a
    /// report with the residuals and the deviation of that curve. What was fitted, and over which
    /// knots, is the same; so are the parameters, but for geometric interpolation, where they are those
    /// of the foot points on that curve.
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
        let moved = kept.foot_points.as_ref().and_then(|points| points.parameters.as_ref());
        let parameters = moved.unwrap_or(&self.parameters);
        let each = vectors.chunks_exact_mut(dimension).zip(data.chunks_exact_mut(dimension));
        for ((vector, point), (&t, &last)) in each.zip(parameters.iter().zip(&self.parameters)) {
            self.curve.evaluate_into(last, &mut theirs)?;
            curve.evaluate_into(t, &mut ours)?;
            for i in 0..dimension {
                point[i] += theirs[i];
                vector[i] += theirs[i] - ours[i];
            }
        }
        let chosen = chosen_of(&self.report.run);
        let measured = measure(&data, &vectors, dimension, chosen, |size, view, residuals| {
            let control = size.scale.apply(kept.control_points.coordinates()).into_owned();
            let curve = curve.with_control_points(Points::new(dimension, control)?)?;
            largest_deviation(&curve, view, parameters, residuals)
        })?;
        let mut report = self.report.clone();
        report.run = run_of(&self.report.run, &measured, kept, curve_sentences);
        if moved.is_some() {
            let domain = self.curve.domain();
            let period = self.curve.is_periodic().then_some(domain.1 - domain.0);
            report.spacing_ratio = spacing_ratio(&rising(parameters, period), period);
        }
        report.max_residual_index = measured.max_residual.1;
        (report.max_deviation, report.max_deviation_index) = measured.max_deviation;
        Ok(CurveFit {
            curve,
            parameters: parameters.clone(),
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
        let places_of = |own: Option<Vec<[f64; 2]>>| -> Vec<[f64; 2]> {
            own.unwrap_or_else(|| {
                rows.iter().flat_map(|&u| columns.iter().map(move |&v| [u, v])).collect()
            })
        };
        let last = places_of(self.foot_parameters.clone());
        let foot_parameters = match &kept.foot_points {
            None => self.foot_parameters.clone(),
            Some(points) => points.parameters.as_ref().map(|flat| {
                flat.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect::<Vec<_>>()
            }),
        };
        let places = places_of(foot_parameters.clone());
        let each = vectors.chunks_exact_mut(dimension).zip(data.chunks_exact_mut(dimension));
        for ((vector, point), (&[u, v], &[last_u, last_v])) in each.zip(places.iter().zip(&last)) {
            self.surface.evaluate_into(last_u, last_v, &mut theirs)?;
            surface.evaluate_into(u, v, &mut ours)?;
            for i in 0..dimension {
                point[i] += theirs[i];
                vector[i] += theirs[i] - ours[i];
            }
        }
        let chosen = chosen_of(&self.report.run);
        let measured = measure(&data, &vectors, dimension, chosen, |size, view, residuals| {
            let control = size.scale.apply(kept.control_points.coordinates()).into_owned();
            let surface = surface.with_control_net(net(control)?)?;
            largest_surface_deviation_from(&surface, view, &places, residuals)
        })?;
        let cell = |index: usize| [index / columns.len(), index % columns.len()];
        let mut report = self.report.clone();
        report.run = run_of(&self.report.run, &measured, kept, |report| {
            surface_sentences(report, columns.len())
        });
        report.max_residual_index = cell(measured.max_residual.1);
        report.max_deviation = measured.max_deviation.0;
        report.max_deviation_index = cell(measured.max_deviation.1);
        Ok(SurfaceFit {
            surface,
            parameters: self.parameters.clone(),
            foot_parameters,
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
        let measured = measure(&data, &vectors, dimension, None, |size, view, residuals| {
            let control = size.scale.apply(kept.control_points.coordinates()).into_owned();
            let patch = TriangularPatch::new(degree, Points::new(dimension, control)?)?;
            largest_triangle_deviation(&patch, view, &places, residuals)
        })?;
        let mut report = self.report.clone();
        report.run = run_of(&self.report.run, &measured, kept, |_| Vec::new());
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

/// The points that local PIA iterated, if it ran.
fn chosen_of(run: &RunReport) -> Option<&[usize]> {
    run.local.as_ref().map(|local| local.chosen.as_slice())
}

/// Parameters inside the domain of a closed curve, unrolled so that they rise.
fn rising(parameters: &[f64], period: Option<f64>) -> Vec<f64> {
    let first = parameters.first().copied().unwrap_or_default();
    let lap = |t: f64| if t < first { period.unwrap_or_default() } else { 0.0 };
    parameters.iter().map(|&t| t + lap(t)).collect()
}

/// The errors of one member, in the unit of the data.
struct Measured {
    /// Of the points iterated.
    max_residual: (f64, usize),
    rms_residual: f64,
    /// Of all points.
    max_deviation: (f64, usize),
    /// The points iterated and the largest residual of the others, where not all were.
    local: Option<LocalReport>,
}

/// Measures difference vectors, of local PIA as its run does; `deviation` looks for the foot points,
/// on data that are scaled.
fn measure(
    data: &[f64],
    vectors: &[f64],
    dimension: usize,
    chosen: Option<&[usize]>,
    deviation: impl FnOnce(&Size, PointsView<'_>, &[f64]) -> Result<(f64, usize), Error>,
) -> Result<Measured, Error> {
    let size = Size::of(Extent::of(PointsView::new(dimension, data)?)?);
    let scale = size.scale;
    let (data, vectors) = (scale.apply(data), scale.apply(vectors));
    let residuals: Vec<f64> = vectors.chunks_exact(dimension).map(norm).collect();
    let mut counts = vec![chosen.is_none(); residuals.len()];
    chosen.unwrap_or_default().iter().for_each(|&j| counts[j] = true);
    let counts = &counts;
    let of = |counted: bool| (0..residuals.len()).filter(move |&j| counts[j] == counted);
    let worst = |all: &mut dyn Iterator<Item = usize>| {
        all.reduce(|w, j| if residuals[j] > residuals[w] { j } else { w })
    };
    let inside = worst(&mut of(true)).unwrap_or_default();
    let outside = worst(&mut of(false));
    let count = of(true).count().max(1) as f64;
    let mean = of(true).map(|j| residuals[j] * residuals[j]).sum::<f64>() / count;
    let largest = if chosen.is_none() && residuals[inside] <= size.rounding_level() {
        // Down there a foot point is decided by rounding; the residual bounds the distance.
        (residuals[inside], inside)
    } else {
        deviation(&size, PointsView::new(dimension, &data)?, &residuals)?
    };
    Ok(Measured {
        max_residual: (scale.undo(residuals[inside]), inside),
        rms_residual: scale.undo(mean.sqrt()),
        max_deviation: (scale.undo(largest.0), largest.1),
        local: chosen.map(|chosen| LocalReport {
            chosen: chosen.to_vec(),
            outside_max_residual: outside.map_or(0.0, |j| scale.undo(residuals[j])),
            outside_max_residual_index: outside.unwrap_or_default(),
        }),
    })
}

/// The account of the run up to a kept fit; `sentences`: what a report says of foot points.
fn run_of(
    run: &RunReport,
    measured: &Measured,
    kept: &KeptFit,
    sentences: impl Fn(&FootPointReport) -> Vec<String>,
) -> RunReport {
    let iteration = kept.entry.iteration;
    // Of a least squares fit what was seen on the way counts: residuals stay.
    let seen = run.history.iter().rev().find(|entry| entry.iteration <= iteration);
    let least_squares = run.least_squares.map(|account| LeastSquaresReport {
        normal_residual: seen.map_or(f64::NAN, HistoryEntry::to_limit),
        ..account
    });
    let to_limit = least_squares.map_or(measured.max_residual.0, |account| account.normal_residual);
    let met = run.residual_target > 0.0 && to_limit <= run.residual_target;
    let mut choices = run.choices.clone();
    if let (Some(last), Some(then)) = (&run.foot_points, &kept.foot_points) {
        let of_the_end = sentences(last);
        choices.retain(|choice| !of_the_end.contains(choice));
        choices.extend(sentences(&then.report));
    }
    choices.push(format!(
        "family: the fit after {iteration} of {} iterations of a run that ended by {}",
        run.iterations, run.termination
    ));
    let foot_points = kept.foot_points.as_ref();
    RunReport {
        choices,
        iterations: iteration,
        iteration_returned: iteration,
        termination: if met { Termination::Residual } else { Termination::Iterations },
        max_residual: measured.max_residual.0,
        rms_residual: measured.rms_residual,
        smallest_eigenvalue: match foot_points {
            Some(points) => points.smallest_eigenvalue,
            None => run.smallest_eigenvalue,
        },
        foot_points: foot_points.map(|points| points.report),
        local: measured.local.clone(),
        least_squares,
        history: run.history.iter().filter(|entry| entry.iteration <= iteration).copied().collect(),
        ..run.clone()
    }
}
