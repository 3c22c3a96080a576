use super::super::{PointFormat, PointTable, ReadError, ReadOptions, read_points_from};

/// A file as numpy.save writes it.
fn file(version: u8, descr: &str, fortran: bool, shape: &str, data: &[u8]) -> Vec<u8> {
    let fortran = if fortran { "True" } else { "False" };
    let header =
        format!("{{'descr': '{descr}', 'fortran_order': {fortran}, 'shape': {shape}, }}\n");
    let mut out = b"\x93NUMPY".to_vec();
    out.extend([version, 0]);
    if version == 1 {
        out.extend((header.len() as u16).to_le_bytes());
    } else {
        out.extend((header.len() as u32).to_le_bytes());
    }
    out.extend(header.bytes());
    out.extend(data);
    out
}

fn read(bytes: &[u8]) -> Result<PointTable, ReadError> {
    read_points_from(bytes, "a.npy", Some("npy"), &ReadOptions::default())
}

#[test]
fn every_kind_and_byte_order_gives_the_same_numbers() {
    macro_rules! check {
        ($t:ty, $name:literal) => {
            let values: [$t; 4] = [1 as $t, 2 as $t, 100 as $t, 7 as $t];
            let little: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
            let big: Vec<u8> = values.iter().flat_map(|v| v.to_be_bytes()).collect();
            for (order, data) in [("<", &little), (">", &big)] {
                let bytes = file(1, &format!("{order}{}", $name), false, "(2, 2)", data);
                let table = read(&bytes).unwrap();
                assert_eq!(table.coordinates, [1.0, 2.0, 100.0, 7.0], "{order}{}", $name);
            }
        };
    }
    check!(f32, "f4");
    check!(f64, "f8");
    check!(i8, "i1");
    check!(i16, "i2");
    check!(i32, "i4");
    check!(i64, "i8");
    check!(u8, "u1");
    check!(u16, "u2");
    check!(u32, "u4");
    check!(u64, "u8");
}

#[test]
fn negative_integers_keep_their_sign() {
    let table = read(&file(1, "|i1", false, "(2,)", &[0xff, 0x80])).unwrap();
    assert_eq!(table.coordinates, [-1.0, -128.0]);
    let data = (-3_i16).to_be_bytes();
    assert_eq!(read(&file(1, ">i2", false, "(1,)", &data)).unwrap().coordinates, [-3.0]);
}

#[test]
fn all_versions_and_both_orders_are_read() {
    let data: Vec<u8> = (0..6).flat_map(|v| f64::from(v).to_le_bytes()).collect();
    for version in [1, 2, 3] {
        let table = read(&file(version, "<f8", false, "(3, 2)", &data)).unwrap();
        assert_eq!(table.coordinates, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
        assert_eq!((table.format, table.dimension()), (PointFormat::Npy, 2));
        assert_eq!(table.row_name(2), "point 2 (counted from 0)");
    }
    let table = read(&file(1, "<f8", true, "(3, 2)", &data)).unwrap();
    assert_eq!(table.coordinates, [0.0, 3.0, 1.0, 4.0, 2.0, 5.0]);
    assert!(read(&file(4, "<f8", true, "(3, 2)", &data)).is_err());
}

#[test]
fn a_size_other_than_the_header_says_is_refused() {
    for (shape, data) in [
        ("(3,)", &[0_u8; 23][..]),
        ("(3,)", &[0; 25]),
        ("(18446744073709551615, 9999)", &[0; 8]),
        ("(1152921504606846976,)", &[]),
    ] {
        let error = read(&file(1, "<f8", false, shape, data)).unwrap_err().to_string();
        assert!(error.contains("bytes, but"), "{error}");
    }
    let mut bytes = file(2, "<f8", false, "(1,)", &[0; 8]);
    bytes[8..12].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(read(&bytes).unwrap_err().to_string().contains("within the header"));
}

#[test]
fn other_kinds_and_shapes_are_refused_with_a_way_out() {
    for (descr, shape, word) in [
        ("<c16", "(1,)", "astype"),
        ("|O", "(1,)", "astype"),
        ("<U4", "(1,)", "astype"),
        ("|b1", "(1,)", "astype"),
        ("<f2", "(1,)", "astype"),
        ("<f8", "(1, 2, 3)", "reshape"),
        ("<f8", "()", "reshape"),
        ("<f8", "(1, 0)", "no columns"),
        ("<f8", "(0,)", "no points"),
    ] {
        let error = read(&file(1, descr, false, shape, &[])).unwrap_err().to_string();
        assert!(error.contains(word), "{error}");
    }
}

#[test]
fn values_that_are_not_finite_are_named_by_row_and_column() {
    let data: Vec<u8> =
        [0.0, 1.0, 2.0, f64::NAN].iter().flat_map(|v: &f64| v.to_le_bytes()).collect();
    let error = read(&file(1, "<f8", false, "(2, 2)", &data)).unwrap_err().to_string();
    assert!(error.starts_with("a.npy, point 1 (counted from 0), column 2: NaN is not"), "{error}");
    let options =
        ReadOptions { columns: Some(vec!["1".parse().unwrap()]), ..ReadOptions::default() };
    let bytes = file(1, "<f8", false, "(2, 2)", &data);
    let table = read_points_from(&bytes, "a", None, &options).unwrap();
    assert_eq!(table.coordinates, [0.0, 2.0]);
}

#[test]
fn rounded_integers_and_wide_arrays_are_noted() {
    let data = ((1_u64 << 53) + 1).to_le_bytes();
    let table = read(&file(1, "<u8", false, "(1,)", &data)).unwrap();
    assert!(table.notes[0].contains("rounded"), "{:?}", table.notes);
    let table = read(&file(1, "|u1", false, "(2, 3)", &[0; 6])).unwrap();
    assert!(table.notes[0].contains("transpose"), "{:?}", table.notes);
}
