//! Laws of fits over blending bases, judged by dense oracles that share no code with the library.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::basis::{Bernstein, BlendingBasis, Dp, Rational, SaidBall, WangBall};
use gimfit::{
    BlendingCurveFit, BlendingOptions, BlendingSurfaceOptions, Error, GridView, IterationWeight,
    Method, Parameterization, PointsView, Termination, fit_blending_curve, fit_blending_surface,
};
use gimfit_testkit::blending;
use gimfit_testkit::dense::{self, Rows};
use gimfit_testkit::generate::Random;
use std::f64::consts::{FRAC_1_SQRT_2, PI};
use std::sync::Arc;

type Textbook = fn(usize, usize, f64) -> f64;

fn named(degree: usize) -> [(Arc<dyn BlendingBasis>, Textbook); 4] {
    [
        (Arc::new(Bernstein::new(degree).unwrap()), blending::bernstein),
        (Arc::new(WangBall::new(degree).unwrap()), blending::wang_ball),
        (Arc::new(SaidBall::new(degree).unwrap()), blending::said_ball),
        (Arc::new(Dp::new(degree).unwrap()), blending::dp),
    ]
}

fn random_points(count: usize, dimension: usize, seed: u64) -> Rows {
    let mut random = Random::new(seed);
    (0..count).map(|_| (0..dimension).map(|_| random.signed()).collect()).collect()
}

fn matrix(degree: usize, function: Textbook) -> Rows {
    let t = |j: usize| j as f64 / degree as f64;
    (0..=degree).map(|j| (0..=degree).map(|i| function(degree, i, t(j))).collect()).collect()
}

fn fit(
    points: &Rows,
    basis: &Arc<dyn BlendingBasis>,
    options: &BlendingOptions,
) -> BlendingCurveFit {
    let flat = points.concat();
    let view = PointsView::new(points[0].len(), &flat).unwrap();
    fit_blending_curve(view, Arc::clone(basis), options).unwrap()
}

fn residuals(fit: &BlendingCurveFit) -> Vec<f64> {
    fit.report.run.history.iter().map(|entry| entry.max_residual).collect()
}

fn with(method: Method, iterations: usize) -> BlendingOptions {
    BlendingOptions { method, iterations, residual: Some(0.0), ..Default::default() }
}

/// Chen, Wang and Jin (2012), Table 1: a half circle by a quartic Wang-Ball curve. What is printed
/// for 10 and 20 steps is off by half a percent.
#[test]
fn the_wang_ball_table_of_2012_is_met() {
    let points: Rows =
        (0..5).map(|i| f64::from(i) * PI / 4.0).map(|s| vec![s.cos(), s.sin()]).collect();
    let basis: Arc<dyn BlendingBasis> = Arc::new(WangBall::new(4).unwrap());
    let found = residuals(&fit(&points, &basis, &with(Method::Pia, 20)));
    for (k, printed, recomputed) in [
        (0, 5.732e-1, 5.732_233e-1),
        (1, 3.297e-1, 3.297_291e-1),
        (5, 3.992e-2, 3.991_886e-2),
        (10, 9.603e-3, 9.551_236e-3),
        (20, 2.521e-3, 2.530_219e-3),
    ] {
        assert!((found[k] / printed - 1.0).abs() < 6e-3, "{k}: {}", found[k]);
        assert!((found[k] / recomputed - 1.0).abs() < 2e-7, "{k}: {}", found[k]);
    }
}

