//! What messages say: the file, the place in it or the option, and what to do.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

mod common;

use common::{Place, wave};

#[test]
fn a_first_row_with_a_typing_error_is_not_dropped() {
    let place = Place::with("a.csv", "1,2O\n2,3\n3,5\n4,4\n5,5\n");
    for line in ["curve a.csv -o fit.json", "info a.csv", "curve a.csv --columns 1,2"] {
        let ran = place.run(line).code(2);
        ran.says(&["a.csv, line 1, column 2", "\"2O\" is not a number", "put #"]);
    }
    assert_eq!(place.names(), ["a.csv"]);
}

#[test]
fn the_advice_on_a_comma_that_may_group_works_as_it_stands() {
    let place = Place::with("a.csv", "x,y\n\"1,234\",\"5\"\n\"2,345\",\"6\"\n");
    let error = place.run("info a.csv").code(2).errors;
    let (_, advice) = error.trim().split_once("name the mark with ").unwrap();
    let facts = place.run(&format!("info a.csv --json {advice}")).code(0).json();
    assert_eq!(facts["lower_corner"], serde_json::json!([1.234, 5.0]));
}

#[test]
fn sorted_rows_keep_their_places_in_the_file() {
    let header = "{'descr': '|u1', 'fortran_order': False, 'shape': (5, 2), }\n";
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(u16::try_from(header.len()).unwrap().to_le_bytes());
    bytes.extend(header.bytes());
    bytes.extend([9, 1, 3, 2, 7, 3, 1, 4, 9, 5]);
    let place = Place::with("a.npy", bytes);
    let ran = place.run("curve a.npy --abscissa 1 --sort").code(2);
    ran.says(&["point 4 (counted from 0) repeats", "point 0 (counted from 0)"]);
}

#[test]
fn a_fault_in_a_list_of_parameters_names_the_list_and_the_place_in_it() {
    let place = Place::with("a.csv", wave(6));
    place.write("list.txt", "0 1 2 3 4 5 5.5\n");
    let closed = "curve a.csv --closed --parameters list.txt -q";
    place.run(closed).code(0);
    place.write("list.txt", "0 1 2 3 4 5 4.5\n");
    place.run(closed).code(2).says(&["list.txt: number 7 is 4.5", "the closing point of a.csv"]);
    place.write("list.txt", "0 1 2 1.5 4 5\n");
    let ran = place.run("curve a.csv --parameters list.txt").code(2);
    ran.says(&["list.txt: number 4 is 1.5", "line 4 of a.csv"]);
}

#[test]
fn numbers_too_far_apart_are_named_by_file_and_column() {
    let place = Place::with("a.csv", "t,far\n0,1e308\n1,-1e308\n2,1e308\n3,0\n");
    for line in ["info a.csv", "curve a.csv"] {
        place.run(line).code(2).says(&["a.csv", "column \"far\"", "scale"]);
    }
    let ran = place.run("curve a.csv --abscissa t --closed --period 1").code(2);
    ran.says(&["a.csv: --period 1 is too short"]);
}

#[test]
fn standard_input_is_read_once() {
    let place = Place::with("a.csv", wave(6));
    for line in ["curve - --parameters -", "curve - --knots -", "evaluate - --at -"] {
        let ran = place.run_with_input(line, "1 2\n").code(2);
        ran.says(&["standard input can be read only once", line.split(' ').nth(2).unwrap()]);
    }
}

#[test]
fn a_misspelt_rule_is_told_the_rules() {
    let place = Place::with("a.csv", wave(6));
    let ran = place.run("curve a.csv --parameters chrod").code(2);
    ran.says(&[
        "--parameters",
        "chord, centripetal, uniform, chord-ratio",
        "chrod",
        "no such file",
    ]);
    let ran = place.run("curve a.csv --knots avraged").code(2);
    ran.says(&["--knots", "averaged, not-a-knot, at-data, uniform", "avraged"]);
    place.run("curve a.csv --method weighted --weight best").code(2).says(&["auto", "best"]);
}

#[test]
fn numbers_that_vanish_or_overflow_are_refused() {
    let place = Place::with("a.csv", wave(6));
    place.run("curve a.csv --residual 1e-400").code(2).says(&["--residual", "too small"]);
    place.run("curve a.csv --residual 1e400").code(2).says(&["--residual", "finite"]);
    let ran = place.run("curve a.csv --method weighted --weight 1e-400").code(2);
    ran.says(&["--weight", "too small"]);
    place.run("curve a.csv --residual 0e-400 --method pia --iterations 3 -q").code(0);
}

