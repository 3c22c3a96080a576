//! The same for a grid of points: each direction by itself, and both at once.

use super::SurfaceOptions;
use super::solve::Size;
use super::surface::{direction, open_up};
use crate::Error;
use crate::collocation::{CollocationMatrix, CollocationOperator, TensorCollocation};
use crate::diagnosis::{Diagnosis, Forecast, Spacing, at_once, diagnose, steps_at_rate};
use crate::points::{Extent, GridView};

/// The diagnosis of a surface before it is fitted. Pairs hold direction u (rows), then direction v
/// (columns); positions in a direction count its lines of points.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceDiagnosis {
    /// What the matrix of each direction says. Steps are those of that direction alone, as a run of
    /// one direction after the other takes them, from the rate.
    pub directions: [Diagnosis; 2],
    /// Forecasts for a net that moves as a whole, from the rate; sor is known for one direction only.
    pub at_once: Vec<Forecast>,
    /// Rows and columns of points fitted.
    pub points: [usize; 2],
    /// The residual that forecasts aim at, in the unit of the data.
    pub residual_target: f64,
    /// Largest residual before the first step.
    pub first_residual: f64,
    /// What was chosen for the caller, and why.
    pub choices: Vec<String>,
}

/// Tells how a surface fit with these options would go, without running it.
///
/// # Errors
/// As [`fit_surface`](super::fit_surface).
pub fn diagnose_surface(
    grid: GridView<'_>,
    options: &SurfaceOptions,
) -> Result<SurfaceDiagnosis, Error> {
    let needed = options.degrees.map(|p| p.saturating_add(1));
    if grid.points().is_empty() {
        return Err(Error::NoPoints { needed: needed[0].saturating_mul(needed[1]) });
    }
    let size = Size::of(Extent::of(grid.points())?);
    let mut choices = Vec::new();
    let (shape, data) = open_up(grid, &size, options, &mut choices);
    let dimension = grid.dimension();
    let data = size.scale.apply(&data);
    let view = GridView::new(shape, dimension, &data)?;
    let u = direction(view, 0, options, &mut choices)?;
    let v = direction(view, 1, options, &mut choices)?;
    let stopping = size.stopping(options.residual, options.iterations, &mut choices)?;

    let tensor = TensorCollocation::new(&u.built.operator, &v.built.operator, dimension);
    let mut vectors = vec![0.0; data.len()];
    let first = tensor.difference_vectors(&data, &data, dimension, &mut vectors).max;
    let target = stopping.residual;
    let told = |k: usize| -> Result<Diagnosis, Error> {
        let direction = [&u, &v][k];
        let matrix: &dyn CollocationMatrix = &direction.built.operator;
        let spacing = Spacing {
            parameters: direction.parameters.values(),
            period: direction.parameters.period(),
            reach: options.degrees[k].div_ceil(2) + 1,
        };
        let mut found = diagnose(matrix, Some(spacing), None)?;
        for forecast in &mut found.forecasts {
            // What is left of the first direction adds to what is left of the second.
            forecast.iterations = steps_at_rate(first, 0.5 * target, forecast.rate);
        }
        Ok(found)
    };
    let directions = [told(0)?, told(1)?];
    let mut both = at_once([&directions[0], &directions[1]]);
    for forecast in &mut both {
        forecast.iterations = steps_at_rate(first, target, forecast.rate);
    }
    Ok(SurfaceDiagnosis {
        directions,
        at_once: both,
        points: shape,
        residual_target: size.scale.undo(target),
        first_residual: size.scale.undo(first),
        choices,
    })
}
