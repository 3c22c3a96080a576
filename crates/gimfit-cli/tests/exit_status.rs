//! How the program ends: 0 done, 1 a residual not met but a result written, 2 wrong usage or
//! input and nothing written.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

mod common;

use common::{Place, wave};

fn place() -> Place {
    Place::with("wave.csv", wave(30))
}

#[test]
fn a_fit_that_reaches_its_residual_is_done() {
    let place = place();
    let ran = place.run("curve wave.csv -o fit.json").code(0);
    assert_eq!(ran.errors, "");
    assert_eq!(place.document("fit.json")["report"]["termination"], "residual");
}

#[test]
fn all_iterations_asked_for_with_residual_0_are_done() {
    let place = place();
    place.run("curve wave.csv --method pia --residual 0 --iterations 7 -o fit.json").code(0);
    let report = &place.document("fit.json")["report"];
    assert_eq!(
        (report["termination"].as_str(), report["iterations"].as_u64()),
        (Some("iterations"), Some(7))
    );
    assert_eq!(report["history"].as_array().unwrap().len(), 8);
}

#[test]
fn a_residual_that_is_not_met_is_1_and_the_result_is_written_and_said() {
    let place = place();
    let line = "curve wave.csv --method pia --iterations 3 -o fit.json -o fit.csv -o fit.svg";
    place.run(line).code(1).says(&["warning", "was not reached", "3 iterations", "written"]);
    assert_eq!(place.document("fit.json")["report"]["termination"], "iterations");
    assert!(place.holds("fit.csv") && place.holds("fit.svg"));
}

#[test]
fn a_demanded_residual_below_rounding_is_1() {
    let place = place();
    place.run("curve wave.csv --residual 1e-30 -o fit.json").code(1);
    assert_eq!(place.document("fit.json")["report"]["termination"], "stalled");
}

#[test]
fn a_residual_that_is_met_exactly_where_asked_is_0() {
    let place = place();
    place.run("curve wave.csv --method pia --residual 1e-3 -o fit.json").code(0);
    let report = &place.document("fit.json")["report"];
    assert!(report["max_residual"].as_f64().unwrap() <= 1e-3);
    let before =
        &report["history"].as_array().unwrap()[report["iterations"].as_u64().unwrap() as usize - 1];
    assert!(before["max_residual"].as_f64().unwrap() > 1e-3, "the loop ran on");
}

#[test]
fn wrong_usage_is_2_and_writes_nothing() {
    for line in [
        "",
        "curve",
        "frobnicate",
        "curve wave.csv --frobnicate",
        "curve wave.csv --degree x",
        "curve wave.csv --degree 0",
        "curve wave.csv --degree 18446744073709551615",
        "curve wave.csv --residual -1",
        "curve wave.csv --residual nan",
        "curve wave.csv --method weighted --weight 2",
        "curve wave.csv --method weighted --weight -1",
        "curve wave.csv --method weighted --weight nan",
        "curve wave.csv --method pia --weight 1",
        "curve wave.csv --method magic",
        "curve wave.csv --knots no-such-rule",
        "curve wave.csv --parameters no-such-rule",
        "curve wave.csv --degree 4 --knots not-a-knot",
        "curve wave.csv --degree 2 --knots at-data",
        "curve wave.csv --closed --knots not-a-knot",
        "curve wave.csv --period 3",
        "curve wave.csv --geometry",
        "curve wave.csv --sort",
        "curve wave.csv --bandwidth 2",
        "curve wave.csv --samples 10",
        "curve wave.csv --keep 1,x",
        "curve wave.csv -o a.json -o a.json",
        "curve wave.csv --json -o -",
        "curve wave.csv -o fit",
        "curve wave.csv -o fit.xyz",
        "curve wave.csv -o none/fit.json",
        "info none.csv",
        "evaluate none.json --samples 3",
        "evaluate wave.csv --samples 3",
        "completions tcsh",
        "reproduce no-such-table",
    ] {
        let place = place();
        let ran = place.run(line).code(2);
        assert!(!ran.errors.is_empty() && ran.out.is_empty(), "{line}: {ran:?}");
        assert_eq!(place.names(), ["wave.csv"], "{line}");
    }
}

