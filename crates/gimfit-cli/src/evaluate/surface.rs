//! Samples of a surface.

use super::{SampleCount, Samples, brought_back, check_inside};
use crate::arguments::EvaluateArguments;
use anyhow::{Context, bail, ensure};
use gimfit::Surface;
use gimfit_io::points::{ReadOptions, input_name, read_points};
use gimfit_io::table::{partials, write_surface_samples};
use std::io::{self, Write};
use std::path::Path;

pub(super) struct SurfaceSamples {
    pub(super) surface: Surface,
    pub(super) parameters: Places,
    /// Of the highest derivative.
    pub(super) order: usize,
    pub(super) names: Vec<String>,
}

/// Where a surface is sampled.
pub(super) enum Places {
    /// At all pairs of these.
    Grid([Vec<f64>; 2]),
    /// At these.
    List(Vec<[f64; 2]>),
}

impl Places {
    fn iter(&self) -> Box<dyn Iterator<Item = [f64; 2]> + '_> {
        match self {
            Self::Grid([u, v]) => {
                Box::new(u.iter().flat_map(move |&u| v.iter().map(move |&v| [u, v])))
            }
            Self::List(list) => Box::new(list.iter().copied()),
        }
    }
}

/// Most samples at a time, as for curves.
const MOST_SAMPLES: usize = 1_000_000_000;

pub(super) fn parameters(
    surface: &Surface,
    arguments: &EvaluateArguments,
) -> anyhow::Result<Places> {
    match arguments.samples {
        Some(SampleCount::Surface(m, n)) => {
            ensure!(
                m.checked_mul(n).is_some_and(|count| count <= MOST_SAMPLES),
                "--samples {m}x{n} are too many; at most 1e9 in all"
            );
            let [u, v] = surface.knots();
            return Ok(Places::Grid([u.equal_steps(m), v.equal_steps(n)]));
        }
        Some(SampleCount::Curve(count)) => bail!(
            "{} holds a surface, and --samples {count} is for curves; give the samples in u and \
             in v, such as {count}x{count}",
            input_name(&arguments.document)
        ),
        None => {}
    }
    let Some(path) = &arguments.at else { bail!("give --samples or --at") };
    pairs(surface, path).map(Places::List)
}

/// Pairs of parameters from a file of two columns.
fn pairs(surface: &Surface, path: &Path) -> anyhow::Result<Vec<[f64; 2]>> {
    let table = read_points(path, &ReadOptions::default())
        .with_context(|| format!("--at {}", path.display()))?;
    ensure!(
        table.dimension() == 2,
        "{}: rows of {} columns, where pairs u,v of parameters of the surface are wanted",
        table.source,
        table.dimension()
    );
    let (domain, periodic) = (surface.domain(), surface.is_periodic());
    let rows = table.coordinates.chunks_exact(2).enumerate();
    rows.map(|(index, pair)| {
        let mut parameters = [pair[0], pair[1]];
        for (k, t) in parameters.iter_mut().enumerate() {
            *t = brought_back(*t, domain[k], periodic[k]);
            let name = ["u", "v"][k];
            let which = || format!("{}: {name} of pair {}", table.source, index + 1);
            check_inside(*t, domain[k], which, &format!("surface in {name}"))?;
        }
        Ok(parameters)
    })
    .collect()
}

impl Samples for SurfaceSamples {
    fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        write_surface_samples(out, &self.surface, self.parameters.iter(), self.order, &self.names)
    }

    fn visit(&self, visit: &mut dyn FnMut(serde_json::Value) -> io::Result<()>) -> io::Result<()> {
        let (dimension, size) = (self.surface.dimension(), self.order + 1);
        let mut values = vec![0.0; size * size * dimension];
        for [u, v] in self.parameters.iter() {
            self.surface
                .derivatives_into(u, v, self.order, &mut values)
                .map_err(|error| io::Error::new(io::ErrorKind::InvalidInput, error))?;
            let derivatives: serde_json::Map<String, serde_json::Value> = partials(self.order)
                .skip(1)
                .map(|(a, b)| {
                    let name = "u".repeat(a) + &"v".repeat(b);
                    (name, values[(a * size + b) * dimension..][..dimension].into())
                })
                .collect();
            visit(serde_json::json!({
                "parameters": [u, v], "point": &values[..dimension], "derivatives": derivatives,
            }))?;
        }
        Ok(())
    }
}
