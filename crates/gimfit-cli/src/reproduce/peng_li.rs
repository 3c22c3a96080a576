//! Peng and Li: the tables of their public programs on SaLSPIA: steps of the LSPIA family until the
//! square of the gradient, relative to that of the start, falls below 1e-6.

use super::table::{Entry, Part, Source, Table};
use anyhow::Context;
use gimfit::PointsView;
use gimfit::collocation::{
    CollocationOperator, LeastSquaresCollocation, NormalMatrix, TensorCollocation,
};
use gimfit::iteration::update::{
    ConjugateGradients, HeavyBall, Nesterov, PerPoint, Preconditioner, SaLspia, Weighted,
};
use gimfit::iteration::{IterationState, UpdateRule};
use gimfit::knots::{KnotVector, place_least_squares_knots};
use gimfit::parameters::{Parameterization, assign_parameters};
use std::f64::consts::{FRAC_PI_4, TAU};

/// Relative square of the gradient at which their runs end.
const ENOUGH: f64 = 1e-6;
/// More steps than any run needs that ends.
const MOST: usize = 2000;

pub(super) fn recompute() -> anyhow::Result<Table> {
    let mut parts = curve()?;
    parts.extend(surface()?);
    parts.extend(with_gaps()?);
    Ok(Table {
        title: "Peng and Li, tables of their programs: LSPIA and relatives until E_k < 1e-6",
        parts,
    })
}

/// A case ready to run: an operator, its data, a start.
struct Case<'a> {
    operator: &'a dyn CollocationOperator,
    data: &'a [f64],
    start: &'a [f64],
    dimension: usize,
}

impl Case<'_> {
    /// Steps until the criterion is met, and the root mean square there.
    fn steps(&self, rule: &mut dyn UpdateRule) -> (f64, f64) {
        let mut state =
            IterationState::begin_at(self.operator, self.data, self.start, self.dimension);
        let square = |state: &IterationState<'_>| {
            state.difference_vectors().iter().map(|x| x * x).sum::<f64>()
        };
        let first = square(&state);
        while square(&state) >= ENOUGH * first && state.iteration() < MOST {
            state.step(rule);
        }
        (state.iteration() as f64, state.norms().rms)
    }
}

/// A count of steps: it is met or not.
fn count(label: &str, printed: &'static str, steps: f64) -> anyhow::Result<Entry> {
    let value = printed.parse().with_context(|| format!("count {printed}"))?;
    Ok(Entry::counted(label.into(), (printed.into(), value), steps))
}

/// The rules with published counts, and those of ours.
struct Counts {
    lspia: &'static str,
    alspia: &'static str,
    mlspia: &'static str,
    nmlspia: &'static str,
    salspia: &'static str,
    column_sums: &'static str,
    cgls: &'static str,
}

/// Runs all rules on a case whose normal matrix has these extreme eigenvalues.
fn all(
    heading: &str,
    case: &Case<'_>,
    normal: &dyn CollocationOperator,
    (low, high): (f64, f64),
    sums: &[f64],
    counts: &Counts,
) -> anyhow::Result<(Vec<Part>, f64)> {
    let length = case.start.len();
    let largest = sums.iter().copied().fold(0.0, f64::max);
    let best = case.steps(&mut Weighted::new(2.0 / (low + high)));
    let reciprocal = sums.iter().map(|c| 1.0 / c).collect();
    let paper = vec![
        count("LSPIA, 2/(l+L)", counts.lspia, best.0)?,
        count("ALSPIA, as 1/L", counts.alspia, case.steps(&mut Weighted::new(1.0 / high)).0)?,
        count("MLSPIA", counts.mlspia, case.steps(&mut HeavyBall::best_for(low, high, length)).0)?,
        count("NmLSPIA", counts.nmlspia, case.steps(&mut Nesterov::best_for(low, high, length)).0)?,
        count(
            "SaLSPIA",
            counts.salspia,
            case.steps(&mut SaLspia::new(normal, largest, case.dimension)).0,
        )?,
    ];
    let mut gradients = ConjugateGradients::new(normal, Preconditioner::Identity, case.dimension);
    let ours = vec![
        count("column sums", counts.column_sums, case.steps(&mut PerPoint::new(reciprocal)).0)?,
        count("CGLS", counts.cgls, case.steps(&mut gradients).0)?,
    ];
    let parts = vec![
        Part::Entries {
            heading: format!("{heading}: steps"),
            source: Source::Paper,
            entries: paper,
        },
        Part::Entries {
            heading: format!("{heading}: steps of methods that the tables leave out"),
            source: Source::Independent,
            entries: ours,
        },
    ];
    Ok((parts, best.1))
}

