//! Fits that keep the turns of a planar data polygon, judged in exact arithmetic and by dense
//! oracles.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::iteration::{Flow, Snapshot};
use gimfit::{
    Convexity, CurveFit, CurveOptions, Error, KnotPlacement, Method, Parameterization,
    SurfaceOptions, Termination, fit_curve, fit_curve_observed,
};
use gimfit_testkit::convexity::{
    Triple, algorithm_1, convex_triples, corner_triples, has_triples, optimality, turn_signs,
};
use gimfit_testkit::dense::{self, Rows};
use gimfit_testkit::generate::{Random, random_walk};
use gimfit_testkit::textbook;
use std::f64::consts::{PI, TAU};

type Polygon = Vec<[f64; 2]>;

const PUBLISHED: Convexity = Convexity::Published { threshold: None };

fn rows(polygon: &[f64]) -> Rows {
    polygon.chunks_exact(2).map(<[f64]>::to_vec).collect()
}

fn options(convexity: Convexity) -> CurveOptions {
    CurveOptions { convexity: Some(convexity), ..Default::default() }
}

fn at_data(convexity: Convexity) -> CurveOptions {
    CurveOptions { knot_placement: Some(KnotPlacement::AtData), ..options(convexity) }
}

/// Half an ellipse of axes 3 and 1, nine points.
fn half_ellipse() -> Polygon {
    (0..9).map(|i| PI * f64::from(i) / 8.0).map(|a| [3.0 * a.cos(), a.sin()]).collect()
}

fn parabola() -> Polygon {
    (0..9).map(|i| -3.0 + 0.75 * f64::from(i)).map(|x| [x, x * x]).collect()
}

/// A rounded corner, convex, whose interpolant is not.
fn corner() -> Polygon {
    vec![
        [0.0, 3.0],
        [0.0, 2.0],
        [0.05, 1.0],
        [0.2, 0.2],
        [1.0, 0.05],
        [2.0, 0.0],
        [3.0, 0.0001],
        [4.0, 0.01],
    ]
}

/// A square whose sides hold two points each.
fn square() -> Polygon {
    let mut points = Vec::new();
    for (corner, way) in [
        ([0.0, 0.0], [1.0, 0.0]),
        ([3.0, 0.0], [0.0, 1.0]),
        ([3.0, 3.0], [-1.0, 0.0]),
        ([0.0, 3.0], [0.0, -1.0]),
    ] {
        let corner: [f64; 2] = corner;
        points.extend((0..3).map(|i| [0, 1].map(|c| corner[c] + f64::from(i) * way[c])));
    }
    points
}

/// Points on an ellipse at random angles.
fn on_ellipse(random: &mut Random, count: usize) -> Polygon {
    let mut angles: Vec<f64> = (0..count).map(|_| TAU * random.unit()).collect();
    angles.sort_by(f64::total_cmp);
    angles.into_iter().map(|a| [2.0 * a.cos(), a.sin()]).collect()
}

fn walk(seed: u64, count: usize) -> Polygon {
    random_walk(seed, count, 2).iter().map(|p| [p[0], p[1]]).collect()
}

/// Whether a polygon has the turns of the data, one by one; straight ones of the data may turn as
/// both neighbours do.
fn keeps(data: &Polygon, control: &[f64], closed: bool) -> bool {
    let wanted = turn_signs(&rows(data.as_flattened()), closed);
    let found = turn_signs(&rows(control), closed);
    wanted.len() == found.len()
        && wanted.iter().zip(&found).all(|(wanted, found)| *wanted == 0 || wanted == found)
}

/// Whether points can be the control points of a curve that bends as they turn: successive ones that
/// turn to one side are the corners of convex polygons, and none lie on a line.
fn is_tame(data: &Polygon, options: &CurveOptions) -> bool {
    let data = rows(data.as_flattened());
    let signs = turn_signs(&data, options.closed);
    !signs.contains(&0) && convex_triples(&data, &signs, options.degree).1
}

/// Whether two neighbouring control points all but coincide: the one reason to crawl.
fn falls_together(fit: &CurveFit) -> bool {
    let control: Vec<&[f64]> = fit.curve.control_points().iter().collect();
    control.windows(2).any(|pair| {
        (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]) < 1e-3 * fit.report.run.extent
    })
}

