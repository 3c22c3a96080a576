//! Laws of the readers of text.

use proptest::prelude::*;

use super::{
    ColumnChoice, DecimalMark, Delimiter, PointFormat, PointTable, ReadError, ReadOptions,
    read_points_from,
};

fn read(text: &str) -> Result<PointTable, ReadError> {
    read_with(text, &ReadOptions::default())
}

fn read_with(text: &str, options: &ReadOptions) -> Result<PointTable, ReadError> {
    read_points_from(text.as_bytes(), "f.csv", Some("csv"), options)
}

fn fault(text: &str) -> String {
    read(text).unwrap_err().to_string()
}

fn asked(columns: &[&str], abscissa: Option<&str>) -> ReadOptions {
    ReadOptions {
        columns: (!columns.is_empty())
            .then(|| columns.iter().map(|c| c.parse().unwrap()).collect()),
        abscissa: abscissa.map(|a| a.parse().unwrap()),
        ..ReadOptions::default()
    }
}

#[test]
fn a_header_names_the_columns_and_x_y_z_are_preferred() {
    let table = read("t,Y,label,X\n1,2,a,3\n4,5,b,6\n").unwrap();
    assert_eq!(table.column_names, ["X", "Y"]);
    assert_eq!(table.coordinates, [3.0, 2.0, 6.0, 5.0]);
    assert!(table.notes.iter().any(|n| n.contains("left out: t, label")), "{:?}", table.notes);
    let table = read("x,z\n1,2\n").unwrap();
    assert_eq!(table.column_names, ["x", "z"]);
    let table = read("1,2,3\n").unwrap();
    assert_eq!(table.column_names, ["column 1", "column 2", "column 3"]);
    assert_eq!((table.format, table.row_name(0).as_str()), (PointFormat::Csv, "line 1"));
}

#[test]
fn columns_and_abscissa_follow_the_choice() {
    let text = "t,x,y,label\n0,1,2,a\n1,3,4,b\n";
    let table = read_with(text, &asked(&["y", "1"], None)).unwrap();
    assert_eq!(table.coordinates, [2.0, 0.0, 4.0, 1.0]);
    let table = read_with(text, &asked(&[], Some("T"))).unwrap();
    assert_eq!(table.abscissa, Some(vec![0.0, 1.0]));
    assert_eq!(table.abscissa_name.as_deref(), Some("t"));
    assert_eq!(table.column_names, ["x", "y"]);
    let table = read_with(text, &asked(&[], Some("x"))).unwrap();
    assert_eq!(table.column_names, ["y"]);
    let table = read_with("t,a,b,n\n0,1,2,p\n1,3,4,q\n", &asked(&[], Some("t"))).unwrap();
    assert_eq!(table.column_names, ["a", "b"]);
    let error = read_with(text, &asked(&["w"], None)).unwrap_err().to_string();
    assert_eq!(error, "f.csv: there is no column \"w\"; the columns are t, x, y, label");
}

#[test]
fn comments_blank_lines_and_line_ends_do_not_shift_line_numbers() {
    for end in ["\n", "\r\n", "\r"] {
        let text = ["# a", "", "x,y", "% b", "1,2 # c", "", "// d", "3,4", "! e", "5,6"].join(end);
        let table = read(&text).unwrap();
        assert_eq!(table.row_lines, Some(vec![5, 8, 10]), "{end:?}");
        assert!(table.notes.iter().any(|n| n.contains("4 comment lines")), "{:?}", table.notes);
        assert!(table.notes.iter().any(|n| n.contains("1 blank line between")));
    }
}

