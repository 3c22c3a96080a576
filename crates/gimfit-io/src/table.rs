//! CSV tables of control points and of samples.

use gimfit::Curve;
use std::io::{self, Write};

/// Writes the stored control points, a row each, under the names of the coordinates.
///
/// # Errors
/// What the writer says.
pub fn write_control_points(
    out: &mut dyn Write,
    curve: &Curve,
    names: &[String],
) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record(coordinate_names(curve, names))?;
    for point in curve.control_points().iter() {
        table.write_record(point.iter().map(|x| format!("{x:?}")))?;
    }
    table.flush()
}

/// Writes points and derivatives up to `order` at parameters, a row each: `t`, the coordinates,
/// then `d1 x`, `d1 y`, ..., `d2 x`, ...
///
/// # Errors
/// What the writer says; [`io::ErrorKind::InvalidInput`] for a parameter outside the domain.
pub fn write_samples(
    out: &mut dyn Write,
    curve: &Curve,
    parameters: &[f64],
    order: usize,
    names: &[String],
) -> io::Result<()> {
    let names = coordinate_names(curve, names);
    let mut table = csv::Writer::from_writer(out);
    let derived = (1..=order).flat_map(|k| names.iter().map(move |name| format!("d{k} {name}")));
    table.write_record(std::iter::once("t".to_owned()).chain(names.clone()).chain(derived))?;
    let mut values = vec![0.0; (order + 1) * curve.dimension()];
    for &t in parameters {
        curve
            .derivatives_into(t, order, &mut values)
            .map_err(|error| io::Error::new(io::ErrorKind::InvalidInput, error))?;
        table.write_record(std::iter::once(&t).chain(&values).map(|x| format!("{x:?}")))?;
    }
    table.flush()
}

fn coordinate_names(curve: &Curve, names: &[String]) -> Vec<String> {
    let dimension = curve.dimension();
    if names.len() == dimension {
        return names.to_vec();
    }
    (1..=dimension).map(|i| format!("x{i}")).collect()
}
