//! Bases beyond B-splines, and Anderson acceleration, through the program.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

mod common;

use common::Place;
use gimfit_testkit::blending;
use serde_json::Value;

const ROUGH: &str = "x,y\n0,-2\n1,0\n2,-6\n3,3\n4,6\n5,-5\n6,-7\n7,-7\n8,-9\n9,3\n10,8\n";

fn points(value: &Value) -> Vec<Vec<f64>> {
    serde_json::from_value(value.clone()).unwrap()
}

/// The document's curve by the textbook, from its own control points and from its Bezier form.
#[test]
fn the_document_tells_the_basis_and_its_bezier_form() {
    type Textbook = fn(usize, usize, f64) -> f64;
    let bases: [(&str, Textbook); 4] = [
        ("bernstein", blending::bernstein),
        ("wang-ball", blending::wang_ball),
        ("said-ball", blending::said_ball),
        ("dp", blending::dp),
    ];
    let place = Place::with("rough.csv", ROUGH);
    for (name, textbook) in bases {
        let line = format!(
            "curve rough.csv --basis {name} --method pia --iterations 30 --residual 0 --keep 2 -o \
             fit.json -o fit.svg -q"
        );
        place.run(&line).code(0);
        let document: Value = serde_json::from_str(&place.read("fit.json")).unwrap();
        assert_eq!(document["blending"]["basis"], name);
        assert_eq!(document["geometry"]["degree"], 10);
        assert_eq!(document["report"]["knot_placement"], "bezier");
        assert_eq!(document["sequence"][0]["control_points"].as_array().unwrap().len(), 11);
        let own = points(&document["blending"]["control_points"]);
        let bezier = points(&document["geometry"]["control_points"]);
        for step in 0..=50 {
            let t = f64::from(step) / 50.0;
            for c in 0..2 {
                let sum = |points: &[Vec<f64>], f: Textbook| -> f64 {
                    points.iter().enumerate().map(|(i, p)| f(10, i, t) * p[c]).sum()
                };
                let gap = sum(&own, textbook) - sum(&bezier, blending::bernstein);
                assert!(gap.abs() < 1e-11, "{name} at {t}: {gap:e}");
            }
        }
        place.run("evaluate fit.json --samples 5").code(0);
        let info = place.run("info fit.json").code(0).out;
        assert!(info.contains("basis") && info.contains(name), "{info}");
    }
}

#[test]
fn every_basis_comes_down_to_the_default_residual_in_tens_of_steps() {
    let place = Place::with("rough.csv", ROUGH);
    for basis in ["bernstein", "wang-ball", "said-ball", "dp"] {
        for method in ["auto", "anderson"] {
            let line = format!("curve rough.csv --basis {basis} --method {method} --json");
            let report = place.run(&line).code(0).json();
            assert!(report["report"]["iterations"].as_u64().unwrap() < 40, "{basis} {method}");
            assert!(report["report"]["max_residual"].as_f64().unwrap() < 1e-9 * 20.0);
        }
    }
}

#[test]
fn options_that_contradict_a_basis_are_refused() {
    let place = Place::with("rough.csv", ROUGH);
    place.write("knots.txt", "0 1");
    for (options, says) in [
        ("--degree 10", "--degree belongs to --basis b-spline"),
        ("--knots averaged", "--knots belongs to --basis b-spline"),
        ("--closed", "--closed belongs to --basis b-spline"),
        ("--duplicates drop", "--duplicates belongs to --basis b-spline"),
        ("--parameters chord-ratio", "chord-ratio"),
    ] {
        let line = format!("curve rough.csv --basis bernstein {options}");
        place.run(&line).code(2).says(&[says]);
    }
    place.run("curve rough.csv --basis bezier").code(2).says(&["bezier", "bernstein"]);
    place
        .run("curve rough.csv --memory 3")
        .code(2)
        .says(&["--memory belongs to --method anderson"]);
    for memory in ["0", "1001"] {
        let line = format!("curve rough.csv --method anderson --memory {memory}");
        place.run(&line).code(2).says(&["between 1 and 1000"]);
    }
    place.write("one.csv", "x,y\n1,2\n");
    place.run("curve one.csv --basis dp").code(2).says(&["at least 2 points"]);
    let many: String = (0..27).map(|i| format!("{i},{}\n", i % 5)).collect();
    place.write("many.csv", many);
    place.run("curve many.csv --basis dp").code(2).says(&["27 points", "26", "b-spline"]);
}

