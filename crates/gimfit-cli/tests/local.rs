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
    for (rest, words) in [
        ("--method local", "needs --only"),
        ("--only 3", "in turns"),
        ("--only 3,4,5", "in turns"),
        ("--only 0,4", "count from 1"),
        ("--only 26,4", "there are 25 rows"),
        ("--only 1-3,20-25", "names column 25, but there are 24 columns"),
        ("--only 3,4 --method geometric", "foot points"),
        ("--only 1,1,2,2 --per-direction", "crossings"),
        ("--only 1,1,2,2 --method preconditioned", "no narrow band"),
        ("--only 3,4 --basis bernstein --method local", "--only"),
    ] {
        place.run(&format!("surface {grid} {rest}")).code(2).says(&[words]);
    }
}

#[test]
fn windows_of_a_grid_are_met_and_the_worst_of_the_others_is_told() {
    let grid = testdata("grids/mt_bruno.csv").display().to_string();
    let place = Place::new();
    let run = place.run(&format!("surface {grid} --method local --only 8-16,5-14")).code(0);
    assert!(run.out.contains("90 of 600 iterate, all crossings of 9 rows"), "{}", run.out);
    assert!(run.out.contains("run        local"), "{}", run.out);
    let worst = "points left aside 8.321e1 at row 16, column 19 (line 17)";
    assert!(run.out.contains(worst), "{}", run.out);
    for (rest, points) in [
        ("--only 8-16,5-14 --per-direction", 90),
        ("--only 8-16,5-14,2,3", 91),
        ("--only 8-16,5-14 --only 2,3", 91),
    ] {
        let found = place.run(&format!("surface {grid} {rest} --json -q")).code(0).json();
        let local = &found["report"]["local"];
        assert_eq!(local["points"], points);
        // Row 16 and column 19, from 0, row by row.
        assert_eq!(local["outside_max_residual_index"], 15 * 24 + 18);
    }
}
