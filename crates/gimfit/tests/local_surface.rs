//! Laws of local PIA on grids.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::{
    Error, GridView, IterationWeight, KnotPlacement, Method, Parameterization, SurfaceFit,
    SurfaceOptions, fit_surface,
};
use gimfit_testkit::dense::{self, Rows};
use gimfit_testkit::generate::Random;
use gimfit_testkit::textbook::collocation_matrix;
use std::ops::Range;

const SHAPE: [usize; 2] = [10, 9];

type Windows = Vec<[Range<usize>; 2]>;

/// A wavy sheet over lines whose steps vary by a factor of up to `grading`.
fn sheet(shape: [usize; 2], grading: f64) -> Vec<f64> {
    let mut random = Random::new(11);
    let mut lines = |count: usize| -> Vec<f64> {
        let mut at = 0.0;
        (0..count)
            .map(|_| {
                at += grading.powf(random.unit());
                at
            })
            .collect()
    };
    let (xs, ys) = (lines(shape[0]), lines(shape[1]));
    let point = |x: f64, y: f64| [x, y + 0.1 * (0.9 * x).sin(), (0.7 * x).sin() + (0.5 * y).cos()];
    xs.iter().flat_map(|&x| ys.iter().flat_map(move |&y| point(x, y))).collect()
}

fn fit(points: &[f64], options: &SurfaceOptions) -> SurfaceFit {
    fit_surface(GridView::new(SHAPE, 3, points).unwrap(), options).unwrap()
}

fn with(windows: &Windows) -> SurfaceOptions {
    SurfaceOptions { local: Some(windows.clone()), ..Default::default() }
}

/// Positions, row by row, that windows cover.
fn covered(windows: &Windows) -> Vec<usize> {
    let inside = |k: &usize| {
        let (i, j) = (k / SHAPE[1], k % SHAPE[1]);
        windows.iter().any(|[rows, columns]| rows.contains(&i) && columns.contains(&j))
    };
    (0..SHAPE[0] * SHAPE[1]).filter(inside).collect()
}

fn one_window() -> Windows {
    vec![[2..6, 3..8]]
}

/// Windows that overlap, and single points.
fn several() -> Windows {
    vec![[0..3, 0..4], [2..6, 3..6], [8..9, 8..9], [9..10, 0..1]]
}

/// The full matrix of an open surface, rational or not.
fn matrix(fit: &SurfaceFit, weights: Option<&[f64]>) -> Rows {
    let knots = fit.surface.knots();
    let each = [0, 1]
        .map(|k| collocation_matrix(knots[k].values(), knots[k].degree(), &fit.parameters[k]));
    let mut whole = dense::kronecker(&each[0], &each[1]);
    if let Some(weights) = weights {
        for row in &mut whole {
            row.iter_mut().zip(weights).for_each(|(x, w)| *x *= w);
            let sum: f64 = row.iter().sum();
            row.iter_mut().for_each(|x| *x /= sum);
        }
    }
    whole
}

fn rows(points: &[f64]) -> Rows {
    points.chunks(3).map(<[f64]>::to_vec).collect()
}

/// Weights that are no product of weights of rows and of columns.
fn bumpy() -> Vec<f64> {
    (0..90_u32).map(|k| 1.0 + f64::from(k * k % 7) / 4.0).collect()
}

#[test]
fn iterates_are_those_of_the_part_of_the_dense_kronecker_product() {
    let points = sheet(SHAPE, 2.0);
    for windows in [one_window(), several(), vec![[1..2, 0..9], [4..6, 0..9]]] {
        for weights in [None, Some(bumpy())] {
            let options = SurfaceOptions {
                method: Method::Local,
                residual: Some(0.0),
                iterations: 6,
                keep: (0..=6).collect(),
                rational_weights: weights.clone(),
                ..with(&windows)
            };
            let found = fit(&points, &options);
            assert_eq!((found.report.run.method, found.sequence.len()), ("local", 7));
            let a = matrix(&found, weights.as_deref());
            let (q, chosen) = (rows(&points), covered(&windows));
            let mut p = q.clone();
            for kept in &found.sequence {
                for (ours, theirs) in kept.control_points.iter().zip(&p) {
                    for (x, y) in ours.iter().zip(theirs) {
                        assert!((x - y).abs() < 1e-12, "{windows:?} {}", kept.entry.iteration);
                    }
                }
                let left = dense::differences(&a, &q, &p);
                let inside: Rows = chosen.iter().map(|&k| left[k].clone()).collect();
                let largest = dense::largest_norm(&inside);
                assert!((kept.entry.max_residual - largest).abs() < 1e-12, "{windows:?}");
                p = dense::local_pia_step(&a, &q, &p, &chosen);
            }
        }
    }
}

