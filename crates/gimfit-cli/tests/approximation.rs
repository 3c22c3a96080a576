//! `gimfit curve --tolerance`, `--rms`, `--control-points`.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

mod common;

use common::{Place, wave};

fn place() -> Place {
    Place::with("wave.csv", wave(60))
}

#[test]
fn a_tolerance_is_kept_and_told() {
    let place = place();
    let ran = place.run("curve wave.csv --tolerance 0.01 -o fit.json -o fit.svg").code(0);
    assert_eq!(ran.errors, "");
    assert!(ran.out.contains("within what was asked"), "{}", ran.out);
    let document = place.document("fit.json");
    let report = &document["report"];
    let account = &report["approximation"];
    assert_eq!(account["met"], true);
    assert!(account["max_distance"].as_f64().unwrap() <= 0.01);
    let control = document["geometry"]["control_points"].as_array().unwrap().len();
    assert!(control < 40 && report["control_points"].as_u64().unwrap() as usize == control);
    // Readable by the rest of the program.
    place.run("evaluate fit.json --samples 5").code(0);
    place.run("info fit.json").code(0);
}

#[test]
fn noise_and_outliers_are_left_out_and_told() {
    // A parabola, noise of 0.01 and a point far off.
    let noise = |i: i32| f64::from(i * 7919 % 101 - 50) * 3.4e-4;
    let rows: String = (0..200)
        .map(|i| {
            let x = f64::from(i) / 20.0;
            let off = if i == 77 { 3.0 } else { 0.0 };
            format!("{},{}\n", x + noise(i * 31 + 7), 0.1 * x * x + noise(i) + off)
        })
        .collect();
    let place = Place::with("noisy.csv", format!("x,y\n{rows}"));
    let ran = place.run("curve noisy.csv --noise auto --robust tukey -o fit.json").code(0);
    assert!(ran.out.contains("noise: standard deviation"), "{}", ran.out);
    assert!(ran.out.contains("1 left out: line 79"), "{}", ran.out);
    let account = &place.document("fit.json")["report"]["approximation"];
    assert_eq!(account["outliers"], serde_json::json!([77]));
    let noise = account["noise"].as_f64().unwrap();
    assert!((0.005..0.02).contains(&noise), "{noise}");
    place.run("curve noisy.csv --noise 0.01 --robust huber").code(0);
    place.run("curve noisy.csv --noise much").code(2).says(&["auto", "standard deviation"]);
    place.run("curve noisy.csv --robust tukey").code(2);
    place.run("curve noisy.csv --noise 0").code(2).says(&["standard deviation", "above 0"]);
}

#[test]
fn a_number_of_control_points_is_kept() {
    let place = place();
    place.run("curve wave.csv --control-points 9 -o fit.json").code(0);
    let document = place.document("fit.json");
    assert_eq!(document["geometry"]["control_points"].as_array().unwrap().len(), 9);
}

#[test]
fn what_belongs_to_interpolation_is_refused_beside_it() {
    let place = place();
    for other in ["--method pia", "--keep 1,2", "--knots uniform", "--iterations 9", "--rms 1"] {
        place.run(&format!("curve wave.csv --tolerance 0.01 {other}")).code(2).says(&["cannot be"]);
    }
    place.run("curve wave.csv --corners none").code(2);
    place.run("curve wave.csv --tolerance 0").code(2).says(&["tolerance", "above 0"]);
    place.run("curve wave.csv --tolerance -1").code(2).says(&["tolerance", "above 0"]);
    place.run("curve wave.csv --tolerance 1 --corners 200").code(2).says(&["180"]);
    place.run("curve wave.csv --control-points 3").code(2).says(&["control points", "4"]);
}

#[test]
fn a_distance_that_cannot_be_kept_is_1_and_the_closest_curve_is_written() {
    // Rough data: neighbours far apart, to be met by a curve that may not swing.
    let rows: String = (0..40).map(|i| format!("{},{}\n", i % 7 * 13 % 5, i * i % 11)).collect();
    let place = Place::with("rough.csv", format!("x,y\n{rows}"));
    let ran = place.run("curve rough.csv --tolerance 1e-13 --corners none -o fit.json");
    let met = place.document("fit.json")["report"]["approximation"]["met"] == true;
    if met {
        ran.code(0);
    } else {
        ran.code(1).says(&["the distance", "was not reached"]);
    }
}
