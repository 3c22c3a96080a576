//! Laws of surfaces whose points are moved one by one.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::{
    EditableSurface, Error, GridView, KnotPlacement, Method, SurfaceFit, SurfaceOptions,
    fit_surface,
};
use gimfit_testkit::dense;
use gimfit_testkit::generate::Random;
use gimfit_testkit::textbook::{closed_collocation_matrix, collocation_matrix};
use std::f64::consts::TAU;

/// A bumpy sheet, torus or tube over lines whose steps vary by a factor of up to `grading`.
fn grid(shape: [usize; 2], closed: [bool; 2], grading: f64) -> Vec<f64> {
    let mut random = Random::new(7);
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
    let turn = |x: f64, of: &[f64]| TAU * x / (of[of.len() - 1] + 1.0);
    let point = |x: f64, y: f64| {
        let bump = 0.3 * (3.1 * x + 1.7 * y).sin();
        match closed {
            [false, false] => [x, y, bump],
            [true, false] => {
                let r = shape[0] as f64 + bump;
                [r * turn(x, &xs).cos(), r * turn(x, &xs).sin(), y]
            }
            [false, true] => {
                let r = shape[1] as f64 + bump;
                [x, r * turn(y, &ys).cos(), r * turn(y, &ys).sin()]
            }
            [true, true] => {
                let (a, b) = (turn(x, &xs), turn(y, &ys));
                let r = 3.0 * shape[0] as f64 + shape[1] as f64 * b.cos() + bump;
                [r * a.cos(), r * a.sin(), shape[1] as f64 * b.sin()]
            }
        }
    };
    xs.iter().flat_map(|&x| ys.iter().flat_map(move |&y| point(x, y)).collect::<Vec<_>>()).collect()
}

fn options(degrees: [usize; 2], closed: [bool; 2]) -> SurfaceOptions {
    SurfaceOptions { degrees, closed, ..Default::default() }
}

/// Moves of random points, with what they must not touch, checked.
fn shake(surface: &mut EditableSurface, random: &mut Random, moves: usize) -> f64 {
    let mut bound = 0.0;
    for _ in 0..moves {
        let at = surface.shape().map(|count| (random.unit() * count as f64) as usize);
        let mut point = surface.point(at[0], at[1]);
        point.iter_mut().for_each(|x| *x += random.signed());
        let report = surface.move_point(at[0], at[1], &point).unwrap();
        assert_eq!(surface.point(at[0], at[1]), point);
        assert_eq!(report.bound, surface.bound());
        bound = report.bound;
    }
    bound
}

fn farthest(ours: &SurfaceFit, theirs: &SurfaceFit) -> f64 {
    let pairs = ours
        .surface
        .control_net()
        .points()
        .iter()
        .zip(theirs.surface.control_net().points().iter());
    let gap = |(a, b): (&[f64], &[f64])| a.iter().zip(b).fold(0.0, |s: f64, (a, b)| s.hypot(a - b));
    pairs.map(gap).fold(0.0, f64::max)
}

fn refit(surface: &EditableSurface, like: &SurfaceFit) -> SurfaceFit {
    let points = surface.points().unwrap();
    let grid = GridView::new(surface.shape(), surface.dimension(), points.coordinates()).unwrap();
    let given = |k: usize| {
        let mut t = like.parameters[k].clone();
        if like.surface.is_periodic()[k] {
            // In rising order again, and the period.
            let (start, end) = like.surface.knots()[k].domain();
            let seam = t.windows(2).position(|t| t[1] < t[0]).map_or(0, |at| at + 1);
            t[..seam].iter_mut().for_each(|t| *t -= end - start);
            t.push(t[0] + (end - start));
        }
        Some(gimfit::Parameterization::Given(t))
    };
    let options = SurfaceOptions {
        parameterizations: [given(0), given(1)],
        knot_placements: [0, 1]
            .map(|k| Some(KnotPlacement::Given(like.surface.knots()[k].values().to_vec()))),
        ..options(surface.degrees(), like.surface.is_periodic())
    };
    fit_surface(grid, &options).unwrap()
}

/// The maximum norm of the inverse of a matrix, by dense elimination.
fn inverse_norm(matrix: &dense::Rows) -> f64 {
    let unit = |j: usize| (0..matrix.len()).map(|i| f64::from(u8::from(i == j))).collect();
    let inverse = dense::solve(matrix, &(0..matrix.len()).map(unit).collect());
    inverse.iter().map(|row| row.iter().map(|x| x.abs()).sum::<f64>()).fold(0.0, f64::max)
}

