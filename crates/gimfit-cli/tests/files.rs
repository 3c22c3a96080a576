//! Which files may be written: never one that is read, never one twice, and all of them or none.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

mod common;

use common::{Place, wave};

fn place() -> Place {
    let place = Place::with("a.csv", wave(8));
    place.write("list.csv", "0\n0.1\n0.2\n0.3\n0.4\n0.6\n0.8\n1\n");
    place.run("curve a.csv -o fit.json -q").code(0);
    place
}

#[test]
fn no_input_is_overwritten_under_any_name() {
    let place = place();
    let before = ["a.csv", "list.csv", "fit.json"].map(|name| place.read(name));
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("a.csv", place.path("link.csv")).unwrap();
        std::fs::hard_link(place.path("a.csv"), place.path("hard.csv")).unwrap();
        for line in
            ["curve a.csv -o link.csv", "curve link.csv -o a.csv", "curve a.csv -o hard.csv"]
        {
            place.run(line).code(2).says(&["is the file to be read"]);
        }
    }
    for line in [
        "curve a.csv --report a.csv",
        "curve a.csv --report ./a.csv",
        "curve a.csv --parameters list.csv -o list.csv",
        "curve a.csv --knots list.csv -o ./list.csv",
        "curve a.csv --method weighted --weight list.csv -o list.csv",
        "evaluate fit.json --samples 3 -o fit.json",
        "evaluate fit.json --at list.csv -o ./list.csv",
    ] {
        let ran = place.run(line).code(2).says(&["cannot write", "is the file to be read"]);
        assert_eq!(ran.out, "", "{line}");
    }
    assert_eq!(["a.csv", "list.csv", "fit.json"].map(|name| place.read(name)), before);
}

#[cfg(target_os = "linux")]
#[test]
fn the_file_behind_standard_input_is_an_input_too() {
    let place = place();
    let mut command = place.command("curve - -o a.csv");
    command.stdin(std::fs::File::open(place.path("a.csv")).unwrap());
    common::ran(command.output().unwrap()).code(2).says(&["a.csv", "is the file to be read"]);
    assert_eq!(place.read("a.csv"), wave(8));
}

#[cfg(target_os = "linux")]
#[test]
fn an_output_that_fails_leaves_the_old_files_of_all_others() {
    let place = place();
    place.write("old.csv", "old");
    // A device that is always full.
    std::os::unix::fs::symlink("/dev/full", place.path("full.svg")).unwrap();
    let ran = place.run("curve a.csv -o old.csv -o full.svg -o new.json").code(2);
    ran.says(&["full.svg", "space"]);
    assert_eq!(place.read("old.csv"), "old");
    assert_eq!(place.names(), ["a.csv", "fit.json", "full.svg", "list.csv", "old.csv"]);
}

#[cfg(unix)]
#[test]
fn a_link_to_a_file_that_is_not_there_is_followed() {
    let place = place();
    std::os::unix::fs::symlink("real.json", place.path("link.json")).unwrap();
    place.run("curve a.csv -o link.json -q").code(0);
    assert!(std::fs::symlink_metadata(place.path("link.json")).unwrap().is_symlink());
    assert_eq!(place.document("real.json")["format"], "gimfit");
    std::fs::remove_file(place.path("real.json")).unwrap();
    place.run("curve a.csv -o link.json -o real.json").code(2).says(&["one file"]);
}

#[test]
fn standard_output_is_an_output_of_every_kind() {
    let place = place();
    let table = place.run("evaluate fit.json --samples 3").code(0).out;
    assert_eq!(place.run("evaluate fit.json --samples 3 -o -").code(0).out, table);
    place.run("evaluate fit.json --samples 3 -o s.CSV").code(0);
    assert_eq!(place.read("s.CSV"), table);
    let report = place.run("curve a.csv -q --report -").code(0);
    assert!(report.out.contains("residual") && !place.holds("-"), "{}", report.out);
    for line in ["curve a.csv -o - --report -", "curve a.csv --json --report -"] {
        place.run(line).code(2).says(&["standard output"]);
    }
    place.run("curve a.csv -o /dev/null").code(2).says(&["- for standard output"]);
    place.run("evaluate fit.json --samples 3 -o s.svg").code(2).says(&["s.svg", ".csv", "- for"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_output_is_named() {
    let place = place();
    for line in ["curve a.csv", "curve a.csv -o -", "info a.csv", "evaluate fit.json --samples 9"] {
        let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
        let ran = place.command(line).stdout(full).stderr(std::process::Stdio::piped()).output();
        common::ran(ran.unwrap()).code(2).says(&["standard output", "No space"]);
    }
}
