//! No input, however broken, stops the readers but by an error.

use proptest::prelude::*;

use super::{GridFormatChoice, GridLines, GridOptions, read_grid_from};
use crate::points::{ColumnChoice, DecimalMark, Delimiter};

const EXTENSIONS: [Option<&str>; 4] = [None, Some("csv"), Some("asc"), Some("npy")];

const VALID: [&[u8]; 9] = [
    b"row,column,x,y\n0,0,1,2\n0,1,3,4\n1,0,5,6\n1,1,7,8\n",
    b"u;v;z\n0;0;1,5\n0;0,5;2\n1;0;3\n1;0,5;4\n",
    b",0,1\n0,5,6 # c\n1,7,8\n",
    b"y\\x\t0\t1\r\n0\t5\t6\r\n1\t7\t8\r\n",
    b"1 2 3 4\n5 6 7 8\n",
    b"\"1\",2,3,4,\n5,6,7,8,\n",
    b"ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9\n1 2\n3 4\n",
    b"\x93NUMPY\x01\x00\x40\x00{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2, 1), }  \
      \x00\x00\x80\x3f\x00\x00\x00\x40",
    b"\x93NUMPY\x01\x00\x3d\x00{'descr': '|i1', 'fortran_order': True , 'shape': (2, 4), }  \
      abcdefgh",
];

fn every_way(bytes: &[u8]) {
    let plain = GridOptions::default();
    let busy = GridOptions {
        shape: Some((2, 2)),
        columns: Some(vec![ColumnChoice::Number(1)]),
        delimiter: Some(Delimiter::Comma),
        decimal: Some(DecimalMark::Comma),
        ..GridOptions::default()
    };
    let axes = GridOptions { axes: Some(true), ..GridOptions::default() };
    let pair = (ColumnChoice::Number(1), ColumnChoice::Number(2));
    let indexed = GridOptions { index_columns: Some(pair), ..GridOptions::default() };
    let with =
        |format, options: &GridOptions| GridOptions { format: Some(format), ..options.clone() };
    let all = [
        with(GridFormatChoice::Lines, &busy),
        with(GridFormatChoice::Matrix, &busy),
        with(GridFormatChoice::Matrix, &plain),
        with(GridFormatChoice::Matrix, &axes),
        with(GridFormatChoice::EsriAscii, &plain),
        with(GridFormatChoice::Npy, &plain),
        GridOptions { axes: Some(false), ..GridOptions::default() },
        plain,
        busy,
        axes,
        indexed,
    ];
    for options in all {
        for extension in EXTENSIONS {
            let Ok(grid) = read_grid_from(bytes, "f", extension, &options) else {
                continue;
            };
            assert!(grid.rows > 0 && grid.columns > 0);
            let points = grid.rows * grid.columns;
            assert_eq!(points * grid.dimension(), grid.coordinates.len());
            assert!(grid.coordinates.iter().all(|v| v.is_finite()));
            for (abscissae, count) in
                [(&grid.row_abscissae, grid.rows), (&grid.column_abscissae, grid.columns)]
            {
                if let Some(abscissae) = abscissae {
                    assert_eq!(abscissae.len(), count);
                    assert!(abscissae.iter().all(|v| v.is_finite()));
                }
            }
            match &grid.lines {
                GridLines::OfRows(lines) => assert_eq!(lines.len(), grid.rows),
                GridLines::OfPoints(lines) => assert_eq!(lines.len(), points),
                GridLines::Binary | GridLines::Unknown => {}
            }
        }
    }
}

#[test]
fn the_files_to_be_broken_are_read_while_whole() {
    for bytes in VALID {
        let grid = read_grid_from(bytes, "f", None, &GridOptions::default());
        assert!(grid.is_ok(), "{:?}", grid.map_err(|e| e.to_string()));
        every_way(bytes);
    }
}

#[test]
fn long_input_made_to_be_slow_is_still_read_in_one_pass() {
    let size = 200_000;
    let apart: String = (0..20_000).map(|at| format!("{at},{at},1\n")).collect();
    for text in [
        "\"#".repeat(size),
        "\",".repeat(size),
        ",".repeat(size),
        ",\n".repeat(size),
        "1,".repeat(size),
        "1\n".repeat(size),
        ",1\n1,\n".repeat(size / 4),
        "ncols 1\n".repeat(size),
        format!("u,v,x\n{apart}"),
        format!("i,j,x\n{apart}"),
        format!("i,j,x\n{}", "0,0,1\n".repeat(size)),
    ] {
        let _ = read_grid_from(text.as_bytes(), "f", None, &GridOptions::default());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn random_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        every_way(&bytes);
    }

    #[test]
    fn random_text_never_panics(
        text in "(u,v,|i,j,|ncols |nrows |xllcorner |cellsize |nan)?\
                 ([-+0-9.,;:# \t\r\n\"eEdDuvij]|é|[0-9],[0-9]\n){0,60}"
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
