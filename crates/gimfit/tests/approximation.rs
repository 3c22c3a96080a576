//! Laws of approximation: what the report says is what dense sampling finds, and demands that were
//! called met are met.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::{
    ApproximationOptions, Corners, CurveFit, Error, Goal, PointsView, Robust, Termination,
    approximate_curve,
};
use gimfit_testkit::{generate, textbook};
use proptest::prelude::*;

/// Points of a fitted curve by the textbook's recursion, dense, with no code of the library.
fn dense(fit: &CurveFit, per_span: usize) -> Vec<Vec<f64>> {
    let knots = fit.curve.knots().values();
    let degree = fit.curve.degree();
    let n = fit.curve.control_points().len();
    let control: Vec<Vec<f64>> = fit.curve.control_points().iter().map(<[f64]>::to_vec).collect();
    let mut points = Vec::new();
    for s in degree..n {
        let (a, b) = (knots[s], knots[s + 1]);
        if a == b {
            continue;
        }
        for i in 0..per_span {
            let t = a + (b - a) * (i as f64 / per_span as f64);
            points.push(textbook::curve_point(knots, degree, &control, t));
        }
    }
    let end = knots[n];
    points.push(textbook::curve_point(knots, degree, &control, end));
    points
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt()
}

/// Distance of a point from a segment.
fn from_segment(x: &[f64], a: &[f64], b: &[f64]) -> f64 {
    let along: f64 = (0..x.len()).map(|i| (x[i] - a[i]) * (b[i] - a[i])).sum();
    let square: f64 = (0..x.len()).map(|i| (b[i] - a[i]).powi(2)).sum();
    let share = if square > 0.0 { (along / square).clamp(0.0, 1.0) } else { 0.0 };
    let foot: Vec<f64> = (0..x.len()).map(|i| a[i] + share * (b[i] - a[i])).collect();
    distance(x, &foot)
}

/// Compares the figures of the report with dense sampling.
fn check_figures(points: &[Vec<f64>], fit: &CurveFit, closed: bool) {
    let account = fit.report.approximation.as_ref().unwrap();
    let samples = dense(fit, 40);
    let distances: Vec<f64> = points
        .iter()
        .map(|q| {
            samples
                .windows(2)
                .map(|pair| from_segment(q, &pair[0], &pair[1]))
                .fold(f64::MAX, f64::min)
        })
        .collect();
    let largest = distances.iter().copied().fold(0.0, f64::max);
    let extent = fit.report.run.extent;
    // The polyline through the samples and that of the report are sampled at different places.
    let slack = 1e-3 * extent;
    assert!(largest <= account.max_distance + slack, "{largest} {}", account.max_distance);
    // Local foot points may miss a nearer pass, never the other way round.
    assert!(account.max_distance <= largest + 0.02 * extent);
    let legs = if closed { points.len() } else { points.len() - 1 };
    let strayed = samples
        .iter()
        .map(|x| {
            (0..legs)
                .map(|j| from_segment(x, &points[j], &points[(j + 1) % points.len()]))
                .fold(f64::MAX, f64::min)
        })
        .fold(0.0, f64::max);
    assert!(strayed <= account.overshoot + slack, "{strayed} {}", account.overshoot);
}

fn flat(points: &[Vec<f64>]) -> Vec<f64> {
    points.concat()
}

fn wave(count: usize) -> Vec<Vec<f64>> {
    (0..count)
        .map(|i| {
            let s = i as f64 / (count - 1) as f64;
            vec![10.0 * s, (12.0 * s * s).sin() + 0.3 * (5.0 * s).cos(), 2.0 * s * s]
        })
        .collect()
}

fn circle(count: usize) -> Vec<Vec<f64>> {
    (0..count)
        .map(|i| {
            let angle = i as f64 / count as f64 * std::f64::consts::TAU;
            vec![3.0 * angle.cos(), 2.0 * angle.sin()]
        })
        .collect()
}

