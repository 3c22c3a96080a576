//! Values so large that sums and differences of them would overflow, drawn in units of 10³⁰⁰.

use super::{CurveFigure, CurveSamples, SequenceCurve};
use std::ops::Deref;

/// Values beyond this size are drawn in larger units.
const LARGE: f64 = 1.0e290;

/// The power of ten of those units: the largest double is a few hundred million of them.
const EXPONENT: i32 = 300;

/// Numbers of a figure in units that leave room for arithmetic.
pub(super) struct Scaled {
    data: Vec<f64>,
    control: Vec<f64>,
    samples: Vec<f64>,
    beziers: Option<Vec<f64>>,
    sequence: Vec<(Vec<f64>, Vec<f64>)>,
    /// Of the data points, the control points and the samples.
    parameters: [Vec<f64>; 3],
    /// The unit of each coordinate as a power of ten.
    units: Vec<i32>,
    parameter_unit: i32,
}

impl Scaled {
    /// The numbers of `figure`, if some are too large to be drawn as they are. The data decide:
    /// what strays further is cut away. Coordinates that share a scale share a unit.
    pub(super) fn of(figure: &CurveFigure<'_>) -> Option<Self> {
        let dimension = figure.dimension;
        let mut units: Vec<i32> = (0..dimension)
            .map(|k| unit(figure.data().iter().filter_map(|row| row.get(k))))
            .collect();
        if matches!(dimension, 2 | 3) {
            let largest = units.iter().copied().max().unwrap_or(0);
            units.fill(largest);
        }
        let parameter_unit = unit(figure.parameters.iter());
        if parameter_unit == 0 && units.iter().all(|unit| *unit == 0) {
            return None;
        }
        let coordinates = |flat: &[f64]| -> Vec<f64> {
            flat.iter().zip(units.iter().cycle()).map(|(x, unit)| x * factor(*unit)).collect()
        };
        let along =
            |list: &[f64]| list.iter().map(|t| t * factor(parameter_unit)).collect::<Vec<f64>>();
        let sequence = figure.sequence.iter();
        Some(Self {
            data: coordinates(figure.data_points),
            control: coordinates(figure.control_points),
            samples: coordinates(figure.curve_samples.points),
            beziers: figure.curve_samples.beziers.map(coordinates),
            sequence: sequence
                .map(|kept| (along(kept.curve.parameters), coordinates(kept.curve.points)))
                .collect(),
            parameters: [
                along(figure.parameters),
                along(figure.abscissae_of_control_points),
                along(figure.curve_samples.parameters),
            ],
            units,
            parameter_unit,
        })
    }

    /// The kept curves, with the iterations of `figure`.
    pub(super) fn sequence<'a>(&'a self, figure: &CurveFigure<'_>) -> Vec<SequenceCurve<'a>> {
        let kept = figure.sequence.iter().zip(&self.sequence);
        kept.map(|(kept, (parameters, points))| SequenceCurve {
            iteration: kept.iteration,
            curve: CurveSamples { parameters, points, beziers: None },
        })
        .collect()
    }
}

fn unit<'a>(mut values: impl Iterator<Item = &'a f64>) -> i32 {
    if values.any(|x| x.abs() > LARGE && x.is_finite()) { EXPONENT } else { 0 }
}

fn factor(unit: i32) -> f64 {
    if unit == 0 { 1.0 } else { 1.0e-300 }
}

/// A figure and the units it is drawn in.
pub(super) struct InUnits<'a> {
    figure: CurveFigure<'a>,
    units: &'a [i32],
    /// The unit of the parameters, as a power of ten.
    pub(super) parameter_unit: i32,
}

impl<'a> InUnits<'a> {
    /// `figure` as it is, or with the numbers of `scaled` and their `sequence`.
    pub(super) fn new(
        figure: &CurveFigure<'a>,
        scaled: Option<&'a Scaled>,
        sequence: &'a [SequenceCurve<'a>],
    ) -> Self {
        let Some(scaled) = scaled else {
            return Self { figure: *figure, units: &[], parameter_unit: 0 };
        };
        let [parameters, abscissae_of_control_points, samples] = &scaled.parameters;
        Self {
            figure: CurveFigure {
                data_points: &scaled.data,
                parameters,
                control_points: &scaled.control,
                abscissae_of_control_points,
                curve_samples: CurveSamples {
                    parameters: samples,
                    points: &scaled.samples,
                    beziers: scaled.beziers.as_deref(),
                },
                sequence,
                ..*figure
            },
            units: &scaled.units,
            parameter_unit: scaled.parameter_unit,
        }
    }

    /// The unit of coordinate `k`, as a power of ten.
    pub(super) fn unit(&self, k: usize) -> i32 {
        self.units.get(k).copied().unwrap_or(0)
    }
}

impl<'a> Deref for InUnits<'a> {
    type Target = CurveFigure<'a>;

    fn deref(&self) -> &CurveFigure<'a> {
        &self.figure
    }
}
