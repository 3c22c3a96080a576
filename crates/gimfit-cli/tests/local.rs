//! `--only`, `--method local` and `--method adaptive`.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

mod common;

use common::{Place, testdata};

#[test]
fn chosen_points_are_met_and_the_worst_of_the_others_is_told() {
    let file = testdata("airfoils/sc20714.dat").display().to_string();
    let place = Place::new();
    let run = place.run(&format!("curve {file} --method local --only 40-60,70")).code(0);
    assert!(run.out.contains("22 of 205 iterate") && run.out.contains("left aside"), "{}", run.out);
    let found = place.run(&format!("curve {file} --only 40-60,70 --json -q")).code(0).json();
    let local = &found["report"]["local"];
    assert_eq!(local["points"], 22);
    assert!(local["outside_max_residual"].as_f64().unwrap() > 1e-4);
    let run = place.run(&format!("curve {file} --method adaptive --residual 1e-6 --json -q"));
    let moves = run.code(0).json()["report"]["moves"].clone();
    assert!(moves["saved"].as_u64().unwrap() > moves["made"].as_u64().unwrap());
}

#[test]
fn choices_that_make_no_sense_are_refused_by_name() {
    let file = testdata("airfoils/sc20714.dat").display().to_string();
    let grid = testdata("grids/mt_bruno.csv").display().to_string();
    let place = Place::new();
    for (rest, words) in [
        ("--method local", "needs --only"),
        ("--only 0", "count from 1"),
        ("--only 9-3", "swap them"),
        ("--only 206", "there are 205 points"),
        ("--only x", "neither a number"),
        ("--only 3 --tolerance 0.1", "--tolerance"),
        ("--only 3 --convex", "convexity"),
    ] {
        place.run(&format!("curve {file} {rest}")).code(2).says(&[words]);
    }
    for rest in ["--only 3", "--method local"] {
        place.run(&format!("surface {grid} {rest}")).code(2).says(&["for curves"]);
    }
}
