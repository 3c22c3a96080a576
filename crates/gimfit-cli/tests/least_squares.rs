//! `gimfit curve --method lspia` and the other methods of least squares.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

mod common;

use common::{Place, wave};

fn place() -> Place {
    Place::with("wave.csv", wave(60))
}

const METHODS: [&str; 14] = [
    "least-squares",
    "lspia",
    "column-sums",
    "gs-lspia",
    "sor-lspia",
    "mlspia",
    "nesterov",
    "chebyshev-lspia",
    "salspia",
    "random-columns",
    "random-rows",
    "epia",
    "cgls",
    "pcg",
];

#[test]
fn every_method_fits_and_its_document_is_read_again() {
    let place = place();
    for method in METHODS {
        let line = format!("curve wave.csv --method {method} --control-points 11 --residual 1e-7");
        let ran = place.run(&format!("{line} -o fit.json -o fit.svg")).code(0);
        assert!(ran.out.contains("normal "), "{}", ran.out);
        let document = place.document("fit.json");
        let report = &document["report"];
        assert_eq!(report["method"], method);
        assert_eq!(document["geometry"]["control_points"].as_array().unwrap().len(), 11);
        assert!(report["least_squares"]["normal_residual"].as_f64().unwrap() <= 1e-7);
        assert!(report["history"][0]["normal_residual"].as_f64().unwrap() > 1e-7);
        place.run("evaluate fit.json --samples 5").code(0);
        place.run("info fit.json").code(0);
    }
}

#[test]
fn knots_weights_ends_and_kept_fits_are_taken() {
    let place = place();
    place.write("knots.txt", "0 0 0 0 0.2 0.4 0.6 0.8 1 1 1 1");
    place.write("weights.txt", "1 2 0 ".repeat(20));
    let base = "curve wave.csv --method column-sums --knots knots.txt --data-weights weights.txt";
    let ran = place.run(&format!("{base} --hold-ends --keep 0,3 --iterations 5000 -o fit.json"));
    ran.code(0);
    let document = place.document("fit.json");
    assert_eq!(document["geometry"]["control_points"].as_array().unwrap().len(), 8);
    assert_eq!(document["sequence"].as_array().unwrap().len(), 2);
    place.run("evaluate fit.json --samples 3 --iteration 3").code(0);
}

#[test]
fn a_run_goes_on_from_the_control_points_of_another() {
    let place = place();
    for closed in ["", "--closed"] {
        let line =
            format!("curve wave.csv --method lspia --control-points 12 --residual 0 {closed}");
        place.run(&format!("{line} --iterations 4 -o first.json")).code(0);
        place.run(&format!("{line} --iterations 5 --start first.json -o second.json")).code(0);
        place.run(&format!("{line} --iterations 9 -o whole.json")).code(0);
        let control =
            |name: &str| common::points(&place.document(name)["geometry"]["control_points"]);
        let gap = common::largest_distance(&control("second.json"), &control("whole.json"));
        assert!(gap < 1e-13, "{gap:e}");
    }
    let other = "curve wave.csv --method lspia --control-points 9 --start first.json";
    place.run(other).code(2).says(&["control points of the start", "9 expected"]);
    place.run("curve wave.csv --start first.json").code(2).says(&["--start", "least-squares"]);
    place.write("no.json", "{}");
    place.run("curve wave.csv --method pcg --control-points 9 --start no.json").code(2);
}

#[test]
fn a_run_that_ends_early_says_how_fast_it_went() {
    let place = place();
    let line =
        "curve wave.csv --method lspia --weight published --control-points 20 --iterations 30";
    place.run(line).code(1).says(&["normal residual", "the last steps left 0.", "more are needed"]);
}

#[test]
fn what_does_not_belong_is_refused_with_what_to_do() {
    let place = place();
    place.write("knots.txt", "0 0 0 0 0.5 1 1 1 1");
    let refused = |line: &str, words: &[&str]| {
        place.run(&format!("curve wave.csv {line}")).code(2).says(words);
    };
    refused("--method lspia", &["--control-points", "--knots FILE"]);
    refused("--method lspia --knots uniform", &["from a file", "--control-points"]);
    refused("--method pcg --knots knots.txt --control-points 9", &["both", "use one"]);
    refused("--method pcg --control-points 9 --convex", &["--convex", "pcg"]);
    refused("--method pcg --control-points 9 --only 3", &["--only", "pcg"]);
    refused("--method pcg --control-points 9 --duplicates drop", &["--duplicates", "as they are"]);
    refused("--method pcg --control-points 9 --basis bernstein", &["--basis"]);
    refused(
        "--method pcg --control-points 9 --foot-points global",
        &["--foot-points", "geometric"],
    );
    refused("--method pcg --control-points 9 --weight 0.5", &["iteration weight", "lspia"]);
    refused("--method pcg --control-points 9 --seed 3", &["--seed", "random"]);
    refused("--method pcg --control-points 61", &["at most one per data point"]);
    refused("--method pcg --control-points 3", &["4 expected"]);
    refused("--method sor-lspia --control-points 9 --weight 2.5", &["below 2"]);
    refused("--method lspia --control-points 9 --weight 1e9", &["largest eigenvalue"]);
    refused("--method lspia --control-points 9 --hold-ends --closed", &["closed curve"]);
    refused("--method pia --control-points 9", &["--method pia", "least-squares"]);
    refused("--control-points 9 --knots uniform", &["--knots", "--method least-squares"]);
    refused("--hold-ends", &["--hold-ends", "--method least-squares"]);
    refused("--method weighted --weight published", &["published", "column-sums"]);
    place.run("surface wave.csv --method lspia").code(2);
}
