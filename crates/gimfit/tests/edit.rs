//! Laws of curves that are edited point by point.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::fit::interpolate;
use gimfit::knots::place_knots;
use gimfit::parameters::Parameters;
use gimfit::{
    CurveOptions, EditReport, EditableCurve, Error, KnotPlacement, Parameterization, Points,
    fit_curve,
};
use gimfit_testkit::generate::{Random, random_walk};
use gimfit_testkit::{dense, textbook};

fn options(degree: usize) -> CurveOptions {
    CurveOptions { degree, ..Default::default() }
}

fn walk(seed: u64, count: usize, dimension: usize) -> Points {
    Points::new(dimension, random_walk(seed, count, dimension).concat()).unwrap()
}

/// Points whose steps are up to three times the one before, or down to a third of it.
fn graded(seed: u64, count: usize) -> Points {
    let mut random = Random::new(seed);
    let (mut x, mut step) = (0.0, 1.0_f64);
    let mut coordinates = Vec::new();
    for _ in 0..count {
        coordinates.extend([x, step * random.signed()]);
        step = (step * 3_f64.powf(random.signed())).clamp(1e-2, 1e2);
        x += step;
    }
    Points::new(2, coordinates).unwrap()
}

/// A random edit near its neighbours.
fn edit(curve: &mut EditableCurve, random: &mut Random) -> EditReport {
    let count = curve.len();
    let at = (random.unit() * count as f64) as usize;
    let (here, next) = (curve.point(at), curve.point(if at + 1 < count { at + 1 } else { at - 1 }));
    let share = 0.2 + 0.6 * random.unit();
    let mut between: Vec<f64> = here.iter().zip(&next).map(|(a, b)| a + share * (b - a)).collect();
    between.iter_mut().for_each(|x| *x += 0.1 * random.signed());
    match (random.unit() * 4.0) as usize {
        0 if count > curve.degree() + 1 => curve.remove_point(at).unwrap(),
        1 => curve.insert_point(at + usize::from(at + 1 < count), &between).unwrap(),
        2 => {
            // Beyond an end.
            let end = if random.unit() < 0.5 { 0 } else { count };
            let mut point = curve.point(end.min(count - 1));
            point.iter_mut().for_each(|x| *x += 0.5 + random.unit());
            curve.insert_point(end, &point).unwrap()
        }
        _ => curve.move_point(at, &between).unwrap(),
    }
}

/// Control points of the fit of all points by dense elimination over the textbook's functions, and
/// the row sums of the inverse without its signs.
fn refit(curve: &EditableCurve) -> (dense::Rows, f64) {
    let (degree, t) = (curve.degree(), curve.parameters());
    let knots = textbook::averaged_knots(degree, &t);
    let matrix = textbook::collocation_matrix(&knots, degree, &t);
    let data: dense::Rows = (0..curve.len()).map(|j| curve.point(j)).collect();
    let unit = |j: usize| (0..t.len()).map(|i| f64::from(u8::from(i == j))).collect();
    let inverse = dense::solve(&matrix, &(0..t.len()).map(unit).collect());
    let sums = inverse.iter().map(|row| row.iter().map(|x| x.abs()).sum::<f64>());
    (dense::solve(&matrix, &data), sums.fold(0.0, f64::max))
}

fn farthest<'a>(ours: &Points, theirs: impl Iterator<Item = &'a [f64]>) -> f64 {
    let gap = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0, |s: f64, (a, b)| s.hypot(a - b));
    ours.iter().zip(theirs).map(|(a, b)| gap(a, b)).fold(0.0, f64::max)
}

#[test]
fn edits_stay_within_the_bound_of_the_fit_of_all_points() {
    for degree in 1..=7 {
        for (kind, data) in
            [walk(degree as u64, 60, 2), graded(degree as u64, 60)].iter().enumerate()
        {
            let mut random = Random::new(degree as u64);
            let mut curve = EditableCurve::new(data, &options(degree)).unwrap();
            for step in 0..30 {
                let report = edit(&mut curve, &mut random);
                assert_eq!(report.bound, curve.bound());
                if step % 6 != 5 {
                    continue;
                }
                let (control, norm) = refit(&curve);
                let fit = curve.fit().unwrap();
                let ours = fit.curve.control_points();
                let off = farthest(ours, control.iter().map(Vec::as_slice));
                // Elimination rounds, too.
                let largest = control.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
                let theirs = 1e-14 * norm * largest;
                assert!(off <= report.bound + theirs, "{degree} {kind}: {off:e} {report:?}");
                // The bound holds what it should, and not much else.
                let least = norm * fit.report.run.max_residual * (1.0 - 1e-5);
                assert!(report.bound >= least, "{degree} {kind}: {least:e} {report:?}");
                let extent = fit.report.run.extent;
                let most = norm * (2e-12 * extent + 1e-14 * largest);
                assert!(report.bound <= most, "{degree} {kind}: {most:e} {report:?}");
            }
        }
    }
}