#[test]
fn faults_name_line_column_and_way_out() {
    assert_eq!(
        fault("lon,lat\n1,2\n3,n/a\n"),
        "f.csv, line 3, column 2 (\"lat\"): \"n/a\" is not a number; remove the row or choose \
         other columns with --columns"
    );
    assert_eq!(
        fault("lon,time,lat\n1,a,2\n3,b,4\n"),
        "f.csv, line 2, column 2 (\"time\"): \"a\" is not a number; choose the columns of numbers \
         with --columns lon,lat"
    );
    assert_eq!(
        fault("x,y\n1,\n2,3\n"),
        "f.csv, line 2, column 2 (\"y\"): the cell is empty; fill it in, remove the row or \
         choose other columns with --columns"
    );
    assert_eq!(
        fault("1,2\n3\n"),
        "f.csv, line 2: there is 1 cell, but line 1 has 2; correct or remove the row"
    );
    assert!(fault("x,y\n1,2,3\n").contains("there are 3 cells, but line 1, the header, has 2"));
    assert!(fault("1,nan\n").contains("line 1, column 2: nan is not a finite number"));
    assert!(fault("1,1e999\n").contains("too large"));
    assert!(fault("# a\n\n").contains("no points"));
    assert!(fault("x,y\n").contains("only line 1, a header"));
}

#[test]
fn a_missing_value_in_the_first_row_makes_no_header() {
    assert!(fault("n/a,1,2\n3,4,5\n").starts_with("f.csv, line 1, column 1: \"n/a\""));
    assert!(fault(",1,2\n3,4,5\n").starts_with("f.csv, line 1, column 1: the cell is empty"));
    assert!(fault("2020-01-02,1\n2020-01-03,2\n").contains("with --columns 2"));
    let labelled = read_with("A,1\nB,2\n", &asked(&["2"], None)).unwrap();
    assert_eq!(labelled.coordinates, [1.0, 2.0]);
}

#[test]
fn a_first_row_of_text_and_numbers_is_a_header_only_by_a_name_asked_for() {
    for text in ["1,2O\n2,3\n3,5\n", "1,abc\n2,3\n", "name,2019\n1,2\n", "1,2O\n"] {
        let error = fault(text);
        assert!(error.starts_with("f.csv, line 1, column "), "{error}");
        assert!(error.contains("is not a number") && error.contains("put # before"), "{error}");
    }
    assert!(fault("1,2O\n2,3\n").contains("column 2: \"2O\""));
    assert!(read_with("1,2O\n2,3\n", &asked(&["1", "2"], None)).is_err());
    for options in [asked(&["name", "2"], None), asked(&[], Some("Name"))] {
        let years = read_with("name,2019\n1,2\n", &options).unwrap();
        assert!(years.notes.iter().any(|n| n.contains("although it holds numbers")));
    }
    assert!(read("#name,2019\n1,2\n").is_ok());
}

#[test]
fn the_advice_on_a_doubtful_comma_works() {
    for text in ["x,y\n\"1,234\",\"5\"\n", "1,234 5,678\n2,345 6,789\n", "\"1,234\",5\n"] {
        let error = fault(text);
        let (_, advice) = error.split_once("name the mark with ").unwrap();
        let mut options = ReadOptions::default();
        let words: Vec<&str> = advice.split(' ').collect();
        for pair in words.chunks(2) {
            match pair[0] {
                "--decimal" => options.decimal = Some(pair[1].parse().unwrap()),
                _ => options.delimiter = Some(pair[1].parse().unwrap()),
            }
        }
        assert_eq!(read_with(text, &options).unwrap().coordinates[0], 1.234, "{text:?}");
    }
}

#[test]
fn a_separator_after_every_row_is_an_end() {
    for text in ["1,2,\n3,4,\n", "x,y\n1,2,\n3,4,\n", "x,y,\n1,2,\n3,4,\n", "x,y,\n1,2\n3,4\n"] {
        let table = read(text).unwrap();
        assert_eq!(table.coordinates, [1.0, 2.0, 3.0, 4.0], "{text:?}");
        assert!(table.notes.iter().any(|n| n.contains("separator")), "{text:?}");
    }
    assert!(fault("1,2,\n3,4,5\n").starts_with("f.csv, line 1, column 3: the cell is empty"));
    assert!(fault("1,2\n3,4,\n").contains("there are 3 cells"));
}

