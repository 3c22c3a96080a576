//! From a fitted surface to the figure of it.

use super::Job;
use gimfit::{HistoryEntry, Surface};
use gimfit_io::surface_figure::{Member, SurfaceFigure, surface_figure_svg};
use std::path::Path;

/// Samples per span of knots, and the most of a picture.
const PER_SPAN: usize = 4;
const MOST_SAMPLES: usize = 2600;
/// Fewest samples in a direction.
const FEWEST: usize = 25;

/// The figure as SVG.
pub(super) fn figure(job: &Job<'_>) -> String {
    let (fit, grid, report) = (job.fit, job.grid, &job.fit.report);
    let surface = &fit.surface;
    let counts = mesh_shape([0, 1].map(|k| surface.knots()[k].nonempty_spans().count()));
    let mesh = [0, 1].map(|k| surface.knots()[k].equal_steps(counts[k]));
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
    let of = |entry: &HistoryEntry, before: usize| {
        let entry = HistoryEntry { iteration: entry.iteration + before, ..*entry };
        (entry.iteration, entry.max_residual, entry.rms_residual)
    };
    // One direction after the other: the history of both stages, one after the other.
    let first = report.stages.as_ref().map(|[first, _]| first.last().map_or(0, |e| e.iteration));
    let mut history: Vec<(usize, f64, f64)> = match (&report.stages, first) {
        (Some([columns, rows]), Some(before)) => columns
            .iter()
            .map(|entry| of(entry, 0))
            .chain(rows.iter().map(|entry| of(entry, before)))
            .collect(),
        _ => report.run.history.iter().map(|entry| of(entry, 0)).collect(),
    };
    history.retain(|(_, largest, rms)| largest.is_finite() && rms.is_finite());
    let members: Vec<(usize, Vec<f64>, Vec<f64>)> = fit
        .sequence
        .iter()
        .filter_map(|kept| {
            let member = fit.member(kept.entry.iteration).ok()?;
            Some((kept.entry.iteration, sample(&member.surface, &mesh), member.residuals()))
        })
        .collect();
    let sequence: Vec<Member<'_>> = members
        .iter()
        .map(|(iteration, mesh_points, residuals)| Member {
            iteration: *iteration,
            mesh_points,
            residuals,
        })
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
        stages: first,
        sequence: &sequence,
        triangle: false,
    })
}

/// Samples in u and v: several for each span of knots where so many can be drawn, otherwise as many
/// as can be, in proportion.
fn mesh_shape(spans: [usize; 2]) -> [usize; 2] {
    let with = |per_span: usize| spans.map(|count| (count * per_span + 1).max(FEWEST));
    for per_span in (1..=PER_SPAN).rev() {
        let [rows, columns] = with(per_span);
        if rows * columns <= MOST_SAMPLES {
            return [rows, columns];
        }
    }
    let [rows, columns] = with(1);
    let share = (MOST_SAMPLES as f64 / (rows as f64 * columns as f64)).sqrt();
    let fewer =
        |count: usize| ((count as f64 * share) as usize).clamp(FEWEST, MOST_SAMPLES / FEWEST);
    [fewer(rows), fewer(columns)]
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meshes_follow_the_knots_and_stay_small() {
        assert_eq!(mesh_shape([1, 1]), [25, 25]);
        assert_eq!(mesh_shape([8, 8]), [33, 33]);
        assert_eq!(mesh_shape([22, 21]), [45, 43]);
        for spans in [[1, 997], [100, 100], [3000, 3000], [1, 1_000_000]] {
            let [rows, columns] = mesh_shape(spans);
            assert!(rows * columns <= MOST_SAMPLES && rows.min(columns) >= FEWEST, "{spans:?}");
        }
    }
}