#[test]
fn moves_stay_within_the_bound_of_the_fit_of_all_points() {
    for degrees in [[1, 2], [3, 3], [2, 4], [5, 3]] {
        for closed in [[false, false], [true, false], [false, true], [true, true]] {
            for (shape, grading) in [([9, 8], 1.5), ([14, 11], 3.0), ([70, 64], 1.5)] {
                if shape[0] > 20 && degrees != [3, 3] {
                    continue;
                }
                let points = grid(shape, closed, grading);
                let view = GridView::new(shape, 3, &points).unwrap();
                let mut surface = EditableSurface::new(view, &options(degrees, closed)).unwrap();
                let bound = shake(&mut surface, &mut Random::new(3), 12);
                let (fit, case) =
                    (surface.fit().unwrap(), format!("{degrees:?} {closed:?} {shape:?}"));
                assert!(fit.report.converged(), "{case} {:?}", fit.report.run);
                let whole = refit(&surface, &fit);
                let off = farthest(&fit, &whole);
                // The refit leaves a residual, too.
                assert!(off <= 2.0 * bound, "{case}: {off:e} {bound:e}");
                assert!(off <= 1e-8, "{case}: {off:e}");
                if shape[0] > 20 {
                    continue;
                }
                // The bound is the textbook's norms times a residual, and not much else.
                let norm: f64 = (0..2)
                    .map(|k| {
                        let (knots, t) = (&fit.surface.knots()[k], &fit.parameters[k]);
                        if closed[k] {
                            let (start, end) = knots.domain();
                            let rising = {
                                let mut t = t.clone();
                                t.sort_by(f64::total_cmp);
                                t
                            };
                            inverse_norm(&closed_collocation_matrix(
                                degrees[k],
                                &rising,
                                end - start,
                            ))
                        } else {
                            inverse_norm(&collocation_matrix(knots.values(), degrees[k], t))
                        }
                    })
                    .product();
                let least = norm * fit.report.run.max_residual * (1.0 - 1e-5);
                let extent = fit.report.run.extent;
                assert!(
                    least <= bound && bound <= 3.0 * norm * 3e-12 * extent,
                    "{case} {bound:e} {norm}"
                );
            }
        }
    }
}

#[test]
fn only_control_points_nearby_move() {
    let shape = [90, 80];
    for closed in [[false, false], [true, true]] {
        let points = grid(shape, closed, 1.3);
        let view = GridView::new(shape, 3, &points).unwrap();
        for (degrees, most) in [([1, 1], 900), ([3, 3], 2500), ([2, 4], 3000)] {
            let mut surface = EditableSurface::new(view, &options(degrees, closed)).unwrap();
            for at in [[0, 0], [45, 40], [89, 3], [20, 79]] {
                let before = surface.fit().unwrap();
                let mut point = surface.point(at[0], at[1]);
                point[2] += 0.5;
                let report = surface.move_point(at[0], at[1], &point).unwrap();
                let after = surface.fit().unwrap();
                assert!(report.control_points_touched <= most, "{degrees:?} {report:?}");
                let moved = before
                    .surface
                    .control_net()
                    .points()
                    .iter()
                    .zip(after.surface.control_net().points().iter())
                    .filter(|(a, b)| a != b)
                    .count();
                // Closed nets store some of them twice.
                let twice = closed.iter().zip(degrees).map(|(c, p)| if *c { p } else { 0 });
                let extra: usize = twice.sum::<usize>() * 90;
                assert!(0 < moved && moved <= report.control_points_touched + extra, "{moved}");
                let product = report.window[0].len() * report.window[1].len();
                assert_eq!(product, report.control_points_touched);
                assert!(report.max_residual <= 1e-11 * after.report.run.extent);
            }
        }
    }
}

#[test]
fn points_of_the_surface_are_found_from_nearby() {
    let mut random = Random::new(4);
    for closed in [[false, false], [true, true]] {
        for knots in [None, Some(KnotPlacement::AtData)] {
            let points = grid([12, 10], closed, 1.5);
            let view = GridView::new([12, 10], 3, &points).unwrap();
            let options = SurfaceOptions {
                knot_placements: [knots.clone(), knots],
                ..options([3, 3], closed)
            };
            let mut surface = EditableSurface::new(view, &options).unwrap();
            shake(&mut surface, &mut random, 6);
            let whole = surface.fit().unwrap();
            let [(u_0, u_1), (v_0, v_1)] = whole.surface.domain();
            for _ in 0..60 {
                let (s, t) = (random.unit(), random.unit());
                let (u, v) = (u_0 + s * (u_1 - u_0), v_0 + t * (v_1 - v_0));
                let (ours, theirs) =
                    (surface.evaluate(u, v).unwrap(), whole.surface.evaluate(u, v).unwrap());
                let off = ours.iter().zip(&theirs).fold(0.0, |s: f64, (a, b)| s.hypot(a - b));
                assert!(off <= 1e-12, "{off:e}");
            }
            assert!(matches!(surface.evaluate(u_1 + 1.0, v_0), Err(Error::OutsideDomain { .. })));
        }
    }
}

