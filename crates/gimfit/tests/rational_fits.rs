//! Laws of fits with given rational weights, judged by full matrices of the definition.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::collocation::{NetWeights, RationalTensorCollocation, interpolation};
use gimfit::iteration::update::{Both, Preconditioned, Rescaled};
use gimfit::iteration::{IterationState, UpdateRule};
use gimfit::knots::place_knots;
use gimfit::parameters::Parameters;
use gimfit::{
    CurveOptions, Duplicates, Error, GridView, IterationWeight, KnotPlacement, Method,
    Parameterization, PointsView, SurfaceFit, SurfaceOptions, SurfaceWeight, fit_curve,
    fit_surface,
};
use gimfit_testkit::dense::{Rows, pia_step, residual_history};
use gimfit_testkit::generate::{Random, random_walk};
use gimfit_testkit::textbook::{collocation_matrix, rational_curve_point};
use std::f64::consts::FRAC_1_SQRT_2;

const METHODS: [Method; 8] = [
    Method::Auto,
    Method::Pia,
    Method::Weighted,
    Method::Jacobi,
    Method::GaussSeidel,
    Method::Chebyshev,
    Method::Anderson { memory: None },
    Method::Preconditioned { half_bandwidth: Some(1) },
];

#[test]
fn a_circle_is_recovered_from_its_points() {
    let knots = vec![0.0, 0.0, 0.0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1.0, 1.0, 1.0];
    let square = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]];
    let square: Rows = square.iter().map(|p| p.iter().map(|&x| f64::from(x)).collect()).collect();
    let weights: Vec<f64> = (0..9).map(|i| if i % 2 == 0 { 1.0 } else { FRAC_1_SQRT_2 }).collect();
    let greville: Vec<f64> = (0..9).map(|i| f64::from(i) / 8.0).collect();
    let data: Vec<f64> = greville
        .iter()
        .flat_map(|&t| rational_curve_point(&knots, 2, &square, &weights, t))
        .collect();
    let options = |method| CurveOptions {
        degree: 2,
        parameterization: Some(Parameterization::Given(greville.clone())),
        knot_placement: Some(KnotPlacement::Given(knots.clone())),
        rational_weights: Some(weights.clone()),
        method,
        ..CurveOptions::default()
    };
    let points = PointsView::new(2, &data).unwrap();
    for method in METHODS {
        let fit = fit_curve(points, &options(method)).unwrap();
        for (found, expected) in fit.curve.control_points().iter().zip(&square) {
            let gap = (found[0] - expected[0]).hypot(found[1] - expected[1]);
            assert!(gap < if method == Method::Auto { 5e-16 } else { 1e-11 }, "{method:?}: {gap}");
        }
        assert_eq!(fit.curve.rational_weights(), Some(&weights[..]));
    }
    // Eigenvalues sqrt 2 - 1, four times, and 1: plain PIA leaves 2 - sqrt 2 in each step.
    let run = fit_curve(points, &options(Method::Pia)).unwrap().report.run;
    for pair in run.history.windows(2).take(20) {
        let rate = pair[1].max_residual / pair[0].max_residual;
        assert!((rate - (2.0 - 2f64.sqrt())).abs() < 1e-8, "{rate}");
    }
    let run = fit_curve(points, &options(Method::Weighted)).unwrap().report.run;
    assert!((run.smallest_eigenvalue.unwrap() - (2f64.sqrt() - 1.0)).abs() < 1e-6);
}

/// The full rational matrix over basis values, from the definition.
fn rational_matrix(basis: &Rows, weights: &[f64]) -> Rows {
    basis
        .iter()
        .map(|row| {
            let lifted: Vec<f64> = row.iter().zip(weights).map(|(b, w)| b * w).collect();
            let sum: f64 = lifted.iter().sum();
            lifted.iter().map(|x| x / sum).collect()
        })
        .collect()
}

fn random_weights(seed: u64, count: usize) -> Vec<f64> {
    let mut random = Random::new(seed);
    (0..count).map(|_| 0.25 + 2.0 * random.unit()).collect()
}

