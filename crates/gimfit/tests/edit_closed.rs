//! Laws of closed curves that are edited point by point.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::fit::interpolate;
use gimfit::knots::place_knots;
use gimfit::parameters::Parameters;
use gimfit::{
    CurveFit, CurveOptions, EditReport, EditableCurve, Error, KnotPlacement, Parameterization,
    Points, fit_curve,
};
use gimfit_testkit::generate::Random;
use gimfit_testkit::{dense, textbook};
use std::f64::consts::TAU;

fn options(degree: usize) -> CurveOptions {
    CurveOptions { degree, closed: true, ..Default::default() }
}

/// A bumpy loop whose steps vary by a factor of up to `grading`.
fn a_loop(seed: u64, count: usize, dimension: usize, grading: f64) -> Points {
    let mut random = Random::new(seed);
    let steps: Vec<f64> = (0..count).map(|_| grading.powf(random.unit())).collect();
    let whole: f64 = steps.iter().sum();
    let mut angle = 0.0;
    let mut coordinates = Vec::new();
    for step in steps {
        let r = count as f64 * (1.0 + 0.1 * random.signed() / count as f64);
        let point = [r * f64::cos(angle), r * f64::sin(angle), random.signed()];
        coordinates.extend_from_slice(&point[..dimension]);
        angle += TAU * step / whole;
    }
    Points::new(dimension, coordinates).unwrap()
}

/// A random edit near its neighbours; every third next to the seam.
fn edit(curve: &mut EditableCurve, random: &mut Random) -> EditReport {
    let count = curve.len();
    let at = match (random.unit() * 3.0) as usize {
        0 => (count - 2 + (random.unit() * 4.0) as usize) % count,
        _ => (random.unit() * count as f64) as usize,
    };
    let (here, next) = (curve.point(at), curve.point((at + 1) % count));
    let share = 0.2 + 0.6 * random.unit();
    let mut between: Vec<f64> = here.iter().zip(&next).map(|(a, b)| a + share * (b - a)).collect();
    between.iter_mut().for_each(|x| *x += 0.1 * random.signed());
    match (random.unit() * 4.0) as usize {
        0 if count > curve.degree() + 1 => curve.remove_point(at).unwrap(),
        1 => curve.insert_point(at + 1, &between).unwrap(),
        // The gap across the seam, from its other end.
        2 if at + 1 == count => curve.insert_point(0, &between).unwrap(),
        _ => curve.move_point(at, &between).unwrap(),
    }
}

/// Control points in the order of the data points.
fn control_points(fit: &CurveFit) -> dense::Rows {
    let (count, half) = (fit.report.points, fit.curve.degree() / 2);
    (0..count).map(|j| fit.curve.control_points().point((j + half) % count).to_vec()).collect()
}

fn farthest(ours: &dense::Rows, theirs: &dense::Rows) -> f64 {
    let gap = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0, |s: f64, (a, b)| s.hypot(a - b));
    ours.iter().zip(theirs).map(|(a, b)| gap(a, b)).fold(0.0, f64::max)
}

/// The textbook's matrix of the closed curve, its control points by dense elimination, and the maximum
/// norm of the inverse.
fn refit(curve: &EditableCurve) -> (dense::Rows, f64) {
    let t = curve.parameters();
    let matrix = textbook::closed_collocation_matrix(curve.degree(), &t, 1.0);
    let data: dense::Rows = (0..curve.len()).map(|j| curve.point(j)).collect();
    let unit = |j: usize| (0..t.len()).map(|i| f64::from(u8::from(i == j))).collect();
    let inverse = dense::solve(&matrix, &(0..t.len()).map(unit).collect());
    let sums = inverse.iter().map(|row| row.iter().map(|x| x.abs()).sum::<f64>());
    (dense::solve(&matrix, &data), sums.fold(0.0, f64::max))
}

#[test]
fn edits_stay_within_the_bound_of_the_fit_of_all_points() {
    // From windows that would meet themselves to some that do not, with odd and even counts.
    for (degree, count) in [(1, 41), (2, 8), (2, 63), (3, 4), (3, 80), (4, 33), (5, 121), (7, 20)] {
        for grading in [1.2, 4.0] {
            let data = a_loop(degree as u64, count, 2, grading);
            let mut random = Random::new(degree as u64);
            let mut curve = EditableCurve::new(&data, &options(degree)).unwrap();
            let mut touched = usize::MAX;
            for step in 0..24 {
                let report = edit(&mut curve, &mut random);
                touched = touched.min(report.control_points_touched);
                assert_eq!(report.bound, curve.bound());
                if step % 12 != 11 {
                    continue;
                }
                let (control, norm) = refit(&curve);
                let fit = curve.fit().unwrap();
                let off = farthest(&control_points(&fit), &control);
                // Elimination rounds, too.
                let largest = control.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
                let theirs = 1e-14 * norm * largest;
                let case = format!("{degree} {count} {grading}");
                assert!(off <= report.bound + theirs, "{case}: {off:e} {report:?}");
                // The bound holds what it should, and not much else.
                let least = norm * fit.report.run.max_residual * (1.0 - 1e-5);
                assert!(report.bound >= least, "{case}: {least:e} {report:?}");
                let extent = fit.report.run.extent;
                let most = 2.0 * norm * (2e-12 * extent + 1e-13 * largest);
                assert!(report.bound <= most, "{case}: {most:e} {report:?}");
            }
            assert!(touched < count || count < 40 || grading > 2.0, "{degree} {count}: {touched}");
        }
    }
}

