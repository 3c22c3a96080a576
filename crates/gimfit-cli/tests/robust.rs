//! Hostile inputs: a clear message and untouched files, or finite numbers.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

mod common;

use common::{Place, all_finite, largest_distance, points, table, wave};
use serde_json::Value;

/// Expects a refusal with these words that touches no file.
#[track_caller]
fn refused(content: &str, options: &str, parts: &[&str]) {
    let place = Place::with("a.csv", content);
    place.write("old.json", "old");
    let ran = place.run(&format!("curve a.csv {options} -o old.json -o new.csv -o new.svg"));
    ran.code(2).says(&["error: ", "a.csv"]).says(parts);
    assert_eq!(place.read("old.json"), "old");
    assert_eq!(place.names(), ["a.csv", "old.json"]);
}

/// Expects a fit of finite numbers whose picture is well-formed.
#[track_caller]
fn fitted(content: &str, options: &str) -> Value {
    let place = Place::with("a.csv", content);
    place.run(&format!("curve a.csv {options} -q -o a.json -o a.svg")).code(0);
    let document = place.document("a.json");
    all_finite(&document);
    roxmltree::Document::parse(&place.read("a.svg")).unwrap();
    place.run("evaluate a.json --samples 50").code(0);
    document
}

/// Residuals of a fit over the extent of its data.
fn share(document: &Value) -> f64 {
    let report = &document["report"];
    report["max_residual"].as_f64().unwrap() / report["extent"].as_f64().unwrap()
}

#[test]
fn too_few_points_say_how_many_are_needed() {
    refused("1,2\n", "", &["1 ", "degree 3", "4", "--degree"]);
    refused("1,2\n2,3\n4,4\n", "", &["3 ", "degree 3", "4", "--degree"]);
    refused(&wave(9), "--degree 9", &["9 ", "degree 9", "10"]);
    refused("1,2\n2,3\n4,1\n1,2\n", "--closed", &["3 ", "degree 3", "4"]);
    fitted(&wave(10), "--degree 9");
    fitted("1,2\n2,3\n", "--degree 1");
}

#[test]
fn repeated_points_are_named_and_dropped_or_merged_only_when_asked() {
    let content = "x,y\n0,0\n1,2\n1,2\n1,2\n3,3\n4,1\n6,0\n";
    refused(content, "", &["line 4 repeats line 3", "--duplicates drop", "--duplicates merge"]);
    let without = fitted("0,0\n1,2\n3,3\n4,1\n6,0\n", "");
    for policy in ["drop", "merge"] {
        let document = fitted(content, &format!("--duplicates {policy}"));
        assert_eq!(document["geometry"], without["geometry"]);
        assert_eq!(document["kept_points"], serde_json::json!([0, 1, 4, 5, 6]));
        let choices = document["report"]["choices"].to_string();
        assert!(choices.contains("2 of 7 points"), "{choices}");
    }
}

#[test]
fn equal_abscissae_are_repeated_points() {
    let content = "t,v\n0,0\n1,1\n1,3\n2,0\n3,1\n4,4\n";
    refused(content, "--abscissa t", &["line 4", "line 3", "--duplicates"]);
    let merged = fitted(content, "--abscissa t --duplicates merge");
    let mean = fitted("t,v\n0,0\n1,2\n2,0\n3,1\n4,4\n", "--abscissa t");
    assert_eq!(merged["geometry"], mean["geometry"]);
}

#[test]
fn points_that_are_all_equal_have_no_curve() {
    let content = "1,2\n".repeat(6);
    for options in ["", "--duplicates drop", "--duplicates merge", "--closed", "--degree 1"] {
        refused(&content, options, &["all 6 points are equal"]);
    }
}

#[test]
fn nan_and_infinities_are_refused_where_they_stand() {
    for word in ["nan", "NaN", "inf", "-inf", "Infinity", "1e999", "-1e400"] {
        let content = format!("x,y\n1,2\n2,3\n3,{word}\n4,5\n5,5\n");
        refused(&content, "", &["line 4", "column 2", "\"y\"", word]);
    }
}

#[test]
fn tiny_huge_and_far_away_coordinates_are_fitted_to_rounding() {
    let scaled = |factor: f64, shift: f64| -> String {
        table(&wave(12))
            .iter()
            .map(|p| format!("{:?},{:?}\n", shift + factor * p[0], shift + factor * p[1]))
            .collect()
    };
    for factor in [1e-300, 1e-150, 1e150, 1e300] {
        for options in ["", "--method pia", "--closed", "--degree 5 --parameters centripetal"] {
            let document = fitted(&scaled(factor, 0.0), options);
            assert!(share(&document) < 1e-11, "{factor} {options}: {}", share(&document));
        }
    }
    // A thousandth at a billion leaves four digits.
    let document = fitted(&scaled(1e-3, 1e9), "");
    assert!(document["report"]["max_residual"].as_f64().unwrap() < 2e-6);
}

