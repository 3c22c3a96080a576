//! `gimfit evaluate`: samples of a fitted curve.

use crate::arguments::EvaluateArguments;
use crate::{Ending, input};
use anyhow::{Context, bail, ensure};
use gimfit::Curve;
use gimfit_io::document::{Document, Geometry, parse_document, read_document};
use gimfit_io::table::write_samples;
use gimfit_io::write::write_file;
use std::io::{Read, Write};
use std::path::Path;

pub(crate) fn run(arguments: &EvaluateArguments) -> anyhow::Result<Ending> {
    let document = document(&arguments.document)?;
    let curve = curve(&document, arguments)?;
    let parameters = parameters(&curve, arguments)?;
    let names = document.coordinate_names.clone().unwrap_or_default();
    let order = arguments.derivatives;
    match &arguments.output {
        None => {
            let mut out = std::io::BufWriter::new(std::io::stdout().lock());
            write_samples(&mut out, &curve, &parameters, order, &names)?;
            out.flush()?;
        }
        Some(path) => match path.extension().and_then(|ending| ending.to_str()) {
            Some("csv") => {
                write_file(path, |out| write_samples(out, &curve, &parameters, order, &names))?;
            }
            Some("json") => {
                let text = json(&curve, &parameters, order)?;
                write_file(path, |out| out.write_all(text.as_bytes()))?;
            }
            _ => bail!("cannot write {}: use .csv or .json", path.display()),
        },
    }
    Ok(Ending::Done)
}

fn document(path: &Path) -> anyhow::Result<Document> {
    if path.as_os_str() != "-" {
        return Ok(read_document(path)?);
    }
    let mut bytes = Vec::new();
    std::io::stdin().lock().read_to_end(&mut bytes).context("cannot read standard input")?;
    Ok(parse_document(&bytes, "standard input")?)
}

fn curve(document: &Document, arguments: &EvaluateArguments) -> anyhow::Result<Curve> {
    let name = arguments.document.display();
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

/// Most samples at equal steps: beyond, the table would not fit into memory.
const MOST_SAMPLES: usize = 1_000_000_000;

fn parameters(curve: &Curve, arguments: &EvaluateArguments) -> anyhow::Result<Vec<f64>> {
    if let Some(count) = arguments.samples {
        ensure!((1..=MOST_SAMPLES).contains(&count), "--samples must lie between 1 and 1e9");
        return Ok(curve.equal_steps(count));
    }
    let Some(path) = &arguments.at else { bail!("give --samples or --at") };
    let mut list = input::numbers(path, "--at")?;
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
            path.display(),
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
