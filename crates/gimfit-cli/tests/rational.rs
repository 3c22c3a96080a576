//! Fits with rational weights and over bezier knots, from the command line.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

mod common;

use common::{Place, numbers, table, wave};

#[test]
fn weights_of_a_file_make_a_rational_curve() {
    let place = Place::with("wave.csv", wave(12));
    let weights: Vec<String> = (0..12).map(|i| format!("{}", 1.0 + f64::from(i % 3))).collect();
    place.write("w.txt", weights.join("\n"));
    place.run("curve wave.csv --rational-weights w.txt -o fit.json -o fit.svg -q").code(0);
    let document = place.document("fit.json");
    assert_eq!(numbers(&document["geometry"]["weights"])[..4], [1.0, 2.0, 3.0, 1.0]);
    let far = place.run("project fit.json wave.csv --json").code(0).json();
    assert!(far["largest_distance"].as_f64().unwrap() < 1e-11);
    place.run("diagnose wave.csv --rational-weights w.txt").code(0);
    place.write("short.txt", "1 2 3");
    let ran = place.run("curve wave.csv --rational-weights short.txt").code(2);
    ran.says(&["wave.csv", "rational weights"]);
    place.write("bad.txt", weights.join("\n").replacen('2', "-2", 1));
    let ran = place.run("curve wave.csv --rational-weights bad.txt").code(2);
    ran.says(&["rational weight 1", "positive"]);
    place.run("curve wave.csv --rational-weights none.txt").code(2).says(&["none.txt"]);
    // The Bernstein basis, by either way, makes the same rational Bezier curve.
    let both = ["--basis bernstein", "--knots bezier --parameters uniform"].map(|way| {
        let line = format!("curve wave.csv --rational-weights w.txt {way} -o way.json -q");
        place.run(&line).code(0);
        let geometry = place.document("way.json")["geometry"].clone();
        let rows = geometry["control_points"].as_array().unwrap().iter().flat_map(numbers);
        (rows.collect::<Vec<f64>>(), numbers(&geometry["weights"]))
    });
    let [(first, weights), (second, others)] = &both;
    assert!(first.iter().zip(second).all(|(a, b)| (a - b).abs() < 1e-8 * (1.0 + b.abs())));
    let ratio = weights[0] / others[0];
    assert!(weights.iter().zip(others).all(|(a, b)| (a / b - ratio).abs() < 1e-12));
}

#[test]
fn sorted_points_take_their_weights_along() {
    let place = Place::with("a.csv", "x,y\n3,1\n0,2\n1,5\n2,0\n4,4\n");
    place.write("w.txt", "30 1 10 20 40");
    let line = "curve a.csv --abscissa x --sort --rational-weights w.txt -o fit.json -q";
    place.run(line).code(0);
    let weights = numbers(&place.document("fit.json")["geometry"]["weights"]);
    assert_eq!(weights, [1.0, 10.0, 20.0, 30.0, 40.0]);
}

#[test]
fn bezier_knots_take_their_degree_from_the_points() {
    let place = Place::with("wave.csv", wave(8));
    place.run("curve wave.csv --knots bezier -o fit.json -q").code(0);
    let document = place.document("fit.json");
    assert_eq!(document["geometry"]["degree"], 7);
    assert_eq!(document["report"]["knot_placement"], "bezier");
    place.run("curve wave.csv --knots bezier --degree 3").code(2).says(&["points - 1"]);
    place.run("curve wave.csv --knots bezier --closed").code(2).says(&["closed"]);
    place.write("long.csv", wave(40));
    place.run("curve long.csv --knots bezier").code(2).says(&["long.csv", "degree 39", "25"]);
}

#[test]
fn weights_of_a_file_make_a_rational_surface() {
    let mut grid = String::from("row,column,x,y,z\n");
    let mut weights = String::new();
    for i in 0..6 {
        for j in 0..5 {
            grid += &format!("{i},{j},{i},{j},{}\n", i * j % 4);
            weights += &format!("{}\n", 1 + (3 * i + 2 * j) % 5);
        }
    }
    let place = Place::with("grid.csv", grid);
    place.write("w.txt", weights);
    place.run("surface grid.csv --rational-weights w.txt -o fit.json -o net.csv -q").code(0);
    let document = place.document("fit.json");
    assert_eq!(numbers(&document["geometry"]["weights"][1]), [4.0, 1.0, 3.0, 5.0, 2.0]);
    let [u, v] = [0, 1].map(|k| numbers(&document["parameters"][k]));
    place.write("at.csv", format!("{:?},{:?}\n", u[3], v[2]));
    let out = place.run("evaluate fit.json --at at.csv").code(0).out;
    let row = &table(out.split_once('\n').unwrap().1)[0];
    for (found, expected) in row[2..].iter().zip([3.0, 2.0, 2.0]) {
        assert!((found - expected).abs() < 1e-11, "{row:?}");
    }
    let line = "surface grid.csv --rational-weights w.txt --per-direction";
    place.run(line).code(2).says(&["no product"]);
    place.run("surface grid.csv --knots bezier --rational-weights w.txt -o b.json -q").code(0);
    let degrees = numbers(&place.document("b.json")["geometry"]["degrees"]);
    assert_eq!(degrees, [5.0, 4.0]);
}