#[test]
fn a_scaled_input_gives_the_scaled_curve() {
    let factor = 2.0_f64.powi(500);
    let huge: String = table(&wave(12))
        .iter()
        .map(|p| format!("{:?},{:?}\n", factor * p[0], factor * p[1]))
        .collect();
    let plain = points(&fitted(&wave(12), "")["geometry"]["control_points"]);
    let scaled: Vec<Vec<f64>> = points(&fitted(&huge, "")["geometry"]["control_points"])
        .iter()
        .map(|p| p.iter().map(|x| x / factor).collect())
        .collect();
    assert!(largest_distance(&plain, &scaled) < 1e-13);
}

#[test]
fn coordinates_beyond_what_doubles_hold_are_refused() {
    refused("1e308,0\n-1e308,1\n1e308,2\n-1e308,5\n", "", &["scale"]);
    refused("5e-324,0\n0,5e-324\n1e-323,0\n2e-323,5e-324\n", "", &["scale"]);
}

#[test]
fn a_spacing_of_a_million_to_one_is_fitted() {
    let content = "0,0\n1,0\n1.000001,0\n2,1\n3,1\n3.000001,1\n4,0\n5,1\n";
    for options in ["", "--closed", "--degree 5", "--degree 2", "--parameters centripetal"] {
        assert!(share(&fitted(content, options)) < 1e-11, "{options}");
    }
}

#[test]
fn a_method_that_cannot_finish_says_so_and_gives_finite_numbers() {
    let content = "0,0\n1,0\n1.000001,0\n2,1\n3,1\n3.000001,1\n4,0\n5,1\n";
    for method in ["pia", "weighted", "jacobi", "gauss-seidel", "sor", "chebyshev", "geometric"] {
        let place = Place::with("a.csv", content);
        let line = format!("curve a.csv --method {method} --iterations 300 -q -o a.json");
        let ran = place.run(&line);
        let report = &place.document("a.json")["report"];
        all_finite(&place.document("a.json"));
        let met = report["termination"] == "residual";
        assert_eq!(ran.code, Some(i32::from(!met)), "{method}");
        assert_eq!(ran.errors.contains("warning"), !met, "{method}: {}", ran.errors);
    }
}

#[test]
fn data_that_cross_themselves_are_no_trouble() {
    let eight: String = (0..40)
        .map(|i| {
            let a = std::f64::consts::TAU * f64::from(i) / 40.0;
            format!("{:?},{:?}\n", a.sin(), (2.0 * a).sin())
        })
        .collect();
    for options in ["", "--closed", "--closed --degree 5", "--method pia --closed"] {
        assert!(share(&fitted(&eight, options)) < 1e-11, "{options}");
    }
}

#[test]
fn collinear_and_constant_data_are_fitted() {
    let line: String = (0..9).map(|i| format!("{i},{}\n", 2 * i)).collect();
    assert!(share(&fitted(&line, "")) < 1e-12);
    fitted("5\n5\n5\n5\n5\n", "");
    fitted("t,v\n0,5\n1,5\n2,5\n3,5\n", "--abscissa t");
    let back_and_forth: String = (0..9).map(|i| format!("{},0\n", i % 2)).collect();
    fitted(&back_and_forth, "");
}

#[test]
fn lists_of_the_wrong_length_say_what_was_expected() {
    let place = Place::with("a.csv", wave(8));
    place.write("three.txt", "0 0.5 1\n");
    for (options, expected) in [
        ("--parameters three.txt", "8"),
        ("--knots three.txt", "12"),
        ("--method weighted --weight three.txt", "8"),
    ] {
        let ran = place.run(&format!("curve a.csv {options} -o a.json"));
        ran.code(2).says(&["a.csv", "3 ", expected]);
    }
    place.write("word.txt", "0 0.5 one\n");
    place.run("curve a.csv --knots word.txt").code(2).says(&["word.txt", "line 1", "\"one\""]);
    assert_eq!(place.names(), ["a.csv", "three.txt", "word.txt"]);
}

#[test]
fn parameters_and_knots_that_fall_are_refused() {
    let place = Place::with("a.csv", wave(5));
    place.write("falling.txt", "0 0.5 0.4 0.8 1\n");
    place.run("curve a.csv --parameters falling.txt").code(2).says(&["line 3", "0.4", "0.5"]);
    place.write("falling.txt", "0 0 0 0 0.5 1 1 1 0.9\n");
    place.run("curve a.csv --knots falling.txt").code(2).says(&["knot 8", "0.9"]);
    place.write("wrong.txt", "0 0 0.01 0.02 0.03 1 1\n");
    place.run("curve a.csv --degree 1 --knots wrong.txt").code(2).says(&[
        "a.csv",
        "line",
        "--knots averaged",
    ]);
}