#[test]
fn every_method_interpolates_and_pia_is_that_of_the_full_matrix() {
    let points = random_walk(3, 14, 2);
    let flat = points.concat();
    let view = PointsView::new(2, &flat).unwrap();
    let weights = random_weights(8, 14);
    for (closed, placement) in [
        (false, KnotPlacement::Averaged),
        (true, KnotPlacement::Averaged),
        (false, KnotPlacement::AtData),
    ] {
        for method in METHODS {
            let options = CurveOptions {
                closed,
                parameterization: Some(Parameterization::Centripetal),
                knot_placement: Some(placement.clone()),
                rational_weights: Some(weights.clone()),
                method,
                iterations: 4000,
                residual: Some(1e-9),
                ..CurveOptions::default()
            };
            let fit = fit_curve(view, &options).unwrap();
            assert!(fit.report.converged(), "{method:?} {closed} {placement:?}");
            assert!(fit.curve.rational_weights().is_some());
            for (point, &t) in points.iter().zip(&fit.parameters) {
                let found = fit.curve.evaluate(t).unwrap();
                let gap = (found[0] - point[0]).hypot(found[1] - point[1]);
                assert!(gap < 2e-9, "{method:?} {closed}: {gap}");
            }
            if method == Method::Pia && !closed && placement == KnotPlacement::Averaged {
                let knots = fit.curve.knots().values();
                let basis = collocation_matrix(knots, 3, &fit.parameters);
                let matrix = rational_matrix(&basis, &weights);
                let expected = residual_history(&matrix, &points, pia_step, 30);
                for (entry, expected) in fit.report.run.history.iter().zip(expected) {
                    assert!((entry.max_residual - expected).abs() < 1e-13, "{entry:?}");
                }
            }
        }
    }
}

#[test]
fn weights_follow_their_points_and_bad_ones_are_refused() {
    let points = [[0.0, 0.0], [1.0, 2.0], [1.0, 2.0], [3.0, 3.0], [4.0, 1.0], [6.0, 0.0]];
    let weights = vec![1.0, 2.0, 9.0, 0.5, 1.0, 3.0];
    let options = |weights| CurveOptions {
        duplicates: Duplicates::Drop,
        rational_weights: Some(weights),
        ..CurveOptions::default()
    };
    let fit = fit_curve(&points, &options(weights)).unwrap();
    assert_eq!(fit.curve.rational_weights().unwrap(), [1.0, 2.0, 0.5, 1.0, 3.0]);
    let again = fit_curve(&points, &options(vec![1.0, 2.0, 0.5, 1.0, 3.0])).unwrap();
    assert_eq!(again.curve, fit.curve);
    let error = fit_curve(&points, &options(vec![1.0; 4])).unwrap_err();
    assert!(matches!(error, Error::WrongCount { given: 4, expected: 6, .. }), "{error}");
    let error = fit_curve(&points, &options(vec![1.0, 1.0, -2.0, 1.0, 1.0])).unwrap_err();
    assert!(error.to_string().contains("rational weight 2"), "{error}");
    // Equal weights change nothing.
    let plain = CurveOptions { duplicates: Duplicates::Drop, ..CurveOptions::default() };
    let plain = fit_curve(&points, &plain).unwrap();
    let equal = fit_curve(&points, &options(vec![2.0; 6])).unwrap();
    let pairs = plain.curve.control_points().iter().zip(equal.curve.control_points().iter());
    pairs.for_each(|(a, b)| assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-13));
    // Kept fits are rational, too.
    let kept = CurveOptions {
        keep: vec![2],
        method: Method::Pia,
        ..options(vec![1.0, 2.0, 0.5, 1.0, 3.0])
    };
    let member = fit_curve(&points, &kept).unwrap().member(2).unwrap();
    assert!(member.curve.rational_weights().is_some());
    assert!(member.report.run.max_residual > 1e-6);
}

#[test]
fn bezier_knots_make_one_piece() {
    let points = [[0.0, 0.0], [1.0, 2.0], [3.0, 3.0], [4.0, 1.0], [6.0, 0.0]];
    let options = |degree, closed| CurveOptions {
        degree,
        closed,
        knot_placement: Some(KnotPlacement::Bezier),
        rational_weights: Some(vec![1.0, 2.0, 1.0, 0.5, 1.0]),
        ..CurveOptions::default()
    };
    let fit = fit_curve(&points, &options(4, false)).unwrap();
    assert_eq!(fit.curve.knots().values().len(), 10);
    assert!(fit.report.converged() && fit.report.knot_placement == "bezier");
    let error = fit_curve(&points, &options(3, false)).unwrap_err();
    assert!(error.to_string().contains("points - 1"), "{error}");
    assert!(matches!(fit_curve(&points, &options(4, true)), Err(Error::Incompatible { .. })));
}

/// A grid of 7 by 6 points.
fn grid() -> Vec<f64> {
    let mut random = Random::new(2);
    (0..42).flat_map(|k| [f64::from(k / 6), f64::from(k % 6), random.signed()]).collect()
}

fn fit_grid(
    method: Method,
    weights: &[f64],
    change: impl Fn(&mut SurfaceOptions),
) -> Result<SurfaceFit, Error> {
    let points = grid();
    let mut options = SurfaceOptions {
        method,
        rational_weights: Some(weights.to_vec()),
        iterations: 4000,
        residual: Some(1e-9),
        ..SurfaceOptions::default()
    };
    change(&mut options);
    fit_surface(GridView::new([7, 6], 3, &points).unwrap(), &options)
}

