//! No input, however broken, panics, hangs or yields NaN; every refusal says why.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::{
    Convexity, CurveOptions, Duplicates, Error, GridView, IterationWeight, KnotPlacement, Method,
    Parameterization, PointsView, SurfaceOptions, fit_curve, fit_surface,
};
use proptest::prelude::*;

fn any_coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        10 => -10.0..10.0,
        2 => prop::sample::select(vec![0.0, -0.0, 1.0, 1e9, 1e9 + 1e-3, -1e9]),
        1 => prop::num::f64::ANY,
        1 => prop::sample::select(vec![1e-300, 1e300, 5e-324, f64::MAX, f64::MIN_POSITIVE]),
    ]
}

fn any_options() -> impl Strategy<Value = CurveOptions> {
    let parameterization = prop_oneof![
        Just(None),
        Just(Some(Parameterization::Chord)),
        Just(Some(Parameterization::Centripetal)),
        Just(Some(Parameterization::Uniform)),
        Just(Some(Parameterization::ChordRatio)),
        prop::collection::vec(prop::num::f64::ANY, 0..12)
            .prop_map(|list| Some(Parameterization::Given(list))),
        prop::collection::vec(-5.0..5.0, 0..12).prop_map(|mut list: Vec<f64>| {
            list.sort_by(f64::total_cmp);
            Some(Parameterization::Given(list))
        }),
    ];
    let knots = prop_oneof![
        3 => Just(None),
        1 => Just(Some(KnotPlacement::Averaged)),
        1 => Just(Some(KnotPlacement::NotAKnot)),
        1 => Just(Some(KnotPlacement::AtData)),
        1 => Just(Some(KnotPlacement::Uniform)),
        1 => prop::collection::vec(-1.0..2.0, 0..30).prop_map(|mut list: Vec<f64>| {
            list.sort_by(f64::total_cmp);
            Some(KnotPlacement::Given(list))
        }),
    ];
    let method = prop::sample::select(vec![
        Method::Auto,
        Method::Pia,
        Method::Weighted,
        Method::Jacobi,
        Method::GaussSeidel,
        Method::Sor,
        Method::Chebyshev,
        Method::Anderson { memory: None },
        Method::Preconditioned { half_bandwidth: None },
        Method::Preconditioned { half_bandwidth: Some(1) },
        Method::Local,
        Method::Adaptive,
        Method::Geometric { global_start: false },
    ]);
    let local = prop_oneof![
        3 => Just(None),
        2 => prop::collection::vec(0_usize..12, 0..6).prop_map(Some),
    ];
    let weight = prop_oneof![
        4 => Just(IterationWeight::Auto),
        1 => prop::num::f64::ANY.prop_map(IterationWeight::Same),
        1 => (0.0..2.0).prop_map(IterationWeight::Same),
        1 => prop::collection::vec(0.1..1.9, 0..12).prop_map(IterationWeight::PerPoint),
    ];
    let convexity = prop_oneof![
        4 => Just(None),
        2 => Just(Some(Convexity::Closest)),
        1 => Just(Some(Convexity::Published { threshold: None })),
        1 => prop::num::f64::ANY
            .prop_map(|length| Some(Convexity::Published { threshold: Some(length) })),
    ];
    let residual = prop_oneof![
        4 => Just(None),
        1 => Just(Some(0.0)),
        1 => prop::num::f64::ANY.prop_map(Some),
        1 => (1e-20..1.0).prop_map(Some),
    ];
    let duplicates =
        prop::sample::select(vec![Duplicates::Error, Duplicates::Drop, Duplicates::Merge]);
    // As many as the most points there can be; the tests leave out those that are too many.
    let most = 147;
    let weight_of_a_rational_curve = prop_oneof![
        30 => 0.1..10.0,
        2 => prop::sample::select(vec![1e-300, 1e300, 1e-12, 1e12, f64::MIN_POSITIVE]),
    ];
    let rational_weights = prop_oneof![
        4 => Just(None),
        2 => prop::collection::vec(weight_of_a_rational_curve, most).prop_map(Some),
        1 => prop::collection::vec(any_coordinate(), 0..most).prop_map(Some),
    ];
    let least_eigenvalue = prop_oneof![
        4 => Just(None),
        2 => (1e-12..1.0).prop_map(Some),
        1 => any::<f64>().prop_map(Some),
    ];
    (
        (0_usize..12, any::<bool>(), parameterization, knots, (convexity, rational_weights)),
        (method, weight, 0_usize..60, residual),
        (duplicates, prop::collection::vec(0_usize..40, 0..4), local, least_eigenvalue),
    )
        .prop_map(|(curve, iteration, rest)| CurveOptions {
            local: rest.2,
            degree: curve.0,
            closed: curve.1,
            parameterization: curve.2,
            knot_placement: curve.3,
            convexity: curve.4.0,
            rational_weights: curve.4.1,
            method: iteration.0,
            weight: iteration.1,
            least_eigenvalue: rest.3,
            iterations: iteration.2,
            residual: iteration.3,
            duplicates: rest.0,
            keep: rest.1,
        })
}

