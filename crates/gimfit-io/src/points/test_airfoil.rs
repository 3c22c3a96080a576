use super::super::{
    FormatChoice, PointFormat, PointTable, ReadError, ReadOptions, read_points_from,
};

fn read(text: &str) -> Result<PointTable, ReadError> {
    read_points_from(text.as_bytes(), "wing.dat", Some("dat"), &ReadOptions::default())
}

const SELIG: &str = " CLARK Y\n 1.0000 0.0\n0.5 .1\n 0.0 0.0\n0.5 -.05\n1.0 -.001\n";
const LEDNICER: &str = "NACA 2412\n 3. 3.\n\n0. 0.\n.5 .1\n1. .01\n\n0. 0.\n.5 -.05\n1. -.01\n";

#[test]
fn selig_files_are_read_as_they_stand() {
    let table = read(SELIG).unwrap();
    assert_eq!(table.format, PointFormat::AirfoilSelig);
    assert_eq!(table.title.as_deref(), Some("CLARK Y"));
    assert_eq!(table.coordinates, [1.0, 0.0, 0.5, 0.1, 0.0, 0.0, 0.5, -0.05, 1.0, -0.001]);
    assert_eq!(table.row_name(1), "line 3");
    assert_eq!(table.column_names, ["x", "y"]);
}

#[test]
fn lednicer_files_become_one_loop_with_the_nose_once() {
    let table = read(LEDNICER).unwrap();
    assert_eq!(table.format, PointFormat::AirfoilLednicer);
    assert_eq!(table.coordinates, [1.0, 0.01, 0.5, 0.1, 0.0, 0.0, 0.5, -0.05, 1.0, -0.01]);
    assert_eq!(table.row_lines, Some(vec![6, 5, 4, 9, 10]));
    assert!(table.notes.iter().any(|n| n.contains("kept once")));
}

#[test]
fn two_different_nose_points_are_both_kept() {
    let table = read(&LEDNICER.replace("\n\n0. 0.\n.5 -", "\n\n0. -0.001\n.5 -")).unwrap();
    assert_eq!(table.rows(), 6);
    assert!(!table.notes.iter().any(|n| n.contains("kept once")));
}

#[test]
fn counts_that_do_not_fit_are_refused() {
    let error = read(&LEDNICER.replace("3. 3.", "3. 4.")).unwrap_err();
    assert!(error.to_string().starts_with("wing.dat, line 2: the two counts"), "{error}");
    let error = read(&LEDNICER.replace("\n.5 .1\n1. .01\n", "\n-.5 .1\n-1. .01\n")).unwrap_err();
    assert!(error.to_string().contains("the upper side"), "{error}");
}

#[test]
fn plain_numbers_in_a_dat_file_are_a_table() {
    let table = read("1 0\n0.5 .1\n0 0\n.5 -.1\n1 0\n").unwrap();
    assert_eq!(table.format, PointFormat::Whitespace);
    let table = read("x y\n1 0\n0.5 .1\n0 0\n.5 -.1\n1 0\n").unwrap();
    assert_eq!((table.format, table.rows()), (PointFormat::Whitespace, 5));
    let table = read("time value\n1 0\n2 .1\n3 0\n4 -.1\n5 0\n").unwrap();
    assert_eq!(table.column_names, ["time", "value"]);
}

#[test]
fn a_bad_row_in_an_airfoil_is_named() {
    let text = "RAE 2822 AIRFOIL\n1 0\n.5 .1\n.2 .1\n.1 .1\n0 O.1\n";
    let error = read(text).unwrap_err().to_string();
    assert!(error.starts_with("wing.dat, line 6, column 2 (\"y\"): \"O.1\""), "{error}");
    let error = read(&text.replace("0 O.1", "0 0 0")).unwrap_err().to_string();
    assert!(error.contains("line 6: there are 3 cells"), "{error}");
}

#[test]
fn a_title_over_an_open_curve_is_an_airfoil_only_when_asked() {
    let text = "measured by hand today\n0 0\n1 1\n2 4\n";
    let error = read(text).unwrap_err().to_string();
    assert!(error.contains("--format airfoil"), "{error}");
    let options = ReadOptions { format: Some(FormatChoice::Airfoil), ..ReadOptions::default() };
    let table = read_points_from(text.as_bytes(), "f", None, &options).unwrap();
    assert_eq!(table.rows(), 3);
    assert!(read_points_from(b"name\n", "f", None, &options).is_err());
}

#[test]
fn a_latin_1_name_is_read_and_noted() {
    let bytes = [b"Profil f\xfcr alle\n" as &[u8], &SELIG.as_bytes()[9..]].concat();
    let table = read_points_from(&bytes, "f.dat", Some("dat"), &ReadOptions::default()).unwrap();
    assert_eq!(table.title.as_deref(), Some("Profil f\u{fc}r alle"));
    assert!(table.notes[0].contains("Latin-1"));
}
