//! The command `gimfit reproduce` from outside: what it prints and how it ends.

#![allow(clippy::unwrap_used)]

use assert_cmd::Command;

fn run(arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gimfit"));
    let output = command.arg("reproduce").args(arguments).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

#[test]
fn every_table_agrees_and_the_summaries_say_so() {
    let (code, printed, errors) = run(&[]);
    assert_eq!((code, errors.as_str()), (0, ""), "{printed}");
    let summaries: Vec<&str> = printed.lines().filter(|line| line.contains(" agree, ")).collect();
    assert_eq!(
        summaries[0],
        "wang2007: 135 entries, 135 agree, 0 misprints in the paper, 0 disagree"
    );
    assert!(summaries.iter().all(|line| line.ends_with(" 0 disagree")), "{summaries:?}");
    assert!(printed.trim_end().ends_with(summaries[summaries.len() - 1]));
    assert!(!printed.contains("DISAGREES"));
}

#[test]
fn one_table_can_be_asked_for() {
    let (code, printed, _) = run(&["orsi2021"]);
    assert_eq!(code, 0);
    assert!(printed.starts_with("orsi2021: Orsi 2021") && !printed.contains("wang2007"));
    assert!(printed.contains("  k=10  2.30600e-3  0.002305999298"), "{printed}");
}

#[test]
fn entries_that_no_run_meets_are_told_with_what_comes_out() {
    let (code, printed, _) = run(&["chen2012"]);
    assert_eq!(code, 0, "{printed}");
    assert!(printed.contains("  k=10 P_8  1.170e-2    0.11490011     +1.0e-1  misprint"));
    assert!(printed.contains("  k=20  2.521e-3  0.0025302192     +9.2e-6  cannot be met"));
    let told =
        "chen2012: 67 entries, 11 agree, 54 cannot be met, 2 misprints in the paper, 0 disagree";
    assert!(printed.contains(told), "{printed}");
}

#[test]
fn tables_are_listed_one_a_line() {
    let (code, printed, _) = run(&["--list"]);
    assert_eq!(code, 0);
    let names: Vec<&str> =
        printed.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(
        names,
        [
            "wang2007",
            "functions2007",
            "lin2004",
            "chen2012",
            "lin2010",
            "orsi2021",
            "peng-li",
            "spectra",
            "bases"
        ]
    );
}

#[test]
fn an_unknown_table_is_an_error_that_lists_the_known_ones() {
    let (code, printed, errors) = run(&["wang2008"]);
    assert_eq!((code, printed.as_str()), (2, ""));
    assert!(errors.contains("wang2008") && errors.contains("wang2007, functions2007"), "{errors}");
}
