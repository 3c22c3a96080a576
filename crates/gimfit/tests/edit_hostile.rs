//! No edit, however broken, panics, hangs or leaves what is no number.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::{CurveOptions, EditableCurve, EditableSurface, GridView, PointsView, SurfaceOptions};
use gimfit_testkit::generate::Random;

const HOSTILE: [f64; 10] =
    [f64::NAN, f64::INFINITY, 1e300, -1e300, 1e-300, f64::MAX, 0.0, 1e9, 1e9 + 1e-6, -1e154];

fn value(random: &mut Random, wild: bool) -> f64 {
    if wild && random.unit() < 0.15 {
        HOSTILE[(random.unit() * 10.0) as usize]
    } else {
        (random.unit() * 8.0).floor()
    }
}

#[test]
fn curves_stay_whole_whatever_is_done_to_them() {
    let mut random = Random::new(31);
    let (mut held, mut refused) = (0, 0);
    for round in 0..400 {
        let (dimension, wild) = ([1, 2, 3, 7][round % 4], round % 3 == 0);
        let count = 2 + (random.unit() * 12.0) as usize;
        let points: Vec<f64> = (0..count * dimension).map(|_| value(&mut random, wild)).collect();
        let view = PointsView::new(dimension, &points).unwrap();
        let options = CurveOptions {
            degree: 1 + (random.unit() * 4.0) as usize,
            closed: round % 2 == 0,
            ..Default::default()
        };
        let Ok(mut curve) = EditableCurve::new(view, &options) else { continue };
        for _ in 0..12 {
            let at = (random.unit() * (curve.len() + 2) as f64) as usize;
            let point: Vec<f64> = (0..dimension).map(|_| value(&mut random, true)).collect();
            let before = curve.clone();
            let done = match (random.unit() * 4.0) as usize {
                0 => curve.move_point(at, &point),
                1 => curve.insert_point(at, &point),
                2 => curve.remove_point(at),
                _ => curve.insert_point_at(at, value(&mut random, true) / 8.0, &point),
            };
            match done {
                Err(error) => {
                    refused += 1;
                    assert!(error.to_string().len() > 20);
                    assert_eq!(curve.points(), before.points());
                    assert_eq!(curve.parameters(), before.parameters());
                }
                Ok(report) => {
                    held += 1;
                    assert!(report.max_residual.is_finite() && report.bound >= report.max_residual);
                    assert!(report.window.end - report.window.start <= curve.len());
                }
            }
            let (start, end) = curve.domain();
            let middle = curve.evaluate(start + 0.3 * (end - start)).unwrap();
            assert!(middle.iter().all(|x| x.is_finite()));
            if let Ok(fit) = curve.fit() {
                assert!(fit.curve.control_points().coordinates().iter().all(|x| x.is_finite()));
            }
        }
    }
    assert!(held > 500 && refused > 500, "{held} {refused}");
}

#[test]
fn surfaces_stay_whole_whatever_is_done_to_them() {
    let mut random = Random::new(32);
    let (mut held, mut refused) = (0, 0);
    for round in 0..200 {
        let (dimension, wild) = ([1, 2, 3, 7][round % 4], round % 5 == 0);
        let shape = [0, 1].map(|_| 2 + (random.unit() * 7.0) as usize);
        let length = shape[0] * shape[1] * dimension;
        let points: Vec<f64> = (0..length).map(|_| value(&mut random, wild)).collect();
        let view = GridView::new(shape, dimension, &points).unwrap();
        let options = SurfaceOptions {
            degrees: [0, 1].map(|_| 1 + (random.unit() * 3.0) as usize),
            closed: [round % 2 == 0, round % 3 == 0],
            ..Default::default()
        };
        let Ok(mut surface) = EditableSurface::new(view, &options) else { continue };
        for _ in 0..8 {
            let at = shape.map(|count| (random.unit() * (count + 1) as f64) as usize);
            let point: Vec<f64> = (0..dimension).map(|_| value(&mut random, true)).collect();
            let before = surface.points();
            match surface.move_point(at[0], at[1], &point) {
                Err(error) => {
                    refused += 1;
                    assert!(error.to_string().len() > 20);
                    assert_eq!(surface.points(), before);
                }
                Ok(report) => {
                    held += 1;
                    assert!(report.max_residual.is_finite() && report.bound >= report.max_residual);
                }
            }
            if let Ok(fit) = surface.fit() {
                let net = fit.surface.control_net().points();
                assert!(net.coordinates().iter().all(|x| x.is_finite()));
            }
        }
    }
    assert!(held > 200 && refused > 200, "{held} {refused}");
}
