//! What a diagnosis says, held against papers, dense oracles and the runs themselves.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::basis::{BlendingBasis, WangBall};
use gimfit::collocation::{
    CollocationMatrix, DenseCollocation, all_eigenvalues, interpolation, lemma2_weight,
    rate_with_weight,
};
use gimfit::diagnosis::{Diagnosis, Dominance, TotalPositivity, diagnose, dominance, dominates};
use gimfit::iteration::IterationState;
use gimfit::iteration::update::{Pia, Weighted};
use gimfit::knots::place_knots;
use gimfit::parameters::{Parameters, assign_parameters};
use gimfit::{
    CurveOptions, Error, IterationWeight, KnotPlacement, Method, Parameterization, Points,
    diagnose_curve, fit_curve,
};
use gimfit_testkit::dense::{self, Rows};
use gimfit_testkit::generate::{Random, graded, helix, random_walk};

fn points(rows: &Rows) -> Points {
    Points::new(rows[0].len(), rows.concat()).unwrap()
}

fn uniform(count: usize) -> Parameters {
    Parameters::open((0..count).map(|i| i as f64 / (count - 1) as f64).collect()).unwrap()
}

fn alone(matrix: &dyn CollocationMatrix) -> Diagnosis {
    diagnose(matrix, None, None).unwrap()
}

/// Chen, Wang and Jin (2012), example 1.
#[test]
fn wang_ball_of_degree_four_is_what_the_paper_says() {
    let matrix = DenseCollocation::new(&WangBall::new(4).unwrap(), &uniform(5)).unwrap();
    // The paper's own certificate; without scaling the diagonal does not dominate.
    assert!(dominates(&matrix, &[0.01, 1.0, 1.1, 1.0, 0.01]));
    assert!(!dominates(&matrix, &[1.0; 5]) && !dominates(&matrix, &[0.01, 1.0, -1.1, 1.0, 0.01]));
    let found = alone(&matrix);
    let eigenvalues = found.eigenvalues.as_ref().unwrap();
    for (value, printed) in eigenvalues.iter().zip([1.0, 1.0, 0.4299, 0.1875, 0.0545]) {
        assert!((value.re - printed).abs() < 5e-5 && value.im == 0.0, "{value:?}");
    }
    assert_eq!(found.total_positivity, TotalPositivity::Refuted);
    assert_eq!(found.lemma2_weight, Some(1.0));
    let Dominance::Generalised { scaling } = found.dominance else { panic!("not GDD") };
    for j in 0..5 {
        let sum: f64 = (0..5).filter(|&i| i != j).map(|i| matrix.row(j)[i] * scaling[i]).sum();
        assert!(matrix.row(j)[j] * scaling[j] > sum);
    }
}

fn bernstein(degree: usize) -> gimfit::collocation::BandedCollocation {
    let t = uniform(degree + 1);
    let knots = place_knots(degree, &t, &KnotPlacement::Averaged).unwrap();
    interpolation(&t, &knots).unwrap().operator
}

/// Chen, Wang and Jin (2012), example 2, and rates recomputed independently.
#[test]
fn the_bernstein_basis_of_degree_ten_is_not_dominant_and_slow() {
    let found = alone(&bernstein(10));
    assert_eq!(found.dominance, Dominance::None);
    assert_eq!(found.total_positivity, TotalPositivity::Known);
    let (low, high) = found.largest_singular_value;
    assert!((1.1012 - low).abs() < 5e-5 && high - low < 1e-6, "{low} {high}");
    let least = (1..=10).product::<usize>() as f64 / 1e10;
    assert!((found.smallest.estimate - least).abs() < 1e-9, "{:?}", found.smallest);
    let rates: Vec<f64> = found.forecasts.iter().map(|forecast| forecast.rate).collect();
    for (rate, known) in rates.iter().zip([0.99964, 0.99927, 2.36, 0.9971]) {
        assert!((rate - known).abs() < 0.005 * (known - 0.99_f64).abs().max(0.002), "{rates:?}");
    }
}

