//! Laws of Anderson acceleration, judged by its textbook form with full matrices.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::basis::Bernstein;
use gimfit::{
    BlendingCurveFit, BlendingOptions, CurveOptions, Error, Method, Termination,
    fit_blending_curve, fit_curve,
};
use gimfit_testkit::anderson::anderson_history;
use gimfit_testkit::blending::bernstein;
use gimfit_testkit::dense::Rows;
use gimfit_testkit::generate::{Random, graded};
use std::sync::Arc;

fn random_points(count: usize, seed: u64) -> Vec<[f64; 2]> {
    let mut random = Random::new(seed);
    (0..count).map(|_| [random.signed(), random.signed()]).collect()
}

fn options(memory: Option<usize>, iterations: usize) -> BlendingOptions {
    BlendingOptions {
        method: Method::Anderson { memory },
        residual: Some(0.0),
        iterations,
        ..Default::default()
    }
}

fn fit(points: &Vec<[f64; 2]>, options: &BlendingOptions) -> BlendingCurveFit {
    let basis = Bernstein::new(points.len() - 1).unwrap();
    fit_blending_curve(points, Arc::new(basis), options).unwrap()
}

fn residuals(fit: &BlendingCurveFit) -> Vec<f64> {
    fit.report.run.history.iter().map(|entry| entry.max_residual).collect()
}

#[test]
fn anderson_takes_the_steps_of_the_textbook() {
    let points = random_points(8, 3);
    let rows: Rows = points.iter().map(|point| point.to_vec()).collect();
    let matrix: Rows =
        (0..8).map(|j| (0..8).map(|i| bernstein(7, i, f64::from(j) / 7.0)).collect()).collect();
    for memory in [1, 2, 3, 5, 7] {
        // While the memory is shorter than the space, old columns are taken off step after step.
        let steps = if memory < 5 { 30 } else { 6 };
        let expected = anderson_history(&matrix, &rows, memory, steps);
        let found = residuals(&fit(&points, &options(Some(memory), steps)));
        assert_eq!(found.len(), expected.len());
        for (k, (a, b)) in found.iter().zip(&expected).enumerate() {
            assert!((a - b).abs() < 1e-6 * b, "memory {memory}, step {k}: {a:e} {b:e}");
        }
    }
}

/// The experiment that made this the way for high degrees: random data, degree 10, where plain PIA
/// keeps 0.99964 of the error in each step.
#[test]
fn anderson_ends_on_degree_10_in_as_many_steps_as_there_are_eigenvalues() {
    for seed in 0..20 {
        let points = random_points(11, seed);
        let history = residuals(&fit(&points, &options(None, 25)));
        assert!(history[9] > 1e-3, "{seed}: no step before the tenth ends it");
        assert!(history[10] < 1e-6, "{seed}: {:e} after 10 steps", history[10]);
        let extent = 2.0; // At least.
        assert!(history[25] < 1e-9 * extent, "{seed}: {:e} after 25 steps", history[25]);
    }
}

#[test]
fn a_short_memory_does_not_end_so_soon() {
    let history = residuals(&fit(&random_points(11, 1), &options(Some(5), 40)));
    assert!(history[40] > 1e-3, "{:e}", history[40]);
}

#[test]
fn anderson_outruns_pia_on_b_splines_of_graded_data() {
    let data: Vec<[f64; 2]> = graded(30, 1.4).iter().map(|p| [p[0], p[1]]).collect();
    let run = |method| {
        let options = CurveOptions { method, iterations: 2000, ..Default::default() };
        fit_curve(&data, &options).unwrap().report.run
    };
    let (plain, fast) = (run(Method::Pia), run(Method::Anderson { memory: None }));
    assert_eq!(fast.termination, Termination::Residual);
    assert!(3 * fast.iterations < plain.iterations, "{} {}", fast.iterations, plain.iterations);
}

#[test]
fn equal_points_and_a_memory_out_of_range() {
    // Nothing to remember: the first difference vectors vanish.
    let still = fit(&vec![[3.0, 4.0]; 6], &options(None, 10));
    assert_eq!(residuals(&still).last(), Some(&0.0));
    for memory in [0, 1001, usize::MAX] {
        let basis = Arc::new(Bernstein::new(4).unwrap());
        let found = fit_blending_curve(&random_points(5, 1), basis, &options(Some(memory), 10));
        assert!(matches!(found, Err(Error::OutOfRange { .. })), "{memory}");
    }
}