#[test]
fn weights_make_a_basis_rational_in_the_document_too() {
    let c = std::f64::consts::FRAC_1_SQRT_2;
    let place = Place::with("arc.csv", format!("x,y\n1,0\n{c},{c}\n0,1\n"));
    place.write("weights.txt", format!("2 {} 2", 2.0 * c));
    for basis in ["bernstein", "said-ball"] {
        let line =
            format!("curve arc.csv --basis {basis} --rational-weights weights.txt -o arc.json");
        let out = place.run(&line).code(0).out;
        assert!(out.contains(&format!("rational {basis} of degree 2")), "{out}");
        let document: Value = serde_json::from_str(&place.read("arc.json")).unwrap();
        assert_eq!(document["blending"]["basis"], format!("rational {basis}"));
        assert_eq!(document["blending"]["rational_weights"].as_array().unwrap().len(), 3);
        assert_eq!(document["geometry"]["weights"].as_array().unwrap().len(), 3);
        for line in place.run("evaluate arc.json --samples 9").code(0).out.lines().skip(1) {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            assert!((cells[1].hypot(cells[2]) - 1.0).abs() < 1e-12, "{line}");
        }
    }
    place.write("weights.txt", "1 -1 1");
    let line = "curve arc.csv --basis bernstein --rational-weights weights.txt";
    place.run(line).code(2).says(&["rational weight 1"]);
    place.write("weights.txt", "1 1");
    place.run(line).code(2).says(&["2 rational weights given, 3 expected"]);
}

#[test]
fn surfaces_take_a_basis_in_each_direction() {
    let place = Place::new();
    let mut grid = String::from("row,column,x,y,z\n");
    for i in 0..6 {
        for j in 0..4 {
            grid += &format!("{i},{j},{i},{j},{}\n", (i * i + 3 * j) % 5);
        }
    }
    place.write("sheet.csv", grid);
    let line = "surface sheet.csv --basis bernstein,wang-ball --method pia --iterations 20 \
                --residual 0 --keep 1 -o fit.json -o fit.svg -q";
    place.run(line).code(0);
    let document: Value = serde_json::from_str(&place.read("fit.json")).unwrap();
    assert_eq!(document["blending"]["bases"], serde_json::json!(["bernstein", "wang-ball"]));
    assert_eq!(document["geometry"]["degrees"], serde_json::json!([5, 3]));
    let net = |part: &str| -> Vec<Vec<Vec<f64>>> {
        serde_json::from_value(document[part]["control_points"].clone()).unwrap()
    };
    let (own, bezier) = (net("blending"), net("geometry"));
    for (u, v) in [(0.0, 1.0), (0.3, 0.45), (0.8, 0.1)] {
        let sum = |net: &[Vec<Vec<f64>>], g: fn(usize, usize, f64) -> f64| -> f64 {
            net.iter()
                .enumerate()
                .flat_map(|(i, row)| row.iter().enumerate().map(move |(j, p)| (i, j, p[2])))
                .map(|(i, j, z)| blending::bernstein(5, i, u) * g(3, j, v) * z)
                .sum()
        };
        let gap = sum(&own, blending::wang_ball) - sum(&bezier, blending::bernstein);
        assert!(gap.abs() < 1e-12, "{gap:e}");
    }
    let info = place.run("info fit.json").code(0).out;
    assert!(info.contains("bernstein, wang-ball"), "{info}");
    place.run("surface sheet.csv --basis b-spline,dp").code(2).says(&["do not go together"]);
    place.run("surface sheet.csv --basis dp --degree 3").code(2).says(&["--degree belongs to"]);
    place.run("surface sheet.csv --basis dp --closed u").code(2).says(&["--closed belongs to"]);
    place.run("surface sheet.csv --basis ball").code(2).says(&["no basis", "wang-ball"]);
}

#[test]
fn a_document_with_another_number_of_blending_points_is_refused() {
    let place = Place::with("rough.csv", ROUGH);
    place.run("curve rough.csv --basis dp -o fit.json -q").code(0);
    let mut document: Value = serde_json::from_str(&place.read("fit.json")).unwrap();
    document["blending"]["control_points"].as_array_mut().unwrap().pop();
    place.write("fit.json", document.to_string());
    place.run("evaluate fit.json --samples 3").code(2).says(&["blending control points"]);
}
