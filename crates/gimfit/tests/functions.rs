//! Laws of approximation over an abscissa: distances are those of the values at the same place, and a
//! textbook evaluation that shares no code finds the same.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::{
    ApproximationOptions, Corners, CurveFit, Error, Goal, PointsView, Robust, approximate_curve,
};
use gimfit_testkit::generate::Random;
use gimfit_testkit::textbook;

fn at(fit: &CurveFit, t: f64) -> Vec<f64> {
    let control: Vec<Vec<f64>> = fit.curve.control_points().iter().map(<[f64]>::to_vec).collect();
    textbook::curve_point(fit.curve.knots().values(), fit.curve.degree(), &control, t)
}

fn over(abscissae: &[f64], options: ApproximationOptions) -> ApproximationOptions {
    ApproximationOptions { abscissae: Some(abscissae.to_vec()), ..options }
}

/// Compares the figures of the report with values at the abscissae and between them.
fn check_figures(abscissae: &[f64], values: &[f64], fit: &CurveFit) {
    let account = fit.report.approximation.as_ref().unwrap();
    let off: Vec<f64> =
        abscissae.iter().zip(values).map(|(&x, y)| (at(fit, x)[0] - y).abs()).collect();
    let largest = off.iter().copied().fold(0.0, f64::max);
    let rms = (off.iter().map(|d| d * d).sum::<f64>() / off.len() as f64).sqrt();
    let slack = 1e-12 * (1.0 + largest);
    assert!((account.max_distance - largest).abs() < slack);
    assert!((account.rms_distance - rms).abs() < slack);
    assert!((off[account.worst[0]] - largest).abs() < slack);
    let mut strayed: f64 = 0.0;
    for j in 1..abscissae.len() {
        let (a, b) = (abscissae[j - 1], abscissae[j]);
        for i in 0..=20 {
            let share = f64::from(i) / 20.0;
            let straight = values[j - 1] + share * (values[j] - values[j - 1]);
            if b > a {
                strayed = strayed.max((at(fit, a + share * (b - a))[0] - straight).abs());
            }
        }
    }
    // It looks at other places between the points.
    let tolerance = 0.1 * account.overshoot + slack;
    assert!(strayed <= account.overshoot + tolerance, "{strayed} {}", account.overshoot);
    if abscissae.windows(2).all(|x| x[0] < x[1]) {
        assert!(account.overshoot <= strayed + tolerance, "{strayed} {}", account.overshoot);
    }
    assert_eq!(fit.parameters, abscissae);
    let (start, end) = fit.curve.domain();
    assert_eq!((start, end), (abscissae[0], abscissae[abscissae.len() - 1]));
}

#[test]
fn values_keep_within_the_distance_at_their_abscissae() {
    // Steep where a distance in the plane would be far smaller than that of the values.
    let abscissae: Vec<f64> = (0..300).map(|i| 1e5 + f64::from(i) * 0.01).collect();
    let values: Vec<f64> = abscissae.iter().map(|x| (20.0 * (x - 1e5 - 1.5)).tanh()).collect();
    let view = PointsView::new(1, &values).unwrap();
    for (tolerance, most) in [(0.1, 14), (0.01, 22), (1e-4, 60)] {
        let options = over(&abscissae, ApproximationOptions::within(tolerance));
        let fit = approximate_curve(view, &options).unwrap();
        let account = fit.report.approximation.as_ref().unwrap();
        assert!(account.met && account.max_distance <= tolerance);
        assert!(account.is_calm());
        let count = fit.curve.control_points().len();
        assert!(count <= most, "{tolerance}: {count}");
        check_figures(&abscissae, &values, &fit);
    }
}