#[test]
fn conditions_are_those_of_the_dense_inverse() {
    for (seed, degree, closed) in [(1, 3, false), (2, 4, false), (3, 3, true), (4, 2, true)] {
        let data = points(&random_walk(seed, 17, 2));
        let t = assign_parameters(data.as_view(), closed, &Parameterization::Chord).unwrap();
        let knots = place_knots(degree, &t, &KnotPlacement::Averaged).unwrap();
        let matrix = interpolation(&t, &knots).unwrap().operator;
        let mut full = vec![vec![0.0; 17]; 17];
        for (j, row) in full.iter_mut().enumerate() {
            matrix.row(j).for_each(|(column, weight)| row[column] += weight);
        }
        let unit: Rows =
            (0..17).map(|i| (0..17).map(|j| f64::from(u8::from(i == j))).collect()).collect();
        let norm = |rows: &Rows| {
            rows.iter().map(|row| row.iter().map(|x| x.abs()).sum::<f64>()).fold(0.0, f64::max)
        };
        let expected = norm(&full) * norm(&dense::solve(&full, &unit));
        let found = alone(&matrix).condition;
        assert!(found.exact && (found.value - expected).abs() < 1e-9 * expected, "{found:?}");
    }
}

/// For nonnegative matrices with a positive diagonal, the comparison matrix is an M-matrix exactly
/// if Jacobi converges: two routes to one answer.
#[test]
fn the_diagonal_dominates_exactly_where_jacobi_converges() {
    let mut random = Random::new(8);
    let mut seen = [0, 0];
    for case in 0..60 {
        let degree = 2 + case % 5;
        let mut sum = 0.0;
        let t = (0..degree + 3 + case % 20).map(|_| {
            sum += 0.02 + random.unit().powi(3);
            sum
        });
        let t = Parameters::open(t.collect()).unwrap();
        let knots = place_knots(degree, &t, &KnotPlacement::Averaged).unwrap();
        let matrix = interpolation(&t, &knots).unwrap().operator;
        let found = alone(&matrix);
        let jacobi = &found.forecasts[2];
        assert_eq!(jacobi.method, "jacobi");
        assert_eq!(found.dominance.is_generalised(), jacobi.converges(), "{degree} {jacobi:?}");
        if let Dominance::Generalised { scaling } = dominance(&matrix) {
            assert!(dominates(&matrix, &scaling));
        }
        seen[usize::from(jacobi.converges())] += 1;
    }
    assert!(seen.iter().all(|&count| count > 5), "{seen:?}");
}

const METHODS: [Method; 6] = [
    Method::Pia,
    Method::Weighted,
    Method::Jacobi,
    Method::GaussSeidel,
    Method::Sor,
    Method::Chebyshev,
];

/// Predicted and measured steps may differ by this share, and by two.
fn compare(data: &Points, options: &CurveOptions, share: f64) -> usize {
    let found = diagnose_curve(data, options).unwrap();
    let mut compared = 0;
    for (method, forecast) in METHODS.into_iter().zip(&found.matrix.forecasts) {
        let options = CurveOptions { method, iterations: 3000, ..options.clone() };
        let run = fit_curve(data, &options).unwrap().report.run;
        let case =
            format!("{method:?} {} {}: {forecast:?} {run:?}", options.degree, options.closed);
        assert_eq!(found.residual_target, run.residual_target, "{case}");
        if let Some(predicted) = forecast.iterations.filter(|&steps| steps < 3000) {
            let gap = (predicted as f64 - run.iterations as f64).abs();
            assert!(run.converged() && gap <= 2.0 + share * predicted as f64, "{case}");
            compared += 1;
        } else {
            assert!(!run.converged(), "{case}");
        }
    }
    compared
}

