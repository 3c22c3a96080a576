//! Interpolation of a grid of points by a tensor-product surface over any blending bases.

use super::blending::{cautions, note_near_singularity, onto_domain};
use super::curve::{parameterization_name, spacing_ratio};
use super::net::{Setting, run_net};
use super::prepare::check_extent;
use super::solve::{Size, norm, unscaled};
use super::surface_method::Directions;
use super::{BlendingSurfaceOptions, KeptFit, SurfaceFit, SurfaceOptions};
use crate::Error;
use crate::basis::BlendingBasis;
use crate::collocation::DenseCollocation;
use crate::geometry::BlendingSurface;
use crate::iteration::{NoObserver, Observer};
use crate::parameters::{Parameterization, Parameters, assign_grid_parameters};
use crate::points::{Extent, GridView, PointGrid, Points};
use crate::projection::largest_surface_deviation;
use crate::report::SurfaceReport;
use std::sync::Arc;

/// A fitted surface over blending bases and the account of how it came about.
#[derive(Debug, Clone)]
pub struct BlendingSurfaceFit {
    /// The surface.
    pub surface: BlendingSurface,
    /// Parameters of the rows (u) and of the columns (v) of points.
    pub parameters: [Vec<f64>; 2],
    /// Difference vectors `Q_ij - S(u_i, v_j)`, row by row.
    pub difference_vectors: Points,
    /// What happened. The degrees told are the numbers of functions less one.
    pub report: SurfaceReport,
    /// Fits kept on the way, with the net of each row by row.
    pub sequence: Vec<KeptFit>,
}

impl BlendingSurfaceFit {
    /// The same fit told in Bezier form, kept fits included: a B-spline surface of one patch.
    ///
    /// # Errors
    /// As [`BlendingSurface::to_bezier`].
    pub fn to_bezier(&self) -> Result<SurfaceFit, Error> {
        let kept = self.sequence.iter().map(|kept| {
            let surface = self.surface.bezier_with(&kept.control_points)?;
            let control_points = surface.control_net().points().clone();
            Ok(KeptFit { entry: kept.entry, control_points, foot_points: None })
        });
        Ok(SurfaceFit {
            surface: self.surface.to_bezier()?,
            parameters: self.parameters.clone(),
            foot_parameters: None,
            difference_vectors: self.difference_vectors.clone(),
            report: self.report.clone(),
            sequence: kept.collect::<Result<_, Error>>()?,
        })
    }
}

/// Fits a tensor-product surface over a blending basis in each direction, u (rows) and v (columns),
/// through a grid of points, one function per row and per column.
///
/// # Errors
/// As [`fit_blending_curve`](super::fit_blending_curve).
///
/// # Examples
/// ```
/// use gimfit::basis::{Bernstein, WangBall};
/// use gimfit::{BlendingSurfaceOptions, GridView, fit_blending_surface};
/// use std::sync::Arc;
/// let points: Vec<f64> = (0..30)
///     .flat_map(|k| [f64::from(k / 5), f64::from(k % 5), f64::from(k * k % 7)])
///     .collect();
/// let grid = GridView::new([6, 5], 3, &points)?;
/// let options = BlendingSurfaceOptions::default();
/// let bases = [Arc::new(Bernstein::new(5)?) as _, Arc::new(WangBall::new(4)?) as _];
/// let fit = fit_blending_surface(grid, bases, &options)?;
/// assert!(fit.report.converged());
/// let on_surface = fit.surface.evaluate(0.2, 0.5)?;
/// assert!((on_surface[2] - 49.0 % 7.0).abs() < 1e-10);
/// # Ok::<(), gimfit::Error>(())
/// ```
pub fn fit_blending_surface(
    grid: GridView<'_>,
    bases: [Arc<dyn BlendingBasis>; 2],
    options: &BlendingSurfaceOptions,
) -> Result<BlendingSurfaceFit, Error> {
    fit_blending_surface_observed(grid, bases, options, &mut NoObserver)
}

