//! `gimfit evaluate`: samples of a fitted curve, surface or triangular patch.

mod curve;
mod surface;
mod triangle;

use crate::arguments::EvaluateArguments;
use crate::shape::{self, Fitted, Shape};
use crate::targets::{self, Kind};
use crate::{Ending, input, output, signal};
use anyhow::bail;
use gimfit_io::write::write_file;
use std::io::{self, Write};
use std::path::Path;

/// A number of samples, or one in u and one in v.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SampleCount {
    Curve(usize),
    Surface(usize, usize),
}

/// Samples that can be written in two forms.
trait Samples {
    fn csv(&self, out: &mut dyn Write) -> io::Result<()>;

    /// Each sample as JSON.
    fn visit(&self, visit: &mut dyn FnMut(serde_json::Value) -> io::Result<()>) -> io::Result<()>;
}

pub(crate) fn run(arguments: &EvaluateArguments) -> anyhow::Result<Ending> {
    let kind = check(arguments)?;
    signal::listen()?;
    let Fitted { shape, names } = shape::read(&arguments.document, arguments.iteration)?;
    let order = arguments.derivatives;
    let samples: Box<dyn Samples> = match shape {
        Shape::Curve(curve) => {
            let parameters = curve::parameters(&curve, arguments)?;
            Box::new(curve::CurveSamples { curve, parameters, order, names })
        }
        Shape::Surface(surface) => {
            let parameters = surface::parameters(&surface, arguments)?;
            Box::new(surface::SurfaceSamples { surface, parameters, order, names })
        }
        Shape::Triangle(patch) => {
            let places = triangle::places(&patch, arguments)?;
            Box::new(triangle::TriangleSamples { patch, places, names })
        }
    };
    match (kind, &arguments.output) {
        (Kind::Json, Some(path)) => write_file(path, |out| json(&*samples, out))?,
        (Kind::Csv, Some(path)) => write_file(path, |out| samples.csv(out))?,
        _ => output::stream(|out| samples.csv(out))?,
    }
    Ok(Ending::Done)
}

/// Refuses what cannot work before any work is done; tells what to write.
fn check(arguments: &EvaluateArguments) -> anyhow::Result<Kind> {
    let at = arguments.at.as_deref().map(|path| ("--at", path));
    let inputs: Vec<(&str, &Path)> =
        [("FILE", arguments.document.as_path())].into_iter().chain(at).collect();
    input::check_standard_input(&inputs)?;
    let paths: Vec<&Path> = inputs.iter().map(|(_, path)| *path).collect();
    let Some(output) = &arguments.output else { return Ok(Kind::StandardOutput) };
    targets::check(&[output.as_path()], &paths)?;
    targets::known_kind(output, &[(Kind::Csv, ".csv"), (Kind::Json, ".json")])
}

/// Brings a parameter of a closed direction into its domain; others are given back as they are.
fn brought_back(t: f64, (start, end): (f64, f64), periodic: bool) -> f64 {
    // A closed curve goes on for ever; only parameters outside the domain are brought back.
    if periodic && t.is_finite() && !(start..=end).contains(&t) {
        return (start + (t - start).rem_euclid(end - start)).clamp(start, end);
    }
    t
}

/// Refuses a parameter outside its domain; `which` and `whose` name it.
fn check_inside(
    t: f64,
    (start, end): (f64, f64),
    which: impl Fn() -> String,
    whose: &str,
) -> anyhow::Result<()> {
    if !(start..=end).contains(&t) {
        bail!("{} is {t}, outside the domain [{start}, {end}] of the {whose}", which());
    }
    Ok(())
}

/// All samples in one line.
fn json(samples: &dyn Samples, out: &mut dyn Write) -> io::Result<()> {
    out.write_all(b"{\"format\":\"gimfit-samples\",\"version\":1,\"samples\":[")?;
    let mut first = true;
    samples.visit(&mut |sample| {
        if !std::mem::take(&mut first) {
            out.write_all(b",")?;
        }
        serde_json::to_writer(&mut *out, &sample)?;
        Ok(())
    })?;
    out.write_all(b"]}\n")
}