#[test]
fn decimal_comma_is_read_only_where_it_is_unambiguous() {
    for text in [
        "1,5;2,25\n3;4\n",
        "1,5 2,25\n3 4\n",
        "1,5\t2,25\n3\t4\n",
        "\"1,5\",\"2,25\"\n3,4\n",
        "x;y\n1,5;2,25\n3;4\n",
    ] {
        let table = read(text).unwrap();
        assert_eq!(table.coordinates, [1.5, 2.25, 3.0, 4.0], "{text:?}");
        assert!(table.notes.iter().any(|n| n.contains("decimal mark")), "{text:?}");
    }
    assert_eq!(read("1,234;5,678\n").unwrap().coordinates, [1.234, 5.678]);
    assert_eq!(read("0,123 1,456\n2 3\n").unwrap().coordinates[0], 0.123);
    for text in
        ["1,234 5,678\n2,345 6,789\n", "1,5;2.5\n", "1,2,3;4\n", "1.234,5;6\n", "\"1,234\",5\n"]
    {
        assert!(fault(text).contains("more than one way"), "{text:?}: {}", fault(text));
    }
    let named = ReadOptions { decimal: Some(DecimalMark::Comma), ..ReadOptions::default() };
    assert_eq!(read_with("1,234 5,678\n", &named).unwrap().coordinates, [1.234, 5.678]);
    assert!(read_with("1.5;2\n", &named).is_err());
    let plain = ReadOptions { decimal: Some(DecimalMark::Point), ..ReadOptions::default() };
    assert!(read_with("1,5;2\n", &plain).is_err());
}

#[test]
fn a_comma_in_a_column_left_out_is_no_decimal_mark() {
    let table = read_with("a;x;y\nb, c;1.5;2\n", &asked(&[], None)).unwrap();
    assert_eq!(table.coordinates, [1.5, 2.0]);
}

#[test]
fn quoted_cells_are_read_with_their_lines() {
    let text = "# \"one\n\"name, or \"\"so\"\"\nmore\",x, \"y\"\n\n\"a, b\",\"1\",2\nc,3,4 # \"\n";
    let table = read(text).unwrap();
    assert_eq!(table.coordinates, [1.0, 2.0, 3.0, 4.0]);
    assert_eq!(table.row_lines, Some(vec![5, 6]));
    let spaced = read_points_from(b"\"x\" \"y\"\n\"1\" 2\n", "f", None, &ReadOptions::default());
    assert_eq!(spaced.unwrap().column_names, ["x", "y"]);
    assert!(fault("x,y\n1,\"2\n3,4\n").starts_with("f.csv, line 2: the quotation mark"));
    assert!(fault("x,y\n1,\"2\"3\n").starts_with("f.csv, line 2: text follows"));
    let nickname = read_with("n,x\na \"b\" c,1\nd,2\n", &asked(&["x"], None)).unwrap();
    assert_eq!(nickname.coordinates, [1.0, 2.0]);
    assert!(fault("x,y\r\"1\",2\r\r\"3\",z\r").starts_with("f.csv, line 4, column 2"));
}