#[test]
fn a_matrix_that_is_singular_is_said_to_be() {
    // Knots at the points, even degree, even number of equal steps: the alternating vector is lost.
    let square = "1,0\n0,1\n-1,0\n0,-1\n";
    let place = Place::with("a.csv", square);
    let ran = place.run("curve a.csv --closed --degree 2 --knots uniform --parameters uniform");
    match ran.code {
        Some(2) => drop(ran.says(&["singular"])),
        code => assert_eq!(code, Some(0)),
    }
}

#[test]
fn numbers_beyond_reason_on_the_command_line_are_met() {
    let place = Place::with("a.csv", wave(8));
    place.run("curve a.csv --iterations 18446744073709551615 -q").code(0);
    place.run("curve a.csv --degree 9223372036854775807").code(2).says(&["--degree"]);
    place.run("curve a.csv --keep 18446744073709551615 --json").code(0);
    place.run("curve a.csv --method preconditioned --bandwidth 18446744073709551615 -q").code(0);
    place.run("curve a.csv -o fit.json -q").code(0);
    place.run("evaluate fit.json --samples 18446744073709551615").code(2).says(&["--samples"]);
    place.run("evaluate fit.json --samples 0").code(2).says(&["--samples"]);
}

#[test]
fn lines_without_end_and_rows_without_number_are_met() {
    let wide: String = (0..3).map(|i| vec![format!("{i}"); 2000].join(",") + "\n").collect();
    let place = Place::with("a.csv", wide);
    assert!(matches!(place.run("curve a.csv --degree 1 -q").code, Some(0 | 2)));
    let place = Place::with("a.csv", "7".repeat(1_000_000));
    place.run("curve a.csv -q").code(2).says(&["a.csv", "line 1"]);
    let place = Place::with("a.csv", "(((((".repeat(10_000));
    place.run("curve a.csv -q").code(2).says(&["a.csv"]);
    let place = Place::with("a.json", "[".repeat(100_000));
    place.run("evaluate a.json --samples 2").code(2).says(&["a.json"]);
}

#[test]
fn derivatives_beyond_reason_are_refused() {
    let place = Place::with("a.csv", wave(8));
    place.run("curve a.csv -o fit.json -q").code(0);
    let ran = place.run("evaluate fit.json --samples 2 --derivatives 18446744073709551615");
    ran.code(2).says(&["--derivatives"]);
}

#[test]
fn samples_beyond_reason_are_refused_and_nothing_is_written() {
    let place = Place::with("a.csv", wave(8));
    let ran = place.run("curve a.csv -o fit.csv --samples 18446744073709551615");
    ran.code(2).says(&["--samples"]);
    assert_eq!(place.names(), ["a.csv"]);
}

#[test]
fn a_closed_curve_over_growing_steps_is_fitted() {
    let mut x = 0.0_f64;
    let mut growing = String::from("0,0\n");
    for i in 0..29 {
        x += 1.1_f64.powi(i);
        growing += &format!("{x:?},{:?}\n", x.ln_1p());
    }
    // Conditions of the matrices: 7e1, 4e3, 1e5.
    for degree in 2..=4 {
        let document = fitted(&growing, &format!("--closed --degree {degree}"));
        assert!(share(&document) < 1e-10, "degree {degree}");
    }
}

#[test]
fn a_picture_of_huge_coordinates_is_the_picture_of_small_ones_with_other_labels() {
    let curve = |factor: &str| {
        let content = format!(
            "1{factor},2{factor}\n2{factor},3{factor}\n3{factor},1{factor}\n4{factor},5{factor}\n"
        );
        let place = Place::with("a.csv", content);
        place.run("curve a.csv -o a.svg -q").code(0);
        let text = place.read("a.svg");
        let svg = roxmltree::Document::parse(&text).unwrap();
        let longest =
            svg.descendants().filter_map(|node| node.attribute("d")).max_by_key(|d| d.len());
        longest.unwrap().to_owned()
    };
    assert_eq!(curve("e300"), curve("e100"));
}

#[test]
fn a_policy_for_duplicates_covers_the_closing_point() {
    let content = "1,2\n4,1\n0,0\n7,7\n1,2\n1,2\n";
    let without = fitted("1,2\n4,1\n0,0\n7,7\n", "--closed");
    for policy in ["drop", "merge"] {
        let document = fitted(content, &format!("--closed --duplicates {policy}"));
        assert_eq!(document["geometry"], without["geometry"]);
    }
}

#[test]
fn the_input_is_never_overwritten() {
    let place = Place::with("a.csv", wave(8));
    for output in ["a.csv", "./a.csv"] {
        place.run(&format!("curve a.csv -o {output} -q")).code(2).says(&["a.csv"]);
        assert_eq!(place.read("a.csv"), wave(8));
    }
}

#[test]
fn two_outputs_into_one_file_are_refused() {
    let place = Place::with("a.csv", wave(8));
    place.run("curve a.csv -o fit.json -o ./fit.json").code(2).says(&["fit.json"]);
    place.run("curve a.csv -o fit.json --report fit.json").code(2).says(&["fit.json"]);
    assert_eq!(place.names(), ["a.csv"]);
}