#[test]
fn a_tolerance_is_kept_and_smaller_ones_take_more_control_points() {
    let points = wave(120);
    let data = flat(&points);
    let view = PointsView::new(3, &data).unwrap();
    let mut last = 0;
    for tolerance in [0.3, 0.03, 0.003, 0.0003] {
        let fit = approximate_curve(view, &ApproximationOptions::within(tolerance)).unwrap();
        let account = fit.report.approximation.as_ref().unwrap();
        assert!(account.met && account.max_distance <= tolerance, "{tolerance}");
        assert!(account.is_calm() && fit.report.converged());
        check_figures(&points, &fit, false);
        let count = fit.curve.control_points().len();
        assert!(count >= last && count < 60, "{count}");
        last = count;
    }
}

#[test]
fn closed_curves_close_smoothly() {
    for repeated in [false, true] {
        let mut points = circle(90);
        if repeated {
            points.push(points[0].clone());
        }
        let data = flat(&points);
        let options = ApproximationOptions { closed: true, ..ApproximationOptions::within(1e-3) };
        let fit = approximate_curve(PointsView::new(2, &data).unwrap(), &options).unwrap();
        let account = fit.report.approximation.as_ref().unwrap();
        assert!(account.met && fit.curve.is_periodic());
        assert!(fit.curve.free_control_points() <= 12, "{}", fit.curve.free_control_points());
        points.truncate(90);
        check_figures(&points, &fit, true);
    }
}

#[test]
fn corners_are_met_and_stay_sharp() {
    // A rounded end and two right angles.
    let mut points: Vec<Vec<f64>> = (0..40).map(|i| vec![f64::from(i) * 0.1, 0.0]).collect();
    points.extend((0..30).map(|i| vec![4.0, f64::from(i) * 0.1]));
    points.extend((0..=40).map(|i| vec![4.0 - f64::from(i) * 0.1, 3.0]));
    let data = flat(&points);
    let view = PointsView::new(2, &data).unwrap();
    let fit = approximate_curve(view, &ApproximationOptions::within(1e-3)).unwrap();
    let account = fit.report.approximation.as_ref().unwrap();
    assert_eq!(account.corners, [40, 70]);
    assert!(account.met && fit.curve.control_points().len() == 10);
    for &corner in &account.corners {
        assert!(distance(fit.difference_vectors.point(corner), &[0.0, 0.0]) < 1e-12);
        let knots = fit.curve.knots().values();
        let t = fit.parameters[corner];
        assert_eq!(knots.iter().filter(|&&knot| knot == t).count(), 3);
    }
    let smooth =
        ApproximationOptions { corners: Corners::None, ..ApproximationOptions::within(1e-3) };
    let fit = approximate_curve(view, &smooth).unwrap();
    assert!(fit.report.approximation.as_ref().unwrap().corners.is_empty());
    check_figures(&points, &fit, false);
    // Closed, with the corners at its ends too.
    points.pop();
    points.extend((1..30).map(|i| vec![0.0, 3.0 - f64::from(i) * 0.1]));
    let data = flat(&points);
    let options = ApproximationOptions { closed: true, ..ApproximationOptions::within(1e-3) };
    let fit = approximate_curve(PointsView::new(2, &data).unwrap(), &options).unwrap();
    let account = fit.report.approximation.as_ref().unwrap();
    assert_eq!(account.corners.len(), 4);
    assert!(account.met);
    check_figures(&points, &fit, true);
}

#[test]
fn a_number_of_control_points_is_kept_and_more_come_closer() {
    let points = wave(100);
    let data = flat(&points);
    let mut last = f64::INFINITY;
    for count in [4, 8, 16, 32] {
        let options = ApproximationOptions::new(Goal::ControlPoints(count));
        let fit = approximate_curve(PointsView::new(3, &data).unwrap(), &options).unwrap();
        let account = fit.report.approximation.as_ref().unwrap();
        assert_eq!(fit.curve.control_points().len(), count);
        assert!(account.max_distance < 0.7 * last, "{count}: {}", account.max_distance);
        check_figures(&points, &fit, false);
        last = account.max_distance;
    }
}