/// The same paper's lemniscate of Gerono, degree 10: its tables with weights per point disagree
/// with themselves, so the numbers here come from another program.
#[test]
fn weights_per_point_move_a_bezier_curve_of_degree_10() {
    let points: Rows = (0..11)
        .map(|i| -PI / 2.0 + f64::from(i) * PI / 5.0)
        .map(|s| vec![s.cos(), s.sin() * s.cos()])
        .collect();
    let basis: Arc<dyn BlendingBasis> = Arc::new(Bernstein::new(10).unwrap());
    let plain = residuals(&fit(&points, &basis, &with(Method::Pia, 100)));
    let expected = [
        (0, 0.462_013),
        (1, 0.349_083),
        (2, 0.280_105),
        (5, 0.168_599),
        (10, 0.101_238),
        (20, 0.056_372),
        (50, 0.018_514),
        (100, 0.011_897_9),
    ];
    for (k, value) in expected {
        assert!((plain[k] - value).abs() < 1e-6, "{k}: {}", plain[k]);
    }
    let uneven = |from: f64| (0..11).map(|i| from + 0.01 * f64::from(i)).collect::<Vec<f64>>();
    for (from, steps, expected) in [
        (
            0.3,
            30,
            [
                0.034_646,
                0.081_427,
                0.006_017_8,
                0.103_676,
                0.001_889_1,
                0.100_260,
                0.005_324_6,
                0.075_662_7,
                0.034_200_1,
            ],
        ),
        (
            0.78,
            50,
            [
                4.940_9e-3,
                4.846_1e-3,
                1.319_28e-2,
                2.389_86e-2,
                2.537e-5,
                2.344_64e-2,
                1.335_46e-2,
                3.331_0e-3,
                3.893_6e-3,
            ],
        ),
    ] {
        let weight = IterationWeight::PerPoint(uneven(from));
        let options = BlendingOptions { weight, ..with(Method::Weighted, steps) };
        let found = fit(&points, &basis, &options);
        for (j, expected) in expected.into_iter().enumerate() {
            let vector = found.difference_vectors.point(j + 1);
            let found = vector[0].hypot(vector[1]);
            assert!((found - expected).abs() < 1e-6, "{from} {j}: {found} {expected}");
        }
    }
}

#[test]
fn histories_are_those_of_full_matrices() {
    for degree in [2, 3, 6, 7] {
        let points = random_points(degree + 1, 3, degree as u64);
        for (basis, textbook) in named(degree) {
            let a = matrix(degree, textbook);
            let methods: [(Method, dense::Step); 3] = [
                (Method::Pia, dense::pia_step),
                (Method::Jacobi, dense::jacobi_step),
                (Method::GaussSeidel, dense::gauss_seidel_step),
            ];
            for (method, step) in methods {
                let expected = dense::residual_history(&a, &points, step, 12);
                let found = residuals(&fit(&points, &basis, &with(method, 12)));
                for (k, (a, b)) in found.iter().zip(&expected).enumerate() {
                    assert!((a - b).abs() < 1e-11 * (1.0 + b), "{basis:?} {method:?} {k}");
                }
            }
        }
    }
}

#[test]
fn every_method_reaches_the_interpolant() {
    for degree in [1, 3, 4] {
        let points = random_points(degree + 1, 2, 77);
        for (basis, textbook) in named(degree) {
            let limit = dense::solve(&matrix(degree, textbook), &points);
            for method in [
                Method::Auto,
                Method::Pia,
                Method::Weighted,
                Method::GaussSeidel,
                Method::Sor,
                Method::Chebyshev,
                Method::Anderson { memory: None },
                Method::Preconditioned { half_bandwidth: Some(2) },
            ] {
                let options = BlendingOptions { method, iterations: 20_000, ..Default::default() };
                let found = fit(&points, &basis, &options);
                assert!(found.report.converged(), "{basis:?} {method:?}");
                for (control, expected) in found.curve.control_points().iter().zip(&limit) {
                    let gap = (control[0] - expected[0]).hypot(control[1] - expected[1]);
                    assert!(gap < 1e-9, "{basis:?} {method:?}: {gap:e}");
                }
            }
        }
    }
}

/// High degrees do not crawl: what PIA could not do in ten thousand steps.
#[test]
fn auto_reaches_rounding_at_degree_10_in_a_few_steps() {
    for (basis, _) in named(10) {
        let found = fit(&random_points(11, 2, 5), &basis, &BlendingOptions::default());
        let run = &found.report.run;
        assert!(run.iterations <= 12, "{basis:?} {}", run.iterations);
        assert!(run.max_residual < 1e-9 * run.extent, "{basis:?} {:e}", run.max_residual);
        // With eigenvalues down to 5e-7, DP needs more digits to be sure of it.
        assert!(found.report.converged() || basis.name() == "dp", "{basis:?}");
    }
}