/// Every method that goes with the choice ends at the one limit, and no other control point moves.
#[test]
fn every_method_reaches_the_local_limit() {
    let methods = [
        Method::Auto,
        Method::Local,
        Method::Pia,
        Method::Weighted,
        Method::GaussSeidel,
        Method::Chebyshev,
        Method::Anderson { memory: None },
        Method::Preconditioned { half_bandwidth: Some(1) },
        Method::Sor,
        Method::Jacobi,
        Method::Adaptive,
    ];
    for grading in [1.2, 3.0] {
        let points = sheet(SHAPE, grading);
        for (windows, per_direction) in
            [(one_window(), false), (one_window(), true), (several(), false)]
        {
            for method in methods {
                let options = SurfaceOptions {
                    method,
                    per_direction,
                    degrees: [3, 2],
                    iterations: 100_000,
                    residual: Some(1e-11),
                    ..with(&windows)
                };
                let grid = GridView::new(SHAPE, 3, &points).unwrap();
                let found = match fit_surface(grid, &options) {
                    Ok(found) => found,
                    Err(Error::Incompatible { what, .. }) => {
                        let scattered = windows.len() > 1;
                        let known = match what {
                            "sor" | "jacobi" => !per_direction,
                            "adaptive" => per_direction,
                            "preconditioned" => scattered,
                            _ => false,
                        };
                        assert!(known, "{method:?} {per_direction} {windows:?}");
                        continue;
                    }
                    Err(error) => panic!("{method:?}: {error}"),
                };
                let case = format!("{method:?} {grading} {per_direction} {windows:?}");
                assert!(found.report.converged(), "{case}: {:?}", found.report.run);
                let control = rows(found.surface.control_net().points().coordinates());
                let (q, chosen) = (rows(&points), covered(&windows));
                let left = dense::differences(&matrix(&found, None), &q, &control);
                let mut outside = 0.0_f64;
                for (k, gap) in left.iter().enumerate() {
                    let size = gap.iter().map(|x| x * x).sum::<f64>().sqrt();
                    assert!((size - found.residuals()[k]).abs() < 1e-12, "{case}");
                    if chosen.contains(&k) {
                        assert!(size <= 2e-11, "{case}: {size:e}");
                    } else {
                        outside = outside.max(size);
                        assert_eq!(control[k], q[k], "{case}");
                    }
                }
                let local = found.report.run.local.unwrap();
                assert_eq!(local.chosen.len(), chosen.len());
                assert!((local.outside_max_residual - outside).abs() < 1e-12, "{case}");
                assert!(found.report.max_deviation <= outside * (1.0 + 1e-9), "{case}");
                let worst = found.report.max_residual_index;
                assert!(chosen.contains(&(worst[0] * SHAPE[1] + worst[1])), "{case}");
            }
        }
    }
}

/// Rows and columns of a closed surface on both sides of the seam are one window to the matrices.
#[test]
fn windows_reach_across_the_seam() {
    let turn = |k: usize, count: usize| std::f64::consts::TAU * k as f64 / count as f64;
    let point = |k: usize| {
        let (a, b) = (turn(k / SHAPE[1], SHAPE[0]), turn(k % SHAPE[1], SHAPE[1]));
        let r = 3.0 + b.cos() + 0.1 * (k as f64).sin();
        [r * a.cos(), r * a.sin(), b.sin()]
    };
    let points: Vec<f64> = (0..90).flat_map(point).collect();
    let windows = vec![[0..2, 0..9], [8..10, 0..9]];
    for method in [Method::Auto, Method::Local] {
        let options = SurfaceOptions { closed: [true, true], method, ..with(&windows) };
        let found = fit(&points, &options);
        assert!(found.report.converged());
        for (k, residual) in found.residuals().iter().enumerate() {
            let inside = [0, 1, 8, 9].contains(&(k / SHAPE[1]));
            assert!((*residual < 1e-10) == inside, "{k} {residual:e}");
            // The surface, not only the operator, meets the points.
            let [u, v] = [found.parameters[0][k / 9], found.parameters[1][k % 9]];
            let at = found.surface.evaluate(u, v).unwrap();
            let gap = (0..3).map(|c| (at[c] - points[3 * k + c]).powi(2)).sum::<f64>().sqrt();
            assert!((gap - residual).abs() < 1e-12);
        }
    }
    // The first row again at the end is the first row.
    let mut repeated = points.clone();
    repeated.extend_from_slice(&points[..27]);
    let grid = GridView::new([11, 9], 3, &repeated).unwrap();
    let closed = SurfaceOptions { closed: [true, true], ..with(&vec![[10..11, 2..4]]) };
    let last = fit_surface(grid, &closed).unwrap();
    let first = fit(&points, &SurfaceOptions { local: Some(vec![[0..1, 2..4]]), ..closed });
    assert_eq!(last.surface, first.surface);
}