#[test]
fn repeated_and_uneven_abscissae_are_fitted() {
    let mut abscissae: Vec<f64> = (0..80).map(|i| f64::from(i / 2).powi(2)).collect();
    abscissae.extend([2000.0, 2000.0, 4000.0]);
    let values: Vec<f64> =
        abscissae.iter().enumerate().map(|(j, x)| x.sqrt() + 0.1 * (j % 2) as f64).collect();
    let view = PointsView::new(1, &values).unwrap();
    let fit =
        approximate_curve(view, &over(&abscissae, ApproximationOptions::within(0.5))).unwrap();
    assert!(fit.report.approximation.as_ref().unwrap().met);
    check_figures(&abscissae, &values, &fit);
    // Two values at one abscissa lie 0.1 apart: nothing comes closer than half of that.
    let close =
        approximate_curve(view, &over(&abscissae, ApproximationOptions::within(0.04))).unwrap();
    assert!(
        close.report.run.choices.iter().any(|line| line.contains("points 0 and 1 are 1.000e-1"))
    );
    let account = close.report.approximation.unwrap();
    assert!(!account.met && account.max_distance >= 0.05 - 1e-12);
}

#[test]
fn noise_of_a_signal_is_found_and_left_out() {
    let mut random = Random::new(7);
    let abscissae: Vec<f64> = (0..2000).map(|i| f64::from(i) / 100.0).collect();
    let mut values: Vec<f64> = abscissae.iter().map(|x| x.sin() + 0.05 * random.normal()).collect();
    let view = PointsView::new(1, &values).unwrap();
    let fit =
        approximate_curve(view, &over(&abscissae, ApproximationOptions::new(Goal::Noise(None))))
            .unwrap();
    let account = fit.report.approximation.as_ref().unwrap();
    let noise = account.noise.unwrap();
    assert!((noise / 0.05 - 1.0).abs() < 0.1, "{noise}");
    assert!(fit.curve.control_points().len() < 25);
    let off = abscissae.iter().map(|&x| (at(&fit, x)[0] - x.sin()).abs()).fold(0.0, f64::max);
    assert!(off < 0.04, "{off}");
    // Two that are wild are left out, and named.
    (values[500], values[1200]) = (9.0, -7.0);
    let view = PointsView::new(1, &values).unwrap();
    let options = ApproximationOptions {
        robust: Some(Robust::Tukey),
        ..ApproximationOptions::new(Goal::Noise(Some(0.05)))
    };
    let fit = approximate_curve(view, &over(&abscissae, options)).unwrap();
    assert_eq!(fit.report.approximation.unwrap().outliers, [500, 1200]);
}

#[test]
fn values_of_one_dimension_stay_at_their_numbers() {
    let values: Vec<f64> = (0..150).map(|i| (f64::from(i) / 10.0).sin()).collect();
    let view = PointsView::new(1, &values).unwrap();
    let fit = approximate_curve(view, &ApproximationOptions::within(0.02)).unwrap();
    let abscissae: Vec<f64> = (0..150).map(|i| f64::from(i) / 149.0).collect();
    check_figures(&abscissae, &values, &fit);
    assert!(fit.report.approximation.unwrap().met);
    let round: Vec<f64> =
        (0..150).map(|i| (f64::from(i) / 150.0 * std::f64::consts::TAU).sin()).collect();
    let view = PointsView::new(1, &round).unwrap();
    let options = ApproximationOptions { closed: true, ..ApproximationOptions::within(0.01) };
    let fit = approximate_curve(view, &options).unwrap();
    assert!(fit.curve.is_periodic());
    for (j, y) in round.iter().enumerate() {
        let t = (fit.parameters[j], y);
        assert!((at(&fit, t.0)[0] - y).abs() <= 0.01);
    }
}

