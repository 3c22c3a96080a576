//! The program between other programs: standard output holds results and nothing else.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

mod common;

use common::{Place, points, ran, testdata, wave};
use std::process::Stdio;

fn place() -> Place {
    Place::with("wave.csv", wave(40))
}

#[test]
fn json_is_all_that_standard_output_holds_and_it_has_no_geometry_unless_asked() {
    let place = place();
    let brief = place.run("curve wave.csv --json --keep 0,2 -o fit.json").code(0);
    assert_eq!((brief.errors.as_str(), brief.out.lines().count()), ("", 1));
    let brief = brief.json();
    assert_eq!((brief["format"].as_str(), brief["version"].as_u64()), (Some("gimfit"), Some(1)));
    for left_out in ["geometry", "parameters", "sequence"] {
        assert!(brief.get(left_out).is_none(), "{left_out}");
    }
    let full = place.run("curve wave.csv --json --geometry --keep 0,2").code(0).json();
    for part in ["geometry", "parameters", "sequence"] {
        assert_eq!(full[part], place.document("fit.json")[part], "{part}");
    }
}

#[test]
fn a_dash_as_output_writes_the_document_and_nothing_else() {
    let place = place();
    let ran = place.run("curve wave.csv -o -").code(0);
    assert_eq!(ran.json()["geometry"]["degree"], 3);
    assert!(ran.errors.contains("residual"), "the report goes to standard error: {}", ran.errors);
    let quiet = place.run("curve wave.csv -o - -q").code(0);
    assert_eq!(quiet.errors, "");
    assert_eq!(quiet.json()["geometry"], ran.json()["geometry"]);
}

#[test]
fn a_warning_leaves_piped_json_alone() {
    let ran = place().run("curve wave.csv --json --method pia --iterations 1").code(1);
    assert_eq!(ran.json()["report"]["termination"], "iterations");
    assert!(ran.errors.contains("warning"));
}

#[test]
fn quiet_prints_nothing() {
    let place = place();
    let ran = place.run("curve wave.csv --quiet -o fit.json -o fit.svg --report fit.txt").code(0);
    assert_eq!((ran.out.as_str(), ran.errors.as_str()), ("", ""));
    assert!(place.read("fit.txt").contains("residual"));
}

#[test]
fn no_progress_bar_and_no_escape_codes_where_no_terminal_listens() {
    let place = place();
    let ran = place.run("curve wave.csv --method pia --residual 0 --iterations 60000").code(0);
    assert!(!ran.out.contains('\u{1b}') && !ran.errors.contains('\u{1b}'));
    assert_eq!(ran.errors, "");
}

#[test]
fn a_dash_as_input_is_standard_input() {
    let place = place();
    let file = place.fit("wave.csv");
    let piped = place.run_with_input("curve - --json --geometry", wave(40)).code(0).json();
    assert_eq!(piped["geometry"], file["geometry"]);
    assert_eq!(piped["report"]["source"], "standard input");
    let told = place.run_with_input("info -", wave(40)).code(0).out;
    assert!(told.contains("standard input") && told.contains("40"), "{told}");
}

#[test]
fn every_text_format_is_recognised_on_standard_input() {
    let place = Place::new();
    for (name, dimension) in
        [("airfoils/rae2822.dat", 2), ("gpx/Mojstrovka.gpx", 2), ("mocap/WRIST.csv", 3)]
    {
        let bytes = std::fs::read(testdata(name)).unwrap();
        let json = place.run_with_input("info - --json", bytes).code(0).json();
        assert_eq!(json["dimension"], dimension, "{name}");
    }
}

#[test]
fn a_fit_flows_through_a_pipe_into_evaluate() {
    let place = place();
    let document = place.run("curve wave.csv -o - -q").code(0).out;
    let samples = place.run_with_input("evaluate - --samples 5", document).code(0);
    assert_eq!((samples.out.lines().count(), samples.errors.as_str()), (6, ""));
}

#[test]
fn parameters_to_evaluate_at_come_from_standard_input() {
    let place = place();
    place.run("curve wave.csv -o fit.json -q").code(0);
    let samples = place.run_with_input("evaluate fit.json --at -", "0\n0.5\n1\n").code(0);
    assert_eq!(samples.out.lines().count(), 4);
}

#[test]
fn an_empty_standard_input_is_an_error_that_names_it() {
    for line in ["curve -", "info -", "evaluate - --samples 2"] {
        Place::new().run(line).code(2).says(&["standard input"]);
    }
}

#[test]
fn a_reader_that_goes_away_is_met_quietly() {
    let place = Place::with("wave.csv", wave(3000));
    place.run("curve wave.csv -o fit.json -q").code(0);
    for line in [
        "curve wave.csv --json --geometry",
        "curve wave.csv -o - -q",
        "info wave.csv",
        "curve --help",
        "completions bash",
    ] {
        let mut command = place.command(line);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let ran = ran(child.wait_with_output().unwrap());
        assert_eq!((ran.code, ran.errors.as_str()), (Some(0), ""), "{line}");
    }
}

#[test]
fn a_reader_of_samples_that_goes_away_is_met_quietly() {
    let place = place();
    place.run("curve wave.csv -o fit.json -q").code(0);
    let mut command = place.command("evaluate fit.json --samples 20000");
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let ran = ran(child.wait_with_output().unwrap());
    assert_eq!((ran.code, ran.errors.as_str()), (Some(0), ""));
}

#[test]
fn piped_numbers_round_trip() {
    let place = place();
    let document = place.run("curve wave.csv -o - -q").code(0).json();
    place.run("curve wave.csv -o fit.csv -q").code(0);
    let table = common::table(place.read("fit.csv").split_once('\n').unwrap().1);
    assert_eq!(table, points(&document["geometry"]["control_points"]));
}