#[test]
fn predicted_steps_are_those_of_the_runs() {
    let mut compared = 0;
    for (seed, degree, closed) in
        [(1, 2, false), (2, 3, false), (3, 3, true), (4, 5, false), (5, 4, true), (6, 1, false)]
    {
        let data = points(&random_walk(seed, 24, 3));
        let options = CurveOptions { degree, closed, residual: Some(1e-8), ..Default::default() };
        compared += compare(&data, &options, 0.01);
    }
    assert!(compared > 25, "{compared}");
}

#[test]
fn windows_stand_for_long_curves() {
    let data = Points::new(3, helix(200)).unwrap();
    let options = CurveOptions { residual: Some(1e-9), ..Default::default() };
    assert_eq!(compare(&data, &options, 0.08), 6);
}

/// Steps that grow threefold, degree 4: the smallest eigenvalue is 0.0115, the condition 1e17.
#[test]
fn a_matrix_far_from_normal_is_told_by_its_condition_and_growth() {
    let data = points(&graded(24, 3.0));
    let options = CurveOptions { degree: 4, ..Default::default() };
    let found = diagnose_curve(&data, &options).unwrap();
    assert!((found.matrix.smallest.estimate - 0.01147).abs() < 1e-4);
    assert!(found.matrix.condition.value > 1e16 && found.rounding > found.residual_target);
    // Though its rate is 0.9885, no run gets there: residuals rise too far first.
    for (method, forecast) in
        [Method::Pia, Method::Weighted].into_iter().zip(&found.matrix.forecasts)
    {
        assert!(forecast.converges() && forecast.growth > 1e10 && forecast.stalls, "{forecast:?}");
        let options = CurveOptions { method, iterations: 10_000, ..options.clone() };
        assert!(!fit_curve(&data, &options).unwrap().report.run.converged());
    }
}

/// Functions whose matrix at 0, 1, 2 is circulant: eigenvalues 1 and two complex ones at a distance
/// of more than 1 from 1.
#[derive(Debug)]
struct Turning;

impl BlendingBasis for Turning {
    fn name(&self) -> &'static str {
        "turning"
    }

    fn functions(&self) -> usize {
        3
    }

    fn domain(&self) -> (f64, f64) {
        (0.0, 2.0)
    }

    fn evaluate_into(&self, t: f64, values: &mut [f64]) {
        let shift = t.round() as usize;
        for (i, value) in values.iter_mut().enumerate() {
            *value = [0.4, 0.6, 0.0][(i + 3 - shift) % 3];
        }
    }
}

/// Chen, Wang and Jin (2012), Lemma 2.
#[test]
fn the_weight_of_lemma_2_converges_where_plain_pia_diverges() {
    let parameters = Parameters::open(vec![0.0, 1.0, 2.0]).unwrap();
    let matrix = DenseCollocation::new(&Turning, &parameters).unwrap();
    let all = all_eigenvalues(&matrix).unwrap().unwrap();
    let omega = lemma2_weight(&all).unwrap();
    // a / (a^2 + b^2) of 0.4 + 0.6 exp(2 pi i / 3).
    let (a, b) = (0.4 - 0.3, 0.6 * 0.75_f64.sqrt());
    assert!((omega - a / (a * a + b * b)).abs() < 1e-12);
    assert!(rate_with_weight(&all, 1.0) > 1.0 && rate_with_weight(&all, omega) < 1.0);
    let data = [1.0, -2.0, 0.5];
    let residual = |omega: f64, steps: usize| {
        let mut state = IterationState::begin(&matrix, &data, 1);
        (0..steps).for_each(|_| state.step(&mut Weighted::new(omega)));
        state.norms().max
    };
    assert!(residual(omega, 1500) < 1e-9 && residual(1.0, 1500) > 1e9);
    let found = alone(&matrix);
    assert!(!found.forecasts[0].converges() && found.forecasts[1].converges());
    let (best, rate) = found.best_weight.unwrap();
    assert!(rate <= rate_with_weight(&all, omega) && best > 0.0);
    let mut state = IterationState::begin(&matrix, &data, 1);
    state.step(&mut Pia);
    assert!(state.norms().max > 0.0);
}