#[test]
fn the_root_mean_square_is_kept() {
    let points = wave(100);
    let data = flat(&points);
    let options = ApproximationOptions::new(Goal::Rms(0.01));
    let fit = approximate_curve(PointsView::new(3, &data).unwrap(), &options).unwrap();
    let account = fit.report.approximation.as_ref().unwrap();
    assert!(account.met && account.rms_distance <= 0.01 && account.max_distance > 0.01);
}

/// One turn of a helix and noise of standard deviation 1e-3 in every coordinate.
fn noisy_helix(count: usize) -> Vec<[f64; 3]> {
    let mut random = generate::Random::new(11);
    (0..count)
        .map(|j| {
            let t = j as f64 / (count - 1) as f64;
            helix(t).map(|x| x + 1e-3 * random.normal())
        })
        .collect()
}

fn helix(t: f64) -> [f64; 3] {
    [(6.0 * t).cos(), (6.0 * t).sin(), t]
}

#[test]
fn noise_is_left_out_whether_its_size_is_given_or_not() {
    for (count, given) in [(200, Some(1e-3)), (800, None), (6000, None)] {
        let points = noisy_helix(count);
        let goal = Goal::Noise(given);
        let fit = approximate_curve(&points, &ApproximationOptions::new(goal)).unwrap();
        let account = fit.report.approximation.as_ref().unwrap();
        assert!(account.met, "{count} {given:?}: {account:?}");
        let noise = account.noise.unwrap();
        assert!((noise / 1e-3 - 1.0).abs() < 0.1, "{count}: {noise}");
        assert!(fit.curve.control_points().len() <= 20, "{count} {given:?}");
        // Closer to the curve behind the noise than the noise itself is.
        let mut square = 0.0;
        let samples = dense(&fit, 20);
        for i in 5..95 {
            let wanted = helix(f64::from(i) / 100.0);
            let off = samples
                .windows(2)
                .map(|pair| from_segment(&wanted, &pair[0], &pair[1]))
                .fold(f64::MAX, f64::min);
            assert!(off < 2e-3, "{count} {given:?} {i}: {off}");
            square += off * off / 90.0;
        }
        assert!(square.sqrt() < 0.8e-3, "{count} {given:?}: {square}");
    }
}

#[test]
fn outliers_are_found_left_out_and_named() {
    for (robust, goal) in
        [(Robust::Huber, Goal::Noise(Some(1e-3))), (Robust::Tukey, Goal::Tolerance(6e-3))]
    {
        let mut points = noisy_helix(1500);
        let moved = |j: &usize| j % 100 == 7;
        for j in (0..points.len()).filter(moved) {
            points[j][0] += 0.05;
            points[j][2] -= 0.05;
        }
        let options =
            ApproximationOptions { robust: Some(robust), ..ApproximationOptions::new(goal) };
        let fit = approximate_curve(&points, &options).unwrap();
        let account = fit.report.approximation.as_ref().unwrap();
        assert!(account.met && fit.curve.control_points().len() <= 20, "{account:?}");
        let kept = fit.kept_points.as_ref().unwrap();
        assert_eq!(kept.len() + account.outliers.len(), points.len());
        assert!((0..points.len()).filter(moved).all(|j| account.outliers.contains(&j)));
        assert!(account.outliers.len() <= 15 + 3, "{:?}", account.outliers);
    }
}

#[test]
fn a_feature_is_no_outlier() {
    // A bump of thirty points in a straight line.
    let points: Vec<[f64; 2]> = (0..300)
        .map(|j| {
            let x = f64::from(j);
            [x, 5.0 * (-((x - 150.0) / 8.0).powi(2)).exp()]
        })
        .collect();
    let options =
        ApproximationOptions { robust: Some(Robust::Tukey), ..ApproximationOptions::within(0.01) };
    let fit = approximate_curve(&points, &options).unwrap();
    let account = fit.report.approximation.as_ref().unwrap();
    assert!(account.met && account.outliers.is_empty(), "{account:?}");
}