#[test]
fn many_rough_values_are_met_too() {
    let mut random = Random::new(3);
    let values: Vec<f64> = (0..6000)
        .map(|i| {
            let beat = f64::from(i % 200) / 200.0;
            (-((beat - 0.5) / 0.02).powi(2)).exp() + 0.01 * random.signed()
        })
        .collect();
    let view = PointsView::new(1, &values).unwrap();
    let fit = approximate_curve(view, &ApproximationOptions::within(0.05)).unwrap();
    let account = fit.report.approximation.as_ref().unwrap();
    assert!(account.met, "{account:?}");
    assert!(fit.curve.control_points().len() < 1000);
    for (&t, y) in fit.parameters.iter().zip(&values).step_by(7) {
        assert!((at(&fit, t)[0] - y).abs() <= 0.05);
    }
}

#[test]
fn constants_scales_and_several_coordinates_make_no_difference() {
    let abscissae: Vec<f64> = (0..40).map(f64::from).collect();
    let constant = vec![2.5; 40];
    let view = PointsView::new(1, &constant).unwrap();
    for goal in [Goal::Tolerance(1e-3), Goal::ControlPoints(4)] {
        let fit =
            approximate_curve(view, &over(&abscissae, ApproximationOptions::new(goal))).unwrap();
        assert_eq!(fit.curve.control_points().len(), 4);
        assert!(fit.curve.control_points().coordinates().iter().all(|y| (y - 2.5).abs() < 1e-9));
    }
    let count = |scale: f64, stretch: f64| {
        let values: Vec<f64> =
            abscissae.iter().flat_map(|x| [scale * x.sin(), scale * (0.3 * x).cos()]).collect();
        let stretched: Vec<f64> = abscissae.iter().map(|x| stretch * x).collect();
        let view = PointsView::new(2, &values).unwrap();
        let options = over(&stretched, ApproximationOptions::within(0.05 * scale));
        let fit = approximate_curve(view, &options).unwrap();
        assert!(fit.report.approximation.unwrap().met);
        fit.curve.control_points().len()
    };
    let usual = count(1.0, 1.0);
    for (scale, stretch) in [(2.0_f64.powi(-900), 1.0), (2.0_f64.powi(900), 1.0), (1.0, 1e-9)] {
        assert_eq!(count(scale, stretch), usual);
    }
}

#[test]
fn what_is_wrong_with_abscissae_is_said() {
    let values: Vec<f64> = (0..10).map(f64::from).collect();
    let view = PointsView::new(1, &values).unwrap();
    let run = |abscissae: &[f64], options: ApproximationOptions| {
        approximate_curve(view, &over(abscissae, options)).unwrap_err()
    };
    let within = || ApproximationOptions::within(0.1);
    assert!(matches!(run(&values[..9], within()), Error::WrongCount { given: 9, .. }));
    let mut falling = values.clone();
    falling[4] = 2.5;
    let error = run(&falling, within());
    assert!(matches!(error, Error::ParametersNotIncreasing { index: 4, .. }), "{error}");
    falling[4] = f64::NAN;
    assert!(matches!(run(&falling, within()), Error::OutOfRange { .. }));
    assert!(matches!(run(&[1.0; 10], within()), Error::OutOfRange { .. }));
    let huge: Vec<f64> = (0..10).map(|i| f64::from(i - 5) * 3e307).collect();
    assert!(matches!(run(&huge, within()), Error::OutOfRange { .. }));
    let closed = ApproximationOptions { closed: true, ..within() };
    assert!(matches!(run(&values, closed), Error::Incompatible { .. }));
    let corners = ApproximationOptions { corners: Corners::Angle(30.0), ..within() };
    assert!(matches!(run(&values, corners), Error::Incompatible { .. }));
    let few = PointsView::new(1, &values[..3]).unwrap();
    let options = over(&values[..3], within());
    assert!(matches!(approximate_curve(few, &options), Err(Error::TooFewPoints { .. })));
    // So close together that knots fall together: an error or a fit, no panic.
    let near: Vec<f64> = (0..10).map(|i| 1e16 + 2.0 * f64::from(i / 5)).collect();
    let _ = approximate_curve(view, &over(&near, within()));
}