/// Fits, and checks the turns of every polygon on the way.
fn fit_keeping(data: &Polygon, options: &CurveOptions) -> CurveFit {
    let mut lost = None;
    let mut watch = |snapshot: Snapshot<'_>| {
        if !keeps(data, snapshot.control, options.closed) {
            lost.get_or_insert(snapshot.entry.iteration);
        }
        Flow::Continue
    };
    let fit = fit_curve_observed(data, options, &mut watch).unwrap();
    let shape = fit.report.shape.unwrap();
    assert!(shape.kept || !is_tame(data, options), "{:?}", fit.report);
    // Where it is the interpolating curve that bends as the data turn, its control polygon over
    // more knots, if need be, has the turns in that order.
    let interpolant = fit.report.run.method == "preconditioned";
    assert!(lost.is_none() || interpolant && fit.report.converged(), "iteration {lost:?}");
    fit
}

#[test]
fn the_published_algorithm_stalls_where_theory_says_it_may() {
    // The figures of an independent computation: eps and the error at which the run freezes.
    let fit = fit_keeping(&half_ellipse(), &at_data(PUBLISHED));
    assert_eq!(fit.report.run.termination, Termination::Stalled);
    assert_eq!(format!("{:.1e}", fit.report.run.max_residual), "1.3e-2");
    let fit = fit_keeping(&parabola(), &at_data(PUBLISHED));
    assert_eq!(fit.report.run.termination, Termination::Stalled);
    assert_eq!(format!("{:.1e}", fit.report.run.max_residual), "2.0e-3");
    let history = &fit.report.run.history;
    assert!((history[10].max_residual - history[9].max_residual).abs() > 1e-4);
    assert!((history[11].max_residual - history[10].max_residual).abs() < 1e-9);
    let fit = fit_keeping(&corner(), &options(PUBLISHED));
    assert_eq!(fit.report.run.termination, Termination::Stalled);
}

#[test]
fn the_published_algorithm_is_that_of_the_paper_step_by_step() {
    for (data, shares) in [
        (half_ellipse(), &[1.0, 1.0, 1.0, 1.0][..]),
        (parabola(), &[1.0, 1.0, 1.0, 1.0]),
        (corner(), &[]),
    ] {
        let q = rows(data.as_flattened());
        let t = textbook::chord_parameters(&q);
        let a = textbook::collocation_matrix(&textbook::averaged_knots(3, &t), 3, &t);
        let options = CurveOptions {
            convexity: Some(Convexity::Published { threshold: Some(1e-9) }),
            iterations: 8,
            residual: Some(0.0),
            ..Default::default()
        };
        let found = fit_keeping(&data, &options);
        let (taken, history) = algorithm_1(&a, &q, 1e-9, 8);
        assert_eq!(&taken[..shares.len()], shares);
        for (entry, expected) in found.report.run.history.iter().zip(&history) {
            assert!((entry.max_residual - expected).abs() < 1e-8, "{}", entry.iteration);
        }
    }
}

#[test]
fn ours_reaches_the_interpolant_where_its_polygon_is_convex() {
    for (data, options) in
        [(half_ellipse(), options(Convexity::Closest)), (parabola(), at_data(Convexity::Closest))]
    {
        let fit = fit_keeping(&data, &options);
        let plain = CurveOptions { convexity: None, ..options };
        let plain = fit_curve(&data, &plain).unwrap();
        assert!(fit.report.converged() && fit.report.run.iterations == 1, "{:?}", fit.report);
        assert_eq!(fit.curve, plain.curve);
    }
}

#[test]
fn ours_keeps_every_turn_and_reaches_what_can_be_reached() {
    let mut random = Random::new(3);
    for seed in 0..8 {
        for degree in [1, 2, 3, 4] {
            for closed in [false, true] {
                let options = CurveOptions { degree, closed, ..options(Convexity::Closest) };
                for data in
                    [on_ellipse(&mut random, 8 + 4 * seed), walk(1 + seed as u64, 8 + 2 * seed)]
                {
                    let fit = fit_keeping(&data, &options);
                    let interpolant =
                        fit_curve(&data, &CurveOptions { convexity: None, ..options.clone() });
                    let interpolant = interpolant.unwrap();
                    let free = interpolant.curve.free_control_points() * 2;
                    let stored = &interpolant.curve.control_points().coordinates()[..free];
                    let case = format!("seed {seed} degree {degree} closed {closed}");
                    // The stored order of a closed curve may start elsewhere; turn counts tell then.
                    let has = |sign| {
                        turn_signs(&rows(stored), closed).iter().filter(|&&s| s == sign).count()
                    };
                    let shape = fit.report.shape.unwrap();
                    let convex = shape.right == 0 && has(-1) == 0;
                    if convex {
                        assert!(fit.report.converged(), "{case}");
                    }
                    let crawls = fit.report.run.termination == Termination::Iterations;
                    if fit.report.run.termination == Termination::Constrained {
                        assert!(fit.report.run.max_residual > 1e-9, "{case}");
                    } else if crawls {
                        assert!(falls_together(&fit), "{case}");
                    } else {
                        assert!(fit.report.converged(), "{case}: {}", fit.report.run.termination);
                    }
                }
            }
        }
    }
}

