//! From a fitted triangular patch to the figure of it, drawn as a surface whose rows shrink to a
//! corner.

use super::Job;
use gimfit::geometry::{TriangularPatch, triangle_points};
use gimfit_io::surface_figure::{SurfaceFigure, surface_figure_svg};
use std::path::Path;

/// Rows of samples, and samples in each.
const SAMPLES: usize = 37;

/// The figure as SVG.
pub(super) fn figure(job: &Job<'_>) -> String {
    let (fit, table, report) = (job.fit, job.table, &job.fit.report);
    let (dimension, rows) = (report.dimension, report.degree + 1);
    let name = Path::new(&table.source).file_name().map(|name| name.to_string_lossy().into_owned());
    let title = table.title.clone().or(name).unwrap_or_else(|| table.source.clone());
    let caption = format!(
        "triangular patch of degree {}, {} points, {}, {} iteration{}, largest residual {:.2e}",
        report.degree,
        report.points,
        report.run.method,
        report.run.iterations,
        if report.run.iterations == 1 { "" } else { "s" },
        report.run.max_residual
    );
    let history: Vec<(usize, f64, f64)> = report
        .run
        .history
        .iter()
        .filter(|entry| entry.max_residual.is_finite() && entry.rms_residual.is_finite())
        .map(|entry| (entry.iteration, entry.max_residual, entry.rms_residual))
        .collect();
    // Heights stand over the triangle's own plane.
    let lift = |flat: &[f64], count: usize| flat[..count * dimension].to_vec();
    let net = lift(fit.patch.control_points().coordinates(), triangle_points(report.degree));
    let data = lift(&table.coordinates, report.points);
    let (net, data) = (standing(&net, rows, dimension), standing(&data, rows, dimension));
    let drawn = if dimension == 1 { 3 } else { dimension };
    let names = if dimension == 1 {
        let height = table.column_names.first().cloned().unwrap_or_else(|| "z".into());
        vec!["v".to_owned(), "w".to_owned(), height]
    } else {
        table.column_names.clone()
    };
    surface_figure_svg(&SurfaceFigure {
        title: &title,
        caption: &caption,
        dimension: drawn,
        coordinate_names: &names,
        closed: [false, false],
        data_shape: [rows, rows],
        data_points: &square(&data, rows, drawn, false),
        parameters: [&[], &[]],
        net_shape: [rows, rows],
        control_net: &square(&net, rows, drawn, true),
        net_abscissae: [&[], &[]],
        mesh_shape: [SAMPLES, SAMPLES],
        mesh_parameters: [&[], &[]],
        mesh_points: &mesh(&fit.patch),
        residuals: &square(&fit.residuals(), rows, 1, false),
        extent: report.run.extent,
        history: &history,
        triangle: true,
        stages: None,
        sequence: &[],
    })
}

/// Points in space: single heights get their barycentric v and w in front.
fn standing(flat: &[f64], rows: usize, dimension: usize) -> Vec<f64> {
    if dimension != 1 {
        return flat.to_vec();
    }
    let last = (rows - 1).max(1) as f64;
    let places = (0..rows).flat_map(|row| (0..=row).map(move |column| (row - column, column)));
    places
        .zip(flat)
        .flat_map(|((j, k), height)| [j as f64 / last, k as f64 / last, *height])
        .collect()
}

/// A triangle as the lower half of a square, row by row. What is missing is no number or, for nets,
/// the last point of the row again, so that the slanted edge is drawn.
fn square(flat: &[f64], rows: usize, dimension: usize, repeat: bool) -> Vec<f64> {
    let mut points = Vec::with_capacity(rows * rows * dimension);
    let mut start = 0;
    for row in 0..rows {
        let line = &flat[start..start + (row + 1) * dimension];
        points.extend_from_slice(line);
        for _ in row + 1..rows {
            if repeat {
                points.extend_from_slice(&line[row * dimension..]);
            } else {
                points.extend(std::iter::repeat_n(f64::NAN, dimension));
            }
        }
        start += line.len();
    }
    points
}

/// Samples in rows that grow from the corner u = 1, all of the same number.
fn mesh(patch: &TriangularPatch) -> Vec<f64> {
    let last = (SAMPLES - 1) as f64;
    let mut points = Vec::new();
    for i in 0..SAMPLES {
        for j in 0..SAMPLES {
            let depth = i as f64 / last;
            let (u, w) = (1.0 - depth, depth * (j as f64 / last));
            let v = (depth - w).max(0.0);
            // The places come from the triangle itself.
            let point = patch.evaluate(u, v).unwrap_or_default();
            if patch.dimension() == 1 {
                points.extend([v, w]);
            }
            points.extend(point);
        }
    }
    points
}
