//! Data sets: generated ones for the kernels, raw files for comparisons with other libraries.

use anyhow::{Context, ensure};
use gimfit_testkit::generate::Random;
use std::path::{Path, PathBuf};

pub use gimfit_testkit::generate::helix;

/// A noisy closed curve that winds round a torus, about 200 points a winding, with jittered steps;
/// flat rows of three coordinates.
#[must_use]
pub fn torus_winding(count: usize) -> Vec<f64> {
    let mut random = Random::new(11);
    let windings = (count as f64 / 200.0).round().max(2.0);
    let step = std::f64::consts::TAU / count as f64;
    let noise = 0.02 * step * windings;
    (0..count)
        .flat_map(|i| {
            let a = step * (i as f64 + 0.3 * (random.unit() - 0.5));
            let radius = 2.0 + (windings * a).cos();
            [
                radius * a.cos() + noise * random.signed(),
                radius * a.sin() + noise * random.signed(),
                (windings * a).sin() + noise * random.signed(),
            ]
        })
        .collect()
}

/// The folder of the raw files: `$BENCH_DATA`, or `bench-data` in the temporary folder.
#[must_use]
pub fn folder() -> PathBuf {
    match std::env::var_os("BENCH_DATA") {
        Some(folder) if !folder.is_empty() => folder.into(),
        _ => std::env::temp_dir().join("bench-data"),
    }
}

/// Reads `<name>.f64` of the folder: little-endian doubles and nothing else.
///
/// # Errors
/// If the file cannot be read or is no whole number of doubles.
pub fn read(name: &str) -> anyhow::Result<Vec<f64>> {
    let path = folder().join(format!("{name}.f64"));
    let bytes = std::fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let (doubles, rest) = bytes.as_chunks::<8>();
    ensure!(rest.is_empty(), "{} holds no whole number of doubles", path.display());
    Ok(doubles.iter().map(|&bytes| f64::from_le_bytes(bytes)).collect())
}

/// Writes doubles as [`read`] reads them.
///
/// # Errors
/// If the file cannot be written.
pub fn write(path: &Path, values: &[f64]) -> anyhow::Result<()> {
    let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
    std::fs::write(path, bytes).with_context(|| format!("cannot write {}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_winding_closes() {
        let points = torus_winding(1000);
        let distance = |a: usize, b: usize| -> f64 {
            (0..3).map(|i| (points[3 * a + i] - points[3 * b + i]).powi(2)).sum::<f64>().sqrt()
        };
        assert_eq!(points.len(), 3000);
        assert!(distance(999, 0) < 3.0 * distance(0, 1));
    }
}