/// The largest share of the sum of squares that a random move of one or all points gains without
/// changing a triple.
fn nearby_gain(a: &Rows, q: &Rows, p: &Rows, triples: &[Triple]) -> f64 {
    let squares =
        |p: &Rows| dense::differences(a, q, p).iter().flatten().map(|x| x * x).sum::<f64>();
    let (mut random, before) = (Random::new(17), squares(p));
    let mut most = 0.0_f64;
    for trial in 0..6000 {
        let size = 10_f64.powi(-1 - trial % 6);
        let only = (trial % 2 == 0).then(|| (random.unit() * p.len() as f64) as usize);
        let mut moved = p.clone();
        for (i, point) in moved.iter_mut().enumerate() {
            if only.is_none_or(|only| only == i) {
                point.iter_mut().for_each(|x| *x += size * random.signed());
            }
        }
        if has_triples(&moved, triples) {
            most = most.max(1.0 - squares(&moved) / before);
        }
    }
    most
}

#[test]
fn the_closest_fit_is_stationary() {
    let mut cases = vec![(corner(), 3), (corner(), 4), (corner(), 5), (square(), 3), (square(), 4)];
    let mut random = Random::new(8);
    cases.extend((0..4).map(|i| (on_ellipse(&mut random, 12 + i), 4)));
    cases.extend((0..4).map(|i| (walk(20 + i, 14), 3)));
    let mut constrained = 0;
    for (number, (data, degree)) in cases.into_iter().enumerate() {
        let options = CurveOptions { degree, ..options(Convexity::Closest) };
        let fit = fit_keeping(&data, &options);
        if fit.report.run.termination == Termination::Residual {
            continue;
        }
        assert_eq!(fit.report.run.termination, Termination::Constrained, "case {number}");
        constrained += 1;
        let q = rows(data.as_flattened());
        let t = textbook::chord_parameters(&q);
        let a = textbook::collocation_matrix(&textbook::averaged_knots(degree, &t), degree, &t);
        let p = rows(fit.curve.control_points().coordinates());
        let mut signs = turn_signs(&q, false);
        if signs.contains(&0) {
            signs.fill(1);
        }
        let mut triples = corner_triples(&signs, q.len());
        triples.extend(convex_triples(&q, &signs, degree).0);
        assert!(nearby_gain(&a, &q, &p, &triples) < 1e-4, "case {number}");
        if (number, degree) == (2, 5) {
            // Two control points fall together here, where no multipliers exist.
            continue;
        }
        let found = optimality(&a, &q, &p, &triples);
        assert!(found.unbalanced < 2e-3, "case {number}: {found:?}");
        assert!(found.complementarity < 1e-5, "case {number}: {found:?}");
        // The published algorithm ends no closer.
        let published = fit_curve(&data, &CurveOptions { degree, ..self::options(PUBLISHED) });
        assert!(published.unwrap().report.run.rms_residual >= fit.report.run.rms_residual);
    }
    assert!(constrained > 6);
}

#[test]
fn a_convex_interpolant_with_a_turning_polygon_is_shown_convex_over_more_knots() {
    // Five points of a parabola, unevenly: a quartic meets it exactly, and bends one way only; its
    // control polygon need not.
    let mut found = 0;
    let mut random = Random::new(5);
    for trial in 0..60 {
        let degree = 3 + trial % 3;
        let closed = trial % 2 == 1;
        let data = on_ellipse(&mut random, 9 + trial % 7);
        let options = CurveOptions {
            degree,
            closed,
            keep: if trial % 4 < 2 { vec![0, 1] } else { Vec::new() },
            ..options(Convexity::Closest)
        };
        let fit = fit_curve(&data, &options).unwrap();
        let shape = fit.report.shape.unwrap();
        if shape.inserted_knots == 0 {
            continue;
        }
        found += 1;
        assert!(fit.report.converged() && shape.kept);
        let plain =
            fit_curve(&data, &CurveOptions { convexity: None, keep: Vec::new(), ..options });
        let plain = plain.unwrap();
        for t in plain.curve.equal_steps(97) {
            let (a, b) = (plain.curve.evaluate(t).unwrap(), fit.curve.evaluate(t).unwrap());
            assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-11);
        }
        let stored = fit.curve.control_points().coordinates();
        let turns = turn_signs(&rows(&stored[..2 * fit.curve.free_control_points()]), closed);
        assert!(turns.iter().all(|&turn| turn >= 0), "trial {trial}: {turns:?}");
        for kept in &fit.sequence {
            assert_eq!(kept.control_points.len(), fit.curve.control_points().len());
        }
    }
    assert!(found > 5, "{found}");
}