#[test]
fn long_curves_agree_with_a_refit_and_move_only_what_is_near() {
    for (degree, most) in [(1, 60), (2, 80), (3, 100), (5, 160), (7, 250)] {
        let mut random = Random::new(degree as u64);
        let mut curve = EditableCurve::new(&walk(4, 2000, 3), &options(degree)).unwrap();
        for _ in 0..15 {
            let before = curve.fit().unwrap();
            let report = edit(&mut curve, &mut random);
            let after = curve.fit().unwrap();
            assert!(report.control_points_touched <= most, "{degree} {report:?}");
            assert_eq!(report.control_points_touched, report.window.len());
            assert!(report.max_residual <= after.report.run.max_residual);
            let (old, new) = (before.curve.control_points(), after.curve.control_points());
            (0..report.window.start).for_each(|i| assert_eq!(old.point(i), new.point(i)));
            let kept = new.len() - report.window.end;
            for i in 1..=kept {
                assert_eq!(old.point(old.len() - i), new.point(new.len() - i));
            }
        }
        let parameters = Parameters::open(curve.parameters()).unwrap();
        let knots = place_knots(degree, &parameters, &KnotPlacement::Averaged).unwrap();
        let points = curve.points().unwrap();
        let whole = interpolate(&points, parameters, knots, &options(degree)).unwrap();
        let ours = curve.fit().unwrap();
        assert_eq!(ours.curve.knots(), whole.curve.knots());
        let off = farthest(ours.curve.control_points(), whole.curve.control_points().iter());
        assert!(off <= 2.0 * curve.bound(), "{degree}: {off:e} {:e}", curve.bound());
        assert!(off <= 1e-9 * ours.report.run.extent, "{degree}: {off:e}");
        assert!(ours.report.max_deviation <= ours.report.run.max_residual);
    }
}

#[test]
fn an_edit_undone_gives_the_old_curve() {
    for degree in [1, 2, 3, 4, 7] {
        let mut curve = EditableCurve::new(&walk(6, 400, 2), &options(degree)).unwrap();
        let before = curve.fit().unwrap();
        for at in [0, 3, 200, 399] {
            let (old, t) = (curve.point(at), curve.parameters()[at]);
            curve.move_point(at, &[old[0] + 3.0, old[1] - 2.0]).unwrap();
            curve.move_point(at, &old).unwrap();
            curve.remove_point(at).unwrap();
            curve.insert_point_at(at, t, &old).unwrap();
        }
        let after = curve.fit().unwrap();
        assert_eq!(after.parameters, before.parameters);
        let control = before.curve.control_points().iter();
        let off = farthest(after.curve.control_points(), control);
        // Both are within the bound of the one interpolant.
        assert!(off <= 2.0 * curve.bound(), "{degree}: {off:e} {:e}", curve.bound());
    }
}

#[test]
fn points_of_the_curve_are_found_from_nearby() {
    let mut random = Random::new(8);
    for degree in [1, 2, 3, 6] {
        let mut curve = EditableCurve::new(&walk(9, 1500, 2), &options(degree)).unwrap();
        for _ in 0..30 {
            edit(&mut curve, &mut random);
        }
        let whole = curve.fit().unwrap();
        let (start, end) = curve.domain();
        let mut parameters = whole.parameters.clone();
        parameters.extend((0..200).map(|_| start + (end - start) * random.unit()));
        for t in parameters {
            let (ours, theirs) = (curve.evaluate(t).unwrap(), whole.curve.evaluate(t).unwrap());
            let off = (ours[0] - theirs[0]).hypot(ours[1] - theirs[1]);
            assert!(off <= 1e-13 * whole.report.run.extent, "{degree} {t}: {off:e}");
        }
        assert!(matches!(curve.evaluate(end + 1.0), Err(Error::OutsideDomain { .. })));
        assert!(matches!(curve.evaluate(f64::NAN), Err(Error::OutsideDomain { .. })));
    }
}

#[test]
fn an_inserted_point_shares_the_gap_as_the_chords_do() {
    let points = [[0.0], [1.0], [2.0], [4.0], [8.0]].map(|[x]| [x, 0.0]);
    let mut curve = EditableCurve::new(&points, &options(2)).unwrap();
    curve.insert_point(4, &[5.0, 0.0]).unwrap();
    assert_eq!(curve.parameters()[4], 0.625);
    curve.insert_point(6, &[10.0, 0.0]).unwrap();
    curve.insert_point(0, &[-1.0, 0.0]).unwrap();
    assert_eq!((curve.parameters()[0], curve.domain()), (-0.125, (-0.125, 1.25)));
    let even = CurveOptions { parameterization: Some(Parameterization::Uniform), ..options(2) };
    let mut curve = EditableCurve::new(&points, &even).unwrap();
    curve.insert_point(4, &[4.1, 0.0]).unwrap();
    assert_eq!(curve.parameters()[3..], [0.75, 0.875, 1.0]);
}