#[test]
fn help_and_version_are_results() {
    let place = place();
    for line in [
        "--help",
        "-h",
        "--version",
        "curve --help",
        "info --help",
        "evaluate --help",
        "help curve",
    ] {
        let ran = place.run(line).code(0);
        assert!(!ran.out.is_empty() && ran.errors.is_empty(), "{line}");
    }
    let help = place.run("curve --help").code(0).out;
    for line in ["curve --help", "evaluate --help"] {
        assert!(place.run(line).code(0).out.contains("130 interrupted"), "{line}");
    }
    let place_of = |part: &str| help.find(part).unwrap_or_else(|| panic!("no {part} in {help}"));
    let parts =
        ["\n  <POINTS>", "Reading:", "--columns", "Curve:", "Iteration:", "Writing:", "--output <"];
    let places = parts.map(place_of);
    assert!(places.is_sorted(), "{places:?} in {help}");
    for option in ["--degree", "--closed", "--keep", "--residual", "--abscissa", "--duplicates"] {
        assert!(help.contains(option), "{option}");
    }
}

#[test]
fn completions_and_manual_pages_are_made_for_every_command() {
    let place = place();
    for shell in ["bash", "zsh", "fish"] {
        let script = place.run(&format!("completions {shell}")).code(0).out;
        assert!(script.contains("gimfit") && script.contains("abscissa"), "{shell}");
    }
    place.run("manual pages").code(0);
    for page in ["gimfit.1", "gimfit-curve.1", "gimfit-info.1", "gimfit-evaluate.1"] {
        assert!(place.read(&format!("pages/{page}")).contains(".TH"), "{page}");
    }
}

#[cfg(unix)]
mod interrupts {
    use super::common::{Place, ran, wave};
    use std::fmt::Write;
    use std::process::{Child, Command, Stdio};
    use std::time::{Duration, Instant};

    fn interrupt(child: &Child) {
        let status = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
        assert!(status.success());
    }

    /// Waits until the program listens to interrupts: where the system shows it, until it catches
    /// them, and elsewhere for a time that is ample.
    fn wait_for_ears(child: &Child) {
        const INTERRUPT: u64 = 1 << 1;
        let status = std::path::PathBuf::from(format!("/proc/{}/status", child.id()));
        if !status.exists() {
            std::thread::sleep(Duration::from_secs(5));
            return;
        }
        wait_until("a handler of interrupts", || {
            let text = std::fs::read_to_string(&status).unwrap();
            let caught = text.lines().find_map(|line| line.strip_prefix("SigCgt:"));
            caught.is_some_and(|mask| u64::from_str_radix(mask.trim(), 16).unwrap() & INTERRUPT > 0)
        });
    }

