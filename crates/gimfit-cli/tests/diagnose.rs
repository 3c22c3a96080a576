//! The command `gimfit diagnose` from outside.

#![allow(clippy::unwrap_used)] // A test that cannot go on has failed.

mod common;

use common::{Place, testdata, wave};
use serde_json::Value;

/// Predicted and measured steps of every method on a file.
fn compare(options: &str, share: f64) {
    let place = Place::new();
    let found = place.run(&format!("diagnose {options} --json")).code(0).json();
    for forecast in found["methods"].as_array().unwrap() {
        let method = forecast["method"].as_str().unwrap();
        let line = format!("curve {options} --method {method} --iterations 3000 --json -q");
        let run = place.run(&line).json();
        let (steps, reason) = (&run["report"]["iterations"], &run["report"]["termination"]);
        match forecast["iterations"].as_f64() {
            Some(predicted) => {
                let gap = (predicted - steps.as_f64().unwrap()).abs();
                assert!(gap <= 2.0 + share * predicted, "{options} {method}: {predicted} {steps}");
                assert_eq!(reason, "residual", "{options} {method}");
            }
            None => assert_eq!(reason, "diverged", "{options} {method}"),
        }
    }
}

#[test]
fn predictions_come_true_on_real_data() {
    let path = |name: &str| testdata(name).display().to_string();
    compare(&path("airfoils/naca2412.dat"), 0.0);
    compare(&format!("{} --columns east,north", path("gpx/Mojstrovka.gpx")), 0.02);
}

#[test]
fn the_report_names_the_lines_to_blame() {
    let mut lines: Vec<String> = wave(30).lines().map(str::to_owned).collect();
    // Line 13 all but repeats line 12.
    let (x, y) = lines[11].split_once(',').unwrap();
    lines[12] = format!("{},{y}", x.parse::<f64>().unwrap() + 1e-4);
    let place = Place::with("wave.csv", lines.join("\n"));
    let run = place.run("diagnose wave.csv").code(0);
    for part in [
        "  spectrum ",
        "totally positive",
        "residuals fall slowest at: line 1",
        "shortest step there from line 12 to line 13",
        "drop line 12 or line 13",
        "centripetal",
        "gauss-seidel",
    ] {
        assert!(run.out.contains(part), "no {part:?} in {}", run.out);
    }
    let even = Place::with("wave.csv", wave(30)).run("diagnose wave.csv").code(0);
    assert!(even.out.contains("nothing is to blame"), "{}", even.out);
}

#[test]
fn options_of_curves_are_understood_and_the_tolerance_counts() {
    let place = Place::with("wave.csv", wave(40));
    let steps = |options: &str| {
        let found = place.run(&format!("diagnose wave.csv --json {options}")).code(0).json();
        let pia: &Value = &found["methods"][0];
        assert_eq!(pia["method"], "pia");
        (pia["iterations"].as_u64().unwrap(), found)
    };
    let (fine, _) = steps("");
    let (coarse, found) = steps("--tolerance 1e-3");
    assert!(coarse < fine && found["residual_target"] == 1e-3, "{coarse} {fine}");
    assert_eq!(steps("--tolerance 100").0, 0);
    let (_, found) = steps("--degree 4 --parameters uniform --closed");
    assert_eq!((&found["degree"], &found["closed"]), (&4.into(), &true.into()));
    assert_eq!(
        (&found["parameterization"], &found["total_positivity"]),
        (&"uniform".into(), &"refuted".into())
    );
    assert_eq!(found["eigenvalues"].as_array().unwrap().len(), 40);
}

#[test]
fn bad_input_is_refused_as_for_curves() {
    let place = Place::with("few.csv", "1,2\n3,4\n");
    place.run("diagnose few.csv").code(2).says(&["few.csv", "--degree"]);
    place.run("diagnose missing.csv").code(2).says(&["missing.csv"]);
    place.write("wave.csv", wave(9));
    place.run("diagnose wave.csv --tolerance -1").code(2).says(&["residual"]);
    place.run("diagnose few.csv --tolerance nan").code(2).says(&["--tolerance"]);
    place.write("same.csv", "1,2\n1,2\n1,2\n1,2\n");
    place.run("diagnose same.csv").code(2).says(&["all 4 points are equal"]);
    place.write("twice.csv", "0,0\n1,0\n1,0\n2,1\n3,3\n4,0\n");
    place.run("diagnose twice.csv").code(2).says(&["line 3", "line 2", "--duplicates"]);
    let dropped = place.run("diagnose twice.csv --duplicates drop").code(0);
    assert!(dropped.out.contains("5 points"), "{}", dropped.out);
    place.write("nan.csv", "0,0\n1,nan\n2,1\n3,3\n4,0\n");
    place.run("diagnose nan.csv").code(2).says(&["line 2"]);
    place.write("huge.csv", "0,0\n1e300,1e299\n2e300,0\n3e300,4e299\n4e300,0\n");
    assert!(!place.run("diagnose huge.csv").code(0).out.contains("NaN"));
}

#[test]
fn the_weight_of_lemma_2_can_be_asked_for() {
    let place = Place::with("wave.csv", wave(20));
    let run = place.run("curve wave.csv --method weighted --weight lemma2").code(0);
    assert!(run.out.contains("Lemma 2"), "{}", run.out);
    place.run("curve wave.csv --method sor --weight lemma2").code(2).says(&["Lemma 2", "weighted"]);
}

#[test]
fn grids_are_told_by_direction_and_at_once() {
    let bruno = testdata("grids/mt_bruno.csv").display().to_string();
    let place = Place::new();
    let run = place.run(&format!("diagnose {bruno} --grid")).code(0);
    for part in ["  u ", "  v ", "both at once", "u alone", "residuals fall slowest at row"] {
        assert!(run.out.contains(part), "no {part:?} in {}", run.out);
    }
    let found = place.run(&format!("diagnose {bruno} --grid --json")).code(0).json();
    let predicted = found["methods"][0]["iterations"].as_f64().unwrap();
    let run = place.run(&format!("surface {bruno} --method pia --json -q")).code(0).json();
    let measured = run["report"]["iterations"].as_f64().unwrap();
    assert!((measured - predicted).abs() <= 2.0, "{predicted} {measured}");
    assert!(found["condition"].as_f64().unwrap() > 1.0 && found["lemma2_weight"] == 1.0);
    place.run(&format!("diagnose {bruno} --grid --period 3")).code(2).says(&["--period"]);
    place.write("weights.txt", "1\n2\n3\n".repeat(14));
    let grid: String = (0..42).map(|k| format!("{},{},{}\n", k / 6, k % 6, k * k % 5)).collect();
    place.write("noheader.csv", grid);
    for options in [
        "--degree 3,2 --parameters chord,uniform",
        "--basis said-ball,bernstein --index-columns 1,2",
        "--rational-weights weights.txt",
        "--knots averaged,bezier --closed u",
    ] {
        let line = format!("diagnose noheader.csv --grid --shape 7x6 {options}");
        let line =
            line.replace("--shape 7x6 --basis said-ball,bernstein", "--basis said-ball,bernstein");
        let run = place.run(&line).code(0);
        for part in ["condition", "Lemma 2", "both at once"] {
            assert!(run.out.contains(part), "{options}: no {part:?} in {}", run.out);
        }
    }
    place.run("diagnose noheader.csv --grid").code(2).says(&["--shape 20x30"]);
    place.write("small.csv", "1,2\n3,4\n");
    place.run("diagnose small.csv --grid").code(2).says(&["small.csv", "rows"]);
}
