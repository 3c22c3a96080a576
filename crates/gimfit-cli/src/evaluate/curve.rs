//! Samples of a curve.

use super::{SampleCount, Samples, brought_back, check_inside};
use crate::arguments::EvaluateArguments;
use crate::input;
use anyhow::bail;
use gimfit::Curve;
use gimfit_io::points::input_name;
use gimfit_io::table::write_samples;
use std::io::{self, Write};

pub(super) struct CurveSamples {
    pub(super) curve: Curve,
    pub(super) parameters: Vec<f64>,
    /// Of the highest derivative.
    pub(super) order: usize,
    pub(super) names: Vec<String>,
}

pub(super) fn parameters(curve: &Curve, arguments: &EvaluateArguments) -> anyhow::Result<Vec<f64>> {
    match arguments.samples {
        Some(SampleCount::Curve(count)) => return Ok(curve.equal_steps(count)),
        Some(SampleCount::Surface(m, n)) => bail!(
            "{} holds a curve, and --samples {m}x{n} is for surfaces; give one number",
            input_name(&arguments.document)
        ),
        None => {}
    }
    let Some(path) = &arguments.at else { bail!("give --samples or --at") };
    let mut list = input::numbers(path, "--at", &[])?;
    for (index, t) in list.iter_mut().enumerate() {
        *t = brought_back(*t, curve.domain(), curve.is_periodic());
        let which = || format!("{}: number {}", input_name(path), index + 1);
        check_inside(*t, curve.domain(), which, "curve")?;
    }
    Ok(list)
}

impl Samples for CurveSamples {
    fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        write_samples(out, &self.curve, &self.parameters, self.order, &self.names)
    }

    fn visit(&self, visit: &mut dyn FnMut(serde_json::Value) -> io::Result<()>) -> io::Result<()> {
        let dimension = self.curve.dimension();
        let mut values = vec![0.0; (self.order + 1) * dimension];
        for &t in &self.parameters {
            self.curve
                .derivatives_into(t, self.order, &mut values)
                .map_err(|error| io::Error::new(io::ErrorKind::InvalidInput, error))?;
            let rows: Vec<&[f64]> = values.chunks_exact(dimension).collect();
            visit(serde_json::json!({
                "parameter": t, "point": rows[0], "derivatives": &rows[1..],
            }))?;
        }
        Ok(())
    }
}
