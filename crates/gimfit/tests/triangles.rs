//! Laws of triangular patches, judged by dense oracles that share no code with the library.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::collocation::CollocationMatrix;
use gimfit::fit::triangular_collocation;
use gimfit::geometry::{TriangularPatch, triangle_indices, triangle_points};
use gimfit::{
    Error, IterationWeight, Method, Points, PointsView, Termination, TriangleFit, TriangleOptions,
    fit_triangular_patch,
};
use gimfit_testkit::blending::{bernstein_eigenvalue, triangular};
use gimfit_testkit::dense::{self, Rows};
use gimfit_testkit::generate::Random;

fn indices(degree: usize) -> Vec<[usize; 3]> {
    let mut list = Vec::new();
    for i in (0..=degree).rev() {
        for k in 0..=degree - i {
            list.push([i, degree - i - k, k]);
        }
    }
    list
}

fn matrix(degree: usize) -> Rows {
    let list = indices(degree);
    let place = |index: [usize; 3]| index.map(|x| x as f64 / degree as f64);
    list.iter().map(|&at| list.iter().map(|&f| triangular(f, place(at))).collect()).collect()
}

fn random_points(degree: usize, dimension: usize, seed: u64) -> Rows {
    let mut random = Random::new(seed);
    let count = triangle_points(degree);
    (0..count).map(|_| (0..dimension).map(|_| random.signed()).collect()).collect()
}

fn fit(points: &Rows, degree: usize, options: &TriangleOptions) -> TriangleFit {
    let flat = points.concat();
    let view = PointsView::new(points[0].len(), &flat).unwrap();
    fit_triangular_patch(view, degree, options).unwrap()
}

fn patch(points: &Rows, degree: usize) -> TriangularPatch {
    TriangularPatch::new(degree, Points::new(points[0].len(), points.concat()).unwrap()).unwrap()
}

#[test]
fn de_casteljau_gives_the_sum_of_the_textbook() {
    for degree in [1, 2, 3, 5, 9] {
        assert_eq!(triangle_indices(degree).collect::<Vec<_>>(), indices(degree));
        let points = random_points(degree, 3, degree as u64);
        let patch = patch(&points, degree);
        let sum = |u: f64, v: f64| -> Vec<f64> {
            let weights = indices(degree).into_iter().map(|f| triangular(f, [u, v, 1.0 - u - v]));
            let weighted: Vec<f64> = weights.collect();
            (0..3).map(|c| weighted.iter().zip(&points).map(|(w, p)| w * p[c]).sum()).collect()
        };
        let apart = |a: &[f64], b: &[f64]| {
            a.iter().zip(b).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()))
        };
        for (u, v) in [(1.0, 0.0), (0.0, 1.0), (0.0, 0.0), (0.2, 0.3), (0.5, 0.5), (0.1, 0.85)] {
            assert!(apart(&patch.evaluate(u, v).unwrap(), &sum(u, v)) < 1e-13);
        }
        // Central differences of the sum.
        let (u, v, h) = (0.3, 0.25, 1e-5);
        let mut jet = [0.0; 9];
        patch.derivatives_into(u, v, &mut jet).unwrap();
        let slope = |plus: Vec<f64>, minus: Vec<f64>| -> Vec<f64> {
            plus.iter().zip(&minus).map(|(a, b)| (a - b) / (2.0 * h)).collect()
        };
        let by_u = slope(sum(u + h, v), sum(u - h, v));
        let by_v = slope(sum(u, v + h), sum(u, v - h));
        assert!(apart(&jet[3..6], &by_u) < 1e-7 && apart(&jet[6..], &by_v) < 1e-7, "{degree}");
        let normal = patch.normal(u, v).unwrap().unwrap();
        let across = |d: &[f64]| normal.iter().zip(d).map(|(n, d)| n * d).sum::<f64>().abs();
        assert!(across(&jet[3..6]) < 1e-12 && across(&jet[6..]) < 1e-12);
    }
}

/// Dimension of the kernel of a matrix, by elimination with full pivoting.
fn nullity(mut a: Rows) -> usize {
    let n = a.len();
    for k in 0..n {
        let places = (k..n).flat_map(|i| (k..n).map(move |j| (i, j)));
        let (i, j) =
            places.max_by(|&(i, j), &(p, q)| a[i][j].abs().total_cmp(&a[p][q].abs())).unwrap();
        if a[i][j].abs() < 1e-10 {
            return n - k;
        }
        a.swap(k, i);
        a.iter_mut().for_each(|row| row.swap(k, j));
        let head = a[k].clone();
        for row in a.iter_mut().skip(k + 1) {
            let factor = row[k] / head[k];
            row.iter_mut().zip(&head).for_each(|(x, h)| *x -= factor * h);
        }
    }
    0
}

/// Chen and Wang (2011): eigenvalues n! / ((n - s)! n^s), each s + 1 times, but that s = 0 and s = 1
/// are the same number, 1.
#[test]
fn the_spectrum_is_that_of_the_law() {
    for degree in 1..=6 {
        let operator = triangular_collocation(degree).unwrap();
        let count = triangle_points(degree);
        let mut rows: Rows = vec![vec![0.0; count]; count];
        for (j, row) in rows.iter_mut().enumerate() {
            operator.visit_row(j, &mut |column, weight| row[column] = weight);
        }
        let expected = matrix(degree);
        let mut known = 0;
        for s in 1..=degree {
            let eigenvalue = bernstein_eigenvalue(degree, s);
            let mut shifted = rows.clone();
            (0..count).for_each(|j| shifted[j][j] -= eigenvalue);
            let times = if s == 1 { 3 } else { s + 1 };
            assert_eq!(nullity(shifted), times, "degree {degree}, s = {s}");
            known += times;
        }
        assert_eq!(known, count, "no eigenvalue is left");
        for (row, expected) in rows.iter().zip(&expected) {
            assert!(row.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14));
        }
        let smallest = operator.known_smallest_eigenvalue().unwrap();
        assert!((smallest - bernstein_eigenvalue(degree, degree)).abs() < 1e-15);
        assert!(!operator.is_totally_positive());
    }
}