#[test]
fn the_bezier_form_is_the_same_curve() {
    for degree in [1, 2, 3, 5, 10, 17, 25] {
        // Smooth data, whose control points stay in their range.
        let points: Rows = (0..=degree)
            .map(|j| 3.0 * j as f64 / degree as f64)
            .map(|s| vec![s.cos(), (2.0 * s).sin(), s])
            .collect();
        for (basis, _) in named(degree) {
            let options = BlendingOptions { keep: vec![0, 2], ..with(Method::Pia, 5) };
            let found = fit(&points, &basis, &options);
            let bezier = found.to_bezier().unwrap();
            assert_eq!(bezier.curve.degree(), degree);
            assert_eq!(bezier.sequence.len(), 2);
            for step in 0..=40 {
                let t = f64::from(step) / 40.0;
                let (a, b) = (found.curve.evaluate(t).unwrap(), bezier.curve.evaluate(t).unwrap());
                let gap = a.iter().zip(&b).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
                assert!(gap < 1e-13, "{basis:?} at {t}: {gap:e}");
            }
        }
    }
    let too_high = fit(&random_points(28, 2, 1), &named(27)[0].0, &with(Method::Pia, 1));
    assert!(matches!(too_high.to_bezier(), Err(Error::OutOfRange { .. })));
}

#[test]
fn a_rational_quadratic_through_a_quarter_circle_is_the_circle() {
    let basis = Bernstein::new(2).unwrap();
    let rational = Rational::new(basis, vec![1.0, FRAC_1_SQRT_2, 1.0]).unwrap();
    let middle = PI / 4.0;
    let points = vec![vec![1.0, 0.0], vec![middle.cos(), middle.sin()], vec![0.0, 1.0]];
    let basis: Arc<dyn BlendingBasis> = Arc::new(rational);
    for method in [Method::Auto, Method::Pia, Method::Anderson { memory: None }] {
        let options = BlendingOptions { method, ..Default::default() };
        let found = fit(&points, &basis, &options);
        let middle = found.curve.control_points().point(1);
        assert!((middle[0] - 1.0).hypot(middle[1] - 1.0) < 1e-11, "{middle:?}");
        for step in 0..=20 {
            let point = found.curve.evaluate(f64::from(step) / 20.0).unwrap();
            assert!((point[0].hypot(point[1]) - 1.0).abs() < 1e-11);
        }
    }
}

#[test]
fn the_bezier_form_of_a_rational_fit_is_the_same_curve_and_surface() {
    for degree in [2, 4, 7] {
        let points = random_points(degree + 1, 3, 21);
        let weights: Vec<f64> = (0..=degree).map(|i| 0.4 + ((3 * i) % 5) as f64).collect();
        for (basis, _) in named(degree) {
            let rational = Rational::new(Arc::clone(&basis), weights.clone()).unwrap();
            let rational: Arc<dyn BlendingBasis> = Arc::new(rational);
            let options = BlendingOptions { keep: vec![1], ..with(Method::Pia, 4) };
            let found = fit(&points, &rational, &options);
            let bezier = found.to_bezier().unwrap();
            assert!(bezier.curve.rational_weights().is_some());
            let member = bezier.member(1).unwrap();
            let expected = found.report.run.history[1].max_residual;
            assert!((member.report.run.max_residual - expected).abs() < 1e-12);
            let grid = random_points((degree + 1) * (degree + 1), 2, 22).concat();
            let grid = GridView::new([degree + 1; 2], 2, &grid).unwrap();
            let options =
                BlendingSurfaceOptions { method: Method::Pia, iterations: 3, ..Default::default() };
            let bases = [Arc::clone(&rational), Arc::clone(&basis)];
            let surface = fit_blending_surface(grid, bases, &options).unwrap();
            let patch = surface.to_bezier().unwrap().surface;
            for step in 0..=30 {
                let t = f64::from(step) / 30.0;
                let apart = |a: Vec<f64>, b: Vec<f64>| {
                    a.iter().zip(&b).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()))
                };
                let (a, b) = (found.curve.evaluate(t).unwrap(), bezier.curve.evaluate(t).unwrap());
                assert!(apart(a, b) < 1e-13, "{rational:?} at {t}");
                let v = f64::from(step * step % 31) / 30.0;
                let (a, b) =
                    (surface.surface.evaluate(t, v).unwrap(), patch.evaluate(t, v).unwrap());
                assert!(apart(a, b) < 1e-13, "{rational:?} at {t}, {v}");
            }
        }
    }
}