#[test]
fn weights_per_point_go_with_the_points() {
    let points = sheet(SHAPE, 1.5);
    let omega: Vec<f64> = (0..90).map(|k| 0.7 + f64::from(k % 5) * 0.1).collect();
    let weight = IterationWeight::PerPoint(omega.clone());
    for windows in [one_window(), several()] {
        let options = SurfaceOptions {
            method: Method::Weighted,
            weight: weight.clone().into(),
            iterations: 1,
            residual: Some(0.0),
            ..with(&windows)
        };
        let found = fit(&points, &options);
        let q = rows(&points);
        let left = dense::differences(&matrix(&found, None), &q, &q);
        let control = rows(found.surface.control_net().points().coordinates());
        for k in covered(&windows) {
            for c in 0..3 {
                assert!((control[k][c] - (q[k][c] + omega[k] * left[k][c])).abs() < 1e-13);
            }
        }
    }
    let short = SurfaceOptions {
        method: Method::Weighted,
        weight: IterationWeight::PerPoint(vec![1.0; 20]).into(),
        ..with(&one_window())
    };
    let error = fit_surface(GridView::new(SHAPE, 3, &points).unwrap(), &short).unwrap_err();
    assert!(matches!(error, Error::WrongCount { expected: 90, .. }), "{error}");
}

#[test]
fn choices_that_make_no_sense_are_refused_with_the_reason() {
    let points = sheet(SHAPE, 1.5);
    let grid = GridView::new(SHAPE, 3, &points).unwrap();
    let refused = |options: SurfaceOptions| fit_surface(grid, &options).unwrap_err().to_string();
    let none = SurfaceOptions { method: Method::Local, ..Default::default() };
    assert!(refused(none).contains("name windows"));
    for empty in [vec![], vec![[3..3, 0..4]], vec![[2..4, 7..7], [9..9, 20..20]]] {
        assert!(refused(with(&empty)).contains("at least one"));
    }
    for beyond in [[0..11, 0..2], [0..1, 8..10], [usize::MAX - 1..usize::MAX, 0..1]] {
        assert!(refused(with(&vec![beyond])).contains("of a point to move"));
    }
    let geometric = Method::Geometric { global_start: false };
    let moving = SurfaceOptions { method: geometric, ..with(&one_window()) };
    assert!(refused(moving).contains("foot points"));
    let apart = SurfaceOptions { per_direction: true, ..with(&several()) };
    assert!(refused(apart).contains("crossings"));
}

#[test]
fn no_choice_of_windows_makes_a_fit_panic_or_tell_no_number() {
    let hostile = [f64::NAN, 1e300, -1e300, 1e-300, 0.0, 1e9 + 0.25, 1.0, f64::INFINITY];
    let mut random = Random::new(4);
    for round in 0..300 {
        let mut pick = |most: usize| (random.unit() * most as f64) as usize;
        let (shape, dimension) = ([pick(7), pick(7)], [1, 2, 3, 7][round % 4]);
        let wild = pick(2) == 0;
        let points: Vec<f64> = (0..shape[0] * shape[1] * dimension)
            .map(|_| if wild && pick(5) == 0 { hostile[pick(8)] } else { pick(9) as f64 })
            .collect();
        let Ok(grid) = GridView::new(shape, dimension, &points) else { continue };
        let range = |start: usize, length: usize| start..start + length;
        let local: Windows =
            (0..pick(4)).map(|_| [range(pick(6), pick(4)), range(pick(6), pick(4))]).collect();
        let methods = [Method::Auto, Method::Local, Method::Weighted, Method::Chebyshev];
        let options = SurfaceOptions {
            degrees: [1 + pick(3), 1 + pick(3)],
            closed: [pick(3) == 0, pick(3) == 0],
            parameterizations: [const { Some(Parameterization::Uniform) }; 2],
            knot_placements: [const { Some(KnotPlacement::Averaged) }; 2],
            rational_weights: (pick(4) == 0)
                .then(|| (0..shape[0] * shape[1]).map(|_| 0.5 + pick(3) as f64).collect()),
            method: methods[pick(4)],
            per_direction: pick(3) == 0,
            iterations: 100,
            local: Some(local),
            ..Default::default()
        };
        match fit_surface(grid, &options) {
            Err(error) => assert!(error.to_string().len() > 20),
            Ok(fit) => {
                let run = &fit.report.run;
                assert!(run.max_residual.is_finite() && fit.report.max_deviation.is_finite());
                assert!(
                    run.local.as_ref().is_some_and(|local| local.outside_max_residual.is_finite())
                );
                let control = fit.surface.control_net().points().coordinates();
                assert!(control.iter().all(|x| x.is_finite()));
            }
        }
    }
}
