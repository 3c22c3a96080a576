//! `gimfit evaluate`: samples of a fitted curve.

use crate::arguments::EvaluateArguments;
use crate::targets::{self, Kind};
use crate::{Ending, input, output, signal};
use anyhow::bail;
use gimfit::Curve;
use gimfit_io::document::{Document, Geometry, read_document};
use gimfit_io::points::input_name;
use gimfit_io::table::write_samples;
use gimfit_io::write::write_file;
use std::path::Path;

pub(crate) fn run(arguments: &EvaluateArguments) -> anyhow::Result<Ending> {
    let kind = check(arguments)?;
    signal::listen()?;
    let document = read_document(&arguments.document)?;
    let curve = curve(&document, arguments)?;
    let parameters = parameters(&curve, arguments)?;
    let names = document.coordinate_names.clone().unwrap_or_default();
    let order = arguments.derivatives;
    match (kind, &arguments.output) {
        (Kind::Json, Some(path)) => {
            let text = json(&curve, &parameters, order)?;
            write_file(path, |out| out.write_all(text.as_bytes()))?;
        }
        (Kind::Csv, Some(path)) => {
            write_file(path, |out| write_samples(out, &curve, &parameters, order, &names))?;
        }
        _ => output::stream(|out| write_samples(out, &curve, &parameters, order, &names))?,
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

fn curve(document: &Document, arguments: &EvaluateArguments) -> anyhow::Result<Curve> {
    let name = input_name(&arguments.document);
    let Some(Geometry::Curve(geometry)) = &document.geometry else {
        bail!("{name} holds no curve; write one with gimfit curve POINTS -o FILE.json");
    };
    let Some(iteration) = arguments.iteration else { return Ok(geometry.curve()?) };
    let sequence = document.sequence.as_deref().unwrap_or_default();
    let Some(kept) = sequence.iter().find(|kept| kept.iteration == iteration) else {
        let known: Vec<String> = sequence.iter().map(|kept| kept.iteration.to_string()).collect();
        bail!(
            "{name} keeps no fit of iteration {iteration}; it keeps {}",
            if known.is_empty() { "none".into() } else { known.join(", ") }
        );
    };
    Ok(geometry.curve_with(&kept.control_points)?)
}

fn parameters(curve: &Curve, arguments: &EvaluateArguments) -> anyhow::Result<Vec<f64>> {
    if let Some(count) = arguments.samples {
        return Ok(curve.equal_steps(count));
    }
    let Some(path) = &arguments.at else { bail!("give --samples or --at") };
    let mut list = input::numbers(path, "--at", &[])?;
    let (start, end) = curve.domain();
    if curve.is_periodic() {
        // A closed curve goes on for ever; only parameters outside the domain are brought back.
        for t in list.iter_mut().filter(|t| t.is_finite() && !(start..=end).contains(*t)) {
            *t = (start + (*t - start).rem_euclid(end - start)).clamp(start, end);
        }
    }
    if let Some(index) = list.iter().position(|t| !(start..=end).contains(t)) {
        bail!(
            "{}: number {} is {}, outside the domain [{start}, {end}] of the curve",
            input_name(path),
            index + 1,
            list[index]
        );
    }
    Ok(list)
}

fn json(curve: &Curve, parameters: &[f64], order: usize) -> anyhow::Result<String> {
    let dimension = curve.dimension();
    let mut values = vec![0.0; (order + 1) * dimension];
    let mut samples = Vec::with_capacity(parameters.len());
    for &t in parameters {
        curve.derivatives_into(t, order, &mut values)?;
        let rows: Vec<&[f64]> = values.chunks_exact(dimension).collect();
        samples.push(serde_json::json!({
            "parameter": t, "point": rows[0], "derivatives": &rows[1..],
        }));
    }
    Ok(serde_json::json!({ "format": "gimfit-samples", "version": 1, "samples": samples })
        .to_string()
        + "\n")
}