    /// Waits until something holds; a run that never gets there fails the test.
    fn wait_until(what: &str, mut holds: impl FnMut() -> bool) {
        let begun = Instant::now();
        while !holds() {
            assert!(begun.elapsed() < Duration::from_secs(60), "waited in vain: {what}");
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    #[test]
    fn an_interrupted_fit_is_written_as_cancelled_and_ends_with_1() {
        let place = Place::new();
        let mut points = String::new();
        for i in 0..100_000 {
            let a = f64::from(i) * 0.01;
            writeln!(points, "{a},{}", a.sin()).unwrap();
        }
        place.write("long.csv", points);
        // The iterations alone would take hours; how long reading takes depends on the machine, and
        // an interrupt that comes so early ends the program with 130.
        let mut patience = Duration::from_millis(500);
        let ran = loop {
            let child = place
                .command(
                    "curve long.csv --method pia --residual 0 --iterations 1000000 -o fit.json \
                     --json",
                )
                .stdout(Stdio::piped())
                .stderr(Stdio::piped())
                .spawn()
                .unwrap();
            wait_for_ears(&child);
            std::thread::sleep(patience);
            interrupt(&child);
            let ran = ran(child.wait_with_output().unwrap());
            if ran.code != Some(130) {
                break ran;
            }
            assert!(!place.holds("fit.json") && patience < Duration::from_secs(60));
            patience *= 2;
        };
        let ran = ran.code(1).says(&["cancelled", "written"]);
        assert_eq!(ran.json()["report"]["termination"], "cancelled");
        let text = place.read("fit.json");
        assert!(text.contains("\"termination\":\"cancelled\"") && text.ends_with("}\n"));
        assert_eq!(place.names(), ["fit.json", "long.csv"]);
    }

    /// Once an interrupt of `edit` was not heeded.
    #[test]
    fn an_interrupted_edit_ends_with_130_and_writes_nothing() {
        let place = Place::new();
        let mut points = String::new();
        (0..200_000).for_each(|i| writeln!(points, "{i},{}", i % 7).unwrap());
        place.write("long.csv", points);
        let child = place
            .command("edit long.csv --move 5=4.5,1 -o e.json")
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        wait_for_ears(&child);
        std::thread::sleep(Duration::from_millis(300));
        interrupt(&child);
        let code = ran(child.wait_with_output().unwrap()).code;
        // On a machine so fast that it is done already there is nothing to interrupt.
        assert!(code == Some(130) || place.holds("e.json"), "{code:?}");
        assert!(code == Some(0) || !place.holds("e.json"), "{code:?}");
    }

    #[test]
    fn an_interrupt_while_reading_ends_at_once_with_130_and_leaves_the_old_file() {
        let place = Place::with("fit.json", "old");
        let mut child = place
            .command("curve - -o fit.json")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let input = child.stdin.take();
        wait_for_ears(&child);
        interrupt(&child);
        wait_until("the end of the program", || child.try_wait().unwrap().is_some());
        assert_eq!(ran(child.wait_with_output().unwrap()).code, Some(130));
        drop(input);
        assert_eq!(place.read("fit.json"), "old");
        assert_eq!(place.names(), ["fit.json"]);
    }

    #[test]
    fn an_interrupted_evaluation_leaves_the_old_file_and_no_other() {
        let place = Place::with("wave.csv", wave(20));
        place.run("curve wave.csv -o fit.json -q").code(0);
        place.write("samples.csv", "old");
        let child = place
            .command("evaluate fit.json --samples 20000000 -o samples.csv")
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        wait_until("the temporary file", || place.names().len() > 3);
        interrupt(&child);
        assert_ne!(ran(child.wait_with_output().unwrap()).code, Some(0));
        assert_eq!(place.read("samples.csv"), "old");
        assert_eq!(place.names(), ["fit.json", "samples.csv", "wave.csv"]);
    }

    #[test]
    fn a_second_interrupt_while_writing_leaves_the_old_files_and_no_other() {
        let place = Place::with("wave.csv", wave(20));
        place.write("samples.csv", "old");
        let mut child = place
            .command("curve wave.csv -o samples.csv --samples 20000000")
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        wait_until("the temporary file", || place.names().len() > 2);
        // The second is told from the first only once that has been taken.
        wait_until("the end of the program", || {
            interrupt(&child);
            std::thread::sleep(Duration::from_millis(100));
            child.try_wait().unwrap().is_some()
        });
        assert_eq!(ran(child.wait_with_output().unwrap()).code, Some(130));
        assert_eq!(place.read("samples.csv"), "old");
        assert_eq!(place.names(), ["samples.csv", "wave.csv"]);
    }

    #[test]
    fn no_part_of_a_file_stays_behind() {
        let place = Place::with("wave.csv", wave(50));
        place.run("curve wave.csv -o a.json -o a.csv -o a.svg --report a.txt").code(0);
        assert_eq!(place.names(), ["a.csv", "a.json", "a.svg", "a.txt", "wave.csv"]);
    }
}