#[test]
fn what_a_method_rests_on_is_told_where_it_is_missing() {
    let points = random_points(11, 2, 4);
    let told = |basis: &Arc<dyn BlendingBasis>, method| {
        fit(&points, basis, &with(method, 2)).report.run.choices.join("\n")
    };
    let [(bernstein, _), (wang_ball, _), ..] = named(10);
    for method in [Method::Pia, Method::Weighted, Method::Chebyshev, Method::GaussSeidel] {
        assert!(told(&wang_ball, method).contains("not known to be totally positive"));
        assert!(!told(&bernstein, method).contains("totally positive"));
    }
    for method in [Method::Auto, Method::Anderson { memory: None }] {
        assert!(!told(&wang_ball, method).contains("totally positive"));
    }
    assert!(told(&bernstein, Method::Jacobi).contains("diagonal dominates"));
    // As it says: the spectral radius is 2.36.
    let jacobi = BlendingOptions { method: Method::Jacobi, ..Default::default() };
    let found = fit(&points, &bernstein, &jacobi);
    assert_eq!(found.report.run.termination, Termination::Diverged);
    let history = residuals(&found);
    let growth = history[history.len() - 1] / history[history.len() - 2];
    assert!((growth - 1.36).abs() < 1.01, "{growth}");
}

#[test]
fn surfaces_mix_bases_and_meet_every_point() {
    let (rows, columns) = (7, 5);
    let points = random_points(rows * columns, 3, 12).concat();
    let grid = GridView::new([rows, columns], 3, &points).unwrap();
    let (in_u, in_v) = (named(rows - 1), named(columns - 1));
    for (k, (u, _)) in in_u.iter().enumerate() {
        let (v, _) = &in_v[(k + 1) % 4];
        let bases = || [Arc::clone(u), Arc::clone(v)];
        let limit =
            fit_blending_surface(grid, bases(), &BlendingSurfaceOptions::default()).unwrap();
        assert!(limit.report.converged() && limit.report.run.iterations <= 5);
        for i in 0..rows {
            for j in 0..columns {
                let s = limit.surface.evaluate(i as f64 / 6.0, j as f64 / 4.0).unwrap();
                let gap =
                    s.iter().zip(grid.point(i, j)).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
                assert!(gap < 1e-9, "{u:?} {v:?}: {gap:e}");
            }
        }
        let bezier = limit.to_bezier().unwrap();
        for step in 0..=20 {
            let (a, b) = (f64::from(step) / 20.0, f64::from(step * step % 21) / 20.0);
            let (s, z) =
                (limit.surface.evaluate(a, b).unwrap(), bezier.surface.evaluate(a, b).unwrap());
            let size = s.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
            let gap = s.iter().zip(&z).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
            assert!(gap < 1e-11 * size, "{u:?} {v:?}: {gap:e}");
        }
        for (method, per_direction) in [
            (Method::Anderson { memory: Some(40) }, false),
            (Method::Anderson { memory: None }, true),
            (Method::Auto, true),
            (Method::GaussSeidel, false),
        ] {
            let options = BlendingSurfaceOptions {
                method,
                per_direction,
                residual: Some(1e-9),
                iterations: 100_000,
                ..Default::default()
            };
            if k > 1 && !per_direction {
                continue; // Tens of thousands of steps, or a longer memory.
            }
            let found = fit_blending_surface(grid, bases(), &options).unwrap();
            assert!(found.report.converged(), "{u:?} {v:?} {method:?} {per_direction}");
        }
    }
}

