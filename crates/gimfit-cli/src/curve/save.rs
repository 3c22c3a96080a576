//! Files of a fit, by their endings.

use super::{Job, draw};
use crate::arguments::CurveArguments;
use crate::output;
use anyhow::{Context, bail, ensure};
use gimfit_io::document::Document;
use gimfit_io::table::{write_control_points, write_samples};
use gimfit_io::write::write_file;
use std::io::{self, Write};
use std::path::Path;
use std::time::Instant;

/// What an output file holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Document,
    StandardOutput,
    Table,
    Svg,
    Png,
}

fn kind(path: &Path) -> anyhow::Result<Kind> {
    if path.as_os_str() == "-" {
        return Ok(Kind::StandardOutput);
    }
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
    Ok(match ending.as_deref() {
        Some("json") => Kind::Document,
        Some("csv") => Kind::Table,
        Some("svg") => Kind::Svg,
        Some("png") => Kind::Png,
        _ => bail!(
            "cannot tell from its ending what to write into {}; use .json, .csv, .svg or .png",
            path.display()
        ),
    })
}

/// Refuses outputs that cannot work, before any work is done.
pub(super) fn check(arguments: &CurveArguments) -> anyhow::Result<()> {
    let mut standard = usize::from(arguments.json);
    for (index, path) in arguments.output.iter().enumerate() {
        standard += usize::from(kind(path)? == Kind::StandardOutput);
        ensure!(
            !arguments.output[..index].contains(path),
            "{} is given twice as an output",
            path.display()
        );
    }
    ensure!(standard <= 1, "--json and -o - both write to standard output; use one of them");
    ensure!(
        arguments.samples.is_none() || has_table(arguments),
        "--samples belongs to an output that ends in .csv"
    );
    ensure!(arguments.samples.is_none_or(|n| n >= 2), "--samples must be at least 2");
    for path in arguments.output.iter().chain(&arguments.report) {
        if path.as_os_str() == "-" {
            continue;
        }
        ensure!(!path.is_dir(), "cannot write {}: it is a folder", path.display());
        let folder = match path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        ensure!(
            folder.is_dir(),
            "cannot write {}: there is no folder {}",
            path.display(),
            folder.display()
        );
    }
    Ok(())
}

fn has_table(arguments: &CurveArguments) -> bool {
    arguments.output.iter().any(|path| kind(path).is_ok_and(|kind| kind == Kind::Table))
}

/// Writes all outputs and says what they are. Documents come last, so that they can tell how long
/// the others took.
pub(super) fn outputs(
    job: &mut Job<'_>,
    arguments: &CurveArguments,
) -> anyhow::Result<Vec<String>> {
    let clock = Instant::now();
    let mut written = Vec::new();
    let mut picture = None;
    let (documents, others): (Vec<_>, Vec<_>) = arguments.output.iter().partition(|path| {
        kind(path).is_ok_and(|kind| matches!(kind, Kind::Document | Kind::StandardOutput))
    });
    for path in others {
        let name = path.display();
        match kind(path)? {
            Kind::Table => {
                written.push(table(job, arguments, path)?);
            }
            Kind::Svg => {
                let svg = picture.get_or_insert_with(|| draw::figure(job));
                write_file(path, |out| out.write_all(svg.as_bytes()))?;
                written.push(format!("{name}: picture"));
            }
            Kind::Png => {
                let svg = picture.get_or_insert_with(|| draw::figure(job));
                let png = gimfit_io::figure::svg_to_png(svg, PNG_SCALE)
                    .with_context(|| format!("cannot write {name}"))?;
                write_file(path, |out| out.write_all(&png))?;
                written.push(format!("{name}: picture"));
            }
            Kind::Document | Kind::StandardOutput => {}
        }
    }
    set_write_time(job, clock);
    for path in documents {
        if path.as_os_str() == "-" {
            output::result(&json_text(job, true)?)?;
        } else {
            write_file(path, |out| write_json(&job.document, out))?;
            written.push(format!("{}: document", path.display()));
        }
    }
    set_write_time(job, clock);
    Ok(written)
}

/// Pixels per unit of a picture: sharp on screens of high resolution.
const PNG_SCALE: f32 = 2.0;

fn set_write_time(job: &mut Job<'_>, clock: Instant) {
    if let Some(seconds) = job.document.report.as_mut().and_then(|r| r.seconds.as_mut()) {
        seconds.write = Some(clock.elapsed().as_secs_f64());
    }
}

fn table(job: &Job<'_>, arguments: &CurveArguments, path: &Path) -> anyhow::Result<String> {
    let (curve, names) = (&job.fit.curve, &job.table.column_names);
    let content = match arguments.samples {
        None => {
            write_file(path, |out| write_control_points(out, curve, names))?;
            format!("{} control points", curve.control_points().len())
        }
        Some(samples) => {
            let parameters = curve.equal_steps(samples);
            write_file(path, |out| write_samples(out, curve, &parameters, 0, names))?;
            format!("{samples} samples")
        }
    };
    Ok(format!("{}: {content}", path.display()))
}

/// Writes the report where it was asked for.
pub(super) fn report(job: &Job<'_>, arguments: &CurveArguments, text: &str) -> anyhow::Result<()> {
    let Some(path) = &arguments.report else { return Ok(()) };
    let as_json = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
    let text = if as_json { json_text(job, false)? } else { text.to_owned() };
    write_file(path, |out| out.write_all(text.as_bytes()))?;
    Ok(())
}

/// The document on one line, with or without what can be long.
pub(super) fn json_text(job: &Job<'_>, geometry: bool) -> anyhow::Result<String> {
    let mut document = Document { report: job.document.report.clone(), ..Document::default() };
    if geometry {
        document = job.document.clone();
    }
    Ok(serde_json::to_string(&document)? + "\n")
}

fn write_json(document: &Document, out: &mut dyn Write) -> io::Result<()> {
    serde_json::to_writer(&mut *out, document)?;
    out.write_all(b"\n")
}