#[test]
fn histories_are_those_of_full_matrices() {
    for degree in [2, 4] {
        let (points, a) = (random_points(degree, 3, 5), matrix(degree));
        let methods: [(Method, dense::Step); 2] =
            [(Method::Pia, dense::pia_step), (Method::GaussSeidel, dense::gauss_seidel_step)];
        for (method, step) in methods {
            let options = TriangleOptions {
                method,
                iterations: 15,
                residual: Some(0.0),
                keep: vec![4],
                ..Default::default()
            };
            let found = fit(&points, degree, &options);
            let expected = dense::residual_history(&a, &points, step, 15);
            for (entry, expected) in found.report.run.history.iter().zip(&expected) {
                assert!((entry.max_residual - expected).abs() < 1e-12);
            }
            assert_eq!(found.sequence[0].control_points.len(), triangle_points(degree));
        }
    }
}

#[test]
fn every_method_reaches_the_interpolant() {
    let degree = 4;
    let points = random_points(degree, 2, 9);
    let limit = dense::solve(&matrix(degree), &points);
    for method in [
        Method::Auto,
        Method::Pia,
        Method::Weighted,
        Method::GaussSeidel,
        Method::Chebyshev,
        Method::Anderson { memory: None },
        Method::Preconditioned { half_bandwidth: None },
    ] {
        let options = TriangleOptions { method, iterations: 5000, ..Default::default() };
        let found = fit(&points, degree, &options);
        assert!(found.report.converged(), "{method:?}");
        for (control, expected) in found.patch.control_points().iter().zip(&limit) {
            assert!((control[0] - expected[0]).hypot(control[1] - expected[1]) < 1e-9);
        }
    }
    let auto = TriangleOptions { method: Method::Weighted, ..Default::default() };
    let found = fit(&points, degree, &auto).report.run;
    let omega = 2.0 / (1.0 + 24.0 / 256.0);
    assert!(found.choices.iter().any(|c| c.contains(&format!("weight: {omega:.6}"))), "{found:?}");
    let sor = TriangleOptions {
        method: Method::Sor,
        weight: IterationWeight::Same(1.1),
        iterations: 3,
        ..Default::default()
    };
    let told = fit(&points, degree, &sor).report.run.choices.join(" ");
    assert!(told.contains("not totally positive"), "{told}");
}

#[test]
fn high_degrees_do_not_crawl() {
    for (degree, method, most) in
        [(10, Method::Auto, 5), (10, Method::Anderson { memory: None }, 80), (17, Method::Auto, 20)]
    {
        let run = fit(
            &random_points(degree, 3, 3),
            degree,
            &TriangleOptions { method, ..Default::default() },
        )
        .report
        .run;
        assert!(run.iterations <= most, "{degree} {method:?}: {}", run.iterations);
        assert!(run.max_residual < 1e-8, "{degree} {method:?}: {:e}", run.max_residual);
    }
}

#[test]
fn hostile_points_are_refused_or_fitted() {
    let default = TriangleOptions::default();
    let shape: Rows = random_points(2, 3, 1);
    for degree in [0, 61, usize::MAX] {
        let flat = shape.concat();
        let view = PointsView::new(3, &flat).unwrap();
        let found = fit_triangular_patch(view, degree, &default);
        assert!(matches!(found, Err(Error::OutOfRange { .. })), "{degree}");
    }
    let none: [[f64; 3]; 0] = [];
    assert!(matches!(fit_triangular_patch(&none, 2, &default), Err(Error::NoPoints { needed: 6 })));
    let five = [[0.0, 1.0]; 5];
    assert!(matches!(
        fit_triangular_patch(&five, 2, &default),
        Err(Error::WrongCount { expected: 6, .. })
    ));
    let mut broken = [[0.0, 1.0]; 6];
    broken[4][1] = f64::INFINITY;
    assert!(matches!(
        fit_triangular_patch(&broken, 2, &default),
        Err(Error::NotFinite { point: 4, coordinate: 1, .. })
    ));
    let still = fit(&vec![vec![5.0; 7]; 6], 2, &default);
    assert_eq!(still.report.run.max_residual, 0.0);
    for (scale, shift) in [(1e300, 0.0), (1e-290, 0.0), (1.0, 1e9)] {
        let moved: Rows =
            shape.iter().map(|p| p.iter().map(|x| x * scale + shift).collect()).collect();
        let found = fit(&moved, 2, &default);
        assert!(found.report.converged(), "{scale:e} {shift:e}");
    }
    let found = fit(&shape, 2, &default).patch;
    for (u, v) in [(-0.1, 0.5), (0.6, 0.6), (f64::NAN, 0.1), (f64::INFINITY, 0.0)] {
        assert!(matches!(found.evaluate(u, v), Err(Error::OutsideTriangle { .. })));
    }
    assert_eq!(found.normal(0.2, 0.2).unwrap().map(|n| n.len()), Some(3));
    let rough = fit(&random_points(30, 1, 4), 30, &default).report.run;
    assert_eq!(rough.termination, Termination::Stalled);
    assert!(rough.choices.iter().any(|choice| choice.contains("close to singular")));
}
