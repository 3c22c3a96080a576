//! The workloads that other libraries get too: same points, same parameters, same knots.

use crate::data;
use anyhow::{Context, bail, ensure};
use gimfit::fit::interpolate;
use gimfit::knots::place_knots;
use gimfit::parameters::Parameters;
use gimfit::points::Extent;
use gimfit::{CurveFit, CurveOptions, KnotPlacement, KnotVector, PointsView};

/// Degree of all workloads.
const DEGREE: usize = 3;
/// Coordinates of a point.
pub const DIMENSION: usize = 3;

/// What is interpolated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Workload {
    /// W1: an open cubic, chord length, not-a-knot knots.
    Open,
    /// W2: a closed cubic, chord length, knots at the data.
    Closed,
}

impl Workload {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Open, Self::Closed];

    /// Finds a workload by its name.
    ///
    /// # Errors
    /// If there is none of that name.
    pub fn named(name: &str) -> anyhow::Result<Self> {
        let found = Self::ALL.into_iter().find(|workload| workload.name() == name);
        found.with_context(|| format!("there is no workload {name}; W1, W2 and W3 exist"))
    }

    /// Its short name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Open => "W1",
            Self::Closed => "W2",
        }
    }

    /// What a reader should know about it.
    #[must_use]
    pub fn note(self) -> &'static str {
        match self {
            Self::Open => "open cubic at given parameters and not-a-knot knots",
            Self::Closed => "closed cubic at given parameters, knots at the data",
        }
    }
}

/// What a caller holds before it asks for a curve.
#[derive(Debug, Clone)]
pub struct Input {
    workload: Workload,
    count: usize,
    points: Vec<f64>,
    /// One per point; for a closed curve one more, where it returns.
    parameters: Vec<f64>,
    /// All knots of an open curve; those of a closed one follow from the parameters.
    knots: Vec<f64>,
}

/// The arrays a fit takes over.
#[derive(Debug)]
pub struct Owned {
    parameters: Vec<f64>,
    knots: Vec<f64>,
}

impl Input {
    /// Reads the files of a workload of `count` points.
    ///
    /// # Errors
    /// If a file is missing or of another length.
    pub fn read(workload: Workload, count: usize) -> anyhow::Result<Self> {
        let file = |kind: &str, expected: usize| -> anyhow::Result<Vec<f64>> {
            let name = format!("{}_{count}.{kind}", workload.name());
            let values = data::read(&name)?;
            ensure!(values.len() == expected, "{name} holds {} values", values.len());
            Ok(values)
        };
        let points = file("p", count * DIMENSION)?;
        let (parameters, knots) = match workload {
            Workload::Open => (file("u", count)?, file("t", count + DEGREE + 1)?),
            Workload::Closed => (file("u", count + 1)?, Vec::new()),
        };
        Ok(Self { workload, count, points, parameters, knots })
    }

    /// Takes out the arrays that a fit takes over.
    pub fn take(&mut self) -> Owned {
        Owned {
            parameters: std::mem::take(&mut self.parameters),
            knots: std::mem::take(&mut self.knots),
        }
    }

    /// Copies of the arrays that a fit takes over.
    #[must_use]
    pub fn copy(&self) -> Owned {
        Owned { parameters: self.parameters.clone(), knots: self.knots.clone() }
    }

    /// The work that is timed: checks parameters and knots, and interpolates.
    ///
    /// # Errors
    /// What is wrong with the data.
    pub fn interpolate(&self, owned: Owned) -> Result<CurveFit, gimfit::Error> {
        let Owned { mut parameters, knots } = owned;
        let (parameters, knots) = match self.workload {
            Workload::Open => (Parameters::open(parameters)?, KnotVector::open(DEGREE, knots)?),
            Workload::Closed => {
                let period = parameters[self.count] - parameters[0];
                parameters.truncate(self.count);
                let parameters = Parameters::closed(parameters, period)?;
                let knots = place_knots(DEGREE, &parameters, &KnotPlacement::AtData)?;
                (parameters, knots)
            }
        };
        let points = PointsView::new(DIMENSION, &self.points)?;
        let closed = self.workload == Workload::Closed;
        interpolate(points, parameters, knots, &CurveOptions { closed, ..CurveOptions::default() })
    }

    /// Residuals found by evaluating the curve, which knows nothing of how it was fitted.
    ///
    /// # Errors
    /// If the curve is not the one asked for.
    pub fn check(&self, fit: &CurveFit) -> anyhow::Result<Residuals> {
        if fit.parameters.len() != self.count {
            bail!("{} parameters for {} points", fit.parameters.len(), self.count);
        }
        let points = PointsView::new(DIMENSION, &self.points)?;
        let (mut largest, mut sum) = (0.0_f64, 0.0);
        let mut found = [0.0; DIMENSION];
        for (j, &t) in fit.parameters.iter().enumerate() {
            fit.curve.evaluate_into(t, &mut found)?;
            let gaps = found.iter().zip(points.point(j)).map(|(x, q)| x - q);
            let square: f64 = gaps.map(|gap| gap * gap).sum();
            largest = largest.max(square);
            sum += square;
        }
        ensure!(f64::is_finite(sum), "the curve is not finite at the data");
        Ok(Residuals {
            largest: largest.sqrt(),
            root_mean_square: (sum / self.count as f64).sqrt(),
            extent: Extent::of(points)?.diagonal(),
        })
    }
}

/// Distances between data points and the curve at their parameters.
#[derive(Debug, Clone, Copy)]
pub struct Residuals {
    /// The largest.
    pub largest: f64,
    /// Their root mean square.
    pub root_mean_square: f64,
    /// Diagonal of the bounding box of the data.
    pub extent: f64,
}