/// The closed-looking curve of the tables, flat rows of two coordinates.
fn blob(count: usize) -> Vec<f64> {
    (0..count)
        .map(|j| TAU * (j as f64 / (count - 1) as f64))
        .flat_map(|t| {
            let r = 2.0 + 4.0 * (2.0 * t + FRAC_PI_4).cos() + (3.0 * t + FRAC_PI_4).cos();
            [r * t.cos(), r * t.sin()]
        })
        .collect()
}

/// Data points at equal steps of their number.
fn chosen(data: &[f64], dimension: usize, control_points: usize) -> Vec<f64> {
    let count = data.len() / dimension;
    (0..control_points)
        .map(|i| (count * i / (control_points - 1)).min(count - 1))
        .flat_map(|j| data[j * dimension..][..dimension].iter().copied())
        .collect()
}

fn curve() -> anyhow::Result<Vec<Part>> {
    const CONTROL: usize = 3001;
    let data = blob(15_001);
    let t = assign_parameters(PointsView::new(2, &data)?, false, &Parameterization::Chord)?;
    let knots = place_least_squares_knots(3, &t, CONTROL)?;
    let operator = LeastSquaresCollocation::new(t.values(), &knots)?;
    let normal = operator.normal_matrix();
    let (low, high) = normal.eigenvalues().context("eigenvalues of the curve")?;
    let start = chosen(&data, 2, CONTROL);
    let case = Case { operator: &operator, data: &data, start: &start, dimension: 2 };
    let counts = Counts {
        lspia: "77",
        alspia: "6",
        mlspia: "25",
        nmlspia: "5",
        salspia: "4",
        column_sums: "2",
        cgls: "4",
    };
    let heading = "Curve of 15001 points, 3001 control points";
    let sums = operator.column_sums();
    let (mut parts, rms) = all(heading, &case, normal.matrix(), (low, high), sums, &counts)?;
    parts.push(Part::Entries {
        heading: format!("{heading}: condition of A, and what LSPIA leaves"),
        source: Source::Paper,
        entries: vec![
            Entry::printed("condition".into(), "4.719154", 7, (high / low).sqrt(), 1.0),
            Entry::printed("rms".into(), "1.0727e-5", 5, rms, 1e-9),
        ],
    });
    Ok(parts)
}

/// MATLAB's peaks.
fn peaks(x: f64, y: f64) -> f64 {
    3.0 * (1.0 - x).powi(2) * (-x * x - (y + 1.0).powi(2)).exp()
        - 10.0 * (x / 5.0 - x.powi(3) - y.powi(5)) * (-x * x - y * y).exp()
        - (-(x + 1.0).powi(2) - y * y).exp() / 3.0
}