#[test]
fn long_loops_agree_with_a_refit_and_move_only_what_is_near() {
    for (degree, count, most) in [(1, 500, 60), (2, 501, 80), (3, 500, 100), (6, 501, 250)] {
        let mut random = Random::new(degree as u64);
        let mut curve = EditableCurve::new(&a_loop(4, count, 3, 1.5), &options(degree)).unwrap();
        let mut across = 0;
        for _ in 0..20 {
            let before = curve.fit().unwrap();
            let report = edit(&mut curve, &mut random);
            let after = curve.fit().unwrap();
            assert!(report.control_points_touched <= most, "{degree}: {report:?}");
            let (old, new) = (control_points(&before), control_points(&after));
            across += usize::from(report.window.end > new.len());
            // All but the window is as it was, but for its place.
            let rest = new.len() - report.window.len();
            let turn = |rows: &dense::Rows, start: usize| -> dense::Rows {
                (0..rest).map(|k| rows[(start + k) % rows.len()].clone()).collect()
            };
            let end = report.window.end;
            let shift = old.len() + 2 - new.len();
            let stays = (0..3).any(|k| {
                turn(&old, (end + k + shift + old.len() - 3) % old.len()) == turn(&new, end)
            });
            assert!(stays, "{degree} {report:?}");
        }
        assert!(across > 0);
        let parameters = Parameters::closed(curve.parameters(), 1.0).unwrap();
        let knots = place_knots(degree, &parameters, &KnotPlacement::Averaged).unwrap();
        let points = curve.points().unwrap();
        let whole = interpolate(&points, parameters, knots, &options(degree)).unwrap();
        let ours = curve.fit().unwrap();
        let slack = 4.0 * f64::EPSILON;
        let pairs = ours.curve.knots().values().iter().zip(whole.curve.knots().values());
        assert!(pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) <= slack);
        let gap = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0, |s: f64, (a, b)| s.hypot(a - b));
        let off = ours.curve.control_points().iter().zip(whole.curve.control_points().iter());
        let off = off.map(|(a, b)| gap(a, b)).fold(0.0, f64::max);
        assert!(off <= 2.0 * curve.bound(), "{degree}: {off:e} {:e}", curve.bound());
        assert!(ours.report.converged() && ours.report.closed);
        assert!(off <= 1e-9 * ours.report.run.extent, "{degree}: {off:e}");
    }
}

#[test]
fn a_loop_edited_back_is_the_old_loop() {
    for degree in [1, 2, 3, 5] {
        let mut curve = EditableCurve::new(&a_loop(6, 401, 2, 1.5), &options(degree)).unwrap();
        let before = curve.fit().unwrap();
        for at in [0, 3, 200, 400] {
            let (old, t) = (curve.point(at), curve.parameters()[at]);
            curve.move_point(at, &[old[0] + 3.0, old[1] - 2.0]).unwrap();
            curve.move_point(at, &old).unwrap();
            curve.remove_point(at).unwrap();
            curve.insert_point_at(at, t, &old).unwrap();
        }
        let after = curve.fit().unwrap();
        let off = farthest(&control_points(&before), &control_points(&after));
        assert!(off <= 2.0 * curve.bound(), "{degree}: {off:e} {:e}", curve.bound());
        assert!(curve.bound() <= 1e-7, "{degree} {:e}", curve.bound());
    }
}

#[test]
fn points_of_the_loop_are_found_from_nearby() {
    let mut random = Random::new(8);
    for (degree, count) in [(1, 3), (2, 3), (3, 4), (3, 700), (6, 701)] {
        let mut curve = EditableCurve::new(&a_loop(9, count, 2, 2.0), &options(degree)).unwrap();
        for _ in 0..12 {
            edit(&mut curve, &mut random);
        }
        let whole = curve.fit().unwrap();
        let (start, end) = curve.domain();
        assert_eq!(whole.curve.domain(), (start, end));
        let mut parameters = whole.parameters.clone();
        parameters.extend([start, end]);
        parameters.extend((0..200).map(|_| start + (end - start) * random.unit()));
        for t in parameters {
            let (ours, theirs) = (curve.evaluate(t).unwrap(), whole.curve.evaluate(t).unwrap());
            let off = (ours[0] - theirs[0]).hypot(ours[1] - theirs[1]);
            assert!(off <= 2e-13 * whole.report.run.extent, "{degree} {t}: {off:e}");
        }
        assert!(matches!(curve.evaluate(end + 1.0), Err(Error::OutsideDomain { .. })));
        assert!(matches!(curve.evaluate(f64::NAN), Err(Error::OutsideDomain { .. })));
    }
}

