//! From a fit to the figure of it.

use super::Job;
use std::path::Path;

use gimfit_io::figure::{CurveFigure, CurveSamples, SequenceCurve, curve_figure_svg};

/// Samples per span of knots, and the most in all.
const PER_SPAN: usize = 12;
const MOST_SAMPLES: usize = 40_000;

/// The figure as SVG.
pub(super) fn figure(job: &Job<'_>) -> String {
    let (fit, table, report) = (job.fit, job.table, &job.fit.report);
    let curve = &fit.curve;
    let dimension = curve.dimension();
    let count = (curve.knots().nonempty_spans().count() * PER_SPAN + 1).clamp(200, MOST_SAMPLES);
    let parameters = curve.equal_steps(count);
    let samples = sample(curve, &parameters);
    let beziers = if dimension == 2 && curve.knots().values().len() < MOST_SAMPLES {
        curve.bezier_pieces()
    } else {
        None
    };
    let free = curve.free_control_points();
    // Of the basis that was fitted, not of its Bezier form.
    let control_points = match &job.document.blending {
        Some(blending) => blending.control_points.values.as_slice(),
        None => &curve.control_points().coordinates()[..free * dimension],
    };
    let greville = curve.knots().greville_abscissae();
    let data = fitted_points(job);
    let history: Vec<(usize, f64, f64)> = report
        .run
        .history
        .iter()
        .filter(|entry| entry.max_residual.is_finite() && entry.rms_residual.is_finite())
        .map(|entry| (entry.iteration, entry.max_residual, entry.rms_residual))
        .collect();
    let normal_history: Vec<(usize, f64)> = report
        .run
        .history
        .iter()
        .filter_map(|entry| Some((entry.iteration, entry.normal_residual?)))
        .filter(|(_, normal)| normal.is_finite())
        .collect();
    let earlier: Vec<(usize, Vec<f64>)> = fit
        .sequence
        .iter()
        .filter_map(|kept| {
            let earlier = curve.with_control_points(kept.control_points.clone()).ok()?;
            Some((kept.entry.iteration, sample(&earlier, &parameters)))
        })
        .collect();
    let sequence: Vec<SequenceCurve<'_>> = earlier
        .iter()
        .map(|(iteration, points)| SequenceCurve {
            iteration: *iteration,
            curve: CurveSamples { parameters: &parameters, points, beziers: None },
        })
        .collect();
    // A picture needs the file's name, not the way to it.
    let name = Path::new(&table.source).file_name().map(|name| name.to_string_lossy());
    let title = match (&table.title, name) {
        (Some(title), _) => title.clone(),
        (None, Some(name)) => name.into_owned(),
        (None, None) => table.source.clone(),
    };
    let basis = job.document.blending.as_ref().map(|blending| format!("{} of ", blending.basis));
    let caption = format!(
        "{}{}, {} points, {} control points, {}, {} iteration{}, largest residual {:.2e}",
        basis.unwrap_or_default(),
        degree_name(report.degree),
        report.points,
        report.control_points,
        report.run.method,
        report.run.iterations,
        if report.run.iterations == 1 { "" } else { "s" },
        report.run.max_residual
    );
    let residuals = fit.residuals();
    curve_figure_svg(&CurveFigure {
        title: &title,
        caption: &caption,
        dimension,
        coordinate_names: &table.column_names,
        parameter_name: table.abscissa_name.as_deref().unwrap_or("parameter"),
        closed: report.closed,
        data_points: &data,
        parameters: &fit.parameters,
        control_points,
        abscissae_of_control_points: &greville[..free],
        curve_samples: CurveSamples {
            parameters: &parameters,
            points: &samples,
            beziers: beziers.as_deref(),
        },
        residuals: &residuals,
        extent: report.run.extent,
        history: &history,
        normal_history: &normal_history,
        sequence: &sequence,
    })
}

/// The data points fitted: the curve at their parameters plus their difference vectors would be
/// the same up to rounding, but the data themselves are at hand.
fn fitted_points(job: &Job<'_>) -> Vec<f64> {
    let (table, fit) = (job.table, job.fit);
    let dimension = table.dimension();
    match &fit.kept_points {
        None => table.coordinates[..fit.report.points * dimension].to_vec(),
        Some(kept) => kept
            .iter()
            .flat_map(|&row| &table.coordinates[row * dimension..][..dimension])
            .copied()
            .collect(),
    }
}

fn sample(curve: &gimfit::Curve, parameters: &[f64]) -> Vec<f64> {
    let dimension = curve.dimension();
    let mut points = vec![0.0; parameters.len() * dimension];
    for (point, &t) in points.chunks_exact_mut(dimension).zip(parameters) {
        // The parameters come from the curve's own domain.
        let _ = curve.evaluate_into(t, point);
    }
    points
}

fn degree_name(degree: usize) -> String {
    match degree {
        1 => "linear".into(),
        2 => "quadratic".into(),
        3 => "cubic".into(),
        4 => "quartic".into(),
        5 => "quintic".into(),
        _ => format!("degree {degree}"),
    }
}