#[test]
fn a_refused_move_changes_nothing() {
    let points = grid([9, 8], [false, false], 1.5);
    let view = GridView::new([9, 8], 3, &points).unwrap();
    let mut surface = EditableSurface::new(view, &options([3, 3], [false, false])).unwrap();
    let before = surface.fit().unwrap();
    let errors = [
        surface.move_point(9, 0, &[0.0; 3]),
        surface.move_point(0, 8, &[0.0; 3]),
        surface.move_point(usize::MAX, usize::MAX, &[0.0; 3]),
        surface.move_point(1, 1, &[0.0; 2]),
        surface.move_point(1, 1, &[]),
        surface.move_point(1, 1, &[0.0, f64::NAN, 0.0]),
        surface.move_point(1, 1, &[0.0, f64::INFINITY, 0.0]),
        surface.move_point(1, 1, &[1e300, 0.0, 0.0]),
        surface.move_point(4, 4, &[f64::MAX, -f64::MAX, 0.0]),
    ];
    for (k, error) in errors.iter().enumerate() {
        assert!(error.as_ref().unwrap_err().to_string().len() > 20, "{k}");
    }
    let after = surface.fit().unwrap();
    assert_eq!(
        (&after.surface, &after.difference_vectors),
        (&before.surface, &before.difference_vectors)
    );
    // And a move back leaves nothing but rounding.
    let old = surface.point(4, 4);
    surface.move_point(4, 4, &[4.0, 4.0, 90.0]).unwrap();
    surface.move_point(4, 4, &old).unwrap();
    assert!(farthest(&surface.fit().unwrap(), &before) <= 2.0 * surface.bound());
}

#[test]
fn what_cannot_be_edited_is_refused() {
    let points = grid([9, 8], [false, false], 1.5);
    let view = GridView::new([9, 8], 3, &points).unwrap();
    let open = options([3, 3], [false, false]);
    let rational = SurfaceOptions { rational_weights: Some(vec![2.0; 72]), ..open.clone() };
    let geometric = Method::Geometric { global_start: false };
    let moving = SurfaceOptions { method: geometric, iterations: 3, ..open.clone() };
    for options in [rational, moving] {
        let error = EditableSurface::new(view, &options).unwrap_err();
        assert!(matches!(error, Error::Incompatible { .. }), "{error}");
    }
    let fit = fit_surface(view, &open).unwrap();
    let other = GridView::new([8, 9], 3, &points).unwrap();
    assert!(matches!(EditableSurface::from_fit(other, &fit), Err(Error::WrongCount { .. })));
}

#[test]
fn any_scale_place_and_dimension_will_do() {
    for dimension in [1, 2, 3, 7] {
        for (scale, shift) in [(1.0, 0.0), (1e300, 0.0), (1e-300, 0.0), (1.0, 1e9)] {
            let mut random = Random::new(2);
            let value = |k: usize, random: &mut Random| match k % dimension {
                0 => (k / dimension / 10) as f64,
                1 => (k / dimension % 10) as f64,
                _ => random.unit(),
            };
            let points: Vec<f64> =
                (0..100 * dimension).map(|k| scale * value(k, &mut random) + shift).collect();
            let view = GridView::new([10, 10], dimension, &points).unwrap();
            let mut surface = EditableSurface::new(view, &options([3, 2], [false, false])).unwrap();
            let mut point = surface.point(9, 4);
            point[0] += 0.5 * scale;
            surface.move_point(9, 4, &point).unwrap();
            let (fit, bound) = (surface.fit().unwrap(), surface.bound());
            assert!(fit.report.converged(), "{dimension} {scale} {shift}");
            let extent = fit.report.run.extent;
            assert!(bound <= 1e-9 * extent + 1e-11 * shift, "{dimension} {scale} {bound:e}");
        }
    }
}

#[test]
fn a_closing_row_that_is_repeated_stays_left_out() {
    let points = grid([12, 10], [true, false], 1.5);
    let mut again = points.clone();
    again.extend_from_slice(&points[..30]);
    let view = GridView::new([13, 10], 3, &again).unwrap();
    let mut surface = EditableSurface::new(view, &options([3, 3], [true, false])).unwrap();
    assert_eq!(surface.shape(), [12, 10]);
    surface.move_point(11, 9, &[1.0, 2.0, 3.0]).unwrap();
    assert!(surface.fit().unwrap().report.converged());
}
