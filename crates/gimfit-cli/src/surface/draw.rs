//! From a fitted surface to the figure of it.

use super::Job;
use gimfit::Surface;
use gimfit_io::surface_figure::{SurfaceFigure, surface_figure_svg};
use std::path::Path;

/// Samples per span of knots, and the most in one direction.
const PER_SPAN: usize = 4;
const MOST_SAMPLES: usize = 96;

/// The figure as SVG.
pub(super) fn figure(job: &Job<'_>) -> String {
    let (fit, grid, report) = (job.fit, job.grid, &job.fit.report);
    let surface = &fit.surface;
    let mesh = [0, 1].map(|k| {
        let knots = &surface.knots()[k];
        let count = knots.nonempty_spans().count() * PER_SPAN + 1;
        knots.equal_steps(count.clamp(25, MOST_SAMPLES))
    });
    let mesh_points = sample(surface, &mesh);
    let name = Path::new(&grid.source).file_name().map(|name| name.to_string_lossy().into_owned());
    let title = grid.title.clone().or(name).unwrap_or_else(|| grid.source.clone());
    let caption = format!(
        "degrees {} and {}, {} x {} points, {} x {} control points, {}, {} iteration{}, largest \
         residual {:.2e}",
        report.degrees[0],
        report.degrees[1],
        report.points[0],
        report.points[1],
        report.control_points[0],
        report.control_points[1],
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
    // A closed direction stores its first rows or columns again.
    let free = free_shape(surface);
    let greville = [0, 1].map(|k| surface.knots()[k].greville_abscissae()[..free[k]].to_vec());
    let data = fitted_points(job);
    surface_figure_svg(&SurfaceFigure {
        title: &title,
        caption: &caption,
        dimension: report.dimension,
        coordinate_names: &grid.column_names,
        closed: report.closed,
        data_shape: report.points,
        data_points: &data,
        parameters: [&fit.parameters[0], &fit.parameters[1]],
        net_shape: free,
        control_net: &free_net(job),
        net_abscissae: [&greville[0], &greville[1]],
        mesh_shape: [mesh[0].len(), mesh[1].len()],
        mesh_parameters: [&mesh[0], &mesh[1]],
        mesh_points: &mesh_points,
        residuals: &fit.residuals(),
        extent: report.run.extent,
        history: &history,
    })
}

fn free_shape(surface: &Surface) -> [usize; 2] {
    [0, 1].map(|k| {
        let stored = surface.control_net().shape()[k];
        if surface.is_periodic()[k] { stored - surface.degrees()[k] } else { stored }
    })
}

/// The control points that are free, row by row.
fn free_net(job: &Job<'_>) -> Vec<f64> {
    let surface = &job.fit.surface;
    if let Some(blending) = &job.document.blending {
        // Of the bases that were fitted, not of their Bezier form.
        return blending.control_points.iter().flat_map(|row| row.values.clone()).collect();
    }
    let [rows, columns] = free_shape(surface);
    (0..rows)
        .flat_map(|i| (0..columns).flat_map(move |j| surface.control_net().point(i, j)))
        .copied()
        .collect()
}

/// The points fitted: all but a repeated last row or column.
fn fitted_points(job: &Job<'_>) -> Vec<f64> {
    let ([rows, columns], dimension) = (job.fit.report.points, job.grid.dimension());
    (0..rows)
        .flat_map(|i| {
            &job.grid.coordinates[i * job.grid.columns * dimension..][..columns * dimension]
        })
        .copied()
        .collect()
}

/// Points of the surface at all pairs of parameters, row by row.
pub(super) fn sample(surface: &Surface, parameters: &[Vec<f64>; 2]) -> Vec<f64> {
    let dimension = surface.dimension();
    let mut points = vec![0.0; parameters[0].len() * parameters[1].len() * dimension];
    let mut places = points.chunks_exact_mut(dimension);
    for &u in &parameters[0] {
        for &v in &parameters[1] {
            if let Some(point) = places.next() {
                // The parameters come from the surface's own domain.
                let _ = surface.evaluate_into(u, v, point);
            }
        }
    }
    points
}