#[test]
fn where_a_closed_curve_starts_does_not_matter() {
    // A bean: two inflections, and a seam put everywhere among them.
    let bean: Polygon = (0..24)
        .map(|i| TAU * f64::from(i) / 24.0)
        .map(|a| (a, 1.0 + 0.45 * (2.0 * a).cos()))
        .map(|(a, r)| [2.0 * r * a.cos(), r * a.sin()])
        .collect();
    let mut reached = None;
    for start in 0..bean.len() {
        let data = [&bean[start..], &bean[..start]].concat();
        for degree in [3, 4] {
            let options = CurveOptions { closed: true, degree, ..options(Convexity::Closest) };
            let fit = fit_keeping(&data, &options);
            let shape = fit.report.shape.unwrap();
            assert!(shape.left > 0 && shape.right > 0);
            if degree == 3 {
                let converged = fit.report.converged();
                assert_eq!(*reached.get_or_insert(converged), converged, "start {start}");
            }
        }
    }
}

#[test]
fn straight_sides_bulge_outwards_or_stay() {
    for closed in [false, true] {
        let data = square();
        let fit = fit_keeping(&data, &CurveOptions { closed, ..options(Convexity::Closest) });
        assert_eq!(fit.report.run.termination, Termination::Constrained);
        let shape = fit.report.shape.unwrap();
        assert_eq!((shape.left, shape.right), (if closed { 4 } else { 3 }, 0));
        let free = 2 * fit.curve.free_control_points();
        let control = &fit.curve.control_points().coordinates()[..free];
        assert!(turn_signs(&rows(control), closed).iter().all(|&turn| turn >= 0));
    }
    let line: Polygon =
        (0..12).map(|i| [0.5 * f64::from(i * i), 0.25 * f64::from(i * i)]).collect();
    let fit = fit_curve(&line, &options(Convexity::Closest)).unwrap();
    assert!(fit.report.converged());
    assert_eq!(fit.report.shape.unwrap().straight, 10);
}

#[test]
fn similar_data_have_similar_fits() {
    let (cosine, sine) = (0.8, 0.6);
    let turned = |data: &Polygon, scale: f64| -> Polygon {
        data.iter()
            .map(|[x, y]| {
                [scale * (cosine * x - sine * y) + 2.0, scale * (sine * x + cosine * y) - 5.0]
            })
            .collect()
    };
    for data in [corner(), walk(9, 15), walk(10, 15)] {
        let fit = fit_keeping(&data, &options(Convexity::Closest));
        for scale in [1.0, 64.0] {
            let other = fit_keeping(&turned(&data, scale), &options(Convexity::Closest));
            let ratio = other.report.run.rms_residual / (scale * fit.report.run.rms_residual);
            assert!((ratio - 1.0).abs() < 1e-5, "{ratio}");
        }
    }
}

#[test]
fn reversed_data_have_the_same_fit() {
    for data in [corner(), square(), half_ellipse(), walk(9, 15)] {
        let fit = fit_keeping(&data, &options(Convexity::Closest));
        let reversed: Polygon = data.iter().rev().copied().collect();
        let back = fit_keeping(&reversed, &options(Convexity::Closest));
        let extent = fit.report.run.extent;
        let there = fit.curve.control_points().iter();
        let mirrored: Vec<&[f64]> = back.curve.control_points().iter().collect();
        for (a, b) in there.zip(mirrored.into_iter().rev()) {
            assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-3 * extent);
        }
        let ratio = fit.report.run.rms_residual - back.report.run.rms_residual;
        assert!(ratio.abs() < 1e-6 * extent);
    }
}

#[test]
fn fits_of_the_way_keep_the_turns_too() {
    for data in [corner(), square(), half_ellipse()] {
        let keep = vec![0, 1, 2, 5];
        let fit = fit_keeping(&data, &CurveOptions { keep, ..options(Convexity::Closest) });
        assert_eq!(fit.sequence.len(), 4);
        for kept in &fit.sequence {
            assert!(keeps(&data, kept.control_points.coordinates(), false));
        }
    }
}