#[test]
fn counts_beyond_reason_name_their_option() {
    let place = Place::with("a.csv", wave(8));
    place.run("curve a.csv -o fit.json -q").code(0);
    let ran = place.run("curve a.csv -o a2.csv --samples 1000000000000").code(2);
    ran.says(&["--samples", "1000000000"]);
    let ran = place.run("evaluate fit.json --samples 2 --derivatives 1000000000").code(2);
    ran.says(&["--derivatives", "25", "zero"]);
    place.run("evaluate fit.json --samples 2 --derivatives 25").code(0);
}

#[test]
fn kept_fits_that_no_memory_holds_are_refused() {
    let place = Place::with("a.csv", wave(100_001));
    let keep: Vec<String> = (0..5000).map(|i| i.to_string()).collect();
    let line = format!("curve a.csv --method pia --iterations 5000 --keep {}", keep.join(","));
    place.run(&line).code(2).says(&["a.csv", "--keep", "5000 fits of 200002 coordinates"]);
}

#[test]
fn commands_of_terminals_in_files_and_names_are_not_sent() {
    let place = Place::with("a\u{1b}[7m.csv", "x\u{1b}[31m,y\u{9b}m\n0,0\n1,1\n2,0\n3,1\n");
    for line in [
        "curve a\u{1b}[7m.csv",
        "curve a\u{1b}[7m.csv --degree 7",
        "curve a\u{1b}[7m.csv --columns z",
        "info a\u{1b}[7m.csv",
        "curve a\u{1b}[7m.csv --method pia --iterations 1 --report r.txt",
    ] {
        let ran = place.run(line);
        let said = ran.out + &ran.errors;
        assert!(!said.contains(['\u{1b}', '\u{9b}']) && said.contains("\\u{1b}[7m"), "{said}");
    }
    assert!(!place.read("r.txt").contains('\u{1b}'));
    let ran = place.run("curve x a\u{9b}7m.csv").code(2);
    assert!(ran.errors.contains("a\\u{9b}7m.csv"), "{}", ran.errors);
    place.run("curve a\u{1b}[7m.csv -o fit.csv -q").code(0);
    assert!(place.read("fit.csv").starts_with("x\u{1b}[31m,"), "data go out as they are");
}

#[test]
fn json_that_is_no_document_is_said_to_be_json() {
    let place = Place::with("a.json", "[1,2]");
    for line in ["curve a.json", "info a.json"] {
        place.run(line).code(2).says(&["a.json", "JSON"]);
    }
}

#[test]
fn one_point_is_one_point() {
    let place = Place::with("a.csv", "1,2\n");
    place.run("curve a.csv").code(2).says(&["1 distinct point is too few"]);
}

#[test]
fn a_picture_over_an_abscissa_names_it() {
    let place = Place::with("a.csv", "depth,v\n0,1\n1,3\n2,0\n4,-1\n5,0.5\n");
    place.run("curve a.csv --abscissa depth -o a.svg -q").code(0);
    assert!(place.read("a.svg").contains(">depth<"));
}

#[test]
fn points_where_a_document_is_wanted_are_told_apart() {
    let place = Place::with("a.csv", "x,y\n1,2\n3,4\n5,5\n6,1\n");
    place
        .run("evaluate a.csv --samples 3")
        .code(2)
        .says(&["is no gimfit document", "gimfit curve"]);
}

#[test]
fn a_shape_that_forbids_the_residual_is_told_with_what_to_do() {
    let corner = "x,y\n0,3\n0,2\n0.05,1\n0.2,0.2\n1,0.05\n2,0\n3,0.0001\n4,0.01\n";
    let place = Place::with("corner.csv", corner);
    let ran = place.run("curve corner.csv --convex -o fit.json").code(1);
    ran.says(&["ended by constrained", "without --convex"]);
    let report = place.document("fit.json")["report"].clone();
    assert_eq!(report["termination"], "constrained");
    let shape = serde_json::json!(
        {
            "left": 6,
            "right": 0,
            "straight": 0,
            "control_left": 6,
            "control_right": 0,
            "inserted_knots": 0,
            "kept": true
        }
    );
    assert_eq!(report["shape"], shape);
    let ran = place.run("curve corner.csv --convex=published").code(1);
    ran.says(&["ended by stalled", "try --convex"]);
    assert!(place.fit("corner.csv")["report"].get("shape").is_none());
    place.run("curve corner.csv --convex --convex-threshold 1").code(2).says(&["=published"]);
    place
        .run("curve corner.csv --convex=published --convex-threshold 0")
        .code(2)
        .says(&["above 0"]);
    place.run("curve corner.csv --convex --method sor").code(2).says(&["its own steps"]);
    place.run("surface corner.csv --convex").code(2).says(&["--convex", "gimfit curve"]);
    place.write("space.csv", "x,y,z\n0,0,0\n1,2,0\n2,1,1\n3,5,1\n4,0,2\n");
    place.run("curve space.csv --convex").code(2).says(&["this dimension", "in the plane"]);
}
