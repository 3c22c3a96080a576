//! The workload W4: a cubic least squares curve at given parameters and over given knots, a tenth as
//! many control points as points.

use crate::data;
use crate::workload::{DIMENSION, Residuals};
use anyhow::ensure;
use gimfit::fit::least_squares;
use gimfit::points::Extent;
use gimfit::{CurveFit, KnotVector, LeastSquaresKnots, LeastSquaresOptions, PointsView};

/// Degree.
const DEGREE: usize = 3;

/// Its short name.
pub const NAME: &str = "W4";
/// The name of our column.
pub const PEER: &str = "gimfit.least_squares";
/// What a reader should know about it.
pub const NOTE: &str = "cubic least squares at given parameters and knots, N/10 control points";
/// Points in larger comparisons.
pub const SIZES: &str = "1000,10000,100000,1000000,10000000";

/// What a caller holds before it asks for a curve.
#[derive(Debug, Clone)]
pub struct Input {
    points: Vec<f64>,
    parameters: Vec<f64>,
    knots: Vec<f64>,
}

impl Input {
    /// Reads the files of a workload of `count` points.
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
            points: file("p", count * DIMENSION)?,
            parameters: file("u", count)?,
            knots: file("t", count / 10 + DEGREE + 1)?,
        })
    }

    /// Copies of the arrays that a fit takes over.
    #[must_use]
    pub fn copy(&self) -> (Vec<f64>, Vec<f64>) {
        (self.parameters.clone(), self.knots.clone())
    }

    /// The work that is timed: checks everything, and fits.
    ///
    /// # Errors
    /// What is wrong with the data.
    pub fn fit(
        &self,
        (parameters, knots): (Vec<f64>, Vec<f64>),
    ) -> Result<CurveFit, gimfit::Error> {
        let points = PointsView::new(DIMENSION, &self.points)?;
        let knots = KnotVector::open(DEGREE, knots)?;
        // Of the options, the knots do not count: they are given.
        let options = LeastSquaresOptions::new(LeastSquaresKnots::ControlPoints(0));
        least_squares(points, parameters, knots, &options)
    }

    /// Residuals found by evaluating the curve, which knows nothing of how it was fitted.
    ///
    /// # Errors
    /// If the curve is not the one asked for.
    pub fn check(&self, fit: &CurveFit) -> anyhow::Result<Residuals> {
        let points = PointsView::new(DIMENSION, &self.points)?;
        let (mut largest, mut sum) = (0.0_f64, 0.0);
        let mut found = [0.0; DIMENSION];
        for (j, &t) in self.parameters.iter().enumerate() {
            fit.curve.evaluate_into(t, &mut found)?;
            let gaps = found.iter().zip(points.point(j)).map(|(x, q)| x - q);
            let square: f64 = gaps.map(|gap| gap * gap).sum();
            largest = largest.max(square);
            sum += square;
        }
        ensure!(f64::is_finite(sum), "the curve is not finite at the data");
        Ok(Residuals {
            largest: largest.sqrt(),
            root_mean_square: (sum / points.len() as f64).sqrt(),
            extent: Extent::of(points)?.diagonal(),
        })
    }
}