/// As [`fit_blending_surface`], watched step by step, as
/// [`fit_curve_observed`](super::fit_curve_observed).
///
/// # Errors
/// As [`fit_blending_surface`].
pub fn fit_blending_surface_observed(
    grid: GridView<'_>,
    bases: [Arc<dyn BlendingBasis>; 2],
    options: &BlendingSurfaceOptions,
    observer: &mut dyn Observer,
) -> Result<BlendingSurfaceFit, Error> {
    if grid.points().is_empty() {
        let needed = bases[0].functions().saturating_mul(bases[1].functions());
        return Err(Error::NoPoints { needed });
    }
    let size = Size::of(Extent::of(grid.points())?);
    check_extent(&size.extent)?;
    let dimension = grid.dimension();
    let data = size.scale.apply(grid.points().coordinates());
    let view = GridView::new(grid.shape(), dimension, &data)?;
    let mut choices = Vec::new();
    let u = direction(view, 0, &*bases[0], options, &mut choices)?;
    let v = direction(view, 1, &*bases[1], options, &mut choices)?;
    let net_options = SurfaceOptions {
        method: options.method,
        weight: options.weight.clone(),
        per_direction: options.per_direction,
        iterations: options.iterations,
        keep: options.keep.clone(),
        ..SurfaceOptions::default()
    };
    let stopping = size.stopping(options.residual, options.iterations, &mut choices)?;
    let setting = Setting {
        view,
        size: &size,
        directions: Directions { u: &u.operator, v: &v.operator, rational: None },
        options: &net_options,
        stopping,
        expand: &|control| control,
        target: None,
    };
    let (mut solved, stages) = run_net(&setting, observer)?;
    note_near_singularity(&[&u.operator, &v.operator], &mut solved.run);

    let scale = size.scale;
    let net = PointGrid::new(view.shape(), dimension, solved.control)?;
    let surface = BlendingSurface::new(bases, net)?;
    let (t_u, t_v) = (u.parameters.into_values(), v.parameters.into_values());
    let norms = solved.norms;
    let (deviation, deviation_index) = match surface.to_bezier() {
        _ if norms.max <= size.rounding_level() => (norms.max, norms.max_index),
        Ok(bezier) => {
            let residuals: Vec<f64> = solved.vectors.chunks_exact(dimension).map(norm).collect();
            largest_surface_deviation(&bezier, view.points(), [&t_u, &t_v], &residuals)?
        }
        Err(_) => {
            choices.push(
                "deviation: not more than the residual, which is told in its place: foot points \
                 are looked for on Bezier surfaces only"
                    .into(),
            );
            (norms.max, norms.max_index)
        }
    };
    let points = unscaled(surface.control_net().points().clone(), scale)?;
    let net = PointGrid::new(view.shape(), dimension, points.into_coordinates())?;
    let surface = BlendingSurface::new(surface.bases().clone(), net)?;
    choices.append(&mut solved.run.choices);
    solved.run.choices = choices;
    let shape = view.shape();
    let cell = |index: usize| [index / shape[1], index % shape[1]];
    let report = SurfaceReport {
        points: shape,
        control_points: shape,
        degrees: shape.map(|count| count - 1),
        dimension,
        closed: [false, false],
        parameterizations: [u.parameterization, v.parameterization],
        knot_placements: ["bezier", "bezier"],
        spacing_ratios: [spacing_ratio(&t_u, None), spacing_ratio(&t_v, None)],
        per_direction: options.per_direction,
        run: solved.run,
        stages,
        max_residual_index: cell(norms.max_index),
        max_deviation: scale.undo(deviation),
        max_deviation_index: cell(deviation_index),
        approximation: None,
    };
    Ok(BlendingSurfaceFit {
        surface,
        parameters: [t_u, t_v],
        difference_vectors: unscaled(Points::new(dimension, solved.vectors)?, scale)?,
        report,
        sequence: solved.sequence,
    })
}

/// What one direction brings along.
pub(super) struct Direction {
    pub(super) parameters: Parameters,
    pub(super) operator: DenseCollocation,
    parameterization: &'static str,
}

pub(super) fn direction(
    view: GridView<'_>,
    k: usize,
    basis: &dyn BlendingBasis,
    options: &BlendingSurfaceOptions,
    choices: &mut Vec<String>,
) -> Result<Direction, Error> {
    let count = view.shape()[k];
    if basis.functions() != count {
        return Err(Error::WrongCount {
            what: ["rows of points", "columns of points"][k],
            given: count,
            expected: basis.functions(),
            why: "as many as the basis has functions; a basis of degree n has n + 1",
        });
    }
    let place = [" in u", " in v"][k];
    let parameterization = options.parameterizations[k].clone().unwrap_or_else(|| {
        choices.push(format!("parameters{place}: uniform, as is usual for this kind of basis"));
        Parameterization::Uniform
    });
    let parameters = assign_grid_parameters(view, k, false, &parameterization)
        .map_err(|error| error.in_lines(["row", "column"][k]))?;
    let parameters = onto_domain(parameters, basis, &parameterization, place, choices)?;
    let operator = DenseCollocation::new(basis, &parameters)?;
    cautions(&operator, basis, options.method, place, choices);
    let parameterization = parameterization_name(&parameterization);
    Ok(Direction { parameters, operator, parameterization })
}