#[test]
fn of_many_points_all_are_kept_though_few_are_looked_at() {
    // A kink between the points looked at first.
    let points: Vec<[f64; 2]> = (0..20_000)
        .map(|j| {
            let x = f64::from(j) / 20_000.0;
            let spike = if (12_345..12_350).contains(&j) { 0.02 } else { 0.0 };
            [x, (9.0 * x).sin() + spike]
        })
        .collect();
    let fit = approximate_curve(&points, &ApproximationOptions::within(1e-3)).unwrap();
    let account = fit.report.approximation.as_ref().unwrap();
    let samples = dense(&fit, 100);
    let met = |j: usize| {
        let near = samples.windows(2).map(|pair| from_segment(&points[j], &pair[0], &pair[1]));
        near.fold(f64::MAX, f64::min)
    };
    let every = (0..points.len()).step_by(97).chain(12_340..12_355);
    let largest = every.map(met).fold(0.0, f64::max);
    assert!(largest <= account.max_distance + 1e-5, "{largest} {}", account.max_distance);
    assert!(account.met && fit.curve.control_points().len() < 60, "{account:?}");
}

#[test]
fn bad_requests_are_named() {
    let points = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.0], [3.0, 1.0]];
    let run = |options| approximate_curve(&points, &options);
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = run(ApproximationOptions::within(tolerance));
        assert!(matches!(refused, Err(Error::OutOfRange { .. })), "{tolerance}");
    }
    for deviation in [0.0, -1.0, f64::NAN] {
        let refused = run(ApproximationOptions::new(Goal::Noise(Some(deviation))));
        assert!(matches!(refused, Err(Error::OutOfRange { .. })), "{deviation}");
    }
    let line: Vec<[f64; 2]> = (0..50).map(|j| [f64::from(j), 0.0]).collect();
    let none = approximate_curve(&line, &ApproximationOptions::new(Goal::Noise(None)));
    assert!(matches!(none, Err(Error::OutOfRange { .. })));
    let few = run(ApproximationOptions::new(Goal::ControlPoints(3)));
    assert!(matches!(few, Err(Error::WrongCount { .. })));
    let high = run(ApproximationOptions { degree: 4, ..ApproximationOptions::within(0.1) });
    assert!(matches!(high, Err(Error::TooFewPoints { .. })));
    let equal = approximate_curve(&[[1.0, 1.0]; 9], &ApproximationOptions::within(0.1));
    assert!(matches!(equal, Err(Error::AllPointsEqual { .. })));
    let hole = [[0.0, 0.0], [1.0, f64::NAN], [2.0, 0.0], [3.0, 1.0]];
    let nan = approximate_curve(&hole, &ApproximationOptions::within(0.1));
    assert!(matches!(nan, Err(Error::NotFinite { point: 1, .. })));
}

#[test]
fn an_observer_ends_the_search_with_the_best_so_far() {
    let points = wave(400);
    let data = flat(&points);
    let mut rounds = 0;
    let mut watch = |_: gimfit::iteration::Snapshot<'_>| {
        rounds += 1;
        if rounds == 5 { gimfit::iteration::Flow::Stop } else { gimfit::iteration::Flow::Continue }
    };
    let fit = gimfit::approximate_curve_observed(
        PointsView::new(3, &data).unwrap(),
        &ApproximationOptions::within(1e-9),
        &mut watch,
    )
    .unwrap();
    assert_eq!(fit.report.run.termination, Termination::Cancelled);
    assert!(!fit.report.approximation.unwrap().met);
}

