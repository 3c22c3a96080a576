//! Samples of triangular patches: for `gimfit triangle --samples` and `gimfit evaluate`.

use gimfit::geometry::TriangularPatch;
use gimfit_io::table::write_rows;
use std::io::{self, Write};

/// Barycentric u and v; w is what is left to 1.
pub(crate) type Sample = [f64; 2];

/// Places in rows of a triangle with `count` points along each edge.
pub(crate) fn samples(count: usize) -> impl Iterator<Item = Sample> {
    let last = count.saturating_sub(1);
    let share = move |k: usize| k as f64 / last.max(1) as f64;
    (0..=last).flat_map(move |row| (0..=row).map(move |c| [share(last - row), share(row - c)]))
}

/// Writes u, v and the coordinates, a row each.
pub(crate) fn write_samples(
    out: &mut dyn Write,
    patch: &TriangularPatch,
    samples: &[Sample],
    names: &[String],
) -> io::Result<()> {
    let points: Vec<Vec<f64>> = samples
        .iter()
        .map(|&[u, v]| patch.evaluate(u, v))
        .collect::<Result<_, _>>()
        .map_err(|error| io::Error::new(io::ErrorKind::InvalidInput, error))?;
    let made_up: Vec<String>;
    let names = if names.len() == patch.dimension() {
        names
    } else {
        made_up = (0..patch.dimension()).map(|k| format!("x{k}")).collect();
        &made_up
    };
    let labels = samples.iter().map(|place| place.map(|x| format!("{x:?}")));
    write_rows(out, ["u", "v"], names, labels, points.iter().map(Vec::as_slice))
}
