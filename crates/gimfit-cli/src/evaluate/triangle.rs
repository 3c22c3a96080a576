//! Samples of a triangular patch.

use super::{SampleCount, Samples};
use crate::arguments::EvaluateArguments;
use crate::triangle::{Sample, samples, write_samples};
use crate::{input, values};
use anyhow::{bail, ensure};
use gimfit::geometry::TriangularPatch;
use gimfit_io::points::input_name;
use std::io::{self, Write};

pub(super) struct TriangleSamples {
    pub(super) patch: TriangularPatch,
    pub(super) places: Vec<Sample>,
    pub(super) names: Vec<String>,
}

/// Places along each edge, or pairs u, v of a file.
pub(super) fn places(
    patch: &TriangularPatch,
    arguments: &EvaluateArguments,
) -> anyhow::Result<Vec<Sample>> {
    let name = input_name(&arguments.document);
    ensure!(
        arguments.derivatives == 0,
        "--derivatives is for curves and surfaces; {name} holds a triangular patch"
    );
    match arguments.samples {
        Some(SampleCount::Curve(count)) => {
            ensure!(
                (2..=values::MOST_TRIANGLE_SAMPLES).contains(&count),
                "--samples of a triangular patch counts those along each edge: from 2 to {}",
                values::MOST_TRIANGLE_SAMPLES
            );
            return Ok(samples(count).collect());
        }
        Some(SampleCount::Surface(m, n)) => bail!(
            "{name} holds a triangular patch, and --samples {m}x{n} is for surfaces; give one number"
        ),
        None => {}
    }
    let Some(path) = &arguments.at else { bail!("give --samples or --at") };
    let list = input::numbers(path, "--at", &[])?;
    ensure!(
        list.len().is_multiple_of(2),
        "{}: {} numbers are no pairs of u and v",
        input_name(path),
        list.len()
    );
    let places: Vec<Sample> = list.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
    for (index, &[u, v]) in places.iter().enumerate() {
        if let Err(error) = patch.evaluate(u, v) {
            bail!("{}: pair {}: {error}", input_name(path), index + 1);
        }
    }
    Ok(places)
}

impl Samples for TriangleSamples {
    fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        write_samples(out, &self.patch, &self.places, &self.names)
    }

    fn visit(&self, visit: &mut dyn FnMut(serde_json::Value) -> io::Result<()>) -> io::Result<()> {
        for &[u, v] in &self.places {
            let point = self
                .patch
                .evaluate(u, v)
                .map_err(|error| io::Error::new(io::ErrorKind::InvalidInput, error))?;
            visit(serde_json::json!({ "parameter": [u, v], "point": point, "derivatives": [] }))?;
        }
        Ok(())
    }
}
