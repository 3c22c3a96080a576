//! From a whole surface to one that can be edited, and back.

use super::row_sums::row_sums;
use super::surface::{EditableSurface, Side};
use super::whole::{refused, unwrapped};
use super::{Account, residual_target};
use crate::Error;
use crate::collocation::{CollocationOperator, NetLayout, TensorCollocation, interpolation};
use crate::fit::solve::{Size, norm, unscaled};
use crate::fit::{SurfaceFit, SurfaceOptions, fit_surface};
use crate::geometry::Surface;
use crate::iteration::{HistoryEntry, ROUNDING};
use crate::memory;
use crate::parameters::Parameters;
use crate::points::{Extent, GridView, PointGrid, Points, PointsView};
use crate::projection::largest_surface_deviation;
use crate::report::{RunReport, SurfaceReport};

impl EditableSurface {
    /// Fits all points, to be edited from then on.
    ///
    /// # Errors
    /// As [`fit_surface`]; [`Error::Incompatible`] for rational weights and for parameters that follow
    /// foot points.
    pub fn new(grid: GridView<'_>, options: &SurfaceOptions) -> Result<Self, Error> {
        Ok(Self::from_fit(grid, &fit_surface(grid, options)?)?.with_residual(options.residual))
    }

    /// Sets the largest residual to keep, in the unit of the data; `None`, and what is not above 0: 1e-12
    /// of the extent, or what rounding allows.
    #[must_use]
    pub fn with_residual(mut self, residual: Option<f64>) -> Self {
        let demanded = residual.filter(|residual| *residual > 0.0);
        self.demanded = demanded.map(|residual| self.scale.up(residual));
        self
    }

    /// Takes a fit of the grid over; a closing row or column that the fit left out is left out here,
    /// too.
    ///
    /// # Errors
    /// As [`EditableSurface::new`].
    pub fn from_fit(grid: GridView<'_>, fit: &SurfaceFit) -> Result<Self, Error> {
        let surface = &fit.surface;
        if surface.rational_weights().is_some() {
            return Err(refused("rational weights", "it is done for polynomial surfaces only"));
        }
        if fit.foot_parameters.is_some() {
            return Err(refused(
                "parameters that follow foot points",
                "every point has its own; fit the grid by another method",
            ));
        }
        let (shape, given, dimension) = (fit.report.points, grid.shape(), grid.dimension());
        let fits = (0..2)
            .all(|k| given[k] == shape[k] || (fit.report.closed[k] && given[k] == shape[k] + 1));
        if !fits || dimension != surface.dimension() {
            return Err(Error::WrongCount {
                what: "coordinates",
                given: grid.points().coordinates().len(),
                expected: shape[0] * shape[1] * surface.dimension(),
                why: "those of the grid fitted",
            });
        }
        let mut data = memory::with_capacity(shape[0] * shape[1] * dimension);
        let line = given[1] * dimension;
        for row in grid.points().coordinates().chunks_exact(line).take(shape[0]) {
            data.extend_from_slice(&row[..shape[1] * dimension]);
        }
        let scale = Size::of(Extent::of(PointsView::new(dimension, &data)?)?).scale;
        let data = scale.apply(&data).into_owned();
        let extent = Extent::of(PointsView::new(dimension, &data)?)?;

        let mut layouts = [crate::collocation::ControlLayout::Free; 2];
        let mut side = |k: usize| -> Result<Side, Error> {
            let knots = surface.knots()[k].clone();
            let closed = surface.is_periodic()[k];
            let (start, end) = knots.domain();
            let stored = fit.parameters[k].clone();
            let parameters = if closed {
                Parameters::closed(unwrapped(&stored, end - start), end - start)?
            } else {
                Parameters::open(stored.clone())?
            };
            let built = interpolation(&parameters, &knots)?;
            layouts[k] = built.layout;
            let (sums, residual) = row_sums(&parameters, &knots, built.layout)?;
            let largest = sums.iter().copied().fold(0.0, f64::max);
            let inverse_norm =
                if residual < 1.0 { largest / (1.0 - residual) } else { f64::INFINITY };
            Ok(Side { knots, operator: built.operator, closed, parameters: stored, inverse_norm })
        };
        let sides = [side(0)?, side(1)?];
        let layout = NetLayout { u: layouts[0], v: layouts[1], columns: shape[1] };
        let net = surface.control_net();
        let control = scale.apply(net.points().coordinates());
        let control = layout.collect(&control, dimension);
        let largest = data.iter().chain(&control).fold(0.0, |most: f64, x| most.max(x.abs()));
        let mut editable = Self {
            sides,
            layout,
            dimension,
            data,
            control,
            scale,
            extent,
            demanded: None,
            account: Account {
                edits: 0,
                iterations: fit.report.run.iterations,
                termination: fit.report.run.termination,
                residual: 0.0,
                row_sum_residual: 0.0,
                largest,
            },
            report: fit.report.clone(),
        };
        editable.account.residual = editable.all_differences().0.max;
        Ok(editable)
    }

