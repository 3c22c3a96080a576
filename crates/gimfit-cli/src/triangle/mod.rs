//! `gimfit triangle`: a triangular patch through a triangular array of points.

mod arguments;
mod draw;
mod print;
mod samples;
mod save;

pub(crate) use arguments::TriangleArguments;
pub(crate) use samples::{Sample, samples, write_samples};

use crate::Ending;
use crate::explain::explain;
use crate::finish::{Finish, Run, Sought};
use crate::input;
use crate::method::{ensure_kept_fits_fit, method, weight, weight_file};
use crate::outputs::Wanted;
use crate::progress::Progress;
use crate::signal::{self, Stage};
use anyhow::{bail, ensure};
use gimfit::fit::fit_triangular_patch_observed;
use gimfit::geometry::{MAX_TRIANGLE_DEGREE, triangle_points};
use gimfit::{PointsView, TriangleFit, TriangleOptions};
use gimfit_io::document::{Seconds, TriangleDocument, triangle_document_of};
use gimfit_io::points::PointTable;
use std::path::Path;
use std::time::Instant;

/// A fit with everything that is told about it.
struct Job<'a> {
    table: &'a PointTable,
    fit: &'a TriangleFit,
    /// Samples along an edge, in place of control points.
    samples: Option<usize>,
    seconds: Seconds,
    document: TriangleDocument,
}

impl<'a> Job<'a> {
    fn new(
        table: &'a PointTable,
        fit: &'a TriangleFit,
        samples: Option<usize>,
        seconds: Seconds,
    ) -> Self {
        let mut document = triangle_document_of(fit);
        document.coordinate_names = Some(table.column_names.clone());
        if let Some(report) = &mut document.report {
            report.source = Some(table.source.clone());
            let notes = table.notes.iter().map(|note| format!("reading: {note}"));
            report.run.choices.splice(0..0, notes);
            report.run.seconds = Some(seconds);
        }
        Self { table, fit, samples, seconds, document }
    }
}

pub(crate) fn run(arguments: &TriangleArguments) -> anyhow::Result<Ending> {
    let mut inputs: Vec<(&str, &Path)> = vec![("POINTS", arguments.input.points.as_path())];
    inputs.extend(weight_file(&arguments.iteration.weight).map(|path| ("--weight", path)));
    let keep = &arguments.iteration.keep;
    let wanted = Wanted::new(&arguments.writing, keep, arguments.samples.is_some());
    wanted.check(&inputs)?;
    ensure!(
        arguments.input.abscissa.is_none(),
        "--abscissa: the points of a triangle sit at (i, j, k) / n and have no parameters of their \
         own"
    );
    signal::listen()?;
    let clock = Instant::now();
    let iteration = &arguments.iteration;
    let mut options = TriangleOptions {
        method: method(iteration, true)?,
        weight: weight(&iteration.weight)?,
        iterations: iteration.iterations,
        residual: iteration.residual,
        keep: iteration.keep.clone(),
    };
    options.keep.sort_unstable();
    let table = input::points(&arguments.input)?;
    let degree = degree(table.rows(), &table.source)?;
    let numbers = table.coordinates.len();
    ensure_kept_fits_fit(&options.keep, options.iterations, numbers, &table.source)?;
    let read = clock.elapsed().as_secs_f64();

    let view = PointsView::new(table.dimension(), &table.coordinates)
        .map_err(|error| explain(error, &table))?;
    let mut progress = Progress::new(arguments.writing.quiet, options.iterations);
    let clock = Instant::now();
    let result = fit_triangular_patch_observed(view, degree, &options, &mut progress);
    let fitted = clock.elapsed().as_secs_f64();
    signal::enter(Stage::Writing);
    progress.finish();
    let fit = result.map_err(|error| explain(error, &table))?;

    let seconds = Seconds { read, fit: fitted, write: None };
    let mut job = Job::new(&table, &fit, arguments.samples, seconds);
    let report = &fit.report;
    let finish = Finish {
        wanted,
        method: iteration.method,
        convex: None,
        run: Run::of(&report.run, Sought::Residual),
    };
    finish.finish(&mut job, print::report)
}

/// The degree whose triangle has so many points; an error tells the nearest counts.
fn degree(points: usize, source: &str) -> anyhow::Result<usize> {
    let above = (1..=MAX_TRIANGLE_DEGREE).find(|&n| triangle_points(n) >= points);
    match above {
        Some(n) if triangle_points(n) == points => Ok(n),
        Some(1) => bail!("{source}: {points} points are too few for a triangle, which needs 3"),
        Some(n) => bail!(
            "{source}: {points} points fill no triangle; {} fill one of degree {}, {} one of degree \
             {n} (rows of 1, 2, 3, ... points)",
            triangle_points(n - 1),
            n - 1,
            triangle_points(n)
        ),
        None => bail!(
            "{source}: {points} points are too many for a triangular patch, whose degree is at most \
             {MAX_TRIANGLE_DEGREE} ({} points)",
            triangle_points(MAX_TRIANGLE_DEGREE)
        ),
    }
}

/// Row and column of a point of a triangle.
fn row_and_column(index: usize) -> (usize, usize) {
    let mut row = 0;
    while (row + 1) * (row + 2) / 2 <= index {
        row += 1;
    }
    (row, index - row * (row + 1) / 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_that_fill_no_triangle_are_told_their_neighbours() {
        assert_eq!(degree(10, "a").unwrap(), 3);
        let error = degree(11, "a").unwrap_err().to_string();
        assert!(error.contains("10 fill one of degree 3, 15 one of degree 4"), "{error}");
        assert!(degree(2, "a").unwrap_err().to_string().contains("needs 3"));
        assert!(degree(2000, "a").unwrap_err().to_string().contains("1891"));
    }

    #[test]
    fn points_have_their_rows() {
        let places: Vec<(usize, usize)> = (0..6).map(row_and_column).collect();
        assert_eq!(places, [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)]);
    }
}