/// Ordered points of any kind: walks, repeated points, huge and tiny, far away.
fn any_points() -> impl Strategy<Value = (usize, Vec<f64>)> {
    let step = prop_oneof![4 => -1.0..1.0, 1 => Just(0.0), 1 => -1e-9..1e-9, 1 => -1e6..1e6];
    (1_usize..4, 4_usize..40).prop_flat_map(move |(dimension, count)| {
        let steps = proptest::collection::vec(step.clone(), dimension * count);
        (
            steps,
            prop_oneof![Just(1.0), Just(1e300), Just(1e-300), Just(1e150)],
            prop_oneof![Just(0.0), Just(1e9)],
        )
            .prop_map(move |(steps, scale, origin)| {
                let mut place = vec![0.0; dimension];
                let points = steps
                    .chunks_exact(dimension)
                    .flat_map(|step| {
                        place.iter_mut().zip(step).for_each(|(x, s)| *x += s);
                        place.iter().map(|x| (origin + x) * scale * 1e-7).collect::<Vec<f64>>()
                    })
                    .collect();
                (dimension, points)
            })
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 30, ..ProptestConfig::default() })]

    #[test]
    fn hostile_points_neither_panic_nor_give_nan(
        (dimension, data) in any_points(),
        degree in 1_usize..6,
        closed: bool,
        share in 1e-6..0.5_f64,
        goal in 0..5,
        robust: bool,
    ) {
        let view = PointsView::new(dimension, &data).unwrap();
        let Ok(extent) = gimfit::points::Extent::of(view) else { return Ok(()) };
        let distance = (share * extent.diagonal()).max(1e-320);
        let goal = match goal {
            0 => Goal::Tolerance(distance),
            1 => Goal::Rms(distance),
            3 => Goal::Noise(None),
            4 => Goal::Noise(Some(distance)),
            _ => Goal::ControlPoints(degree + 1 + data.len() % 5),
        };
        let options = ApproximationOptions {
            degree,
            closed,
            rounds: Some(60),
            robust: robust.then_some(Robust::Huber),
            ..ApproximationOptions::new(goal)
        };
        if let Ok(fit) = approximate_curve(view, &options) {
            let account = fit.report.approximation.as_ref().unwrap();
            prop_assert!(account.max_distance.is_finite() && account.overshoot.is_finite());
            prop_assert!(account.rms_distance <= account.max_distance * (1.0 + 1e-12));
            if account.met && let Goal::Tolerance(tolerance) = options.goal {
                prop_assert!(account.max_distance <= tolerance);
            }
        }
    }
}

#[test]
fn ends_that_are_held_are_met() {
    for (count, goal) in [(200, Goal::Tolerance(0.05)), (60, Goal::ControlPoints(7))] {
        let points = wave(count);
        let flat = flat(&points);
        let view = PointsView::new(3, &flat).unwrap();
        let options = ApproximationOptions { hold_ends: true, ..ApproximationOptions::new(goal) };
        let fit = approximate_curve(view, &options).unwrap();
        assert!(fit.report.approximation.as_ref().unwrap().met);
        let samples = dense(&fit, 2);
        let ends = [(&samples[0], &points[0]), (&samples[samples.len() - 1], &points[count - 1])];
        for (end, point) in ends {
            assert!(distance(end, point) < 1e-13);
        }
        if count == 200 {
            let free = approximate_curve(view, &ApproximationOptions::new(goal)).unwrap();
            assert!(distance(&dense(&free, 2)[0], &points[0]) > 1e-6);
        }
        let closed = ApproximationOptions { closed: true, ..options };
        assert!(matches!(approximate_curve(view, &closed), Err(Error::Incompatible { .. })));
    }
}

#[test]
fn where_nothing_is_calm_the_distance_is_kept_with_no_more_control_points_than_points() {
    // An islet of four points, and a polygon whose points are all corners.
    let islet =
        [[180.0, -16.49045], [180.0, -16.53482], [179.98083, -16.53964], [180.0, -16.49045]];
    let star: Vec<[f64; 2]> = (0..24)
        .map(|i| {
            let (angle, radius) = (f64::from(i) * 0.26, f64::from(1 + i % 2));
            [radius * angle.cos(), radius * angle.sin()]
        })
        .collect();
    for (points, tolerance) in [(islet.to_vec(), 5e-5), (islet.to_vec(), 5e-6), (star, 1e-4)] {
        let fit = approximate_curve(&points, &ApproximationOptions::within(tolerance)).unwrap();
        let account = fit.report.approximation.as_ref().unwrap();
        assert!(account.met && account.max_distance <= tolerance);
        assert!(account.is_calm() || fit.curve.control_points().len() <= points.len());
        let rows: Vec<Vec<f64>> = points.iter().map(|p| p.to_vec()).collect();
        check_figures(&rows, &fit, false);
    }
}
