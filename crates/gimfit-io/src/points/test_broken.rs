//! No input, however broken, stops the readers but by an error.

use proptest::prelude::*;

use super::{
    ColumnChoice, DecimalMark, Delimiter, FormatChoice, PartChoice, ReadOptions, number_list,
    read_points_from,
};

const EXTENSIONS: [Option<&str>; 6] =
    [None, Some("csv"), Some("dat"), Some("xyz"), Some("gpx"), Some("npy")];

const VALID: [&[u8]; 7] = [
    b"# a\nx,y,z\n1,2,3\n4.5,-6e3,7 # b\n\"8\",\"9\",10\n",
    b"a;b\n1,5;2,25\n3;4\n",
    b"1\t2\r\n3\t4\r\n",
    b"NACA 2412\n 3. 3.\n\n0. 0.\n.5 .1\n1. .01\n\n0. 0.\n.5 -.05\n1. -.01\n",
    b"CLARK Y\n1 0\n.5 .1\n0 0\n.5 -.1\n1 0\n",
    b"<gpx><trk><name>n</name><trkseg><trkpt lat='1' lon='2'><ele>3</ele></trkpt>\
      <trkpt lat='2' lon='3'/></trkseg></trk><wpt lat='0' lon='0'/></gpx>",
    b"\x93NUMPY\x01\x00\x3d\x00{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2), }  \
      \x00\x00\x80\x3f\x00\x00\x00\x40",
];

fn every_way(bytes: &[u8]) {
    let defaults = ReadOptions::default();
    for extension in EXTENSIONS {
        if let Ok(table) = read_points_from(bytes, "f", extension, &defaults) {
            assert_eq!(table.rows() * table.dimension(), table.coordinates.len());
            assert!(table.rows() > 0);
            assert!(table.coordinates.iter().all(|v| v.is_finite()));
            if let Some(lines) = &table.row_lines {
                assert_eq!(lines.len(), table.rows());
            }
        }
    }
    let busy = ReadOptions {
        format: Some(FormatChoice::Text),
        columns: Some(vec![ColumnChoice::Number(1)]),
        abscissa: Some(ColumnChoice::Number(2)),
        delimiter: Some(Delimiter::Semicolon),
        decimal: Some(DecimalMark::Comma),
        part: Some(PartChoice::All),
        skip_missing: true,
    };
    for format in [FormatChoice::Text, FormatChoice::Airfoil, FormatChoice::Gpx] {
        let options = ReadOptions { format: Some(format), ..busy.clone() };
        if let Ok(table) = read_points_from(bytes, "f", None, &options) {
            assert_eq!(table.abscissa.map(|a| a.len()), Some(table.coordinates.len()));
        }
    }
    if let Ok(numbers) = number_list::read(bytes, "f") {
        assert!(!numbers.is_empty() && numbers.iter().all(|v| v.is_finite()));
    }
}

#[test]
fn the_files_to_be_broken_are_read_while_whole() {
    for bytes in VALID {
        let table = read_points_from(bytes, "f", None, &ReadOptions::default());
        assert!(table.is_ok(), "{:?}", table.map_err(|e| e.to_string()));
    }
}

#[test]
fn long_input_made_to_be_slow_is_still_read_in_one_pass() {
    let size = 300_000;
    for text in [
        "\"#".repeat(size),
        "\"".repeat(size),
        "\",".repeat(size),
        ",".repeat(size),
        ";\n".repeat(size),
        "# \n".repeat(size),
        "9".repeat(size),
        "9d".repeat(size),
        "1,5 ".repeat(size),
        "\n".repeat(size),
        "1\n\"2\"\n".repeat(size / 4),
        "<a>".repeat(size),
        format!("<gpx{}>", " a=''".repeat(size)),
        format!("<gpx>{}", "<!--".repeat(size)),
    ] {
        let _ = read_points_from(text.as_bytes(), "f", None, &ReadOptions::default());
        let _ = number_list::read(text.as_bytes(), "f");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn random_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        every_way(&bytes);
    }

    #[test]
    fn random_text_never_panics(
        text in "([-+0-9.,;:# \t\r\n\"eEdxynaif<>/='%!]|é|\u{feff}|<trkpt|lat=|<gpx>|</){0,120}"
    ) {
        every_way(text.as_bytes());
    }

    #[test]
    fn mutated_files_never_panic(
        which in 0..VALID.len(),
        changes in prop::collection::vec(
            (any::<prop::sample::Index>(), any::<u8>(), 0..4_u8), 1..6),
    ) {
        let mut bytes = VALID[which].to_vec();
        for (at, byte, kind) in changes {
            if bytes.is_empty() {
                break;
            }
            let at = at.index(bytes.len());
            match kind {
                0 => bytes[at] = byte,
                1 => { bytes.remove(at); }
                2 => bytes.insert(at, byte),
                _ => bytes.truncate(at),
            }
        }
        every_way(&bytes);
    }
}