#[test]
fn plain_pia_of_a_surface_is_that_of_the_kronecker_product() {
    let (rows, columns) = (4, 6);
    let points = random_points(rows * columns, 2, 8);
    let (u, textbook_u) = named(rows - 1)[1].clone();
    let (v, textbook_v) = named(columns - 1)[3].clone();
    let (a, b) = (matrix(rows - 1, textbook_u), matrix(columns - 1, textbook_v));
    let whole: Rows = (0..rows * columns)
        .map(|p| {
            (0..rows * columns)
                .map(|q| a[p / columns][q / columns] * b[p % columns][q % columns])
                .collect()
        })
        .collect();
    let expected = dense::residual_history(&whole, &points, dense::pia_step, 10);
    let flat = points.concat();
    let grid = GridView::new([rows, columns], 2, &flat).unwrap();
    let options = BlendingSurfaceOptions {
        method: Method::Pia,
        residual: Some(0.0),
        iterations: 10,
        keep: vec![3],
        ..Default::default()
    };
    let found = fit_blending_surface(grid, [u, v], &options).unwrap();
    for (entry, expected) in found.report.run.history.iter().zip(&expected) {
        assert!((entry.max_residual - expected).abs() < 1e-13);
    }
    assert_eq!(found.to_bezier().unwrap().sequence[0].control_points.len(), rows * columns);
}

/// The quadratic basis of sines and cosines on an arc of 1 radian from 2 to 3: the user's own,
/// normalised totally positive there, and no polynomials.
#[derive(Debug)]
struct Trigonometric;

impl BlendingBasis for Trigonometric {
    fn name(&self) -> &str {
        "trigonometric"
    }

    fn functions(&self) -> usize {
        3
    }

    fn domain(&self) -> (f64, f64) {
        (2.0, 3.0)
    }

    fn evaluate_into(&self, t: f64, values: &mut [f64]) {
        let whole = 1.0 - f64::cos(1.0);
        values[0] = (1.0 - (3.0 - t).cos()) / whole;
        values[2] = (1.0 - (t - 2.0).cos()) / whole;
        values[1] = 1.0 - values[0] - values[2];
    }

    fn is_totally_positive(&self) -> bool {
        true
    }
}

#[test]
fn a_basis_of_the_users_own_reproduces_what_it_spans() {
    let basis: Arc<dyn BlendingBasis> = Arc::new(Trigonometric);
    // An arc of the unit circle, at the parameters that are its angles.
    let points: Rows = [2.0, 2.5, 3.0].iter().map(|a: &f64| vec![a.cos(), a.sin()]).collect();
    for method in [Method::Auto, Method::Pia, Method::Anderson { memory: None }] {
        let options = BlendingOptions { method, ..Default::default() };
        let found = fit(&points, &basis, &options);
        assert!(found.report.converged());
        assert_eq!(found.parameters, [2.0, 2.5, 3.0]);
        for step in 0..=20 {
            let a = 2.0 + f64::from(step) / 20.0;
            let point = found.curve.evaluate(a).unwrap();
            assert!((point[0] - a.cos()).hypot(point[1] - a.sin()) < 1e-11);
        }
        assert!(matches!(found.to_bezier(), Err(Error::Incompatible { .. })));
        assert!(matches!(found.curve.evaluate(1.9), Err(Error::OutsideDomain { .. })));
    }
    let short = BlendingOptions { iterations: 2, method: Method::Pia, ..Default::default() };
    let found = fit(&points, &basis, &short);
    assert_eq!(found.report.max_deviation, found.report.run.max_residual);
    assert!(found.report.run.choices.iter().any(|choice| choice.starts_with("deviation")));
}