#[test]
fn lemma_2_leaves_splines_alone_and_names_what_it_cannot_help() {
    let data = points(&random_walk(4, 40, 2));
    let options = CurveOptions {
        method: Method::Weighted,
        weight: IterationWeight::Lemma2,
        ..Default::default()
    };
    let plain = CurveOptions { method: Method::Pia, ..Default::default() };
    for closed in [false, true] {
        let run = |options: &CurveOptions| {
            fit_curve(&data, &CurveOptions { closed, ..options.clone() }).unwrap().report.run
        };
        assert_eq!(run(&options).history, run(&plain).history);
        assert!(run(&options).choices.iter().any(|choice| choice.contains("Lemma 2")));
    }
    let other = CurveOptions { method: Method::Jacobi, ..options };
    assert!(matches!(fit_curve(&data, &other), Err(Error::Incompatible { .. })));
}

#[test]
fn places_name_the_points_that_are_too_close() {
    let mut rows: Rows = (0..40).map(|i| vec![f64::from(i), (0.3 * f64::from(i)).sin()]).collect();
    rows[23] = vec![rows[22][0] + 1e-4, rows[22][1]];
    let found = diagnose_curve(&points(&rows), &CurveOptions::default()).unwrap().matrix;
    for place in [found.slowest.unwrap(), found.most_sensitive.unwrap()] {
        assert_eq!(place.shortest, 22, "{place:?}");
        assert!(place.ratio > 1e3 && place.point.abs_diff(22) <= 2, "{place:?}");
    }
}

#[test]
fn no_data_make_a_diagnosis_panic_or_tell_no_number() {
    let options = CurveOptions::default();
    let refused = |data: &[f64], dimension: usize| {
        let data = Points::new(dimension, data.to_vec()).unwrap();
        diagnose_curve(&data, &options).unwrap_err()
    };
    assert!(matches!(refused(&[], 2), Error::NoPoints { .. }));
    assert!(matches!(refused(&[1.0, 2.0], 2), Error::TooFewPoints { .. }));
    assert!(matches!(refused(&[1.0; 12], 2), Error::AllPointsEqual { .. }));
    let mut broken = random_walk(1, 9, 2).concat();
    broken[7] = f64::NAN;
    assert!(matches!(refused(&broken, 2), Error::NotFinite { point: 3, .. }));
    for dimension in [1, 2, 3, 7] {
        for (scale, origin) in [(1.0, 0.0), (1e300, 0.0), (1e-300, 0.0), (1.0, 1e9)] {
            let data = random_walk(3, 20, dimension).concat();
            let data = data.iter().map(|x| scale * x + origin).collect();
            let found = diagnose_curve(&Points::new(dimension, data).unwrap(), &options).unwrap();
            assert!(found.residual_target > 0.0 && found.rounding.is_finite());
            assert!(found.matrix.condition.value >= 1.0);
            assert!(found.matrix.forecasts.iter().all(|forecast| forecast.rate.is_finite()));
        }
    }
    // The least possible, and residuals that are zero from the start.
    for closed in [false, true] {
        let least = points(&random_walk(2, 4, 2));
        let options = CurveOptions { closed, ..Default::default() };
        assert!(diagnose_curve(&least, &options).unwrap().matrix.points == 4);
    }
    let line = points(&(0..9).map(|i| vec![f64::from(i)]).collect());
    let found = diagnose_curve(&line, &CurveOptions { degree: 1, ..Default::default() }).unwrap();
    assert!(found.matrix.forecasts.iter().all(|forecast| forecast.iterations == Some(0)));
}