fn surface() -> anyhow::Result<Vec<Part>> {
    const M: usize = 121;
    const N: usize = 41;
    const D: usize = 3;
    let share = |j: usize| j as f64 / (M - 1) as f64;
    let t: Vec<f64> = (0..M).map(share).collect();
    let mut knots = vec![0.0; 3];
    knots.extend((0..=N - 3).map(|i| i as f64 / (N - 3) as f64));
    knots.extend([1.0; 3]);
    let operator = LeastSquaresCollocation::new(&t, &KnotVector::open(3, knots)?)?;
    let normal = operator.normal_matrix();
    let (low, high) = normal.eigenvalues().context("eigenvalues of a direction")?;
    let data: Vec<f64> = (0..M)
        .flat_map(|i| (0..M).map(move |j| (-3.0 + 6.0 * share(i), -4.0 + 8.0 * share(j))))
        .flat_map(|(x, y)| [x, y, peaks(x, y)])
        .collect();
    // Steps of the normal equations of both directions: their data are A_u^T Q A_v.
    let gather = |data: &[f64], dimension: usize| {
        let (zero, mut result) = (vec![0.0; N * dimension], vec![0.0; N * dimension]);
        operator.difference_vectors(data, &zero, dimension, &mut result);
        result
    };
    let in_u = gather(&data, M * D);
    let right: Vec<f64> = in_u.chunks_exact(M * D).flat_map(|row| gather(row, D)).collect();
    let place = |i: usize| (i as f64 * (M - 1) as f64 / (N - 1) as f64).round() as usize;
    let start: Vec<f64> = (0..N)
        .flat_map(|i| (0..N).map(move |j| place(i) * M + place(j)))
        .flat_map(|k| data[k * D..][..D].iter().copied())
        .collect();
    let both = TensorCollocation::new(normal.matrix(), normal.matrix(), D);
    let sums: Vec<f64> = products(&normal);
    let case = Case { operator: &both, data: &right, start: &start, dimension: D };
    let counts = Counts {
        lspia: "1091",
        alspia: "15",
        mlspia: "109",
        nmlspia: "17",
        salspia: "8",
        column_sums: "6",
        cgls: "7",
    };
    let heading = "Peaks, 121 x 121 points, 41 x 41 control points";
    let extremes = (low * low, high * high);
    let (mut parts, _) = all(heading, &case, &both, extremes, &sums, &counts)?;
    parts.push(Part::Entries {
        heading: format!("{heading}: condition of A"),
        source: Source::Paper,
        entries: vec![Entry::printed("condition".into(), "21.220866", 8, high / low, 1.0)],
    });
    Ok(parts)
}

/// Column sums of both directions, multiplied.
fn products(normal: &NormalMatrix) -> Vec<f64> {
    let sums = normal.column_sums();
    sums.iter().flat_map(|u| sums.iter().map(move |v| u * v)).collect()
}

fn with_gaps() -> anyhow::Result<Vec<Part>> {
    const CONTROL: usize = 101;
    let all = blob(331);
    let t = assign_parameters(PointsView::new(2, &all)?, false, &Parameterization::Chord)?;
    let knots = place_least_squares_knots(3, &t, CONTROL)?;
    let outside = |t: f64| [0.2, 0.42, 0.62, 0.82].iter().all(|centre| (t - centre).abs() > 0.02);
    let kept: Vec<usize> = (0..331).filter(|&j| outside(t.values()[j])).collect();
    let data: Vec<f64> = kept.iter().flat_map(|&j| [all[2 * j], all[2 * j + 1]]).collect();
    let t: Vec<f64> = kept.iter().map(|&j| t.values()[j]).collect();
    let operator = LeastSquaresCollocation::new(&t, &knots)?;
    let normal = operator.normal_matrix();
    let (low, high) = normal.eigenvalues().context("eigenvalues of the curve with gaps")?;
    let start = chosen(&all, 2, CONTROL);
    let case = Case { operator: &operator, data: &data, start: &start, dimension: 2 };
    let steps = case.steps(&mut PerPoint::new(normal.reciprocal_sums())).0;
    Ok(vec![Part::Entries {
        heading: "Curve of 331 points with four gaps, 101 control points".into(),
        source: Source::Paper,
        entries: vec![
            count("points left", "267", kept.len() as f64)?,
            count("column sums, steps", "18", steps)?,
            Entry::printed("condition".into(), "6.479e5", 4, (high / low).sqrt(), 1.0),
        ],
    }])
}