    fn all_differences(&self) -> (crate::collocation::ResidualNorms, Vec<f64>) {
        let [u, v] = &self.sides;
        let operator = TensorCollocation::new(&u.operator, &v.operator, self.dimension);
        let mut vectors = memory::zeros(self.data.len());
        let norms =
            operator.difference_vectors(&self.data, &self.control, self.dimension, &mut vectors);
        (norms, vectors)
    }

    /// All data points, row by row.
    ///
    /// # Errors
    /// None that a surface which holds points can meet.
    pub fn points(&self) -> Result<Points, Error> {
        unscaled(Points::new(self.dimension, self.data.clone())?, self.scale)
    }

    /// The whole surface as it is now, with its report: residuals and deviation are measured anew, at
    /// all points.
    ///
    /// # Errors
    /// [`Error::LeavesDoubles`] if a coordinate does.
    pub fn fit(&self) -> Result<SurfaceFit, Error> {
        let (dimension, scale, shape) = (self.dimension, self.scale, self.shape());
        let (norms, vectors) = self.all_differences();
        let view = PointsView::new(dimension, &self.data)?;
        let extent = Extent::of(view)?;
        let rounding = ROUNDING * extent.largest_coordinate();
        let knots = self.sides.each_ref().map(|side| side.knots.clone());
        let net_shape = knots.each_ref().map(crate::knots::KnotVector::control_points);
        let parameters = self.sides.each_ref().map(|side| side.parameters.clone());
        let net = |coordinates| PointGrid::new(net_shape, dimension, coordinates);
        let stored = self.layout.expand(self.control.clone(), dimension);
        let surface = Surface::new(knots, net(stored)?)?;
        let (max_deviation, deviation_index) = if norms.max <= rounding {
            // Down there a foot point is decided by rounding; the residual bounds the distance.
            (norms.max, norms.max_index)
        } else {
            let residuals: Vec<f64> = vectors.chunks_exact(dimension).map(norm).collect();
            let [u, v] = &parameters;
            largest_surface_deviation(&surface, view, [u, v], &residuals)?
        };
        let points = unscaled(surface.control_net().points().clone(), scale)?;
        let surface = surface.with_control_net(net(points.into_coordinates())?)?;
        let cell = |index: usize| [index / shape[1], index % shape[1]];
        let (max_residual, rms_residual) = (scale.undo(norms.max), scale.undo(norms.rms));
        let Account { edits, iterations, termination, .. } = self.account;
        let run = RunReport {
            method: "local",
            choices: vec![format!(
                "edits: {edits}, each by local PIA of the points near it; {}",
                super::whole::within(self.bound())
            )],
            iterations,
            iteration_returned: iterations,
            termination,
            residual_target: scale.undo(residual_target(&extent, self.demanded).max(rounding)),
            extent: scale.undo(extent.diagonal()),
            max_residual,
            rms_residual,
            smallest_eigenvalue: None,
            updates: None,
            local: None,
            foot_points: None,
            least_squares: None,
            history: vec![HistoryEntry {
                iteration: iterations,
                max_residual,
                rms_residual,
                normal_residual: None,
            }],
        };
        let report = SurfaceReport {
            per_direction: false,
            run,
            stages: None,
            max_residual_index: cell(norms.max_index),
            max_deviation: scale.undo(max_deviation),
            max_deviation_index: cell(deviation_index),
            ..self.report.clone()
        };
        Ok(SurfaceFit {
            surface,
            parameters,
            foot_parameters: None,
            difference_vectors: unscaled(Points::new(dimension, vectors)?, scale)?,
            report,
            sequence: Vec::new(),
        })
    }
}