#[test]
fn parameters_are_brought_onto_the_domain_and_said_so() {
    let basis = named(3)[0].0.clone();
    let points = random_points(4, 2, 3);
    let run = |parameters: Vec<f64>| {
        let parameterization = Some(Parameterization::Given(parameters));
        fit(&points, &basis, &BlendingOptions { parameterization, ..Default::default() })
    };
    let inside = run(vec![0.1, 0.3, 0.5, 0.9]);
    assert_eq!(inside.parameters, [0.1, 0.3, 0.5, 0.9]);
    let stretched = run(vec![10.0, 11.0, 13.0, 14.0]);
    assert_eq!(stretched.parameters, [0.0, 0.25, 0.75, 1.0]);
    assert!(stretched.report.run.choices.iter().any(|choice| choice.contains("[10, 14]")));
    let chord =
        BlendingOptions { parameterization: Some(Parameterization::Chord), ..Default::default() };
    assert!(fit(&points, &basis, &chord).report.spacing_ratio > 1.0);
}

#[test]
fn hostile_points_are_refused_or_fitted() {
    let [(basis, _), ..] = named(3);
    let try_fit = |points: &[[f64; 2]], options: &BlendingOptions| {
        fit_blending_curve(points, Arc::clone(&basis), options)
    };
    let default = BlendingOptions::default();
    assert!(matches!(try_fit(&[], &default), Err(Error::NoPoints { needed: 4 })));
    for count in [1, 3, 5] {
        let found = try_fit(&vec![[0.0, 1.0]; count], &default);
        assert!(matches!(found, Err(Error::WrongCount { expected: 4, .. })), "{count}");
    }
    let mut points = [[0.0, 0.0], [1.0, 2.0], [2.0, -1.0], [3.0, 0.5]];
    points[2][1] = f64::NAN;
    assert!(matches!(
        try_fit(&points, &default),
        Err(Error::NotFinite { point: 2, coordinate: 1, .. })
    ));
    // All equal: a curve that stands still, but no chord lengths.
    let still = [[7.0, 7.0]; 4];
    assert_eq!(try_fit(&still, &default).unwrap().report.run.max_residual, 0.0);
    let chord =
        BlendingOptions { parameterization: Some(Parameterization::Chord), ..Default::default() };
    assert!(matches!(try_fit(&still, &chord), Err(Error::AllPointsEqual { points: 4 })));
    points[2] = points[1];
    assert!(matches!(try_fit(&points, &chord), Err(Error::RepeatedPoints { .. })));
    assert!(try_fit(&points, &default).unwrap().report.converged());
    let ratio = BlendingOptions {
        parameterization: Some(Parameterization::ChordRatio),
        ..Default::default()
    };
    assert!(matches!(try_fit(&points, &ratio), Err(Error::Incompatible { .. })));

    let shape = [[0.0, 0.0], [1.0, 2.0], [2.0, -1.0], [3.0, 0.5]];
    for (scale, shift) in [(1e300, 0.0), (1e-290, 0.0), (1.0, 1e9), (1e-3, -1e12)] {
        let moved = shape.map(|p| p.map(|x| x * scale + shift));
        let found = try_fit(&moved, &default).unwrap();
        assert!(found.report.converged(), "{scale:e} {shift:e}");
        let end = found.curve.control_points().point(3);
        assert!((end[0] - moved[3][0]).abs() <= 1e-12 * moved[3][0].abs());
    }
    let tiny = shape.map(|p| p.map(|x| x * 1e-308));
    assert!(matches!(try_fit(&tiny, &default), Err(Error::OutOfRange { .. })));
}

#[test]
fn degree_60_meets_smooth_data_and_says_what_rough_data_ask() {
    let [(bernstein, _), (_, _), (_, _), (dp, _)] = named(60);
    let smooth: Rows =
        (0..=60).map(|j| f64::from(j) / 10.0).map(|s| vec![s.cos(), s.sin()]).collect();
    let found = fit(&smooth, &bernstein, &BlendingOptions::default());
    assert!(found.report.converged() && found.report.run.iterations < 5);
    for (points, basis) in [(random_points(61, 2, 2), bernstein), (smooth, dp)] {
        let run = fit(&points, &basis, &BlendingOptions::default()).report.run;
        assert_eq!(run.termination, Termination::Stalled);
        assert!(run.max_residual.is_finite());
        assert!(run.choices.iter().any(|choice| choice.contains("close to singular in doubles")));
    }
}