#[test]
fn an_xyz_file_gives_its_first_three_columns() {
    let bytes = b"1 2 3 255 0 0\n4 5 6 0 255 0\n";
    let table = read_points_from(bytes, "f", Some("xyz"), &ReadOptions::default()).unwrap();
    assert_eq!(table.format, PointFormat::Xyz);
    assert_eq!(table.coordinates, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    assert!(table.notes.iter().any(|n| n.contains("left out: column 4")));
}

#[test]
fn numbers_that_vanish_are_noted() {
    let table = read("1e-400,0.0\n").unwrap();
    assert_eq!(table.coordinates, [0.0, 0.0]);
    assert!(table.notes.iter().any(|n| n.starts_with("1 number too small")));
}

#[test]
fn a_title_over_blank_separated_numbers_is_explained() {
    let error = read_points_from(b"my own data\n1 2\n", "f", None, &ReadOptions::default());
    assert!(error.unwrap_err().to_string().contains("put # before line 1"));
}

#[test]
fn too_many_columns_are_refused() {
    assert!(fault(&"1,".repeat(20_000)).contains("more than 10000"));
}

#[test]
fn a_separator_asked_for_is_used() {
    let options = ReadOptions {
        delimiter: Some(Delimiter::Semicolon),
        columns: Some(vec![ColumnChoice::Number(2)]),
        ..ReadOptions::default()
    };
    assert_eq!(read_with("1,2;3\n4,5;6\n", &options).unwrap().coordinates, [3.0, 6.0]);
}

proptest! {
    #[test]
    fn numbers_written_as_text_come_back_bit_by_bit(
        rows in prop::collection::vec(
            prop::collection::vec(
                any::<f64>().prop_filter("finite", |v| v.is_finite()), 3), 1..20),
        separator in prop::sample::select(vec![",", ";", "\t", " ", ", ", "  ", "\t ", " ; "]),
        end in prop::sample::select(vec!["\n", "\r\n", "\r"]),
        exponent in any::<bool>(),
        header in any::<bool>(),
        comma in any::<bool>(),
        quoted in any::<bool>(),
    ) {
        // A decimal comma between commas would be two cells.
        let comma = comma && separator.contains(';');
        let mut text = String::new();
        if header {
            text.push_str(&["a", "b", "c"].join(separator));
            text.push_str(end);
        }
        for row in &rows {
            let cells: Vec<String> = row
                .iter()
                .map(|v| if exponent { format!("{v:e}") } else { format!("{v}") })
                .map(|cell| if comma { cell.replace('.', ",") } else { cell })
                .map(|cell| if quoted { format!("\"{cell}\"") } else { cell })
                .collect();
            text.push_str(&cells.join(separator));
            text.push_str(end);
        }
        let table = read_points_from(text.as_bytes(), "f", Some("txt"), &ReadOptions::default())
            .map_err(|e| TestCaseError::fail(e.to_string()))?;
        let expected: Vec<u64> = rows.iter().flatten().map(|v| v.to_bits()).collect();
        let got: Vec<u64> = table.coordinates.iter().map(|v| v.to_bits()).collect();
        prop_assert_eq!(got, expected);
    }
}

#[test]
fn rows_without_a_value_are_left_out_where_that_is_asked_for() {
    let text = "t,x,y,label\n0,1,2,a\n1,,3,b\n2,4,NaN,\n3,N/A,1,c\n4,5,6,\n";
    let skip = ReadOptions {
        abscissa: Some("t".parse().unwrap()),
        columns: Some(vec!["x".parse().unwrap(), "y".parse().unwrap()]),
        skip_missing: true,
        ..ReadOptions::default()
    };
    let read = |text: &str, options: &ReadOptions| {
        read_points_from(text.as_bytes(), "f.csv", Some("csv"), options)
    };
    let table = read(text, &skip).unwrap();
    assert_eq!(table.coordinates, [1.0, 2.0, 5.0, 6.0]);
    assert_eq!(table.abscissa, Some(vec![0.0, 4.0]));
    assert_eq!((table.row_name(0), table.row_name(1)), ("line 2".into(), "line 6".into()));
    let note = "3 rows without a value left out: line 3, line 4, line 5.";
    assert!(table.notes.iter().any(|found| found == note), "{:?}", table.notes);
    assert_eq!(table.for_rows(vec![9.0, 8.0, 7.0, 6.0, 5.0]), vec![9.0, 5.0]);
    assert_eq!(table.for_rows(vec![9.0, 8.0]), [9.0, 8.0]);
    // What is wrong rather than missing is refused still, and so is a file of nothing.
    assert!(
        read("x,y\n1,oops\n", &ReadOptions { skip_missing: true, ..Default::default() }).is_err()
    );
    let none = read("x,y\n1,\n,2\n", &ReadOptions { skip_missing: true, ..Default::default() });
    assert!(none.unwrap_err().to_string().contains("every row lacks a value"));
    assert!(read(text, &ReadOptions { skip_missing: false, ..skip }).is_err());
}
