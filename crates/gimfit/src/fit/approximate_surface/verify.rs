//! The figures of an approximation, measured on the finished surface.

use super::cells::{Cells, Place};
use crate::Error;
use crate::geometry::Surface;
use crate::projection::local_surface_foot_point;
use crate::report::ApproximationReport;

/// What was measured.
pub(super) struct Verified {
    /// Parameters of the foot points.
    pub(super) parameters: Vec<[f64; 2]>,
    /// Shape (points, dimension).
    pub(super) difference_vectors: Vec<f64>,
    pub(super) account: ApproximationReport,
}

/// Points named among the worst.
const WORST: usize = 5;

/// Projects all data points from their parameters; those of heights stay.
pub(super) fn verify(
    surface: &Surface,
    cells: &Cells<'_>,
    starts: impl Iterator<Item = [f64; 2]>,
) -> Result<Verified, Error> {
    let dimension = cells.dimension;
    let count = cells.shape[0] * cells.shape[1];
    let mut parameters = Vec::with_capacity(count);
    let mut difference_vectors = Vec::with_capacity(count * dimension);
    let mut distances = Vec::with_capacity(count);
    let mut place = vec![0.0; dimension];
    for (start, point) in starts.zip(cells.data.chunks_exact(dimension)) {
        if cells.in_place {
            surface.evaluate_into(start[0], start[1], &mut place)?;
            parameters.push(start);
        } else {
            let foot = local_surface_foot_point(surface, point, start)?;
            place.copy_from_slice(&foot.point);
            parameters.push(foot.parameters);
        }
        let from = difference_vectors.len();
        difference_vectors.extend(point.iter().zip(&place).map(|(q, s)| q - s));
        distances.push(crate::fit::solve::norm(&difference_vectors[from..]));
    }
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| distances[b].total_cmp(&distances[a]));
    order.truncate(WORST);
    let square: f64 = distances.iter().map(|x| x * x).sum();
    let account = ApproximationReport {
        met: false,
        max_distance: distances[order[0]],
        rms_distance: (square / count as f64).sqrt(),
        mean_distance: distances.iter().sum::<f64>() / count as f64,
        worst: order,
        overshoot: 0.0,
        calm_limit: 0.0,
        noise: None,
        outliers: Vec::new(),
        corners: Vec::new(),
        pieces: surface.knots().iter().map(|knots| knots.nonempty_spans().count()).product(),
        rounds: 0,
    };
    Ok(Verified { parameters, difference_vectors, account })
}

/// How far the surface strays from the cells of the data, sampled between parameters; `place` gives
/// the parameters of a place in a cell.
pub(super) fn overshoot(
    surface: &Surface,
    cells: &Cells<'_>,
    place: impl Fn([usize; 2], [f64; 2]) -> [f64; 2],
) -> Result<f64, Error> {
    /// Samples along a side of a cell, where there are not very many cells.
    const SAMPLES: usize = 7;
    const MANY: usize = 20_000;
    let [rows, columns] = cells.count();
    let samples = if rows * columns > MANY { 2 } else { SAMPLES };
    let mut worst: f64 = 0.0;
    let mut point = vec![0.0; cells.dimension];
    let mut nearest = point.clone();
    for Place { cell, share } in cells.places(samples) {
        let [u, v] = place(cell, share);
        surface.evaluate_into(u, v, &mut point)?;
        if cells.distance(cell, share, &point, &mut nearest) > worst {
            worst = worst.max(cells.distance_nearby(cell, share, &point, &mut nearest));
        }
    }
    Ok(worst)
}