#[test]
fn both_ends_of_the_gap_across_the_seam_take_a_point() {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mut curve = EditableCurve::new(&square, &options(2)).unwrap();
    curve.insert_point(4, &[0.0, 0.75]).unwrap();
    assert_eq!(curve.parameters(), [0.0, 0.25, 0.5, 0.75, 0.8125]);
    curve.insert_point(0, &[0.0, 0.25]).unwrap();
    assert!((curve.parameters()[0] + 0.0625).abs() < 1e-15);
    assert_eq!(curve.point(0), [0.0, 0.25]);
    curve.remove_point(1).unwrap();
    assert_eq!(curve.point(1), [1.0, 0.0]);
    assert!(curve.fit().unwrap().report.converged());
    // Neighbours across the seam are neighbours.
    let met = curve.move_point(0, &[0.0, 0.75]).unwrap_err();
    assert_eq!(met, Error::MeetsNeighbour { neighbour: 4 });
    let met = curve.insert_point(5, &[0.0, 0.25]).unwrap_err();
    assert_eq!(met, Error::MeetsNeighbour { neighbour: 0 });
    let beyond = curve.insert_point_at(5, 1.0, &[0.5, 0.5]).unwrap_err();
    assert!(matches!(beyond, Error::OutOfRange { .. }), "{beyond}");
}

#[test]
fn a_loop_grows_from_few_points_and_shrinks_to_them() {
    for degree in [1, 2, 3, 6] {
        let mut curve =
            EditableCurve::new(&a_loop(3, degree + 2, 2, 1.0), &options(degree)).unwrap();
        let mut random = Random::new(1);
        while curve.len() < 150 {
            // Where there is most room.
            let t = curve.parameters();
            let gap = |j: usize| t.get(j + 1).map_or(t[0] + 1.0, |next| *next) - t[j];
            let at = (0..t.len()).max_by(|&a, &b| gap(a).total_cmp(&gap(b))).unwrap();
            let (a, b) = (curve.point(at), curve.point((at + 1) % t.len()));
            let lift = 0.01 * random.signed();
            let middle = [0.5 * (a[0] + b[0]) + lift, 0.5 * (a[1] + b[1]) - lift];
            curve.insert_point(at + 1, &middle).unwrap();
        }
        let (fit, bound) = (curve.fit().unwrap(), curve.bound());
        assert!(
            bound <= 1e-8 * fit.report.run.extent && fit.report.converged(),
            "{degree} {bound:e}"
        );
        while curve.len() > degree + 1 {
            curve.remove_point(curve.len() / 2).unwrap();
        }
        let refused = curve.remove_point(0);
        assert!(matches!(refused, Err(Error::TooFewPoints { .. })), "{refused:?}");
        assert!(curve.fit().unwrap().report.run.max_residual <= curve.bound());
    }
}

#[test]
fn loops_of_any_scale_place_and_parameters_will_do() {
    for (scale, shift) in [(1.0, 0.0), (1e300, 0.0), (1e-300, 0.0), (1.0, 1e9)] {
        let data = a_loop(5, 80, 2, 1.5);
        let data: Vec<f64> = data.coordinates().iter().map(|x| scale * x + shift).collect();
        let given: Vec<f64> = (0..=80).map(|j| 100.0 + f64::from(j * j) / 80.0).collect();
        for parameterization in [
            Parameterization::Chord,
            Parameterization::Centripetal,
            Parameterization::Uniform,
            Parameterization::Given(given.clone()),
        ] {
            let options = CurveOptions { parameterization: Some(parameterization), ..options(3) };
            let data = Points::new(2, data.clone()).unwrap();
            let mut curve = EditableCurve::new(&data, &options).unwrap();
            let mut point = curve.point(79);
            point[0] += scale * 0.5;
            curve.move_point(79, &point).unwrap();
            point[1] += scale * 0.25;
            curve.insert_point(80, &point).unwrap();
            curve.remove_point(1).unwrap();
            let fit = curve.fit().unwrap();
            assert!(fit.report.converged(), "{scale} {shift} {:?}", fit.report.run);
            let extent = fit.report.run.extent;
            assert!(curve.bound() <= 1e-8 * extent + 1e-10 * shift, "{:e}", curve.bound());
        }
    }
}

#[test]
fn a_closing_point_that_is_repeated_stays_left_out() {
    let data = a_loop(2, 40, 2, 1.5);
    let mut again = data.coordinates().to_vec();
    again.extend_from_slice(data.point(0));
    let again = Points::new(2, again).unwrap();
    let curve = EditableCurve::new(&again, &options(3)).unwrap();
    assert_eq!(curve.len(), 40);
    let fit = fit_curve(&data, &options(3)).unwrap();
    assert_eq!(curve.fit().unwrap().curve.control_points(), fit.curve.control_points());
    let at_data = CurveOptions { knot_placement: Some(KnotPlacement::AtData), ..options(3) };
    let error = EditableCurve::new(&data, &at_data).unwrap_err();
    assert!(matches!(error, Error::Incompatible { .. }), "{error}");
}
