//! Interpolation of a triangular array of points by a triangular Bernstein-Bezier patch.
//!
//! Point (i, j, k) sits at barycentric (i, j, k) / n (Chen and Wang 2011). The eigenvalues of the
//! collocation matrix are `n! / ((n - s)! n^s)`, s + 1 times each, so that PIA converges although
//! the basis of a triangle is not totally positive.

use super::blending::note_near_singularity;
use super::method::choose;
use super::prepare::check_extent;
use super::solve::{Size, Task, norm, solve, unscaled};
use super::{KeptFit, Method, TriangleOptions};
use crate::Error;
use crate::basis::{factorial_over_power, triangular_into};
use crate::collocation::DenseCollocation;
use crate::geometry::{TriangularPatch, check_triangle_degree, triangle_indices, triangle_points};
use crate::iteration::{NoObserver, Observer};
use crate::points::{Extent, Points, PointsView};
use crate::projection::largest_triangle_deviation;
use crate::report::TriangleReport;

/// A fitted triangular patch and the account of how it came about.
#[derive(Debug, Clone, PartialEq)]
pub struct TriangleFit {
    /// The patch.
    pub patch: TriangularPatch,
    /// Difference vectors, in the order of the points.
    pub difference_vectors: Points,
    /// What happened.
    pub report: TriangleReport,
    /// Fits kept on the way.
    pub sequence: Vec<KeptFit>,
}

impl TriangleFit {
    /// Norm of the difference vector at each point.
    #[must_use]
    pub fn residuals(&self) -> Vec<f64> {
        self.difference_vectors.iter().map(norm).collect()
    }
}

/// Fits a triangular patch of a degree through (degree + 1) (degree + 2) / 2 points, given in rows
/// of the triangle as [`TriangularPatch`] stores control points.
///
/// # Errors
/// What is wrong with the points or the options; see [`Error`]. A run that does not reach its
/// residual is no error: look at [`RunReport::termination`](crate::RunReport::termination).
///
/// # Examples
/// ```
/// use gimfit::{TriangleOptions, fit_triangular_patch};
/// let points = [
///     [0.0, 0.0, 1.0],
///     [1.0, 0.0, 2.0], [0.0, 1.0, 0.5],
///     [2.0, 0.0, 1.0], [1.0, 1.0, 1.5], [0.0, 2.0, 0.0],
/// ];
/// let fit = fit_triangular_patch(&points, 2, &TriangleOptions::default())?;
/// assert!(fit.report.converged());
/// let middle_of_an_edge = fit.patch.evaluate(0.5, 0.5)?;
/// assert!((middle_of_an_edge[2] - 2.0).abs() < 1e-12);
/// # Ok::<(), gimfit::Error>(())
/// ```
pub fn fit_triangular_patch<'a>(
    points: impl Into<PointsView<'a>>,
    degree: usize,
    options: &TriangleOptions,
) -> Result<TriangleFit, Error> {
    fit_triangular_patch_observed(points, degree, options, &mut NoObserver)
}

/// As [`fit_triangular_patch`], watched step by step, as
/// [`fit_curve_observed`](super::fit_curve_observed).
///
/// # Errors
/// As [`fit_triangular_patch`].
pub fn fit_triangular_patch_observed<'a>(
    points: impl Into<PointsView<'a>>,
    degree: usize,
    options: &TriangleOptions,
    observer: &mut dyn Observer,
) -> Result<TriangleFit, Error> {
    let points = points.into();
    check_triangle_degree(degree)?;
    let needed = triangle_points(degree);
    if points.is_empty() {
        return Err(Error::NoPoints { needed });
    }
    if points.len() != needed {
        return Err(Error::WrongCount {
            what: "points",
            given: points.len(),
            expected: needed,
            why: "(degree + 1) (degree + 2) / 2 for a triangular patch",
        });
    }
    let size = Size::of(Extent::of(points)?);
    check_extent(&size.extent)?;
    let dimension = points.dimension();
    let data = size.scale.apply(points.coordinates());
    let view = PointsView::new(dimension, &data)?;
    let operator = triangular_collocation(degree)?;

    let gradual = options.keep.iter().copied().max().unwrap_or(0).min(options.iterations);
    let mut chosen = choose(options.method, &options.weight, &operator, dimension, gradual)?;
    if matches!(options.method, Method::Jacobi | Method::GaussSeidel | Method::Sor) {
        chosen.choices.push(
            "caution: the basis of a triangle is not totally positive, and nothing is known of the \
             convergence of this method on it; pia, weighted, chebyshev, anderson and auto converge"
                .into(),
        );
    }
    let stopping = size.stopping(options.residual, options.iterations, &mut chosen.choices)?;
    let task = Task {
        operator: &operator,
        data: view.coordinates(),
        dimension,
        size: &size,
        stopping,
        keep: &options.keep,
        expand: &|control| control,
        foot_points: None,
    };
    let mut solved = solve(&task, &mut chosen, observer)?;
    drop(chosen);
    note_near_singularity(&[&operator], &mut solved.run);

    let scale = size.scale;
    let patch = TriangularPatch::new(degree, Points::new(dimension, solved.control)?)?;
    let norms = solved.norms;
    let (deviation, deviation_index) = if norms.max <= size.rounding_level() {
        (norms.max, norms.max_index)
    } else {
        let residuals: Vec<f64> = solved.vectors.chunks_exact(dimension).map(norm).collect();
        largest_triangle_deviation(&patch, view, &places(degree), &residuals)?
    };
    let control_points = unscaled(patch.control_points().clone(), scale)?;
    let report = TriangleReport {
        points: view.len(),
        degree,
        dimension,
        run: solved.run,
        max_residual_index: norms.max_index,
        max_deviation: scale.undo(deviation),
        max_deviation_index: deviation_index,
    };
    Ok(TriangleFit {
        patch: TriangularPatch::new(degree, control_points)?,
        difference_vectors: unscaled(Points::new(dimension, solved.vectors)?, scale)?,
        report,
        sequence: solved.sequence,
    })
}

/// Where the points of a triangle sit: (i, j, k) / n.
fn barycentric(degree: usize) -> Vec<[f64; 3]> {
    triangle_indices(degree)
        .map(|indices| indices.map(|index| index as f64 / degree as f64))
        .collect()
}

/// The same as parameters u, v.
pub(super) fn places(degree: usize) -> Vec<[f64; 2]> {
    barycentric(degree).into_iter().map(|[u, v, _]| [u, v]).collect()
}

/// The Bernstein basis of a triangle at (i, j, k) / n.
///
/// # Errors
/// [`Error::OutOfRange`] for a degree that triangular patches do not have.
pub fn triangular_collocation(degree: usize) -> Result<DenseCollocation, Error> {
    check_triangle_degree(degree)?;
    let places = barycentric(degree);
    let smallest = Some(factorial_over_power(degree));
    DenseCollocation::from_rows("triangular", places.len(), smallest, |j, row| {
        triangular_into(degree, places[j], row);
    })
}