fn largest_gap(fit: &SurfaceFit) -> f64 {
    let points = grid();
    let [u, v] = &fit.parameters;
    let places = u.iter().flat_map(|&u| v.iter().map(move |&v| (u, v)));
    let gaps = places.zip(points.chunks_exact(3)).map(|((u, v), point)| {
        let found = fit.surface.evaluate(u, v).unwrap();
        found.iter().zip(point).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    });
    gaps.fold(0.0, f64::max)
}

#[test]
fn surfaces_take_any_positive_weights() {
    let weights = random_weights(5, 42);
    for method in METHODS {
        // Of a bicubic net as a whole Jacobi diverges, with weights and without.
        let degrees = if method == Method::Jacobi { [2, 2] } else { [3, 3] };
        let fit = fit_grid(method, &weights, |options| options.degrees = degrees).unwrap();
        assert!(fit.report.converged(), "{method:?}");
        assert!(largest_gap(&fit) < 2e-9, "{method:?}");
        assert_eq!(fit.surface.rational_weights(), Some(&weights[..]));
        if method == Method::Auto {
            assert!(fit.report.run.iterations <= 3, "exact through both directions");
        }
    }
    // PIA is that of the full matrix.
    let fit = fit_grid(Method::Pia, &weights, |_| ()).unwrap();
    let [in_u, in_v] =
        [0, 1].map(|k| collocation_matrix(fit.surface.knots()[k].values(), 3, &fit.parameters[k]));
    let product: Rows = in_u
        .iter()
        .flat_map(|a| {
            in_v.iter().map(move |b| a.iter().flat_map(|x| b.iter().map(move |y| x * y)).collect())
        })
        .collect();
    let points: Rows = grid().chunks_exact(3).map(<[f64]>::to_vec).collect();
    let expected = residual_history(&rational_matrix(&product, &weights), &points, pia_step, 25);
    for (entry, expected) in fit.report.run.history.iter().zip(expected) {
        assert!((entry.max_residual - expected).abs() < 1e-12, "{entry:?} {expected}");
    }
}

#[test]
fn weights_that_are_products_run_in_each_direction() {
    let (rows, columns) = (random_weights(6, 7), random_weights(7, 6));
    let weights: Vec<f64> = rows.iter().flat_map(|u| columns.iter().map(move |v| u * v)).collect();
    for per_direction in [false, true] {
        let fit = fit_grid(Method::Pia, &weights, |options| options.per_direction = per_direction)
            .unwrap();
        assert!(fit.report.converged() && largest_gap(&fit) < 2e-9);
    }
    // Others do not, and say why.
    let other = random_weights(9, 42);
    let error = fit_grid(Method::Pia, &other, |options| options.per_direction = true).unwrap_err();
    assert!(error.to_string().contains("no product"), "{error}");
    let error = fit_grid(Method::Weighted, &other, |options| {
        options.weight = SurfaceWeight::Both(IterationWeight::Lemma2);
    });
    assert!(matches!(error, Err(Error::Incompatible { .. })));
    assert!(fit_grid(Method::Pia, &other[1..], |_| ()).is_err());
    let closed = fit_grid(Method::Auto, &other, |options| options.closed = [true, false]).unwrap();
    assert!(closed.report.converged() && largest_gap(&closed) < 2e-9);
}

#[test]
fn a_step_on_a_rational_net_allocates_nothing() {
    let t = |count: usize| Parameters::open((0..count).map(|i| i as f64).collect()).unwrap();
    let operator = |count: usize| {
        let knots = place_knots(3, &t(count), &KnotPlacement::Averaged).unwrap();
        interpolation(&t(count), &knots).unwrap().operator
    };
    let (u, v) = (operator(20), operator(15));
    let net = NetWeights::new(&u, &v, random_weights(1, 300));
    let matrix = RationalTensorCollocation::new(&u, &v, &net, 3);
    let data: Vec<f64> = random_walk(4, 300, 3).concat();
    let both = Both::new(
        Preconditioned::new(&u, None).unwrap(),
        Preconditioned::new(&v, None).unwrap(),
        15,
    );
    let mut rule: Box<dyn UpdateRule> = Box::new(Rescaled::new(both, &net));
    let mut state = IterationState::begin(&matrix, &data, 3);
    let counted = allocation_counter::measure(|| (0..3).for_each(|_| state.step(rule.as_mut())));
    assert_eq!(counted.count_total, 0);
    assert!(state.norms().max < 1e-10);
}