#[test]
fn a_curve_grows_from_few_points_and_shrinks_to_them() {
    for degree in [1, 3, 7] {
        let few = walk(3, degree + 1, 2);
        let mut curve = EditableCurve::new(&few, &options(degree)).unwrap();
        for j in 0..900 {
            let mut point = curve.point(curve.len() - 1);
            point[0] += 1.0;
            point[1] = f64::from(j % 5);
            curve.insert_point(curve.len(), &point).unwrap();
        }
        assert_eq!(curve.len(), degree + 901);
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
fn a_refused_edit_changes_nothing() {
    let data = walk(2, 40, 2);
    let mut curve = EditableCurve::new(&data, &options(3)).unwrap();
    let before = curve.fit().unwrap();
    let near = curve.point(11);
    let too_far = [1e300, -1e300];
    let errors = [
        curve.move_point(40, &[0.0, 0.0]),
        curve.move_point(usize::MAX, &[0.0, 0.0]),
        curve.insert_point(41, &[0.0, 0.0]),
        curve.remove_point(40),
        curve.move_point(3, &[f64::NAN, 0.0]),
        curve.insert_point(3, &[0.0, f64::INFINITY]),
        curve.move_point(3, &[0.0]),
        curve.move_point(3, &[]),
        curve.move_point(10, &near),
        curve.move_point(12, &near),
        curve.insert_point(11, &near),
        curve.insert_point(12, &near),
        curve.move_point(3, &too_far),
        curve.insert_point(0, &too_far),
        curve.insert_point_at(3, 2.0, &[0.0, 0.0]),
        curve.insert_point_at(3, f64::NAN, &[0.0, 0.0]),
        curve.insert_point_at(40, f64::INFINITY, &[0.0, 0.0]),
        curve.insert_point_at(3, before.parameters[3], &[0.0, 0.0]),
    ];
    for (k, error) in errors.iter().enumerate() {
        let error = error.as_ref().expect_err(&format!("edit {k}"));
        assert!(!error.to_string().is_empty());
    }
    assert_eq!(errors[8], Err(Error::MeetsNeighbour { neighbour: 11 }));
    let after = curve.fit().unwrap();
    assert_eq!((&after.curve, &after.parameters), (&before.curve, &before.parameters));
}

#[test]
fn curves_that_are_no_local_matter_are_refused() {
    let data = walk(2, 40, 2);
    for options in [
        CurveOptions { knot_placement: Some(KnotPlacement::NotAKnot), ..options(5) },
        CurveOptions { knot_placement: Some(KnotPlacement::AtData), ..options(3) },
        CurveOptions { rational_weights: Some(vec![2.0; 40]), ..options(3) },
    ] {
        let error = EditableCurve::new(&data, &options).unwrap_err();
        assert!(matches!(error, Error::Incompatible { .. }), "{error}");
    }
    let fit = fit_curve(&data, &options(3)).unwrap();
    let other = EditableCurve::from_fit(&walk(2, 39, 2), &fit);
    assert!(matches!(other, Err(Error::WrongCount { .. })));
    assert!(matches!(
        EditableCurve::new(&walk(1, 3, 2), &options(3)),
        Err(Error::TooFewPoints { .. })
    ));
}

#[test]
fn any_scale_place_and_dimension_will_do() {
    for dimension in [1, 2, 3, 7] {
        for (scale, shift) in [(1.0, 0.0), (1e300, 0.0), (1e-300, 0.0), (1.0, 1e9), (1e-3, -1e6)] {
            let rows = random_walk(5, 80, dimension).concat();
            let data: Vec<f64> = rows.iter().map(|x| scale * x + shift).collect();
            let data = Points::new(dimension, data).unwrap();
            let mut curve = EditableCurve::new(&data, &options(3)).unwrap();
            let extent = curve.fit().unwrap().report.run.extent;
            let mut point = curve.point(20);
            point[0] += scale * 0.5;
            curve.move_point(20, &point).unwrap();
            point[0] += scale * 0.25;
            curve.insert_point(21, &point).unwrap();
            curve.remove_point(60).unwrap();
            let (fit, bound) = (curve.fit().unwrap(), curve.bound());
            let rounding = 1e-15 * shift.abs();
            assert!(
                bound.is_finite() && bound <= 1e-9 * extent + 1e3 * rounding,
                "{dimension} {bound:e}"
            );
            assert!(fit.report.run.max_residual <= 1e-11 * extent + 10.0 * rounding);
            assert!(fit.report.converged(), "{dimension} {scale} {shift}");
        }
    }
}

#[test]
fn repetitions_that_the_fit_dropped_stay_dropped() {
    let points = [[0.0, 0.0], [1.0, 1.0], [1.0, 1.0], [2.0, 0.0], [3.0, 1.0], [4.0, 0.0]];
    let options = CurveOptions { duplicates: gimfit::Duplicates::Drop, ..options(3) };
    let mut curve = EditableCurve::new(&points, &options).unwrap();
    assert_eq!((curve.len(), curve.point(2)), (5, vec![2.0, 0.0]));
    curve.move_point(2, &[2.0, 0.5]).unwrap();
    assert!(curve.fit().unwrap().report.converged());
}