/// Leaves out weights beyond the number of points.
fn fit_count(weights: Option<Vec<f64>>, points: usize) -> Option<Vec<f64>> {
    weights.map(|mut weights| {
        weights.truncate(points);
        weights
    })
}

/// Fits and looks for what must never be found.
fn check(dimension: usize, coordinates: &[f64], options: &CurveOptions) {
    let view = PointsView::new(dimension, coordinates).unwrap();
    match fit_curve(view, options) {
        Err(error) => assert!(error.to_string().len() > 20, "{error}"),
        Ok(fit) => {
            let finite = |list: &[f64]| list.iter().all(|x| x.is_finite());
            assert!(finite(fit.curve.control_points().coordinates()));
            assert!(finite(&fit.parameters));
            assert!(finite(fit.difference_vectors.coordinates()));
            let report = &fit.report;
            assert!(finite(&[
                report.run.max_residual,
                report.run.rms_residual,
                report.max_deviation,
                report.run.extent,
                report.run.residual_target
            ]));
            // The deviation is that of all points, the residual that of those chosen.
            let outside = report.run.local.as_ref().map_or(0.0, |local| local.outside_max_residual);
            assert!(outside.is_finite());
            assert!(report.max_deviation <= report.run.max_residual.max(outside));
            assert!(report.run.iterations <= options.iterations);
            let (start, end) = fit.curve.domain();
            assert!(fit.parameters.iter().all(|t| (start..=end).contains(t)));
            for t in fit.curve.equal_steps(7) {
                assert!(finite(&fit.curve.evaluate(t).unwrap()));
            }
        }
    }
}

/// Fits a surface and looks for what must never be found.
fn check_surface(
    shape: [usize; 2],
    dimension: usize,
    coordinates: &[f64],
    options: &SurfaceOptions,
) {
    let view = GridView::new(shape, dimension, coordinates).unwrap();
    match fit_surface(view, options) {
        Err(error) => assert!(error.to_string().len() > 20, "{error}"),
        Ok(fit) => {
            let finite = |list: &[f64]| list.iter().all(|x| x.is_finite());
            assert!(finite(fit.surface.control_net().points().coordinates()));
            assert!(finite(&fit.parameters[0]) && finite(&fit.parameters[1]));
            let [(u_0, u_1), (v_0, v_1)] = fit.surface.domain();
            for [u, v] in fit.foot_parameters.iter().flatten() {
                assert!((u_0..=u_1).contains(u) && (v_0..=v_1).contains(v));
            }
            assert!(finite(fit.difference_vectors.coordinates()));
            let report = &fit.report;
            assert!(finite(&[
                report.run.max_residual,
                report.run.rms_residual,
                report.max_deviation
            ]));
            let outside = report.run.local.as_ref().map_or(0.0, |local| local.outside_max_residual);
            assert!(report.max_deviation <= report.run.max_residual.max(outside));
            for (u, v) in fit.surface.knots()[0]
                .equal_steps(4)
                .into_iter()
                .zip(fit.surface.knots()[1].equal_steps(4))
            {
                assert!(finite(&fit.surface.evaluate(u, v).unwrap()));
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, ..ProptestConfig::default() })]

    #[test]
    fn any_points_and_options_end_in_a_fit_or_a_reason(
        dimension in 1_usize..5,
        coordinates in prop::collection::vec(any_coordinate(), 0..60),
        options in any_options(),
    ) {
        let points = coordinates.len() / dimension;
        let rational_weights = fit_count(options.rational_weights.clone(), points);
        let options = CurveOptions { rational_weights, ..options };
        check(dimension, &coordinates[..points * dimension], &options);
    }

    #[test]
    fn any_grid_and_options_end_in_a_fit_or_a_reason(
        rows in 0_usize..8,
        columns in 0_usize..8,
        dimension in 1_usize..4,
        coordinates in prop::collection::vec(any_coordinate(), 147),
        choices in (any_options(), any_options()),
        per_direction in any::<bool>(),
        windows in prop::collection::vec((0_usize..8, 0_usize..4, 0_usize..8, 0_usize..4), 0..3),
        chosen in prop::bool::weighted(0.3),
    ) {
        let (u, v) = choices;
        let window = |(i, m, j, n): (usize, usize, usize, usize)| [i..i + m, j..j + n];
        let local = chosen.then(|| windows.into_iter().map(window).collect());
        let options = SurfaceOptions {
            degrees: [u.degree, v.degree],
            closed: [u.closed, v.closed],
            parameterizations: [u.parameterization, v.parameterization],
            knot_placements: [u.knot_placement, v.knot_placement],
            rational_weights: fit_count(u.rational_weights, rows * columns),
            method: u.method,
            weight: u.weight.into(),
            least_eigenvalue: u.least_eigenvalue,
            local,
            per_direction,
            iterations: u.iterations,
            residual: u.residual,
            keep: v.keep,
        };
        let length = rows * columns * dimension;
        check_surface([rows, columns], dimension, &coordinates[..length], &options);
    }

    #[test]
    fn points_that_are_plain_are_fitted(
        dimension in 1_usize..5,
        coordinates in prop::collection::vec(-10.0..10.0, 24..200),
        degree in 1_usize..6,
        closed in any::<bool>(),
    ) {
        let whole = coordinates.len() / dimension * dimension;
        let view = PointsView::new(dimension, &coordinates[..whole]).unwrap();
        let parameterization = (dimension == 1).then_some(Parameterization::Uniform);
        let options = CurveOptions { degree, closed, parameterization, ..Default::default() };
        let fit = fit_curve(view, &options).unwrap();
        prop_assert!(fit.report.converged(), "{:?}", fit.report);
        check(dimension, &coordinates[..whole], &options);
    }
}

