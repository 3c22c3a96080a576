//! `gimfit project`: the distance of points from a fitted curve or surface.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

mod common;

use common::{Place, numbers, table};

/// A document of the parabola y = x^2 for x from -1 to 1.
const PARABOLA: &str = r#"{"format":"gimfit","version":1,"geometry":{"type":"curve","degree":2,
    "dimension":2,"periodic":false,"knots":[0,0,0,1,1,1],
    "control_points":[[-1,1],[0,-1],[1,1]],"weights":null},"coordinate_names":["x","y"]}"#;

/// A document of the square from (0, 0, 0) to (2, 2, 0).
const SQUARE: &str = r#"{"format":"gimfit","version":1,"geometry":{"type":"surface",
    "degrees":[1,1],"dimension":3,"periodic":[false,false],"knots":[[0,0,1,1],[0,0,1,1]],
    "control_points":[[[0,0,0],[0,2,0]],[[2,0,0],[2,2,0]]],"weights":null}}"#;

#[test]
fn points_find_their_nearest_point_of_a_curve() {
    let place = Place::with("fit.json", PARABOLA);
    place.write("p.csv", "x,y\n0,-2\n1,1\n3,1\n0.01,5\n");
    let report = place.run("project fit.json p.csv -o feet.csv").code(0).out;
    // From (0.01, 5) the right branch is nearer than the left one: the end there is not.
    for part in ["the curve of fit.json", "largest", "line 5", "rms", "mean", "4 foot points"] {
        assert!(report.contains(part), "no {part} in {report}");
    }
    let text = place.read("feet.csv");
    let (header, rows) = text.split_once('\n').unwrap();
    assert_eq!(header, "t,x,y,distance");
    let rows = table(rows);
    assert_eq!(rows[0], [0.5, 0.0, 0.0, 2.0]);
    assert_eq!(rows[1], [1.0, 1.0, 1.0, 0.0]);
    assert_eq!(rows[2], [1.0, 1.0, 1.0, 2.0]);
    assert_eq!(rows[3][..3], [1.0, 1.0, 1.0]);
    assert_eq!(place.run("project fit.json p.csv -o -").code(0).out, text);
    place.run("project fit.json p.csv -o feet.json").code(0);
    let feet = place.document("feet.json");
    assert_eq!(feet["format"], "gimfit-feet");
    for (foot, row) in feet["feet"].as_array().unwrap().iter().zip(&rows) {
        assert_eq!(foot["parameter"].as_f64().unwrap(), row[0]);
        assert_eq!(numbers(&foot["point"]), row[1..3]);
        assert_eq!(foot["distance"].as_f64().unwrap(), row[3]);
    }
    let summary = place.run("project fit.json p.csv --json").code(0).json();
    let mean = rows.iter().map(|row| row[3]).sum::<f64>() / 4.0;
    assert!((summary["mean_distance"].as_f64().unwrap() - mean).abs() < 1e-15);
    assert_eq!(summary["largest_distance_index"], 3);
}

#[test]
fn points_find_their_nearest_point_of_a_surface() {
    let place = Place::with("fit.json", SQUARE);
    place.write("p.csv", "0.5,1,1\n3,3,0\n-1,1,0\n2,0,0\n");
    place.run("project fit.json p.csv -o feet.csv").code(0);
    let text = place.read("feet.csv");
    let (header, rows) = text.split_once('\n').unwrap();
    assert!(header.starts_with("u,v,") && header.ends_with(",distance"), "{header}");
    let rows = table(rows);
    assert_eq!(rows[0], [0.25, 0.5, 0.5, 1.0, 0.0, 1.0]);
    assert_eq!(rows[1], [1.0, 1.0, 2.0, 2.0, 0.0, 2f64.sqrt()]);
    assert_eq!(rows[2], [0.0, 0.5, 0.0, 1.0, 0.0, 1.0]);
    assert_eq!(rows[3][5], 0.0);
}

#[test]
fn kept_fits_are_measured_too() {
    let mut wave = String::from("x,y\n");
    for i in 0..20 {
        wave += &format!("{i},{}\n", f64::from(i * i % 7));
    }
    let place = Place::with("wave.csv", wave);
    place.run("curve wave.csv --method pia --keep 0,5 -o fit.json -q").code(0);
    let largest = |line: &str| {
        let summary = place.run(line).code(0).json();
        summary["largest_distance"].as_f64().unwrap()
    };
    let end = largest("project fit.json wave.csv --json");
    let start = largest("project fit.json wave.csv --json --iteration 0");
    let later = largest("project fit.json wave.csv --json --iteration 5");
    assert!(end < 1e-9 && later < start && later > end, "{start} {later} {end}");
    place.run("project fit.json wave.csv --iteration 3").code(2).says(&["0, 5"]);
}

#[test]
fn what_cannot_be_projected_is_refused() {
    let place = Place::with("fit.json", PARABOLA);
    place.write("p.csv", "x,y,z\n1,2,3\n");
    place.write("q.csv", "x,y\n1,2\n");
    place.run("project fit.json p.csv").code(2).says(&["p.csv", "dimension 3", "--columns"]);
    place.run("project fit.json p.csv --columns x,z").code(0);
    place.run("project q.csv fit.json").code(2).says(&["q.csv", "no gimfit document"]);
    place.run("project - -").code(2).says(&["standard input", "FIT", "POINTS"]);
    place.run("project fit.json q.csv -o q.csv").code(2).says(&["q.csv"]);
    place.run("project fit.json q.csv -o q.svg").code(2).says(&["q.svg", ".csv"]);
    place.run("project fit.json q.csv --json -o -").code(2).says(&["--json"]);
    place.run("project fit.json none.csv").code(2).says(&["none.csv"]);
    place.write("nan.csv", "x,y\n1,nan\n");
    place.run("project fit.json nan.csv").code(2).says(&["nan.csv", "line 2"]);
    place.write("far.csv", "x,y\n1e300,-1e300\n1e-300,0\n");
    let far = place.run("project fit.json far.csv --json").code(0).json();
    assert!(far["rms_distance"].as_f64().unwrap() > 1e299);
}
