//! `gimfit curve --constraints`.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

mod common;

use common::{Place, wave};

#[test]
fn constraints_of_a_file_are_met() {
    let place = Place::with("wave.csv", wave(60));
    let data = wave(60);
    let first: Vec<f64> = data
        .lines()
        .find_map(|line| line.split(',').map(|x| x.trim().parse().ok()).collect())
        .unwrap();
    let zeros = vec!["0"; first.len() - 2].join(" ");
    place.write(
        "met.txt",
        format!("# ends\n\nthrough 1\ntangent 1, 1 1 {zeros} # up\nthrough,30\n"),
    );
    let line = "curve wave.csv --method least-squares --control-points 12 --constraints met.txt";
    place.run(&format!("{line} -o fit.json")).code(0);
    let document = place.document("fit.json");
    let control = common::points(&document["geometry"]["control_points"]);
    let gap = |a: &[f64], b: &[f64]| -> f64 {
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    // A clamped curve starts at its first control point, in the direction of the second.
    assert!(gap(&control[0], &first) < 1e-12);
    let leg: Vec<f64> = control[1].iter().zip(&control[0]).map(|(b, a)| b - a).collect();
    assert!((leg[0] - leg[1]).abs() < 1e-12 * leg[0].abs(), "{leg:?}");
}

#[test]
fn faults_of_the_file_are_named_by_line() {
    let place = Place::with("wave.csv", wave(60));
    let refused = |text: &str, says: &[&str]| {
        place.write("bad.txt", text);
        let line = "curve wave.csv --method pcg --control-points 12 --constraints bad.txt";
        place.run(line).code(2).says(says);
    };
    refused("through 1\ncontrol 1 5 5\n", &["line 1 (through 1)", "line 2 (control 1 5 5)"]);
    refused("\nthrough 61", &["line 2", "60 points"]);
    refused("through 0", &["line 1", "from 1"]);
    refused("through 1 2", &["one row"]);
    refused("through", &["row of a point"]);
    refused("tangent 1", &["coordinates"]);
    refused("tangent 1 x 0", &["\"x\" is no number"]);
    refused("touch 1", &["no constraint \"touch\""]);
    refused("straight 3 1 0", &["first or last"]);
    refused("planar last 30 1 0", &["fewer control points"]);
    refused("mirror 3 0", &["no such coordinate"]);
    refused("# nothing\n", &["no constraint in it"]);
    place.run("curve wave.csv --constraints bad.txt").code(2).says(&["--constraints"]);
    let line = "curve wave.csv --method lspia --control-points 12 --constraints none.txt";
    place.run(line).code(2).says(&["none.txt"]);
}