#[test]
fn refusals_name_what_is_at_fault() {
    let fit = |points: &[[f64; 2]], options: &CurveOptions| fit_curve(points, options).unwrap_err();
    let plain = CurveOptions::default();
    let walk = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.0], [3.0, 1.0], [4.0, 0.0]];

    assert_eq!(fit(&[], &plain), Error::NoPoints { needed: 4 });
    assert_eq!(fit(&walk[..3], &plain), Error::TooFewPoints { points: 3, degree: 3, needed: 4 });
    assert_eq!(fit(&[[1.0, 2.0]; 6], &plain), Error::AllPointsEqual { points: 6 });

    let mut broken = walk;
    broken[3][1] = f64::NAN;
    assert!(matches!(fit(&broken, &plain), Error::NotFinite { point: 3, coordinate: 1, .. }));
    broken[3][1] = f64::NEG_INFINITY;
    assert!(matches!(fit(&broken, &plain), Error::NotFinite { point: 3, coordinate: 1, .. }));
    broken[3] = broken[2];
    assert_eq!(fit(&broken, &plain), Error::RepeatedPoints { first: 2, second: 3, others: 0 });
    broken[3] = [1e308, -1e308];
    broken[2] = [-1e308, 1e308];
    assert!(matches!(fit(&broken, &plain), Error::ExtentOverflow { .. }));

    let close = [[1e9, 0.0], [0.0, 0.0], [1e-8, 0.0], [0.0, 1e9], [1.0, 1.0]];
    assert_eq!(fit(&close, &plain), Error::ParametersCollide { first: 1, second: 2 });

    let option = |change: fn(&mut CurveOptions)| {
        let mut options = CurveOptions::default();
        change(&mut options);
        fit(&walk, &options)
    };
    assert!(matches!(option(|o| o.degree = 0), Error::OutOfRange { .. }));
    assert!(matches!(option(|o| o.residual = Some(-1.0)), Error::OutOfRange { .. }));
    assert!(matches!(
        option(
            |o| o.parameterization = Some(Parameterization::Given(vec![0.0, 1.0, 1.0, 2.0, 3.0]))
        ),
        Error::RepeatedPoints { first: 1, second: 2, .. }
    ));
    assert!(matches!(
        option(
            |o| o.parameterization = Some(Parameterization::Given(vec![0.0, 2.0, 1.0, 3.0, 4.0]))
        ),
        Error::ParametersNotIncreasing { index: 2, .. }
    ));
    assert!(matches!(
        option(|o| {
            o.knot_placement =
                Some(KnotPlacement::Given(vec![0.0, 0.0, 0.9, 0.95, 0.97, 1.0, 1.0]));
            o.degree = 1;
            o.parameterization = Some(Parameterization::Given(vec![0.0, 0.1, 0.2, 0.3, 1.0]));
        }),
        Error::SchoenbergWhitney { point: 2, .. }
    ));
    assert!(matches!(
        option(|o| {
            o.degree = 2;
            o.knot_placement = Some(KnotPlacement::NotAKnot);
        }),
        Error::Incompatible { .. }
    ));
    assert!(matches!(
        option(|o| {
            o.closed = true;
            o.knot_placement = Some(KnotPlacement::NotAKnot);
        }),
        Error::Incompatible { .. }
    ));
}