#[test]
fn grids_are_told_by_products_of_eigenvalues() {
    let points: Vec<f64> = (0..12 * 9)
        .flat_map(|k| {
            let (x, y) = (f64::from(k / 9), f64::from(k % 9));
            [x, y + 0.1 * (x * y).sin(), (0.7 * x).sin() * (0.5 * y).cos()]
        })
        .collect();
    let grid = gimfit::GridView::new([12, 9], 3, &points).unwrap();
    let options =
        gimfit::SurfaceOptions { degrees: [3, 2], residual: Some(1e-9), ..Default::default() };
    let found = gimfit::diagnose_surface(grid, &options).unwrap();
    let methods =
        [Method::Pia, Method::Weighted, Method::Jacobi, Method::GaussSeidel, Method::Chebyshev];
    for (method, forecast) in methods.into_iter().zip(&found.at_once) {
        let options = gimfit::SurfaceOptions { method, ..options.clone() };
        let Some(predicted) = forecast.iterations.filter(|_| forecast.converges()) else {
            // The fit refuses what would diverge.
            assert!(gimfit::fit_surface(grid, &options).is_err(), "{forecast:?}");
            continue;
        };
        let run = gimfit::fit_surface(grid, &options).unwrap().report.run;
        let predicted = predicted as f64;
        let measured = run.iterations as f64;
        assert!((measured - predicted).abs() <= 1.0, "{forecast:?} {measured}");
    }
    for (k, method) in
        [(0, Method::Pia), (3, Method::GaussSeidel), (4, Method::Sor), (5, Method::Chebyshev)]
    {
        let options = gimfit::SurfaceOptions { method, per_direction: true, ..options.clone() };
        let run = gimfit::fit_surface(grid, &options).unwrap().report.run;
        let each = found.directions.each_ref().map(|told| told.forecasts[k].iterations.unwrap());
        let measured = run.iterations as u64;
        assert!((each[0] + each[1]).abs_diff(measured) <= 2, "{method:?}: {each:?} {measured}");
    }
    assert_eq!(found.lemma2_weight, Some(1.0));
    let [u, v] = found.directions.each_ref().map(|told| told.condition.value);
    assert!((found.condition / (u * v) - 1.0).abs() < 1e-12);
    // Rational weights that are no product, and other bases.
    let weights: Vec<f64> = (0..108).map(|k| 1.0 + f64::from(k * k % 7)).collect();
    let rational = gimfit::SurfaceOptions { rational_weights: Some(weights), ..options.clone() };
    let found = gimfit::diagnose_surface(grid, &rational).unwrap();
    for (method, forecast) in methods.into_iter().zip(&found.at_once) {
        let options = gimfit::SurfaceOptions { method, ..rational.clone() };
        if let (Ok(fit), Some(predicted)) =
            (gimfit::fit_surface(grid, &options), forecast.iterations)
        {
            let measured = fit.report.run.iterations as u64;
            assert!(measured.abs_diff(predicted) <= 1 + measured / 20, "{forecast:?} {measured}");
        }
    }
    let bases =
        [gimfit::basis::SaidBall::new(11).unwrap(), gimfit::basis::SaidBall::new(8).unwrap()];
    let over = gimfit::BlendingSurfaceOptions { residual: Some(1e-3), ..Default::default() };
    let found = gimfit::diagnose_blending_surface(grid, [&bases[0], &bases[1]], &over).unwrap();
    let over = gimfit::BlendingSurfaceOptions { method: Method::GaussSeidel, ..over };
    let bases = bases.map(|basis| {
        std::sync::Arc::new(basis) as std::sync::Arc<dyn gimfit::basis::BlendingBasis>
    });
    let run = gimfit::fit_blending_surface(grid, bases, &over).unwrap().report.run;
    if let Some(predicted) = found.at_once[3].iterations.filter(|&steps| steps < 1000) {
        assert!(predicted.abs_diff(run.iterations as u64) <= 1, "{predicted} {}", run.iterations);
    }
    let broken = gimfit::GridView::new([2, 2], 1, &[1.0, 2.0, 3.0, 4.0]).unwrap();
    assert!(gimfit::diagnose_surface(broken, &options).is_err());
}