#[test]
fn other_methods_can_be_guarded_as_published() {
    let data = half_ellipse();
    for method in [Method::Weighted, Method::GaussSeidel, Method::Jacobi, Method::Sor] {
        fit_keeping(&data, &CurveOptions { method, ..at_data(PUBLISHED) });
    }
    let chebyshev = CurveOptions { method: Method::Chebyshev, ..at_data(PUBLISHED) };
    assert!(matches!(fit_curve(&data, &chebyshev), Err(Error::Incompatible { .. })));
    let chosen = CurveOptions { method: Method::Jacobi, ..options(Convexity::Closest) };
    assert!(matches!(fit_curve(&data, &chosen), Err(Error::Incompatible { .. })));
}

#[test]
fn what_has_no_turns_is_refused() {
    let space = random_walk(1, 9, 3).concat();
    let space = gimfit::Points::new(3, space).unwrap();
    for convexity in [PUBLISHED, Convexity::Closest] {
        let refused = fit_curve(&space, &options(convexity));
        assert!(matches!(refused, Err(Error::Incompatible { .. })));
        let mut twice = corner();
        twice.insert(3, twice[3]);
        let uniform = CurveOptions {
            parameterization: Some(Parameterization::Uniform),
            ..options(convexity)
        };
        let refused = fit_curve(&twice, &uniform);
        assert!(matches!(refused, Err(Error::RepeatedPoints { first: 3, second: 4, .. })));
    }
    for threshold in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let bad = options(Convexity::Published { threshold: Some(threshold) });
        assert!(matches!(fit_curve(&corner(), &bad), Err(Error::OutOfRange { .. })));
    }
    let _ = SurfaceOptions::default();
}

#[test]
fn hostile_polygons_end_in_time_and_keep_their_turns() {
    let zigzag: Polygon = (0..20).map(|i| [f64::from(i), f64::from(i % 2)]).collect();
    let star: Polygon = (0..10)
        .map(|i| (PI * f64::from(i) / 5.0, if i % 2 == 0 { 1.0 } else { 0.3 }))
        .map(|(a, r)| [r * a.cos(), r * a.sin()])
        .collect();
    let spiral: Polygon = (0..60)
        .map(|i| 0.3 * f64::from(i))
        .map(|a| [(1.0 + a) * a.cos(), (1.0 + a) * a.sin()])
        .collect();
    let back: Polygon =
        vec![[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [3.0, 0.0], [3.0, 1.0], [0.0, 2.0]];
    let triangle: Polygon = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    for convexity in [PUBLISHED, Convexity::Closest] {
        for closed in [false, true] {
            for data in [&zigzag, &star, &spiral, &back] {
                fit_keeping(data, &CurveOptions { closed, ..options(convexity) });
            }
            fit_keeping(&triangle, &CurveOptions { closed, degree: 2, ..options(convexity) });
            fit_keeping(&triangle, &CurveOptions { closed, degree: 1, ..options(convexity) });
        }
        // Scaling by powers of two changes nothing but the scale.
        let plain = fit_curve(&square(), &options(convexity)).unwrap();
        for exponent in [-1000, 900] {
            let scale = 2.0_f64.powi(exponent);
            let data: Polygon = square().iter().map(|p| p.map(|x| x * scale)).collect();
            let fit = fit_curve(&data, &options(convexity)).unwrap();
            assert_eq!(fit.report.run.rms_residual, plain.report.run.rms_residual * scale);
            assert_eq!(fit.report.run.termination, plain.report.run.termination);
        }
        let far: Polygon = square().iter().map(|p| p.map(|x| x + 1e9)).collect();
        let fit = fit_keeping(&far, &options(convexity));
        let change = fit.report.run.rms_residual - plain.report.run.rms_residual;
        assert!(change.abs() < 1e-5, "{change}");
    }
}

#[test]
fn far_from_the_origin_the_closest_fit_ends_where_rounding_hides_what_is_left() {
    for data in [half_ellipse(), corner(), walk(20, 14)] {
        let options = at_data(Convexity::Closest);
        let near = fit_keeping(&data, &options).report.run;
        assert_eq!(near.termination, Termination::Constrained);
        let far: Polygon = data.iter().map(|p| p.map(|x| x + 1e9)).collect();
        let far = fit_keeping(&far, &options).report.run;
        assert_eq!(far.termination, Termination::Constrained);
        assert!(far.iterations < 100, "{}", far.iterations);
        assert!((far.rms_residual - near.rms_residual).abs() < 1e-6);
    }
}
