//! The workload W3: a bicubic surface through a square grid of points, at given parameters and over
//! given knots in both directions.

use crate::data;
use crate::workload::{DIMENSION, Residuals};
use anyhow::ensure;
use gimfit::points::Extent;
use gimfit::{
    GridView, KnotPlacement, Parameterization, PointsView, SurfaceFit, SurfaceOptions, fit_surface,
};

/// Degree in both directions.
const DEGREE: usize = 3;

/// Its short name.
pub const NAME: &str = "W3";
/// What a reader should know about it.
pub const NOTE: &str = "bicubic surface at given parameters and not-a-knot knots; m x m points";
/// Rows, and columns, of the grids in larger comparisons.
pub const SIZES: &str = "100,300,1000,3000";

/// What a caller holds before it asks for a surface.
#[derive(Debug, Clone)]
pub struct Grid {
    count: usize,
    points: Vec<f64>,
    parameters: [Vec<f64>; 2],
    knots: [Vec<f64>; 2],
}

impl Grid {
    /// Reads the files of a grid of `count` x `count` points.
    ///
    /// # Errors
    /// If a file is missing or of another length.
    pub fn read(count: usize) -> anyhow::Result<Self> {
        let file = |kind: &str, expected: usize| -> anyhow::Result<Vec<f64>> {
            let name = format!("{NAME}_{count}.{kind}");
            let values = data::read(&name)?;
            ensure!(values.len() == expected, "{name} holds {} values", values.len());
            Ok(values)
        };
        Ok(Self {
            count,
            points: file("p", count * count * DIMENSION)?,
            parameters: [file("u", count)?, file("v", count)?],
            knots: [file("s", count + DEGREE + 1)?, file("t", count + DEGREE + 1)?],
        })
    }

    /// The grid as a fit takes it.
    ///
    /// # Errors
    /// None for a grid that was read.
    pub fn view(&self) -> Result<GridView<'_>, gimfit::Error> {
        GridView::new([self.count; 2], DIMENSION, &self.points)
    }

    /// What the fit is asked for.
    #[must_use]
    pub fn options(&self) -> SurfaceOptions {
        SurfaceOptions {
            parameterizations: self
                .parameters
                .each_ref()
                .map(|values| Some(Parameterization::Given(values.clone()))),
            knot_placements: self
                .knots
                .each_ref()
                .map(|values| Some(KnotPlacement::Given(values.clone()))),
            ..SurfaceOptions::default()
        }
    }

    /// The work that is timed: checks everything, and interpolates.
    ///
    /// # Errors
    /// What is wrong with the data.
    pub fn interpolate(&self, options: &SurfaceOptions) -> Result<SurfaceFit, gimfit::Error> {
        fit_surface(self.view()?, options)
    }

    /// Residuals found by evaluating the surface at every point of every seventh row and column, and
    /// of the last: of millions of points that is as many as can be had in a moment.
    ///
    /// # Errors
    /// If the surface is not the one asked for.
    pub fn check(&self, fit: &SurfaceFit) -> anyhow::Result<Residuals> {
        ensure!(fit.report.points == [self.count; 2], "{:?} points", fit.report.points);
        let grid = self.view()?;
        let (mut largest, mut sum, mut looked_at) = (0.0_f64, 0.0, 0.0);
        let mut found = [0.0; DIMENSION];
        let some = |k: &usize| k.is_multiple_of(7) || k + 1 == self.count;
        for i in (0..self.count).filter(some) {
            for j in (0..self.count).filter(some) {
                let (u, v) = (fit.parameters[0][i], fit.parameters[1][j]);
                fit.surface.evaluate_into(u, v, &mut found)?;
                let gaps = found.iter().zip(grid.point(i, j)).map(|(x, q)| x - q);
                let square: f64 = gaps.map(|gap| gap * gap).sum();
                largest = largest.max(square);
                sum += square;
                looked_at += 1.0;
            }
        }
        ensure!(f64::is_finite(sum), "the surface is not finite at the data");
        Ok(Residuals {
            largest: largest.sqrt(),
            root_mean_square: (sum / looked_at).sqrt(),
            extent: Extent::of(PointsView::new(DIMENSION, &self.points)?)?.diagonal(),
        })
    }
}
