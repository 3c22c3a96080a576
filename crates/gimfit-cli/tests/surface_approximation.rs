//! `gimfit surface --tolerance`, `--rms`, `--control-points`.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

mod common;

use common::Place;

/// A bent sheet, 12 rows of 10 points.
fn place() -> Place {
    let mut rows = String::from("row,column,x,y,z\n");
    for i in 0..12 {
        for j in 0..10 {
            let (s, t) = (f64::from(i) / 11.0, f64::from(j) / 9.0);
            let (x, y, z) = (3.0 * s + 0.1 * t, (2.0 * t).sin(), (2.0 * t).cos() + s * s);
            rows += &format!("{i},{j},{x},{y},{z}\n");
        }
    }
    Place::with("sheet.csv", rows)
}

#[test]
fn a_tolerance_is_kept_and_told() {
    let place = place();
    let ran = place.run("surface sheet.csv --tolerance 0.02 -o fit.json -o fit.svg").code(0);
    assert_eq!(ran.errors, "");
    assert!(ran.out.contains("within what was asked"), "{}", ran.out);
    assert!(ran.out.contains("from the cells of the grid, calm"), "{}", ran.out);
    let document = place.document("fit.json");
    let report = &document["report"];
    let account = &report["approximation"];
    assert_eq!(account["met"], true);
    assert!(account["max_distance"].as_f64().unwrap() <= 0.02);
    let net = document["geometry"]["control_points"].as_array().unwrap();
    let size = net.len() * net[0].as_array().unwrap().len();
    assert!(size <= 40, "{size}");
    assert_eq!(document["foot_parameters"].as_array().unwrap().len(), 12);
    // Readable by the rest of the program.
    place.run("evaluate fit.json --samples 3x3").code(0);
    place.run("info fit.json").code(0);
}

#[test]
fn heights_are_told_as_such() {
    let rows: String = (0..9)
        .map(|i| {
            let row: Vec<String> =
                (0..11).map(|j| format!("{}", (0.4 * f64::from(i * j)).sin())).collect();
            row.join(",") + "\n"
        })
        .collect();
    let place = Place::with("heights.csv", rows);
    let ran = place.run("surface heights.csv --tolerance 0.3 -o fit.json").code(0);
    assert!(ran.out.contains("of the heights, each at its place"), "{}", ran.out);
    let report = &place.document("fit.json")["report"];
    assert_eq!(report["parameterizations"][0], "abscissae");
}

#[test]
fn a_number_of_control_points_is_kept() {
    let place = place();
    place.run("surface sheet.csv --control-points 6x5 -o fit.json").code(0);
    assert_eq!(place.document("fit.json")["report"]["control_points"].to_string(), "[6,5]");
}

#[test]
fn what_belongs_to_interpolation_is_refused_beside_it() {
    let place = place();
    for other in [
        "--method pia",
        "--keep 1,2",
        "--knots uniform",
        "--iterations 9",
        "--rms 1",
        "--per-direction",
        "--basis bernstein",
        "--parameters uniform",
    ] {
        place
            .run(&format!("surface sheet.csv --tolerance 0.01 {other}"))
            .code(2)
            .says(&["cannot be"]);
    }
    place.run("surface sheet.csv --tolerance 0").code(2).says(&["tolerance", "above 0"]);
    place.run("surface sheet.csv --tolerance -1").code(2).says(&["tolerance", "above 0"]);
    place.run("surface sheet.csv --control-points 3x5").code(2).says(&["control points", "4"]);
    place.run("surface sheet.csv --control-points 9").code(2).says(&["9"]);
}

#[test]
fn a_distance_that_cannot_be_kept_is_1_and_the_closest_surface_is_written() {
    let mut rows = String::from("x,y,z\n");
    for i in 0..7_i32 {
        for j in 0..6_i32 {
            rows += &format!("{},{},{}\n", i * 7 % 5, j * i % 4, i * i * j % 11);
        }
    }
    let place = Place::with("rough.csv", rows);
    let ran = place.run("surface rough.csv --shape 7x6 --tolerance 1e-13 -o fit.json");
    if place.document("fit.json")["report"]["approximation"]["met"] == true {
        ran.code(0);
    } else {
        ran.code(1).says(&["the distance", "was not reached"]);
    }
}
